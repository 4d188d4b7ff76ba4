"""From the circuits of a Dataport home to PV, load and HVAC."""

from datetime import timedelta

import numpy as np
import pytest
from dataport_files import (
    HEADER,
    body,
    circuits,
    dataport,
    expected,
    instants,
    naive,
    read,
    refusal,
    row,
    same_series,
)

from hemma.data import PecanStreetOptions, list_pecan_street_homes


def test_a_circuit_without_a_value_is_not_instrumented_one_with_gaps_is(folder):
    """air2 is empty throughout: no air2. car1 has values once: where it is empty nobody knows."""
    options = PecanStreetOptions(exclude_cars=True)
    rows = body(192, car1=lambda k, v: "" if 20 <= k < 30 else 0.0)
    assert "2.5 hours missing from 2018-06-01T05:00:00-05:00 in load_kw" in refusal(folder, rows, options)
    same_series(read(folder, rows), read(folder, body(192)))


def test_cars_and_batteries_are_taken_out_when_asked(folder):
    def with_car_and_battery(k, values):
        return circuits(k)["grid"] + 3.0 * (k % 8 == 0) + 0.25

    changed = {
        "car1": lambda k, v: 3.0 * (k % 8 == 0),
        "battery1": lambda k, v: 0.25,
        "grid": with_car_and_battery,
    }
    plain = read(folder, body(192))
    both = read(folder, body(192, **changed), PecanStreetOptions(exclude_cars=True, exclude_battery=True))
    same_series(both, plain)
    kept = read(folder, body(192, **changed))
    assert kept.exogenous.load.sum() == pytest.approx(plain.exogenous.load.sum() + 48 * (3.0 / 8 + 0.25))
    assert any("has its own battery" in note for note in kept.notes)


def test_old_schema_has_use_and_gen(folder):
    header = ["dataid", "localhour", "use", "air1", "furnace1", "gen", "grid", "leg1v"]
    hours = instants(48, step=timedelta(hours=1))
    rows = [
        row(661, naive(t), {"use": 2.0 + k % 5, "gen": 1.0, "grid": 1.0 + k % 5, "air1": 0.75}, header)
        for k, t in enumerate(hours)
    ]
    traces = read(folder, rows, header=header)
    np.testing.assert_allclose(traces.exogenous.load, 1.25 + np.arange(48) % 5)
    np.testing.assert_allclose(traces.exogenous.pv_generation, 1.0)
    np.testing.assert_allclose(traces.hvac_power, 0.75)


def test_all_hvac_circuits_count(folder):
    nine = ["air1", "air2", "air3", "airwindowunit1", "furnace1", "furnace2", "heater1", "heater2", "heater3"]
    rows = [
        row(661, dataport(t), {"grid": 10.0, **{name: 2.0**-k for k, name in enumerate(nine)}})
        for t in instants(48)
    ]
    traces = read(folder, rows)
    np.testing.assert_allclose(traces.hvac_power, sum(2.0**-k for k in range(9)))
    np.testing.assert_allclose(traces.exogenous.load + traces.hvac_power, 10.0)


def test_a_home_without_hvac_circuits_keeps_it_in_the_load(folder):
    rows = [row(661, dataport(t), {"grid": 1.5}) for t in instants(48)]
    traces = read(folder, rows)
    assert traces.hvac_power is None
    assert any("no HVAC circuit is instrumented" in note for note in traces.notes)
    assert any("a home without PV" in note for note in traces.notes)


def test_noise_becomes_zero(folder):
    rows = body(192, solar=lambda k, v: -0.003 if v["solar"] == 0 else v["solar"],
                air1=lambda k, v: -0.002 if v["air1"] == 0 else v["air1"])  # fmt: skip
    traces = read(folder, rows)
    np.testing.assert_allclose(traces.exogenous.pv_generation, expected(192, "pv"), atol=1e-12)
    np.testing.assert_allclose(traces.hvac_power, expected(192, "hvac"), atol=1e-12)


def test_a_failed_current_transformer_is_told(folder):
    rows = body(192, grid=lambda k, v: -40.0 if k == 100 else v["grid"])
    traces = read(folder, rows)
    assert traces.exogenous.load.min() >= 0.5 - 1e-9
    assert any(
        "1 row left out in which use (grid + solar) is negative (lowest -40 kW)" in n for n in traces.notes
    )
    assert any("15 minutes interpolated from 2018-06-02T01:00:00-05:00 in load_kw" in n for n in traces.notes)


def test_a_turned_sensor_is_refused(folder):
    rows = body(192, solar=lambda k, v: -v["solar"])
    assert "expected solar of at least 0 kW" in refusal(folder, rows)


def test_homes_are_listed_with_what_is_instrumented(folder):
    path = folder / "15minute_data_austin.csv"
    rows = [*body(8, home=9278, car1=lambda k, v: 0.0), *body(96)]
    path.write_text("\n".join([",".join(HEADER), *rows]))
    header = "dataid,active_record,city,state,total_amount_of_pv\n"
    text = header + "Unique number,Yes,City,State,kW\n661,yes,Austin,Texas,5.2\n9278,yes,Peña,Texas,\n"
    (folder / "metadata.csv").write_bytes(text.encode("latin-1"))
    homes = list_pecan_street_homes(path, folder / "metadata.csv")
    assert [(h.home, h.rows, h.city, h.pv_peak_power) for h in homes] == [
        (661, 96, "Austin", 5.2),
        (9278, 8, "Peña", None),
    ]
    assert [(h.has_pv, h.has_hvac, h.has_car, h.has_battery) for h in homes] == [
        (True, True, False, False),
        (True, True, True, False),
    ]
    assert (homes[0].first, homes[0].last) == ("2018-06-01T05:00:00+00:00", "2018-06-02T04:45:00+00:00")
