"""Panels (e) and (f) and the week's powers: what a few controllers did, slot by slot."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from hemma.report.drawing.canvas import FAINT, INK, days_below, legend_above
from hemma.report.methods import GREEN, ORANGE, look_of
from hemma.report.week import Week, battery_rests
from hemma.results.results import HomeResults

PRICE_COLOUR = "#BDBDBD"
_PRICE_SHARE = 2.6
"""The price axis reaches this many times the highest price, which keeps it below the temperatures."""


def draw_indoor_temperature(axes: Axes, home: HomeResults, week: Week) -> None:
    """Panel (e): indoor temperature at the end of each slot, the comfort band and the price."""
    axes.set_title("(e) Indoor temperature")
    low, high = home.comfort_c
    axes.axhspan(low, high, color=GREEN, alpha=0.10, linewidth=0, label="comfort band", zorder=0)
    schedules = week.selected
    for method, schedule in schedules.items():
        _line(axes, method, week.posts[1:], schedule.indoor_temperature)
    axes.set_ylabel("Indoor temperature (°C)")
    values = [schedule.indoor_temperature for schedule in schedules.values()]
    bottom, top = min([low, *map(np.min, values)]), max([high, *map(np.max, values)])
    axes.set_ylim(bottom - 0.08 * (top - bottom), top + 0.08 * (top - bottom))
    _finish(axes, home, week)


def draw_battery_level(axes: Axes, home: HomeResults, week: Week) -> None:
    """Panel (f): battery energy at the end of each slot and the price; resting batteries are left out."""
    axes.set_title("(f) Battery level")
    for method, schedule in week.selected.items():
        if not battery_rests(schedule):
            _line(axes, method, week.posts[1:], schedule.battery_energy)
    axes.set_ylabel("Battery energy (kWh)")
    axes.margins(y=0.06)
    axes.set_ylim(bottom=0.0)
    _finish(axes, home, week)


def draw_generation(axes: Axes, home: HomeResults, week: Week) -> None:
    """PV generation and load of the week."""
    axes.set_title("PV generation and load")
    pv, load = step_values(week.exogenous.pv_generation), step_values(week.exogenous.load)
    axes.fill_between(week.posts, pv, step="post", color=ORANGE, alpha=0.45, lw=0, label="PV generation")
    axes.step(week.posts, load, where="post", color=INK, lw=1.2, label="load without HVAC")
    axes.set_ylabel("Power (kW)")
    axes.set_ylim(bottom=0.0)
    _finish(axes, home, week)


def draw_grid_power(axes: Axes, home: HomeResults, week: Week) -> None:
    """Grid power of the week, buying positive."""
    axes.set_title("Grid power: above zero the home buys, below it sells")
    axes.axhline(0.0, color=FAINT, lw=0.9)
    for method, schedule in week.selected.items():
        look = look_of(method)
        axes.step(
            week.posts,
            step_values(schedule.grid_power),
            where="post",
            color=look.colour,
            linestyle=look.line,
            lw=1.2,
            label=method,
        )
    axes.set_ylabel("Grid power (kW)")
    _finish(axes, home, week)


def step_values(values: np.ndarray) -> np.ndarray:
    """Slot values at the fence posts of a step drawn from each post to the next."""
    return np.append(values, values[-1])


def _line(axes: Axes, method: str, time: np.ndarray, values: np.ndarray) -> None:
    look = look_of(method)
    axes.plot(time, values, color=look.colour, linestyle=look.line, lw=1.5, label=method)  # pyright: ignore[reportArgumentType]


def _finish(axes: Axes, home: HomeResults, week: Week) -> None:
    _shade_price(axes, home, week)
    days_below(axes, week.posts[0], week.posts[-1])
    axes.set_xlabel(f"Local time ({week.exogenous.clock.offset})")
    legend_above(axes, columns=7)


def _shade_price(axes: Axes, home: HomeResults, week: Week) -> None:
    price = step_values(week.exogenous.buying_price)
    right = axes.twinx()
    right.fill_between(week.posts, price, step="post", color=PRICE_COLOUR, alpha=0.6, linewidth=0)
    axes.fill_between([], [], color=PRICE_COLOUR, alpha=0.6, linewidth=0, label="buying price (right)")
    lowest, highest = week.price_range
    right.set_ylim(lowest, _PRICE_SHARE * highest)
    right.set_yticks([tick for tick in MaxNLocator(3).tick_values(0.0, highest) if tick <= 1.2 * highest])
    right.set_ylabel(f"Price ({home.currency}/kWh)", y=0.0, ha="left", color=FAINT)
    right.grid(visible=False)
    right.spines["right"].set_visible(False)
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
