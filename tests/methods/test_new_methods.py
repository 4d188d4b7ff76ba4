"""A new method is a file and a line: then it stands in table, report, robustness and recommendation."""

from dataclasses import replace

import pytest
from made_up import CLOCKWORK, WIDE

import hemma.methods
from hemma.experiment.run import Stage, run
from hemma.methods import METHODS, controls, learned, learners, method_of
from hemma.report.methods import grouped, look_of, meaning_of
from hemma.results.results import load_results
from hemma.studies.robustness.faults import faults
from hemma.studies.robustness.run import run_faults
from tiny_experiment import tiny_experiment, tiny_job


@pytest.fixture(autouse=True)
def _one_line(monkeypatch):
    monkeypatch.setattr(hemma.methods, "METHODS", (*METHODS, CLOCKWORK, WIDE))


def test_the_line_makes_them_known():
    assert CLOCKWORK in controls()
    assert WIDE in learned(replace(tiny_experiment(), learned=None))
    assert method_of("wide cloning published").observation_model.published
    assert "wide cloning causal" in learners()
    assert grouped(["clockwork", "Rule", "wide cloning"]) == {
        "Learned from demonstrations": ["wide cloning"],
        "Fixed rules": ["Rule", "clockwork"],
    }
    assert meaning_of("clockwork") == CLOCKWORK.meaning
    assert look_of("clockwork") == look_of("clockwork")
    assert look_of("clockwork") != look_of("Rule")


@pytest.mark.slow
def test_they_stand_in_table_report_robustness_and_recommendation(tmp_path, monkeypatch):
    experiment = replace(
        tiny_experiment(),
        learned=("wide cloning",),
        demonstration_days=1,
        data_efficiency=replace(tiny_experiment().data_efficiency, days=()),
    )
    job = tiny_job(tmp_path, experiment)
    run(job, Stage.REPORT)
    home = load_results(tmp_path).homes["austin2021-2"]
    assert {"clockwork", "wide cloning"} <= set(home.methods)
    assert {"clockwork", "wide cloning"} <= {one.method for one in home.recommendation.judged}
    assert {"clockwork", "wide cloning"} <= set(home.regret)
    page = (tmp_path / "report.html").read_text()
    assert CLOCKWORK.meaning in page
    assert WIDE.meaning in page
    monkeypatch.setattr("hemma.studies.robustness.trial.faults", lambda settings: faults(settings)[:1])
    met = run_faults(job).homes["austin2021-2"].faults[0].methods
    assert {"clockwork", "wide cloning"} <= set(met)
