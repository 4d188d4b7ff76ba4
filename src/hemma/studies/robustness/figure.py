"""What faults leave of the savings, method by method."""

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from hemma.report.drawing.canvas import INK, new_figure
from hemma.report.numbers import DASH, decimals

LOWEST = 0.0
"""Shares below this have the darkest colour; the number says more."""


def robustness_figure(
    faults: list[str], methods: list[str], shares: Float[np.ndarray, "faults methods"]
) -> Figure:
    """A field a fault and method: its mean share of savings in per cent, NaN where there is none."""
    figure = new_figure(1.9 + 0.72 * len(methods), 1.1 + 0.32 * len(faults))
    axes = figure.subplots()
    axes.imshow(np.nan_to_num(shares, nan=LOWEST), cmap="cividis", vmin=LOWEST, vmax=1.0, aspect="auto")
    for (row, column), share in np.ndenumerate(shares):
        text = decimals(100 * share, 0) if np.isfinite(share) else DASH
        colour = INK if share > 0.55 else "white"
        axes.text(column, row, text, ha="center", va="center", fontsize=8.5, color=colour)
    axes.set_xticks(range(len(methods)), methods, rotation=40, ha="left", rotation_mode="anchor")
    axes.set_yticks(range(len(faults)), faults)
    axes.xaxis.tick_top()
    axes.grid(visible=False)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.set_xlabel("Share of savings at the same deviation (%); 100 is perfect information in the same home")
    return figure
