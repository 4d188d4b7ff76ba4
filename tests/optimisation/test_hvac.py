"""The upper level against the comfort law, linear programmes and models it was not made for."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from hemma.home import ExplicitThermalModel, Home, Hvac, ThermalState, benchmark_home
from hemma.optimisation.hvac import DESCENT, DescentSettings, HvacPlan, plan_hvac
from hemma.types import Exogenous


def weather(outdoor: np.ndarray, slot_length: float = 1.0) -> Exogenous:
    none = np.zeros(len(outdoor))
    hour = np.arange(len(outdoor)) * slot_length % 24.0
    return Exogenous(none, none + 0.5, outdoor, none + 0.1, none + 0.09, hour)


def heat(slots: int, mean: float, seed: int, slot_length: float = 1.0) -> np.ndarray:
    hours = np.arange(slots) * slot_length
    noise = np.random.default_rng(seed).normal(0, 1.5, slots)
    return mean + 7 * np.sin((hours - 9) * np.pi / 12) + noise


def planned(home: Home, outdoor: np.ndarray, settings: DescentSettings = DESCENT) -> HvacPlan:
    with jax.enable_x64(True):
        plan = plan_hvac(home, weather(outdoor, home.slot_length), home.reset().thermal, settings)
    return jax.tree.map(np.asarray, plan)


def least_deviation_then_energy(home: Home, outdoor: np.ndarray) -> tuple[float, float]:
    """Least sum of X3 of the explicit model, and the least sum of h among its minimisers (SciPy)."""
    model, n = home.thermal_model, len(outdoor)
    eps, sign = model.inertia, 1.0 if home.hvac.heats else -1.0
    free, T = np.empty(n), home.initial_temperature
    for t in range(n):
        free[t] = T = eps * T + (1 - eps) * outdoor[t]
    lag = np.arange(n)[:, None] - np.arange(n)[None, :]
    per_power = sign * (1 - eps) * model.efficiency / model.conductance
    G = np.where(lag >= 0, per_power * eps ** np.maximum(lag, 0), 0.0)
    eye, zero = np.eye(n), np.zeros((n, n))
    A = np.block([[G, -eye, zero], [-G, zero, -eye]])
    b = np.concatenate([home.comfort.high - free, free - home.comfort.low])
    box = [(0, home.hvac.max_power)] * n + [(0, None)] * (2 * n)
    X3, energy = np.repeat([0.0, 1.0, 1.0], n), np.repeat([1.0, 0.0, 0.0], n)
    least = linprog(X3, A, b, bounds=box).fun
    within = linprog(energy, np.vstack([A, X3]), np.append(b, least + 1e-9), bounds=box)
    return least, within.fun


def explicit(inertia: float, slot_length: float, max_power: float, heats: bool) -> Home:
    model = ExplicitThermalModel(inertia=inertia).at_slot_length(slot_length)
    return Home(thermal_model=model, hvac=Hvac(max_power, heats), slot_length=slot_length)


@pytest.mark.parametrize("heats", [False, True])
def test_where_comfort_can_be_held_slot_by_slot_it_is_the_comfort_law(heats):
    home = Home(hvac=Hvac(heats=heats))
    outdoor = heat(480, 11.0 if heats else 30.0, 1)
    plan = planned(home, outdoor)
    T = np.concatenate([[23.0], plan.indoor_temperature[:-1]])
    T, T_out, upp = (-T, -outdoor, -19.0) if heats else (T, outdoor, 24.0)
    law = np.clip((0.7 * T + 0.3 * T_out - upp) * 0.252 / (0.3 * 2.5), 0, 2.0)
    np.testing.assert_allclose(plan.hvac_power, law, atol=1e-9)
    assert plan.converged
    assert plan.iterations == 2


@settings(max_examples=15)
@given(
    seed=st.integers(0, 1000),
    inertia=st.sampled_from([0.5, 0.7, 0.95]),
    slot_length=st.sampled_from([0.25, 1.0]),
    max_power=st.sampled_from([1.0, 1.4]),
    heats=st.booleans(),
)
def test_saturated_days_are_precooled_with_least_deviation_and_then_least_energy(
    seed, inertia, slot_length, max_power, heats
):
    home = explicit(inertia, slot_length, max_power, heats)
    outdoor = heat(60, 12.0 if heats else 31.0, seed, slot_length)
    plan = planned(home, outdoor)
    T = plan.indoor_temperature
    deviation = np.sum(np.maximum(T - 24, 0) + np.maximum(19 - T, 0))
    least, energy = least_deviation_then_energy(home, outdoor)
    assert plan.converged
    assert deviation == pytest.approx(least, abs=1e-6)
    assert np.sum(plan.hvac_power) == pytest.approx(energy, abs=1e-4)


def test_a_hot_afternoon_is_met_by_full_power_just_before_it():
    home = explicit(0.9, 1.0, 1.5, False)
    outdoor = np.full(24, 30.0)
    outdoor[14:18] = 42.0
    plan = planned(home, outdoor)
    assert np.max(plan.indoor_temperature) <= 24 + 1e-9
    hold = (30 - 24) * 0.252 / 2.5
    np.testing.assert_allclose(plan.hvac_power[4:10], hold, atol=1e-9)
    early = np.flatnonzero(plan.hvac_power[:14] > hold + 1e-6)
    assert early[0] >= 10
    np.testing.assert_allclose(plan.hvac_power[early[1] : 18], 1.5, atol=1e-9)  # only the first is partial


def test_a_model_that_is_not_affine_takes_some_steps_and_says_when_it_may_not():
    class Saturating(ExplicitThermalModel):
        def __call__(self, state: ThermalState, drivers):
            used = jnp.tanh(0.7 * drivers.cooling_power)
            return super().__call__(state, eqx.tree_at(lambda d: d.cooling_power, drivers, used))

    home = Home(thermal_model=Saturating())
    outdoor = heat(96, 23.0, 2)
    plan = planned(home, outdoor)
    assert plan.converged
    assert plan.iterations > 2
    works = plan.hvac_power > 1e-9
    assert works.sum() > 30
    np.testing.assert_allclose(plan.indoor_temperature[works], 24.0, atol=1e-5)
    assert not planned(home, outdoor, DescentSettings(max_iterations=2)).converged


def test_padding_changes_nothing():
    home = explicit(0.9, 1.0, 1.2, False)
    hot = weather(heat(60, 34.0, 1))
    with jax.enable_x64(True):
        plain = plan_hvac(home, hot, home.reset().thermal)
        padded = plan_hvac(home, hot, home.reset().thermal, compiled_slots=100)
    assert plain.hvac_power.max() == pytest.approx(1.2)
    np.testing.assert_allclose(plain.hvac_power, padded.hvac_power, atol=1e-9)
    np.testing.assert_allclose(plain.indoor_temperature, padded.indoor_temperature, atol=1e-9)
    assert padded.converged


def test_batches_of_homes_plan_as_one_by_one():
    powers = jnp.array([0.9, 1.5, 2.0])
    outdoor = heat(48, 34.0, 3)

    def plan(power):
        home = dataclasses.replace(benchmark_home(), hvac=Hvac(power))
        return plan_hvac(home, weather(outdoor), home.reset().thermal).hvac_power

    with jax.enable_x64(True):
        batch = jax.vmap(plan)(powers.astype(float))
        for power, row in zip(powers, batch, strict=True):
            alone = planned(Home(hvac=Hvac(float(power))), outdoor)
            np.testing.assert_allclose(row, alone.hvac_power, atol=1e-6)
