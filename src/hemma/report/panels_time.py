"""Panels (e) and (f) and the week's powers: what the controllers did, hour by hour."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from hemma.report.canvas import FAINT, INK, days_below, legend_above
from hemma.report.methods import GREEN, ORANGE, look_of, shown_over_time
from hemma.report.results import HomeResults
from hemma.report.series import ExogenousSeries, ScheduleSeries, SeriesReader

SHOWN_DAYS = 7
PRICE_COLOUR = "#BDBDBD"
_PRICE_SHARE = 2.6
"""The price axis reaches this many times the highest price, which keeps it below the temperatures."""
_REST = 1e-6
"""A battery whose energy moves less than this [kWh] in the window rests, and is not drawn."""


@dataclass(frozen=True)
class Week:
    """The first week of a home's test period: its exogenous series and some methods' schedules."""

    exogenous: ExogenousSeries
    schedules: dict[str, ScheduleSeries]
    """By method, the run of median cost of each."""
    slots: int
    """Number of slots shown."""

    @property
    def posts(self) -> Shaped[np.ndarray, "posts"]:
        """Local time at the start of every slot and at the end of the last."""
        return self.exogenous.clock.fence_posts(self.slots)


def read_week(reader: SeriesReader, name: str, home: HomeResults) -> Week:
    """Read what the time panels need."""
    slots = min(home.test.slots, round(SHOWN_DAYS * 24 / home.slot_length_h))
    runs = {method: home.methods[method].typical_run for method in shown_over_time(home.methods)}
    return Week(
        exogenous=reader.exogenous(name, home.test.slots),
        schedules={
            method: reader.schedule(run.schedule, home.test.slots)
            for method, run in runs.items()
            if run.schedule is not None
        },
        slots=slots,
    )


def draw_indoor_temperature(axes: Axes, home: HomeResults, week: Week) -> None:
    """Panel (e): indoor temperature at the end of each slot, the comfort band and the price."""
    axes.set_title("(e) Indoor temperature")
    low, high = home.comfort_c
    axes.axhspan(low, high, color=GREEN, alpha=0.10, linewidth=0, label="comfort band", zorder=0)
    for method, schedule in week.schedules.items():
        _line(axes, method, week.posts[1:], schedule.indoor_temperature[: week.slots])
    axes.set_ylabel("Indoor temperature (°C)")
    values = [schedule.indoor_temperature[: week.slots] for schedule in week.schedules.values()]
    bottom, top = min([low, *map(np.min, values)]), max([high, *map(np.max, values)])
    axes.set_ylim(bottom - 0.08 * (top - bottom), top + 0.08 * (top - bottom))
    _finish(axes, home, week)


def draw_battery_level(axes: Axes, home: HomeResults, week: Week) -> None:
    """Panel (f): battery energy at the end of each slot and the price; resting batteries are left out."""
    axes.set_title("(f) Battery level")
    for method, schedule in week.schedules.items():
        energy = schedule.battery_energy[: week.slots]
        if np.ptp(energy) > _REST:
            _line(axes, method, week.posts[1:], energy)
    axes.set_ylabel("Battery energy (kWh)")
    axes.margins(y=0.06)
    axes.set_ylim(bottom=0.0)
    _finish(axes, home, week)


def draw_generation(axes: Axes, home: HomeResults, week: Week) -> None:
    """PV generation and load of the week."""
    axes.set_title("PV generation and load")
    pv, load = week.exogenous.pv_generation, week.exogenous.load
    axes.fill_between(
        week.posts, _post(pv, week.slots), step="post", color=ORANGE, alpha=0.45, lw=0, label="PV generation"
    )
    axes.step(week.posts, _post(load, week.slots), where="post", color=INK, lw=1.2, label="load without HVAC")
    axes.set_ylabel("Power (kW)")
    axes.set_ylim(bottom=0.0)
    _finish(axes, home, week)


def draw_grid_power(axes: Axes, home: HomeResults, week: Week) -> None:
    """Grid power of the week, buying positive."""
    axes.set_title("Grid power: above zero the home buys, below it sells")
    axes.axhline(0.0, color=FAINT, lw=0.9)
    for method, schedule in week.schedules.items():
        look = look_of(method)
        axes.step(
            week.posts,
            _post(schedule.grid_power, week.slots),
            where="post",
            color=look.colour,
            linestyle=look.line,
            lw=1.2,
            label=method,
        )
    axes.set_ylabel("Grid power (kW)")
    _finish(axes, home, week)


def _line(axes: Axes, method: str, time: np.ndarray, values: np.ndarray) -> None:
    look = look_of(method)
    axes.plot(time, values, color=look.colour, linestyle=look.line, lw=1.5, label=method)  # pyright: ignore[reportArgumentType]


def _post(values: np.ndarray, slots: int) -> np.ndarray:
    """Slot values at the fence posts of a step drawn from each post to the next."""
    return np.append(values[:slots], values[slots - 1])


def _finish(axes: Axes, home: HomeResults, week: Week) -> None:
    _shade_price(axes, home, week)
    days_below(axes, week.posts[0], week.posts[-1])
    axes.set_xlabel(f"Local time ({week.exogenous.clock.offset})")
    legend_above(axes, columns=7)


def _shade_price(axes: Axes, home: HomeResults, week: Week) -> None:
    price = _post(week.exogenous.buying_price, week.slots)
    right = axes.twinx()
    right.fill_between(week.posts, price, step="post", color=PRICE_COLOUR, alpha=0.6, linewidth=0)
    axes.fill_between([], [], color=PRICE_COLOUR, alpha=0.6, linewidth=0, label="buying price (right)")
    highest = max(float(np.max(price)), 1e-9)
    right.set_ylim(min(0.0, float(np.min(price))), _PRICE_SHARE * highest)
    right.set_yticks([tick for tick in MaxNLocator(3).tick_values(0.0, highest) if tick <= 1.2 * highest])
    right.set_ylabel(f"Price ({home.currency}/kWh)", y=0.0, ha="left", color=FAINT)
    right.grid(visible=False)
    right.spines["right"].set_visible(False)
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
