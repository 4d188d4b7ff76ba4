"""Predicted temperature as an affine function of the HVAC power, read off any thermal model."""

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.errors import HemmaError
from hemma.home import Home, ThermalState
from hemma.home.precision import in_double
from hemma.types import Array, Exogenous

TOLERANCE = 1e-6
"""How far a model may be from its affine form [degC]; rounding of float64 leaves about 1e-12."""


@dataclass(frozen=True)
class AffineResponse:
    """x_{t+1} = free_{t+1} + carry_t (x_t - free_t) + gain_t h_t with x = (T_in, memory of the model).

    ``free`` is the path of the idle house (h = 0) from the given state, so x_0 = free_0.
    """

    free: Float[np.ndarray, "slots 2"]
    """x [degC] at the end of each slot without HVAC."""
    carry: Float[np.ndarray, "slots 2 2"]
    """dx'/dx; the first one meets no difference yet."""
    gain: Float[np.ndarray, "slots 2"]
    """dx'/dh [degC/kW]."""

    @property
    def memory_matters(self) -> bool:
        """Whether the HVAC moves the memory and the memory moves the temperature."""
        moves_memory = np.any(self.gain[:, 1] != 0) or np.any(self.carry[:, 1, 0] != 0)
        return bool(moves_memory and np.any(self.carry[:, 0, 1] != 0))

    def reach(self, max_power: float) -> Float[np.ndarray, "slots 2"]:
        """Largest |x - free| [degC] that powers in [0, ``max_power``] [kW] can cause."""
        reach, reaches = np.zeros(2), []
        for carry, gain in zip(np.abs(self.carry), np.abs(self.gain), strict=True):
            reach = carry @ reach + gain * max_power
            reaches.append(reach)
        return np.array(reaches)


def affine_response(home: Home, exogenous: Exogenous, initial: ThermalState) -> AffineResponse:
    """The affine form of ``home.thermal_model`` along the weather of ``exogenous``, in float64.

    Values and derivatives are taken along the path of the idle house and checked on another path, so
    that a model that is not affine in the HVAC power raises ``HemmaError``. The explicit model is affine;
    so is the physically consistent network, whose learned part sees neither power nor temperature.
    """
    with jax.enable_x64(True):
        path = _linearise(*in_double((home, exogenous, initial)))
        free, carry, gain, error = (np.asarray(x, np.float64) for x in path)
    if not error <= TOLERANCE:
        name = type(home.thermal_model).__name__
        raise HemmaError(
            f"thermal model {name}: expected a temperature that is affine in the HVAC power, it differs by "
            f"{float(error):.3g} degC; plan with the gradient level or fit an affine model"
        )
    return AffineResponse(free=free, carry=carry, gain=gain)


@eqx.filter_jit
def _linearise(home: Home, exogenous: Exogenous, initial: ThermalState) -> tuple[Array, ...]:
    def slot(x: Array, h: Array, now: Exogenous) -> Array:
        drivers = home.thermal_drivers(now, h, jnp.zeros(()))
        after = home.thermal_model(ThermalState(x[0], x[1]), drivers)
        return jnp.stack([after.indoor_temperature, after.memory])

    def rollout(powers: Array) -> Array:
        def advance(x: Array, inputs: tuple[Array, Exogenous]):
            after = slot(x, *inputs)
            return after, after

        return jax.lax.scan(advance, start, (powers, exogenous))[1]

    start = jnp.stack([initial.indoor_temperature, initial.memory])
    idle = jnp.zeros(exogenous.slots)
    free = rollout(idle)
    before = jnp.concatenate([start[None], free[:-1]])
    carry, gain = jax.vmap(jax.jacfwd(slot, argnums=(0, 1)))(before, idle, exogenous)

    def deviate(difference: Array, inputs: tuple[Array, Array, Array]):
        carry, gain, h = inputs
        difference = carry @ difference + gain * h
        return difference, difference

    probe = home.hvac.max_power * (0.5 + 0.5 * jnp.cos(jnp.arange(exogenous.slots) ** 1.5))
    affine = free + jax.lax.scan(deviate, jnp.zeros(2), (carry, gain, probe))[1]
    return free, carry, gain, jnp.max(jnp.abs(affine - rollout(probe))[:, 0])
