"""The environment of a learner: a home that replays its training traces, in rollouts of fixed length."""

from collections.abc import Callable
from typing import TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float, Int

from hemma.home import Home, HomeState, Step, observe, paper_state
from hemma.rl.policies.action_space import ActionSpace, Deed
from hemma.rl.policies.policy import FEATURES, StochasticPolicy
from hemma.rl.policies.scaling import SELLING, StateScaler
from hemma.types import Array, Costs, Exogenous

Tree = TypeVar("Tree")


class Transitions(eqx.Module):
    """Transitions (s, a, s') of a learner; states are in features, actions as deeds are read."""

    features: Float[Array, "*batch features"]
    """s, scaled."""
    fractions: Float[Array, "*batch actions"]
    """a, as ``Deed.fractions``."""
    next_features: Float[Array, "*batch features"]
    """s', scaled."""
    reach: Float[Array, "*batch bounds"]
    """As ``Deed.reach``."""


def flattened(tree: Tree) -> Tree:
    """Leaves of shape (slots, rollouts, ...) as (samples, ...)."""
    return jax.tree.map(lambda x: x.reshape(x.shape[0] * x.shape[1], *x.shape[2:]), tree)


class Rollout(eqx.Module):
    """What a policy did: one slot, or ``slots`` slots of ``rollouts`` rollouts, (slots, rollouts, ...)."""

    transitions: Transitions
    log_density: Float[Array, "*batch"]
    """log pi(a|s) under the policy that acted."""
    surprise: Float[Array, "*batch"]
    """As ``ActionSpace.surprise``; its mean is an entropy."""
    costs: Costs
    """X1, X2, X3 of the home. No learner of the paper's method reads them; explicit rewards do."""


class Environment(eqx.Module):
    """A home, what is known of it, and the traces it replays, seen through a scaler.

    It never terminates: after the last slot of the traces comes the first. Replay whole days, so that the
    clock goes on where it was.
    """

    planning_home: Home
    """The home as far as the learner knows it, with an identified thermal model: what turns its fractions
    into powers."""
    home: Home
    """The home that reacts."""
    exogenous: Exogenous
    available: Int[Array, ""]
    """How many slots of ``exogenous`` may be replayed; what lies behind them is padding and never read."""
    scaler: StateScaler
    context: Float[Array, "slots figures"]
    """What is seen in each slot besides the paper's state, scaled: the selling price where the state does not
    tell it, and the figures of a context; nothing in the paper's method."""

    @property
    def width(self) -> int:
        """How many features a policy sees."""
        return FEATURES + self.context.shape[-1]

    def seen_through(self, scaler: StateScaler) -> "Environment":
        """The same through another scaler, which may know a selling price of its own shape or not."""
        others = self.context[:, self.scaler.centre.shape[-1] - SELLING :]
        seen = jnp.concatenate([scaler.selling(self.exogenous.selling_price), others], axis=1)
        return eqx.tree_at(lambda e: (e.scaler, e.context), self, (scaler, seen))

    def reset(self, key: Array) -> tuple[HomeState, Array]:
        """A random first slot of the traces, battery level and indoor temperature.

        E is uniform over the battery's range; T_in is uniform over the comfort band and one degree beyond.
        """
        start_key, energy_key, temperature_key = jax.random.split(key, 3)
        start = jax.random.randint(start_key, (), 0, self.available)
        battery, comfort = self.home.battery, self.home.comfort
        energy = jax.random.uniform(energy_key, minval=battery.min_energy, maxval=battery.max_energy)
        temperature = jax.random.uniform(temperature_key, minval=comfort.low - 1, maxval=comfort.high + 1)
        return self.home.reset(energy, temperature), start

    def at(self, slot: Array) -> Exogenous:
        """Exogenous values of a slot, counted on beyond the last one."""
        return jax.tree.map(lambda x: x[slot % self.available], self.exogenous)

    def features(self, state: HomeState, slot: Array) -> Float[Array, "features"]:
        """The scaled state of the paper when the home stands at the start of ``slot``, and the context."""
        seen = self.scaler(paper_state(observe(state, self.at(slot))))
        return jnp.concatenate([seen, self.context[slot % self.available]])

    def step(
        self, state: HomeState, start: Array, decision: Array, space: ActionSpace, disturbance: Array
    ) -> tuple[Step, Deed]:
        """One slot of a rollout that began in the slot ``start``, and what the decision was read as."""
        now = self.at(start + state.slot)
        deed = space.carry_out(self.planning_home, observe(state, now), decision, self.scaler)
        return self.home.step(state, now, deed.action, disturbance), deed


def collect(
    environment: Environment,
    policy: StochasticPolicy,
    deviation: Float[Array, "actions"],
    shape: tuple,
    key: Array,
) -> Rollout:
    """Let the policy explore with this ``deviation``; ``shape`` is (slots, rollouts)."""
    slots, rollouts = shape
    reset_key, noise_key, disturbance_key = jax.random.split(key, 3)
    states, starts = jax.vmap(environment.reset)(jax.random.split(reset_key, rollouts))
    noise = policy.space.noise(noise_key, (slots, rollouts)) * deviation
    begin = (states, starts, jax.vmap(environment.features)(states, starts))

    def act(features: Array, noise: Array) -> tuple[Array, Callable[[Deed], tuple[Array, Array]]]:
        mean = policy.mean(features)

        def judge(deed: Deed) -> tuple[Array, Array]:
            density = policy.space.log_density(deed.fractions, deed.reach, mean, deviation)
            return density, policy.space.surprise(deed.reach, mean, deviation)

        return mean + noise, judge

    return rolled_out(environment, policy.space, act, begin, noise, disturbance_key)


def rolled_out(
    environment: Environment,
    space: ActionSpace,
    act: Callable[[Array, Array], tuple[Array, Callable[[Deed], tuple[Array, Array]]]],
    begin: tuple[HomeState, Int[Array, "rollouts"], Float[Array, "rollouts features"]],
    given: Array,
    key: Array,
) -> Rollout:
    """The one loop of learners, for rollouts side by side, (slots, rollouts, ...).

    ``act(features, given)`` tells a decision of the ``space``, and how likely and surprising the deed is
    that comes of it; ``given`` has one entry a slot and rollout.
    The rollouts ``begin`` with these states of the home, slots of the traces, and features.
    """
    states, starts, features = begin
    slots, rollouts = given.shape[:2]
    keys = jax.random.split(key, rollouts)
    disturbances = jax.vmap(lambda k: environment.home.disturbances(k, slots))(keys).T

    def one(state: HomeState, start: Array, features: Array, given: Array, disturbance: Array):
        decision, judge = act(features, given)
        step, deed = environment.step(state, start, decision, space, disturbance)
        after = environment.features(step.state, start + state.slot + 1)
        transition = Transitions(features, deed.fractions, after, deed.reach)
        return step.state, Rollout(transition, *judge(deed), step.costs)

    def slot(carry: tuple[HomeState, Array], inputs: tuple[Array, Array]):
        states, features = carry
        states, rollout = jax.vmap(one)(states, starts, features, *inputs)
        return (states, rollout.transitions.next_features), rollout

    return jax.lax.scan(slot, (states, features), (given, disturbances))[1]
