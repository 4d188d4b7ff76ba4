"""The recommended controller: the simplest that cannot be told from the best, at equal comfort."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.evaluation import Outcome
from hemma.studies.recommendation.recommend import daily_costs, recommend

COMFORTABLE = {"Rule": 0.0, "thresholds": 0.0, "default": 0.0}


def costs(**methods):
    """By method, in the order of simplicity."""
    return {name: np.asarray(days, float) for name, days in methods.items()}


def test_the_best_is_recommended_where_every_day_shows_it():
    found = recommend(costs(Rule=[3, 3.2, 3], thresholds=[2, 2.1, 2], default=[1, 1, 1.1]), COMFORTABLE)
    assert (found.method, found.days) == ("default", 3)
    assert [one.method for one in found.judged] == ["Rule", "thresholds", "default"]


def test_a_simpler_one_is_recommended_that_cannot_be_told_from_the_best():
    found = recommend(costs(Rule=[3, 3, 3, 3], thresholds=[1, 2, 1, 2], default=[2, 1, 2, 0.9]), COMFORTABLE)
    assert found.method == "thresholds"
    excess = np.array([-1, 1, -1, 1.1])
    judged = {one.method: one for one in found.judged}["thresholds"]
    assert judged.excess == pytest.approx(np.mean(excess))
    assert judged.standard_error == pytest.approx(np.std(excess, ddof=1) / 2)


def test_your_rule_is_fine_where_nothing_beats_it():
    assert recommend(costs(Rule=[1, 1], thresholds=[1.5, 1], default=[1, 1]), COMFORTABLE).method == "Rule"


def test_of_one_day_the_cheapest_is_taken():
    assert recommend(costs(Rule=[2], default=[1]), COMFORTABLE).method == "default"


@settings(max_examples=50)
@given(seed=st.integers(0, 1000), shift=st.floats(-5, 5), scale=st.floats(0.1, 100))
def test_neither_the_currency_nor_a_standing_charge_changes_the_recommendation(seed, shift, scale):
    days = np.random.default_rng(seed).normal(1, 0.3, (3, 12))
    plain = dict(zip(COMFORTABLE, days, strict=True))
    other = {name: scale * (values + shift) for name, values in plain.items()}
    assert recommend(plain, COMFORTABLE).method == recommend(other, COMFORTABLE).method


def outcome(cost, deviation):
    """Slots of this cost and deviation; nothing else matters."""
    nothing = np.zeros(6)
    return Outcome(
        battery_power=nothing,
        hvac_power=nothing,
        battery_energy=nothing,
        indoor_temperature=nothing,
        grid_power=nothing,
        transaction=np.full(6, cost),
        ageing=nothing,
        temperature_deviation=np.full(6, deviation),
    )


def test_what_leaving_the_band_saved_is_taken_back():
    def optimum(deviation):
        return 10.0 - (deviation or 0.0)

    warm, held = outcome(1.0, 4 / 6), outcome(2.0, 0.0)
    np.testing.assert_allclose(daily_costs([warm], optimum, 3), [3 + 2, 3 + 2])
    np.testing.assert_allclose(daily_costs([warm, held], optimum, 3), [5.5, 5.5])


def test_of_the_same_cost_the_one_that_keeps_comfort_is_recommended():
    """Where nothing has a price a thermostat that lets the home drift is not as good as one that holds it."""
    free = costs(Rule=[0, 0, 0], thresholds=[0, 0, 0], default=[0, 0, 0])
    drifting = {"Rule": 0.45, "thresholds": 0.0, "default": 0.0}
    assert recommend(free, drifting).method == "thresholds"
    assert recommend(free, COMFORTABLE).method == "Rule"
    dear = costs(Rule=[2, 2, 2], thresholds=[2, 2, 2], default=[1, 1, 1])
    assert recommend(dear, drifting).method == "default"
