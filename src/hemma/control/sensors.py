"""What a controller reads when sensors err, lag or fail, and the safety layer between it and the home."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Bool, Float, Int

from hemma.control.adaptation import corrected, unadapted
from hemma.home.comfort import observed_comfort_power
from hemma.home.home import Home, HomeState, Step, observe
from hemma.home.replay import Controller
from hemma.types import Action, Array, Exogenous, Observation, Scalar


class Readings(eqx.Module):
    """What sensors make of a period, one value a slot, and what disturbs the building meanwhile."""

    exogenous: Exogenous
    """As it is read: a missing reading is the last one before it."""
    temperature_error: Float[Array, "slots"]
    """Added to T_in [degC]."""
    energy_error: Float[Array, "slots"]
    """Added to E [kWh]; the reading stays within the battery's limits."""
    is_temperature_missing: Bool[Array, "slots"]
    is_energy_missing: Bool[Array, "slots"]
    lag: Int[Array, ""]
    """1 where T_in is that of the slot before, else 0."""
    disturbance: Float[Array, "slots"]
    """epsilon_t [degC]."""


def faultless(exogenous: Exogenous) -> Readings:
    """Everything as it is, nothing disturbed."""
    nothing = jnp.zeros(exogenous.slots)
    present = jnp.zeros(exogenous.slots, bool)
    return Readings(exogenous, nothing, nothing, present, present, jnp.zeros((), int), nothing)


class Measured(eqx.Module):
    """The last readings of what the controller itself moves."""

    temperature: Float[Array, ""]
    """T_in as last read [degC]."""
    energy: Float[Array, ""]
    """E as last read [kWh]."""
    earlier: Float[Array, ""]
    """T_in one slot before, as it was [degC]."""
    is_temperature_read: Bool[Array, ""]
    """Whether T_in was read in this slot."""


def first_measured(state: HomeState) -> Measured:
    """Before the first slot everything is as it is."""
    temperature = state.indoor_temperature
    return Measured(temperature, state.battery_energy, temperature, jnp.ones((), bool))


def measure_state(home: Home, state: HomeState, readings: Readings, slot: Array, last: Measured) -> Measured:
    """The readings of a slot; what is missing is what was read last."""
    true = jnp.where(readings.lag > 0, last.earlier, state.indoor_temperature)
    temperature = true + readings.temperature_error[slot]
    battery = home.battery
    energy = jnp.clip(
        state.battery_energy + readings.energy_error[slot], battery.min_energy, battery.max_energy
    )
    return Measured(
        temperature=jnp.where(readings.is_temperature_missing[slot], last.temperature, temperature),
        energy=jnp.where(readings.is_energy_missing[slot], last.energy, energy),
        earlier=state.indoor_temperature,
        is_temperature_read=~readings.is_temperature_missing[slot],
    )


class SafetyLayer(eqx.Module):
    """The last word on an action: it is a number, it is feasible, and it does not fight the occupants.

    Where T_in as read lies more than ``margin`` beyond the edge of comfort that the HVAC guards, it runs with
    the comfort action of ``home`` at least; more than ``margin`` beyond the other edge it stays off. A power
    that is not a number becomes the comfort action, or a battery at rest.
    """

    home: Home
    """As it is believed to be."""
    margin: Scalar = 1.0
    """[degC]."""
    adapts: bool = eqx.field(static=True, default=False)
    """Whether the building is corrected by what is measured (``hemma.control.adaptation``)."""

    def __call__(self, observation: Observation, asked: Action) -> tuple[Action, "Interventions"]:
        """What goes to the home, and what was changed."""
        comfort = observed_comfort_power(self.home, observation)
        is_number = jnp.isfinite(asked.battery_power) & jnp.isfinite(asked.hvac_power)
        e = jnp.where(jnp.isfinite(asked.battery_power), asked.battery_power, 0.0)
        h = jnp.where(jnp.isfinite(asked.hvac_power), asked.hvac_power, comfort)
        low, high = self.home.battery.power_limits(observation.battery_energy, self.home.slot_length)
        limited = Action(jnp.clip(e, low, high), jnp.clip(h, 0.0, self.home.hvac.max_power))
        band, temperature = self.home.comfort, observation.indoor_temperature
        warm, cold = temperature > band.high + self.margin, temperature < band.low - self.margin
        needed, idle = (cold, warm) if self.home.hvac.heats else (warm, cold)
        guarded = jnp.where(needed, jnp.maximum(limited.hvac_power, comfort), limited.hvac_power)
        guarded = jnp.where(idle, 0.0, guarded)
        beyond = (jnp.abs(limited.battery_power - e) > TINY) | (jnp.abs(limited.hvac_power - h) > TINY)
        interventions = Interventions(
            limited=(beyond | ~is_number).astype(int),
            comfort=(jnp.abs(guarded - limited.hvac_power) > TINY).astype(int),
        )
        return Action(limited.battery_power, guarded), interventions


TINY = 1e-6
"""Changes of a power up to this are rounding [kW]."""


class Interventions(eqx.Module):
    """What the safety layer changed, one count a slot."""

    limited: Int[Array, "*slots"]
    """An action that was no number, or not feasible by the readings."""
    comfort: Int[Array, "*slots"]
    """An HVAC power that fought the occupants."""


class WatchedStep(eqx.Module):
    """What a slot did, and what the safety layer did to it."""

    step: Step
    interventions: Interventions


def watched_replay(
    home: Home,
    exogenous: Exogenous,
    controller: Controller,
    readings: Readings,
    safety: SafetyLayer,
    key: Array,
) -> WatchedStep:
    """Let ``controller`` run ``home`` from its start by its ``readings``, behind a safety layer; (slots,).

    If the layer adapts, controller and layer act by a building that is corrected in every slot by what was
    read in the slots before.
    """
    believed = safety.home

    def slot(carry, inputs: tuple[Exogenous, Exogenous, Array, Array]):
        state, last, adaptation = carry
        now, read, disturbance, key = inputs
        measured = measure_state(home, state, readings, state.slot, last)
        observation = read_observation(observe(state, read), measured)
        acting, guard = controller, safety
        if safety.adapts:
            temperature = adaptation.temperature(believed, measured.temperature, read)
            observation = eqx.tree_at(lambda o: o.indoor_temperature, observation, temperature)
            acting, guard = corrected((controller, safety), adaptation)
        action, interventions = guard(observation, acting(observation, key))
        step = home.step(state, now, action, disturbance)
        following = jnp.minimum(state.slot + 1, exogenous.slots - 1)
        after = measure_state(home, step.state, readings, following, measured)
        adaptation = adaptation.learned(believed, taught(measured, after), read, action.hvac_power)
        return (step.state, measured, adaptation), WatchedStep(step, interventions)

    start = home.reset()
    keys = jax.random.split(key, exogenous.slots)
    inputs = (exogenous, readings.exogenous, readings.disturbance, keys)
    begin = (start, first_measured(start), unadapted(believed))
    return jax.lax.scan(slot, begin, inputs)[1]


def taught(before: Measured, after: Measured) -> tuple[Array, Array]:
    """The readings of T_in at both ends of a slot [degC]; NaN where one of them is an older one."""
    known = before.is_temperature_read & after.is_temperature_read
    return before.temperature, jnp.where(known, after.temperature, jnp.nan)


def read_observation(observation: Observation, measured: Measured) -> Observation:
    """The observation with T_in and E as they were read."""
    return eqx.tree_at(
        lambda o: (o.indoor_temperature, o.battery_energy),
        observation,
        (measured.temperature, measured.energy),
    )
