"""Maps of rewards whose wishes are known: axes in physical units, and the wishes where they should be."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.evaluation.reward_maps import (
    Grid,
    Varied,
    answers,
    outdoor_and_indoor,
    preferred,
    price_and_energy,
)
from hemma.home import Home, HomeState, observe, paper_state
from hemma.irl.learned_reward import LearnedReward
from hemma.irl.reward import ShapedReward
from hemma.rl.policies.scaling import StateScaler
from hemma.types import Exogenous

PRICE, INDOOR = 5, 4
CENTRE = jnp.asarray([1.0, 0.5, 3.0, 30.0, 24.0, 0.12])
SPREAD = jnp.asarray([1.0, 0.3, 2.0, 4.0, 1.0, 0.05])
GRID = Grid(np.linspace(0.02, 0.32, 16), np.linspace(0.7, 5.9, 5))


def days():
    hour = np.arange(48) % 24.0
    flat = np.ones(48)
    return Exogenous(flat, 0.5 * flat, 25 + hour / 2, 0.1 * flat, 0.09 * flat, hour)


def blank(hidden=2):
    """g = h = 0."""
    head = jax.tree.map(jnp.zeros_like, ShapedReward.random((hidden,), 0.9, jax.random.key(0)))
    return LearnedReward(head, StateScaler(CENTRE, SPREAD))


def trader():
    """g = b(p + a) - b(p - a), b(x) = tanh(x + 1) - tanh(x - 1): charges where the price's feature p < 0."""
    signs = jnp.asarray([1.0, 1.0, -1.0, -1.0])
    weight = jnp.zeros((4, 10)).at[:, PRICE].set(1.0).at[:, 8].set(signs)
    head = (jnp.asarray([1.0, -1.0, 1.0, -1.0]), jnp.asarray([[1.0, -1.0, -1.0, 1.0]]))
    return eqx.tree_at(
        lambda r: (
            r.head.approximator.weights[0],
            r.head.approximator.biases[0],
            r.head.approximator.weights[1],
        ),
        blank(hidden=4),
        (weight, *head),
    )


def stacked(*rewards):
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *rewards)


def test_axes_in_physical_units_invert_the_scaler():
    moment = price_and_energy(days(), 15.0, GRID, Home())
    state = HomeState(
        moment.battery_energy,
        Home().thermal_model.initial(moment.indoor_temperature),
        jnp.zeros((5, 16)),
        jnp.zeros((5, 16), int),
    )
    states = paper_state(observe(state, moment.now))
    scaler = StateScaler(CENTRE, SPREAD)
    np.testing.assert_allclose(scaler.quantities(scaler(states)), states[..., :6], rtol=1e-4)
    np.testing.assert_allclose(scaler.quantities(scaler(states))[0, :, PRICE], GRID.x, rtol=1e-4)
    np.testing.assert_allclose(scaler.quantities(scaler(states))[:, 0, 2], GRID.y, rtol=1e-4)


def test_a_reward_that_charges_below_a_price_is_seen_to_do_so_at_that_price():
    found = answers(stacked(trader()), Home(), price_and_energy(days(), 15.0, GRID, Home()), Varied.BATTERY)
    wanted = np.asarray(preferred(found.battery_power, found.ground))[0]
    middle = wanted[2]  # half full: 2.5 kW and more is feasible both ways
    assert (middle[GRID.x < 0.115] > 2.0).all()
    assert (middle[GRID.x > 0.125] < -2.0).all()
    assert wanted[0].max() > 2.0 > -wanted[0].min()  # nearly empty: it can charge and hardly discharge


def test_without_shaping_r_is_g():
    found = answers(stacked(trader()), Home(), price_and_energy(days(), 3.0, GRID, Home()), Varied.BATTERY)
    np.testing.assert_array_equal(found.ground, found.reward)


def test_shaping_pays_for_where_the_slot_ends():
    """g = 0 and h(s) = -T_in's feature: r pays best what ends coolest, g cares for nothing."""
    weight = jnp.zeros((2, 8)).at[0, INDOOR].set(0.1)
    cool = eqx.tree_at(
        lambda r: (r.head.shaping.weights[0], r.head.shaping.weights[1]),
        blank(),
        (weight, jnp.asarray([[-1.0, 0.0]])),
    )
    grid = Grid(np.linspace(28.0, 36.0, 4), np.linspace(22.0, 25.0, 3))
    found = answers(stacked(cool), Home(), outdoor_and_indoor(days(), 15.0, grid, Home()), Varied.HVAC)
    ends = np.asarray(found.next_temperature)
    np.testing.assert_array_equal(preferred(found.next_temperature, found.reward)[0], ends.min(axis=-1))
    assert np.ptp(np.asarray(found.ground)) == 0.0


def test_an_hvac_fraction_of_nothing_ends_at_the_edge_of_comfort():
    grid = Grid(np.linspace(28.0, 36.0, 4), np.linspace(23.0, 24.5, 3))
    found = answers(stacked(blank()), Home(), outdoor_and_indoor(days(), 15.0, grid, Home()), Varied.HVAC)
    ends = np.asarray(found.next_temperature)
    np.testing.assert_allclose(ends[..., ends.shape[-1] // 2], 24.0, atol=1e-3)


def test_an_hour_that_no_slot_begins_is_refused():
    with pytest.raises(HemmaError, match=r"begins a slot of the traces, got 3\.5"):
        price_and_energy(days(), 3.5, GRID, Home())
