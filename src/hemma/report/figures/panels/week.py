"""Panels (e) and (f) and the powers: what a few controllers did in a week, and what they could not decide."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.methods.looks import GREEN, ORANGE
from hemma.report.drawing.canvas import FAINT, FULL_WIDTH, INK, new_figure, single
from hemma.report.drawing.over_time import finish_week, step_values
from hemma.report.figures.figure import PANELS, HomeFigure, Words, listed
from hemma.report.methods import look_of
from hemma.report.numbers import plain
from hemma.report.subject import HomeSubject, Week, battery_rests
from hemma.results.results import HomeResults


def draw_indoor_temperature(axes: Axes, home: HomeResults, week: Week) -> None:
    """Indoor temperature at the end of each slot, the comfort band and the price."""
    axes.set_title("(e) Indoor temperature")
    low, high = home.comfort_c
    axes.axhspan(low, high, color=GREEN, alpha=0.10, linewidth=0, label="comfort band", zorder=0)
    schedules = week.selected
    for method, schedule in schedules.items():
        _draw_line(axes, method, week, schedule.indoor_temperature)
    axes.set_ylabel("Indoor temperature (°C)")
    values = [schedule.indoor_temperature for schedule in schedules.values()]
    bottom, top = min([low, *map(np.min, values)]), max([high, *map(np.max, values)])
    axes.set_ylim(bottom - 0.08 * (top - bottom), top + 0.08 * (top - bottom))
    finish_week(axes, home, week)


def draw_battery_level(axes: Axes, home: HomeResults, week: Week) -> None:
    """Battery energy at the end of each slot and the price; resting batteries are left out."""
    axes.set_title("(f) Battery level")
    for method, schedule in week.selected.items():
        if not battery_rests(schedule):
            _draw_line(axes, method, week, schedule.battery_energy)
    axes.set_ylabel("Battery energy (kWh)")
    axes.margins(y=0.06)
    axes.set_ylim(bottom=0.0)
    finish_week(axes, home, week)


def powers_figure(subject: HomeSubject) -> Figure:
    """PV generation and load above, grid power below."""
    figure = new_figure(FULL_WIDTH, 5.0)
    above, below = figure.subplots(2, 1)
    _draw_generation(above, subject.home, subject.week)
    _draw_grid_power(below, subject.home, subject.week)
    above.set_xlabel("")
    return figure


def _draw_line(axes: Axes, method: str, week: Week, values: np.ndarray) -> None:
    """What a method did, at the end of each slot."""
    look = look_of(method)
    axes.plot(week.posts[1:], values, color=look.colour, linestyle=look.line, lw=1.5, label=method)  # pyright: ignore[reportArgumentType]


def _draw_generation(axes: Axes, home: HomeResults, week: Week) -> None:
    axes.set_title("PV generation and load")
    pv, load = step_values(week.exogenous.pv_generation), step_values(week.exogenous.load)
    axes.fill_between(week.posts, pv, step="post", color=ORANGE, alpha=0.45, lw=0, label="PV generation")
    axes.step(week.posts, load, where="post", color=INK, lw=1.2, label="load without HVAC")
    axes.set_ylabel("Power (kW)")
    axes.set_ylim(bottom=0.0)
    finish_week(axes, home, week)


def _draw_grid_power(axes: Axes, home: HomeResults, week: Week) -> None:
    axes.set_title("Grid power: above zero the home buys, below it sells")
    axes.axhline(0.0, color=FAINT, lw=0.9)
    for method, schedule in week.selected.items():
        look, power = look_of(method), step_values(schedule.grid_power)
        axes.step(
            week.posts, power, where="post", color=look.colour, linestyle=look.line, lw=1.2, label=method
        )
    axes.set_ylabel("Grid power (kW)")
    finish_week(axes, home, week)


def _of_whom(week: Week) -> str:
    """Whose lines are drawn, and for how long."""
    return f"{listed(week.selected)} over {plain(round(week.days, 1))} days"


def _words_of_temperature(subject: HomeSubject) -> Words:
    (low, high), week = subject.home.comfort_c, subject.week
    return Words(
        "(e) Indoor temperature",
        f"Indoor temperature of {_of_whom(week)}, with the comfort band from {plain(low)} to {plain(high)} "
        "°C and the buying price.",
        f"Week {week.number} of the test period; of several seeds the one of median cost. "
        "Staying near the edge of the band needs the least energy.",
    )


def _words_of_battery(subject: HomeSubject) -> Words:
    return Words(
        "(f) Battery level",
        f"Battery energy of {_of_whom(subject.week)}, with the buying price.",
        "Good control fills the battery where the grey price is low and empties it where it is high. "
        "Batteries that rest are left out.",
    )


def _words_of_powers(subject: HomeSubject) -> Words:
    week = subject.week
    return Words(
        "PV generation, load and grid power",
        f"PV generation and load, and the grid power of {listed(week.selected)}, slot by slot for "
        f"{plain(round(week.days, 1))} days.",
        "Above: what the home cannot decide. Below: what each controller makes of it at the meter. "
        "The grey area is the buying price.",
    )


INDOOR_TEMPERATURE = HomeFigure[HomeSubject](
    name="indoor-temperature",
    section=PANELS,
    needs=lambda subject: subject,
    draw=lambda it: single(FULL_WIDTH, 2.9, lambda axes: draw_indoor_temperature(axes, it.home, it.week)),
    words=_words_of_temperature,
)
BATTERY_LEVEL = HomeFigure[HomeSubject](
    name="battery-level",
    section=PANELS,
    needs=lambda subject: subject,
    draw=lambda it: single(FULL_WIDTH, 2.9, lambda axes: draw_battery_level(axes, it.home, it.week)),
    words=_words_of_battery,
)
POWERS_WEEK = HomeFigure[HomeSubject](
    name="powers-week",
    section=PANELS,
    needs=lambda subject: subject,
    draw=powers_figure,
    words=_words_of_powers,
)
