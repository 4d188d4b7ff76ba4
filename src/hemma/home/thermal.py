"""Thermal dynamics of the building, equation (7): one interface, several models."""

from abc import abstractmethod

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home.checks import require
from hemma.types import Array, Scalar


class ThermalDrivers(eqx.Module):
    """All that acts on the indoor temperature in one slot."""

    outdoor_temperature: Float[Array, "*slots"]
    """T_out [degC]."""
    heating_power: Float[Array, "*slots"]
    """Electric power of the HVAC while heating [kW], at least 0."""
    cooling_power: Float[Array, "*slots"]
    """Electric power of the HVAC while cooling [kW], at least 0."""
    pv_generation: Float[Array, "*slots"]
    """p [kW], a measure of the sun."""
    hour_of_day: Float[Array, "*slots"]
    """t' in [0, 24)."""
    disturbance: Float[Array, "*slots"]
    """epsilon_t, added to the temperature at the end of the slot [degC]."""


class ThermalState(eqx.Module):
    """Indoor temperature and what a model remembers besides it."""

    indoor_temperature: Float[Array, "*slots"]
    """T_in [degC]."""
    memory: Float[Array, "*slots"]
    """The model's own hidden temperature [degC]; models without one carry T_in itself."""


class AbstractThermalModel(eqx.Module):
    """F_T of equation (7): ``model(state, drivers) -> state`` one slot later."""

    def initial(self, indoor_temperature: Array) -> ThermalState:
        """State of a building whose indoor temperature [degC] was just measured."""
        temperature = jnp.asarray(indoor_temperature)
        return ThermalState(indoor_temperature=temperature, memory=temperature)

    @abstractmethod
    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        """State at the end of the slot."""


class ExplicitThermalModel(AbstractThermalModel):
    """The first-order model of the authors' earlier benchmark, with heating beside cooling.

    T' = eps T + (1 - eps) (T_out + (eta / A) (u_heat - u_cool)) + epsilon_t.
    """

    inertia: Scalar = 0.7
    """eps, share of the temperature kept over one slot; ``at_slot_length`` converts the hourly value."""
    efficiency: Scalar = 2.5
    """eta, heat moved per electric energy (coefficient of performance)."""
    conductance: Scalar = 0.252
    """A, heat lost per degree between inside and outside [kW/degC] (0.14 kW/degF)."""

    def __check_init__(self):
        """Refuse a building that cannot exist."""
        require("thermal", (self.inertia > 0) & (self.inertia < 1), "0 < inertia < 1", self.inertia)
        require("thermal", self.efficiency > 0, "efficiency > 0", self.efficiency)
        require("thermal", self.conductance > 0, "conductance > 0", self.conductance)

    def at_slot_length(self, slot_length: float) -> "ExplicitThermalModel":
        """The same building with slots of ``slot_length`` [h] instead of one hour: eps -> eps^dt, exact."""
        require("home", slot_length > 0, "slot_length > 0", slot_length)
        return ExplicitThermalModel(self.inertia**slot_length, self.efficiency, self.conductance)

    @property
    def temperature_per_power(self) -> Scalar:
        """Cooling of the next temperature per HVAC power held for one slot, (1 - eps) eta / A [degC/kW]."""
        return (1 - self.inertia) * self.efficiency / self.conductance

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        """State at the end of the slot."""
        hvac = (self.efficiency / self.conductance) * (drivers.heating_power - drivers.cooling_power)
        ambient = drivers.outdoor_temperature + hvac
        T = self.inertia * state.indoor_temperature + (1 - self.inertia) * ambient + drivers.disturbance
        return ThermalState(indoor_temperature=T, memory=T)
