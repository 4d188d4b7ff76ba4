"""What is learned with one battery, read with another."""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hemma.home import Battery
from hemma.rl.carry_over import carried_over
from hemma.rl.policies.scaling import StateScaler

SCALER = StateScaler(
    jnp.asarray([1.0, 0.5, 2.0, 30.0, 24.0, 0.1]), jnp.asarray([1.0, 0.3, 1.5, 4.0, 1.0, 0.05])
)


def state(energy):
    return jnp.asarray([2.0, 0.7, energy, 33.0, 23.5, 0.2, 15.0])


@given(share=st.floats(0.0, 1.0), low=st.floats(0.0, 3.0), capacity=st.floats(1.0, 30.0))
def test_the_same_share_of_the_battery_looks_the_same_and_so_does_all_else(share, low, capacity):
    origin = Battery()
    target = Battery(max_energy=low + capacity, min_energy=low, initial_energy=low)
    here = origin.min_energy + share * (origin.max_energy - origin.min_energy)
    there = low + share * capacity
    carried = carried_over(SCALER, origin, target)
    np.testing.assert_allclose(carried(state(there)), SCALER(state(here)), atol=1e-4)


def test_the_same_battery_changes_nothing():
    carried = carried_over(SCALER, Battery(), Battery())
    np.testing.assert_allclose(carried(state(3.3)), SCALER(state(3.3)), rtol=1e-6)


def test_stacked_runs_are_carried_over_one_by_one():
    stacked = jax.tree.map(
        lambda a, b: jnp.stack([a, b]), SCALER, StateScaler(2 * SCALER.centre, SCALER.spread)
    )
    target = Battery(max_energy=12.0, min_energy=1.2, initial_energy=2.4)
    carried = carried_over(stacked, Battery(), target)
    np.testing.assert_allclose(carried.centre[:, 2], [4.0, 8.0], rtol=1e-6)
    np.testing.assert_allclose(carried.spread[:, 2], [3.0, 3.0], rtol=1e-6)
