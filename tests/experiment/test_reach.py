"""A home in which nobody could be comfortable is told so before any work, with the cause."""

from dataclasses import replace

import numpy as np
import pytest

from hemma.home import Hvac
from hemma.stages.case import make_case
from hemma.stages.reach import unreachable
from tiny_experiment import tiny_job


def case_of(tmp_path, outdoor=None, **home):
    job = tiny_job(tmp_path)
    [traces] = job.homes
    if outdoor is not None:
        exogenous = traces.exogenous
        shifted = np.asarray(exogenous.outdoor_temperature) * 0 + outdoor
        traces = replace(traces, exogenous=replace(exogenous, outdoor_temperature=shifted))
    return make_case(replace(job.experiment, **home), traces, job.test_from)


def test_the_usual_home_is_in_reach(tmp_path):
    assert unreachable(case_of(tmp_path)) == []


@pytest.mark.parametrize(
    ("outdoor", "hvac", "cause"),
    [
        (2.0, Hvac(), "only cools and it is 2.0 °C outside on average: set hvac.heats to yes"),
        (35.0, Hvac(heats=True), "only heats and it is 35.0 °C outside on average: set hvac.heats to no"),
        (38.0, Hvac(max_power=0.1), "may be too weak (0.1 kW)"),
    ],
)
def test_the_cause_is_told_for_both_periods(tmp_path, outdoor, hvac, cause):
    told = unreachable(case_of(tmp_path, outdoor, hvac=hvac))
    assert [period in said for period, said in zip(("training", "test"), told, strict=True)] == [True, True]
    assert all(cause in said and "out of reach" in said for said in told)
