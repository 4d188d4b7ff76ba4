"""AIRL: the reward and the discriminator by hand, and Algorithm 1 against experts with a known rule."""

import dataclasses
import math

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import demonstrate, price_rule, ruled_task, traces

from companions import assert_alone_as_among_others
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.irl.airl import AdversarialImitation, AIRLSettings, Contest
from hemma.irl.discriminator import cross_entropy, gradient_penalty
from hemma.irl.reward import ImitationScore, ShapedReward
from hemma.rl import training
from hemma.rl.environment import Transitions
from hemma.rl.improvement import Proximal
from hemma.rl.policies.committee import Committee
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import ExpertData, make_task, stack

SMALL = AIRLSettings(
    iterations=50,
    agent_rollouts=4,
    batch=64,
    hidden=(16,),
)
LEARNER = AdversarialImitation(SMALL, Proximal(PPOSettings(rollouts=8, slots=12, hidden=(16,))))


def task(seed=0, days=5):
    return ruled_task(price_rule, seed, days)


def transitions(samples, seed=0):
    rng = np.random.default_rng(seed)
    return Transitions(*(jnp.asarray(rng.normal(size=(samples, n)), float) for n in (8, 2, 8, 0)))


def test_reward_is_g_plus_discounted_shaping_difference():
    reward = ShapedReward.random((16,), 0.9, jax.random.key(0))
    batch = transitions(5)
    for i in range(5):
        s, a, after = (np.asarray(x[i]) for x in (batch.features, batch.fractions, batch.next_features))

        def network(net, x):
            hidden = np.tanh(np.asarray(net.weights[0]) @ x + np.asarray(net.biases[0]))
            return (np.asarray(net.weights[1]) @ hidden + np.asarray(net.biases[1]))[0]

        g = network(reward.approximator, np.concatenate([s, a]))
        expected = g + 0.9 * network(reward.shaping, after) - network(reward.shaping, s)
        np.testing.assert_allclose(reward.batch(batch)[i], expected, rtol=1e-4, atol=1e-5)


def test_shaping_telescopes_along_a_trajectory():
    """sum gamma^t r_t = sum gamma^t g_t + gamma^T h(s_T) - h(s_0): shaping cannot change what is best."""
    reward = ShapedReward.random((16,), 0.9, jax.random.key(1))
    batch = transitions(9)
    chained = eqx.tree_at(lambda t: t.next_features, batch, jnp.roll(batch.features, -1, axis=0))
    path = jax.tree.map(lambda x: x[:8], chained)
    discounts = 0.9 ** jnp.arange(8)
    g = jax.vmap(reward.approximator)(jnp.concatenate([path.features, path.fractions], axis=1))[:, 0]
    ends = 0.9**8 * reward.shaping(batch.features[8])[0] - reward.shaping(batch.features[0])[0]
    total = jnp.sum(discounts * reward.batch(path))
    np.testing.assert_allclose(total, jnp.sum(discounts * g) + ends, rtol=1e-4)


def test_logit_is_that_of_equation_10_and_loss_that_of_equation_12():
    reward = ShapedReward.random((16,), 0.9, jax.random.key(2))
    expert, agent = transitions(6, 1), transitions(6, 2)
    log_pi = jnp.linspace(-3.0, 2.0, 6)
    scores = []
    for batch in (expert, agent):
        r, pi = np.exp(np.asarray(reward.batch(batch))), np.exp(np.asarray(log_pi))
        scores.append(r / (r + pi))
        np.testing.assert_allclose(jax.nn.sigmoid(reward.logits(batch, log_pi)), scores[-1], rtol=1e-5)
    expected = 0.5 * (-np.log(scores[0]).mean() - np.log(1 - scores[1]).mean())
    loss = cross_entropy(reward.logits(expert, log_pi), reward.logits(agent, log_pi))
    np.testing.assert_allclose(loss, expected, rtol=1e-5)


def test_the_density_of_an_impossible_action_is_bounded():
    policy = StochasticPolicy((16,), jax.random.key(2))
    far = eqx.tree_at(lambda t: t.fractions, transitions(3), jnp.full((3, 2), 1e30))
    contest = Contest(ExpertData(far, jnp.asarray(3)), far, policy, jnp.asarray([0.2, 0.1]))
    np.testing.assert_array_equal(contest.density(far, 10.0), [-10.0] * 3)


def test_gail_pays_the_probability_of_not_being_taken_for_the_agent_and_knows_no_density():
    head = ImitationScore.random((16,), 0.9, jax.random.key(2))
    batch = transitions(5)
    probability = 1 / (1 + np.exp(-np.asarray(head.logits(batch, jnp.zeros(5)), float)))
    np.testing.assert_allclose(head.rewards(batch), -np.log(1 - probability), rtol=1e-5)
    np.testing.assert_array_equal(head.logits(batch, jnp.ones(5)), head.logits(batch, jnp.zeros(5)))


def test_the_penalty_falls_to_nothing_and_stays_there():
    settings = AIRLSettings(iterations=100, penalty=0.4, relaxing=0.5)
    weights = [float(settings.penalty_at(jnp.asarray(n))) for n in (0, 25, 50, 99)]
    assert np.allclose(weights, [0.4, 0.2, 0.0, 0.0])


def test_gradient_penalty_is_zero_for_a_flat_reward_and_grows_with_slope():
    reward = ShapedReward.random((16,), 0.9, jax.random.key(3))
    batches = transitions(32, 1), transitions(32, 2)
    flat = jax.tree.map(lambda w: 0.01 * w, reward)
    steep = jax.tree.map(lambda w: 10.0 * w, reward)
    assert float(gradient_penalty(flat, *batches, jax.random.key(0))) == 0.0
    assert float(gradient_penalty(steep, *batches, jax.random.key(0))) > 10.0


@pytest.mark.slow
def test_padding_is_never_read():
    """A run of 3 days beside one of 5 days trains the same whatever lies behind its third day."""
    runs = stack([task(seed=0, days=3), task(seed=1, days=5)])
    poisoned = eqx.tree_at(
        lambda t: (t.environment.exogenous, t.teacher.transitions),
        runs,
        (
            jax.tree.map(lambda x: x.at[0, 72:].set(math.nan), runs.environment.exogenous),
            jax.tree.map(lambda x: x.at[0, 71:].set(math.nan), runs.teacher.transitions),
        ),
    )
    clean, other = (training.advance(training.begin(r, LEARNER), r, LEARNER) for r in (runs, poisoned))
    for a, b in zip(jax.tree.leaves(clean.state.average), jax.tree.leaves(other.state.average), strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.slow
def test_training_goes_on_from_a_file_to_the_same_result(tmp_path):
    runs = stack([task(seed=0), task(seed=1)])
    unbroken = training.train(runs, LEARNER)
    half = training.advance(training.begin(runs, LEARNER), runs, LEARNER)
    training.save(tmp_path / "half.safetensors", half, {})
    resumed = training.train(runs, LEARNER, training.load(tmp_path / "half.safetensors", runs, LEARNER))
    for a, b in zip(jax.tree.leaves(unbroken), jax.tree.leaves(resumed), strict=True):
        if jnp.issubdtype(a.dtype, jax.dtypes.prng_key):
            a, b = jax.random.key_data(a), jax.random.key_data(b)
        np.testing.assert_array_equal(a, b)


@pytest.mark.slow
def test_seeds_give_different_policies():
    runs = stack([task(seed=0), task(seed=1)])
    weights = training.begin(runs, LEARNER).state.average.network.weights[0]
    assert not np.allclose(weights[0], weights[1])


def test_foreign_days_are_refused_with_the_cure():
    with pytest.raises(HemmaError, match="expected 47 transitions for traces of 48 slots, got 71"):
        make_task(Home(), Home(), traces(2), demonstrate(Home(), traces(3), price_rule), 0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"iterations": 30}, "iterations a multiple of 25, got 30"),
        ({"iterations": -25}, "iterations a multiple of 25, got -25"),
        ({"penalty": -1.0}, "penalty >= 0, got -1.0"),
        ({"relaxing": 0.0}, "0 < relaxing <= 1, got 0.0"),
    ],
)
def test_settings_without_meaning_are_refused(change, message):
    with pytest.raises(HemmaError, match=message):
        dataclasses.replace(SMALL, **change)


def test_minibatches_that_do_not_divide_the_samples_are_refused():
    with pytest.raises(HemmaError, match="multiple of minibatches, got 5"):
        PPOSettings(rollouts=8, slots=12, minibatches=5)


@pytest.mark.slow
def test_a_diverged_run_is_named():
    runs = stack([task(seed=3), task(seed=8)])
    poisoned = eqx.tree_at(
        lambda t: t.teacher.transitions.features, runs, runs.teacher.transitions.features.at[1].set(math.nan)
    )
    with pytest.raises(HemmaError, match=r"seeds \[8\]"):
        training.train(poisoned, LEARNER)


@pytest.mark.slow
@pytest.mark.parametrize("head", [ShapedReward, ImitationScore])
def test_the_policy_moves_to_an_expert_whose_reward_it_never_saw(head):
    """A rule on price and weather, on days the learner never saw: same battery and HVAC power."""
    improvement = Proximal(PPOSettings(rollouts=32, slots=24))
    learner = AdversarialImitation(AIRLSettings(iterations=250), improvement, head)
    runs = stack([task()])
    trained = training.train(runs, learner)
    controller = jax.tree.map(lambda x: x[0], training.controllers(trained, runs, learner))
    unseen = demonstrate(Home(), traces(4, seed=9), price_rule)
    acted = demonstrate(Home(), traces(4, seed=9), lambda o: controller(o, (), jax.random.key(0))[0])
    same = jnp.abs(acted.actions[:, 0] - unseen.actions[:, 0]) < 0.75
    assert float(same.mean()) > 0.8
    assert float(jnp.abs(acted.actions[:, 1] - unseen.actions[:, 1]).mean()) < 0.15


@pytest.mark.slow
@pytest.mark.parametrize("head", [ShapedReward, ImitationScore])
def test_a_run_is_the_same_alone_and_among_others(head, monkeypatch):
    """Of AIRL and of GAIL, to the bit."""
    assert_alone_as_among_others(task, dataclasses.replace(LEARNER, head=head), monkeypatch)


@pytest.mark.slow
def test_a_committee_is_the_same_alone_and_among_others(monkeypatch):
    assert_alone_as_among_others(task, Committee(LEARNER, 2), monkeypatch)
