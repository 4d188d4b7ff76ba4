"""What is repaired and told, and what is refused with file, line and cure."""

from datetime import timedelta

import numpy as np
import pytest
from canonical_files import FULL, HEADER, refusal, rows, stamps, sun

from hemma.data import read_canonical, report_quality


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
    assert "15 minutes interpolated from 2021-06-01T05:00:00-06:00 in pv_kw, load_kw, outdoor_c" in read.notes
    assert "15 minutes held from 2021-06-01T05:00:00-06:00 in buy_per_kwh" in read.notes


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


def test_quality_report_gives_energies_and_span(write):
    lines = [f"{t},{2.0 * (10 <= k % 24 < 14)},0.5,{20 + k % 24},0.1" for k, t in enumerate(stamps(48))]
    text = "\n".join(report_quality(read_canonical(write(lines))))
    assert "2.0 days, 48 slots of 1 hour" in text
    assert "PV: 16.0 kWh in all, at most 2 kW" in text
    assert "load: 24.0 kWh" in text
    assert "outdoor temperature: 20 to 43 degC, mean 31.5" in text
    assert "no thermal model can be identified" in text
    assert "note: sell_per_kwh is not given" in text
