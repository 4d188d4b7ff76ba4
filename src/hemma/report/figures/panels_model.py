"""The identified network running on its own beside the measurement."""

from matplotlib.figure import Figure

from hemma.report.drawing.canvas import FAINT, INK, days_below, legend_above, new_figure
from hemma.report.methods import BLUE, VERMILLION
from hemma.report.series import FreeRun


def free_run_figure(run: FreeRun, slots: int) -> Figure:
    """The first ``slots`` slots of a free run beside the measurement, and its error over the whole period."""
    figure = new_figure(9.2, 5.0)
    above, below = figure.subplots(2, 1)
    count = min(slots, len(run.measured))
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
