"""A building that is not as identified, read late: corrected while the home runs, from what is measured.

Two hypotheses side by side, T_in read in time or one slot late; under each a Kalman filter of three constants
(recursive least squares): theta_{t+1} = theta_t, T_{t+1} - F_T(T_t, ...) = theta' phi_t + noise.
"""

from typing import TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Bool, Float

from hemma.home.home import Home
from hemma.home.thermal import AbstractThermalModel, ThermalDrivers, ThermalState
from hemma.types import Array, Exogenous

UNCERTAINTY = 0.3
"""Standard deviation of the building's constants beforehand, as a share of what they are believed to be."""
REACH = 5.0
"""Beforehand the unexplained part of a slot is as uncertain as UNCERTAINTY of so much difference to the
outside [degC]."""
NOISE = 0.2
"""Standard deviation of what no constant explains: measurement, people, open doors [degC]."""
MEMORY = 0.95
"""Share of the past errors of the hypotheses that counts on a slot later."""
DOUBT = 0.5
"""Readings count as late only if that explains them with less than this share of the error."""


class CorrectedThermalModel(AbstractThermalModel):
    """T' = F_T(...) + theta' phi, phi = (1, T_out - T_in, u_heat - u_cool); affine in power if F_T is."""

    model: AbstractThermalModel
    """F_T, as identified."""
    correction: Float[Array, "3"]
    """theta: [degC], 1, [degC/kW], for one slot."""

    def initial(self, indoor_temperature: Array) -> ThermalState:
        """State of a building whose indoor temperature [degC] was just measured."""
        return self.model.initial(indoor_temperature)

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        """State at the end of the slot."""
        after = self.model(state, drivers)
        shift = influences(state, drivers) @ self.correction
        return ThermalState(after.indoor_temperature + shift, after.memory)


class Adaptation(eqx.Module):
    """What is known of the building under both hypotheses, in time first and late second."""

    corrections: Float[Array, "2 3"]
    """Means of theta."""
    covariances: Float[Array, "2 3 3"]
    errors: Float[Array, "2"]
    """Squared errors of the predictions, those long past forgotten [degC^2]."""
    power: Float[Array, ""]
    """HVAC power of the slot before [kW]; NaN before there was one."""

    @property
    def is_late(self) -> Bool[Array, ""]:
        """Whether readings are better explained as those of the slot before."""
        return self.errors[1] < DOUBT * self.errors[0]

    @property
    def correction(self) -> Float[Array, "3"]:
        """theta under the better hypothesis."""
        return jnp.where(self.is_late, self.corrections[1], self.corrections[0])

    def learned(
        self, home: Home, readings: tuple[Array, Array], exogenous: Exogenous, hvac_power: Array
    ) -> "Adaptation":
        """After a slot with these readings of T_in at its ends [degC], and ``hvac_power`` [kW] in it.

        ``home`` is the one as identified, ``exogenous`` the slot as it was read. A reading that is no number
        teaches nothing. A late reading of a slot's end is that of its start: the power that led from the
        one reading to the other is that of the slot before.
        """
        powers = jnp.stack([jnp.asarray(hvac_power, float), self.power])
        before, after = readings
        state = home.thermal_model.initial(before)

        def filtered(correction: Array, covariance: Array, power: Array) -> tuple[Array, Array, Array]:
            drivers = home.thermal_drivers(exogenous, power, jnp.zeros(()))
            phi = influences(state, drivers)
            surprise = after - home.thermal_model(state, drivers).indoor_temperature - phi @ correction
            spread = covariance @ phi
            gain = spread / (phi @ spread + NOISE**2)
            known = jnp.isfinite(surprise)
            return (
                jnp.where(known, correction + gain * surprise, correction),
                jnp.where(known, covariance - gain[:, None] * spread[None, :], covariance),
                surprise**2,
            )

        corrections, covariances, errors = jax.vmap(filtered)(self.corrections, self.covariances, powers)
        both = jnp.all(jnp.isfinite(errors))
        errors = jnp.where(both, MEMORY * self.errors + errors, self.errors)
        return Adaptation(corrections, covariances, errors, powers[0])

    def temperature(self, home: Home, reading: Array, exogenous: Exogenous) -> Float[Array, ""]:
        """T_in now [degC]: the reading, or what it will have become since where it is late."""
        model = CorrectedThermalModel(home.thermal_model, self.correction)
        drivers = home.thermal_drivers(exogenous, self.power, jnp.zeros(()))
        since = model(model.initial(reading), drivers).indoor_temperature
        return jnp.where(self.is_late & jnp.isfinite(since), since, reading)


def unadapted(home: Home) -> Adaptation:
    """theta = 0 before anything is measured, as uncertain as the constants of ``home``'s model are.

    With a = dT'/dT and b = dT'/dh of the model in the middle of the comfort band, the standard deviations
    are REACH s (1 - a), s (1 - a) and s |b|, s = UNCERTAINTY.
    """
    middle = jnp.asarray((home.comfort.low + home.comfort.high) / 2, float)

    def after(temperature: Array, power: Array) -> Array:
        nothing = jnp.zeros_like(power)
        idle = Exogenous(nothing, nothing, middle, nothing, nothing, nothing + 12.0)
        model = home.thermal_model
        drivers = home.thermal_drivers(idle, power, nothing)
        return model(model.initial(temperature), drivers).indoor_temperature

    kept, effect = jax.grad(after, argnums=(0, 1))(middle, jnp.zeros_like(middle))
    leak = jnp.abs(1 - kept)
    covariance = jnp.diag((UNCERTAINTY * jnp.stack([REACH * leak, leak, jnp.abs(effect)])) ** 2)
    zeros = jnp.zeros((2, 3), covariance.dtype)
    errors = jnp.zeros(2, covariance.dtype)
    return Adaptation(zeros, jnp.stack([covariance, covariance]), errors, jnp.full((), jnp.nan, errors.dtype))


def influences(state: ThermalState, drivers: ThermalDrivers) -> Float[Array, "*slots 3"]:
    """phi = (1, T_out - T_in, u_heat - u_cool) of a slot."""
    difference = drivers.outdoor_temperature - state.indoor_temperature
    power = drivers.heating_power - drivers.cooling_power
    return jnp.stack([jnp.ones_like(difference), difference, power * jnp.ones_like(difference)], axis=-1)


Tree = TypeVar("Tree")


def corrected(tree: Tree, adaptation: Adaptation) -> Tree:
    """``tree``, a home or whatever plans or acts by one, with the building corrected in every home in it."""

    def correct(leaf: object) -> object:
        if not isinstance(leaf, Home):
            return leaf
        model = CorrectedThermalModel(leaf.thermal_model, adaptation.correction)
        return eqx.tree_at(lambda home: home.thermal_model, leaf, model)

    return jax.tree.map(correct, tree, is_leaf=lambda leaf: isinstance(leaf, Home))
