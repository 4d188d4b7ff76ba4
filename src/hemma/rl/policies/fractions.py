"""Decisions as fractions of what is feasible now, the HVAC's counted from comfort."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import Home
from hemma.home.comfort import observed_comfort_power
from hemma.rl.policies.action_space import Deed
from hemma.rl.policies.scaling import StateScaler
from hemma.types import Action, Array, Observation

FINENESS = 5.0
"""kappa: an HVAC fraction is sinh(kappa) / kappa = 15 times as fine at comfort as linear ones would be."""
SLOPE_BEYOND = 0.05
"""Slope of a mean fraction beyond [-1, 1]: a flat one would have no gradient to come back by."""


def to_power(planning_home: Home, observation: Observation, fractions: Float[Array, "*batch 2"]) -> Action:
    """The action (e, h) [kW] of two fractions in [-1, 1]; values beyond are clipped to the bound.

    Battery: +1 charges at the highest power that is feasible at the observed energy, -1 discharges at the
    highest, 0 rests. HVAC: ``hvac_power``.
    """
    low, high = planning_home.battery.power_limits(observation.battery_energy, planning_home.slot_length)
    battery = jnp.clip(fractions[..., 0], -1.0, 1.0)
    return Action(
        battery_power=jnp.where(battery > 0, battery * high, -battery * low),
        hvac_power=hvac_power(planning_home, observation, fractions[..., 1]),
    )


def to_fractions(planning_home: Home, observation: Observation, action: Action) -> Float[Array, "*batch 2"]:
    """The inverse of ``to_power``; where only one power is feasible, or on one side of comfort, 0."""
    low, high = planning_home.battery.power_limits(observation.battery_energy, planning_home.slot_length)
    battery = _share(action.battery_power, jnp.where(action.battery_power > 0, high, -low))
    return jnp.stack([battery, hvac_fraction(planning_home, observation, action.hvac_power)], axis=-1)


def hvac_power(planning_home: Home, observation: Observation, fraction: Float[Array, "*batch"]) -> Array:
    """h [kW] of a fraction a in [-1, 1]; values beyond are clipped to the bound.

    0 is the comfort action h_c, the least power that ends the slot within the band as far as the thermal
    model of ``planning_home`` knows; -1 is off and +1 full power. Between them

        h = h_c + f (h^max - h_c) for f > 0, h_c + f h_c for f < 0, f = sinh(kappa a) / sinh(kappa).

    A tenth of a degree is a few per cent of the power: comfort needs fine strokes, and only there.
    """
    comfort = observed_comfort_power(planning_home, observation)
    share = jnp.sinh(FINENESS * jnp.clip(fraction, -1.0, 1.0)) / jnp.sinh(FINENESS)
    room = jnp.where(share > 0, planning_home.hvac.max_power - comfort, comfort)
    return comfort + share * room


def hvac_fraction(planning_home: Home, observation: Observation, power: Float[Array, "*batch"]) -> Array:
    """The inverse of ``hvac_power``; 0 where comfort needs none or all, on that side."""
    comfort = observed_comfort_power(planning_home, observation)
    more = power - comfort
    share = _share(more, jnp.where(more > 0, planning_home.hvac.max_power - comfort, comfort))
    return jnp.arcsinh(share * jnp.sinh(FINENESS)) / FINENESS


@dataclass(frozen=True)
class Fractions:
    """Both decisions are fractions of what is feasible, and a Gaussian explores around the mean.

    The fractions that are sampled are not bounded: the home takes those beyond [-1, 1] as the bound, and the
    density stays that of the sample, so log pi is finite everywhere.
    """

    @property
    def name(self) -> str:
        """As settings and files call it."""
        return "fractions"

    @property
    def bounds(self) -> int:
        """Each decision has a power of its own."""
        return 0

    def carry_out(
        self,
        planning_home: Home,
        observation: Observation,
        decision: Float[Array, "*batch actions"],
        scaler: StateScaler,
    ) -> Deed:
        """``to_power``; what rewards read is the decision itself."""
        return self.tried(planning_home, observation, decision)

    def shown(
        self, planning_home: Home, observation: Observation, action: Action, scaler: StateScaler
    ) -> Deed:
        """The action itself, by ``to_fractions``."""
        fractions = to_fractions(planning_home, observation, action)
        return Deed(action, fractions, jnp.zeros((*fractions.shape[:-1], 0)))

    def tried(
        self,
        planning_home: Home,
        observation: Observation,
        fractions: Float[Array, "*batch actions"],
    ) -> Deed:
        """All fractions are feasible."""
        action = to_power(planning_home, observation, fractions)
        return Deed(action, fractions, jnp.zeros((*fractions.shape[:-1], 0)))

    def noise(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """Standard normal."""
        return jax.random.normal(key, (*shape, 2))

    def log_density(
        self,
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """That of a diagonal Gaussian: -sum (a - mu)^2 / (2 sigma^2) - sum log(sigma sqrt(2 pi))."""
        distance = (fractions - mean) / deviation
        return -0.5 * jnp.sum(distance**2, axis=-1) - jnp.sum(jnp.log(deviation * jnp.sqrt(2 * jnp.pi)))

    def surprise(
        self,
        reach: Float[Array, "*batch bounds"],
        mean: Float[Array, "*batch actions"],
        deviation: Float[Array, "actions"],
    ) -> Float[Array, "*batch"]:
        """0: the entropy of a Gaussian is that of its deviation."""
        return jnp.zeros(mean.shape[:-1])

    def jitter(self, key: Array, shape: tuple[int, ...]) -> Float[Array, "*shape actions"]:
        """As the policy explores."""
        return self.noise(key, shape)

    @property
    def heeds(self) -> tuple[bool, ...]:
        """All features of the paper's state."""
        return (True,) * 8

    def bent(self, raw: Float[Array, "actions"]) -> Float[Array, "actions"]:
        """Bent at -1 and 1, where a little slope is left for the gradient."""
        bounded = jnp.clip(raw, -1.0, 1.0)
        return bounded + SLOPE_BEYOND * (raw - bounded)

    def agreed(self, decisions: Float[Array, "members actions"]) -> Float[Array, "actions"]:
        """The mean of what they would do, each within its bounds."""
        return jnp.mean(jnp.clip(decisions, -1.0, 1.0), axis=0)

    def error(
        self,
        mean: Float[Array, "*batch actions"],
        fractions: Float[Array, "*batch actions"],
        reach: Float[Array, "*batch bounds"],
    ) -> Float[Array, "*batch actions"]:
        """mu - a, where an action at a bound says only that the mean was there or beyond.

        The expert's powers are bounded, the policy's mean is not: at a = 1 only min(mu - 1, 0) is an error,
        at a = -1 only max(mu + 1, 0). This is the censored regression of Tobin 1958 with squares for
        likelihoods.
        """
        return censored(mean - fractions, fractions)


def censored(error: Array, shown: Array) -> Array:
    """The error, but none beyond a bound at which something was shown."""
    error = jnp.where(shown >= 1.0, jnp.minimum(error, 0.0), error)
    return jnp.where(shown <= -1.0, jnp.maximum(error, 0.0), error)


def _share(power: Array, limit: Array) -> Array:
    feasible = limit > 1e-6  # of a kW: less is a rounding error
    return jnp.clip(jnp.where(feasible, power / jnp.where(feasible, limit, 1.0), 0.0), -1.0, 1.0)
