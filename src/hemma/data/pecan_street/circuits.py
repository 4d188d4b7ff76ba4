"""From the circuits of a home to PV, load and HVAC power [kW, means over the interval].

``grid`` is positive for import and negative for export, ``solar`` is generation, so that everything the home
uses is grid + solar + solar2 (old files have it as ``use``, and PV as ``gen``).
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from hemma.data.gaps import counted
from hemma.errors import HemmaError

HVAC = ("air1", "air2", "air3", "airwindowunit1", "furnace1", "furnace2", "heater1", "heater2", "heater3")
CARS = ("car1", "car2")
BATTERY = "battery1"
SOLAR = ("solar", "solar2")
OLD = ("use", "gen")
CIRCUITS = (*OLD, "grid", *SOLAR, *HVAC, *CARS, BATTERY)
NOISE = 0.05
"""Between minus this [kW] and 0 an idle circuit is noise; below it the current transformer failed."""
TURNED_SHARE = 0.05
"""A circuit that is below the noise in more than this share of its rows is wired the other way round."""

Series = Float[np.ndarray, "rows"]


def instrumented(columns: Mapping[str, Series]) -> dict[str, Series]:
    """The circuits that are instrumented: a column that is empty throughout the home's rows is not."""
    return {name: column for name, column in columns.items() if np.isfinite(column).any()}


class Circuits:
    """The instrumented circuits of one home."""

    def __init__(self, name: str, columns: Mapping[str, Series]):
        """``name`` says in messages whose circuits these are; columns [kW] have NaN in empty cells."""
        self.name = name
        self.rows = max((len(column) for column in columns.values()), default=0)
        self.columns = columns
        self.notes: list[str] = []

    def has(self, *names: str) -> bool:
        """Whether one of the circuits is instrumented."""
        return any(name in self.columns for name in names)

    def sum(self, *names: str) -> Series:
        """Sum of the magnitudes of the instrumented circuits among them, NaN where one has no value."""
        present = [self.magnitude(name, self.columns[name]) for name in names if name in self.columns]
        return np.sum([np.zeros(self.rows), *present], axis=0)

    def magnitude(self, name: str, series: Series) -> Series:
        """``series`` with noise below 0 set to 0 and values that no circuit can have left out (NaN)."""
        wrong = series < -NOISE
        if wrong.sum() > TURNED_SHARE * len(series):
            raise HemmaError(
                f"{self.name}: expected {name} of at least 0 kW, got less than -{NOISE} kW in "
                f"{100 * wrong.mean():.0f} % of the rows, lowest {np.nanmin(series):.3g}. Its sensor looks "
                "turned round: choose another home, or turn the sign"
            )
        if wrong.any():
            self.notes.append(
                f"{counted(int(wrong.sum()), 'row')} left out in which {name} is negative (lowest "
                f"{np.nanmin(series):.3g} kW): a failed current transformer"
            )
        return np.where(wrong, np.nan, np.maximum(series, 0.0))


def home_power(circuits: Circuits, *, exclude_cars: bool, exclude_battery: bool) -> dict[str, Series]:
    """``pv_kw``, ``load_kw`` and ``hvac_kw`` of a home, NaN where that is not known.

    Load = use - HVAC (- cars, - battery charging when excluded). If no HVAC circuit is instrumented it is a
    part of the load, and there is no ``hvac_kw``.
    """
    pv = circuits.sum("gen") if circuits.has("gen") else circuits.sum(*SOLAR)
    load = used = _use(circuits, pv)
    hvac = circuits.sum(*HVAC) if circuits.has(*HVAC) else None
    if hvac is None:
        circuits.notes.append(
            "no HVAC circuit is instrumented: it is part of load_kw, and hvac_kw is left out"
        )
    else:
        load = load - hvac
    if exclude_cars and circuits.has(*CARS):
        load = load - circuits.sum(*CARS)
        circuits.notes.append("car1 and car2 are taken out of load_kw")
    if circuits.has(BATTERY):
        load = load - circuits.columns[BATTERY] if exclude_battery else load
        circuits.notes.append(_battery_note(exclude_battery))
    load = circuits.magnitude("load (use without the other circuits)", load) if load is not used else load
    power = {"pv_kw": pv, "load_kw": load}
    return power if hvac is None else {**power, "hvac_kw": hvac}


def _use(circuits: Circuits, pv: Series) -> Series:
    """Everything the home uses: ``use``, or grid + solar + solar2."""
    if circuits.has("use"):
        return circuits.magnitude("use", circuits.columns["use"])
    if not circuits.has("grid"):
        raise HemmaError(
            f"{circuits.name}: expected a home whose circuit grid (or use) is instrumented, it is empty. "
            "Choose another home: list_pecan_street_homes says which are instrumented"
        )
    return circuits.magnitude("use (grid + solar)", circuits.columns["grid"] + pv)


def _battery_note(excluded: bool) -> str:
    if excluded:
        return "the home's own battery (battery1, positive taken as charging) is taken out of load_kw"
    return "the home has its own battery (battery1), whose power is part of load_kw"
