"""A selling price that the paper's state does not tell: one more feature, and only there."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from paid_worlds import two_price_traces

from hemma.checkpoint import save_tree
from hemma.evaluation import evaluate_stacked
from hemma.home import Home, observe, paper_state
from hemma.irl.cloning import BehaviourCloning, CloningSettings
from hemma.irl.learned_reward import LearnedReward, load_rewards, save_rewards
from hemma.irl.reoptimise import frozen_task, ground
from hemma.irl.reward import ShapedReward
from hemma.rl import training
from hemma.rl.loading import load_controllers
from hemma.rl.policies.scaling import SELLING, Context, fit_scaler
from hemma.rl.task import Demonstrated, explicit_task, make_task, stack
from hemma.types import Action

HOME = Home()


def coin_export(days, seed=0):
    """One import price; what export brings is drawn for every hour, so that no hour tells it."""
    dear = np.random.default_rng(seed).uniform(size=24 * days) < 0.5
    flat = np.full(24 * days, 0.30)
    return replace(
        two_price_traces(days), buying_price=flat, selling_price=np.where(dear, 0.28, 0.02)
    ), np.where(dear, -1.0, 1.0)


def cloning_task(days=8):
    """An expert that discharges where export is dear and charges where it is not."""
    exogenous, sign = coin_export(days)

    def slot(state, inputs):
        now, sign = inputs
        done = HOME.step(state, now, Action(1.0 * sign, jnp.asarray(0.5)), jnp.zeros(()))
        action = jnp.stack([done.action.battery_power, done.action.hvac_power])
        return done.state, (paper_state(observe(state, now)), action)

    inputs = jax.tree.map(lambda x: jnp.asarray(x, float), (exogenous, sign))
    _, (states, actions) = jax.lax.scan(slot, HOME.reset(8.0), inputs)
    return make_task(HOME, HOME, exogenous, Demonstrated(states[:-1], actions[:-1], states[1:]), 0)


@pytest.mark.parametrize("selling", [lambda u: 0.9 * u, np.zeros_like, lambda u: 0 * u + 0.08])
def test_a_line_of_the_buying_price_is_no_feature(selling):
    traces = two_price_traces()
    task = explicit_task(HOME, HOME, replace(traces, selling_price=selling(traces.buying_price)), 0.5, 0)
    assert task.environment.width == 8
    assert task.environment.scaler.centre.shape == (6,)


def test_it_is_scaled_by_its_own_prices_and_stands_behind_the_state():
    task = cloning_task()
    exogenous, _ = coin_export(8)
    environment, transitions, v = task.environment, task.teacher.transitions, exogenous.selling_price
    assert environment.width == 9
    centre, spread = np.median(v[:-1]), (0.28 - 0.02) / 2
    expected = np.arcsinh((v - centre) / spread)
    np.testing.assert_allclose(transitions.features[:, 8], expected[:-1], rtol=1e-5)
    np.testing.assert_allclose(transitions.next_features[:, 8], expected[1:], rtol=1e-5)
    for slot in (0, 7, 24 * 8 + 7):
        now, state = environment.at(jnp.asarray(slot)), HOME.reset()
        features = environment.features(state, jnp.asarray(slot))
        np.testing.assert_allclose(features[8], expected[slot % len(v)], rtol=1e-5)
        np.testing.assert_allclose(features, environment.scaler.observed(observe(state, now)))


@pytest.mark.slow
def test_a_policy_acts_by_it_on_other_days_and_off_the_disk(tmp_path):
    learner = BehaviourCloning(CloningSettings(iterations=50, batch=64, hidden=(16,), weight_decay=0.1))
    task, (days, sign) = stack([cloning_task()]), coin_export(4, seed=9)
    kept = training.controllers(training.train(task, learner), task, learner)
    save_tree(tmp_path / "c.safetensors", kept, {})
    again = load_controllers(tmp_path / "c.safetensors", HOME)
    keys = jax.random.split(jax.random.key(0), 1)
    power, same = (evaluate_stacked(HOME, days, one, keys)[0].battery_power for one in (kept, again))
    np.testing.assert_array_equal(power, same)
    assert np.mean(np.sign(power) == sign) > 0.9


def test_a_learned_reward_reads_it_and_keeps_it_on_disk(tmp_path):
    environment = cloning_task().environment
    rewards = stacked(LearnedReward(ShapedReward.random((4,), 0.9, jax.random.key(0), 9), environment.scaler))
    save_rewards(tmp_path / "r.safetensors", rewards, {})
    reward = load_rewards(tmp_path / "r.safetensors").run(0)
    cheap, dear = (
        observe(HOME.reset(), replace(environment.at(jnp.asarray(0)), selling_price=jnp.asarray(price)))
        for price in (0.02, 0.28)
    )
    paid = [float(reward.head.rewards(reward.transitions(o, jnp.zeros(2), o))) for o in (cheap, dear)]
    assert paid[0] != paid[1]


@pytest.mark.parametrize("reader", ["export of its own", "line"])
def test_a_reward_from_elsewhere_sees_what_it_learned_with(reader):
    own, line = cloning_task().environment, explicit_task(HOME, HOME, two_price_traces(), 0.5, 0).environment
    scaler, width = (own.scaler, 9) if reader == "export of its own" else (line.scaler, 8)
    for traces in (coin_export(4)[0], two_price_traces(4)):
        made = explicit_task(HOME, HOME, traces, 0.5, 0)
        head = ShapedReward.random((4,), 0.9, jax.random.key(0), width)
        environment = frozen_task(made, ground(head), scaler).environment
        assert environment.width == width
        seen = environment.features(HOME.reset(), jnp.asarray(5))
        np.testing.assert_allclose(
            seen, scaler.observed(observe(HOME.reset(), environment.at(jnp.asarray(5))))
        )


def test_figures_of_coming_selling_prices_are_scaled_as_the_present_one():
    """Even where the days learned from do not tell both prices apart, and later ones do."""
    traces = two_price_traces(2)
    figures = np.full((48, 1), 0.5)
    context = Context(figures, np.asarray(traces.selling_price)[:, None], np.array([SELLING]))
    environment = explicit_task(HOME, HOME, traces, 0.5, 0, context).environment
    assert environment.width == 10
    bent = np.arcsinh((0.5 - environment.scaler.centre[SELLING]) / environment.scaler.spread[SELLING])
    np.testing.assert_allclose(environment.context[:, 1], bent - environment.context[:, 0], rtol=1e-5)


def test_a_price_that_never_changes_is_no_rounding_error_seen_large():
    """The standard deviation of 0.3, 0.3, ... is 6e-17; in other digits 0.3 lies many of them away."""
    states = np.random.default_rng(0).uniform(0, 1, (336, 7))
    states[:, 5] = 0.3
    scaler = fit_scaler(states)
    seen = scaler(jnp.asarray(np.where(np.arange(7) == 5, np.float32(0.3) + 3e-8, states[0])))
    assert abs(float(seen[5])) < 1e-6


def stacked(tree):
    return jax.tree.map(lambda x: jnp.asarray(x)[None] if isinstance(x, jax.Array) else x, tree)
