"""Maximum-entropy inverse reinforcement learning: a reward under which the expert's behaviour is the best.

Ziebart et al. 2008 for the principle, Wulfmeier et al. 2015 (arXiv 1507.04888) for networks, Dey et al. 2023
for buildings; ``docs/maxent.md`` has the mathematics.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.irl.maxent_rewards import Comparison, LinearMaxEnt, NeuralMaxEnt, RewardLearner
from hemma.rl.environment import Environment, flattened, rolled_out
from hemma.rl.improvement import Effort, PolicyImprovement, Proximal, measured, standard
from hemma.rl.policies.action_space import Deed
from hemma.rl.policies.exploration import Exploration, falling
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.policies.scaling import HOUR
from hemma.rl.task import ExpertData, Task
from hemma.rl.training import CHUNK
from hemma.types import Array, PaperState


@dataclass(frozen=True)
class MaxEntSettings:
    """Sizes and rates of MaxEnt IRL; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 800
    """Reward and policy updates, a multiple of 25."""
    windows: int = 16
    """Windows of the demonstrations that the policy repeats in an iteration."""
    slots: int = 48
    """Length of a window."""
    linear: LinearMaxEnt = field(default_factory=LinearMaxEnt)
    """Of the reward that is linear in named features."""
    neural: NeuralMaxEnt = field(default_factory=NeuralMaxEnt)
    """Of the reward that is a network."""
    exploration: Exploration = field(default_factory=Exploration)
    """Of the policy while it is improved."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("maxent", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("windows", "slots"):
            require("maxent", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))


class MaxEntState(eqx.Module):
    """All that training carries from iteration to iteration."""

    learner: Any
    """pi_n and what its improvement carries on."""
    learned: Any
    """r_n and what its learner carries on."""
    average: StochasticPolicy
    """Exponential moving average of the policy's weights."""
    iteration: Int[Array, "*runs"]
    key: Array


class MaxEntProgress(eqx.Module):
    """What one iteration tells about itself."""

    reward_gap: Float[Array, "*iterations"]
    """E_expert[r] - E_agent[r], mean a slot: 0 where the expert's expectations are met."""
    learned_reward: Float[Array, "*iterations"]
    """Mean r of the exploring agent's transitions."""
    energy_cost: Float[Array, "*iterations"]
    """Mean X1 + X2 a slot of the exploring agent [currency]; shown, never used."""
    temperature_deviation: Float[Array, "*iterations"]
    """Mean X3 of the exploring agent [degC]; shown, never used."""


@dataclass(frozen=True)
class MaxEnt:
    """One loop for both rewards: compare with the expert, improve the reward, improve the policy."""

    settings: MaxEntSettings
    reward: RewardLearner
    improvement: PolicyImprovement = field(default_factory=Proximal)

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.settings.iterations

    def policy(self, state: MaxEntState) -> StochasticPolicy:
        """The averaged policy."""
        return state.average

    def start(self, task: Task[ExpertData], key: Array) -> MaxEntState:
        """Random policy and first reward."""
        learner_key, reward_key, key = jax.random.split(key, 3)
        learner = self.improvement.start(learner_key, task.environment.width)
        learned = self.reward.start(task.teacher, self.improvement.discount, reward_key)
        return MaxEntState(learner, learned, self.improvement.policy(learner), jnp.zeros((), int), key)

    def iterate(self, state: MaxEntState, task: Task[ExpertData]) -> tuple[MaxEntState, MaxEntProgress]:
        """One step of the reward, and one of the policy towards its best response."""
        settings, n = self.settings, state.iteration
        key, compare_key, reward_key, explore_key, improve_key = jax.random.split(state.key, 5)
        policy, share = self.improvement.policy(state.learner), falling(n, settings.iterations)

        # The reward: what the expert gets more than the policy, in the same slots.
        shape = (settings.slots, settings.windows)
        comparison = compare(task.environment, task.teacher, policy, shape, compare_key)
        learned = self.reward.improve(state.learned, comparison, share, reward_key)
        reward = learned.reward

        # The policy.
        effort = Effort(settings.exploration.deviation(n, settings.iterations), share)
        rollout = self.improvement.explore(state.learner, task.environment, effort, explore_key)
        rewards = standard(reward.batch(rollout.transitions) + rollout.surprise)
        learner = self.improvement.improve(state.learner, rollout, rewards, effort, improve_key)
        average = settings.exploration.averaged(state.average, self.improvement.policy(learner), n)
        gap = jnp.mean(reward.batch(comparison.expert)) - jnp.mean(reward.batch(comparison.agent))
        seen = measured(rollout, rewards)
        progress = MaxEntProgress(gap, seen.reward, seen.energy_cost, seen.temperature_deviation)
        return MaxEntState(learner, learned, average, n + 1, key), progress


def linear_maxent(settings: MaxEntSettings, improvement: PolicyImprovement) -> MaxEnt:
    """MaxEnt IRL with a reward that is linear in named features."""
    return MaxEnt(settings, settings.linear, improvement)


def neural_maxent(settings: MaxEntSettings, improvement: PolicyImprovement) -> MaxEnt:
    """MaxEnt IRL with a neural reward."""
    return MaxEnt(settings, settings.neural, improvement)


def compare(
    environment: Environment,
    expert: ExpertData,
    policy: StochasticPolicy,
    shape: tuple[int, int],
    key: Array,
) -> Comparison:
    """Random windows of the demonstrations, and the policy's mean action from the state in which each begins.

    ``shape`` is (slots, windows). Both sides meet the same prices, weather and load, so nothing but behaviour
    differs. Windows reach to the last demonstrated slot, and only round it where that is all there is.
    """
    slots, windows = shape
    start_key, disturbance_key = jax.random.split(key)
    last = jnp.maximum(expert.available - slots, 0)
    starts = jax.random.randint(start_key, (windows,), 0, last + 1)
    rows = (starts[None, :] + jnp.arange(slots)[:, None]) % expert.available
    shown = jax.tree.map(lambda x: x[rows], expert.transitions)
    first = shown.features[0]
    states = jax.vmap(environment.home.reset)(*_stood(environment, first))

    def act(features: Array, nothing: Array) -> tuple[Array, Callable[[Deed], tuple[Array, Array]]]:
        return policy.mean(features), lambda deed: (nothing, nothing)

    nothing = jnp.zeros((slots, windows))
    begin = (states, starts, first)
    played = rolled_out(environment, policy.space, act, begin, nothing, disturbance_key).transitions
    return Comparison(flattened(shown), flattened(played))


def _stood(environment: Environment, features: Float[Array, "windows features"]) -> tuple[Array, Array]:
    """E [kWh] and T_in [degC] of scaled states."""
    scaler = environment.scaler
    quantities = (
        scaler.centre[:HOUR] + scaler.spread[:HOUR] * features[:, :HOUR]
    )  # those two are scaled linearly
    return quantities[:, PaperState.BATTERY_ENERGY], quantities[:, PaperState.INDOOR_TEMPERATURE]
