"""A results folder recomputed from its files: the paper's equations, NumPy's sums, and nothing of Hemma.

``complaints(folder)`` goes through whatever the folder holds: every schedule of every home, every run that
``results.json`` names, under any method. A method that is added later is checked without a change here.
"""

import csv
import json
import math
from pathlib import Path

import numpy as np

EXOGENOUS = ["time", "pv_kw", "load_kw", "outdoor_c", "buy_per_kwh", "sell_per_kwh"]
SCHEDULE = ["time", "battery_kw", "hvac_kw", "battery_kwh", "indoor_c", "grid_kw", "cost"]


def complaints(folder):
    """One sentence for each number that does not recompute; empty where all do."""
    content = json.loads((Path(folder) / "results.json").read_text())
    found = []
    for name, home in content["homes"].items():
        where = Path(folder) / "schedules" / name
        settings, dt = content["settings"], home["slot_length_h"]
        files = [file for file in sorted(where.glob("*.csv")) if file.name != "exogenous.csv"]
        costs = {}
        for file in files:
            costs[f"schedules/{name}/{file.name}"], wrong = recomputed(settings, dt, where, file)
            found += [f"{name}/{file.name}: {sentence}" for sentence in wrong]
        for label, group in groups(home):
            found += [f"{name}, {label}: {sentence}" for sentence in of_group(group, costs)]
    return found


def groups(content, label=""):
    """Whatever has runs, at any depth: methods, and lengths of demonstrations."""
    if isinstance(content, dict):
        if "runs" in content and isinstance(content["runs"], list):
            yield label, content
        for key, value in content.items():
            yield from groups(value, f"{label} {key}".strip())
    if isinstance(content, list):
        for position, value in enumerate(content):
            yield from groups(value, f"{label} {position}")


def of_group(group, costs):
    """Totals of each run against the sums over its schedule, and their means over the runs."""
    totals = []
    for run in group["runs"]:
        if run["schedule"] not in costs:
            yield f"the schedule {run['schedule']} is not there"
            continue
        x1, x2, x3 = costs[run["schedule"]]
        totals.append(
            {
                "energy_cost": np.sum(x1) + np.sum(x2),
                "transaction_cost": np.sum(x1),
                "battery_cost": np.sum(x2),
                "mean_temperature_deviation": np.mean(x3),
                "total_temperature_deviation": np.sum(x3),
            }
        )
        for metric, value in totals[-1].items():
            if not same(run[metric], value):
                yield f"{metric} of {run['schedule']} is {run[metric]}, recomputed {value}"
    for metric in totals[0] if totals else ():
        value = np.mean([total[metric] for total in totals])
        if not same(group["mean"][metric], value):
            yield f"mean {metric} is {group['mean'][metric]}, recomputed {value}"


def recomputed(settings, dt, where, file):
    """X1, X2 and X3 of every slot, and what the schedule has wrong: equations (1) to (8), slot by slot."""
    battery, building = settings["battery"], settings["building"]
    hvac, comfort = settings["hvac"], settings["comfort"]
    eta_c, eta_d = battery["charging_efficiency"], battery["discharging_efficiency"]
    eps = building["inertia_per_hour"] ** dt
    warming = building["coefficient_of_performance"] / building["conductance_kw_per_c"]
    warming *= 1 if hvac["heats"] else -1
    E, T = battery["initial_energy_kwh"], settings["initial_indoor_c"]
    stamps, outside = table(where / "exogenous.csv", EXOGENOUS)
    times, rows = table(file, SCHEDULE)
    wrong = [] if times == stamps else ["its time stamps are not those of exogenous.csv"]
    costs = []
    for time, row, (p, load, T_out, u_buy, u_sell) in zip(times, rows, outside, strict=False):
        e, h, *written = row
        g = h + e + load - p
        E = E + eta_c * e * dt if e > 0 else E + e / eta_d * dt
        T = eps * T + (1 - eps) * (T_out + warming * h)
        x1 = u_buy * g * dt if g > 0 else u_sell * g * dt
        x2 = battery["ageing_per_kwh"] * abs(e) * dt
        x3 = max(T - comfort["high_c"], 0) + max(comfort["low_c"] - T, 0)
        costs.append((x1, x2, x3))
        for column, value, mine in zip(SCHEDULE[3:], written, (E, T, g, x1 + x2), strict=True):
            if not same(value, mine):
                wrong.append(f"{column} at {time} is {value}, recomputed {mine}")
        limits = (
            ("battery_kw", e, -battery["max_discharging_kw"], battery["max_charging_kw"]),
            ("hvac_kw", h, 0, hvac["max_power_kw"]),
            ("battery_kwh", E, battery["min_energy_kwh"], battery["max_energy_kwh"]),
        )
        for column, value, low, high in limits:
            if not low - 1e-9 <= value <= high + 1e-9:
                wrong.append(f"{column} at {time} is {value}, outside {low} to {high}")
    return np.array(costs).T, wrong


def table(file, columns):
    """Time stamps and numbers of a CSV file."""
    with file.open(newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == columns, f"{file}: {header}"
    return [row[0] for row in rows], [[float(cell) for cell in row[1:]] for row in rows]


def same(came, expected):
    """Equal but for rounding."""
    return math.isclose(came, expected, rel_tol=1e-9, abs_tol=1e-9)
