"""A building corrected while the home runs: by hand, by regression, and where it is not as believed."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_sensors import Held, observation, watched, week

from hemma.control.adaptation import IN_TIME, LATE, CorrectedThermalModel, corrected, unadapted
from hemma.control.estimation import StateEstimator
from hemma.control.rolling import RollingPlanner
from hemma.control.sensors import faultless
from hemma.forecasting.outlook import Outlook, perfect
from hemma.home import ExplicitThermalModel, Home, Hvac, benchmark_home, replay_in_double
from hemma.home.comfort import observed_comfort_power
from hemma.home.precision import in_double
from hemma.types import Exogenous

HOME = benchmark_home()
LEAKY = eqx.tree_at(
    lambda h: h.thermal_model, HOME, ExplicitThermalModel(efficiency=2.5, conductance=1.3 * 0.252)
)
HEATED = Home(hvac=Hvac(heats=True))


def slot(outdoor, hour=12.0):
    zero = np.zeros(())
    return Exogenous(zero, zero, np.asarray(outdoor), zero, zero, np.asarray(hour))


def run(home, adapts, readings=None, believed=HOME, days=6):
    exogenous = week(24 * days)
    readings = faultless(exogenous) if readings is None else readings(faultless(exogenous))
    controller = watched(Held(believed), readings, adapts, believed)
    return replay_in_double(home, exogenous, controller, disturbances=readings.disturbance).steps


def deviation(steps):
    """Mean X3 once a day has passed [degC]."""
    return float(np.mean(steps.costs.temperature_deviation[24:]))


def test_the_uncertainty_beforehand_is_that_of_the_constants():
    """Explicit model: a = eps, b = -(1 - eps) eta / A."""
    found = np.sqrt(np.diag(unadapted(HOME).covariances[0]))
    np.testing.assert_allclose(found, [0.3 * 5 * 0.3, 0.3 * 0.3, 0.3 * 0.3 * 2.5 / 0.252], rtol=1e-5)


@given(st.lists(st.tuples(st.floats(20, 35), st.floats(0, 2), st.floats(-1, 1)), min_size=1, max_size=12))
@settings(max_examples=20)
def test_it_is_the_ridge_regression_on_all_slots_so_far(slots):
    """argmin sum (y - theta' phi)^2 / NOISE^2 + theta' P_0^-1 theta, solved at once."""
    with jax.enable_x64(True):
        adaptation = in_double(unadapted(in_double(HOME)))
        prior, rows, targets, T = np.asarray(adaptation.covariances[0]), [], [], 23.0
        for outdoor, power, error in slots:
            expected = 0.7 * T + 0.3 * (outdoor - 2.5 / 0.252 * power)
            after = expected + error
            readings = (jnp.asarray(T), jnp.asarray(after))
            adaptation = adaptation.learned(HOME, readings, slot(outdoor), jnp.asarray(power))
            rows.append([1.0, outdoor - T, -power])
            targets.append(error)
            T = after
        phi, y = np.array(rows), np.array(targets)
        theta = np.linalg.solve(phi.T @ phi / 0.2**2 + np.linalg.inv(prior), phi.T @ y / 0.2**2)
    np.testing.assert_allclose(adaptation.corrections[IN_TIME], theta, rtol=1e-5, atol=1e-7)


def test_a_reading_that_is_no_number_teaches_nothing():
    before = unadapted(HOME)
    readings = (jnp.asarray(23.0), jnp.asarray(jnp.nan))
    after = before.learned(HOME, readings, slot(30.0), jnp.asarray(1.0))
    for name in ("corrections", "covariances", "errors", "error"):
        np.testing.assert_array_equal(getattr(before, name), getattr(after, name))
    assert float(after.power) == 1.0


def test_where_nothing_is_wrong_it_changes_nothing():
    usual, adapting = (run(HOME, adapts) for adapts in (False, True))
    np.testing.assert_allclose(adapting.action.hvac_power, usual.action.hvac_power, atol=1e-9)


@pytest.mark.parametrize("share", [1.3, 0.7])
def test_a_building_that_leaks_more_or_less_is_known_after_a_day(share):
    other = eqx.tree_at(lambda h: h.thermal_model.conductance, HOME, share * 0.252)
    usual, adapting = (run(other, adapts) for adapts in (False, True))
    assert deviation(adapting) < 0.002
    if share > 1:
        assert deviation(usual) > 0.2
    else:  # it cools too much: the bill suffers, not the comfort
        assert np.sum(adapting.action.hvac_power) < 0.97 * np.sum(usual.action.hvac_power)


def lagging(weather):
    """Readings of T_in one slot late, and those of load, PV and weather too if ``weather``."""

    def late(readings):
        readings = eqx.tree_at(lambda r: r.lag, readings, jnp.ones((), int))
        seen, first = readings.exogenous, lambda x: jnp.concatenate([x[:1], x[:-1]])
        moved = eqx.tree_at(lambda e: e.outdoor_temperature, seen, first(seen.outdoor_temperature))
        return eqx.tree_at(lambda r: r.exogenous, readings, moved) if weather else readings

    return late


@pytest.mark.parametrize("weather", [False, True])
def test_late_readings_are_noticed_and_never_make_it_worse(weather):
    usual, adapting = (run(HOME, adapts, lagging(weather)) for adapts in (False, True))
    assert deviation(adapting) < deviation(usual)


def test_a_late_reading_is_brought_up_to_now():
    """The hypothesis that T_in alone is late is the one that holds, and the state in between is known."""
    with jax.enable_x64(True):
        home, adaptation, T, rng = (
            in_double(HOME),
            unadapted(in_double(HOME)),
            [24.0],
            np.random.default_rng(1),
        )
        outdoor, power = rng.uniform(25, 35, 60), rng.uniform(0, 2, 60)
        for t in range(60):
            T.append(0.7 * T[-1] + 0.3 * (outdoor[t] - 2.5 / 0.252 * power[t]))
            read = (jnp.asarray(T[max(t - 1, 0)]), jnp.asarray(T[t]))  # of T_t and T_{t+1}
            adaptation = adaptation.learned(home, read, slot(outdoor[t]), jnp.asarray(power[t]))
        now = float(adaptation.temperature(home, jnp.asarray(T[59]), slot(33.0)))
        assert int(adaptation.best) == LATE
    assert now == pytest.approx(T[60], abs=1e-3)


@pytest.mark.parametrize("kind", ["temperature_error", "disturbance"])
def test_noise_is_not_mistaken_for_another_building(kind):
    def noisy(readings):
        kicks = np.random.default_rng(0).normal(0, 0.3, 24 * 6)
        return eqx.tree_at(lambda r: getattr(r, kind), readings, kicks)

    usual, adapting = (run(HOME, adapts, noisy) for adapts in (False, True))
    assert deviation(adapting) < 1.1 * deviation(usual)


def test_heating_is_corrected_in_its_own_direction():
    """A heater of 70 % of the power believed: comfort asks for 1 / 0.7 of it."""
    with jax.enable_x64(True):
        home, adaptation = in_double(HEATED), unadapted(in_double(HEATED))
        T = 20.0
        for number in range(48):
            power = 1.0 + 0.5 * (number % 3)
            after = 0.7 * T + 0.3 * (5.0 + 0.7 * 2.5 / 0.252 * power)
            readings = (jnp.asarray(T), jnp.asarray(after))
            adaptation = adaptation.learned(home, readings, slot(5.0), jnp.asarray(power))
            T = after
        model = corrected(home, adaptation).thermal_model
        drivers = home.thermal_drivers(slot(5.0), jnp.asarray(1.2), jnp.zeros(()))
        found = model(model.initial(jnp.asarray(20.0)), drivers).indoor_temperature
        expected = 0.7 * 20.0 + 0.3 * (5.0 + 0.7 * 2.5 / 0.252 * 1.2)
    assert isinstance(model, CorrectedThermalModel)
    assert float(found) == pytest.approx(expected, abs=0.02)


def test_every_home_inside_a_controller_is_corrected():
    learned = (jnp.full((3, 3), 0.1), jnp.ones(()))  # theta, and an error as identified
    adaptation = eqx.tree_at(lambda a: (a.corrections, a.error), unadapted(HOME), learned)
    held = corrected(Held(HOME), adaptation)
    seen = observation(24.0, outdoor=30.0)
    assert isinstance(held.home.thermal_model, CorrectedThermalModel)
    usual, changed = (float(observed_comfort_power(home, seen)) for home in (HOME, held.home))
    assert usual != changed


def test_the_rolling_planner_adapts_as_well():
    period = jax.tree.map(np.asarray, week(72))
    forecasts = perfect(Outlook(period.window(0, 24), period, 1.0, 12.0))
    planner = RollingPlanner(HOME, forecasts)
    usual, adapting = (
        replay_in_double(LEAKY, period, StateEstimator(planner, HOME, adapts)).steps.costs
        for adapts in (False, True)
    )
    assert np.mean(usual.temperature_deviation[24:]) > 0.2
    assert np.mean(adapting.temperature_deviation[24:]) < 0.005
