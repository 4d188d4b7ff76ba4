"""Perfect information that knows what will disturb the building."""

import numpy as np
import pytest

from hemma.control.comfort import ComfortHold
from hemma.control.safety import SafetyLayer
from hemma.evaluation.replay import outcome_of
from hemma.home import benchmark_home, replay_in_double
from hemma.optimisation.optimum import optimum_problem
from small_worlds import noisy

HOME = benchmark_home()


def kicks(slots, seed, deviation=0.5):
    return deviation * np.random.default_rng(seed).normal(size=slots)


def test_the_idle_path_is_the_one_written_out_by_hand():
    world, epsilon = noisy(2, seed=1), kicks(48, 2)
    response = optimum_problem(HOME, world, disturbances=epsilon).response
    temperature = 23.0
    for slot in range(48):
        temperature = 0.7 * temperature + 0.3 * world.outdoor_temperature[slot] + epsilon[slot]
        assert response.free[slot, 0] == pytest.approx(temperature, abs=1e-9)


def test_without_disturbances_it_is_the_problem_it_was():
    world = noisy(3, seed=3)
    plain, zero = optimum_problem(HOME, world), optimum_problem(HOME, world, disturbances=np.zeros(72))
    assert zero.least_deviation == plain.least_deviation
    assert zero.solve().cost == pytest.approx(plain.solve().cost, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_no_controller_beats_it_in_the_disturbed_home(seed):
    world, epsilon = noisy(3, seed), kicks(72, seed + 10)
    problem = optimum_problem(HOME, world, disturbances=epsilon)
    guarded = SafetyLayer(ComfortHold(HOME), HOME)
    outcome = outcome_of(replay_in_double(HOME, world, guarded, disturbances=epsilon).steps)
    assert outcome.total_deviation >= problem.least_deviation - 1e-6
    for battery in (True, False):
        best = problem.solve(outcome.total_deviation, battery=battery)
        assert best.deviation <= outcome.total_deviation + 1e-5
        assert best.cost <= np.sum(outcome.cost) + 1e-6
