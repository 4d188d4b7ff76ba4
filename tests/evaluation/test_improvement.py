"""How probably one method does better: Mann and Whitney's U by hand, and an interval that can be trusted."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ndtri
from scipy.stats import mannwhitneyu

from hemma.evaluation import Pair, Sample, probability_of_improvement

RUNS = st.lists(st.integers(0, 9).map(float), min_size=1, max_size=8)


def pair(own, other, other_is_random=True):
    return Pair(Sample(tuple(own)), Sample(tuple(other), other_is_random))


def probability(own, other, tie=0.0):
    return probability_of_improvement([pair(own, other)], tie).probability


def test_wins_and_ties_by_hand():
    """1 beats all three; 3 beats 5, ties with 3 and loses to 2: 3 + 1.5 of 6."""
    assert probability([1.0, 3.0], [2.0, 3.0, 5.0]) == 4.5 / 6
    assert probability([1.0], [1.0]) == 0.5
    assert probability([2.0], [1.0]) == 0.0
    assert probability([-2.0], [1.0]) == 1.0


def test_what_is_closer_than_the_solver_can_tell_is_a_tie():
    assert probability([1.0], [1.0 + 1e-8]) == 1.0
    assert probability([1.0], [1.0 + 1e-8], tie=1e-6) == 0.5


@given(RUNS, RUNS)
def test_it_is_mann_and_whitneys_statistic(own, other):
    statistic = mannwhitneyu(other, own).statistic
    assert probability(own, other) == pytest.approx(statistic / (len(own) * len(other)))
    assert probability(other, own) == pytest.approx(1 - probability(own, other))


def test_over_homes_only_runs_of_the_same_home_meet():
    """The second home is ten times dearer for both; each method wins one home."""
    homes = [pair([1.0, 2.0], [3.0, 4.0]), pair([30.0, 40.0], [10.0, 20.0])]
    assert probability_of_improvement(homes).probability == 0.5
    assert probability_of_improvement(homes[:1]).probability == 1.0


def test_an_interval_by_hand():
    """All 5 runs beat a fixed opponent: 1 - theta = z sqrt(theta (1 - theta) / 5), so theta = 5/(5 + z^2)."""
    found = probability_of_improvement([pair([1.0, 2.0, 3.0, 4.0, 5.0], [9.0], other_is_random=False)])
    assert found.interval is not None
    assert found.interval.high == 1.0
    assert found.interval.low == pytest.approx(5 / (5 + 1.959964**2), abs=1e-6)


def test_winning_every_pair_of_five_runs_proves_little_and_on_six_homes_more():
    wins = pair([1.0, 2.0, 3.0, 4.0, 5.0], [6.0, 7.0, 8.0, 9.0, 10.0])
    one, six = (probability_of_improvement([wins] * homes).interval for homes in (1, 6))
    assert one is not None
    assert six is not None
    assert 0.6 < one.low < 0.7
    assert 0.9 < six.low < 0.95


@given(RUNS.filter(lambda runs: len(runs) > 1), RUNS.filter(lambda runs: len(runs) > 1))
def test_the_interval_holds_the_estimate_and_turns_with_the_pair(own, other):
    found = probability_of_improvement([pair(own, other)])
    turned = probability_of_improvement([pair(other, own)])
    assert found.interval is not None
    assert turned.interval is not None
    assert 0.0 <= found.interval.low <= found.probability <= found.interval.high <= 1.0
    assert found.interval.low == pytest.approx(1 - turned.interval.high, abs=1e-6)


def test_one_run_of_something_random_has_no_interval():
    assert probability_of_improvement([pair([1.0], [2.0, 3.0])]).interval is None
    assert probability_of_improvement([pair([1.0, 2.0], [3.0])]).interval is None
    fixed = Pair(Sample((1.0,), is_random=False), Sample((2.0,), is_random=False))
    assert probability_of_improvement([fixed]).interval is None
    assert probability_of_improvement([fixed]).probability == 1.0


@pytest.mark.parametrize("missing", [None, float("nan")])
def test_a_missing_run_is_not_left_out(missing):
    found = probability_of_improvement([pair([1.0, 2.0], [3.0, 4.0]), pair([1.0, missing], [3.0, 4.0])])
    assert found.probability is found.interval is None


@pytest.mark.parametrize("truth", [0.5, 0.75, 0.9, 0.98])
@pytest.mark.parametrize(("homes", "runs"), [(1, 5), (1, 10), (6, 3)])
def test_the_interval_covers_the_truth_also_where_it_is_near_one(truth, homes, runs):
    """A bootstrap of five runs against five covers 0.98 in 27 of 100 cases."""
    random = np.random.default_rng(5)
    lead = float(ndtri(truth)) * 2**0.5
    covered = []
    for _ in range(400):
        own, other = random.normal(0.0, 1.0, (2, homes, runs))
        pairs = [pair(a.tolist(), (b + lead).tolist()) for a, b in zip(own, other, strict=True)]
        interval = probability_of_improvement(pairs).interval
        assert interval is not None
        covered.append(interval.low <= truth <= interval.high)
    assert np.mean(covered) > 0.91
