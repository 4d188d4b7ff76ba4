"""Axes over local time: lines and steps of a week, and the buying price behind them."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from hemma.report.drawing.canvas import FAINT, days_below, legend_above
from hemma.report.subject import Week
from hemma.results.results import HomeResults

PRICE_LOOK: dict[str, Any] = {"color": "#BDBDBD", "alpha": 0.6, "linewidth": 0}
_PRICE_SHARE = 2.6
"""The price axis reaches this many times the highest price, which keeps it below the temperatures."""


def step_values(values: np.ndarray) -> np.ndarray:
    """Slot values at the fence posts of a step drawn from each post to the next."""
    return np.append(values, values[-1])


def finish_week(axes: Axes, home: HomeResults, week: Week) -> None:
    """Price, days, label and legend, when all lines are drawn."""
    _shade_price(axes, home, week)
    days_below(axes, week.posts[0], week.posts[-1])
    axes.set_xlabel(f"Local time ({week.exogenous.clock.offset})")
    legend_above(axes, columns=7)


def _shade_price(axes: Axes, home: HomeResults, week: Week) -> None:
    price = step_values(week.exogenous.buying_price)
    right = axes.twinx()
    right.fill_between(week.posts, price, step="post", **PRICE_LOOK)
    axes.fill_between([], [], label="buying price (right)", **PRICE_LOOK)
    lowest, highest = week.price_range
    right.set_ylim(lowest, _PRICE_SHARE * highest)
    right.set_yticks([tick for tick in MaxNLocator(3).tick_values(0.0, highest) if tick <= 1.2 * highest])
    right.set_ylabel(f"Price ({home.currency}/kWh)", y=0.0, ha="left", color=FAINT)
    right.grid(visible=False)
    right.spines["right"].set_visible(False)
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
