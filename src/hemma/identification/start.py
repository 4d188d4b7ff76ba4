"""Where training starts: scales of the inputs, and a physical response by constrained least squares."""

import numpy as np
from scipy.optimize import lsq_linear

from hemma.home.thermal import ExplicitThermalModel
from hemma.identification.pcnn import InputScaling, ThermalResponse
from hemma.identification.record import ThermalRecord

TIME_CONSTANTS = (1.0, 500.0)
"""Time constants of buildings [h], from a tent to a castle: the range of -dt / log(1 - b)."""
WARMING_RATES = (0.02, 20.0)
"""Ranges of a / dt and d / dt [degC/h per kW electric]."""


def input_scaling(record: ThermalRecord) -> InputScaling:
    """Scales of the inputs of f; a constant temperature or a home without PV is scaled by 1."""
    temperature = np.asarray(record.indoor_temperature, float)
    return InputScaling(
        temperature_mean=float(temperature.mean()),
        temperature_deviation=float(temperature.std()) or 1.0,
        pv_peak=float(np.max(record.drivers.pv_generation)) or 1.0,
    )


def least_squares_response(record: ThermalRecord) -> ThermalResponse:
    """Minimise sum (T' - T - a u_heat + d u_cool + b (T - T_out))^2 with a, b, d inside physical ranges.

    One step ahead and with f = 0; the gains of sun and people bias it, and training starts from there. A
    direction that the record never used (no heating in summer) takes the response of the other one, and a
    record without HVAC that of the benchmark home.
    """
    heated, cooled = (np.any(np.asarray(u) > 0) for u in _powers(record))
    solution = _bounded_least_squares(record)
    fallback = ExplicitThermalModel().at_slot_length(float(record.slot_length)).temperature_per_power
    a = solution[0] if heated else solution[1] if cooled else fallback
    d = solution[1] if cooled else a
    return ThermalResponse(heating=float(a), cooling=float(d), loss=float(solution[2]))


def _powers(record: ThermalRecord) -> tuple[np.ndarray, np.ndarray]:
    drivers = record.drivers
    return np.asarray(drivers.heating_power, float), np.asarray(drivers.cooling_power, float)


def _bounded_least_squares(record: ThermalRecord) -> np.ndarray:
    """Parameters a, d, b."""
    drivers, T = record.drivers, np.asarray(record.indoor_temperature, float)
    u_heat, u_cool = _powers(record)
    columns = [u_heat, -u_cool, np.asarray(drivers.outdoor_temperature, float) - T[:-1]]
    dt = float(record.slot_length)
    shortest, longest = TIME_CONSTANTS
    slow, fast = (rate * dt for rate in WARMING_RATES)
    low = [slow, slow, -np.expm1(-dt / longest)]
    high = [fast, fast, -np.expm1(-dt / shortest)]
    return lsq_linear(np.stack(columns, axis=1), np.diff(T), bounds=(low, high)).x
