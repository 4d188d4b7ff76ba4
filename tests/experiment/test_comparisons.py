"""Method against method, and over homes: two homes with three seeds each, by hand."""

import json
import math

import pytest

from hemma.evaluation import summarise
from hemma.results import comparisons
from hemma.results.reading import json_content
from hemma.results.results import HomeResults

T_2_DEGREES = 4.302653
"""t_{0.975} with 2 degrees of freedom."""


def record(home):
    period = {"start": "2021-08-01T00:00:00-06:00", "slots": 24}
    said = {"currency": "$", "slot_length_h": 1.0, "comfort_c": [19.0, 24.0], "test": period}
    return HomeResults.model_validate({**said, **home})


def aggregate(entries):
    found = comparisons.aggregate({name: record(home) for name, home in entries.items()})
    return None if found is None else json_content(found)


def improvements(entries):
    return [json_content(found) for found in comparisons.improvements([record(home) for home in entries])]


def method(shares, seeds=True):
    """Runs whose other metrics follow from the share: gap 1 - share, regret ten times that."""
    runs = [
        {
            "seed": seed if seeds else None,
            "share_of_savings": share,
            "gap_to_optimum": 1 - share,
            "mean_temperature_deviation": share / 100,
            "regret": 10 * (1 - share),
        }
        for seed, share in enumerate(shares)
    ]
    return {"runs": runs, "mean": {}}


def homes():
    return {
        "a": {
            "methods": {
                "HA-1": method([0.9, 0.8, 0.7]),
                "PPO": method([0.6, 0.75, 0.6]),
                "Rule": method([0.0], seeds=False),
            }
        },
        "b": {
            "methods": {
                "HA-1": method([0.5, 0.4, 0.3]),
                "Rule": method([-0.2], seeds=False),
                "PPO": method([0.6, 0.6, 0.3]),
            }
        },
    }


def pair(entries, name, over):
    [found] = [entry for entry in entries if (entry["method"], entry["over"]) == (name, over)]
    return found


def test_improvements_of_one_home_by_hand():
    """0.9 and 0.8 beat all three of PPO, 0.7 beats two."""
    found = improvements([homes()["a"]])
    assert [(entry["method"], entry["over"]) for entry in found] == [
        ("HA-1", "PPO"),
        ("HA-1", "Rule"),
        ("PPO", "Rule"),
    ]
    assert pair(found, "HA-1", "PPO")["probability"] == pytest.approx(8 / 9)
    low, high = pair(found, "HA-1", "PPO")["interval"]
    assert 0.0 < low < 8 / 9 < high <= 1.0


def test_improvements_over_homes_are_the_mean_of_both():
    """On the second home 3 of 9 pairs are won, since 0.5, 0.4 and 0.3 meet 0.3 once: 1 + 1 + 1/2."""
    found = pair(aggregate(homes())["probability_of_improvement"], "HA-1", "PPO")
    assert found["probability"] == pytest.approx((8 / 9 + 2.5 / 9) / 2)


def test_means_worst_runs_and_interquartile_means_by_hand():
    found = aggregate(homes())["methods"]["HA-1"]
    assert found["share_of_savings"]["mean"] == pytest.approx(0.6)
    assert found["share_of_savings"]["worst"] == 0.3
    assert found["gap_to_optimum"]["worst"] == pytest.approx(0.7)
    assert found["mean_temperature_deviation"]["worst"] == pytest.approx(0.009)
    assert found["regret"]["mean"] == pytest.approx(4.0)
    assert found["regret"]["worst"] == pytest.approx(7.0)
    # Of 0.3, 0.4, 0.5, 0.7, 0.8, 0.9 the middle three: half of 0.4, 0.5, 0.7, half of 0.8.
    assert found["share_of_savings"]["interquartile_mean"] == pytest.approx((0.2 + 0.5 + 0.7 + 0.4) / 3)


def test_the_interval_over_seeds_is_narrow_and_that_over_homes_wide():
    """Both homes have s = 0.1: sqrt(2 * 0.01/3)/2 with 4 degrees of freedom, t = 2.776."""
    found = aggregate(homes())["methods"]["HA-1"]
    assert found["interval_kind"] == "student"
    low, high = found["share_of_savings"]["interval"]
    assert (high - low) / 2 == pytest.approx(2.776445 * math.sqrt(2 * 0.01 / 3) / 2, abs=1e-6)
    low, high = found["share_of_savings"]["interval_over_homes"]
    assert (high - low) / 2 == pytest.approx(12.7062 * 0.2, abs=1e-4)


def test_a_method_without_randomness_has_an_interval_over_homes_only():
    found = aggregate(homes())["methods"]["Rule"]
    assert found["share_of_savings"]["mean"] == pytest.approx(-0.1)
    assert found["share_of_savings"]["interval"] is None
    assert found["share_of_savings"]["interval_over_homes"] is not None
    assert found["interval_kind"] is None


def test_paired_differences_by_hand():
    """HA-1 less PPO: 0.8 - 0.65 and 0.4 - 0.5."""
    found = pair(aggregate(homes())["paired"], "HA-1", "PPO")
    assert found["differences"] == pytest.approx({"a": 0.15, "b": -0.1})
    assert found["mean"] == pytest.approx(0.025)
    interval = summarise([0.15, -0.1]).interval
    assert found["interval"] == pytest.approx([interval.low, interval.high])


def test_a_missing_value_is_not_left_out():
    broken = homes()
    broken["b"]["methods"]["PPO"]["runs"][1] |= {"share_of_savings": None, "regret": None}
    found = aggregate(broken)
    ppo = found["methods"]["PPO"]
    for metric in ("share_of_savings", "regret"):
        assert set(ppo[metric].values()) == {None}
    assert ppo["gap_to_optimum"]["mean"] is not None
    assert pair(found["probability_of_improvement"], "HA-1", "PPO")["probability"] is None
    difference = pair(found["paired"], "HA-1", "PPO")
    assert difference["differences"]["a"] == pytest.approx(0.15)
    assert difference["differences"]["b"] is difference["mean"] is difference["interval"] is None


def test_only_methods_of_all_homes_are_aggregated():
    some = homes()
    del some["b"]["methods"]["PPO"]
    assert list(aggregate(some)["methods"]) == ["HA-1", "Rule"]


def test_unfinished_homes_do_not_count():
    assert aggregate(homes() | {"c": {"methods": {}}})["homes"] == ["a", "b"]
    assert aggregate({"a": homes()["a"], "c": {"methods": {}}}) is None
    assert aggregate({"a": homes()["a"], "b": {"methods": {"DDPG": method([0.1])}}}) is None
    assert aggregate({}) is None


def test_it_is_plain_json():
    found = aggregate(homes())
    assert json.loads(json.dumps(found, allow_nan=False)) == found
