"""The canonical file: exact round trip, clocks, and files that cannot be read."""

import gzip
import hashlib
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from canonical_files import FULL, HEADER, refusal, rows, stamps
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hemma.data import load_austin2021, read_canonical, split, write_canonical
from hemma.data.canonical import canonical_text
from hemma.errors import HemmaError

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
        assert again.time_stamps() == read.time_stamps()
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
    """Hours from ``first`` (UTC) with the offset ``before``, from ``change_at`` on with ``after``."""
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
    assert np.all(np.diff(read.clock.seconds) == 3600)
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
