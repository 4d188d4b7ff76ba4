"""Figures that compare methods show the numbers of the folder, and their texts do not hide each other."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from synthetic_results import save_results, write_results

from hemma.evaluation import RegretSplit
from hemma.report import write_report
from hemma.report.drawing.canvas import drawing_style, new_figure
from hemma.report.drawing.labels import Label, place_labels
from hemma.report.drawing.rows import method_rows
from hemma.report.figures.cost_and_comfort import pareto_figure, sweeps_of
from hemma.report.figures.probability_of_improvement import comparison_of, improvement_figure
from hemma.report.figures.regret import regret_figure
from hemma.report.figures.share_of_savings import homes_figure
from hemma.report.tables.aggregate import differences_of, worst_over_homes
from hemma.report.tables.cells import Cell
from hemma.results.findings import ImprovementRecord, PairedDifference, ParetoPoint
from hemma.results.results import HomeResults, Results, load_results

REGRET_BARS = 3


@pytest.fixture(scope="module")
def home(written) -> HomeResults:
    return load_results(written.folder).homes["austin2021-1"]


@pytest.fixture(scope="module")
def two_homes(tmp_path_factory) -> Results:
    folder = tmp_path_factory.mktemp("two")
    write_results(folder, homes=("north", "southern"), seeds=2, methods=("HA-1", "PPO", "Rule"))
    return load_results(folder)


def _drawn(figure: Figure) -> list[tuple[float, float]]:
    return [
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for axes in figure.axes
        for line in axes.get_lines()
        if len(line.get_xdata()) == 1
    ]


def test_every_method_and_every_swept_point_stands_in_the_trade_off(home):
    with drawing_style():
        figure = pareto_figure(home)
    for method in home.methods.values():
        assert (method.mean.mean_temperature_deviation, method.mean.energy_cost) in _drawn(figure)
    lines = [np.asarray(line.get_xydata()) for line in figure.axes[0].get_lines()]
    for sweep in sweeps_of(home):
        assert any(line.shape == sweep.track.shape and np.allclose(line, sweep.track) for line in lines)


def test_the_frontier_comes_first_and_in_the_order_of_comfort(home):
    frontier, *others = sweeps_of(home)
    assert frontier.name == "optimum"
    assert np.all(np.diff(frontier.track[:, 0]) > 0)
    assert [sweep.name for sweep in others] == ["PPO", "HA-1"]
    assert [point.value for point in others[0].points] == [0.02, 0.1, 0.3, 1.0]


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_names_do_not_lie_on_each_other_or_outside_and_no_line_leads_across_them(seed):
    spots = np.random.default_rng(seed).uniform(0.3, 0.6, (20, 2))
    with drawing_style():
        figure = new_figure(9.2, 5.6)
        axes = figure.add_subplot()
        axes.set_xlim(0, 1)
        axes.set_ylim(0, 1)
        place_labels(axes, [Label(f"method {i}", *spot) for i, spot in enumerate(spots)], [spots])
        figure.draw_without_rendering()
        boxes = [Text.get_window_extent(text) for text in axes.texts]  # without the leader
    assert len(boxes) > 15
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    frame = axes.get_window_extent()
    assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in boxes)
    leaders = [text.arrow_patch for text in axes.texts if text.arrow_patch is not None]
    assert leaders
    for leader in leaders:
        path = leader.get_path().transformed(leader.get_transform())
        assert not any(path.intersects_bbox(box.padded(-1.0), filled=False) for box in boxes)


def test_a_swept_weight_is_a_letter_with_a_subscript_and_a_name_is_never_a_formula(home):
    point = {"value": 1.0, "energy_cost": 1.0, "mean_temperature_deviation": 0.0}
    swept = [ParetoPoint(series=r"$\frac{$", parameter="beta_T", **point | {"value": v}) for v in (1.0, 2.0)]
    assert sweeps_of(home.model_copy(update={"pareto": swept}))[0].legend == (
        r"\$\frac{\$, $\beta_T$ from 1 to 2"
    )
    with drawing_style():
        figure = pareto_figure(home.model_copy(update={"pareto": swept}))
        figure.draw_without_rendering()
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert any(r"$\beta_T$ 1" in text for text in texts)
    assert not any("β_T" in text for text in texts)


def test_an_open_pair_is_pale_and_a_decided_one_is_not():
    decided, unsure = (
        ImprovementRecord(method="HA-1", over=over, probability=1.0, interval=interval)
        for over, interval in (("PPO", (0.6, 1.0)), ("BC", (0.4, 1.0)))
    )
    axes = improvement_figure(comparison_of([decided, unsure], {"HA-1", "PPO", "BC"})).axes[0]
    colours = {
        patch.get_xy(): patch.get_facecolor() for patch in axes.patches if isinstance(patch, Rectangle)
    }
    columns = {label.get_text(): place for place, label in enumerate(axes.get_xticklabels())}
    strong, pale = (colours[columns[over] - 0.5, -0.5] for over in ("PPO", "BC"))
    assert strong[0] < 0.6  # much less red than blue
    assert min(pale[:3]) > 0.85


def test_points_on_each_other_share_a_label():
    with drawing_style():
        axes = new_figure(5.0, 4.0).add_subplot()
        place_labels(axes, [Label("A", 0.5, 0.5), Label("B", 0.9, 0.9), Label("C", 0.5, 0.5)], [])
    assert sorted(text.get_text() for text in axes.texts) == ["A, C", "B"]


def test_stacked_parts_end_where_positive_and_negative_parts_add_up_to(home):
    split = RegretSplit(total=1.5, future=2.0, thermal_model=-0.2, policy=-0.3)
    axes = regret_figure(home.model_copy(update={"regret": {"HA-1": split}})).axes[0]
    bars = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
    ends = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars)
    assert len(bars) == REGRET_BARS
    assert np.allclose(ends, [(-0.2, -0.5), (0.0, -0.2), (0.0, 2.0)])
    assert (1.5, 0.0) in [
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for line in axes.get_lines()
        if line.get_marker() == "D"
    ]


def test_a_regret_that_was_not_split_is_drawn_whole(home):
    axes = regret_figure(home.model_copy(update={"regret": {"HA-1": RegretSplit(total=1.5)}})).axes[0]
    assert [bar.get_width() for bar in axes.patches] == [1.5]


def test_a_pair_given_one_way_is_turned_around():
    given = ImprovementRecord(method="PPO", over="HA-1", probability=0.2, interval=(0.1, 0.4))
    comparison = comparison_of([given], {"HA-1", "PPO"})
    turned = comparison.pairs["HA-1", "PPO"]
    assert comparison.methods == ("HA-1", "PPO")
    assert turned.probability == pytest.approx(0.8)
    assert turned.interval == pytest.approx((0.6, 0.9))


def test_only_the_methods_asked_for_are_compared():
    pairs = [ImprovementRecord(method="HA-1", over=other, probability=0.9) for other in ("PPO", "Rule")]
    assert comparison_of(pairs, {"HA-1", "PPO"}).methods == ("HA-1", "PPO")
    assert comparison_of(pairs, {"PPO", "Rule"}).methods == ()


def test_the_table_of_probabilities_reads_row_over_column():
    comparison = comparison_of(
        [ImprovementRecord(method="HA-1", over="PPO", probability=0.93)], {"HA-1", "PPO"}
    )
    axes = improvement_figure(comparison).axes[0]
    told = {text.get_position(): text.get_text() for text in axes.texts}
    assert told == {(1, 0): "0.93", (0, 1): "0.07"}


def test_a_mark_for_every_home_and_the_mean_of_all(two_homes):
    figure = homes_figure(two_homes)
    shares = [x for x, _ in _drawn(figure)]
    for home in two_homes.homes.values():
        for method in home.methods.values():
            assert method.mean.share_of_savings in shares
    assert two_homes.aggregate is not None
    for method in two_homes.aggregate.methods.values():
        assert method.share_of_savings.mean in shares


def test_shares_far_below_zero_are_written(two_homes):
    rule = two_homes.homes["north"].methods["Rule"]
    low = rule.model_copy(update={"mean": rule.mean.model_copy(update={"share_of_savings": -3.053})})
    home = two_homes.homes["north"]
    home = home.model_copy(update={"methods": {**home.methods, "Rule": low}})
    results = two_homes.model_copy(update={"homes": {"north": home, "south": two_homes.homes["southern"]}})
    axes = homes_figure(results).axes[0]
    assert any("◂ −305.3" in text.get_text() for text in axes.texts)
    assert axes.get_xlim()[0] > -1.0


def test_the_worst_run_over_homes_is_found_with_its_home_and_seed(two_homes):
    runs = {
        (n, r.seed): r.share_of_savings for n, h in two_homes.homes.items() for r in h.methods["PPO"].runs
    }
    home, seed = min(runs, key=lambda key: runs[key])
    worst = worst_over_homes(two_homes, "PPO")
    assert worst == Cell(f"{100 * runs[home, seed]:.1f}\u00a0%", f"{home}, seed {seed}")
    assert worst_over_homes(two_homes, "DNLP").value == "–"


def test_the_main_method_against_the_others_home_by_home():
    share = {"method": "PPO", "metric": "share_of_savings"}
    pairs = [
        PairedDifference(
            over="HA-1", mean=-0.2, interval=(-0.3, -0.1), differences={"a": -0.3, "b": 0.1}, **share
        ),
        PairedDifference(over="Rule", mean=0.5, **share),
    ]
    found = differences_of("HA-1", pairs)
    assert list(found) == ["PPO"]
    assert found["PPO"].mean == 0.2
    assert found["PPO"].interval == (0.1, 0.3)
    assert found["PPO"].differences == {"a": 0.3, "b": -0.1}


@pytest.mark.usefixtures("undrawn")
def test_several_homes_begin_with_all_methods_over_homes(tmp_path):
    content = write_results(tmp_path, homes=("a", "bb"), seeds=2, methods=("HA-1", "PPO", "Rule"))
    page = write_report(tmp_path).read_text(encoding="utf-8")
    mean = content["aggregate"]["methods"]["HA-1"]["share_of_savings"]["mean"]
    assert page.index("Every method over 2 homes") < page.index("The homes at a glance")
    assert f"{100 * mean:.1f}\u00a0%" in page
    assert "HA-1 against the others, home by home" in page
    assert "2 of 2 homes" in page
    assert "leaves out all that they share: weather, prices, building" in page
    assert "other homes" not in page
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert {"homes-share-of-savings.svg", "homes-probability-of-improvement.png"} <= names
    del content["aggregate"]
    save_results(tmp_path, content)
    assert "No statistics over homes in this folder." in write_report(tmp_path).read_text(encoding="utf-8")


def test_rows_are_grouped_once_there_are_many(home):
    few, many = method_rows(("HA-1", "Rule", "optimum")), method_rows(home.methods)
    assert not few.titles
    assert next(iter(many.titles)) == "Learned from demonstrations"
    taken = [*many.places.values(), *many.titles.values()]
    assert sorted(taken) == list(range(len(home.methods) + len(many.titles)))
