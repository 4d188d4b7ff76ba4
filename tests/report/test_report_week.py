"""The chosen week of the test period: the right slots, and a clear word where there is none."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from synthetic_results import save_results

from hemma.errors import HemmaError
from hemma.report import write_report
from hemma.report.drawing.canvas import drawing_style
from hemma.report.figures.panels.week import draw_indoor_temperature
from hemma.report.figures.traces_week import traces_figure
from hemma.report.series import SeriesReader
from hemma.report.subject import Week, read_week
from hemma.results.results import HomeResults, load_results

NAME = "austin2021-1"


@pytest.fixture(scope="module")
def home(written) -> HomeResults:
    return load_results(written.folder).homes[NAME]


def _week(written, home: HomeResults, number: int) -> Week:
    return read_week(SeriesReader(written.folder), NAME, home, number)


@pytest.mark.parametrize(("number", "first", "slots"), [(1, 0, 168), (3, 336, 168), (5, 672, 72)])
def test_a_week_holds_its_own_slots(written, home, number, first, slots):
    week = _week(written, home, number)
    path = home.methods["PPO"].typical_run.schedule
    whole = SeriesReader(written.folder).schedule(path, home.test.slots)
    for mine, all_of_it in (
        (week.schedules["PPO"].indoor_temperature, whole.indoor_temperature),
        (week.schedules["PPO"].battery_energy, whole.battery_energy),
    ):
        assert mine.tolist() == all_of_it[first : first + slots].tolist()
    start = np.datetime64("2021-08-01") + np.timedelta64(first, "h")
    assert week.posts[0] == start
    assert week.posts[-1] == start + np.timedelta64(slots, "h")
    assert len(week.posts) == slots + 1
    assert week.days == slots / 24


@pytest.mark.parametrize("number", [0, -1, 6])
def test_a_week_beyond_the_period_is_refused(written, number):
    with pytest.raises(HemmaError, match=rf"Week {number} .*expected 1 to 5.*{NAME} has 31 days"):
        write_report(written.folder, week=number)


def test_slots_of_another_length_make_the_same_week(written, home):
    quarter = home.model_copy(update={"slot_length_h": 0.5})
    week = _week(written, quarter, 2)
    first = SeriesReader(written.folder).exogenous(NAME, home.test.slots).buying_price[336:672]
    assert week.exogenous.buying_price.tolist() == first.tolist()


def test_the_time_panels_show_the_chosen_week(written, home):
    week = _week(written, home, 2)
    axes = Figure().add_subplot()
    draw_indoor_temperature(axes, home, week)
    (line,) = [line for line in axes.get_lines() if line.get_label() == "PPO"]
    assert line.get_xdata()[0] == np.datetime64("2021-08-08T01:00:00")
    assert line.get_ydata()[0] == week.schedules["PPO"].indoor_temperature[0]


def test_every_method_has_its_two_small_panels(written, home):
    week = _week(written, home, 1)
    with drawing_style():
        panels = traces_figure(home, week).axes
    assert len(panels) == 2 * len(home.methods)
    assert [axes.get_title(loc="left") for axes in panels[::2]] == list(week.schedules)
    for above, below, schedule in zip(panels[::2], panels[1::2], week.schedules.values(), strict=True):
        assert above.get_lines()[0].get_ydata() == pytest.approx(schedule.indoor_temperature)
        assert below.get_lines()[0].get_ydata() == pytest.approx(schedule.battery_energy)
    assert len({axes.get_ylim() for axes in panels[::2]}) == 1


@pytest.mark.usefixtures("undrawn")
def test_the_report_says_which_week_it_shows(small):
    folder, _ = small
    page = write_report(folder, week=3).read_text(encoding="utf-8")
    assert "What every method does in week 3 of the test period" in page


@pytest.mark.usefixtures("undrawn")
def test_without_any_schedule_there_are_no_traces(small):
    folder, content = small
    for method in content["homes"]["home"]["methods"].values():
        for run in method["runs"]:
            run["schedule"] = None
    save_results(folder, content)
    assert "No schedule in this folder." in write_report(folder).read_text(encoding="utf-8")
    assert not (folder / "figures/traces-week.png").exists()
