"""Maps of what the learned reward wants: of the battery by price and energy, of the HVAC by temperatures."""

from collections.abc import Sequence
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Patch

from hemma.evaluation.reward_maps import FRACTIONS, Answers, Grid, preferred
from hemma.methods.looks import BLUE, ORANGE
from hemma.report.drawing.canvas import GRID, INK, new_figure
from hemma.report.numbers import plain

DISCHARGE_TO_CHARGE = LinearSegmentedColormap.from_list(
    "power", ["#D55E00", "#F3C9A8", "#FFFFFF", "#A9D0EA", "#0072B2"]
)
COOL_TO_WARM = DISCHARGE_TO_CHARGE.reversed()
DISAGREE = "/////"
LEVELS = 14
"""Bounds of the steps of colour, an even number so that the middle step is white."""
TICKS = 7
"""Numbers beside the colours."""
POWER_SPREAD = 0.25
"""Runs disagree where their standard deviation is more than this share of the battery's power."""
TEMPERATURE_SPREAD = 0.2
"""Runs disagree where their standard deviation is more than this [degC]."""
REACH = 1.5
"""Degrees above and below the edge of comfort that the colours of the comfort map tell apart."""

Runs = Float[np.ndarray, "runs rows columns"]
"""A map of each run."""


@dataclass(frozen=True)
class BatteryMap:
    """What every run pays each battery power, by buying price (x) and energy (y)."""

    hour: float
    grid: Grid
    found: Answers


@dataclass(frozen=True)
class ComfortMap:
    """What every run pays each HVAC power, by outdoor (x) and indoor temperature (y)."""

    hour: float
    edge: float
    """The edge of comfort at which energy is saved [degC]."""
    tried: float
    """How far from the comfort action the HVAC's fraction was in training, three sigma."""
    grid: Grid
    found: Answers


def battery_figure(maps: Sequence[BatteryMap]) -> Figure:
    """A column an hour; above what the whole r pays best, below what g alone does."""
    figure = new_figure(9.2, 5.2)
    panels = figure.subplots(2, len(maps), sharex=True, sharey=True, squeeze=False)
    limit = max(float(np.max(np.abs(one.found.battery_power))) for one in maps)
    levels, spread = np.linspace(-limit, limit, LEVELS), POWER_SPREAD * limit
    for (above, below), one in zip(panels.T, maps, strict=True):
        for axes, paid in ((above, one.found.reward), (below, one.found.ground)):
            wanted = np.asarray(preferred(one.found.battery_power, paid))
            _draw_map(axes, one.grid, wanted, levels, DISCHARGE_TO_CHARGE)
            _hatch(axes, one.grid, wanted, spread)
        above.set_title(f"{plain(one.hour)} h")
        below.set_xlabel("Buying price (per kWh)")
    panels[0, 0].set_ylabel("Paid best by r\nBattery energy (kWh)")
    panels[1, 0].set_ylabel("Paid best by g alone\nBattery energy (kWh)")
    _colour_bar(figure, panels, "Battery power, charging positive (kW)", aspect=36.0)
    _explain(figure, f"runs differ by more than {plain(spread)} kW (standard deviation)")
    return figure


def comfort_figure(one: ComfortMap) -> Figure:
    """Where the slot ends under what r pays best, under what g does, and what either pays for it.

    The maps compare what was tried in training; beyond it r and g are guesses, as the third panel shows.
    """
    figure = new_figure(9.6, 3.7)
    maps, curves = np.asarray(figure.subfigures(1, 2, width_ratios=(1.9, 1.0))).tolist()
    panels = maps.subplots(1, 2, sharey=True)
    levels = one.edge + np.linspace(-REACH, REACH, LEVELS)
    for axes, paid, name in zip(panels, (one.found.reward, one.found.ground), ("r", "g alone"), strict=True):
        tried = np.where(np.abs(FRACTIONS) <= one.tried, np.asarray(paid), -np.inf)
        wanted = np.asarray(preferred(one.found.next_temperature, jnp.asarray(tried)))
        _draw_map(axes, one.grid, wanted, levels, COOL_TO_WARM)
        _hatch(axes, one.grid, wanted, TEMPERATURE_SPREAD)
        axes.set_title(f"Paid best by {name}")
        axes.set_xlabel("Outdoor temperature (°C)")
    panels[0].set_ylabel("Indoor temperature (°C)")
    _colour_bar(maps, panels, "Indoors at the end of the slot (°C)", aspect=30.0)
    _pay(curves.subplots(), one)
    _explain(maps, f"runs differ by more than {plain(TEMPERATURE_SPREAD)} °C (standard deviation)")
    return figure


def _draw_map(
    axes: Axes, grid: Grid, wanted: Runs, levels: Float[np.ndarray, "levels"], colours: Colormap
) -> None:
    """The mean over the runs."""
    axes.contourf(grid.x, grid.y, wanted.mean(axis=0), levels=levels, cmap=colours, extend="both")


def _hatch(axes: Axes, grid: Grid, wanted: Runs, spread: float) -> None:
    deviation = wanted.std(axis=0)
    if deviation.max() > spread:
        axes.contourf(grid.x, grid.y, deviation, levels=[spread, np.inf], colors="none", hatches=[DISAGREE])
    axes.grid(visible=False)


def _colour_bar(figure: FigureBase, panels: np.ndarray, label: str, aspect: float) -> None:
    """The colours of the maps, which are the same in all panels."""
    drawn = panels.flat[0].collections[0]
    ticks = np.linspace(drawn.levels[0], drawn.levels[-1], TICKS)
    figure.colorbar(drawn, ax=panels, label=label, aspect=aspect, ticks=ticks)


def _pay(axes: Axes, one: ComfortMap) -> None:
    """r and g over the HVAC's fraction, less their most, from the edge of comfort on a hot day."""
    row = int(np.argmin(np.abs(one.grid.y - one.edge)))
    column = int(0.75 * len(one.grid.x))
    axes.axvspan(-one.tried, one.tried, color=GRID, lw=0, label="tried in training")
    for paid, name, colour in ((one.found.reward, "r", BLUE), (one.found.ground, "g alone", ORANGE)):
        runs = np.asarray(paid)[:, row, column]
        runs = runs - runs[:, np.abs(FRACTIONS) <= one.tried].max(axis=-1, keepdims=True)
        axes.plot(FRACTIONS, runs.T, color=colour, lw=0.6, alpha=0.45)
        axes.plot(FRACTIONS, runs.mean(axis=0), color=colour, lw=1.8, label=name)
    ends = np.asarray(one.found.next_temperature)[row, column]
    ticks = (-1.0, 0.0, 1.0)
    words = [
        f"{plain(tick)}\n{end:.1f} °C"
        for tick, end in zip(ticks, np.interp(ticks, FRACTIONS, ends), strict=True)
    ]
    axes.set_xticks(ticks, words, fontsize=7.5)
    axes.set_title(f"At {one.grid.y[row]:.0f} °C, outdoors {one.grid.x[column]:.0f} °C")
    axes.set_xlabel("HVAC fraction, and where the slot ends")
    axes.set_ylabel("Pay, less the most that was tried (nats)")
    axes.legend(loc="lower center", fontsize=7.5, frameon=True, framealpha=0.9, edgecolor="none")


def _explain(figure: FigureBase, words: str) -> None:
    patch = Patch(facecolor="white", edgecolor=INK, hatch=DISAGREE, linewidth=0.5, label=words)
    figure.legend(handles=[patch], loc="outside upper left")
