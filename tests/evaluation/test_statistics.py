"""Mean and interval over seeds and homes: by hand, their coverage, and what is missing stays missing."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import stdtrit
from scipy.stats import trim_mean

from hemma.evaluation import (
    IntervalKind,
    interquartile_mean,
    interval_kind,
    summarise,
    summarise_homes,
)

VALUE = st.floats(-1e6, 1e6)


def coverage(intervals, truth):
    return np.mean([i is not None and i.low <= truth <= i.high for i in intervals])


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
    assert coverage(intervals, 7.0) == pytest.approx(0.95, abs=0.012)


@pytest.mark.parametrize("runs", [10, 20])
def test_the_bootstrap_covers_the_truth_in_95_of_100_cases(runs):
    """The plain percentile interval of 10 normal runs does in 90 of 100."""
    random = np.random.default_rng(1)
    intervals = [summarise(sample.tolist()).interval for sample in random.normal(7.0, 2.0, (1000, runs))]
    assert coverage(intervals, 7.0) == pytest.approx(0.95, abs=0.02)


def test_the_bootstrap_leans_to_the_side_of_the_long_tail():
    runs = [1.0, 1.1, 1.2, 1.0, 1.1, 1.2, 1.0, 1.1, 1.2, 5.0]
    found = summarise(runs)
    assert found.interval is not None
    assert found.interval.high - found.mean > 1.5 * (found.mean - found.interval.low)


def test_the_kind_of_interval_changes_at_ten_runs():
    assert interval_kind([1]) is interval_kind([]) is interval_kind([5, 1]) is None
    assert interval_kind([9]) is IntervalKind.STUDENT
    assert interval_kind([10]) is IntervalKind.BOOTSTRAP
    assert interval_kind([5, 5]) is IntervalKind.STUDENT
    assert interval_kind([5, 5, 5]) is IntervalKind.BOOTSTRAP


def test_the_same_runs_give_the_same_interval():
    runs = np.random.default_rng(2).normal(0, 1, 12).tolist()
    assert summarise(runs) == summarise(runs)


def test_two_homes_by_hand():
    """Means 2 and 20; s^2/n is 1/3 and 100/3; Welch and Satterthwaite give (101/3)^2 / ((1 + 10^4)/18)."""
    found = summarise_homes([[1.0, 2.0, 3.0], [10.0, 20.0, 30.0]])
    assert found.mean == 11.0
    freedom = (101 / 3) ** 2 / ((1 / 9 + 10000 / 9) / 2)
    assert freedom == pytest.approx(2.0400, abs=1e-4)
    assert found.interval is not None
    half = found.interval.high - 11.0
    assert half == pytest.approx(11.0 - found.interval.low)
    assert half == pytest.approx(stdtrit(freedom, 0.975) * math.sqrt(101 / 3 / 4))


def test_every_home_counts_the_same_however_many_runs_it_has():
    found = summarise_homes([[0.0] * 9, [4.0]])
    assert found.mean == 2.0
    assert found.interquartile_mean == pytest.approx(2.0)


@pytest.mark.parametrize(("homes", "runs"), [(2, 3), (6, 2), (6, 3), (6, 5)])
def test_homes_of_unequal_spread_cover_the_truth(homes, runs):
    """Never far below 95 of 100, by Student's t or by bootstrap."""
    random = np.random.default_rng(4)
    spread = np.linspace(0.2, 2.0, homes)[:, None]
    samples = random.normal(0.0, 1.0, (1000, homes, runs)) * spread
    intervals = [summarise_homes(sample.tolist()).interval for sample in samples]
    assert 0.93 <= coverage(intervals, 0.0) <= 0.985


def test_interquartile_mean_by_hand():
    assert interquartile_mean([4.0, 100.0, 2.0, -50.0]) == 3.0
    assert interquartile_mean([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 80.0]) == pytest.approx(4.5)
    # Half of five runs are 2.5: 3/4 + 1 + 3/4.
    assert interquartile_mean([0.0, 1.0, 3.0, 4.0, 99.0]) == pytest.approx((0.75 + 3.0 + 3.0) / 2.5)
    assert interquartile_mean([1.0, 2.0, 6.0]) == pytest.approx((0.25 * 1 + 2.0 + 0.25 * 6) / 1.5)
    assert interquartile_mean([1.0, 2.0]) == 1.5
    assert interquartile_mean([7.0]) == 7.0
    assert interquartile_mean([1.0, None]) is None


@given(st.lists(VALUE, min_size=1, max_size=20))
def test_interquartile_mean_is_scipys_trimmed_mean_where_both_are_defined(values):
    """Repeated four times, the middle half has whole runs only."""
    assert interquartile_mean(values * 4) == pytest.approx(trim_mean(values * 4, 0.25), rel=1e-9, abs=1e-6)
    assert interquartile_mean(values) == pytest.approx(trim_mean(values * 4, 0.25), rel=1e-9, abs=1e-6)


def test_one_run_has_a_mean_and_no_interval():
    summary = summarise([4.2])
    assert summary.mean == 4.2
    assert summary.interval is None


@pytest.mark.parametrize("missing", [None, math.nan, math.inf])
def test_a_missing_run_is_not_averaged_away(missing):
    summary = summarise([1.0, missing, 2.0])
    assert summary.mean is None
    assert summary.interval is None
    assert summary.interquartile_mean is None
    assert summarise_homes([[1.0, 2.0], [1.0, missing]]) == summary


def test_equal_runs_have_an_interval_of_no_width():
    for runs in (3, 12):
        interval = summarise([2.5] * runs).interval
        assert interval is not None
        assert interval.low == interval.high == 2.5
