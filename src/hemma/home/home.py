"""The home: equations (1) to (8) of the paper, pure, differentiable and compiled by whoever calls it.

The home has no reward: it returns the next state and the three costs. What happens to an action that
breaks a limit is decided here and nowhere else: ``feasible_action`` moves it to the nearest feasible one.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float, Int

from hemma.home.battery import Battery
from hemma.home.checks import require
from hemma.home.thermal import AbstractThermalModel, ExplicitThermalModel, ThermalDrivers, ThermalState
from hemma.types import Action, Array, Costs, Exogenous, Observation, PaperState, Scalar


class Hvac(eqx.Module):
    """The air conditioner or heat pump: 0 <= h <= h^max, equation (6)."""

    max_power: Scalar = 2.0
    """h^max [kW electric]."""
    heats: bool = eqx.field(static=True, default=False)
    """Whether its power heats (winter) or cools (summer, the paper)."""

    def __check_init__(self):
        """Refuse a negative power."""
        require("hvac", self.max_power >= 0, "max_power >= 0", self.max_power)


class ComfortBand(eqx.Module):
    """Range of comfortable indoor temperatures."""

    low: Scalar = 19.0
    """T^low,in [degC]."""
    high: Scalar = 24.0
    """T^upp,in [degC]."""

    def __check_init__(self):
        """Refuse an empty band."""
        require("comfort", self.low <= self.high, "low <= high", (self.low, self.high))

    def deviation(self, temperature: Array) -> Array:
        """X3 = [T - T^upp]^+ + [T^low - T]^+ [degC], equation (2)."""
        return jnp.maximum(temperature - self.high, 0.0) + jnp.maximum(self.low - temperature, 0.0)


class HomeState(eqx.Module):
    """All that the home carries from slot to slot."""

    battery_energy: Float[Array, "*slots"]
    """E [kWh]."""
    thermal: ThermalState
    """T_in and the thermal model's memory."""
    previous_hvac_power: Float[Array, "*slots"]
    """h of the slot before [kW]."""
    slot: Int[Array, "*slots"]
    """Index of the slot in the replayed period."""

    @property
    def indoor_temperature(self) -> Array:
        """T_in [degC]."""
        return self.thermal.indoor_temperature


class Step(eqx.Module):
    """What one slot did."""

    state: HomeState
    """State at the end of the slot."""
    action: Action
    """The feasible action that was carried out."""
    grid_power: Float[Array, "*slots"]
    """g [kW], buying positive, equation (8)."""
    costs: Costs
    """X1, X2, X3."""


class Home(eqx.Module):
    """A home is its parameters: a pytree, so that ``vmap`` over homes and ``grad`` through one are free."""

    battery: Battery = Battery()
    thermal_model: AbstractThermalModel = ExplicitThermalModel()
    hvac: Hvac = Hvac()
    comfort: ComfortBand = ComfortBand()
    slot_length: Scalar = 1.0
    """dt [h]. The thermal model must be one for this slot length."""
    initial_temperature: Scalar = 23.0
    """T_in at the first slot [degC]."""
    disturbance_deviation: Scalar = 0.0
    """Standard deviation of the Gaussian thermal disturbance epsilon_t [degC]; not printed in the paper."""

    def __check_init__(self):
        """Refuse a slot without length and a negative deviation."""
        require("home", self.slot_length > 0, "slot_length > 0", self.slot_length)
        require(
            "home", self.disturbance_deviation >= 0, "disturbance_deviation >= 0", self.disturbance_deviation
        )

    def reset(
        self, battery_energy: Scalar | None = None, indoor_temperature: Scalar | None = None
    ) -> HomeState:
        """State at slot 0, from the home's own initial values unless others are given."""
        energy = self.battery.initial_energy if battery_energy is None else battery_energy
        temperature = self.initial_temperature if indoor_temperature is None else indoor_temperature
        return HomeState(
            battery_energy=jnp.asarray(energy, float),
            thermal=self.thermal_model.initial(jnp.asarray(temperature, float)),
            previous_hvac_power=jnp.zeros((), float),
            slot=jnp.zeros((), int),
        )

    def feasible_action(self, state: HomeState, action: Action) -> Action:
        """The feasible action nearest to ``action``, equations (3), (4) and (6)."""
        low, high = self.battery.power_limits(state.battery_energy, self.slot_length)
        return Action(
            battery_power=jnp.clip(action.battery_power, low, high),
            hvac_power=jnp.clip(action.hvac_power, 0.0, self.hvac.max_power),
        )

    def thermal_drivers(self, exogenous: Exogenous, hvac_power: Array, disturbance: Array) -> ThermalDrivers:
        """What acts on the building when the HVAC runs at ``hvac_power`` [kW]."""
        idle = jnp.zeros_like(hvac_power)
        return ThermalDrivers(
            outdoor_temperature=exogenous.outdoor_temperature,
            heating_power=hvac_power if self.hvac.heats else idle,
            cooling_power=idle if self.hvac.heats else hvac_power,
            pv_generation=exogenous.pv_generation,
            hour_of_day=exogenous.hour_of_day,
            disturbance=disturbance,
        )

    def step(self, state: HomeState, exogenous: Exogenous, action: Action, disturbance: Array) -> Step:
        """One slot. ``exogenous`` holds this slot's values, ``disturbance`` epsilon_t [degC]."""
        action = self.feasible_action(state, action)
        e, h = action.battery_power, action.hvac_power
        grid_power = h + e + exogenous.load - exogenous.pv_generation
        thermal = self.thermal_model(state.thermal, self.thermal_drivers(exogenous, h, disturbance))
        costs = Costs(
            transaction=transaction_cost(grid_power, exogenous, self.slot_length),
            ageing=self.battery.ageing(e, self.slot_length),
            temperature_deviation=self.comfort.deviation(thermal.indoor_temperature),
        )
        after = HomeState(
            battery_energy=self.battery.next_energy(state.battery_energy, e, self.slot_length),
            thermal=thermal,
            previous_hvac_power=h,
            slot=state.slot + 1,
        )
        return Step(state=after, action=action, grid_power=grid_power, costs=costs)

    def disturbances(self, key: Array, slots: int) -> Float[Array, "slots"]:
        """Gaussian epsilon_t for ``slots`` slots [degC]; zeros with the default deviation of 0."""
        return self.disturbance_deviation * jax.random.normal(key, (slots,))


def transaction_cost(grid_power: Array, exogenous: Exogenous, slot_length: Scalar) -> Array:
    """X1 = u+ g dt where g > 0, else u- g dt [currency], equation (1)."""
    price = jnp.where(grid_power > 0, exogenous.buying_price, exogenous.selling_price)
    return price * grid_power * slot_length


def observe(state: HomeState, exogenous: Exogenous) -> Observation:
    """What a controller sees at the start of the slot whose exogenous values are given."""
    return Observation(
        pv_generation=exogenous.pv_generation,
        load=exogenous.load,
        battery_energy=state.battery_energy,
        outdoor_temperature=exogenous.outdoor_temperature,
        indoor_temperature=state.indoor_temperature,
        buying_price=exogenous.buying_price,
        selling_price=exogenous.selling_price,
        hour_of_day=exogenous.hour_of_day,
        previous_hvac_power=state.previous_hvac_power,
        slot=state.slot,
    )


def paper_state(observation: Observation) -> Float[Array, "*slots 7"]:
    """s = (p, l, E, T_out, T_in, u, t'), the state of the paper: order of ``PaperState``, in units."""
    return jnp.stack([getattr(observation, position.name.lower()) for position in PaperState], axis=-1)


def benchmark_home(slot_length: float = 1.0) -> Home:
    """The home of the authors' earlier benchmark, for slots of ``slot_length`` [h]."""
    return Home(thermal_model=ExplicitThermalModel().at_slot_length(slot_length), slot_length=slot_length)
