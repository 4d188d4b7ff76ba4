"""Single cells: sentinels, spikes, prices out of this world, stuck sensors; and what must pass."""

from contextlib import suppress

import numpy as np
import pytest
from canonical_files import FULL, refusal, stamps, sun
from dataport_files import body, instants, weather_file
from dataport_files import read as read_dataport
from dataport_files import refusal as dataport_refusal
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hemma.data import load_austin2021, read_canonical, write_canonical
from hemma.data.clock import Clock
from hemma.data.columns import Columns
from hemma.data.outliers import stuck_cells, unusual_cells
from hemma.data.plausibility import require_plausible
from hemma.errors import HemmaError

AT = 300
MOMENT = "2021-06-13T12:00:00-06:00"


def log(changes=(), count=480):
    """Twenty days of a home in order; ``changes`` are (column, slot, value)."""
    names = FULL.split(",")
    table = []
    for k, t in enumerate(stamps(count)):
        hour = k % 24
        load = 0.3 + 0.2 * (hour > 17) + 0.01 * (k % 7)
        price = 0.1 + 0.1 * (16 <= hour < 20)
        table.append([t, sun(t) / 2, load, 25 + hour / 4 + k % 3, price, 0.9 * price, 23 + k % 5 / 4, k % 4])
    for column, slot, value in changes:
        table[slot][names.index(column)] = value
    return [",".join(map(str, row)) for row in table]


ORDERLY = log()


def one(column, value):
    return log([(column, AT, value)])


CLOCK = Clock(int(np.datetime64("2021-06-01T06:00", "s").astype(int)), 3600, np.full(480, -6.0))


def series(column, changes=()):
    """A column of the home in order, without a file."""
    index = FULL.split(",").index(column)
    values = np.array([row.split(",")[index] for row in ORDERLY], float)
    for slot, value in changes:
        values[slot] = value
    return values


def problem(column, values):
    with pytest.raises(HemmaError) as caught:
        require_plausible("home.csv", Columns(CLOCK, {column: values}))
    return str(caught.value)


def odd(notes):
    return [note for note in notes if "stand" in note or "is exactly" in note]


def test_a_home_in_order_has_no_odd_cells(write):
    assert read_canonical(write(log(), FULL)).notes == ()


@pytest.mark.parametrize("column", ["load_kw", "pv_kw", "hvac_kw"])
@pytest.mark.parametrize("value", [15234.7, 201.5, 4.2e9, 1e308])
def test_one_absurd_power_is_a_cell_not_a_unit(column, value):
    message = problem(column, series(column, [(AT, value)]))
    assert message.startswith(
        f"home.csv: one slot of {column} is not to be believed, {value:.6g} kW at {MOMENT}"
    )
    assert "expected 0 to 200 kW" in message
    assert message.endswith("Empty the cell")
    assert "Divide" not in message


def test_it_is_told_how_many_times_the_median_it_is(write):
    assert f"15000 kW at {MOMENT}, 7500 times the median" in refusal(write(one("hvac_kw", 15000.0), FULL))


def test_a_counter_that_runs_backwards_is_a_cell_not_a_sign(write):
    message = refusal(write(one("load_kw", -15234.7), FULL))
    assert f"one slot of load_kw is not to be believed, -15234.7 kW at {MOMENT}" in message
    assert "sign" not in message
    turned = [("pv_kw", k, -1000.0 * sun(t)) for k, t in enumerate(stamps(480))]
    assert "this looks like W. Divide by 1000" in refusal(write(log(turned), FULL))


def test_several_absurd_cells_are_counted(write):
    message = refusal(write(log([("load_kw", 20, 900.5), ("load_kw", AT, 1200.5)]), FULL))
    assert "2 slots of load_kw are not to be believed, 1200.5 kW at" in message
    assert "(the first at 2021-06-01T20:00:00-06:00)" in message
    assert message.endswith("Empty these cells")


def test_most_of_a_column_out_of_scale_is_a_unit(write):
    in_watts = [("load_kw", k, 350.0 + k % 7) for k in range(480)]
    assert "this looks like W. Divide by 1000" in refusal(write(log(in_watts), FULL))
    part = refusal(write(log(in_watts[:200]), FULL))
    assert "Divide" not in part
    assert part.endswith("A part of the column in another unit? Convert it, or empty these cells")


@pytest.mark.parametrize("column", FULL.split(",")[1:])
@pytest.mark.parametrize(
    "value", [-999, -9999, -999.9, 999, 9999, 999.9, 99.99, 99999, 32767, -32768, 65535, 3276.7]
)
def test_sentinels_are_named_as_such(column, value):
    for slots in ([AT], [AT, AT + 1, AT + 9, 7, 8, 9, 10], range(50, 270)):
        message = problem(column, series(column, [(slot, value) for slot in slots]))
        count = "one slot" if len(slots) == 1 else f"{len(slots)} slots"
        assert message.startswith(f"home.csv: {count} of {column} ")
        assert f"A sentinel: loggers write {value:g} where they have no value. Empty the" in (
            message.replace("these", "the")
        )


def test_a_sentinel_in_a_file_is_named_with_its_time(write):
    message = refusal(write(one("load_kw", -999), FULL))
    assert f"one slot of load_kw is not to be believed, -999 kW at {MOMENT}" in message


@pytest.mark.parametrize("value", [85, -127, 127, 71.3, -91])
def test_temperatures_that_do_not_occur(value):
    for column in ("outdoor_c", "indoor_c"):
        message = problem(column, series(column, [(AT, value)]))
        assert f"one slot of {column} is not to be believed, {value} degC at {MOMENT}" in message
        assert "Empty the cells of the failed sensor" in message


@pytest.mark.parametrize(
    ("column", "value", "told"),
    [
        ("load_kw", 150, "150 kW at 2021-06-13T12:00:00-06:00, 441 times the median"),
        ("pv_kw", 60, "60 kW at"),
        ("hvac_kw", 120, "120 kW at"),
        ("buy_per_kwh", 9.0, "9 per kWh at 2021-06-13T12:00:00-06:00, 90 times the median"),
        ("sell_per_kwh", -9.0, "-9 per kWh at"),
        ("buy_per_kwh", 25.0, "25 per kWh at"),
        ("outdoor_c", -2, "-2 degC at"),
        ("outdoor_c", 55, "55 degC at"),
        ("indoor_c", 0, "0 degC at"),
    ],
)
def test_milder_spikes_are_told(column, value, told):
    values = series(column, [(AT, value)])
    require_plausible("home.csv", Columns(CLOCK, {column: values}))
    [note] = unusual_cells(column, CLOCK, values)
    assert note.startswith(f"one slot of {column} stands out, {told}")


def test_hours_of_cold_in_summer_are_told():
    values = series("outdoor_c", [(slot, -50) for slot in range(50, 60)])
    [note] = unusual_cells("outdoor_c", CLOCK, values)
    assert note.startswith("10 slots of outdoor_c stand out, -50 degC at 2021-06-03T02:00:00-06:00")


def test_a_spike_is_told_in_the_notes_of_a_file(write):
    notes = odd(read_canonical(write(one("load_kw", 150), FULL)).notes)
    assert notes == [
        f"one slot of load_kw stands out, 150 kW at {MOMENT}, 441 times the median: is it right? "
        "If not, empty it"
    ]


@pytest.mark.parametrize("column", ["buy_per_kwh", "sell_per_kwh"])
@pytest.mark.parametrize("value", [1e6, 1e308, 187.0, -1e6, 31.0])
def test_prices_out_of_this_world_are_refused(column, value):
    message = problem(column, series(column, [(AT, value)]))
    assert f"one slot of {column} is not to be believed, {value:.6g} per kWh at {MOMENT}" in message
    assert "expected at most 30 per kWh, or 100 times the median" in message


def test_days_of_scarcity_are_told_and_read(write):
    scarce = [("buy_per_kwh", k, 9.1 - 0.01 * (k % 24)) for k in range(200, 296)]
    read = read_canonical(write(log(scarce), FULL))
    assert read.exogenous.buying_price[200:296].min() > 8.8
    assert odd(read.notes)[0].startswith("96 slots of buy_per_kwh stand out, 9.1 per kWh at")


@pytest.mark.parametrize(
    ("column", "value", "hours", "told"),
    [
        ("load_kw", 0.41, 36, "load_kw is exactly 0.41 kW for 36 hours from 2021-06-09T08:00:00-06:00"),
        ("outdoor_c", 21.5, 48, "outdoor_c is exactly 21.5 degC for 48 hours from"),
        ("indoor_c", 21.5, 72, "indoor_c is exactly 21.5 degC for 72 hours from"),
        ("pv_kw", 0.7, 24, "pv_kw is exactly 0.7 kW for 24 hours from"),
        ("hvac_kw", 1.3, 60, "hvac_kw is exactly 1.3 kW for 60 hours from"),
        ("load_kw", 0, 100, "load_kw is exactly 0 kW for 100 hours from"),
        ("pv_kw", 0, 100, None),
        ("hvac_kw", 0, 200, None),
        ("indoor_c", 21.5, 48, None),
        ("outdoor_c", 21.5, 20, None),
        ("buy_per_kwh", 0.13, 250, None),
    ],
)
def test_stuck_sensors_are_told(column, value, hours, told):
    stuck = series(column, [(200 + k, value) for k in range(hours)])
    notes = stuck_cells(column, CLOCK, stuck)
    assert [note.startswith(told) for note in notes] == [True] if told else notes == []


def test_a_load_that_never_changes_is_told(write):
    read = read_canonical(write(log([("load_kw", k, 0.5) for k in range(480)]), FULL))
    assert odd(read.notes)[0].startswith("load_kw is exactly 0.5 kW for 480 hours")


def test_a_load_of_some_watts_is_told(write):
    read = read_canonical(write(log([("load_kw", k, 0.0004 + 0.0001 * (k % 3)) for k in range(480)]), FULL))
    assert "load_kw is at most 0.0006 kW: is it in kW?" in read.notes


def test_the_embedded_homes_have_no_odd_cells(tmp_path):
    for home in (2, 4):
        write_canonical(load_austin2021(home), tmp_path / "home.csv")
        assert read_canonical(tmp_path / "home.csv").notes == ()


def test_an_absurd_circuit_is_named_before_it_is_averaged(folder):
    rows = body(192, grid=lambda k, v: 15234.7 if k == 101 else v["grid"])
    message = dataport_refusal(folder, rows)
    assert "home 661: one slot of load_kw is not to be believed, 15234.6 kW" in message
    assert "at 2018-06-02T01:15:00-05:00" in message


def test_weather_and_prices_are_named_by_their_own_file(folder):
    weather = weather_file(folder, "2018-06-01T00:00+00:00", 72)
    lines = weather.read_text().splitlines()
    weather.write_text("\n".join([*lines[:20], lines[20].replace(",25", ",-999"), *lines[21:]]))
    message = dataport_refusal(folder, body(192), weather=weather)
    assert message.startswith(
        f"{weather}: one slot of outdoor_c is not to be believed, -999 degC at 2018-06-01T19"
    )
    prices = folder / "p.csv"
    rows = [f"{t.isoformat()},{9999 if k == 30 else 0.1}" for k, t in enumerate(instants(300))]
    prices.write_text("\n".join(["time,buy_per_kwh", *rows]))
    assert dataport_refusal(folder, body(192), prices=prices).startswith(f"{prices}: one slot of buy_per_kwh")
    prices.write_text(prices.read_text().replace("9999", "0.2"))
    assert read_dataport(folder, body(192), prices=prices).exogenous.buying_price.max() < 0.2


@settings(max_examples=30)
@given(seed=st.integers(0, 2**32 - 1), peak=st.floats(1.0, 22.0), scale=st.floats(0.1, 3.0))
def test_loads_of_real_homes_are_not_refused(seed, peak, scale):
    """Cars, saunas and ovens: some hours far above the rest."""
    draw = np.random.default_rng(seed)
    load = scale * draw.gamma(2.0, 0.2, 480)
    load[draw.integers(0, 480, 10)] = peak
    require_plausible("home.csv", Columns(CLOCK, {"load_kw": load}))


@settings(max_examples=30)
@given(values=arrays(float, 480), column=st.sampled_from(FULL.split(",")[1:]))
def test_no_numbers_break_the_checks(values, column):
    """Any floats, NaN and infinities too: refused or not, without an overflow."""
    values = np.where(np.isinf(values), np.nan, values)
    with suppress(HemmaError):
        require_plausible("home.csv", Columns(CLOCK, {column: values}))
