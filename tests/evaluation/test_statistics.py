"""Mean and interval over seeds: a printed quantile, its coverage, and what is missing stays missing."""

import math

import numpy as np
import pytest

from hemma.evaluation import summarise


def test_interval_by_hand():
    """t_{0.975, 4} = 2.776 stands in every table; s of 1..5 is sqrt(2.5)."""
    summary = summarise([1.0, 2.0, 3.0, 4.0, 5.0])
    assert summary.mean == 3.0
    assert summary.interval is not None
    half = 2.776445 * math.sqrt(2.5) / math.sqrt(5)
    assert (summary.interval.low, summary.interval.high) == pytest.approx((3 - half, 3 + half), abs=1e-5)


def test_five_seeds_cover_the_truth_in_95_of_100_cases():
    random = np.random.default_rng(0)
    intervals = [summarise(sample.tolist()).interval for sample in random.normal(7.0, 2.0, (4000, 5))]
    covered = np.mean([i is not None and i.low <= 7.0 <= i.high for i in intervals])
    assert covered == pytest.approx(0.95, abs=0.012)


def test_one_run_has_a_mean_and_no_interval():
    summary = summarise([4.2])
    assert summary.mean == 4.2
    assert summary.interval is None


@pytest.mark.parametrize("missing", [None, math.nan, math.inf])
def test_a_missing_run_is_not_averaged_away(missing):
    summary = summarise([1.0, missing, 2.0])
    assert summary.mean is None
    assert summary.interval is None


def test_equal_runs_have_an_interval_of_no_width():
    interval = summarise([2.5, 2.5, 2.5]).interval
    assert interval is not None
    assert interval.low == interval.high == 2.5
