"""The environment of a learner: a home that replays its training traces, in rollouts of fixed length."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float, Int

from hemma.home import Home, HomeState, Step, observe, paper_state
from hemma.rl.policies.actions import to_power
from hemma.rl.policies.policy import FEATURES, GaussianPolicy, log_density
from hemma.rl.policies.scaling import SELLING, StateScaler
from hemma.types import Array, Costs, Exogenous


class Transitions(eqx.Module):
    """Transitions (s, a, s') of a learner; states are in features, actions in fractions."""

    features: Float[Array, "*batch features"]
    """s, scaled."""
    fractions: Float[Array, "*batch actions"]
    """a, as sampled: may lie beyond [-1, 1]."""
    next_features: Float[Array, "*batch features"]
    """s', scaled."""


class Rollout(eqx.Module):
    """What a policy did: one slot, or ``slots`` slots of ``rollouts`` rollouts, (slots, rollouts, ...)."""

    transitions: Transitions
    log_density: Float[Array, "*batch"]
    """log pi(a|s) under the policy that acted."""
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

    def step(self, state: HomeState, start: Array, fractions: Array, disturbance: Array) -> Step:
        """One slot of a rollout that began in the slot ``start``."""
        now = self.at(start + state.slot)
        action = to_power(self.planning_home, observe(state, now), fractions)
        return self.home.step(state, now, action, disturbance)


def collect(
    environment: Environment,
    policy: GaussianPolicy,
    deviation: Float[Array, "actions"],
    shape: tuple,
    key: Array,
) -> Rollout:
    """Let the policy act with standard ``deviation`` of its fractions; ``shape`` is (slots, rollouts)."""
    slots, rollouts = shape
    reset_key, noise_key, disturbance_key = jax.random.split(key, 3)
    states, starts = jax.vmap(environment.reset)(jax.random.split(reset_key, rollouts))
    noise = jax.random.normal(noise_key, (slots, rollouts, deviation.size)) * deviation
    begin = (states, starts, jax.vmap(environment.features)(states, starts))

    def act(features: Array, noise: Array) -> tuple[Array, Array]:
        mean = policy.mean(features)
        fractions = mean + noise
        return fractions, log_density(fractions, mean, deviation)

    return rolled_out(environment, act, begin, noise, disturbance_key)


def rolled_out(
    environment: Environment,
    act: Callable[[Array, Array], tuple[Array, Array]],
    begin: tuple[HomeState, Int[Array, "rollouts"], Float[Array, "rollouts features"]],
    given: Array,
    key: Array,
) -> Rollout:
    """The one loop of learners, for rollouts side by side, (slots, rollouts, ...).

    ``act(features, given)`` tells fractions and log density; ``given`` has one entry a slot and rollout.
    The rollouts ``begin`` with these states of the home, slots of the traces, and features.
    """
    states, starts, features = begin
    slots, rollouts = given.shape[:2]
    keys = jax.random.split(key, rollouts)
    disturbances = jax.vmap(lambda k: environment.home.disturbances(k, slots))(keys).T

    def one(state: HomeState, start: Array, features: Array, given: Array, disturbance: Array):
        fractions, density = act(features, given)
        step = environment.step(state, start, fractions, disturbance)
        after = environment.features(step.state, start + state.slot + 1)
        return step.state, Rollout(Transitions(features, fractions, after), density, step.costs)

    def slot(carry: tuple[HomeState, Array], inputs: tuple[Array, Array]):
        states, features = carry
        states, rollout = jax.vmap(one)(states, starts, features, *inputs)
        return (states, rollout.transitions.next_features), rollout

    return jax.lax.scan(slot, (states, features), (given, disturbances))[1]
