"""Learners that imitate with the worth of a stored kWh: a rule on price alone is one worth."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import demonstrate, price_rule, traces

from hemma.home import Home
from hemma.irl.airl import AdversarialImitation, AIRLSettings
from hemma.irl.cloning import BehaviourCloning, CloningSettings
from hemma.irl.maxent import MaxEntSettings, linear_maxent
from hemma.irl.reward import ImitationScore, ShapedReward
from hemma.rl import training
from hemma.rl.improvement import Proximal
from hemma.rl.policies.spaces import STORED_VALUE
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import make_task, stack
from hemma.types import Action


def battery_powers(learner, task, rule_traces):
    """What the trained policy does with the battery on other days."""
    trained = training.train(task, learner)
    controller = jax.tree.map(lambda x: x[0], training.controllers(trained, task, learner))
    acted = demonstrate(Home(), rule_traces, lambda o: controller(o, (), jax.random.key(0))[0])
    return np.asarray(acted.actions[:, 0])


def ruled(seed=0, days=5):
    """The task of imitating a rule that charges when cheap and discharges when dear."""
    shown = demonstrate(Home(), traces(days), price_rule)
    return make_task(Home(), Home(), traces(days), shown, seed, space=STORED_VALUE)


def test_cloning_finds_a_worth_between_the_two_prices():
    """A rule on price alone: any worth between the prices does the same, on days that were not shown."""
    learner = BehaviourCloning(CloningSettings(iterations=100, hidden=(16,)), STORED_VALUE)
    unseen = demonstrate(Home(), traces(4, seed=9), price_rule)
    acted = battery_powers(learner, stack([ruled()]), traces(4, seed=9))
    assert np.mean(np.abs(acted - np.asarray(unseen.actions[:, 0])) < 0.05) > 0.95


@pytest.mark.slow
@pytest.mark.parametrize("head", [ShapedReward, ImitationScore])
def test_adversarial_imitation_finds_it_too(head):
    improvement = Proximal(PPOSettings(rollouts=32, slots=24), STORED_VALUE)
    learner = AdversarialImitation(AIRLSettings(iterations=250), improvement, head)
    unseen = demonstrate(Home(), traces(4, seed=9), price_rule)
    acted = battery_powers(learner, stack([ruled()]), traces(4, seed=9))
    assert np.mean(np.abs(acted - np.asarray(unseen.actions[:, 0])) < 0.05) > 0.9


@pytest.mark.slow
def test_maximum_entropy_finds_it_too():
    learner = linear_maxent(MaxEntSettings(iterations=200), Proximal(PPOSettings(), STORED_VALUE))
    unseen = demonstrate(Home(), traces(4, seed=9), price_rule)
    acted = battery_powers(learner, stack([ruled()]), traces(4, seed=9))
    assert np.mean(np.abs(acted - np.asarray(unseen.actions[:, 0])) < 0.05) > 0.8


def test_demonstrations_that_no_worth_would_show_end_where_their_deeds_do():
    """Charging at 2 kW of 3 is shown as full charging, and the next energy is that of full charging."""
    days = traces(2)
    shown = demonstrate(Home(), days, lambda o: Action(jnp.asarray(2.0), jnp.asarray(0.0)))
    task = make_task(Home(), Home(), days, shown, 0, space=STORED_VALUE)
    first = jax.tree.map(lambda x: x[0], task.teacher.transitions)
    scaler = task.environment.scaler
    assert float(first.fractions[0]) == 1.0
    np.testing.assert_allclose(scaler.quantities(first.features)[2], 1.2, rtol=1e-5)
    np.testing.assert_allclose(scaler.quantities(first.next_features)[2], 1.2 + 0.95 * 3.0, rtol=1e-5)
