"""Made-up comparisons of methods for a made-up results folder."""

from itertools import combinations

import numpy as np

HINDSIGHT = ("MPC perfect", "HMPC", "HMPC joint", "DNLP", "optimum", "no battery")
MEASURES = ("share_of_savings", "gap_to_optimum", "mean_temperature_deviation", "regret")


def interquartile_mean(values: list) -> float | None:
    """Mean of the middle half; a quarter is rounded down."""
    if None in values:
        return None
    cut = len(values) // 4
    return float(np.mean(sorted(values)[cut : len(values) - cut]))


def improvements(methods: dict) -> list[dict]:
    """Each pair once, by regret."""
    return [_improvement(methods, first, second) for first, second in combinations(methods, 2)]


def regret_split(method: dict) -> dict:
    """Parts that add up; the policies of cheap methods save."""
    total = method["mean"]["regret"]
    return {"total": total, "future": 2.1, "thermal_model": 0.15, "policy": total - 2.25}


def pareto() -> list[dict]:
    """The frontier, a sweep of PPO's weight of comfort and one of HA-1's upper limit."""
    frontier = [_point("optimum", "total deviation budget", 744 * d, 28.4 - 6 * d**0.7, d) for d in (
        0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0)]  # fmt: skip
    ppo = [
        _point("PPO", "beta_T", b, 33 + 0.9 * np.log10(1 + 100 * b), 0.05 / b) for b in (0.02, 0.1, 0.3, 1.0)
    ]
    airl = [_point("HA-1", "upper comfort limit", t, 31.4 + 1.3 * (24 - t), 0.004 * np.exp(2 * (t - 24)))
        for t in (23.0, 23.5, 24.0, 24.5)]  # fmt: skip
    return [*frontier, *ppo, *airl]


def aggregate(homes: dict) -> dict:
    """All methods over all homes, with a made-up interval."""
    first = next(iter(homes.values()))["methods"]
    methods = {name: _over_homes([home["methods"][name] for home in homes.values()]) for name in first}
    return {
        "homes": list(homes),
        "methods": methods,
        "probability_of_improvement": improvements(first),
        "paired": [_paired(homes, *pair) for pair in combinations(first, 2)],
    }


def _paired(homes: dict, method: str, over: str) -> dict:
    differences = {
        name: home["methods"][method]["mean"]["share_of_savings"]
        - home["methods"][over]["mean"]["share_of_savings"]
        for name, home in homes.items()
    }
    mean = float(np.mean(list(differences.values())))
    return {
        "method": method, "over": over, "metric": "share_of_savings", "differences": differences,
        "mean": mean, "interval": [mean - 0.05, mean + 0.04],
    }  # fmt: skip


def _over_homes(methods: list[dict]) -> dict:
    found = {}
    for measure in MEASURES:
        values = [run[measure] for method in methods for run in method["runs"]]
        if None in values:
            found[measure] = {"mean": None, "interval": None, "interquartile_mean": None, "worst": None}
            continue
        mean = float(np.mean(values))
        spread = 0.1 * abs(mean)
        found[measure] = {
            "mean": mean,
            "interval": [mean - spread, mean + spread] if len(values) > len(methods) else None,
            "interval_over_homes": [mean - 2 * spread, mean + 2 * spread],
            "interquartile_mean": interquartile_mean(values),
            "worst": max(values),
        }
    return found


def _improvement(methods: dict, first: str, second: str) -> dict:
    mine, other = ([run["regret"] for run in methods[name]["runs"]] for name in (first, second))
    wins = [float(a < b) + 0.5 * float(a == b) for a in mine for b in other]
    chance = float(np.mean(wins))
    interval = [max(0.0, chance - 0.12), min(1.0, chance + 0.1)] if len(wins) > 1 else None
    return {"method": first, "over": second, "probability": chance, "interval": interval}


def _point(series: str, parameter: str, value: float, cost: float, deviation: float) -> dict:
    return {
        "series": series, "parameter": parameter, "value": float(value), "energy_cost": float(cost),
        "mean_temperature_deviation": float(deviation), "runs": 3,
    }  # fmt: skip
