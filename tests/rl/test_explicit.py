"""The explicit reward by hand, the choice of beta_T, and worlds whose best policy is known."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from paid_worlds import paid_task, played, two_price_traces

from companions import assert_alone_as_among_others
from hemma.checkpoint import save_tree
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.rl import training
from hemma.rl.environment import collect
from hemma.rl.explicit import (
    ExplicitLearning,
    ExplicitSettings,
    choose_comfort_price,
    comfort_prices,
    reward_unit,
    scaled_reward,
    usual_price,
)
from hemma.rl.policies.exploration import Exploration
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import ExplicitReward, explicit_task, stack
from hemma.types import Costs

LEARNER = ExplicitLearning(
    ExplicitSettings(
        iterations=150,
        exploration=Exploration((0.3, 0.3), (0.2, 0.1)),
        ppo=PPOSettings(rollouts=32, slots=24, hidden=(16,), learning_rate=3e-3, value_learning_rate=3e-3),
    )
)


def test_the_reward_is_the_papers():
    costs = Costs(jnp.asarray([0.3, -0.1]), jnp.asarray([0.01, 0.02]), jnp.asarray([0.0, 1.5]))
    np.testing.assert_allclose(ExplicitReward(jnp.asarray(2.0))(costs), [-0.31, 0.1 - 0.02 - 3.0], rtol=1e-6)


def test_learners_see_the_same_numbers_in_any_currency():
    dollars = two_price_traces()
    crowns = dataclasses.replace(
        dollars, buying_price=11 * dollars.buying_price, selling_price=11 * dollars.selling_price
    )
    home = Home()
    rewards = []
    for traces, price in ((dollars, 0.5), (crowns, 5.5)):
        task = explicit_task(home, home, traces, price, 0)
        policy = StochasticPolicy((8,), jax.random.key(0))
        rollout = collect(task.environment, policy, jnp.asarray([0.3, 0.3]), (12, 4), jax.random.key(1))
        ageing = rollout.costs.ageing  # k_e is a price too, and stays in dollars here
        rewards.append(
            scaled_reward(
                dataclasses.replace(
                    rollout, costs=dataclasses.replace(rollout.costs, ageing=jnp.zeros_like(ageing))
                ),
                task,
            )
        )
    np.testing.assert_allclose(rewards[0], rewards[1], rtol=1e-3, atol=1e-3)


def test_learners_are_paid_the_reward_but_for_what_no_policy_changes_day_by_day():
    """In currency, and with u (l - p) dt taken out, the sums differ by the worth of what is left in store."""
    traces, home = two_price_traces(), Home()
    task = explicit_task(home, home, traces, 0.5, 0)
    policy = StochasticPolicy((8,), jax.random.key(0))
    rollout = collect(task.environment, policy, jnp.asarray([0.8, 0.8]), (12, 4), jax.random.key(1))
    price = float(usual_price(task.environment))
    paid = np.asarray(scaled_reward(rollout, task)).sum(axis=0) * price * 3.0  # c^max is above h^max
    scaler, transitions = task.environment.scaler, rollout.transitions
    before, after = (scaler.quantities(f) for f in (transitions.features, transitions.next_features))
    unavoidable = (before[..., 5] * (before[..., 1] - before[..., 0])).sum(axis=0)
    left = price * (after[-1, :, 2] - before[0, :, 2])
    reward = task.teacher(rollout.costs).sum(axis=0)
    np.testing.assert_allclose(paid, reward + unavoidable + left, rtol=1e-3, atol=1e-3)


def test_the_usual_price_hardly_knows_scarcity():
    traces = two_price_traces()
    spiked = np.asarray(traces.buying_price).copy()
    spiked[3] = 100.0
    tasks = (
        explicit_task(Home(), Home(), dataclasses.replace(traces, buying_price=price), 0.5, 0)
        for price in (traces.buying_price, spiked)
    )
    ordinary, scarce = (float(usual_price(task.environment)) for task in tasks)
    np.testing.assert_allclose(ordinary, 0.275, rtol=1e-5)
    np.testing.assert_allclose(scarce, ordinary, rtol=0.05)


def test_neither_the_unit_nor_the_usual_price_reads_padding():
    long = explicit_task(Home(), Home(), two_price_traces(6), 0.5, 0)
    short = explicit_task(Home(), Home(), two_price_traces(2), 0.5, 0)
    padded = jax.tree.map(lambda x: x[1], stack([long, short]))
    for measure in (usual_price, reward_unit):
        np.testing.assert_allclose(measure(padded.environment), measure(short.environment), rtol=1e-6)


def test_prices_of_comfort_are_multiples_of_the_hvacs_energy():
    values = comfort_prices(Home(), two_price_traces(), (1.0, 4.0))
    mean = float(np.mean(two_price_traces().buying_price))
    np.testing.assert_allclose(values, [2 * mean, 8 * mean], rtol=1e-6)


def test_the_cheapest_that_keeps_comfort_is_chosen_else_the_most_comfortable():
    prices, regrets = np.array([1.0, 2.0, 3.0]), np.array([0.1, 2.0, 3.0])
    assert choose_comfort_price(prices, regrets, np.array([0.5, 0.01, 0.0]), 0.02) == 2.0
    assert choose_comfort_price(prices, regrets, np.array([0.5, 0.3, 0.4]), 0.02) == 2.0


@pytest.mark.parametrize("iterations", [0, 30])
def test_settings_without_meaning_are_refused(iterations):
    with pytest.raises(HemmaError, match="iterations a multiple of 25"):
        ExplicitSettings(iterations=iterations)


@pytest.mark.slow
def test_one_step_world_without_a_price_of_comfort_the_hvac_is_off():
    acted = played(LEARNER, comfort_price=0.0)
    assert float(acted.action.hvac_power.mean()) < 0.1


@pytest.mark.slow
def test_state_matters_world_comfort_at_any_price_is_held_hot_or_cool():
    acted = played(LEARNER, comfort_price=50.0)
    assert float(acted.costs.temperature_deviation[12:].mean()) < 0.05
    hot = acted.state.thermal.indoor_temperature
    assert float(hot.mean()) > 19.0


def test_discounting_world_the_battery_is_filled_at_night_for_the_day():
    acted = played(LEARNER, comfort_price=50.0)
    hour = np.arange(acted.action.battery_power.shape[0]) % 24
    energy = np.asarray(acted.state.battery_energy)
    assert energy[hour == 5].mean() > energy[hour == 17].mean() + 2.0


def test_a_run_is_the_same_alone_and_among_others(monkeypatch):
    assert_alone_as_among_others(paid_task, LEARNER, monkeypatch)


@pytest.mark.parametrize("header", [{}, {"chunks": "two"}, {"chunks": -1}])
def test_a_training_under_way_with_a_damaged_header_is_refused(tmp_path, header):
    save_tree(tmp_path / "half.safetensors", {"a": np.zeros(1)}, header)
    with pytest.raises(HemmaError, match="expected a training under way"):
        training.load(tmp_path / "half.safetensors", paid_task(), LEARNER)
