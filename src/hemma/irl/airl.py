"""Algorithm 1 of the paper: adversarial inverse reinforcement learning, or imitation, from demonstrations."""

from dataclasses import dataclass, field

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float, Int

from hemma.home.checks import require
from hemma.irl.discriminator import cross_entropy, gradient_penalty
from hemma.irl.reward import AbstractHead, ShapedReward
from hemma.rl import ppo
from hemma.rl.descent import begin, descend
from hemma.rl.environment import Environment, Transitions, collect
from hemma.rl.exploration import Exploration, falling
from hemma.rl.policy import GaussianPolicy, log_density
from hemma.rl.ppo import PPOSettings
from hemma.rl.task import Expert, Task
from hemma.rl.training import CHUNK
from hemma.types import Array


@dataclass(frozen=True)
class AIRLSettings:
    """Sizes and rates of Algorithm 1; where a value comes from stands in ``docs/paper.md``."""

    iterations: int = 1000
    """N, a multiple of 25."""
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
    exploration: Exploration = field(default_factory=Exploration)
    """Of the policy; the expert's jitter has the same sigma."""
    ppo: PPOSettings = field(default_factory=PPOSettings)
    """Of the policy's update."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        whole = self.iterations >= CHUNK and self.iterations % CHUNK == 0
        require("airl", whole, f"iterations a multiple of {CHUNK}", self.iterations)
        for name in ("agent_rollouts", "replayed", "steps", "batch"):
            require("airl", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("learning_rate", "log_density_bound"):
            require("airl", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("airl", self.penalty >= 0, "penalty >= 0", self.penalty)
        require(
            "airl", all(width >= 1 for width in self.hidden), "hidden layers of at least 1 unit", self.hidden
        )


class TrainingState(eqx.Module):
    """All that training carries from iteration to iteration: save it, and training goes on the same."""

    learner: ppo.Learner
    """pi_n with its value function and optimiser."""
    head: AbstractHead
    """AIRL: r_n."""
    head_optimiser: optax.OptState
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


@dataclass(frozen=True)
class AdversarialImitation:
    """Algorithm 1 with the head of AIRL (the paper), or with that of GAIL: one loop, two arguments."""

    settings: AIRLSettings = field(default_factory=AIRLSettings)
    head: type[AbstractHead] = ShapedReward

    @property
    def iterations(self) -> int:
        """N."""
        return self.settings.iterations

    def policy(self, state: TrainingState) -> GaussianPolicy:
        """The averaged policy."""
        return state.average

    def start(self, task: Task[Expert], key: Array) -> TrainingState:
        """Initial policy pi_0 and reward r_0; the replay is filled with transitions of pi_0."""
        settings = self.settings
        learner_key, head_key, replay_key, key = jax.random.split(key, 4)
        learner = ppo.start(settings.ppo, learner_key)
        head = self.head.random(settings.hidden, settings.ppo.discount, head_key)
        deviation = self._deviation(jnp.zeros(()))
        keys = jax.random.split(replay_key, settings.replayed)
        replay = jax.vmap(lambda k: self._agent(task.environment, learner, deviation, k))(keys)
        return TrainingState(
            learner=learner,
            head=head,
            head_optimiser=begin(_optimiser(settings), head),
            replay=replay,
            average=learner.networks.policy,
            iteration=jnp.zeros((), int),
            key=key,
        )

    def iterate(self, state: TrainingState, task: Task[Expert]) -> tuple[TrainingState, Progress]:
        """One iteration n of Algorithm 1 (its lines 3 to 10)."""
        settings, n = self.settings, state.iteration
        key, collect_key, head_key, trajectory_key, update_key = jax.random.split(state.key, 5)
        policy, deviation = state.learner.networks.policy, self._deviation(n)

        # Learn the reward function of the home (lines 3 to 8).
        fresh = self._agent(task.environment, state.learner, deviation, collect_key)
        replay = jax.tree.map(lambda old, new: old.at[n % settings.replayed].set(new), state.replay, fresh)
        contest = Contest(task.teacher, replay, policy, deviation)
        head, head_optimiser, measured = learn_head(
            state.head, state.head_optimiser, contest, settings, head_key
        )

        # Train the energy management policy (lines 9 and 10).
        shape = (settings.ppo.slots, settings.ppo.rollouts)
        rollout = collect(task.environment, policy, deviation, shape, trajectory_key)
        rewards = head.rewards(rollout.transitions)
        objective = ppo.Objective(rewards, deviation, share=falling(n, settings.iterations))
        learner = ppo.update(state.learner, rollout, objective, settings.ppo, update_key)

        average = settings.exploration.averaged(state.average, learner.networks.policy, n)
        progress = Progress(
            *measured,
            learned_reward=jnp.mean(rewards),
            energy_cost=jnp.mean(rollout.costs.transaction + rollout.costs.ageing),
            temperature_deviation=jnp.mean(rollout.costs.temperature_deviation),
        )
        return TrainingState(learner, head, head_optimiser, replay, average, n + 1, key), progress

    def _deviation(self, iteration: Array) -> Float[Array, "actions"]:
        return self.settings.exploration.deviation(iteration, self.settings.iterations)

    def _agent(
        self, environment: Environment, learner: ppo.Learner, deviation: Array, key: Array
    ) -> Transitions:
        shape = (self.settings.ppo.slots, self.settings.agent_rollouts)
        rollout = collect(environment, learner.networks.policy, deviation, shape, key)
        return jax.tree.map(lambda x: x.reshape(-1, x.shape[-1]), rollout.transitions)


class Contest(eqx.Module):
    """What the discriminator has to tell apart."""

    expert: Expert
    replay: Transitions
    """Of the agent, (replayed, samples, ...)."""
    policy: GaussianPolicy
    """Present policy: log pi of both sides is taken under it, without gradient."""
    deviation: Float[Array, "actions"]
    """Its sigma, and that of the expert's jitter."""

    def density(self, transitions: Transitions, bound: float) -> Float[Array, "samples"]:
        """log pi(a|s) within plus and minus ``bound``: an action far from the mean would otherwise have an
        unbounded logit, and its reward no gradient."""
        means = jax.vmap(self.policy.mean)(transitions.features)
        return jnp.clip(log_density(transitions.fractions, means, self.deviation), -bound, bound)

    def sample(self, batch: int, key: Array) -> tuple[Transitions, Transitions]:
        """So many transitions of the expert, jittered, and as many of the agent."""
        expert_key, jitter_key, agent_key = jax.random.split(key, 3)
        rows = jax.random.randint(expert_key, (batch,), 0, self.expert.available)
        experts = jax.tree.map(lambda x: x[rows], self.expert.transitions)
        jitter = self.deviation * jax.random.normal(jitter_key, experts.fractions.shape)
        experts = eqx.tree_at(lambda t: t.fractions, experts, experts.fractions + jitter)
        agent = jax.tree.map(lambda x: x.reshape(-1, x.shape[-1]), self.replay)
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
        penalty = gradient_penalty(head, experts, agents, key)
        measured = (loss, jnp.mean(expert_logits > 0), jnp.mean(agent_logits < 0))
        return loss + settings.penalty * penalty, measured

    def step(carry, key: Array):
        head, optimiser_state = carry
        sample_key, penalty_key = jax.random.split(key)
        batches = contest.sample(settings.batch, sample_key)
        gradient, measured = jax.grad(objective, has_aux=True)(head, *batches, penalty_key)
        return descend(_optimiser(settings), gradient, optimiser_state, head), measured

    keys = jax.random.split(key, settings.steps)
    (head, optimiser_state), measured = jax.lax.scan(step, (head, optimiser_state), keys)
    return head, optimiser_state, jax.tree.map(jnp.mean, measured)


def _optimiser(settings: AIRLSettings) -> optax.GradientTransformation:
    return optax.adam(settings.learning_rate, b1=0.5)
