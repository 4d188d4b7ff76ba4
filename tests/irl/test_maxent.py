"""MaxEnt IRL: features and gradient by hand, and worlds in which the reward or the behaviour is known."""

import math
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import (
    PPO,
    demonstrate,
    idle_rule,
    imitation_task,
    linear_reward,
    night_rule,
    price_rule,
    ruled_task,
    shown_by,
    traces,
    transitions,
)

from companions import assert_alone_as_among_others
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.irl.maxent import MaxEntSettings, compare, linear_maxent, neural_maxent
from hemma.irl.maxent_rewards import Comparison, LearnedWeights, LinearMaxEnt, NeuralMaxEnt
from hemma.irl.reward_features import LinearReward, RewardFeatures, demonstrated_scale, reward_features
from hemma.rl import training
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.task import stack

SMALL = MaxEntSettings(iterations=50, windows=4, slots=12, neural=NeuralMaxEnt(hidden=(16,), steps=2))
NAMES = list(RewardFeatures.__dataclass_fields__)


def vector(features):
    """A RewardFeatures as NumPy, in the order of its fields."""
    return np.asarray([float(getattr(features, name)) for name in NAMES])


def by_hand(s, a, after):
    """phi of one transition, from the definitions."""
    pv, load, energy, outdoor, _, price, sine, cosine = s
    change, level, temperature = after[2] - energy, after[2], after[4]
    power = min(max(a[1], -1.0), 1.0)
    return [
        change,
        price * change,
        price * price * change,
        sine * change,
        cosine * change,
        pv * change,
        load * change,
        abs(change),
        level,
        level * level,
        price * level,
        sine * level,
        cosine * level,
        power,
        power * power,
        price * power,
        outdoor * power,
        max(temperature, 0.0),
        max(-temperature, 0.0),
    ]


def gap(reward, comparison):
    """E_expert[r] - E_agent[r]."""
    return jnp.mean(reward.batch(comparison.expert)) - jnp.mean(reward.batch(comparison.agent))


def test_features_are_those_of_their_definitions():
    batch = transitions(6)
    found = reward_features(batch)
    for i in range(6):
        one = (np.asarray(x[i], float) for x in (batch.features, batch.fractions, batch.next_features))
        phi = [float(getattr(found, name)[i]) for name in NAMES]
        np.testing.assert_allclose(phi, by_hand(*one), rtol=1e-5, atol=1e-6)


def test_linear_reward_weighs_the_scaled_features():
    rng = np.random.default_rng(3)
    w, scale = rng.normal(size=len(NAMES)), rng.uniform(0.5, 2.0, len(NAMES))
    reward = LinearReward(*(RewardFeatures(*(jnp.asarray(x) for x in v)) for v in (w, scale)))
    batch = transitions(5)
    for i in range(5):
        one = (np.asarray(x[i], float) for x in (batch.features, batch.fractions, batch.next_features))
        np.testing.assert_allclose(reward.batch(batch)[i], (w / scale) @ by_hand(*one), rtol=1e-4, atol=1e-5)


def test_scale_is_the_demonstrations_deviation_with_a_floor_and_without_padding():
    expert = ruled_task(price_rule, days=3).teacher
    padded = jax.tree.map(
        lambda x: jnp.pad(x, [(0, 9), (0, 0)], constant_values=math.nan), expert.transitions
    )
    scale = demonstrated_scale(eqx.tree_at(lambda e: e.transitions, expert, padded), 0.1)
    features = reward_features(expert.transitions)
    expected = np.maximum([np.std(np.asarray(getattr(features, name), float)) for name in NAMES], 0.1)
    np.testing.assert_allclose(vector(scale), expected, rtol=1e-4)
    assert expected.min() == 0.1  # the floor is met


def test_weights_step_along_the_difference_of_expectations():
    """w + eta (E_expert[phi] - E_agent[phi] - lambda w) by hand, and no further than |w| = 1."""
    learner = LinearMaxEnt(rate=0.1, shrinkage=0.5)
    expert, agent = transitions(40, 1), transitions(40, 2)
    start = linear_reward(charge=0.3, warmer=-0.2)
    learned = LearnedWeights(start, start, jnp.zeros((), int))

    def mean(batch):
        columns = (batch.features, batch.fractions, batch.next_features)
        rows = zip(*(np.asarray(x, float) for x in columns), strict=True)
        return np.mean([by_hand(s, a, after) for s, a, after in rows], axis=0)

    expected = vector(start.weights) + 0.05 * (mean(expert) - mean(agent) - 0.5 * vector(start.weights))
    comparison = Comparison(expert, agent)
    moved = learner.improve(learned, comparison, jnp.asarray(0.5), jax.random.key(0)).reward.weights
    np.testing.assert_allclose(vector(moved), expected, rtol=1e-3, atol=1e-5)
    far = learner.improve(learned, comparison, jnp.asarray(500.0), jax.random.key(0)).reward.weights
    np.testing.assert_allclose(np.linalg.norm(vector(far)), 1.0, rtol=1e-5)


def test_the_step_is_the_gradient_of_the_dual():
    """d/dw (E_expert[r] - E_agent[r] - lambda |w|^2 / 2), by automatic differentiation."""
    learner = LinearMaxEnt(rate=0.1, shrinkage=0.5)
    comparison = Comparison(transitions(40, 1), transitions(40, 2))
    start = linear_reward(charge=0.3, hvac=0.1)

    def dual(w):
        price = sum(x**2 for x in jax.tree.leaves(w)) / 2
        return gap(LinearReward(w, start.scale), comparison) - 0.5 * price

    expected = vector(start.weights) + 0.1 * vector(jax.grad(dual)(start.weights))
    learned = LearnedWeights(start, start, jnp.zeros((), int))
    moved = learner.improve(learned, comparison, jnp.asarray(1.0), jax.random.key(0)).reward.weights
    np.testing.assert_allclose(vector(moved), expected, rtol=1e-3, atol=1e-5)


def test_neural_reward_climbs_the_same_difference():
    learner = NeuralMaxEnt(hidden=(16,), steps=20, learning_rate=1e-2)
    task = ruled_task(price_rule, days=2)
    learned = learner.start(task.teacher, 0.9, jax.random.key(0))
    comparison = Comparison(transitions(64, 1), transitions(64, 2))
    better = learner.improve(learned, comparison, jnp.asarray(1.0), jax.random.key(1))
    assert float(gap(better.reward, comparison)) > float(gap(learned.reward, comparison)) + 0.1


def test_a_policy_that_is_the_expert_leaves_nothing_to_compare():
    """The expert's own policy, started in the expert's states, repeats the windows.

    It uses more of the HVAC than comfort asks for, where every fraction is another power.
    """
    policy = StochasticPolicy((16,), jax.random.key(4))
    law = (jnp.zeros((2, 8)).at[:, 5].set(jnp.asarray([-0.5, 0.1])), jnp.asarray([0.0, 0.5]))
    policy = eqx.tree_at(lambda p: (p.linear, p.bias), policy, law)
    scaler = ruled_task(price_rule).environment.scaler
    task = imitation_task(shown_by(policy, scaler), scaler)
    both = compare(task.environment, task.teacher, policy, (24, 6), jax.random.key(2))
    for a, b in zip(jax.tree.leaves(both.expert), jax.tree.leaves(both.agent), strict=True):
        np.testing.assert_allclose(a, b, atol=2e-3)


def test_both_sides_of_a_comparison_see_the_same_prices_and_weather():
    task = ruled_task(price_rule)
    policy = StochasticPolicy((16,), jax.random.key(4))
    both = compare(task.environment, task.teacher, policy, (24, 6), jax.random.key(2))
    given = np.asarray([0, 1, 3, 5, 6, 7])
    for side in ("features", "next_features"):
        expert, agent = (np.asarray(getattr(x, side))[:, given] for x in (both.expert, both.agent))
        np.testing.assert_allclose(expert, agent, atol=1e-5)


def test_windows_longer_than_the_demonstrations_go_round():
    task = ruled_task(price_rule, days=1)
    policy = StochasticPolicy((16,), jax.random.key(4))
    both = compare(task.environment, task.teacher, policy, (48, 3), jax.random.key(2))
    assert all(np.isfinite(np.asarray(x)).all() for x in jax.tree.leaves(both))
    np.testing.assert_array_equal(both.expert.features[0], both.expert.features[23 * 3])


def short_and_long():
    """Runs of 3 and of 5 days side by side."""
    return stack([ruled_task(price_rule, days=3), ruled_task(price_rule, seed=1, days=5)])


@pytest.mark.slow
def test_padding_is_never_read():
    """A run of 3 days beside one of 5 days trains the same whatever lies behind its third day."""
    learner, runs = linear_maxent(SMALL, PPO), short_and_long()
    poisoned = eqx.tree_at(
        lambda t: (t.environment.exogenous, t.teacher.transitions),
        runs,
        (
            jax.tree.map(lambda x: x.at[0, 72:].set(math.nan), runs.environment.exogenous),
            jax.tree.map(lambda x: x.at[0, 71:].set(math.nan), runs.teacher.transitions),
        ),
    )
    clean, other = (training.advance(training.begin(r, learner), r, learner) for r in (runs, poisoned))
    for a, b in zip(jax.tree.leaves(clean.state.average), jax.tree.leaves(other.state.average), strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.slow
@pytest.mark.parametrize("build", [linear_maxent, neural_maxent])
def test_training_goes_on_from_a_file_to_the_same_result(build, tmp_path):
    learner, runs = build(SMALL, PPO), short_and_long()
    unbroken = training.train(runs, learner)
    half = training.advance(training.begin(runs, learner), runs, learner)
    training.save(tmp_path / "half.safetensors", half, {})
    resumed = training.train(runs, learner, training.load(tmp_path / "half.safetensors", runs, learner))
    for a, b in zip(jax.tree.leaves(unbroken), jax.tree.leaves(resumed), strict=True):
        if jnp.issubdtype(a.dtype, jax.dtypes.prng_key):
            a, b = jax.random.key_data(a), jax.random.key_data(b)
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: MaxEntSettings(iterations=30), "iterations a multiple of 25, got 30"),
        (lambda: MaxEntSettings(windows=0), "windows >= 1, got 0"),
        (lambda: LinearMaxEnt(shrinkage=0.0), "shrinkage > 0, got 0.0"),
        (lambda: LinearMaxEnt(rate=10.0), "rate [*] shrinkage < 1, got 2.0"),
        (lambda: NeuralMaxEnt(hidden=(0,)), "hidden layers of at least 1 unit"),
    ],
)
def test_settings_without_meaning_are_refused(make, message):
    with pytest.raises(HemmaError, match=message):
        make()


@pytest.fixture(scope="module")
def imitators():
    """Controllers and rewards learned side by side in three worlds: idle, by the price, full at night."""
    runs = stack([ruled_task(rule) for rule in (idle_rule, price_rule, night_rule)])
    learner = linear_maxent(MaxEntSettings(iterations=150, windows=8, slots=24), PPO)
    trained = training.train(runs, learner)
    return training.controllers(trained, runs, learner), trained.state.learned.reward


def acted(imitators, run, seed):
    """What the mean action of one of them does on four days."""
    controller = jax.tree.map(lambda x: x[run], imitators[0])
    return demonstrate(Home(), traces(4, seed), lambda o: controller(o, (), jax.random.key(0))[0])


@pytest.mark.slow
def test_one_step_an_idle_expert_teaches_rest(imitators):
    """What the HVAC's power is worth, it is worth at once."""
    assert float(acted(imitators, 0, seed=9).actions[:, 1].mean()) < 0.1


@pytest.mark.slow
def test_the_state_matters_an_expert_on_price_teaches_a_reaction_to_price(imitators):
    """On days it never saw; and buying low and selling high is what was found to pay."""
    expert = demonstrate(Home(), traces(4, seed=9), price_rule)
    distance = jnp.abs(acted(imitators, 1, seed=9).states[:, 2] - expert.states[:, 2])
    assert float((distance < 1.0).mean()) > 0.8
    assert float(imitators[1].weights.charge_at_price[1]) < 0


@pytest.mark.slow
def test_tomorrow_matters_reward_at_night_is_prepared_in_time(imitators):
    """No price tells when to charge: the battery is filled before the night and emptied after it."""
    shown = acted(imitators, 2, seed=0)
    hour, energy = np.asarray(shown.states[24:, 6]), np.asarray(shown.states[24:, 2])
    night, noon = (hour >= 22) | (hour < 2), (hour >= 10) & (hour < 14)
    assert energy[night].mean() > energy[noon].mean() + 2.5
    assert energy[hour == 21].mean() > energy[hour == 15].mean() + 1.0


@pytest.mark.slow
def test_a_run_is_the_same_alone_and_among_others(monkeypatch):
    assert_alone_as_among_others(partial(ruled_task, price_rule), linear_maxent(SMALL, PPO), monkeypatch)
