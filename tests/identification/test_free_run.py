"""Free-run errors against what NumPy says about models with known errors."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.home import AbstractThermalModel, ExplicitThermalModel, ThermalDrivers, ThermalState
from hemma.identification import ThermalRecord, free_run, free_run_errors


class Persistence(AbstractThermalModel):
    """A building whose temperature never changes."""

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        return state


def record(slots: int, slot_length: float) -> ThermalRecord:
    rng = np.random.default_rng(0)
    values = jnp.asarray(rng.uniform(0, 2, (6, slots)), float)
    drivers = ThermalDrivers(*values)
    return ThermalRecord(drivers, jnp.asarray(20 + rng.normal(size=slots + 1), float), slot_length)


@pytest.mark.parametrize(("slot_length", "slots_an_hour"), [(1.0, 1), (0.5, 2), (0.25, 4)])
def test_errors_of_persistence(slot_length, slots_an_hour):
    """It errs by T(t + horizon) - T(t), at the horizon over all starts, and by T(t) - T(0) over the whole."""
    data = record(30 * slots_an_hour, slot_length)
    T = np.asarray(data.indoor_temperature, float)
    errors = free_run_errors(Persistence(), data)
    for error, hours in ((errors.one_hour, 1), (errors.six_hours, 6), (errors.day, 24)):
        k = hours * slots_an_hour
        assert error == pytest.approx(np.sqrt(np.mean((T[k:] - T[:-k]) ** 2)), rel=1e-5)
    assert errors.month == pytest.approx(np.sqrt(np.mean((T[1:] - T[0]) ** 2)), rel=1e-5)


def test_free_run_forgets_all_measurements_but_the_first():
    data = record(100, 1.0)
    model = ExplicitThermalModel()
    predicted = free_run(model, data)
    state = model.initial(data.indoor_temperature[0])
    for t in range(100):
        state = model(state, jax.tree.map(lambda x, t=t: x[t], data.drivers))
        assert float(predicted[t + 1]) == pytest.approx(float(state.indoor_temperature), abs=1e-4)
    assert predicted[0] == data.indoor_temperature[0]


def test_a_record_shorter_than_a_day_is_refused():
    with pytest.raises(HemmaError, match="at least 24 h, got 20 slots of 1 h"):
        free_run_errors(Persistence(), record(20, 1.0))
