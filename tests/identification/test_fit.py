"""Fitting: known buildings come back, on weather that training never saw."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.checkpoint import load_header, save_tree
from hemma.data import AUSTIN2021_HOMES, load_austin2021
from hemma.errors import HemmaError
from hemma.home import (
    AbstractThermalModel,
    ExplicitThermalModel,
    Home,
    Hvac,
    ThermalDrivers,
    ThermalState,
    benchmark_home,
)
from hemma.identification import (
    Excitation,
    Fit,
    IdentificationSettings,
    ThermalRecord,
    ThermalResponse,
    excite,
    fit,
    free_run,
    least_squares_response,
    load_model,
    save_model,
)

AUGUST = 61 * 24
FAR = ThermalResponse(heating=1.0, cooling=1.0, loss=0.1)
ENOUGH = IdentificationSettings(updates=700)
SMALL = IdentificationSettings(width=4, window=12.0, batch=8, updates=25, chunk=10, patience=2)
"""One set for all that needs no accuracy: it compiles once."""


class SunlitModel(AbstractThermalModel):
    """The explicit model and 0.5 degC/h per kW of PV."""

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        T = ExplicitThermalModel()(state, drivers).indoor_temperature + 0.5 * drivers.pv_generation
        return ThermalState(indoor_temperature=T, memory=T)


def excited(home: Home, first: int, last: int, seed: int = 0, traces: int = 1) -> ThermalRecord:
    exogenous = load_austin2021(traces).exogenous.window(first, last)
    return excite(home, exogenous, Excitation(), jax.random.key(seed))


def august(home: Home, traces: int = 1) -> ThermalRecord:
    return excited(replace(home, disturbance_deviation=0.0), AUGUST, 2208, 99, traces)


def month_error(model: AbstractThermalModel, test: ThermalRecord) -> float:
    """Root mean square error of a month of free run [degC]."""
    difference = free_run(model, test) - test.indoor_temperature
    return float(jnp.sqrt(jnp.mean(difference[1:] ** 2)))


@pytest.fixture(scope="module")
def fifteen_days() -> ThermalRecord:
    return excited(benchmark_home(), AUGUST - 360, AUGUST)


@pytest.fixture(scope="module")
def from_far(fifteen_days: ThermalRecord) -> Fit:
    """Trained from a third of the true response, so that the gradient has to find it."""
    return fit(fifteen_days, ENOUGH, jax.random.key(0), FAR)


@pytest.mark.slow
def test_gradient_alone_finds_the_building(from_far):
    model = from_far.model
    assert float(model.loss_share) == pytest.approx(0.3, abs=0.002)
    assert float(model.cooling_response) == pytest.approx(0.3 * 2.5 / 0.252, abs=0.01)
    assert month_error(model, august(benchmark_home())) < 0.02


def test_checkpoint_is_the_best_of_the_curve(from_far, fifteen_days):
    """Its validation error, taken anew window by window, is the least of the curve."""
    assert float(from_far.curve.validation[0]) > 1
    last = fifteen_days.window(288, 360)
    squares = []
    for start in range(72 - 48 + 1):
        window = last.window(start, start + 48)
        squares.append(np.asarray(free_run(from_far.model, window) - window.indoor_temperature)[1:] ** 2)
    assert np.sqrt(np.mean(squares)) == pytest.approx(float(from_far.curve.validation.min()), rel=1e-3)
    assert from_far.best_update == int(from_far.curve.updates[jnp.argmin(from_far.curve.validation)])


def test_sun_is_learned_by_the_network():
    """A gain that the physical part cannot know: the month in August is ten times better with f."""
    home = replace(benchmark_home(), thermal_model=SunlitModel())
    fitted = fit(excited(home, AUGUST - 360, AUGUST), ENOUGH, jax.random.key(0))
    test = august(home)
    physical = replace(fitted.model, weights=jax.tree.map(jnp.zeros_like, fitted.model.weights))
    assert month_error(fitted.model, test) < 0.05
    assert month_error(physical, test) > 0.3


@pytest.mark.slow
@pytest.mark.parametrize("disturbance", [0.0, 0.1])
@pytest.mark.parametrize("days", [61, 15])
@pytest.mark.parametrize("traces", AUSTIN2021_HOMES)
def test_a_month_of_free_run(traces, days, disturbance):
    """On each of the embedded homes, still or disturbed, 61 or 15 days: at most 0.05 degC in August."""
    home = replace(benchmark_home(), disturbance_deviation=disturbance)
    record = excited(home, AUGUST - 24 * days, AUGUST, seed=traces, traces=traces)
    fitted = fit(record, IdentificationSettings(), jax.random.key(traces))
    assert month_error(fitted.model, august(home, traces)) < 0.05


def test_a_small_improvement_keeps_the_physical_start(fifteen_days, from_far):
    """What training gained is less than was asked for, so the start comes back whole."""
    reached = float(from_far.curve.validation.min() / from_far.curve.validation[0])
    settings = replace(SMALL, least_improvement=1 - reached)
    fitted = fit(fifteen_days, settings, jax.random.key(0), FAR)
    assert float(fitted.curve.validation.min()) < float(fitted.curve.validation[0])
    assert fitted.best_update == 0
    assert float(fitted.model.cooling_response) == FAR.cooling
    assert float(fitted.model.loss_share) == pytest.approx(FAR.loss)


def test_least_squares_on_exact_data(fifteen_days):
    found = least_squares_response(fifteen_days)
    assert found.cooling == pytest.approx(0.3 * 2.5 / 0.252, abs=1e-4)
    assert found.loss == pytest.approx(0.3, abs=1e-5)
    assert found.heating == found.cooling  # never heated: the same machine


def test_least_squares_of_a_heated_home():
    home = replace(benchmark_home(0.25), hvac=Hvac(max_power=3.0, heats=True))
    found = least_squares_response(excited(home, 0, 500))
    assert found.heating == pytest.approx((1 - 0.7**0.25) * 2.5 / 0.252, abs=1e-4)
    assert found.loss == pytest.approx(1 - 0.7**0.25, abs=1e-5)
    assert found.cooling == found.heating


def test_wrong_signs_cannot_come_out_of_least_squares():
    """A log in which cooling seems to warm and the outside to push away: plain least squares believes it."""
    n = 200
    outdoor, power = np.full(n, 30.0), np.linspace(0, 1, n) ** 2
    T = np.empty(n + 1)
    T[0] = 22
    for t in range(n):
        T[t + 1] = T[t] + 0.05 * power[t] + 0.001 * (T[t] - outdoor[t])
    rows = np.stack([-power, outdoor - T[:-1]], axis=1)
    plain = np.linalg.lstsq(rows, np.diff(T), rcond=None)[0]
    assert (plain < 0).all()
    zeros = jnp.zeros(n)
    drivers = ThermalDrivers(
        jnp.asarray(outdoor, float), zeros, jnp.asarray(power, float), zeros, jnp.arange(float(n)) % 24, zeros
    )
    found = least_squares_response(ThermalRecord(drivers, jnp.asarray(T, float), 1.0))
    assert found.cooling >= 0.02
    assert found.loss >= 1 - np.exp(-1 / 500)


def test_same_key_same_model(fifteen_days):
    first, again, other = (fit(fifteen_days, SMALL, jax.random.key(k), FAR) for k in (1, 1, 2))
    jax.tree.map(np.testing.assert_array_equal, first, again)
    assert (first.curve.training != other.curve.training).any()


def test_validation_days_choose_nothing_but_the_checkpoint(fifteen_days):
    """Scales and start come from the first four fifths: the last fifth may say what it likes."""
    T = fifteen_days.indoor_temperature
    other = replace(fifteen_days, indoor_temperature=T.at[289:].add(5.0))
    first, second = (fit(record, SMALL, jax.random.key(0)).model for record in (fifteen_days, other))
    assert first.scaling == second.scaling
    assert first.start == second.start


def test_progress_and_early_stopping(fifteen_days):
    seen: list[tuple[int, int]] = []
    fit(fifteen_days, SMALL, jax.random.key(0), FAR, lambda done, total: seen.append((done, total)))
    assert seen == [(10, 25), (20, 25), (25, 25)]
    exact = fit(fifteen_days, SMALL, jax.random.key(0))  # nothing is better than the start
    assert exact.curve.updates.tolist() == [0, 10, 20]
    assert exact.best_update == 0


def test_a_loss_that_is_no_number_names_its_update(fifteen_days):
    absurd = replace(fifteen_days, indoor_temperature=1e25 * fifteen_days.indoor_temperature)
    with pytest.raises(HemmaError, match=r"no longer a finite number at update 1 of 25; lower learning_rate"):
        fit(absurd, SMALL, jax.random.key(0), FAR)


def test_a_record_too_short_for_the_windows_is_refused(fifteen_days):
    with pytest.raises(HemmaError, match="at least 240 h for windows of 48 h, got 100 h"):
        fit(fifteen_days.window(0, 100), IdentificationSettings(), jax.random.key(0))


def test_saved_models_come_back(from_far, tmp_path):
    path = tmp_path / "network.safetensors"
    save_model(path, from_far, seed=7)
    jax.tree.map(np.testing.assert_array_equal, load_model(path), from_far.model)
    header = load_header(path)
    assert (header["seed"], header["width"], header["slot_length_h"]) == (7, 16, 1.0)
    assert header["settings"]["window"] == 48.0
    assert header["validation_rmse_c"] == pytest.approx(float(from_far.curve.validation.min()))


def test_another_checkpoint_is_refused(tmp_path):
    path = tmp_path / "policy.safetensors"
    save_tree(path, {"weight": np.zeros(3)}, {"kind": "policy"})
    with pytest.raises(HemmaError, match="found a checkpoint of kind 'policy'"):
        load_model(path)
