"""One length of a slot that divides a day, and offsets that a wall clock can have."""

from datetime import datetime, timedelta

import pytest
from canonical_files import refusal, rows, stamps
from dataport_files import TARIFF, dataport, instants, row, weather_file

from hemma.data import PecanStreetOptions, read_canonical, read_pecan_street
from hemma.errors import HemmaError


@pytest.mark.parametrize("minutes", [50, 7, 11, 25, 35, 100, 300, 2880])
def test_slots_that_do_not_divide_a_day_are_refused(write, minutes):
    path = write(rows(stamps(60, timedelta(minutes=minutes))))
    message = refusal(path)
    assert message.startswith(f"{path}: expected slots that divide a day")
    assert f"got slots of {minutes} minutes (2021-06-01T00:00:00-06:00, " in message


@pytest.mark.parametrize("minutes", [1, 5, 10, 12, 20, 45, 90, 120, 1440])
def test_slots_that_divide_a_day_are_read(write, minutes):
    times = stamps(60, timedelta(minutes=minutes))
    assert read_canonical(write(rows(times))).slot_length == minutes / 60


def test_a_dataport_home_in_seven_minutes_is_refused(tmp_path):
    header = ["dataid", "localminute", "grid", "solar"]
    rows = [
        row(661, dataport(t), {"grid": 0.5, "solar": k % 3}, header)
        for k, t in enumerate(instants(1500, step=timedelta(minutes=1)))
    ]
    (tmp_path / "home.csv").write_text("\n".join([",".join(header), *rows]))
    weather = weather_file(tmp_path, "2018-05-31T00:00+00:00", 80)
    with pytest.raises(HemmaError, match=r"home 661: expected slots that divide a day.*got slots of 7 min"):
        read_pecan_street(
            tmp_path / "home.csv", 661, weather=weather, prices=TARIFF,
            options=PecanStreetOptions(slot_length=7 / 60),
        )  # fmt: skip


def changing(*parts):
    """Time stamps in parts of (number, minutes) each."""
    moment, times = datetime.fromisoformat("2021-06-01T00:00:00-06:00"), []
    for count, minutes in parts:
        for _ in range(count):
            times.append(moment.isoformat())
            moment += timedelta(minutes=minutes)
    return times


@pytest.mark.parametrize(
    ("parts", "line", "usual", "start", "other"),
    [
        (((48, 60), (96, 15)), 3, 15, "2021-06-01T00:00:00-06:00", 60),
        (((96, 60), (48, 15)), 99, 60, "2021-06-05T00:00:00-06:00", 15),
        (((96, 15), (48, 60)), 99, 15, "2021-06-02T00:00:00-06:00", 60),
        (((96, 15), (8, 30), (96, 15)), 99, 15, "2021-06-02T00:00:00-06:00", 30),
    ],
)
def test_a_slot_length_that_changes_is_refused_where_it_changes(write, parts, line, usual, start, other):
    message = refusal(write(rows(changing(*parts))))
    assert f"line {line}: expected slots of one length, mostly {usual} minutes, but from {start}" in message
    assert f"they have {other} minutes. Bring all rows to one length, or cut the file there" in message


def test_single_missing_rows_are_no_change_of_the_slot_length(write):
    times = stamps(96, timedelta(minutes=15))
    for k in (90, 60, 58, 56, 54, 31):
        del times[k]
    assert read_canonical(write(rows(times))).slots == 96


def shifted(times, offsets):
    """The same moments, each on the wall clock of its offset [h]."""
    moments = [datetime.fromisoformat(t) for t in times]
    texts = []
    for moment, offset in zip(moments, offsets, strict=True):
        wall = (moment.replace(tzinfo=None) + timedelta(hours=offset)).isoformat()
        minutes = round(abs(offset) * 60)
        texts.append(f"{wall}{'-' if offset < 0 else '+'}{minutes // 60:02d}:{minutes % 60:02d}")
    return texts


@pytest.mark.parametrize(
    ("offsets", "line", "expected"),
    [
        ([1 + k % 2 for k in range(48)], 4, "offsets from UTC that change in spring and autumn"),
        ([2 if k == 20 else 1 for k in range(48)], 23, "offsets from UTC that change in spring and autumn"),
        ([2 if 20 < k < 40 else 1 for k in range(48)], 42, "offsets from UTC that change in spring"),
        ([17 if k == 5 else 1 for k in range(48)], 7, "an offset from UTC that exists"),
        ([-13] * 48, 2, "an offset from UTC that exists"),
        ([1 + 7 / 60 if k > 8 else 1 for k in range(48)], 11, "an offset from UTC that exists"),
        ([8 if k > 30 else 1 for k in range(48)], 33, "daylight saving changes by at most 2 hours"),
        ([1 + (k > 10) + (k > 30) for k in range(48)], 33, "at most two offsets from UTC"),
    ],
)
def test_offsets_that_no_wall_clock_has_are_refused_by_line(write, offsets, line, expected):
    message = refusal(write(rows(shifted(stamps(48, first="2021-06-01T00:00:00"), offsets))))
    assert f"line {line}: expected" in message
    assert expected in message
    assert "Write each row with the offset of the home's wall clock" in message


def test_summer_and_winter_of_two_years_are_read(write):
    """Central Europe: changes on 28 March, 31 October 2021 and 27 March 2022."""
    times = stamps(24 * 330 // 6, timedelta(hours=6), "2021-03-20T00:00:00")
    summer = [("2021-03-28" <= t[:10] < "2021-10-31") or t[:10] >= "2022-03-27" for t in times]
    read = read_canonical(write(rows(shifted(times, [1 + dst for dst in summer]))))
    assert sorted(set(read.clock.offset.tolist())) == [1.0, 2.0]


@pytest.mark.parametrize("stamp", ["0001-01-01T00:00:00+14:00", "9999-12-31T23:00:00-06:00", "x" * 9000])
def test_moments_that_no_log_has_are_refused(write, stamp):
    lines = rows(stamps(48))
    lines[30] = f"{stamp},0,1,30,0.1"
    message = refusal(write(lines))
    assert "line 32: expected a time stamp" in message
    assert len(message) < 500
