"""Behaviour cloning: regression of what the expert did on what it saw, with no home and no reward."""

from dataclasses import dataclass, field

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Bool, Float, Int

from hemma.home.checks import require
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Transitions
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.exploration import falling
from hemma.rl.policies.policy import ACTIONS, StochasticPolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.task import ExpertData, Task
from hemma.rl.training import CHUNK
from hemma.types import Array


@dataclass(frozen=True)
class CloningSettings:
    """Sizes and rates of behaviour cloning; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 400
    """Looks at the held-out days, a multiple of 25."""
    steps: int = 10
    """Adam steps an iteration."""
    batch: int = 256
    """Transitions a step."""
    learning_rate: float = 3e-3
    """Of Adam at first; it falls to a tenth."""
    weight_decay: float = 1.0
    """Of the weights of the battery's network, decoupled from the gradient."""
    held_out: int = 5
    """Every so many days one is held out, to say which iteration was the best."""
    hidden: tuple[int, ...] = (64, 64)
    """Units of the hidden layers of the battery's mean."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("cloning", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("steps", "batch"):
            require("cloning", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        require("cloning", self.learning_rate > 0, "learning_rate > 0", self.learning_rate)
        require("cloning", self.weight_decay >= 0, "weight_decay >= 0", self.weight_decay)
        require("cloning", self.held_out >= 2, "held_out >= 2", self.held_out)
        wide = all(width >= 1 for width in self.hidden)
        require("cloning", wide, "hidden layers of at least 1 unit", self.hidden)


class CloningState(eqx.Module):
    """All that training carries from iteration to iteration."""

    policy: StochasticPolicy
    """As far as the regression has come."""
    optimiser: optax.OptState
    best: StochasticPolicy
    """The best so far on the held-out days, battery and HVAC each by itself."""
    best_loss: Float[Array, "*runs actions"]
    """Its loss there."""
    iteration: Int[Array, "*runs"]
    key: Array


class CloningProgress(eqx.Module):
    """What one iteration tells about itself."""

    training_loss: Float[Array, "*iterations"]
    """Of the days that are learned from, battery and HVAC together."""
    held_out_loss: Float[Array, "*iterations"]
    """Of the days that are not."""
    best_held_out_loss: Float[Array, "*iterations"]
    """The lowest so far, of battery and HVAC each by itself, summed."""


@dataclass(frozen=True)
class BehaviourCloning:
    """Least squares by minibatches, stopped where the held-out days say so."""

    settings: CloningSettings = field(default_factory=CloningSettings)
    space: ActionSpace = FRACTIONS
    """What the policy decides on."""

    @property
    def iterations(self) -> int:
        """How many iterations a training takes."""
        return self.settings.iterations

    def policy(self, state: CloningState) -> StochasticPolicy:
        """The best so far on the held-out days."""
        return state.best

    def start(self, task: Task[ExpertData], key: Array) -> CloningState:
        """A random policy."""
        policy_key, key = jax.random.split(key)
        policy = StochasticPolicy(self.settings.hidden, policy_key, task.environment.width, self.space)
        nothing = jnp.full(ACTIONS, jnp.inf)
        return CloningState(policy, begin(self._method(), policy), policy, nothing, jnp.zeros((), int), key)

    def iterate(self, state: CloningState, task: Task[ExpertData]) -> tuple[CloningState, CloningProgress]:
        """``steps`` of Adam on minibatches, and a look at the held-out days."""
        key, sample_key = jax.random.split(state.key)
        expert, share = task.teacher, falling(state.iteration, self.settings.iterations)
        learned, held = split_days(task, self.settings.held_out)

        def step(carry, key: Array):
            policy, optimiser = carry
            rows = jax.random.randint(key, (self.settings.batch,), 0, expert.available)
            batch = jax.tree.map(lambda x: x[rows], expert.transitions)
            gradient = jax.grad(lambda p: jnp.sum(cloning_loss(p, batch, learned[rows])))(policy)
            return descend(self._method(), gradient, optimiser, policy, share), None

        keys = jax.random.split(sample_key, self.settings.steps)
        (policy, optimiser), _ = jax.lax.scan(step, (state.policy, state.optimiser), keys)
        held_loss = cloning_loss(policy, expert.transitions, held)
        best = _better(state.best, policy, held_loss < state.best_loss)
        best_loss = jnp.minimum(held_loss, state.best_loss)
        training_loss = jnp.sum(cloning_loss(policy, expert.transitions, learned))
        progress = CloningProgress(training_loss, jnp.sum(held_loss), jnp.sum(best_loss))
        return CloningState(policy, optimiser, best, best_loss, state.iteration + 1, key), progress

    def _method(self) -> optax.GradientTransformation:
        decay = self.settings.weight_decay
        return optax.adamw(self.settings.learning_rate, weight_decay=decay, mask=_decayed)


def split_days(task: Task[ExpertData], every: int) -> tuple[Bool[Array, "samples"], Bool[Array, "samples"]]:
    """Which transitions are learned from and which are held out: the last of ``every`` days in turn.

    Whole days, because neighbouring hours tell each other's answer. Demonstrations of fewer days than
    ``every`` are cut into that many parts instead.
    """
    expert = task.teacher
    index = jnp.arange(expert.transitions.fractions.shape[0])
    day = jnp.round(24 / task.environment.home.slot_length).astype(int)
    part = jnp.maximum(jnp.minimum(day, expert.available // every), 1)
    held = (index // part) % every == every - 1
    shown = index < expert.available
    return shown & ~held, shown & held


def cloning_loss(
    policy: StochasticPolicy, transitions: Transitions, counted: Bool[Array, "samples"]
) -> Float[Array, "actions"]:
    """Mean square of the space's error over the transitions that count, of battery and HVAC."""
    means = jax.vmap(policy.mean)(transitions.features)
    error = policy.space.error(means, transitions.fractions, transitions.reach)
    squares = jnp.where(counted[:, None], error**2, 0.0)
    return jnp.sum(squares, axis=0) / jnp.maximum(jnp.sum(counted), 1)


def _decayed(policy: StochasticPolicy) -> StochasticPolicy:
    """Which leaves decay: the weights of the network. The affine part has no more freedom than the law."""
    rest = jax.tree.map(lambda _: False, policy)
    return eqx.tree_at(lambda t: t.network.weights, rest, tuple(True for _ in policy.network.weights))


def _better(
    best: StochasticPolicy, policy: StochasticPolicy, improved: Bool[Array, "actions"]
) -> StochasticPolicy:
    """The parts of ``policy`` that improved, the rest of ``best``: battery and HVAC share no weights."""
    battery = improved[0]
    network = jax.tree.map(lambda b, p: jnp.where(battery, p, b), best.network, policy.network)
    return eqx.tree_at(
        lambda t: (t.network, t.linear, t.bias),
        best,
        (
            network,
            jnp.where(improved[:, None], policy.linear, best.linear),
            jnp.where(improved, policy.bias, best.bias),
        ),
    )
