"""A building that is not as identified, or read late: corrected while the home runs, from what is measured.

Three hypotheses side by side: everything is read in time, everything one slot late, T_in alone one slot late.
Under each a Kalman filter of three constants (recursive least squares): theta_{t+1} = theta_t,
T_{t+1} - F_T(T_t, ...) = theta' phi_t + noise. The best one is believed, once it explains much more than the
building as it was identified.
"""

from typing import TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Bool, Float, Int

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
"""A hypothesis is believed once it leaves less than this share of the squared error as identified."""
IN_TIME, ALL_LATE, LATE = range(3)
"""The hypotheses; the last is that of T_in alone."""


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
    """What is known of the building under each hypothesis."""

    corrections: Float[Array, "3 3"]
    """Means of theta."""
    covariances: Float[Array, "3 3 3"]
    errors: Float[Array, "3"]
    """Squared errors of their predictions, those long past forgotten [degC^2]."""
    error: Float[Array, ""]
    """The same of the building as identified, read in time."""
    power: Float[Array, ""]
    """HVAC power of the slot before [kW]; NaN before there was one."""
    exogenous: Exogenous
    """The slot before, as it was read."""

    @property
    def best(self) -> Int[Array, ""]:
        """The hypothesis that predicts best."""
        return jnp.argmin(self.errors)

    @property
    def is_believed(self) -> Bool[Array, ""]:
        """Whether it explains so much more than the building as identified."""
        return self.errors[self.best] < DOUBT * self.error

    @property
    def correction(self) -> Float[Array, "3"]:
        """theta to plan with: that of the best hypothesis if it is believed, else 0."""
        return jnp.where(self.is_believed, self.corrections[self.best], 0.0)

    def learned(
        self, home: Home, readings: tuple[Array, Array], exogenous: Exogenous, hvac_power: Array
    ) -> "Adaptation":
        """After a slot with these readings of T_in at its ends [degC], and ``hvac_power`` [kW] in it.

        ``home`` is the one as identified, ``exogenous`` the slot as it was read. A reading that is no number
        teaches nothing. A late reading of a slot's end is that of its start: the power that led from the one
        reading to the other is that of the slot before.
        """
        before, after = readings
        power = jnp.asarray(hvac_power, self.power.dtype)
        state, drivers = home.thermal_model.initial(before), self._drivers(home, exogenous, power)

        def filtered(correction: Array, covariance: Array, acted: ThermalDrivers) -> tuple[Array, ...]:
            phi = influences(state, acted)
            surprise = after - home.thermal_model(state, acted).indoor_temperature - phi @ correction
            spread = covariance @ phi
            gain = spread / (phi @ spread + NOISE**2)
            known = jnp.isfinite(surprise)
            return (
                jnp.where(known, correction + gain * surprise, correction),
                jnp.where(known, covariance - gain[:, None] * spread[None, :], covariance),
                surprise**2,
            )

        corrections, covariances, errors = jax.vmap(filtered)(self.corrections, self.covariances, drivers)
        in_time = jax.tree.map(lambda x: x[IN_TIME], drivers)
        error = (after - home.thermal_model(state, in_time).indoor_temperature) ** 2
        known = jnp.all(jnp.isfinite(errors))
        return Adaptation(
            corrections=corrections,
            covariances=covariances,
            errors=jnp.where(known, MEMORY * self.errors + errors, self.errors),
            error=jnp.where(known, MEMORY * self.error + error, self.error),
            power=power,
            exogenous=jax.tree.map(lambda x: jnp.asarray(x, power.dtype), exogenous),
        )

    def temperature(self, home: Home, reading: Array, exogenous: Exogenous) -> Float[Array, ""]:
        """T_in now [degC]: the reading, or what it will have become since where it is believed to be late."""
        model = CorrectedThermalModel(home.thermal_model, self.correction)
        acted = jax.tree.map(lambda x: x[self.best], self._drivers(home, exogenous, self.power))
        since = model(model.initial(reading), acted).indoor_temperature
        is_late = self.is_believed & (self.best != IN_TIME) & jnp.isfinite(since)
        return jnp.where(is_late, since, reading)

    def _drivers(self, home: Home, exogenous: Exogenous, power: Array) -> ThermalDrivers:
        """What led from one reading to the next under each hypothesis, (3,)."""
        powers = jnp.stack([power, self.power, self.power])
        pairs = jax.tree.map(lambda now, before: jnp.stack([now, now, before]), exogenous, self.exogenous)
        return home.thermal_drivers(pairs, powers, jnp.zeros_like(powers))


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
    unknown, nothing = jnp.full_like(middle, jnp.nan), jnp.zeros_like(middle)
    return Adaptation(
        corrections=jnp.zeros((3, 3), covariance.dtype),
        covariances=jnp.stack([covariance] * 3),
        errors=jnp.zeros(3, covariance.dtype),
        error=nothing,
        power=unknown,
        exogenous=Exogenous(unknown, unknown, unknown, unknown, unknown, unknown),
    )


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
