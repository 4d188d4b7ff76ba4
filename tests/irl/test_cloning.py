"""Behaviour cloning: the regression by hand, experts that it must hit, and the held-out days."""

import dataclasses
import math
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import demonstrate, price_rule, ruled_task, traces

from companions import assert_alone_as_among_others
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.irl.cloning import BehaviourCloning, CloningSettings, cloning_loss, split_days
from hemma.rl import training
from hemma.rl.policies.fractions import to_power
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.task import stack

SMALL = CloningSettings(iterations=50, batch=64, hidden=(16,))
LEARNER = BehaviourCloning(SMALL)


def hvac_fraction(outdoor):
    """0, the comfort action, on a mild night of 23 degC, full power from 33 degC on, and affine between."""
    return jnp.clip(0.1 * (outdoor - 23), 0.0, 1.0)


def hvac_law(observation):
    """That, and the battery at rest."""
    hvac = hvac_fraction(observation.outdoor_temperature)
    return to_power(Home(), observation, jnp.stack([jnp.zeros_like(hvac), hvac], axis=-1))


def test_an_action_at_a_bound_asks_for_no_more_than_the_bound():
    """By hand: mean 1.4 for a shown 1 is no error, 0.7 is one of -0.3; within, plain differences."""
    mean = jnp.asarray([[1.4, -1.5], [0.7, -0.2], [0.5, 1.2], [-1.2, 1.2]])
    shown = jnp.asarray([[1.0, -1.0], [1.0, -1.0], [0.2, 0.9], [1.0, -1.0]])
    expected = [[0.0, 0.0], [-0.3, 0.8], [0.3, 0.3], [-2.2, 2.2]]
    np.testing.assert_allclose(FRACTIONS.error(mean, shown, jnp.zeros((4, 0))), expected, atol=1e-6)


def test_loss_is_the_mean_square_over_what_counts():
    task, policy = ruled_task(price_rule, days=2), StochasticPolicy((16,), jax.random.key(0))
    moved = eqx.tree_at(lambda p: p.bias, policy, jnp.asarray([0.3, -0.2]))
    counted = jnp.arange(47) % 3 == 0
    total = np.zeros(2)
    for i in np.flatnonzero(counted):
        mean = np.asarray(moved.mean(task.teacher.transitions.features[i]))
        shown = np.asarray(task.teacher.transitions.fractions[i])
        for j in range(2):
            error = mean[j] - shown[j]
            if shown[j] >= 1:
                error = min(error, 0.0)
            if shown[j] <= -1:
                error = max(error, 0.0)
            total[j] += error**2
    found = cloning_loss(moved, task.teacher.transitions, counted)
    np.testing.assert_allclose(found, total / counted.sum(), rtol=1e-4)


def test_whole_days_are_held_out_and_every_transition_has_one_use():
    learned, held = (np.asarray(x) for x in split_days(ruled_task(price_rule, days=10), 5))
    np.testing.assert_array_equal(learned, ~held)
    np.testing.assert_array_equal(np.flatnonzero(held), [*range(96, 120), *range(216, 239)])


def test_short_demonstrations_hold_out_a_part_of_a_day():
    learned, held = (np.asarray(x) for x in split_days(ruled_task(price_rule, days=2), 5))
    np.testing.assert_array_equal(np.flatnonzero(held), range(36, 45))
    assert learned.sum() == 47 - 9


@pytest.mark.slow
def test_an_expert_with_a_bounded_affine_law_is_found():
    """HVAC as comfort asks, full, and in between: the mean is the law where the law is within the bounds."""
    task = stack([ruled_task(hvac_law, days=10)])
    learner = BehaviourCloning(dataclasses.replace(SMALL, iterations=200, learning_rate=1e-2))
    trained = training.train(task, learner)
    policy, scaler = jax.tree.map(lambda x: x[0], (trained.state.best, task.environment.scaler))
    unseen = demonstrate(Home(), traces(4, seed=9), hvac_law).states
    found = jnp.clip(jax.vmap(policy.mean)(scaler(unseen)), -1.0, 1.0)
    np.testing.assert_allclose(found[:, 0], 0.0, atol=0.05)
    np.testing.assert_allclose(found[:, 1], hvac_fraction(unseen[:, 3]), atol=0.05)


@pytest.mark.slow
def test_the_result_is_the_best_on_the_held_out_days():
    """Labels without sense are learned by heart: the held-out loss rises again, the result stays behind."""
    task = ruled_task(price_rule, days=5)
    noise = jax.random.uniform(jax.random.key(5), (119,), minval=-0.9, maxval=0.9)
    task = eqx.tree_at(
        lambda t: t.teacher.transitions.fractions,
        task,
        jnp.stack([noise, task.teacher.transitions.fractions[:, 1]], axis=1),
    )
    settings = dataclasses.replace(SMALL, iterations=200, hidden=(64,), learning_rate=1e-2, weight_decay=0.0)
    learner = BehaviourCloning(settings)
    trained = training.train(stack([task]), learner)
    curve = jax.tree.map(lambda x: np.asarray(x[0]), trained.curve.progress)
    state = jax.tree.map(lambda x: x[0], trained.state)
    held = split_days(task, settings.held_out)[1]
    result = cloning_loss(learner.policy(state), task.teacher.transitions, held)
    last = cloning_loss(state.policy, task.teacher.transitions, held)
    np.testing.assert_allclose(result, state.best_loss, rtol=1e-4)
    assert float(last[0]) > 1.2 * float(result[0])
    assert (np.diff(curve.best_held_out_loss) <= 0).all()
    assert curve.training_loss[-1] < curve.training_loss[0]


@pytest.fixture(scope="module")
def trained():
    """Three runs on the same five days, with seeds 3, 3 and 4."""
    return training.train(stack([ruled_task(price_rule, seed=seed) for seed in (3, 3, 4)]), LEARNER).state


@pytest.mark.slow
def test_battery_and_hvac_are_stopped_each_by_itself(trained):
    """The result may come from two iterations; each part has the loss that it had in its own."""
    task, state = ruled_task(price_rule), jax.tree.map(lambda x: x[0], trained)
    held = split_days(task, SMALL.held_out)[1]
    found = cloning_loss(state.best, task.teacher.transitions, held)
    np.testing.assert_allclose(found, state.best_loss, rtol=1e-4)


@pytest.mark.slow
def test_training_is_a_function_of_the_seed(trained):
    first, again, other = (jax.tree.map(lambda x, run=run: x[run], trained.best) for run in range(3))
    for a, b in zip(jax.tree.leaves(first), jax.tree.leaves(again), strict=True):
        np.testing.assert_array_equal(a, b)
    assert not np.allclose(first.network.weights[0], other.network.weights[0])


@pytest.mark.slow
def test_padding_is_never_read():
    runs = stack([ruled_task(price_rule, days=3), ruled_task(price_rule, seed=1, days=5)])
    poisoned = eqx.tree_at(
        lambda t: t.teacher.transitions,
        runs,
        jax.tree.map(lambda x: x.at[0, 71:].set(math.nan), runs.teacher.transitions),
    )
    clean, other = (training.advance(training.begin(r, LEARNER), r, LEARNER) for r in (runs, poisoned))
    for a, b in zip(jax.tree.leaves(clean.state.best), jax.tree.leaves(other.state.best), strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"iterations": 30}, "iterations a multiple of 25, got 30"),
        ({"held_out": 1}, "held_out >= 2, got 1"),
        ({"weight_decay": -1.0}, "weight_decay >= 0, got -1.0"),
        ({"hidden": (0,)}, "hidden layers of at least 1 unit"),
    ],
)
def test_settings_without_meaning_are_refused(change, message):
    with pytest.raises(HemmaError, match=message):
        dataclasses.replace(SMALL, **change)


@pytest.mark.slow
def test_a_run_is_the_same_alone_and_among_others(monkeypatch):
    assert_alone_as_among_others(partial(ruled_task, price_rule), LEARNER, monkeypatch)
