"""More to see than the paper's state: scaled by hand, in its slot, of use where the state says nothing."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from paid_worlds import two_price_traces

from hemma.errors import HemmaError
from hemma.evaluation import evaluate_stacked
from hemma.home import Home, observe, paper_state
from hemma.irl.airl import AdversarialImitation, AIRLSettings
from hemma.irl.cloning import BehaviourCloning, CloningSettings
from hemma.irl.maxent import MaxEntSettings, linear_maxent, neural_maxent
from hemma.irl.reward import ImitationScore
from hemma.rl import training
from hemma.rl.ddpg import DDPG, DDPGSettings
from hemma.rl.explicit import ExplicitLearning, ExplicitSettings
from hemma.rl.improvement import Proximal
from hemma.rl.policies.committee import Committee
from hemma.rl.policies.policy import InformedController
from hemma.rl.policies.scaling import NOTHING, PLAIN, Context, StateScaler
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import Demonstrated, explicit_task, make_task, stack
from hemma.types import Action

DAYS = 8
PPO = PPOSettings(rollouts=4, slots=12, epochs=1, minibatches=2, hidden=(4,))
AIRL = AIRLSettings(iterations=25, hidden=(4,), batch=16, steps=1, rollouts=4, agent_rollouts=2, replayed=2)
MAXENT = MaxEntSettings(iterations=25, windows=2, slots=12)


def told(days=DAYS, seed=0):
    """A coin for every slot, and the context that tells it."""
    coin = np.where(np.random.default_rng(seed).uniform(size=24 * days) < 0.5, -1.0, 1.0)
    return coin, Context(coin[:, None], np.zeros((24 * days, 1)), np.array([PLAIN]))


def coin_task(seed=0, days=DAYS, context=None):
    """An expert that charges or discharges as a coin has it that the paper's state does not show."""
    home, exogenous = Home(), two_price_traces(days)
    coin, told_of = told(days)

    def slot(state, inputs):
        now, sign = inputs
        done = home.step(state, now, Action(1.0 * sign, jnp.asarray(0.5)), jnp.zeros(()))
        action = jnp.stack([done.action.battery_power, done.action.hvac_power])
        return done.state, (paper_state(observe(state, now)), action)

    inputs = jax.tree.map(lambda x: jnp.asarray(x, float), (exogenous, coin))
    _, (states, actions) = jax.lax.scan(slot, home.reset(8.0), inputs)
    shown = Demonstrated(states[:-1], actions[:-1], states[1:])
    return make_task(home, home, exogenous, shown, seed, told_of if context is None else context)


def test_figures_are_scaled_as_their_quantities_and_counted_from_their_origins():
    scaler = StateScaler(jnp.arange(6.0), jnp.full(6, 2.0))
    context = Context(np.array([[7.0, 7.0, 0.3]]), np.array([[3.0, 4.0, 9.0]]), np.array([5, 3, PLAIN]))
    expected = [np.arcsinh(1.0) - np.arcsinh(-1.0), (7 - 4) / 2, 0.3]
    np.testing.assert_allclose(scaler.context(context)[0], expected, rtol=1e-6)


def test_the_environment_shows_the_figures_of_the_slot_and_goes_round():
    task = coin_task()
    coin, _ = told()
    environment, state = task.environment, Home().reset()
    assert environment.width == 9
    for slot in (0, 5, 24 * DAYS + 5):
        features = environment.features(state, jnp.asarray(slot))
        np.testing.assert_allclose(features[8], coin[slot % (24 * DAYS)])


def test_a_transition_has_the_figures_of_its_slot_and_of_the_next():
    transitions = coin_task().teacher.transitions
    coin, _ = told()
    np.testing.assert_allclose(transitions.features[:, 8], coin[:-1])
    np.testing.assert_allclose(transitions.next_features[:, 8], coin[1:])


def test_figures_for_other_days_are_refused():
    with pytest.raises(HemmaError, match="a row for each of the 192 slots"):
        coin_task(context=told(2)[1])


@pytest.mark.slow
def test_a_policy_learns_what_only_the_context_tells_and_acts_by_it():
    """Cloned with the coin in sight, the battery follows another coin on other days; no state could tell."""
    learner = BehaviourCloning(CloningSettings(iterations=50, batch=64, hidden=(16,), weight_decay=0.1))
    task, (coin, context) = stack([coin_task()]), told(4, seed=9)
    controllers = training.controllers(training.train(task, learner), task, learner)
    informed = InformedController(controllers, jax.tree.map(lambda x: x[None], context))
    keys = jax.random.split(jax.random.key(0), 1)
    (outcome,) = evaluate_stacked(Home(), two_price_traces(4), informed, keys)
    assert np.mean(np.sign(outcome.battery_power) == coin) > 0.9


@pytest.mark.parametrize(
    "learner",
    [
        AdversarialImitation(AIRL, Proximal(PPO)),
        Committee(AdversarialImitation(AIRL, Proximal(PPO), ImitationScore), 2),
        linear_maxent(MAXENT, Proximal(PPO)),
        neural_maxent(MAXENT, Proximal(PPO)),
        BehaviourCloning(CloningSettings(iterations=25, hidden=(4,))),
        ExplicitLearning(ExplicitSettings(iterations=25, ppo=PPO)),
        DDPG(DDPGSettings(iterations=25, steps=1, hidden=(4,))),
    ],
    ids=["AIRL", "GAIL", "MaxEnt linear", "MaxEnt neural", "BC", "PPO", "DDPG"],
)
def test_every_learner_can_see_more(learner):
    """An iteration takes and gives the same shapes, and the policy asks for nine features."""
    if isinstance(learner, ExplicitLearning | DDPG):
        task = explicit_task(Home(), Home(), two_price_traces(2), 0.5, 0, told(2)[1])
    else:
        task = coin_task(days=2)
    before = eqx.filter_eval_shape(lambda t: learner.start(t, t.key), task)
    after = eqx.filter_eval_shape(lambda t: learner.iterate(learner.start(t, t.key), t)[0], task)
    assert jax.tree.map(lambda x: x.shape, before) == jax.tree.map(lambda x: x.shape, after)
    inputs = {weight.shape[-1] for weight in jax.tree.leaves(eqx.filter(after, _is_first_weight))}
    assert 9 in inputs


def _is_first_weight(leaf):
    return len(leaf.shape) >= 2


def test_padding_of_shorter_days_is_not_seen():
    long, short = coin_task(days=DAYS), coin_task(days=2)
    padded = jax.tree.map(lambda x: x[1], stack([long, short])).environment
    coin, _ = told(2)
    for slot in (0, 47, 48, 60):
        np.testing.assert_allclose(padded.features(Home().reset(), jnp.asarray(slot))[8], coin[slot % 48])


def test_without_more_to_see_the_features_are_those_of_the_papers_state():
    task = coin_task(context=NOTHING)
    assert task.environment.width == 8
    assert task.teacher.transitions.features.shape == (24 * DAYS - 1, 8)
