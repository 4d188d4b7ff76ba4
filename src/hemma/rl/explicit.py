"""Reinforcement learning on the explicit reward of the paper's baselines: r = -(X1 + X2) - beta_T X3."""

from collections.abc import Sequence
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
from hemma.rl.exploration import Exploration, falling
from hemma.rl.improvement import Effort, Improvement, Measured, Proximal
from hemma.rl.policy import GaussianPolicy
from hemma.rl.task import ExplicitReward, Task
from hemma.rl.training import CHUNK
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class ExplicitSettings:
    """Sizes of training on the explicit reward; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 800
    """Updates of the policy, a multiple of 25."""
    exploration: Exploration = field(default_factory=Exploration)

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("explicit", whole, f"iterations a multiple of {CHUNK}", self.iterations)


class ExplicitState(eqx.Module):
    """All that training carries from iteration to iteration."""

    learner: Any
    """The policy and what its improvement carries on."""
    average: GaussianPolicy
    """Exponential moving average of the policy's weights."""
    iteration: Int[Array, "*runs"]
    key: Array


@dataclass(frozen=True)
class ExplicitLearning:
    """A policy improved on the explicit reward: with ``Proximal`` the paper's benchmark PPO."""

    settings: ExplicitSettings = field(default_factory=ExplicitSettings)
    improvement: Improvement = field(default_factory=Proximal)

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.settings.iterations

    def policy(self, state: ExplicitState) -> GaussianPolicy:
        """The averaged policy."""
        return state.average

    def start(self, task: Task[ExplicitReward], key: Array) -> ExplicitState:
        """A random policy."""
        learner_key, key = jax.random.split(key)
        learner = self.improvement.start(learner_key)
        return ExplicitState(learner, self.improvement.policy(learner), jnp.zeros((), int), key)

    def iterate(self, state: ExplicitState, task: Task[ExplicitReward]) -> tuple[ExplicitState, Measured]:
        """One improvement of the policy."""
        settings, n = self.settings, state.iteration
        key, improve_key = jax.random.split(state.key)
        effort = Effort(
            settings.exploration.deviation(n, settings.iterations), falling(n, settings.iterations)
        )
        learner, measured = self.improvement.improve(
            state.learner, task.environment, lambda r: scaled_reward(r, task), effort, improve_key
        )
        average = settings.exploration.averaged(state.average, self.improvement.policy(learner), n)
        return ExplicitState(learner, average, n + 1, key), measured


def scaled_reward(rollout: Rollout, task: Task[ExplicitReward]) -> Float[Array, "*batch"]:
    """The explicit reward as learners see it: (r + u (l - p) dt) / unit.

    What load and PV alone would cost, u (l - p) dt, is most of X1 and none of it can be helped. It depends on
    neither action nor battery nor building, so taking it out changes no policy's rank, only the noise.
    """
    environment = task.environment
    quantities = environment.scaler.quantities(rollout.transitions.features)
    pv, load, price = quantities[..., 0], quantities[..., 1], quantities[..., 5]
    unavoidable = price * (load - pv) * environment.home.slot_length
    return (task.teacher(rollout.costs) + unavoidable) / reward_unit(environment)


def reward_unit(environment: Environment) -> Float[Array, ""]:
    """The currency that learners count in: what the HVAC at full power costs in a slot of mean |price|.

    Learning rates then mean the same in SEK as in $, and for slots of any length.
    """
    traces, home = environment.exogenous, environment.home
    counted = jnp.arange(traces.slots) < environment.available
    price = jnp.sum(jnp.where(counted, jnp.abs(traces.buying_price), 0.0)) / environment.available
    unit = price * home.hvac.max_power * home.slot_length
    return jnp.where(unit > 0, unit, 1.0)


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
