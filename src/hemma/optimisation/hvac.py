"""Upper level of the hierarchy: HVAC power that minimises the sum of X3 through the home's thermal model.

The descent and its measurements against plain gradient descent are written up in ``docs/expert.md``.
"""

from dataclasses import dataclass

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jaxtyping import Bool, Float, Int

from hemma.home import Home, ThermalState
from hemma.home.precision import in_double
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class DescentSettings:
    """When the descent stops."""

    tolerance: float = 1e-6
    """Largest change of the HVAC power in the last iteration [kW]."""
    max_iterations: int = 50
    """Iterations after which it gives up. An affine model needs 2: one step, and one that finds no better."""


DESCENT = DescentSettings()


class HvacPlan(eqx.Module):
    """HVAC power over a period, the temperature it leads to, and how the descent ended."""

    hvac_power: Float[Array, "*batch slots"]
    """h [kW]."""
    indoor_temperature: Float[Array, "*batch slots"]
    """T_in at the end of each slot, as predicted [degC]."""
    iterations: Int[Array, "*batch"]
    """Iterations done."""
    residual: Float[Array, "*batch"]
    """Largest change of h in the last iteration [kW]."""
    converged: Bool[Array, "*batch"]
    """Whether the residual fell below the tolerance; if not, the plan is the last iterate."""


def plan_hvac(
    home: Home,
    exogenous: Exogenous,
    initial: ThermalState,
    settings: DescentSettings = DESCENT,
    compiled_slots: int | None = None,
) -> HvacPlan:
    """Minimise the sum of X3 over h in [0, h^max], from h = 0 and with the least energy, in float64.

    Projected descent in the coordinates in which the objective is separable, the predicted temperatures:
    every temperature beyond the comfort band moves to its edge (``_aims``), the path is projected onto
    those that 0 <= h <= h^max can reach (backward in ``_aims``, forward in ``_follow``), and all slopes
    come from the model by automatic differentiation. ``vmap`` and ``jit`` it over homes or days at will.

    Every length of period is compiled once. With ``compiled_slots`` periods of up to that many slots share
    one compilation; the padding changes nothing. The plan holds NumPy arrays unless it is traced.
    """
    slots = exogenous.slots
    padding = max(0, (compiled_slots or slots) - slots)
    with jax.enable_x64(True):
        exogenous = jax.tree.map(lambda x: jnp.pad(x, (0, padding), mode="edge"), in_double(exogenous))
        home, initial = in_double((home, initial))
        plan = _descend(home, exogenous, initial, jnp.arange(slots + padding) < slots, settings)
        h, T = plan.hvac_power[:slots], plan.indoor_temperature[:slots]
        plan = eqx.tree_at(lambda p: (p.hvac_power, p.indoor_temperature), plan, (h, T))
    return jax.tree.map(lambda x: x if isinstance(x, Tracer) else np.asarray(x), plan)


@eqx.filter_jit
def _descend(
    home: Home,
    exogenous: Exogenous,
    initial: ThermalState,
    counts: Bool[Array, "slots"],
    settings: DescentSettings,
) -> HvacPlan:
    """``counts`` is false in padded slots: there the HVAC is off and nothing is aimed at."""
    start = jnp.zeros(exogenous.slots)

    def unfinished(carry: tuple[Array, Array, Array]) -> Array:
        _, iteration, residual = carry
        return (iteration < settings.max_iterations) & (residual > settings.tolerance)

    def iterate(carry: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        h, iteration, _ = carry
        aims = _aims(home, _full_power(home, exogenous, initial, h), counts)
        after = jnp.where(counts, _follow(home, exogenous, initial, h, aims), 0.0)
        return after, iteration + 1, jnp.max(jnp.abs(after - h))

    first = (start, jnp.asarray(0), jnp.asarray(jnp.inf))
    h, iterations, residual = jax.lax.while_loop(unfinished, iterate, first)
    return HvacPlan(
        hvac_power=h,
        indoor_temperature=_path(home, exogenous, initial, h).indoor_temperature[1:],
        iterations=iterations,
        residual=residual,
        converged=residual <= settings.tolerance,
    )


def _slot(home: Home, state: ThermalState, now: Exogenous, h: Array) -> ThermalState:
    return home.thermal_model(state, home.thermal_drivers(now, h, jnp.zeros_like(h)))


def _path(home: Home, exogenous: Exogenous, initial: ThermalState, h: Array) -> ThermalState:
    """States of the model under ``h`` at the slots + 1 fence posts."""

    def slot(state: ThermalState, inputs: tuple[Exogenous, Array]):
        after = _slot(home, state, *inputs)
        return after, after

    _, states = jax.lax.scan(slot, initial, (exogenous, h))
    return jax.tree.map(lambda first, later: jnp.concatenate([first[None], later]), initial, states)


class _FullPower(eqx.Module):
    """What full power in a slot would do from where the path is, one value a slot."""

    before: Float[Array, "slots"]
    """T of the path at the start of the slot [degC]."""
    after: Float[Array, "slots"]
    """T' at its end under h^max [degC]."""
    carry: Float[Array, "slots"]
    """a = dT'/dT, the memory of the model held."""


def _full_power(home: Home, exogenous: Exogenous, initial: ThermalState, h: Array) -> _FullPower:
    """Roll the model out under ``h``; try h^max in each slot and differentiate."""

    def temperature(T: Array, memory: Array, now: Exogenous) -> Array:
        most = jnp.asarray(home.hvac.max_power, T.dtype)
        return _slot(home, ThermalState(T, memory), now, most).indoor_temperature

    before = jax.tree.map(lambda x: x[:-1], _path(home, exogenous, initial, h))
    differentiate = jax.vmap(jax.value_and_grad(temperature))
    after, carry = differentiate(before.indoor_temperature, before.memory, exogenous)
    return _FullPower(before.indoor_temperature, after, carry)


def _aims(home: Home, full: _FullPower, counts: Bool[Array, "slots"]) -> Float[Array, "slots"]:
    """Temperature to aim at by the end of each slot [degC]: the edge of the band, or earlier what it takes.

    Backward: r_t = min(T^upp, T_t + (r_{t+1} - T'_t(h^max)) / a_t), not below T^low, is the highest
    temperature at t from which full power still ends slot t at r_{t+1}. Heating mirrors it.
    """
    edge, far, sign = home.comfort.high, home.comfort.low, 1.0
    if home.hvac.heats:
        edge, far, sign = -home.comfort.low, -home.comfort.high, -1.0

    def slot(aim: Array, inputs: tuple[_FullPower, Array]):
        full, counts = inputs
        remembers = (full.carry > 0) & counts
        reach = sign * full.before + (aim - sign * full.after) / jnp.where(remembers, full.carry, 1.0)
        return jnp.clip(jnp.where(remembers, reach, edge), far, edge), aim

    start = jnp.asarray(edge, full.before.dtype)
    return sign * jax.lax.scan(slot, start, (full, counts), reverse=True)[1]


def _follow(
    home: Home, exogenous: Exogenous, initial: ThermalState, h: Array, aims: Float[Array, "slots"]
) -> Float[Array, "slots"]:
    """Forward: in each slot the smallest power that ends it at the aim or beyond, else h^max.

    One Newton step from ``h``, exact where T' is affine in h. An HVAC without effect stays off.
    """

    def slot(state: ThermalState, inputs: tuple[Exogenous, Array, Array]):
        now, h, aim = inputs
        T, slope = jax.value_and_grad(lambda h: _slot(home, state, now, h).indoor_temperature)(h)
        works = slope > 0 if home.hvac.heats else slope < 0
        power = jnp.where(works, h + (aim - T) / jnp.where(works, slope, 1.0), 0.0)
        power = jnp.clip(power, 0.0, home.hvac.max_power)
        return _slot(home, state, now, power), power

    return jax.lax.scan(slot, initial, (exogenous, h, aims))[1]
