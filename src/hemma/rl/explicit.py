"""Reinforcement learning on the explicit reward of the paper's baselines: r = -(X1 + X2) - beta_T X3."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.home import Home
from hemma.home.checks import require
from hemma.rl.environment import Environment, Rollout
from hemma.rl.improvement import Effort, PolicyImprovement, Proximal, RolloutMeans, measured
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.exploration import Exploration, falling
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import ExplicitReward, Task
from hemma.rl.training import CHUNK
from hemma.types import Array, Exogenous, PaperState

PV, LOAD = PaperState.PV_GENERATION, PaperState.LOAD
ENERGY, PRICE = PaperState.BATTERY_ENERGY, PaperState.BUYING_PRICE
"""Positions in the paper's state."""
SPREADS = 5.0
"""How far from the median a price still counts as usual, in the scaler's spreads."""


@dataclass(frozen=True)
class ExplicitSettings:
    """Sizes of training on the explicit reward; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 800
    """Updates of the policy, a multiple of 25."""
    exploration: Exploration = field(
        default_factory=lambda: Exploration(first_deviation=(0.5, 0.2), last_deviation=(0.15, 0.01))
    )
    ppo: PPOSettings = field(
        default_factory=lambda: PPOSettings(trace=0.9, learning_rate=3e-3, value_learning_rate=3e-3)
    )

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("explicit", whole, f"iterations a multiple of {CHUNK}", self.iterations)


class ExplicitState(eqx.Module):
    """All that training carries from iteration to iteration."""

    learner: Any
    """The policy and what its improvement carries on."""
    average: StochasticPolicy
    """Exponential moving average of the policy's weights."""
    iteration: Int[Array, "*runs"]
    key: Array


@dataclass(frozen=True)
class ExplicitLearning:
    """A policy improved on the explicit reward: by PPO, the paper's benchmark of that name."""

    settings: ExplicitSettings = field(default_factory=ExplicitSettings)
    space: ActionSpace = FRACTIONS
    """What the policy decides on."""
    other_improvement: PolicyImprovement | None = None
    """What takes the place of PPO as set, if anything."""

    @property
    def improvement(self) -> PolicyImprovement:
        """How the policy is improved."""
        return self.other_improvement or Proximal(self.settings.ppo, self.space)

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.settings.iterations

    def policy(self, state: ExplicitState) -> StochasticPolicy:
        """The averaged policy."""
        return state.average

    def start(self, task: Task[ExplicitReward], key: Array) -> ExplicitState:
        """A random policy."""
        learner_key, key = jax.random.split(key)
        learner = self.improvement.start(learner_key, task.environment.width)
        return ExplicitState(learner, self.improvement.policy(learner), jnp.zeros((), int), key)

    def iterate(self, state: ExplicitState, task: Task[ExplicitReward]) -> tuple[ExplicitState, RolloutMeans]:
        """One improvement of the policy."""
        return self.improved(state, task.environment, lambda rollout: scaled_reward(rollout, task))

    def improved(
        self,
        state: ExplicitState,
        environment: Environment,
        paid: Callable[[Rollout], Array],
        scaled: Callable[[Array], Array] = lambda rewards: rewards,
    ) -> tuple[ExplicitState, RolloutMeans]:
        """One improvement of the policy on what a rollout is ``paid``, shape (slots, rollouts).

        What is shown is the pay as it is, what is learned from is the pay ``scaled``.
        """
        settings, n = self.settings, state.iteration
        key, explore_key, improve_key = jax.random.split(state.key, 3)
        effort = Effort(
            settings.exploration.deviation(n, settings.iterations), falling(n, settings.iterations)
        )
        rollout = self.improvement.explore(state.learner, environment, effort, explore_key)
        rewards = paid(rollout)
        learner = self.improvement.improve(state.learner, rollout, scaled(rewards), effort, improve_key)
        average = settings.exploration.averaged(state.average, self.improvement.policy(learner), n)
        return ExplicitState(learner, average, n + 1, key), measured(rollout, rewards)


def scaled_reward(rollout: Rollout, task: Task[ExplicitReward]) -> Float[Array, "*batch"]:
    """The explicit reward as learners see it: (r + u (l - p) dt + v (E' - E)) / unit.

    What load and PV alone would cost, u (l - p) dt, is most of X1 and none of it can be helped: it depends on
    no action, so taking it out changes no policy's rank, only the noise. Energy put into the store is paid at
    its usual price v and charged for when it is taken out again. Over a day these payments come to v times
    the difference of the two ends, so they change no policy's daily cost; but without them a discount of
    0.95 an hour leaves half of what a kWh stored at night earns in the afternoon, and storing never pays.
    """
    environment = task.environment
    quantities = environment.scaler.quantities(rollout.transitions.features)
    after = environment.scaler.quantities(rollout.transitions.next_features)
    pv, load, price = quantities[..., PV], quantities[..., LOAD], quantities[..., PRICE]
    unavoidable = price * (load - pv) * environment.home.slot_length
    stored = usual_price(environment) * (after[..., ENERGY] - quantities[..., ENERGY])
    return (task.teacher(rollout.costs) + unavoidable + stored) / reward_unit(environment)


def usual_price(environment: Environment) -> Float[Array, ""]:
    """v: the mean buying price of the traces [currency/kWh], each within five spreads of the median.

    The mean itself may be ruled by a few hours of scarcity, and to hold energy for them would seem to pay
    better than to use it on any other day.
    """
    traces, scaler = environment.exogenous, environment.scaler
    reach = SPREADS * scaler.spread[PRICE]
    usual = jnp.clip(traces.buying_price, scaler.centre[PRICE] - reach, scaler.centre[PRICE] + reach)
    return _mean(usual, environment)


def reward_unit(environment: Environment) -> Float[Array, ""]:
    """The currency that learners count in: a slot at full power of HVAC or battery, at the usual price.

    Learning rates then mean the same in SEK as in $, and for slots of any length.
    """
    home = environment.home
    power = jnp.maximum(home.hvac.max_power, home.battery.max_charging_power)
    unit = jnp.abs(usual_price(environment)) * power * home.slot_length
    return jnp.where(unit > 0, unit, 1.0)


def _mean(values: Float[Array, "slots"], environment: Environment) -> Float[Array, ""]:
    counted = jnp.arange(values.shape[0]) < environment.available
    return jnp.sum(jnp.where(counted, values, 0.0)) / environment.available


def comfort_prices(
    home: Home, exogenous: Exogenous, multiples: Sequence[float]
) -> Float[np.ndarray, "multiples"]:
    """Values of beta_T to try [currency/degC for one slot]: ``multiples`` of the mean buying price's
    magnitude times the HVAC's energy in a slot at full power."""
    price = float(np.mean(np.abs(np.asarray(exogenous.buying_price, float))))
    unit = price * float(home.hvac.max_power) * float(home.slot_length)
    return np.asarray(multiples, float) * (unit if unit > 0 else 1.0)


def choose_comfort_price(
    prices: Float[np.ndarray, "values"],
    regrets: Float[np.ndarray, "values"],
    deviations: Float[np.ndarray, "values"],
    tolerance: float,
) -> float:
    """beta_T with the least regret at equal comfort among those that keep comfort, on days not learned from.

    ``deviations`` are mean X3 [degC]; comfort is kept where it is at most ``tolerance``. Where no value keeps
    it, the one that comes nearest is taken.
    """
    kept = deviations <= tolerance
    if not np.any(kept):
        return float(prices[np.argmin(deviations)])
    return float(prices[kept][np.argmin(regrets[kept])])
