"""The canonical file: exact round trip, clocks, holes, and every refusal with its message."""

import gzip
import hashlib
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hemma.data import load_austin2021, read_canonical, report_quality, split, write_canonical
from hemma.data.canonical import canonical_text
from hemma.errors import HemmaError

HEADER = "time,pv_kw,load_kw,outdoor_c,buy_per_kwh"
FULL = f"{HEADER},sell_per_kwh,indoor_c,hvac_kw"


def stamps(count, step=timedelta(hours=1), first="2021-06-01T00:00:00-06:00"):
    start = datetime.fromisoformat(first)
    return [(start + k * step).isoformat() for k in range(count)]


def sun(stamp):
    return max(0.0, 6.0 - abs(datetime.fromisoformat(stamp).hour + 0.5 - 12.5))


def rows(times):
    return [f"{t},{sun(t)},0.{5 + k % 4},30.{k % 7},0.1{k % 5}" for k, t in enumerate(times)]


@pytest.fixture
def write(tmp_path):
    def written(lines, header=HEADER):
        path = tmp_path / "home.csv"
        path.write_text("\n".join([header, *lines]) + "\n")
        return path

    return written


def refusal(path, **options):
    with pytest.raises(HemmaError) as caught:
        read_canonical(path, **options)
    return str(caught.value)


magnitude = st.floats(0, 30)


@given(
    pv=arrays(float, 30, elements=magnitude),
    other=arrays(float, (4, 30), elements=st.floats(0, 2.5)),
    temperature=arrays(float, (2, 30), elements=st.floats(-20, 38)),
    minutes=st.sampled_from([5, 15, 30, 60, 120]),
    offset=st.integers(-12 * 4, 14 * 4),
)
def test_round_trip_is_exact(tmp_path_factory, pv, other, temperature, minutes, offset):
    folder = tmp_path_factory.mktemp("round")
    zone = datetime(2020, 2, 28, tzinfo=UTC) - timedelta(minutes=15 * offset)
    first = zone.replace(tzinfo=None) + timedelta(minutes=15 * offset)
    sign, quarters = ("-" if offset < 0 else "+"), abs(offset)
    suffix = f"{sign}{quarters // 4:02d}:{15 * (quarters % 4):02d}"
    times = [(first + k * timedelta(minutes=minutes)).isoformat() + suffix for k in range(30)]
    columns = [pv, other[0], temperature[0], other[1], other[2], temperature[1], other[3]]
    body = [",".join([t, *(repr(float(c[k])) for c in columns)]) for k, t in enumerate(times)]
    text = "\n".join([FULL, *body]) + "\n"
    (folder / "a.csv").write_text(text)
    read = read_canonical(folder / "a.csv")
    assert canonical_text(read) == text
    assert read.slot_length == minutes / 60
    for name in ("b.csv", "b.csv.gz"):
        write_canonical(read, folder / name)
        again = read_canonical(folder / name)
        assert again.time.equals(read.time)
        for field in (
            "pv_generation",
            "load",
            "outdoor_temperature",
            "buying_price",
            "selling_price",
            "hour_of_day",
        ):
            np.testing.assert_array_equal(getattr(again.exogenous, field), getattr(read.exogenous, field))
        np.testing.assert_array_equal(again.indoor_temperature, read.indoor_temperature)
        np.testing.assert_array_equal(again.hvac_power, read.hvac_power)


def test_an_embedded_home_survives_export(tmp_path):
    home = load_austin2021(3)
    write_canonical(home, tmp_path / "home3.csv")
    read = read_canonical(tmp_path / "home3.csv")
    assert (read.sha256, read.name, read.notes) == (home.sha256, "home3", ())
    assert canonical_text(read) == canonical_text(home)
    assert split(read).test.time_stamps() == split(home).test.time_stamps()


def test_sha256_is_of_the_bytes_on_disk(tmp_path):
    path = tmp_path / "x.csv.gz"
    path.write_bytes(gzip.compress("\n".join([HEADER, *rows(stamps(30))]).encode()))
    read = read_canonical(path)
    assert read.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert read.name == "x"


def test_columns_may_come_in_any_order(write):
    plain = read_canonical(write(rows(stamps(24))))
    turned = [",".join(reversed(row.split(","))) for row in rows(stamps(24))]
    read = read_canonical(write(turned, ",".join(reversed(HEADER.split(",")))))
    assert canonical_text(read) == canonical_text(plain)


def test_selling_price_defaults_to_a_share_of_the_buying_price(write):
    read = read_canonical(write(rows(stamps(24))), selling_ratio=0.4)
    np.testing.assert_allclose(read.exogenous.selling_price, 0.4 * read.exogenous.buying_price)
    assert any("0.4 of buy_per_kwh is assumed" in note for note in read.notes)


def local_stamps(first, hours, change_at, before, after):
    """Hours from ``first`` (UTC), written with the offset ``before`` or ``after`` the moment ``change_at``."""
    moments = [datetime.fromisoformat(first) + timedelta(hours=k) for k in range(hours)]
    change = datetime.fromisoformat(change_at)
    texts = []
    for moment in moments:
        offset = before if moment < change else after
        wall = (moment + timedelta(hours=offset)).replace(tzinfo=None)
        texts.append(f"{wall.isoformat()}-{-offset:02d}:00")
    return texts


def test_autumn_repeats_a_wall_clock_hour(write):
    """Central time ends daylight saving at 2018-11-04T07:00Z: 01:00 comes twice and no slot is lost."""
    times = local_stamps("2018-11-03T05:00+00:00", 49, "2018-11-04T07:00+00:00", -5, -6)
    read = read_canonical(write(rows(times)))
    assert read.slots == 49
    assert read.time_stamps() == times
    np.testing.assert_array_equal(read.exogenous.hour_of_day[24:29], [0, 1, 1, 2, 3])
    assert np.all(np.diff(read.time.tz_convert(None).to_numpy()) == np.timedelta64(1, "h"))
    assert read.window(24, 49).time_stamps() == times[24:]


def test_spring_skips_a_wall_clock_hour(write, tmp_path):
    """Central time begins daylight saving at 2018-03-11T08:00Z: 02:00 does not exist and is no hole."""
    times = local_stamps("2018-03-10T06:00+00:00", 48, "2018-03-11T08:00+00:00", -6, -5)
    read = read_canonical(write(rows(times)))
    assert not any("interpolated" in note for note in read.notes)
    np.testing.assert_array_equal(read.exogenous.hour_of_day[24:28], [0, 1, 3, 4])
    write_canonical(read, tmp_path / "again.csv")
    assert read_canonical(tmp_path / "again.csv").time_stamps() == times


def test_a_day_of_the_test_period_begins_at_local_midnight(write):
    times = local_stamps("2018-10-01T05:00+00:00", 24 * 60 + 1, "2018-11-04T07:00+00:00", -5, -6)
    traces = read_canonical(write(rows(times)))
    assert split(traces).test.time_stamps()[0] == "2018-10-30T00:00:00-05:00"
    assert split(traces).test.slots == 31 * 24 + 1
    assert split(traces, "2018-11-05").test.time_stamps()[0] == "2018-11-05T00:00:00-06:00"
    assert split(traces, "2018-11-05T00:00:00Z").test.time_stamps()[0] == "2018-11-04T18:00:00-06:00"


@pytest.mark.parametrize("start", ["2021-05-01", "2021-07-01", None])
def test_a_period_too_short_to_split_is_refused(write, start):
    traces = read_canonical(write(rows(stamps(48))))
    with pytest.raises(HemmaError, match=r"traces hold 2\.0 days, 2021-06-01T00.*Give a longer file"):
        split(traces, start)


def test_a_start_that_is_no_time_is_refused(write):
    with pytest.raises(HemmaError, match=r"--test-from: expected a day or a time.*got 'August'"):
        split(read_canonical(write(rows(stamps(48)))), "August")


def test_holes_up_to_an_hour_are_interpolated_and_told(write):
    times = stamps(96, timedelta(minutes=15))
    lines = rows(times)
    lines[50] = f"{times[50]},3,1.0,30,0.1"
    lines[55] = f"{times[55]},3,2.0,30,0.1"
    for k in range(51, 55):
        lines[k] = f"{times[k]},3,,30,0.1"
    del lines[20]
    read = read_canonical(write(lines))
    np.testing.assert_allclose(read.exogenous.load[50:56], [1.0, 1.2, 1.4, 1.6, 1.8, 2.0])
    assert read.time_stamps() == times
    assert "1 hour interpolated from 2021-06-01T12:45:00-06:00 in load_kw" in read.notes
    assert "15 minutes interpolated from 2021-06-01T05:00:00-06:00 in every column" in read.notes


def test_each_longer_hole_is_named(write):
    times = stamps(24 * 40)
    lines = rows(times)
    for k in range(26, 40):
        cells = lines[k].split(",")
        lines[k] = ",".join([*cells[:2], "", *cells[3:]])
    del lines[500:503]
    message = refusal(write(lines))
    assert "14 hours missing from 2021-06-02T02:00:00-06:00 in load_kw" in message
    assert f"3 hours missing from {times[500]} in every column" in message
    assert "got 2: " in message
    assert f"19.2 days, {times[40]} to {times[500]}" in message.replace("19.17", "19.2")
    read = read_canonical(write(lines), longest_gap=14.0)
    assert read.slots == len(times)


def test_holes_at_the_ends_are_refused_whatever_their_length(write):
    lines = rows(stamps(48))
    lines[0] = lines[0].rsplit(",", 1)[0] + ","
    assert "1 hour missing from 2021-06-01T00:00:00-06:00 in buy_per_kwh" in refusal(write(lines))


def replaced(column, factor, count=72, term=0.0):
    index = FULL.split(",").index(column)
    body = []
    for k, stamp in enumerate(stamps(count)):
        cells = [stamp, str(sun(stamp)), "0.6", "30", "0.1", "0.09", "23", f"{1.5 + k % 2}"]
        cells[index] = str(float(cells[index]) * factor + term)
        body.append(",".join(cells))
    return body


@pytest.mark.parametrize(
    ("column", "factor", "term", "message"),
    [
        ("pv_kw", 1000, 0, "this looks like W. Divide by 1000"),
        ("load_kw", 1000, 0, "this looks like W. Divide by 1000"),
        ("hvac_kw", 1000, 0, "this looks like W. Divide by 1000"),
        ("outdoor_c", 1.8, 32, "this looks like Fahrenheit"),
        ("indoor_c", 1.8, 32, "this looks like Fahrenheit"),
        ("outdoor_c", 1, 273.15, "this looks like kelvin"),
        ("indoor_c", 1, 273.15, "this looks like kelvin"),
        ("buy_per_kwh", 100, 0, "this looks like cents/kWh"),
        ("sell_per_kwh", 1000, 0, "currency/MWh"),
    ],
)
def test_wrong_units_are_named_with_their_cure(write, column, factor, term, message):
    read_canonical(write(replaced(column, 1), FULL))
    text = refusal(write(replaced(column, factor, term=term), FULL))
    assert text.startswith(str(write(replaced(column, factor, term=term), FULL)))
    assert column in text
    assert message in text


def test_a_spike_of_the_market_is_no_wrong_unit(write):
    lines = rows(stamps(48))
    lines[20] = lines[20].rsplit(",", 1)[0] + ",9.0"
    assert read_canonical(write(lines)).exogenous.buying_price.max() == 9.0


def test_a_failed_sensor_is_no_wrong_unit(write):
    lines = replaced("outdoor_c", 1, 240)
    lines[100] = lines[100].replace(",30.0,", ",85,")
    assert "Empty the cells of the failed sensor" in refusal(write(lines, FULL))


def test_noise_below_zero_becomes_zero_and_is_told(write):
    lines = rows(stamps(48))
    lines[0] = lines[0].replace(",0.0,", ",-0.003,", 1)
    read = read_canonical(write(lines))
    assert read.exogenous.pv_generation[0] == 0.0
    assert "1 hour of pv_kw just below zero (lowest -0.003 kW) set to 0" in read.notes


def test_a_negative_load_is_refused(write):
    lines = rows(stamps(48))
    cells = lines[7].split(",")
    lines[7] = ",".join([*cells[:2], "-1.25", *cells[3:]])
    message = refusal(write(lines))
    assert "load_kw is negative in 1 hour (1 times), lowest -1.25 kW at 2021-06-01T07:00:00-06:00" in message


def test_stamps_in_the_wrong_zone_are_told(write):
    shifted = [row.replace("-06:00,", "+06:00,") for row in rows(stamps(48))]
    assert not any("pv_kw" in note for note in read_canonical(write(shifted)).notes)
    in_utc = [
        f"{t.replace('-06:00', '+00:00')},{sun(w)},0.5,30,0.1"
        for t, w in zip(stamps(72), stamps(78)[6:], strict=True)
    ]
    assert any("pv_kw is centred at 6." in note for note in read_canonical(write(in_utc)).notes)


def test_odd_prices_are_allowed_and_told(write):
    lines = [
        f"{t},{sun(t)},0.5,30,{-0.02 if k == 5 else 0.1},{0.12 if k < 2 else 0.05},23,1"
        for k, t in enumerate(stamps(48))
    ]
    read = read_canonical(write(lines, FULL))
    assert "sell_per_kwh is above buy_per_kwh in 3 hours" in read.notes
    assert "buy_per_kwh is negative in 1 hour" in read.notes
    assert read.exogenous.buying_price[5] == -0.02


@pytest.mark.parametrize(
    ("time", "rest", "message"),
    [
        (
            "2021-06-01T03:00:00",
            "0,1,30,0.1",
            "line 5: expected a time stamp in whole seconds with its offset",
        ),
        ("yesterday", "0,1,30,0.1", "line 5: expected a time stamp"),
        (
            "03:00:00-06:00",
            "0,much,30,0.1",
            "line 5: expected a finite number (or an empty cell) in load_kw, got",
        ),
        (
            "03:00:00-06:00",
            "inf,1,30,0.1",
            "line 5: expected a finite number (or an empty cell) in pv_kw, got 'inf'",
        ),
        ("03:00:00-06:00", "0,1,30", "line 5: expected 5 cells as in the header, got 4"),
        ("02:00:00-06:00", "0,1,30,0.1", "each once, but 2021-06-01T02:00:00-06:00 is there twice"),
        ("01:30:00-06:00", "0,1,30,0.1", "2021-06-01T01:30:00-06:00 comes after 2021-06-01T02:00:00-06:00"),
        ("03:10:00-06:00", "0,1,30,0.1", "line 5: expected slots of one length, mostly 60 minutes"),
    ],
)
def test_bad_rows_are_named_by_line(write, time, rest, message):
    lines = rows(stamps(48))
    lines[3] = f"{time if time[2] != ':' else '2021-06-01T' + time},{rest}"
    assert message in refusal(write(lines))


def test_a_wrong_century_is_no_hole(write):
    lines = [*rows(stamps(47)), "2121-06-02T23:00:00-06:00,0,1,30,0.1"]
    assert "got 48 rows between 2021-06-01T00:00:00-06:00 and 2121" in refusal(write(lines))


def test_lines_are_counted_with_empty_ones(write):
    lines = rows(stamps(48))
    lines[10:10] = ["", ""]
    lines[20] = lines[20].replace("0.", "x.", 1)
    assert "line 22:" in refusal(write(lines))


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("time,pv_kw,load_kw,outdoor_c", "missing: buy_per_kwh, found: time,pv_kw,load_kw,outdoor_c"),
        (f"{HEADER},sel_per_kwh", "got also sel_per_kwh. Rename them or take them out"),
        (f"{HEADER},pv_kw", "pv_kw stands there twice"),
        (HEADER.replace(",", ";"), "separated by commas"),
    ],
)
def test_bad_headers_are_told(write, header, message):
    assert message in refusal(write(rows(stamps(4)), header))


def test_three_offsets_are_no_daylight_saving(write):
    times = stamps(24)
    times[5] = "2021-06-01T06:00:00-05:00"
    times[6] = "2021-06-01T08:00:00-04:00"
    assert "at most two offsets from UTC" in refusal(write(rows(times)))


def test_unreadable_files_are_told(tmp_path):
    assert "expected a readable file" in refusal(tmp_path / "none.csv")
    (tmp_path / "a.csv").write_bytes(b"PK\x03\x04 a spreadsheet")
    assert "Export it as CSV" in refusal(tmp_path / "a.csv")
    (tmp_path / "b.csv").write_bytes("time,pv_kw,größe".encode("latin-1"))
    assert "expected text in UTF-8, got byte 0xf6" in refusal(tmp_path / "b.csv")
    (tmp_path / "c.csv.gz").write_bytes(gzip.compress(b"time")[:-3])
    assert "damaged" in refusal(tmp_path / "c.csv.gz")
    (tmp_path / "d.csv").write_bytes(b"")
    assert "the file is empty" in refusal(tmp_path / "d.csv")
    (tmp_path / "e.csv").write_text(HEADER + "\n")
    assert "expected at least two rows, got 0" in refusal(tmp_path / "e.csv")


def test_a_byte_order_mark_does_no_harm(tmp_path):
    (tmp_path / "a.csv").write_bytes(b"\xef\xbb\xbf" + "\r\n".join([HEADER, *rows(stamps(9))]).encode())
    assert read_canonical(tmp_path / "a.csv").slots == 9


def test_only_csv_names_are_written(tmp_path):
    with pytest.raises(HemmaError, match=r"ends in \.csv or \.csv\.gz"):
        write_canonical(load_austin2021(1), tmp_path / "home.xlsx")


def test_quality_report_gives_energies_and_span(write):
    lines = [f"{t},{2.0 * (10 <= k % 24 < 14)},0.5,{20 + k % 24},0.1" for k, t in enumerate(stamps(48))]
    text = "\n".join(report_quality(read_canonical(write(lines))))
    assert "2.0 days, 48 slots of 1 hour" in text
    assert "PV: 16.0 kWh in all, at most 2 kW" in text
    assert "load: 24.0 kWh" in text
    assert "outdoor temperature: 20 to 43 degC, mean 31.5" in text
    assert "no thermal model can be identified" in text
    assert "note: sell_per_kwh is not given" in text
