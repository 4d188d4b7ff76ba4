"""Panel (f): what a few controllers did with the battery."""

from matplotlib.axes import Axes

from hemma.report.drawing.canvas import FULL_WIDTH, single
from hemma.report.drawing.over_time import draw_line, finish_week
from hemma.report.figures.figure import PANELS, HomeFigure, Words, listed
from hemma.report.numbers import plain
from hemma.report.subject import HomeSubject
from hemma.report.week import Week, battery_rests
from hemma.results.results import HomeResults


def draw_battery_level(axes: Axes, home: HomeResults, week: Week) -> None:
    """Battery energy at the end of each slot and the price; resting batteries are left out."""
    axes.set_title("(f) Battery level")
    for method, schedule in week.selected.items():
        if not battery_rests(schedule):
            draw_line(axes, method, week.posts[1:], schedule.battery_energy)
    axes.set_ylabel("Battery energy (kWh)")
    axes.margins(y=0.06)
    axes.set_ylim(bottom=0.0)
    finish_week(axes, home, week)


def _words(subject: HomeSubject) -> Words:
    week = subject.week
    return Words(
        "(f) Battery level",
        f"Battery energy of {listed(week.selected)} over {plain(round(week.days, 1))} days, with the buying "
        "price.",
        "Good control fills the battery where the grey price is low and empties it where it is high. "
        "Batteries that rest are left out.",
    )


BATTERY_LEVEL = HomeFigure[HomeSubject](
    name="battery-level",
    section=PANELS,
    needs=lambda subject: subject,
    draw=lambda it: single(FULL_WIDTH, 2.9, lambda axes: draw_battery_level(axes, it.home, it.week)),
    words=_words,
)
