"""The default controller: its forecast is chosen on training days that the forecast had not seen."""

from dataclasses import replace

import pytest

from hemma.errors import HemmaError
from hemma.results.store import Store
from hemma.settings.experiment import DefaultController
from hemma.stages.case import make_case
from hemma.stages.default import preferred
from hemma.stages.folds import training_folds
from tiny_experiment import Watching, tiny_job


@pytest.fixture
def case(tmp_path):
    job = tiny_job(tmp_path)
    return make_case(job.experiment, job.homes[0], job.test_from)


def test_the_folds_are_the_last_days_each_with_all_days_before_it(case):
    first, second = training_folds(case)
    assert (first.past.slots, first.period.slots) == (72, 24)
    assert (second.past.slots, second.period.slots) == (96, 24)
    assert first.period.load.tolist() == case.training.load[72:96].tolist()
    assert second.past.load.tolist() == case.training.load[:96].tolist()


def test_a_training_period_too_short_for_the_folds_has_none(case):
    many = replace(case.experiment, default=DefaultController(folds=3))
    assert list(training_folds(replace(case, experiment=many))) == []


def test_a_later_forecast_must_be_clearly_better():
    assert preferred({"a": 1.0, "b": 0.85}, margin=0.2) == "a"
    assert preferred({"a": 1.0, "b": 0.75}, margin=0.2) == "b"
    assert preferred({"a": 1.0, "b": 0.75, "c": 0.7}, margin=0.2) == "b"
    assert preferred({"a": 0.0, "b": 0.0}, margin=0.2) == "a"
    assert preferred({"a": 1e-9, "b": -1e-9}, margin=0.2) == "b"


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        ({"judged": 1.0}, "judged < 1"),
        ({"folds": 0}, "folds >= 1"),
        ({"margin": 1.0}, "margin < 1"),
        ({"refitted": 0}, "refitted >= 1"),
        ({"published_at": 25.0}, "from 0 to 24"),
    ],
)
def test_settings_without_meaning_are_refused(wrong, expected):
    with pytest.raises(HemmaError, match=expected):
        DefaultController(**wrong)


def test_what_was_chosen_and_what_is_recommended_stand_in_the_folder(finished):
    folder, content = finished
    card = Store(folder, "austin2021-2", Watching()).folder / "models/austin2021-2/default.json"
    assert '"chosen": "five places"' in card.read_text()  # two days of examples are too few for the others
    found = content["homes"]["austin2021-2"]["recommendation"]
    assert found["days"] == 2
    assert [one["method"] for one in found["judged"]] == [
        "Rule",
        "no battery",
        "thresholds",
        "MPC forecast",
        "default",
        "HA-1",
    ]
    by_method = {one["method"]: one for one in found["judged"]}
    assert min(one["excess"] for one in found["judged"]) == 0
    assert by_method[found["method"]]["excess"] <= by_method[found["method"]]["standard_error"]
    assert by_method["default"]["daily_cost"] == pytest.approx(
        by_method["MPC forecast"]["daily_cost"], rel=0.05
    )
