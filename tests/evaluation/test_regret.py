"""Where the distance to perfect information comes from: three parts that add up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hemma.errors import HemmaError
from hemma.evaluation.regret import RegretSplit, regret, split_regret

REGRET = st.floats(-1e4, 1e6)


def numbers(split):
    return [split.total, *split.parts]


def test_regret_is_a_difference_so_that_an_optimum_near_zero_is_no_trouble():
    assert regret(31.5, 30.0) == 1.5
    assert regret(0.25, 0.0) == 0.25
    assert regret(-3.0, -5.0) == 2.0


def test_the_parts_by_hand():
    """The planner loses 2 to the future and 3 with the network; the controller loses 4.5."""
    assert split_regret(4.5, 3.0, 2.0) == RegretSplit(total=4.5, future=2.0, thermal_model=1.0, policy=1.5)


def test_a_planner_is_split_by_itself_and_has_no_part_of_a_policy():
    split = split_regret(3.0, 3.0, 2.0)
    assert split.policy == 0
    assert split.future + split.thermal_model == 3.0


def test_a_controller_better_than_the_planner_has_a_negative_part_of_the_policy():
    assert split_regret(2.5, 3.0, 2.0).policy == -0.5
    assert split_regret(2.5, 1.5, 2.0).thermal_model == -0.5


def test_perfect_information_through_the_true_model_loses_nothing():
    assert numbers(split_regret(0.0, 0.0, 0.0)) == [0.0, 0.0, 0.0, 0.0]


@given(REGRET, REGRET, REGRET)
def test_the_parts_add_up_to_the_total(controller, planner, true_model):
    split = split_regret(controller, planner, true_model)
    largest = max(abs(controller), abs(planner), abs(true_model))
    assert split.total == controller
    assert abs(split.total - split.future - split.thermal_model - split.policy) <= 1e-12 * largest


@given(st.lists(st.tuples(REGRET, REGRET, REGRET), min_size=1, max_size=5))
def test_the_split_of_the_means_is_the_mean_of_the_splits(regrets):
    together = split_regret(*(float(mean) for mean in np.mean(regrets, axis=0)))
    separate = np.mean([numbers(split_regret(*three)) for three in regrets], axis=0)
    np.testing.assert_allclose(numbers(together), separate, rtol=1e-9, atol=1e-9 * np.abs(regrets).max())


@pytest.mark.parametrize("wrong", [float("nan"), float("inf")])
@pytest.mark.parametrize("position", [0, 1, 2])
def test_a_missing_regret_is_refused(position, wrong):
    regrets = [3.0, 2.0, 1.0]
    regrets[position] = wrong
    with pytest.raises(HemmaError, match=r"finite regrets, got (nan|inf) of the .*; measure it again"):
        split_regret(*regrets)
