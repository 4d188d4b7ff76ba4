"""The home as rows and columns of a programme: one function for each equation, named after it.

When whole numbers are needed is proved in ``docs/expert.md``.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from hemma.errors import HemmaError
from hemma.home import Battery, ComfortBand, Home
from hemma.optimisation.affine import AffineResponse
from hemma.optimisation.exact.programme import Programme
from hemma.types import Exogenous

ROUNDING = 1e-6
"""How far single precision may carry an energy beyond its limits [kWh]."""

Block = Int[np.ndarray, "slots"]


@dataclass(frozen=True)
class BatteryColumns:
    """e = charge - discharge [kW], never both, and E at the end of each slot [kWh]."""

    charge: Block
    discharge: Block
    energy: Block


@dataclass(frozen=True)
class ThermalColumns:
    """h [kW] and T_in = held + excess - lack at the end of each slot [degC], so X3 = excess + lack."""

    hvac: Block
    held: Block
    excess: Block
    lack: Block


def idling_pays(battery: Battery, exogenous: Exogenous) -> Bool[np.ndarray, "slots"]:
    """Slots in which charging while discharging could lower the cost, so that it must be forbidden.

    min(u+, u-) (1 - eta_c eta_d) + k_e (1 + eta_c eta_d) < 0: being paid to burn energy beats the ageing.
    """
    product = battery.charging_efficiency * battery.discharging_efficiency
    lowest = np.minimum(exogenous.buying_price, exogenous.selling_price)
    return lowest * (1 - product) + battery.ageing_cost * (1 + product) < 0


def arbitrage_pays(exogenous: Exogenous) -> Bool[np.ndarray, "slots"]:
    """Slots in which buying while selling could lower the cost: u- > u+."""
    return np.asarray(exogenous.selling_price) > np.asarray(exogenous.buying_price)


def add_battery(programme: Programme, home: Home, exogenous: Exogenous, energy: float) -> BatteryColumns:
    """Columns of the battery within (3) and (4), their ageing cost, and the rows that bind them.

    ``energy`` is E at the start of the first slot [kWh]; outside (3) by more than rounding it is refused.
    """
    battery, dt = home.battery, home.slot_length
    inside = float(np.clip(energy, battery.min_energy, battery.max_energy))
    if not abs(energy - inside) <= ROUNDING:
        raise HemmaError(
            f"battery: expected an initial energy from {battery.min_energy:g} to {battery.max_energy:g} kWh, "
            f"got {energy:g}; correct the initial state"
        )
    ageing = battery.ageing_cost * dt
    columns = BatteryColumns(
        charge=programme.add_columns(0.0, battery.max_charging_power, ageing),
        discharge=programme.add_columns(0.0, battery.max_discharging_power, ageing),
        energy=programme.add_columns(battery.min_energy, battery.max_energy),
    )
    energy_balance(programme, columns, home, inside)
    charge_or_discharge(programme, columns, battery, idling_pays(battery, exogenous))
    return columns


def energy_balance(programme: Programme, columns: BatteryColumns, home: Home, energy: float) -> None:
    """E_{t+1} - E_t - eta_c dt charge + (dt / eta_d) discharge = 0, equation (5)."""
    start = programme.add_columns(energy, energy, entries=1)
    programme.add_rows(
        0.0,
        0.0,
        (columns.energy, 1.0),
        (_before(start, columns.energy), -1.0),
        (columns.charge, -home.battery.charging_efficiency * home.slot_length),
        (columns.discharge, home.slot_length / home.battery.discharging_efficiency),
    )


def charge_or_discharge(
    programme: Programme, columns: BatteryColumns, battery: Battery, where: Bool[np.ndarray, "slots"]
) -> None:
    """charge <= c^max z, discharge <= d^max (1 - z), z in {0, 1}, in the slots ``where``."""
    count = int(where.sum())
    c, d = battery.max_charging_power, battery.max_discharging_power
    z = programme.add_columns(0.0, 1.0, whole=True, entries=count)
    programme.add_rows(-np.inf, 0.0, (columns.charge[where], 1.0), (z, -c))
    programme.add_rows(-np.inf, d, (columns.discharge[where], 1.0), (z, d))


def power_balance(
    programme: Programme,
    home: Home,
    exogenous: Exogenous,
    hvac: Block | Float[np.ndarray, "slots"],
    battery: BatteryColumns | None,
) -> Block:
    """buy - sell - h - e = l - p, equation (8), with cost u+ buy dt - u- sell dt, equation (1).

    ``hvac`` holds columns (integers) or known powers [kW] (floats). Never buy and sell in one slot:
    buy <= B z, sell <= S (1 - z) where it could pay, with the largest powers B and S that can occur.
    Gives the rows of the balance.
    """
    known = np.issubdtype(hvac.dtype, np.floating)
    demand = np.asarray(exogenous.load) - np.asarray(exogenous.pv_generation) + (hvac if known else 0.0)
    most = demand + (0.0 if known else home.hvac.max_power)
    charge, discharge = (
        (0.0, 0.0)
        if battery is None
        else (home.battery.max_charging_power, home.battery.max_discharging_power)
    )
    B, S = np.maximum(most + charge, 0.0), np.maximum(discharge - demand, 0.0)
    dt = home.slot_length
    buy = programme.add_columns(0.0, B, np.asarray(exogenous.buying_price) * dt)
    sell = programme.add_columns(0.0, S, -np.asarray(exogenous.selling_price) * dt)
    terms = [(buy, 1.0), (sell, -1.0)]
    terms += [] if known else [(hvac, -1.0)]
    terms += [] if battery is None else [(battery.charge, -1.0), (battery.discharge, 1.0)]
    balance = programme.add_rows(demand, demand, *terms)
    where = arbitrage_pays(exogenous) & (B > 0) & (S > 0)
    count = int(where.sum())
    z = programme.add_columns(0.0, 1.0, whole=True, entries=count)
    programme.add_rows(-np.inf, 0.0, (buy[where], 1.0), (z, -B[where]))
    programme.add_rows(-np.inf, S[where], (sell[where], 1.0), (z, S[where]))
    return balance


def add_building(programme: Programme, home: Home, response: AffineResponse, price: float) -> ThermalColumns:
    """Columns of the HVAC within (6) and of the temperature; ``price`` is the cost of X3 [1/degC]."""
    comfort: ComfortBand = home.comfort
    free = response.free[:, 0]
    reach = response.reach(float(home.hvac.max_power))
    columns = ThermalColumns(
        hvac=programme.add_columns(0.0, home.hvac.max_power),
        held=programme.add_columns(comfort.low, comfort.high),
        excess=programme.add_columns(0.0, np.maximum(free + reach[:, 0] - comfort.high, 0.0), price),
        lack=programme.add_columns(0.0, np.maximum(comfort.low - free + reach[:, 0], 0.0), price),
    )
    memory = programme.add_columns(-reach[:, 1], reach[:, 1]) if response.memory_matters else None
    thermal_dynamics(programme, columns, response, memory)
    return columns


def thermal_dynamics(
    programme: Programme, columns: ThermalColumns, response: AffineResponse, memory: Block | None
) -> None:
    """T_{t+1} - a_t T_t - w_t m_t - b_t h_t = f_{t+1} - a_t f_t, equation (7) in its affine form.

    T = held + excess - lack, f is the free path, m the memory beside its own free path:
    m_{t+1} - v_t (T_t - f_t) - n_t m_t - q_t h_t = 0. Without ``memory`` it stays on its free path.
    """
    free = response.free[:, 0]
    earlier = np.concatenate([[0.0], free[:-1]])  # the first slot starts on the free path: T_0 - f_0 = 0
    nothing = programme.add_columns(0.0, 0.0, entries=1)

    def temperature_before(slope: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        blocks = ((columns.held, slope), (columns.excess, slope), (columns.lack, -slope))
        return [(_before(nothing, block), coefficient) for block, coefficient in blocks]

    (a, w), (v, n) = response.carry.transpose(1, 2, 0)
    b, q = response.gain.T
    now = [(columns.held, 1.0), (columns.excess, 1.0), (columns.lack, -1.0), (columns.hvac, -b)]
    remembered = [] if memory is None else [(_before(nothing, memory), -w)]
    moved = free - a * earlier
    programme.add_rows(moved, moved, *now, *temperature_before(-a), *remembered)
    if memory is not None:
        terms = [(memory, 1.0), (_before(nothing, memory), -n), (columns.hvac, -q)]
        programme.add_rows(-v * earlier, -v * earlier, *terms, *temperature_before(-v))


def comfort_budget(programme: Programme, columns: ThermalColumns, budget: float) -> Int[np.ndarray, "1"]:
    """Sum over the slots of excess + lack <= D [degC]: the bill at equal comfort. Gives its row."""
    both = np.concatenate([columns.excess, columns.lack])
    return programme.add_rows(0.0, budget, (both[None, :], 1.0))


def _before(first: np.ndarray, block: Block) -> Block:
    """The column of the slot before, ``first`` before the first slot."""
    return np.concatenate([first, block[:-1]])
