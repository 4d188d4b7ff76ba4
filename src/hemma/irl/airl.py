"""Algorithm 1 of the paper: adversarial inverse reinforcement learning from demonstrations."""

from dataclasses import dataclass, field

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.irl.discriminator import cross_entropy, gradient_penalty, logits
from hemma.irl.reward import ShapedReward
from hemma.rl import ppo
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Environment, Transitions, collect
from hemma.rl.policy import GaussianPolicy, log_density
from hemma.rl.ppo import PPOSettings
from hemma.types import Array

CHUNK = 25
"""Iterations between two looks at a run: one row of its learning curve, one occasion to save it."""


@dataclass(frozen=True)
class AIRLSettings:
    """Sizes and rates of Algorithm 1; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 1000
    """N, a multiple of 25."""
    first_deviation: tuple[float, float] = (0.2, 0.15)
    """sigma at the first iteration: standard deviation of the policy's fractions (battery, HVAC) and of the
    expert's jitter."""
    last_deviation: tuple[float, float] = (0.2, 0.05)
    """sigma once it has shrunk, geometrically, over the first ``shrinking`` of the iterations."""
    shrinking: float = 0.8
    """Share of the iterations over which sigma shrinks."""
    agent_rollouts: int = 16
    """Rollouts collected for the discriminator in an iteration."""
    replayed: int = 8
    """Iterations whose agent transitions the discriminator still sees."""
    steps: int = 4
    """Discriminator updates an iteration."""
    batch: int = 512
    """Expert and as many agent transitions an update, I / 2."""
    learning_rate: float = 1e-3
    """Of the discriminator's Adam."""
    penalty: float = 1.0
    """Weight of the gradient penalty."""
    log_density_bound: float = 10.0
    """log pi enters the logit within plus and minus this."""
    hidden: tuple[int, ...] = (64,)
    """Units of the hidden layers of g, and of h."""
    averaging: float = 0.99
    """Share of the old average kept an iteration in the averaged policy, which is the result."""
    ppo: PPOSettings = field(default_factory=PPOSettings)
    """Of the policy's update."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("airl", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("agent_rollouts", "replayed", "steps", "batch"):
            require("airl", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("first_deviation", "last_deviation"):
            value = getattr(self, name)
            require("airl", len(value) == 2 and min(value) > 0, f"{name} two numbers > 0", value)
        for name in ("learning_rate", "log_density_bound"):
            require("airl", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("airl", self.penalty >= 0, "penalty >= 0", self.penalty)
        require("airl", 0 < self.shrinking <= 1, "0 < shrinking <= 1", self.shrinking)
        require("airl", 0 <= self.averaging < 1, "0 <= averaging < 1", self.averaging)
        require(
            "airl", all(width >= 1 for width in self.hidden), "hidden layers of at least 1 unit", self.hidden
        )


class Expert(eqx.Module):
    """The demonstrations, as the discriminator samples them."""

    transitions: Transitions
    """Shape (L + padding, ...)."""
    available: Int[Array, ""]
    """L; what lies behind is padding and never read."""


class TrainingState(eqx.Module):
    """All that training carries from iteration to iteration: save it, and training goes on the same."""

    learner: ppo.Learner
    """pi_n with its value function and optimiser."""
    reward: ShapedReward
    """r_n."""
    reward_optimiser: optax.OptState
    replay: Transitions
    """Agent transitions of the last iterations, (replayed, samples, ...)."""
    average: GaussianPolicy
    """Exponential moving average of the policy's weights."""
    iteration: Int[Array, ""]
    key: Array


class Progress(eqx.Module):
    """What one iteration tells about itself."""

    discriminator_loss: Float[Array, "*iterations"]
    expert_accuracy: Float[Array, "*iterations"]
    """Share of the expert's transitions taken for the expert's."""
    agent_accuracy: Float[Array, "*iterations"]
    """Share of the agent's transitions taken for the agent's."""
    learned_reward: Float[Array, "*iterations"]
    """Mean r of the agent's transitions."""
    energy_cost: Float[Array, "*iterations"]
    """Mean X1 + X2 a slot of the exploring agent [currency]; shown, never used."""
    temperature_deviation: Float[Array, "*iterations"]
    """Mean X3 of the exploring agent [degC]; shown, never used."""


def deviation_at(iteration: Array, settings: AIRLSettings) -> Float[Array, "actions"]:
    """sigma at an iteration: coarse strokes first, fine ones later."""
    first, last = jnp.asarray(settings.first_deviation), jnp.asarray(settings.last_deviation)
    share = jnp.minimum(iteration / (settings.shrinking * settings.iterations), 1.0)
    return first * (last / first) ** share


def start(environment: Environment, settings: AIRLSettings, key: Array) -> TrainingState:
    """Initial policy pi_0 and reward r_0; the replay is filled with transitions of pi_0."""
    learner_key, reward_key, replay_key, key = jax.random.split(key, 4)
    learner = ppo.start(settings.ppo, learner_key)
    reward = ShapedReward(settings.hidden, settings.ppo.discount, reward_key)
    deviation = deviation_at(jnp.zeros(()), settings)
    keys = jax.random.split(replay_key, settings.replayed)
    replay = jax.vmap(lambda k: _agent_transitions(environment, learner, deviation, settings, k))(keys)
    return TrainingState(
        learner=learner,
        reward=reward,
        reward_optimiser=begin(_optimiser(settings), reward),
        replay=replay,
        average=learner.networks.policy,
        iteration=jnp.zeros((), int),
        key=key,
    )


def iterate(
    state: TrainingState, environment: Environment, expert: Expert, settings: AIRLSettings
) -> tuple[TrainingState, Progress]:
    """One iteration n of Algorithm 1 (its lines 3 to 10)."""
    key, collect_key, reward_key, trajectory_key, update_key = jax.random.split(state.key, 5)
    policy, deviation = state.learner.networks.policy, deviation_at(state.iteration, settings)

    # Learn the reward function of the home (lines 3 to 8).
    fresh = _agent_transitions(environment, state.learner, deviation, settings, collect_key)
    replay = jax.tree.map(
        lambda old, new: old.at[state.iteration % settings.replayed].set(new), state.replay, fresh
    )
    reward, reward_optimiser, measured = _learn_reward(state, expert, replay, settings, reward_key)

    # Train the energy management policy (lines 9 and 10).
    shape = (settings.ppo.slots, settings.ppo.rollouts)
    rollout = collect(environment, policy, deviation, shape, trajectory_key)
    rewards = reward.batch(rollout.transitions)
    objective = ppo.Objective(rewards, deviation, share=1.0 - 0.9 * state.iteration / settings.iterations)
    learner = ppo.update(state.learner, rollout, objective, settings.ppo, update_key)

    keep = jnp.minimum(settings.averaging, state.iteration / (state.iteration + 10.0))
    average = jax.tree.map(lambda a, p: keep * a + (1 - keep) * p, state.average, learner.networks.policy)
    progress = Progress(
        *measured,
        learned_reward=jnp.mean(rewards),
        energy_cost=jnp.mean(rollout.costs.transaction + rollout.costs.ageing),
        temperature_deviation=jnp.mean(rollout.costs.temperature_deviation),
    )
    return TrainingState(
        learner, reward, reward_optimiser, replay, average, state.iteration + 1, key
    ), progress


def _agent_transitions(
    environment: Environment, learner: ppo.Learner, deviation: Array, settings: AIRLSettings, key: Array
) -> Transitions:
    shape = (settings.ppo.slots, settings.agent_rollouts)
    rollout = collect(environment, learner.networks.policy, deviation, shape, key)
    return jax.tree.map(lambda x: x.reshape(-1, x.shape[-1]), rollout.transitions)


def _optimiser(settings: AIRLSettings) -> optax.GradientTransformation:
    return optax.adam(settings.learning_rate, b1=0.5)


def _learn_reward(
    state: TrainingState, expert: Expert, replay: Transitions, settings: AIRLSettings, key: Array
) -> tuple[ShapedReward, optax.OptState, tuple[Array, Array, Array]]:
    """r_{n+1}, its optimiser, and (loss, expert accuracy, agent accuracy) as means over the steps."""
    deviation = deviation_at(state.iteration, settings)
    policy = state.learner.networks.policy
    agent = jax.tree.map(lambda x: x.reshape(-1, x.shape[-1]), replay)

    def density(transitions: Transitions) -> Array:
        means = jax.vmap(policy.mean)(transitions.features)
        return log_density(transitions.fractions, means, deviation)

    def sample(source: Transitions, available: Array | int, key: Array) -> Transitions:
        rows = jax.random.randint(key, (settings.batch,), 0, available)
        return jax.tree.map(lambda x: x[rows], source)

    def objective(reward: ShapedReward, experts: Transitions, agents: Transitions, key: Array):
        expert_logits = logits(reward, experts, density(experts), settings.log_density_bound)
        agent_logits = logits(reward, agents, density(agents), settings.log_density_bound)
        loss = cross_entropy(expert_logits, agent_logits)
        penalty = gradient_penalty(reward, experts, agents, key)
        measured = (loss, jnp.mean(expert_logits > 0), jnp.mean(agent_logits < 0))
        return loss + settings.penalty * penalty, measured

    def step(carry, key: Array):
        reward, optimiser_state = carry
        expert_key, jitter_key, agent_key, penalty_key = jax.random.split(key, 4)
        experts = sample(expert.transitions, expert.available, expert_key)
        jitter = deviation * jax.random.normal(jitter_key, experts.fractions.shape)
        experts = eqx.tree_at(lambda t: t.fractions, experts, experts.fractions + jitter)
        agents = sample(agent, agent.fractions.shape[0], agent_key)
        gradient, measured = jax.grad(objective, has_aux=True)(reward, experts, agents, penalty_key)
        return descend(_optimiser(settings), gradient, optimiser_state, reward), measured

    keys = jax.random.split(key, settings.steps)
    (reward, optimiser_state), measured = jax.lax.scan(step, (state.reward, state.reward_optimiser), keys)
    return reward, optimiser_state, jax.tree.map(jnp.mean, measured)
