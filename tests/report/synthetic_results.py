"""A made-up results folder with numbers of a believable size: nothing in it was measured."""

import csv
import json
from datetime import datetime, timedelta, timezone
from pathlib import Path

import numpy as np
from synthetic_findings import HINDSIGHT, aggregate, improvements, interquartile_mean, pareto, regret_split

SLOTS = 744
ZONE = timezone(timedelta(hours=-6))
METRICS = (
    "energy_cost",
    "transaction_cost",
    "battery_cost",
    "mean_temperature_deviation",
    "total_temperature_deviation",
    "gap_to_optimum",
    "share_of_savings",
    "regret",
    "reference_gap",
    "seconds_to_train",
)
COSTS = {
    "HA-1": 31.4,
    "HA-2": 30.9,
    "GAIL": 32.6,
    "MaxEnt IRL": 36.8,
    "MaxEnt IRL neural": 34.1,
    "BC": 33.9,
    "PPO": 34.7,
    "DDPG": 38.2,
    "MPC forecast": 31.9,
    "MPC hourly means": 33.1,
    "MPC yesterday": 32.8,
    "thresholds": 35.5,
    "Rule": 44.6,
    "no battery": 43.1,
    "MPC perfect": 28.9,
    "HMPC": 28.7,
    "HMPC joint": 28.5,
    "DNLP": 28.6,
    "optimum": 28.4,
}
DEVIATIONS = {
    "HA-1": 0.004, "HA-2": 0.002, "GAIL": 0.02, "MaxEnt IRL": 0.11,
    "MaxEnt IRL neural": 0.03, "BC": 0.05, "PPO": 0.08, "DDPG": 0.4,
    "Rule": 0.47,
}  # fmt: skip
TRAINED = {"HA-1", "HA-2", "GAIL", "MaxEnt IRL", "MaxEnt IRL neural", "BC", "PPO", "DDPG"}
TEST_START = datetime(2021, 8, 1, tzinfo=ZONE)


def write_results(
    folder: Path,
    homes: tuple[str, ...] = ("austin2021-1",),
    seeds: int = 5,
    methods: tuple[str, ...] = tuple(COSTS),
) -> dict:
    """Write a whole results folder; returns what stands in ``results.json``."""
    content = {
        "schema": 1,
        "hemma": "0.1.0",
        "settings": {"seeds": list(range(seeds)), "airl": {"rounds": 1800, "discount": 0.99}, "tariff": None},
        "interval_kind": "Student's t below 10 runs, bootstrap from 10 runs on",
        "homes": {name: _home(folder, name, seeds, methods) for name in homes},
    }
    if len(homes) > 1:
        content["aggregate"] = aggregate(content["homes"])
    save_results(folder, content)
    return content


def save_results(folder: Path, content: dict) -> None:
    (folder / "results.json").write_text(json.dumps(content))


def _home(folder: Path, name: str, seeds: int, methods: tuple[str, ...]) -> dict:
    generator = np.random.default_rng(len(name))
    exogenous = _exogenous(generator)
    _write(folder / f"schedules/{name}/exogenous.csv", ["time", *exogenous], exogenous, TEST_START)
    found = {
        method: _method(folder, name, method, seeds if method in TRAINED else 0, exogenous)
        for method in methods
    }
    return {
        "source": "Modelled homes (NREL End-Use Load Profiles) on measured Austin weather; ERCOT prices.",
        "currency": "$",
        "notes": ["The year of the weather is inferred."],
        "traces_sha256": "ab" * 32,
        "slot_length_h": 1.0,
        "training": {"start": "2021-06-01T00:00:00-06:00", "slots": 1464},
        "test": {"start": "2021-08-01T00:00:00-06:00", "slots": SLOTS},
        "comfort_c": [19.0, 24.0],
        "identification": _identification(folder, name, generator),
        "optimum": {
            "energy_cost": 28.4, "mean_temperature_deviation": 0.0, "bound": 28.39999, "relative_gap": 3.5e-7,
        },
        "demonstration_days": {"HA-1": 15, "HA-2": 60},
        "methods": found,
        "data_efficiency": [
            {
                "days": days,
                "method": method,
                **_summary([_run(base + 9 / days, 0.3 / days, seed) for seed in range(3)]),
            }
            for days in (1, 3, 7, 15, 30, 60)
            for method, base in (("AIRL", 30.8), ("GAIL", 31.9), ("BC", 33.0))
        ],
        "probability_of_improvement": improvements(found),
        "regret": {name: regret_split(found[name]) for name in found if name not in HINDSIGHT},
        "pareto": pareto(),
    }  # fmt: skip


def _method(folder: Path, home: str, method: str, seeds: int, exogenous: dict) -> dict:
    runs = []
    for seed in range(max(seeds, 1)):
        run = _run(COSTS.get(method, 40.0), DEVIATIONS.get(method, 0.0), seed if seeds else None)
        if method in ("optimum", "no battery"):
            run["gap_to_optimum"] = 0.0 if method == "optimum" else None
        run["schedule"] = f"schedules/{home}/{method}-{seed}.csv"
        schedule = _schedule(method, exogenous, seed)
        _write(folder / run["schedule"], ["time", *schedule], schedule, TEST_START)
        run["curve"] = f"curves/{home}/{method}-{seed}.csv" if seeds else None
        if seeds:
            curve = _curve(method, seed)
            _write(folder / run["curve"], list(curve), curve, None)
        runs.append(run)
    return _summary(runs)


def _run(cost: float, deviation: float, seed: int | None) -> dict:
    generator = np.random.default_rng(0 if seed is None else seed + round(100 * cost))
    noise = generator.normal(0.0, 0.02) if seed is not None else 0.0
    cost, deviation = cost * (1 + noise), deviation * float(np.exp(10 * noise))
    return {
        "seed": seed,
        "energy_cost": cost,
        "transaction_cost": cost - 0.6,
        "battery_cost": 0.6,
        "mean_temperature_deviation": deviation,
        "total_temperature_deviation": SLOTS * deviation,
        "gap_to_optimum": cost / 28.4 - 1,
        "share_of_savings": (43.1 - cost) / (43.1 - 28.4),
        "regret": cost - 28.4,
        "reference_gap": 2e-7,
        "seconds_to_train": 74.0 + noise if seed is not None else None,
        "schedule": None,
        "curve": None,
    }


def _summary(runs: list[dict]) -> dict:
    mean, interval = {}, {}
    for metric in METRICS:
        values = [run[metric] for run in runs]
        known = None not in values
        mean[metric] = float(np.mean(values)) if known else None
        half = (
            2.78 * float(np.std(values, ddof=1)) / len(values) ** 0.5 if known and len(values) > 1 else None
        )
        interval[metric] = [mean[metric] - half, mean[metric] + half] if half is not None else None
    summary = {"runs": runs, "mean": mean, "interval": interval}
    if len(runs) < 2:
        return summary
    middle = {metric: interquartile_mean([run[metric] for run in runs]) for metric in METRICS}
    worst = max(runs, key=lambda run: run["regret"])["seed"]
    return summary | {"interquartile_mean": middle, "worst_seed": worst}


def _exogenous(generator: np.random.Generator) -> dict:
    hour = np.arange(SLOTS) % 24
    day = np.repeat(generator.uniform(0.6, 1.3, SLOTS // 24), 24)
    buy = (
        0.07 + 0.02 * np.sin((hour - 9) / 24 * 2 * np.pi) + 0.12 * day**4 * np.exp(-((hour - 16.5) ** 2) / 4)
    )
    sun = np.maximum(0.0, 2.2 * np.sin((hour - 6.5) / 13 * np.pi)) * (hour > 6) * (hour < 20)
    return {
        "pv_kw": sun * np.minimum(day, 1.0),
        "load_kw": 0.4 + 0.5 * np.exp(-((hour - 19) ** 2) / 8) + 0.1 * generator.random(SLOTS),
        "outdoor_c": 30 + 5 * np.sin((hour - 9) / 24 * 2 * np.pi),
        "buy_per_kwh": buy,
        "sell_per_kwh": 0.9 * buy,
    }  # fmt: skip


def _schedule(method: str, exogenous: dict, seed: int) -> dict:
    price = exogenous["buy_per_kwh"]
    generator = np.random.default_rng(seed)
    skill = 0.0 if method in ("Rule", "no battery") else 1.0
    wish = np.where(price < 0.08, 2.0, np.where(price > 0.13, -2.5, 0.0)) * skill
    wish = wish + (generator.normal(0, 0.4, SLOTS) * skill if method in TRAINED else 0.0)
    energy, level = np.empty(SLOTS), 1.2
    for slot in range(SLOTS):
        level = energy[slot] = min(6.0, max(0.6, level + 0.95 * wish[slot]))
    battery = np.diff(energy, prepend=1.2) / 0.95
    hour = np.arange(SLOTS) % 24
    indoor = 23.85 + 0.1 * np.sin(hour) * (method in TRAINED) - 0.3 * (hour < 9)
    if method == "Rule":
        indoor = 22.4 + 2.3 * np.sin(np.arange(SLOTS) / 2.1)
    hvac = np.maximum(0.0, (exogenous["outdoor_c"] - 24) * 0.08)
    grid = exogenous["load_kw"] - exogenous["pv_kw"] + battery + hvac
    return {
        "battery_kw": battery,
        "hvac_kw": hvac,
        "battery_kwh": energy,
        "indoor_c": indoor,
        "grid_kw": grid,
        "cost": grid * np.where(grid > 0, price, 0.9 * price),
    }


def _curve(method: str, seed: int) -> dict:
    rows = np.arange(0, 1800, 20)
    generator = np.random.default_rng(seed + len(method))
    fall = np.exp(-rows / (150 + 60 * len(method)))
    curve = {"iteration": rows}
    if method in ("HA-1", "HA-2", "GAIL"):
        curve |= {
            "discriminator_loss": 0.69 - 0.4 * fall + generator.normal(0, 0.01, len(rows)),
            "expert_accuracy": 0.52 + 0.4 * fall + generator.normal(0, 0.02, len(rows)),
            "agent_accuracy": 0.53 + 0.4 * fall + generator.normal(0, 0.02, len(rows)),
            "learned_reward": -2 * fall + generator.normal(0, 0.05, len(rows)),
        }
    if method == "DDPG":
        curve |= {"critic_loss": 0.4 * fall + 0.1}
    if method not in ("BC", "DDPG"):
        curve |= {"policy_kl": 0.01 * fall + 0.002, "policy_entropy": 1.2 + 0.5 * fall}
    start = 1.6 if method == "PPO" else 1.9
    return curve | {
        "train_energy_cost": 0.95
        + 0.02 * len(method)
        + start * fall * 0.4
        + generator.normal(0, 0.01, len(rows)),
        "train_temperature_deviation": 8 * fall + np.abs(generator.normal(0, 0.1, len(rows))),
    }


def _identification(folder: Path, name: str, generator: np.random.Generator) -> dict:
    measured = 22.5 + 1.4 * np.sin(np.arange(SLOTS) / 24 * 2 * np.pi) + generator.normal(0, 0.2, SLOTS)
    path = f"identification/{name}.csv"
    columns = {
        "measured_c": measured,
        "predicted_c": measured + 0.2 * np.sin(np.arange(SLOTS) / 40) + generator.normal(0, 0.05, SLOTS),
        "outdoor_c": np.full(SLOTS, 30.0),
    }
    _write(folder / path, ["time", *columns], columns, TEST_START)
    rmse = {"1 h": 0.031, "6 h": 0.087, "24 h": 0.143, "whole period": 0.152}
    return {"rmse_c": rmse, "free_run": path, "seconds": 12.3}


def _write(path: Path, header: list[str], columns: dict, start: datetime | None) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = zip(*(np.asarray(values).tolist() for values in columns.values()), strict=True)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        for number, row in enumerate(rows):
            stamp = [] if start is None else [(start + timedelta(hours=number)).isoformat()]
            writer.writerow([*stamp, *row])
