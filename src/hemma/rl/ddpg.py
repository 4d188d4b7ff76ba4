"""Deep deterministic policy gradient (Lillicrap et al. 2016, arXiv 1509.02971) on the explicit reward."""

from dataclasses import dataclass, field, replace

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.rl.critic import Critic
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Transitions, collect, flattened
from hemma.rl.explicit import scaled_reward
from hemma.rl.improvement import RolloutMeans, measured
from hemma.rl.policies.exploration import Exploration, falling
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.replay_buffer import Experience, Memory, empty_memory
from hemma.rl.task import ExplicitReward, Task
from hemma.rl.training import CHUNK
from hemma.types import Array


@dataclass(frozen=True)
class DDPGSettings:
    """Sizes and rates of DDPG; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 600
    """Rounds of acting and learning, a multiple of 25."""
    rollouts: int = 8
    """Homes that act side by side in a round, each from a random start."""
    slots: int = 24
    """Slots that each acts."""
    capacity: int = 24000
    """Transitions that the memory keeps."""
    steps: int = 16
    """Gradient steps of critic and actor in a round."""
    batch: int = 256
    """Transitions of a step."""
    discount: float = 0.9
    """gamma."""
    following: float = 0.01
    """tau, share of the way that the target networks go towards the learned ones in a step."""
    actor_rate: float = 1e-3
    """Of the actor's Adam at first; it falls to a tenth."""
    critic_rate: float = 2e-3
    """Of the critic's Adam at first; it falls to a tenth."""
    hidden: tuple[int, ...] = (64, 64)
    """Units of the hidden layers of the battery's mean, and of the critic."""
    exploration: Exploration = field(
        default_factory=lambda: Exploration(first_deviation=(0.5, 0.2), last_deviation=(0.15, 0.02))
    )
    """Noise on the actions; ``averaging`` plays no part here, the result is the target actor."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("ddpg", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("rollouts", "slots", "steps", "batch"):
            require("ddpg", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("actor_rate", "critic_rate"):
            require("ddpg", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("ddpg", 0 < self.discount < 1, "0 < discount < 1", self.discount)
        require("ddpg", 0 < self.following <= 1, "0 < following <= 1", self.following)
        room = self.capacity >= self.rollouts * self.slots
        require("ddpg", room, "capacity >= rollouts * slots", self.capacity)
        wide = all(width >= 1 for width in self.hidden)
        require("ddpg", wide, "hidden layers of at least 1 unit", self.hidden)


class ActorAndCritic(eqx.Module):
    """mu(s) and Q(s, a)."""

    actor: StochasticPolicy
    critic: Critic

    def value(self, features: Array, fractions: Array) -> Float[Array, "batch"]:
        """Q of a batch of states and actions."""
        return jax.vmap(self.critic)(features, fractions)

    def decision(self, features: Array) -> Float[Array, "batch actions"]:
        """mu of a batch of states."""
        return jax.vmap(self.actor.mean)(features)


class DDPGState(eqx.Module):
    """All that training carries from round to round."""

    learned: ActorAndCritic
    target: ActorAndCritic
    actor_optimiser: optax.OptState
    critic_optimiser: optax.OptState
    memory: Memory
    iteration: Int[Array, "*runs"]
    key: Array


@dataclass(frozen=True)
class DDPG:
    """The paper's benchmark of that name."""

    settings: DDPGSettings = field(default_factory=DDPGSettings)

    @property
    def iterations(self) -> int:
        """How many rounds a training takes."""
        return self.settings.iterations

    def policy(self, state: DDPGState) -> StochasticPolicy:
        """The target actor."""
        return state.target.actor

    def start(self, task: Task[ExplicitReward], key: Array) -> DDPGState:
        """Random networks, and a memory of what the random actor did."""
        width = task.environment.width
        actor_key, critic_key, act_key, key = jax.random.split(key, 4)
        actor = StochasticPolicy(self.settings.hidden, actor_key, width)
        critic = Critic(self.settings.hidden, critic_key, width)
        both = ActorAndCritic(actor, critic)
        experience, _ = self._act(task, actor, jnp.zeros((), int), act_key)
        memory = empty_memory(experience, self.settings.capacity).add(experience)
        return DDPGState(
            learned=both,
            target=both,
            actor_optimiser=begin(optax.adam(self.settings.actor_rate), actor),
            critic_optimiser=begin(optax.adam(self.settings.critic_rate), critic),
            memory=memory,
            iteration=jnp.zeros((), int),
            key=key,
        )

    def iterate(self, state: DDPGState, task: Task[ExplicitReward]) -> tuple[DDPGState, RolloutMeans]:
        """Act for a while, remember it, and learn from the memory."""
        key, act_key, learn_key = jax.random.split(state.key, 3)
        fresh, found = self._act(task, state.learned.actor, state.iteration, act_key)
        memory = state.memory.add(fresh)
        state = eqx.tree_at(lambda s: (s.memory, s.key), state, (memory, key))

        def step(state: DDPGState, key: Array) -> tuple[DDPGState, None]:
            return self._learn(state, memory.sample(self.settings.batch, key)), None

        state, _ = jax.lax.scan(step, state, jax.random.split(learn_key, self.settings.steps))
        return eqx.tree_at(lambda s: s.iteration, state, state.iteration + 1), found

    def _act(
        self, task: Task[ExplicitReward], actor: StochasticPolicy, iteration: Array, key: Array
    ) -> tuple[Experience, RolloutMeans]:
        deviation = self.settings.exploration.deviation(iteration, self.settings.iterations)
        shape = (self.settings.slots, self.settings.rollouts)
        rollout = collect(task.environment, actor, deviation, shape, key)
        rewards = scaled_reward(rollout, task)
        transitions = rollout.transitions
        done = jnp.clip(transitions.fractions, -1.0, 1.0)  # what the home took
        transitions = replace(transitions, fractions=done)
        return flattened(Experience(transitions, rewards)), measured(rollout, rewards)

    def _learn(self, state: DDPGState, batch: Experience) -> DDPGState:
        """One step of the critic, one of the actor, and the targets a little after them."""
        settings, learned = self.settings, state.learned
        share = falling(state.iteration, settings.iterations)
        targets = bellman_targets(state.target, batch, settings.discount)
        slope = jax.grad(critic_loss)(learned.critic, learned.actor, batch.transitions, targets)
        critic, critic_optimiser = descend(
            optax.adam(settings.critic_rate), slope, state.critic_optimiser, learned.critic, share
        )
        slope = jax.grad(actor_loss)(learned.actor, critic, batch.transitions)
        actor, actor_optimiser = descend(
            optax.adam(settings.actor_rate), slope, state.actor_optimiser, learned.actor, share
        )
        learned = ActorAndCritic(actor, critic)
        target = followed(state.target, learned, settings.following)
        return DDPGState(
            learned, target, actor_optimiser, critic_optimiser, state.memory, state.iteration, state.key
        )


def bellman_targets(target: ActorAndCritic, batch: Experience, discount: float) -> Float[Array, "batch"]:
    """y = r + gamma Q'(s', mu'(s')): a home never terminates, so every target is bootstrapped."""
    following = batch.transitions.next_features
    decision = jnp.clip(target.decision(following), -1.0, 1.0)
    return batch.rewards + discount * target.value(following, decision)


def critic_loss(
    critic: Critic, actor: StochasticPolicy, transitions: Transitions, targets: Float[Array, "batch"]
) -> Array:
    """E[H(Q(s, a) - y)], H(x) = x^2 / 2 up to |x| = 1 and |x| - 1/2 beyond: price spikes are heavy tails."""
    value = ActorAndCritic(actor, critic).value(transitions.features, transitions.fractions)
    return jnp.mean(optax.huber_loss(value, targets))


def actor_loss(actor: StochasticPolicy, critic: Critic, transitions: Transitions) -> Array:
    """-E[Q(s, mu(s))], Q taken at what the home does: the bound, where mu lies beyond it.

    The gradient passes as if mu were not bounded. Without the bound the critic would be asked about actions
    that never occurred, and the actor would follow its guess outwards; without the gradient it would stick.
    """
    both = ActorAndCritic(actor, critic)
    decision = both.decision(transitions.features)
    done = decision + jax.lax.stop_gradient(jnp.clip(decision, -1.0, 1.0) - decision)
    return -jnp.mean(both.value(transitions.features, done))


def followed(target: ActorAndCritic, learned: ActorAndCritic, share: float) -> ActorAndCritic:
    """The target networks, a ``share`` tau nearer to the learned ones."""
    return jax.tree.map(lambda t, x: (1 - share) * t + share * x, target, learned)
