"""The identified network running on its own beside the measurement."""

import numpy as np
from matplotlib.figure import Figure

from hemma.methods.looks import BLUE, VERMILLION
from hemma.report.drawing.canvas import FAINT, INK, days_below, legend_above, new_figure
from hemma.report.figures.figure import IDENTIFICATION, HomeFigure, Words
from hemma.report.series import FreeRun
from hemma.report.subject import WEEK_DAYS


def free_run_figure(run: FreeRun) -> Figure:
    """The first week of a free run beside the measurement, and its error over the whole period."""
    figure = new_figure(9.2, 5.0)
    above, below = figure.subplots(2, 1)
    start = run.clock.start
    count = int(np.searchsorted(start, start[0] + np.timedelta64(WEEK_DAYS, "D")))
    posts = run.clock.fence_posts(count)
    above.set_title("The identified network on its own, first days")
    above.plot(posts[:-1], run.measured[:count], color=INK, label="measured")
    above.plot(posts[:-1], run.predicted[:count], color=BLUE, linestyle="--", label="predicted")
    above.set_ylabel("Indoor temperature (°C)")
    days_below(above, posts[0], posts[-1])
    legend_above(above, columns=2)
    whole = run.clock.fence_posts(len(run.measured))
    below.set_title("Error over the whole period")
    below.axhline(0.0, color=FAINT, lw=0.9)
    below.plot(whole[:-1], run.predicted - run.measured, color=VERMILLION, lw=1.0)
    below.set_ylabel("Predicted − measured (°C)")
    days_below(below, whole[0], whole[-1])
    below.set_xlabel(f"Local time ({run.clock.offset})")
    return figure


FREE_RUN = HomeFigure[FreeRun](
    name="free-run",
    section=IDENTIFICATION,
    needs=lambda subject: subject.free_run,
    draw=free_run_figure,
    words=lambda _: Words(
        "Free run of the identified network",
        "Measured and predicted indoor temperature for the first days, and the error over the period.",
        "The network is given the first temperature only and then runs on its own predictions.",
    ),
)
