"""A home in a period, how both are read, and the ways in which that can go wrong."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool

from hemma.control.sensors import Readings, faultless
from hemma.errors import HemmaError
from hemma.home import ExplicitThermalModel, Home
from hemma.home.precision import in_numpy
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class Scene:
    """What happens, and what is read of it."""

    home: Home
    """The real one."""
    exogenous: Exogenous
    """The real ones."""
    readings: Readings
    is_price_missing: Bool[np.ndarray, "slots"]
    """Whether the prices that are read are the last ones before."""

    @property
    def repaired(self) -> int:
        """Slots in which a reading was missing, so that the last one was taken."""
        readings = self.readings
        missing = np.asarray(readings.is_temperature_missing) | np.asarray(readings.is_energy_missing)
        return int(np.sum(missing | self.is_price_missing))


def scene(home: Home, exogenous: Exogenous) -> Scene:
    """Everything as it should be."""
    exogenous = in_numpy(exogenous)
    return Scene(home, exogenous, in_numpy(faultless(exogenous)), np.zeros(exogenous.slots, bool))


def disturbed(deviation: float, scene: Scene, random: np.random.Generator) -> Scene:
    """Gaussian epsilon_t of this standard deviation [degC]."""
    kicks = deviation * random.normal(size=scene.exogenous.slots)
    return replace(scene, readings=replace(scene.readings, disturbance=kicks))


def noisy(errors: tuple[float, float, float], scene: Scene, random: np.random.Generator) -> Scene:
    """Gaussian errors of T_in [degC], of E (a share of the usable capacity), of load and PV (shares)."""
    temperature, energy, demand = errors
    battery, slots = scene.home.battery, scene.exogenous.slots
    capacity = float(battery.max_energy - battery.min_energy)
    seen = scene.readings.exogenous

    def blurred(x: Array) -> Array:
        return np.maximum(np.asarray(x) * (1 + demand * random.normal(size=slots)), 0.0)

    readings = replace(
        scene.readings,
        exogenous=replace(seen, load=blurred(seen.load), pv_generation=blurred(seen.pv_generation)),
        temperature_error=temperature * random.normal(size=slots),
        energy_error=energy * capacity * random.normal(size=slots),
    )
    return replace(scene, readings=readings)


def late(scene: Scene, random: np.random.Generator) -> Scene:
    """Load, PV and temperatures are read one slot late; prices and the clock are known."""

    def before(x: Array) -> Array:
        return np.concatenate([np.asarray(x)[:1], np.asarray(x)[:-1]])

    seen = scene.readings.exogenous
    seen = replace(
        seen,
        load=before(seen.load),
        pv_generation=before(seen.pv_generation),
        outdoor_temperature=before(seen.outdoor_temperature),
    )
    return replace(scene, readings=replace(scene.readings, exogenous=seen, lag=np.ones((), int)))


def rebuilt(factors: tuple[float, float], scene: Scene, random: np.random.Generator) -> Scene:
    """Conductance and time constant of the building are these multiples of what was identified."""
    conductance, constant = factors
    model = scene.home.thermal_model
    if not isinstance(model, ExplicitThermalModel):
        raise HemmaError(
            f"faults: expected a simulated building with constants to change, got {type(model).__name__}"
        )
    other = replace(
        model, conductance=model.conductance * conductance, inertia=model.inertia ** (1 / constant)
    )
    return replace(scene, home=replace(scene.home, thermal_model=other))


def worn(efficiency: float, scene: Scene, random: np.random.Generator) -> Scene:
    """eta_c and eta_d are this and not what is believed."""
    battery = replace(scene.home.battery, charging_efficiency=efficiency, discharging_efficiency=efficiency)
    return replace(scene, home=replace(scene.home, battery=battery))


def without_thermometer(scene: Scene, random: np.random.Generator) -> Scene:
    """T_in is missing for an hour a day."""
    missing = _an_hour_a_day(scene.exogenous, random)
    return replace(scene, readings=replace(scene.readings, is_temperature_missing=missing))


def without_battery_level(scene: Scene, random: np.random.Generator) -> Scene:
    """E is missing for an hour a day."""
    missing = _an_hour_a_day(scene.exogenous, random)
    return replace(scene, readings=replace(scene.readings, is_energy_missing=missing))


def without_price(scene: Scene, random: np.random.Generator) -> Scene:
    """Prices are missing for an hour a day; the last ones read are taken."""
    missing = _an_hour_a_day(scene.exogenous, random)
    missing[0] = False  # the first reading of all is there
    last = np.maximum.accumulate(np.where(missing, 0, np.arange(len(missing))))
    seen = scene.readings.exogenous
    seen = replace(
        seen,
        buying_price=np.asarray(seen.buying_price)[last],
        selling_price=np.asarray(seen.selling_price)[last],
    )
    readings = replace(scene.readings, exogenous=seen)
    return replace(scene, readings=readings, is_price_missing=missing)


def spiked(spikes: tuple[float, float], scene: Scene, random: np.random.Generator) -> Scene:
    """A share of the hours costs, and pays, a multiple."""
    share, factor = spikes
    hours = np.floor(np.arange(scene.exogenous.slots) * float(scene.home.slot_length)).astype(int)
    multiple = np.where(random.uniform(size=hours[-1] + 1) < share, factor, 1.0)[hours]
    real = scene.exogenous
    real = replace(
        real, buying_price=real.buying_price * multiple, selling_price=real.selling_price * multiple
    )
    return replace(scene, exogenous=real, readings=replace(scene.readings, exogenous=real))


def another_household(factor: float, scene: Scene, random: np.random.Generator) -> Scene:
    """So many times the load, and PV divided by it."""
    real = scene.exogenous
    real = replace(real, load=real.load * factor, pv_generation=real.pv_generation / factor)
    return replace(scene, exogenous=real, readings=replace(scene.readings, exogenous=real))


def _an_hour_a_day(exogenous: Exogenous, random: np.random.Generator) -> Bool[np.ndarray, "slots"]:
    """Slots of one random hour of each day."""
    clock = np.asarray(exogenous.hour_of_day)
    days = np.cumsum(np.diff(clock, prepend=clock[0]) < 0)
    hours = random.integers(0, 24, size=days[-1] + 1)
    return np.floor(clock) == hours[days]
