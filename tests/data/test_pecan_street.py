"""Dataport files: their clocks, holes, intervals and archives."""

import gzip
import tarfile
from datetime import timedelta

import numpy as np
import pytest
from dataport_files import (
    CENTRAL,
    HEADER,
    TARIFF,
    bad_cell,
    body,
    circuits,
    dataport,
    excel,
    expected,
    instants,
    naive,
    read,
    refusal,
    row,
    same_series,
    weather_file,
)

from hemma.data import (
    PecanStreetOptions,
    list_pecan_street_homes,
    read_canonical,
    read_pecan_street,
    write_canonical,
)
from hemma.errors import HemmaError


def test_header_has_the_documented_79_columns():
    assert len(HEADER) == 79


def test_hourly_power_is_the_mean_of_four_rows(folder):
    traces = read(folder, body(192))
    assert traces.time_stamps()[:2] == ["2018-06-01T00:00:00-05:00", "2018-06-01T01:00:00-05:00"]
    assert (traces.slots, traces.slot_length, traces.name) == (48, 1.0, "pecan-street-661")
    np.testing.assert_allclose(traces.exogenous.pv_generation, expected(192, "pv"), atol=1e-12)
    np.testing.assert_allclose(traces.exogenous.load, expected(192, "load"), atol=1e-12)
    np.testing.assert_allclose(traces.hvac_power, expected(192, "hvac"), atol=1e-12)
    assert traces.indoor_temperature is None
    np.testing.assert_array_equal(traces.exogenous.hour_of_day[:3], [0, 1, 2])
    assert "licensed" in traces.source


@pytest.mark.parametrize("slot_length", [0.25, 0.5, 1.0, 2.0, 6.0])
def test_energy_is_conserved_by_resampling(folder, slot_length):
    traces = read(folder, body(192), PecanStreetOptions(slot_length=slot_length))
    energy = traces.exogenous.load.sum() * slot_length
    assert energy == pytest.approx(sum(0.5 + 0.1 * (k % 4) for k in range(192)) / 4)
    assert traces.hvac_power.sum() * slot_length == pytest.approx(expected(192, "hvac", 1).sum() / 4)


def test_whole_slots_begin_on_the_hour(folder):
    """From 01:15 to 23:15, the hours from 02:00 to 22:00 are whole."""
    traces = read(folder, body(192)[5:-2])
    assert traces.time_stamps()[0] == "2018-06-01T02:00:00-05:00"
    assert traces.time_stamps()[-1] == "2018-06-02T22:00:00-05:00"


def test_unsorted_rows_of_several_homes(folder):
    rows = [*body(192, home=2335, solar=lambda k, v: 9.0), *body(192)]
    shuffled = [rows[k] for k in np.random.default_rng(0).permutation(len(rows))]
    same_series(read(folder, shuffled), read(folder, body(192)))


def test_naive_dumps_and_excel_copies_say_the_same(folder):
    plain = read(folder, body(192))
    old = read(folder, body(192, naive))
    same_series(old, plain)
    assert any("taken as wall clock times of US/Central" in note for note in old.notes)
    resaved = [line.replace(",", ";") for line in body(192, excel)]
    same_series(read(folder, resaved, separator=";"), plain)
    commas = [line.replace(".", ",") for line in resaved]
    same_series(read(folder, commas, separator=";"), plain)


def test_month_first_where_day_first_cannot_be(folder):
    """27 May would be month 27."""
    count = 8 * 96
    american = [
        t.astimezone(CENTRAL).strftime("%m/%d/%Y %H:%M") for t in instants(count, "2018-05-27T05:00+00:00")
    ]
    rows = [row(661, stamp, circuits(k)) for k, stamp in enumerate(american)]
    traces = read(folder, rows, PecanStreetOptions(start="2018-06-01", stop="2018-06-02"))
    assert traces.time_stamps()[0] == "2018-06-01T00:00:00-05:00"


@pytest.mark.parametrize("form", [dataport, naive])
def test_autumn_keeps_all_25_hours(folder, form):
    """2018-11-04 in Central time has 01:00 to 01:45 twice: in a naive dump the first ones are summer time."""
    times = instants(100, "2018-11-04T05:00+00:00")
    rows = [row(661, form(t), {"grid": 0.01 * k, "air1": 0}) for k, t in enumerate(times)]
    weather = weather_file(folder, "2018-11-03T00:00+00:00", 60)
    traces = read(folder, rows, weather=weather)
    assert traces.slots == 25
    assert traces.time_stamps()[:4] == [
        "2018-11-04T00:00:00-05:00",
        "2018-11-04T01:00:00-05:00",
        "2018-11-04T01:00:00-06:00",
        "2018-11-04T02:00:00-06:00",
    ]
    np.testing.assert_allclose(traces.exogenous.load, 0.01 * np.arange(100).reshape(25, 4).mean(axis=1))
    np.testing.assert_array_equal(traces.exogenous.hour_of_day[:4], [0, 1, 1, 2])


def test_a_naive_dump_without_the_second_hour_has_a_hole_of_one_hour(folder):
    times = instants(100, "2018-11-04T05:00+00:00")
    kept = [(k, t) for k, t in enumerate(times) if not 8 <= k < 12]
    rows = [row(661, naive(t), {"grid": 0.01 * k, "air1": 0}) for k, t in kept]
    traces = read(folder, rows, weather=weather_file(folder, "2018-11-03T00:00+00:00", 60))
    assert traces.slots == 25
    np.testing.assert_allclose(traces.exogenous.load, 0.01 * np.arange(100).reshape(25, 4).mean(axis=1))
    assert any("1 hour interpolated from 2018-11-04T01:00:00-06:00" in note for note in traces.notes)


def test_spring_is_no_hole(folder):
    times = instants(92, "2018-03-11T06:00+00:00")
    rows = [row(661, naive(t), {"grid": 0.5, "air1": 0}) for t in times]
    rows.insert(8, row(661, "2018-03-11 02:15:00", {"grid": 77.0, "air1": 0}))
    traces = read(folder, rows, weather=weather_file(folder, "2018-03-10T00:00+00:00", 60))
    assert traces.slots == 23
    assert traces.exogenous.load.max() == pytest.approx(0.5)
    assert any("1 row left out whose wall clock time is skipped" in note for note in traces.notes)
    assert not any("interpolated" in note for note in traces.notes)


def test_doubled_rows_count_once(folder):
    rows = body(192)
    rows.insert(60, rows[59].replace(",0.", ",7.", 1))
    traces = read(folder, rows)
    same_series(traces, read(folder, body(192)))
    assert "1 row left out whose moment was there before" in traces.notes


def test_missing_rows_up_to_an_hour_are_interpolated(folder):
    rows = body(192, grid=lambda k, v: 0.5 + 0.01 * k, solar=lambda k, v: 0.0, air1=lambda k, v: 0.0,
                furnace1=lambda k, v: 0.0)  # fmt: skip
    traces = read(folder, [*rows[:40], *rows[44:]])
    np.testing.assert_allclose(
        traces.exogenous.load, (0.5 + 0.01 * np.arange(192)).reshape(48, 4).mean(axis=1), atol=1e-12
    )
    assert "1 hour interpolated from 2018-06-01T10:00:00-05:00 in every column" in traces.notes


def test_longer_holes_are_named_with_the_longest_stretch(folder):
    rows = body(384)
    message = refusal(folder, [*rows[:40], *rows[45:]])
    assert "home 661" in message
    assert "1.25 hours missing from 2018-06-01T10:00:00-05:00 in every column" in message
    assert (
        "longest stretch without one has 3.5 days, 2018-06-01T11:15:00-05:00 to 2018-06-05T00:00" in message
    )
    traces = read(folder, [*rows[:40], *rows[45:]], PecanStreetOptions(start="2018-06-02", stop="2018-06-04"))
    assert (traces.slots, traces.time_stamps()[0]) == (48, "2018-06-02T00:00:00-05:00")


def test_minutes_become_hours(folder):
    header = ["dataid", "localminute", "grid", "solar", "solar2", "air1"]
    rows = [
        row(661, dataport(t), {"grid": 0.01 * (k % 60), "solar": 1.0, "solar2": 0.5, "air1": 0.0}, header)
        for k, t in enumerate(instants(600, step=timedelta(minutes=1)))
    ]
    traces = read(folder, rows, header=header)
    np.testing.assert_allclose(traces.exogenous.pv_generation, 1.5)
    np.testing.assert_allclose(traces.exogenous.load, 1.5 + 0.01 * np.mean(np.arange(60)), atol=1e-12)
    assert traces.slots == 10


def test_californian_homes_live_by_pacific_time(folder):
    traces = read(folder, body(192), PecanStreetOptions(home_zone="US/Pacific"))
    assert traces.time_stamps()[0] == "2018-05-31T22:00:00-07:00"
    assert traces.exogenous.hour_of_day[0] == 22


@pytest.mark.parametrize("form", ["csv.gz", "tar.gz"])
def test_compressed_files(folder, form):
    plain = read(folder, body(192))
    content = (folder / "15minute_data_austin.csv").read_bytes()
    path = folder / f"15minute_data_austin.{form}"
    if form == "csv.gz":
        path.write_bytes(gzip.compress(content))
    else:
        with tarfile.open(path, "w:gz") as archive:
            archive.add(folder / "15minute_data_austin.csv", "austin/15minute_data_austin.csv")
            archive.add(folder / "weather.csv", "austin/metadata.csv")
    traces = read_pecan_street(path, 661, weather=folder / "weather.csv", prices=TARIFF)
    same_series(traces, plain)
    assert traces.sha256 == plain.sha256
    assert [home.home for home in list_pecan_street_homes(path)] == [661]


def test_the_canonical_export_reads_back(folder):
    traces = read(folder, body(192))
    write_canonical(traces, folder / "export.csv")
    again = read_canonical(folder / "export.csv")
    same_series(again, traces)
    assert again.sha256 == traces.sha256


def test_refusals_say_where(folder):
    rows = body(192)
    assert "line 12: expected a number in solar, got 'n/a?'" in refusal(folder, bad_cell(rows, 10, "n/a?"))
    assert "line 4: expected a time stamp" in refusal(
        folder, [*rows[:2], rows[2].replace("2018-06", "2018-16"), *rows[3:]]
    )
    assert "line 4: expected a time stamp written like" in refusal(
        folder, [*rows[:2], row(661, "2018-06-01 00:30", {}), *rows[3:]]
    )
    assert "expected one of its homes, got 661. It holds 7, 8" in refusal(
        folder, [*body(4, home=7), *body(4, home=8)]
    )
    assert "multiple of the file's 15 minutes, got 20 minutes" in refusal(
        folder, rows, PecanStreetOptions(slot_length=1 / 3)
    )
    assert "circuit grid (or use) is instrumented" in refusal(folder, body(96, grid=lambda k, v: ""))
    assert "expected a time zone such as US/Central, got 'Texas'" in refusal(
        folder, rows, PecanStreetOptions(home_zone="Texas")
    )
    assert "expected rows between 2019-01-01 and None" in refusal(
        folder, rows, PecanStreetOptions(start="2019-01-01")
    )
    assert "got 'June'" in refusal(folder, rows, PecanStreetOptions(start="June"))
    assert "header has dataid and one of local_15min" in refusal(folder, [], header=["time", "grid"])


def test_a_file_that_is_not_there(folder):
    with pytest.raises(HemmaError, match="expected a readable file"):
        list_pecan_street_homes(folder / "none.csv")
