"""Hundreds of spoilt trace files: each is read or refused in one message, and nonsense is never silent."""

from contextlib import suppress

import numpy as np
import pytest
from canonical_files import FULL, stamps
from dataport_files import HEADER as DATAPORT
from dataport_files import body, read

from hemma.data import read_canonical, report_quality
from hemma.errors import HemmaError

COLUMNS = FULL.split(",")
TIMES = stamps(120)
SENTINELS = ["-999", "9999", "999.9", "32767", "-9999", "65535", "-32768", "99999"]
TEXTS = [
    *("1_0", "0x10", '"1,5"', "١٢", "nan", "inf", "-inf", "1e308", "-1e308", "", " ", "NULL", "1e-320"),
    *("x" * 300, "7" * 5000, '"', "'", "\x00", "\x0c", "\ufeff", "=1+1", "1.5.2", "+-3", "1e999"),
]


def log(draw):
    """A home in order, its cells as text; measured values differ from slot to slot."""
    hour = np.arange(len(TIMES)) % 24
    solar = np.maximum(0.0, 3.0 - np.abs(hour - 12) / 2)
    load = 0.3 + draw.gamma(2.0, 0.1, len(hour))
    price = 0.1 + 0.1 * ((hour >= 16) & (hour < 20)) + draw.uniform(0, 0.02, len(hour))
    outdoor, indoor = 22 + hour / 4 + draw.normal(size=len(hour)), 23 + draw.normal(size=len(hour)) / 4
    hvac = draw.uniform(0, 3, len(hour))
    columns = [solar, load, outdoor, price, 0.9 * price, indoor, hvac]
    texts = [np.char.mod("%.4f", column).tolist() for column in columns]
    return [list(COLUMNS), *map(list, zip(TIMES, *texts, strict=True))]


def place(draw, table):
    return draw.integers(1, len(table)), draw.integers(1, len(COLUMNS))


def text_of(table):
    return "\n".join(",".join(row) for row in table) + "\n"


def flipped_cell(draw, table):
    row, column = place(draw, table)
    table[row][column] = str(draw.choice(TEXTS))
    return text_of(table)


def flipped_time(draw, table):
    row = draw.integers(1, len(table))
    text = table[row][0]
    at = draw.integers(0, len(text))
    table[row][0] = text[:at] + str(draw.choice(list("0123456789-+:TZ x\"'"))) + text[at + 1 :]
    return text_of(table)


def dropped_column(draw, table):
    column = draw.integers(0, len(COLUMNS))
    rows = table if draw.random() < 0.5 else table[int(draw.integers(1, len(table))) :]
    for row in rows:
        del row[column]
    return text_of(table)


def doubled_or_renamed_column(draw, table):
    column = draw.integers(0, len(COLUMNS))
    table[0][column] = str(draw.choice([*COLUMNS, "", "Unnamed: 0", "PV_KW", "x" * 5000]))
    return text_of(table)


def shuffled_lines(draw, table):
    one, other = draw.integers(0, len(table), 2)
    table[one], table[other] = table[other], table[one]
    return text_of(table)


def dropped_and_doubled_lines(draw, table):
    for _ in range(draw.integers(1, 30)):
        at = draw.integers(0, len(table))
        if draw.random() < 0.5:
            del table[at]
        else:
            table.insert(at, list(table[at]))
    return text_of(table)


def stray_characters(draw, table):
    text = text_of(table)
    for _ in range(draw.integers(1, 4)):
        at = draw.integers(0, len(text))
        text = text[:at] + str(draw.choice(list('",;\n\r\t\0\x1a\x85 _-\u2028é'))) + text[at:]
    return text


def cut_file(draw, table):
    text = text_of(table)
    return text[: draw.integers(0, len(text))]


def other_bytes(draw, table):
    content = text_of(table).replace("kw", "kẃ" if draw.random() < 0.1 else "kw")
    kind = draw.integers(0, 4)
    if kind == 0:
        return content.encode(str(draw.choice(["utf-16", "utf-16-le", "utf-32", "utf-7", "utf-8-sig"])))
    spoilt = bytearray(content.encode())
    for _ in range(draw.integers(1, 5)):
        spoilt[draw.integers(0, len(spoilt))] = draw.integers(0, 256)
    return bytes(spoilt)


def other_separators(draw, table):
    separator, point = str(draw.choice([";", "\t", "|", " "])), str(draw.choice([",", "."]))
    return text_of(table).replace(",", separator).replace(".", point)


def other_clock(draw, table):
    kind = draw.integers(0, 4)
    minutes = int(draw.choice([1, 7, 13, 50, 90, 1500]))
    for k, row in enumerate(table[1:]):
        if kind == 0:
            row[0] = row[0][:-6]
        elif kind == 1:
            row[0] = str(np.datetime64("2021-06-01", "s") + np.timedelta64(60 * k * minutes, "s")) + "+00:00"
        elif kind == 2 and k % int(minutes) == 0:
            row[0] = row[0][:-6] + "-05:00"
        elif kind == 3 and k > 60:
            row[0] = row[0].replace("2021", str(draw.choice(["1021", "2121", "9999", "2022"])))
    return text_of(table)


HARMLESS_OR_REFUSED = (
    flipped_cell, flipped_time, dropped_column, doubled_or_renamed_column, shuffled_lines,
    dropped_and_doubled_lines, stray_characters, cut_file, other_bytes, other_separators, other_clock,
)  # fmt: skip


def scaled(column, factor, term=0.0):
    def change(draw, table):
        at = COLUMNS.index(column)
        for row in table[1:]:
            row[at] = repr(float(row[at]) * factor + term)

    return change


def sentinel(draw, table):
    value = str(draw.choice(SENTINELS))
    column = draw.integers(1, len(COLUMNS))
    for row in draw.integers(1, len(table), draw.integers(1, 20)):
        table[row][column] = value


def absurd_price(draw, table):
    row, column = draw.integers(1, len(table)), draw.integers(4, 6)
    table[row][column] = repr(float(10.0 ** draw.uniform(1.0, 300.0) * draw.choice([1, -1])))


def absurd_power(draw, table):
    row, column = (
        draw.integers(1, len(table)),
        COLUMNS.index(str(draw.choice(["pv_kw", "load_kw", "hvac_kw"]))),
    )
    table[row][column] = repr(float(10.0 ** draw.uniform(2.0, 300.0)))


def stuck(draw, table):
    column = COLUMNS.index(str(draw.choice(["pv_kw", "load_kw", "outdoor_c", "indoor_c", "hvac_kw"])))
    for row in table[10:90]:
        row[column] = "1.2345"


POWERS, TEMPERATURES = ("pv_kw", "load_kw", "hvac_kw"), ("outdoor_c", "indoor_c")
PRICES = ("buy_per_kwh", "sell_per_kwh")
NONSENSE = {
    **{f"{name} in W": scaled(name, 1000) for name in POWERS},
    **{f"{name} in MW": scaled(name, 0.001) for name in POWERS},
    **{f"{name} in degF": scaled(name, 1.8, 32) for name in TEMPERATURES},
    **{f"{name} in K": scaled(name, 1, 273.15) for name in TEMPERATURES},
    **{f"{name} in tenths": scaled(name, 10) for name in TEMPERATURES},
    **{f"{name} in thousandths": scaled(name, 1000) for name in TEMPERATURES},
    **{f"{name} in cents": scaled(name, 100) for name in PRICES},
    **{f"{name} per MWh": scaled(name, 1000) for name in PRICES},
    "sentinels": sentinel,
    "an absurd price": absurd_price,
    "an absurd power": absurd_power,
    "a stuck sensor": stuck,
}


def outcome(path, content):
    """The notes of a file that is read, or the message that refuses it; anything else fails the test."""
    path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass"))
    try:
        traces = read_canonical(path, selling_ratio=0.9)
    except HemmaError as error:
        message = str(error)
        assert message.startswith(str(path))
        assert len(message) < 1500, message
        assert "\n" not in message
        return message
    assert np.isfinite(traces.exogenous.load).all()
    assert report_quality(traces)
    return traces.notes


@pytest.mark.parametrize("mutation", HARMLESS_OR_REFUSED, ids=lambda mutation: mutation.__name__)
def test_a_spoilt_file_is_read_or_refused_in_one_message(tmp_path, mutation):
    for seed in range(15):
        draw = np.random.default_rng(seed)
        outcome(tmp_path / "home.csv", mutation(draw, log(draw)))


def test_a_file_in_order_is_read_without_a_word(tmp_path):
    for seed in range(3):
        assert outcome(tmp_path / "home.csv", text_of(log(np.random.default_rng(seed)))) == ()


@pytest.mark.parametrize("name", NONSENSE)
def test_nonsense_is_never_silent(tmp_path, name):
    for seed in range(3):
        draw = np.random.default_rng(seed)
        table = log(draw)
        NONSENSE[name](draw, table)
        assert outcome(tmp_path / "home.csv", text_of(table)), (name, seed)


def test_a_spoilt_dataport_file_is_read_or_refused(folder):
    for seed in range(20):
        draw = np.random.default_rng(seed)
        rows = body(96)
        at = int(draw.integers(0, len(rows)))
        cells = rows[at].split(",")
        column = int(draw.choice([0, 1, DATAPORT.index("grid"), DATAPORT.index("solar"), len(cells) - 1]))
        cells[column] = str(draw.choice(TEXTS))
        rows[at] = ",".join(cells[: draw.integers(1, len(cells))] if seed % 5 == 0 else cells)
        with suppress(HemmaError):
            read(folder, rows)
