"""What the home could not decide in a week, and what each controller made of it at the meter."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.methods.looks import ORANGE
from hemma.report.drawing.canvas import FAINT, FULL_WIDTH, INK, new_figure
from hemma.report.drawing.over_time import finish_week, step_values
from hemma.report.figures.figure import PANELS, HomeFigure, Words, listed
from hemma.report.methods import look_of
from hemma.report.numbers import plain
from hemma.report.subject import HomeSubject
from hemma.report.week import Week
from hemma.results.results import HomeResults


def powers_figure(home: HomeResults, week: Week) -> Figure:
    """PV generation and load above, grid power below."""
    figure = new_figure(FULL_WIDTH, 5.0)
    above, below = figure.subplots(2, 1)
    _draw_generation(above, home, week)
    _draw_grid_power(below, home, week)
    above.set_xlabel("")
    return figure


def _draw_generation(axes: Axes, home: HomeResults, week: Week) -> None:
    """PV generation and load of the week."""
    axes.set_title("PV generation and load")
    pv, load = step_values(week.exogenous.pv_generation), step_values(week.exogenous.load)
    axes.fill_between(week.posts, pv, step="post", color=ORANGE, alpha=0.45, lw=0, label="PV generation")
    axes.step(week.posts, load, where="post", color=INK, lw=1.2, label="load without HVAC")
    axes.set_ylabel("Power (kW)")
    axes.set_ylim(bottom=0.0)
    finish_week(axes, home, week)


def _draw_grid_power(axes: Axes, home: HomeResults, week: Week) -> None:
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
    finish_week(axes, home, week)


def _words(subject: HomeSubject) -> Words:
    week = subject.week
    return Words(
        "PV generation, load and grid power",
        f"PV generation and load, and the grid power of {listed(week.selected)}, slot by slot for "
        f"{plain(round(week.days, 1))} days.",
        "Above: what the home cannot decide. Below: what each controller makes of it at the meter. "
        "The grey area is the buying price.",
    )


POWERS_WEEK = HomeFigure[HomeSubject](
    name="powers-week",
    section=PANELS,
    needs=lambda subject: subject,
    draw=lambda subject: powers_figure(subject.home, subject.week),
    words=_words,
)
