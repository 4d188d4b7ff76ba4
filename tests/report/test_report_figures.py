"""What is drawn is what was computed, and drawing leaves no trace in the caller's Matplotlib."""

import os
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from synthetic_results import save_results, write_results

from hemma.evaluation import Intervals
from hemma.methods import METHODS
from hemma.report import write_report
from hemma.report.drawing.canvas import drawing_style, new_figure, save, single
from hemma.report.figures import FIGURES
from hemma.report.figures.figure import HomeFigure, ReportSection, Words
from hemma.report.figures.panels.demonstrations import draw_cost_by_length, draw_deviation_by_length
from hemma.report.figures.panels.methods import draw_costs, draw_deviations
from hemma.report.figures.panels.week import draw_battery_level, draw_indoor_temperature
from hemma.report.figures.training import thinned
from hemma.report.methods import look_of
from hemma.report.pictures import LIST_FILE
from hemma.report.series import SeriesReader
from hemma.report.subject import HomeSubject, read_subject
from hemma.results.records import DemonstrationRuns
from hemma.results.results import HomeResults, load_results

NAMES = (
    "results", "cost-by-demonstrations", "deviation-by-demonstrations", "energy-cost",
    "temperature-deviation", "indoor-temperature", "battery-level", "powers-week", "traces-week",
    "cost-and-comfort", "regret", "probability-of-improvement", "training-curves", "training-diagnostics",
    "free-run",
)  # fmt: skip


@pytest.fixture(scope="module")
def home(written) -> HomeResults:
    return load_results(written.folder).homes["austin2021-1"]


@pytest.fixture(scope="module")
def series(written, home) -> HomeSubject:
    return read_subject(SeriesReader(written.folder), "austin2021-1", home)


def _axes():
    return Figure().add_subplot()


def _line(axes, label):
    (line,) = [line for line in axes.get_lines() if line.get_label() == label]
    return line


def test_every_figure_is_written_as_png_and_svg(written):
    figures = written.folder / "figures"
    names = {f"{n}.{e}" for n in NAMES for e in ("png", "svg")}
    assert {path.name for path in figures.iterdir()} == names | {LIST_FILE}
    for name in NAMES:
        assert (figures / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "<svg" in (figures / f"{name}.svg").read_text(encoding="utf-8")


def test_the_same_numbers_give_the_same_bytes(tmp_path, home):
    for folder in (tmp_path / "one", tmp_path / "two"):
        with drawing_style():
            figure = new_figure(5.0, 4.0)
            draw_costs(figure.add_subplot(), home)
            save(figure, folder, "costs")
    for name in ("costs.svg", "costs.png"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_the_caller_finds_matplotlib_as_it_was(tmp_path):
    with mpl.rc_context({"font.size": 33.0, "svg.hashsalt": "mine"}):
        before = dict(mpl.rcParams)
        with drawing_style():
            assert mpl.rcParams["font.size"] != 33.0
            save(new_figure(1.0, 1.0), tmp_path, "empty")
        assert dict(mpl.rcParams) == before


def test_pyplot_is_never_imported():
    code = "import sys, hemma.report; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_panel_a_shows_the_means_by_length_and_the_references(written, home):
    axes = _axes()
    draw_cost_by_length(axes, home)
    entries = written.content["homes"]["austin2021-1"]["data_efficiency"]
    for method in ("AIRL", "GAIL", "BC"):
        expected = [entry["mean"]["energy_cost"] for entry in entries if entry["method"] == method]
        assert _line(axes, method).get_ydata() == pytest.approx(expected)
        assert _line(axes, method).get_xdata() == pytest.approx([1, 3, 7, 15, 30, 60], rel=0.1)
    assert set(_line(axes, "optimum").get_ydata()) == {28.4}
    assert set(_line(axes, "Rule").get_ydata()) == {44.6}


def test_panel_b_starts_at_zero_and_shows_totals(written, home):
    axes = _axes()
    draw_deviation_by_length(axes, home)
    entries = written.content["homes"]["austin2021-1"]["data_efficiency"]
    expected = [e["mean"]["total_temperature_deviation"] for e in entries if e["method"] == "AIRL"]
    assert _line(axes, "AIRL").get_ydata() == pytest.approx(expected)
    assert axes.get_ylim()[0] == 0.0


def test_without_a_study_the_two_lengths_of_the_paper_are_drawn(home):
    axes = _axes()
    draw_cost_by_length(axes, home.model_copy(update={"data_efficiency": ()}))
    means = [home.methods[name].mean.energy_cost for name in ("HA-1", "HA-2")]
    assert _line(axes, "AIRL").get_ydata() == pytest.approx(means)


def test_a_single_length_is_said_to_be_one(home):
    axes = _axes()
    points = tuple(point for point in home.data_efficiency if point.days == 15)
    draw_cost_by_length(axes, home.model_copy(update={"data_efficiency": points}))
    assert any("one length so far" in text.get_text() for text in axes.texts)


def test_no_length_at_all_is_said_too(home):
    axes = _axes()
    draw_cost_by_length(axes, home.model_copy(update={"data_efficiency": (), "demonstration_days": {}}))
    assert any("No runs" in text.get_text() for text in axes.texts)


def test_panel_c_has_a_bar_of_the_mean_for_each_method(home):
    axes = _axes()
    draw_costs(axes, home)
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert sorted(names) == sorted(home.methods)
    widths = [bar.get_width() for bar in axes.patches]
    assert widths == pytest.approx([home.methods[name].mean.energy_cost for name in names])


def test_panel_d_has_room_for_zero_and_for_the_largest(home):
    axes = _axes()
    draw_deviations(axes, home)
    low, high = axes.get_xlim()
    means = [method.mean.mean_temperature_deviation for method in home.methods.values()]
    assert low == 0.0
    assert high > max(means)
    drawn = [line.get_xdata()[0] for line in axes.get_lines() if len(line.get_xdata()) == 1]
    assert sorted(drawn) == pytest.approx(sorted(means))


def test_no_interval_of_a_deviation_is_drawn_below_zero(home):
    method = home.methods["GAIL"]
    wide = Intervals(mean_temperature_deviation=(-0.02, 0.06), total_temperature_deviation=(-15.0, 45.0))
    entry = method.model_copy(update={"interval": wide})
    axes = _axes()
    draw_deviations(axes, home.model_copy(update={"methods": {"GAIL": entry}}))
    assert [tuple(line.get_xdata()) for line in axes.get_lines() if len(line.get_xdata()) == 2] == [
        (0.0, 0.06)
    ]
    point = DemonstrationRuns(days=7, method="GAIL", **entry.model_dump())
    axes = _axes()
    draw_deviation_by_length(axes, home.model_copy(update={"data_efficiency": (point,)}))
    (whisker,) = [lines for lines in axes.collections if isinstance(lines, LineCollection)]
    assert [y for _, y in whisker.get_segments()[0]] == [0.0, 45.0]


def test_temperatures_stand_at_the_end_of_their_slots(home, series):
    axes = _axes()
    draw_indoor_temperature(axes, home, series.week)
    line = _line(axes, "Rule")
    assert len(line.get_xdata()) == 7 * 24
    assert line.get_xdata()[0] == np.datetime64("2021-08-01T01:00:00")
    assert line.get_ydata()[0] == series.week.schedules["Rule"].indoor_temperature[0]


def test_a_resting_battery_is_not_drawn(home, series):
    axes = _axes()
    draw_battery_level(axes, home, series.week)
    labels = {line.get_label() for line in axes.get_lines()}
    assert {"HA-1", "PPO", "optimum"} <= labels
    assert "Rule" not in labels


def test_the_run_of_median_cost_is_shown(home):
    method = home.methods["HA-1"]
    assert method.typical_run.energy_cost == sorted(run.energy_cost for run in method.runs)[1]


def test_no_two_methods_look_the_same():
    looks = [look_of(method.name) for method in METHODS]
    assert len({(look.colour, look.line) for look in looks}) == len(looks)


def test_a_stranger_looks_the_same_in_every_process():
    code = "from hemma.report.methods import look_of; print([look_of(f'my own {i}') for i in range(9)])"
    here = [look_of(f"my own {number}") for number in range(9)]
    other = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONHASHSEED": "7"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert other.stdout.strip() == str(here)
    assert len(set(here)) > 1


@pytest.mark.parametrize("rows", [1, 149, 150, 151, 1800])
def test_thinning_keeps_the_mean_of_what_it_joins(rows):
    values = np.arange(rows, dtype=float) ** 1.5
    short = thinned(values)
    size = -(-rows // 150)
    assert len(short) <= 150
    assert short[0] == pytest.approx(values[:size].mean())
    assert short[-1] == pytest.approx(values[(len(short) - 1) * size :].mean())


@pytest.mark.usefixtures("undrawn")
def test_several_homes_have_figures_each_under_its_own_safe_name(tmp_path):
    content = write_results(tmp_path, homes=("a b", "a_b"), seeds=1, methods=("Rule",))
    for entry in content["homes"].values():
        entry["data_efficiency"] = []
        del entry["identification"]
    save_results(tmp_path, content)
    page = write_report(tmp_path).read_text(encoding="utf-8")
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert {"results.png", "a_b-1-results.png", "a_b-2-results.png", "a_b-2-energy-cost.svg"} <= names
    assert page.index("The homes at a glance") < page.index("Results on a b") < page.index("Results on a_b")


@pytest.mark.usefixtures("undrawn")
def test_figures_of_an_earlier_larger_run_are_removed_and_nothing_else(small):
    folder, content = small
    write_report(folder)
    figures = folder / "figures"
    outside = folder / "outside.svg"
    strangers = (figures / "robustness.svg", figures / "mine.png", outside)
    for path in strangers:
        path.write_text("not of the report")
    with (figures / LIST_FILE).open("a") as file:
        file.write("../outside.svg\nnotes.txt\n")
    assert (figures / "regret.svg").is_file()
    del content["homes"]["home"]["regret"]
    save_results(folder, content)
    write_report(folder)
    assert not (figures / "regret.svg").exists()
    assert not (figures / "regret.png").exists()
    assert all(path.read_text() == "not of the report" for path in strangers)
    assert (figures / "energy-cost.svg").is_file()
    assert "regret.svg" not in (figures / LIST_FILE).read_text()


@pytest.mark.usefixtures("undrawn")
def test_a_made_up_figure_is_one_module_and_one_line(small, monkeypatch):
    def draw(home: HomeResults) -> Figure:
        return single(2.0, 1.0, lambda axes: axes.set_title(home.currency))

    made_up = HomeFigure[HomeResults](
        name="made-up",
        section=ReportSection("A section of its own"),
        needs=lambda subject: subject.home if "Rule" in subject.home.methods else None,
        draw=draw,
        words=lambda home: Words("Made up", f"Nothing of {len(home.methods)} methods.", "Seen, and said."),
        missing="Nothing is made up here.",
    )
    monkeypatch.setattr("hemma.report.figures.FIGURES", (*FIGURES, made_up))
    folder, content = small
    page = write_report(folder).read_text(encoding="utf-8")
    assert (folder / "figures/made-up.svg").is_file()
    assert (folder / "figures/made-up.png").is_file()
    for told in (
        "<h3>A section of its own</h3>",
        "Nothing of 3 methods.",
        "Made up.</strong> Seen, and said.",
    ):
        assert told in page
    del content["homes"]["home"]["methods"]["Rule"]
    save_results(folder, content)
    assert "Nothing is made up here." in write_report(folder).read_text(encoding="utf-8")
    assert not (folder / "figures/made-up.svg").exists()
