"""Small homes and experts whose right answer is known, for the learners that imitate."""

from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from hemma.home import Home, observe, paper_state
from hemma.irl.reward_features import LinearReward, RewardFeatures
from hemma.rl.environment import Transitions
from hemma.rl.improvement import Effort, Proximal, standard
from hemma.rl.policies.policy import PolicyController
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import Demonstrated, make_task
from hemma.types import Action, Exogenous

PPO = Proximal(PPOSettings(rollouts=32, slots=24, hidden=(16,), learning_rate=1e-3))
SIGMA = jnp.asarray([0.2, 0.1])


def traces(days, seed=0):
    """Two prices, a sun, a hot afternoon."""
    rng = np.random.default_rng(seed)
    hour = np.arange(24 * days) % 24.0
    price = np.where((hour >= 14) & (hour < 20), 0.3, 0.1) * rng.uniform(0.9, 1.1, hour.size)
    return Exogenous(
        pv_generation=np.maximum(0.0, np.sin((hour - 6) / 12 * np.pi)),
        load=rng.uniform(0.3, 1.5, hour.size),
        outdoor_temperature=29 + 6 * np.sin((hour - 9) / 24 * 2 * np.pi),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=hour,
    )


def demonstrate(home, exogenous, rule):
    """Carry out ``rule(observation) -> Action`` and note the transitions."""

    def slot(state, now):
        observation = observe(state, now)
        step = home.step(state, now, rule(observation), jnp.zeros(()))
        action = jnp.stack([step.action.battery_power, step.action.hvac_power])
        return step.state, (paper_state(observation), action)

    exogenous = jax.tree.map(lambda x: jnp.asarray(x, float), exogenous)
    _, (states, actions) = jax.lax.scan(slot, home.reset(), exogenous)
    return Demonstrated(states[:-1], actions[:-1], states[1:])


def price_rule(observation):
    """Discharge when dear, charge when cheap; HVAC proportional to the outdoor temperature."""
    dear = observation.buying_price > 0.2
    return Action(jnp.where(dear, -3.0, 3.0), jnp.clip((observation.outdoor_temperature - 24) / 10, 0.0, 2.0))


def night_rule(observation):
    """Fill the battery from the afternoon on, empty it in the morning, whatever the price; no HVAC."""
    hour = observation.hour_of_day
    power = jnp.where(hour >= 15, 1.0, jnp.where((hour >= 5) & (hour < 12), -1.0, 0.0))
    return Action(power, jnp.zeros_like(power))


def idle_rule(observation):
    """Everything at rest."""
    return Action(jnp.zeros_like(observation.load), jnp.zeros_like(observation.load))


def ruled_task(rule, seed=0, days=5):
    """The task of imitating ``rule``."""
    home, exogenous = Home(), traces(days)
    return make_task(home, home, exogenous, demonstrate(home, exogenous, rule), seed)


def imitation_task(shown, scaler, seed=0, days=5):
    """The task of imitating what was shown on those days, seen through a scaler that is already known."""
    task = make_task(Home(), Home(), traces(days), shown, seed)
    deeds = task.teacher.transitions
    seen = replace(deeds, features=scaler(shown.states), next_features=scaler(shown.next_states))
    return eqx.tree_at(lambda t: (t.environment.scaler, t.teacher.transitions), task, (scaler, seen))


def weights(**named):
    """w with these entries, zeros elsewhere."""
    zeros = {name: jnp.zeros(()) for name in RewardFeatures.__dataclass_fields__}
    return RewardFeatures(**{**zeros, **{name: jnp.asarray(value, float) for name, value in named.items()}})


def linear_reward(**named):
    """The reward with these weights on unscaled features."""
    return LinearReward(weights(**named), jax.tree.map(jnp.ones_like, weights()))


def best_response(reward, task, updates, seed=7):
    """The Gaussian policy that PPO finds for ``reward``: the soft-optimal one, its entropy being given."""

    def update(learner, inputs):
        key, step = inputs
        explore_key, improve_key = jax.random.split(key)
        effort = Effort(SIGMA, 1.0 - 0.9 * step / updates)
        rollout = PPO.explore(learner, task.environment, effort, explore_key)
        rewards = standard(reward.batch(rollout.transitions))
        return PPO.improve(learner, rollout, rewards, effort, improve_key), None

    keys = jax.random.split(jax.random.key(seed), updates)
    start = PPO.start(jax.random.key(seed + 1))
    learner, _ = jax.jit(lambda s: jax.lax.scan(update, s, (keys, jnp.arange(updates))))(start)
    return PPO.policy(learner)


def shown_by(policy, scaler, days=5):
    """What the policy's mean action does on those days, as demonstrations."""
    home = Home()
    controller = PolicyController(policy, scaler, home)
    return demonstrate(home, traces(days), lambda o: controller(o, (), jax.random.key(0))[0])


def transitions(samples, seed=0):
    """Transitions without sense: for equations that hold for any."""
    rng = np.random.default_rng(seed)
    return Transitions(*(jnp.asarray(rng.normal(size=(samples, n)), float) for n in (8, 2, 8, 0)))
