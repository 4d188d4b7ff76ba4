"""Algorithm 1 of the paper: adversarial inverse reinforcement learning, or imitation, from demonstrations."""

from dataclasses import dataclass, field
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.irl.discriminator import cross_entropy, gradient_penalty
from hemma.irl.reward import AbstractHead, ShapedReward
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Rollout, Transitions, flattened
from hemma.rl.improvement import Effort, PolicyImprovement, Proximal, measured, standard
from hemma.rl.policies.exploration import Exploration, falling
from hemma.rl.policies.policy import StochasticPolicy
from hemma.rl.task import ExpertData, Task
from hemma.rl.training import CHUNK
from hemma.types import Array


@dataclass(frozen=True)
class AIRLSettings:
    """Sizes and rates of Algorithm 1; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 500
    """N, a multiple of 25."""
    members: int = 3
    """Agents that learn by themselves, each with its own reward; the mean of their actions is the result."""
    rollouts: int = 32
    """Rollouts of an agent in an iteration, in the place of the number that PPO's settings have."""
    agent_rollouts: int = 8
    """How many of them the discriminator sees."""
    replayed: int = 8
    """Iterations whose agent transitions the discriminator still sees."""
    steps: int = 4
    """Discriminator updates an iteration."""
    batch: int = 512
    """Expert transitions and as many agent transitions an update, I / 2."""
    learning_rate: float = 5e-3
    """Of the discriminator's Adam."""
    penalty: float = 0.0
    """Weight of the gradient penalty at first."""
    relaxing: float = 1.0
    """Share of the iterations over which that weight falls to 0, linearly."""
    entropy: float = 0.3
    """Weight of the policy's entropy beside the reward, where the policy can change it (`stored value`)."""
    log_density_bound: float = 10.0
    """log pi enters the logit within plus and minus this."""
    hidden: tuple[int, ...] = (64,)
    """Units of the hidden layers of g, and of h."""
    exploration: Exploration = field(default_factory=Exploration)
    """Of the policy; the expert's jitter has the same sigma."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("airl", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("members", "agent_rollouts", "replayed", "steps", "batch"):
            require("airl", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        seen = self.agent_rollouts <= self.rollouts
        require("airl", seen, "agent_rollouts <= rollouts", self.agent_rollouts)
        for name in ("learning_rate", "log_density_bound"):
            require("airl", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        for name in ("penalty", "entropy"):
            require("airl", getattr(self, name) >= 0, f"{name} >= 0", getattr(self, name))
        require("airl", 0 < self.relaxing <= 1, "0 < relaxing <= 1", self.relaxing)
        require(
            "airl", all(width >= 1 for width in self.hidden), "hidden layers of at least 1 unit", self.hidden
        )

    def penalty_at(self, iteration: Array) -> Float[Array, ""]:
        """Weight of the gradient penalty at an iteration: the head is smooth first, and sharp later."""
        return self.penalty * jnp.maximum(1.0 - iteration / (self.relaxing * self.iterations), 0.0)


class ImitationState(eqx.Module):
    """All that training carries from iteration to iteration: save it, and training goes on the same."""

    learner: Any
    """pi_n and what its improvement carries on."""
    head: AbstractHead
    """AIRL: r_n."""
    head_optimiser: optax.OptState
    replay: Transitions
    """Agent transitions of the last iterations, (replayed, samples, ...)."""
    average: StochasticPolicy
    """Exponential moving average of the policy's weights."""
    iteration: Int[Array, ""]
    key: Array


class ImitationProgress(eqx.Module):
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


@dataclass(frozen=True)
class AdversarialImitation:
    """Algorithm 1. Its arguments make it AIRL by PPO (the paper), or GAIL."""

    settings: AIRLSettings = field(default_factory=AIRLSettings)
    improvement: PolicyImprovement = field(default_factory=Proximal)
    head: type[AbstractHead] = ShapedReward

    @property
    def iterations(self) -> int:
        """N."""
        return self.settings.iterations

    def policy(self, state: ImitationState) -> StochasticPolicy:
        """The averaged policy."""
        return state.average

    def start(self, task: Task[ExpertData], key: Array) -> ImitationState:
        """Initial policy pi_0 and reward r_0; the replay is filled with transitions of pi_0."""
        settings, width = self.settings, task.environment.width
        learner_key, head_key, replay_key, key = jax.random.split(key, 4)
        learner = self.improvement.start(learner_key, width)
        policy = self.improvement.policy(learner)
        head = self.head.random(settings.hidden, self.improvement.discount, head_key, width)
        effort = Effort(self._deviation(jnp.zeros(())))

        def kept(key: Array) -> Transitions:
            return self._kept(self.improvement.explore(learner, task.environment, effort, key))

        replay = jax.vmap(kept)(jax.random.split(replay_key, settings.replayed))
        return ImitationState(
            learner=learner,
            head=head,
            head_optimiser=begin(_optimiser(settings), head),
            replay=replay,
            average=policy,
            iteration=jnp.zeros((), int),
            key=key,
        )

    def iterate(
        self, state: ImitationState, task: Task[ExpertData]
    ) -> tuple[ImitationState, ImitationProgress]:
        """One iteration n of Algorithm 1 (its lines 3 to 10)."""
        settings, n = self.settings, state.iteration
        key, explore_key, head_key, improve_key = jax.random.split(state.key, 4)
        effort = Effort(self._deviation(n), falling(n, settings.iterations))
        rollout = self.improvement.explore(state.learner, task.environment, effort, explore_key)

        # Learn the reward function of the home (lines 3 to 8).
        fresh = self._kept(rollout)
        replay = jax.tree.map(lambda old, new: old.at[n % settings.replayed].set(new), state.replay, fresh)
        policy, penalty = self.improvement.policy(state.learner), settings.penalty_at(n)
        contest = Contest(task.teacher, replay, policy, effort.deviation, penalty)
        head, head_optimiser, judged = learn_head(
            state.head, state.head_optimiser, contest, settings, head_key
        )

        # Train the energy management policy (lines 9 and 10).
        rewards = head.rewards(rollout.transitions) + settings.entropy * head.entropy_share * rollout.surprise
        learner = self.improvement.improve(state.learner, rollout, standard(rewards), effort, improve_key)
        average = settings.exploration.averaged(state.average, self.improvement.policy(learner), n)
        seen = measured(rollout, rewards)
        progress = ImitationProgress(*judged, seen.reward, seen.energy_cost, seen.temperature_deviation)
        return ImitationState(learner, head, head_optimiser, replay, average, n + 1, key), progress

    def _deviation(self, iteration: Array) -> Float[Array, "actions"]:
        return self.settings.exploration.deviation(iteration, self.settings.iterations)

    def _kept(self, rollout: Rollout) -> Transitions:
        """The transitions of the first rollouts, (samples, ...)."""
        first = jax.tree.map(lambda x: x[:, : self.settings.agent_rollouts], rollout.transitions)
        return flattened(first)


class Contest(eqx.Module):
    """What the discriminator has to tell apart, and how smoothly."""

    expert: ExpertData
    replay: Transitions
    """Of the agent, (replayed, samples, ...)."""
    policy: StochasticPolicy
    """Present policy: log pi of both sides is taken under it, without gradient."""
    deviation: Float[Array, "actions"]
    """Its sigma, and that of the expert's jitter."""
    penalty: Array | float = 0.0
    """Weight of the gradient penalty."""

    def density(self, transitions: Transitions, bound: float) -> Float[Array, "samples"]:
        """log pi(a|s) within plus and minus ``bound``: an action far from the mean would otherwise have an
        unbounded logit, and its reward no gradient."""
        means, space = jax.vmap(self.policy.mean)(transitions.features), self.policy.space
        density = space.log_density(transitions.fractions, transitions.reach, means, self.deviation)
        return jnp.clip(density, -bound, bound)

    def sample(self, batch: int, key: Array) -> tuple[Transitions, Transitions]:
        """So many transitions of the expert, jittered, and as many of the agent."""
        expert_key, jitter_key, agent_key = jax.random.split(key, 3)
        rows = jax.random.randint(expert_key, (batch,), 0, self.expert.available)
        experts = jax.tree.map(lambda x: x[rows], self.expert.transitions)
        jitter = self.deviation * self.policy.space.jitter(jitter_key, (batch,))
        experts = eqx.tree_at(lambda t: t.fractions, experts, experts.fractions + jitter)
        agent = flattened(self.replay)
        rows = jax.random.randint(agent_key, (batch,), 0, agent.fractions.shape[0])
        return experts, jax.tree.map(lambda x: x[rows], agent)


def learn_head(
    head: AbstractHead, optimiser_state: optax.OptState, contest: Contest, settings: AIRLSettings, key: Array
) -> tuple[AbstractHead, optax.OptState, tuple[Array, Array, Array]]:
    """The better discriminator, its optimiser, and (loss, expert accuracy, agent accuracy) over the steps."""

    def objective(head: AbstractHead, experts: Transitions, agents: Transitions, key: Array):
        bound = settings.log_density_bound
        expert_logits = head.logits(experts, contest.density(experts, bound))
        agent_logits = head.logits(agents, contest.density(agents, bound))
        loss = cross_entropy(expert_logits, agent_logits)
        judged = (loss, jnp.mean(expert_logits > 0), jnp.mean(agent_logits < 0))
        return loss + contest.penalty * gradient_penalty(head, experts, agents, key), judged

    def step(carry, key: Array):
        head, optimiser_state = carry
        sample_key, penalty_key = jax.random.split(key)
        batches = contest.sample(settings.batch, sample_key)
        gradient, judged = jax.grad(objective, has_aux=True)(head, *batches, penalty_key)
        return descend(_optimiser(settings), gradient, optimiser_state, head), judged

    keys = jax.random.split(key, settings.steps)
    (head, optimiser_state), judged = jax.lax.scan(step, (head, optimiser_state), keys)
    return head, optimiser_state, jax.tree.map(jnp.mean, judged)


def _optimiser(settings: AIRLSettings) -> optax.GradientTransformation:
    return optax.adam(settings.learning_rate, b1=0.5)
