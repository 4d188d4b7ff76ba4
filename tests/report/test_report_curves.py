"""Learning curves: mean and range over seeds against the share of training, whatever columns a method has."""

import numpy as np
import pytest

from hemma.report.drawing.canvas import drawing_style, save
from hemma.report.figures.training import (
    COST,
    DEVIATION,
    TRAINING_CURVES,
    diagnostics_figure,
    diagnostics_of,
    learning_figure,
    spread_of,
)
from hemma.report.series import SeriesReader, TrainingCurve
from hemma.report.subject import HomeSubject, read_week
from hemma.results.results import load_results


def _curve(iterations: list[float], **quantities: list[float]) -> TrainingCurve:
    return TrainingCurve(np.array(iterations), {name: np.array(v, float) for name, v in quantities.items()})


def test_mean_and_range_over_seeds():
    runs = [_curve([25.0, 50.0], loss=[1.0, 2.0]), _curve([25.0, 50.0], loss=[3.0, 6.0])]
    spread = spread_of(runs, "loss")
    assert spread is not None
    assert spread.share.tolist() == [0.5, 1.0]
    assert spread.mean.tolist() == [2.0, 4.0]
    assert spread.low.tolist() == [1.0, 2.0]
    assert spread.high.tolist() == [3.0, 6.0]


def test_runs_of_other_lengths_meet_at_shares_of_training():
    runs = [
        _curve([50.0, 100.0], loss=[1.0, 2.0]),
        _curve([25.0, 50.0, 75.0, 100.0], loss=[9.0, 3.0, 9.0, 4.0]),
    ]
    spread = spread_of(runs, "loss")
    assert spread is not None
    assert spread.mean.tolist() == [2.0, 3.0]


def test_only_runs_that_have_a_quantity_count():
    assert spread_of([_curve([1.0], other=[1.0])], "loss") is None


def _subject(written, curves: dict) -> HomeSubject:
    home = load_results(written.folder).homes["austin2021-1"]
    week = read_week(SeriesReader(written.folder), "austin2021-1", home)
    return HomeSubject(home, week, curves, free_run=None)


def test_a_panel_for_each_method_and_both_quantities(written):
    curves = {
        name: [_curve([25.0, 50.0], **{COST: [2.0, 1.0], DEVIATION: [1.0, 0.0]})] for name in ("HA-1", "BC")
    }
    curves["PPO"] = [_curve([25.0, 50.0], **{COST: [3.0, 1.0]})]
    with drawing_style():
        figure = learning_figure(_subject(written, curves))
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.axison]
    assert titles == ["HA-1", "BC", "PPO", "HA-1", "BC"]


def test_curves_without_cost_and_deviation_have_no_learning_figure(written):
    assert TRAINING_CURVES.needs(_subject(written, {"BC": [_curve([1.0], loss=[1.0])]})) is None


def test_an_unknown_column_gets_a_panel_with_its_own_name():
    curves = {
        "BC": [_curve([25.0, 50.0], held_out_error=[2.0, 1.0], **{COST: [1.0, 1.0]})],
        "HA-1": [_curve([25.0, 50.0], discriminator_loss=[0.5, 0.6])],
    }
    assert [diagnostic.title for diagnostic in diagnostics_of(curves)] == [
        "Discriminator loss",
        "Held out error",
    ]
    figure = diagnostics_figure(curves)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["BC", "HA-1"]


def test_nothing_but_cost_and_deviation_needs_no_diagnostics():
    assert diagnostics_of({"PPO": [_curve([1.0], **{COST: [1.0]})]}) == []


@pytest.mark.parametrize("value", ["nan", "inf"])
def test_a_learner_that_lost_itself_is_still_drawn(written, tmp_path, value):
    (tmp_path / "curve.csv").write_text(f"iteration,{COST},{DEVIATION}\n25,1.0,{value}\n50,{value},0.1\n")
    subject = _subject(written, {"PPO": [SeriesReader(tmp_path).curve("curve.csv")]})
    save(learning_figure(subject), tmp_path, "learning")
