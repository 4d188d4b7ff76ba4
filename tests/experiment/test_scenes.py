"""Each fault changes what it says and nothing else."""

import numpy as np
import pytest

from hemma.data import load_austin2021
from hemma.errors import HemmaError
from hemma.home import benchmark_home
from hemma.studies.robustness import scenes
from hemma.studies.robustness.faults import FaultSettings, faults
from hemma.studies.robustness.scenes import scene

PERIOD = load_austin2021(2).window(0, 24 * 40).exogenous
BEFORE = scene(benchmark_home(), PERIOD)


def met(happen, *facts, seed=3):
    return happen(*facts, BEFORE, np.random.default_rng(seed))


def unchanged(before, after, *names):
    return all(np.array_equal(getattr(before, name), getattr(after, name)) for name in names)


QUANTITIES = ("pv_generation", "load", "outdoor_temperature", "buying_price", "selling_price", "hour_of_day")


def test_a_disturbance_has_the_deviation_it_says():
    after = met(scenes.disturbed, 0.3)
    assert np.std(after.readings.disturbance) == pytest.approx(0.3, rel=0.1)
    assert after.exogenous is BEFORE.exogenous


def test_noise_blurs_what_is_read_and_not_what_happens():
    after = met(scenes.noisy, (0.3, 0.03, 0.1))
    assert unchanged(BEFORE.exogenous, after.exogenous, *QUANTITIES)
    assert np.std(after.readings.temperature_error) == pytest.approx(0.3, rel=0.1)
    assert np.std(after.readings.energy_error) == pytest.approx(0.03 * 5.4, rel=0.1)
    ratio = after.readings.exogenous.load / BEFORE.exogenous.load
    assert np.std(ratio) == pytest.approx(0.1, rel=0.1)
    assert unchanged(BEFORE.exogenous, after.readings.exogenous, "buying_price", "outdoor_temperature")


def test_late_sensors_show_the_slot_before_but_know_price_and_clock():
    after = met(scenes.late).readings
    np.testing.assert_array_equal(after.exogenous.load[1:], BEFORE.exogenous.load[:-1])
    assert unchanged(BEFORE.exogenous, after.exogenous, "buying_price", "hour_of_day")
    assert int(after.lag) == 1


def test_another_building_differs_in_its_constants_alone():
    model, other = BEFORE.home.thermal_model, met(scenes.rebuilt, (1.3, 0.7)).home.thermal_model
    assert other.conductance == pytest.approx(1.3 * model.conductance)
    time_constant = -1 / np.log([model.inertia, other.inertia])
    assert time_constant[1] == pytest.approx(0.7 * time_constant[0])
    assert other.efficiency == model.efficiency


def test_a_worn_battery_wastes_what_it_says():
    battery = met(scenes.worn, 0.85).home.battery
    assert (battery.charging_efficiency, battery.discharging_efficiency) == (0.85, 0.85)


@pytest.mark.parametrize("happen", [scenes.without_thermometer, scenes.without_battery_level])
def test_a_reading_is_missing_for_one_hour_of_each_day(happen):
    after = met(happen).readings
    missing = np.asarray(after.is_temperature_missing) | np.asarray(after.is_energy_missing)
    np.testing.assert_array_equal(missing.reshape(40, 24).sum(axis=1), 1)
    assert len(set(np.argmax(missing.reshape(40, 24), axis=1))) > 10
    assert met(happen).repaired == 40


def test_a_missing_price_is_the_last_one_read():
    after = met(scenes.without_price)
    read, true = after.readings.exogenous.buying_price, BEFORE.exogenous.buying_price
    held = np.flatnonzero(read != true)
    assert 30 <= len(held) <= 40  # some hours cost what the hour before cost
    np.testing.assert_array_equal(read[held], true[held - 1])
    assert after.repaired == 40  # also those that would have said the same
    np.testing.assert_array_equal(after.is_price_missing.reshape(40, 24).sum(axis=1), 1)
    assert set(held) <= set(np.flatnonzero(after.is_price_missing))
    assert unchanged(BEFORE.exogenous, after.exogenous, *QUANTITIES)


def test_price_spikes_are_real_and_known():
    after = met(scenes.spiked, (0.02, 10.0))
    ratio = np.asarray(after.exogenous.buying_price / BEFORE.exogenous.buying_price)
    assert set(np.round(ratio, 6)) == {1.0, 10.0}
    assert np.mean(ratio > 1) == pytest.approx(0.02, abs=0.015)
    assert unchanged(after.exogenous, after.readings.exogenous, *QUANTITIES)


def test_another_household_has_more_load_and_less_sun():
    after = met(scenes.another_household, 1.5).exogenous
    np.testing.assert_allclose(after.load, 1.5 * BEFORE.exogenous.load)
    np.testing.assert_allclose(after.pv_generation, BEFORE.exogenous.pv_generation / 1.5)


def test_of_no_magnitude_no_fault_changes_anything():
    nothing = dict.fromkeys(
        ("disturbance", "temperature_noise", "energy_noise", "demand_noise", "building", "spikes"), 0.0
    )
    none = FaultSettings(efficiency=0.95, household=1.0, **nothing)
    lasting = {"late sensors", "no thermometer", "no battery level", "no price"}
    for fault in faults(none):
        if fault.name in lasting:
            continue
        after = fault.happen(BEFORE, np.random.default_rng(0))
        assert unchanged(BEFORE.exogenous, after.exogenous, *QUANTITIES)
        assert unchanged(BEFORE.exogenous, after.readings.exogenous, *QUANTITIES)
        assert not np.any(after.readings.disturbance)
        assert after.home.thermal_model.inertia == pytest.approx(BEFORE.home.thermal_model.inertia)
        assert after.home.battery == BEFORE.home.battery


def test_the_same_seed_lets_the_same_go_wrong():
    a, b = met(scenes.without_price), met(scenes.without_price)
    np.testing.assert_array_equal(a.readings.exogenous.buying_price, b.readings.exogenous.buying_price)
    assert len({fault.name for fault in faults(FaultSettings())}) == 13


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        ({"building": 1.0}, "building < 1"),
        ({"efficiency": 0.0}, "0 < efficiency"),
        ({"spikes": 1.5}, "spikes <= 1"),
        ({"household": 0.0}, "household > 0"),
        ({"disturbance": -1.0}, "disturbance >= 0"),
    ],
)
def test_magnitudes_without_meaning_are_refused(wrong, expected):
    with pytest.raises(HemmaError, match=expected):
        FaultSettings(**wrong)
