"""The results file: grows, is never a mix of two settings, and takes only its own stale files away."""

import json
import math

import pytest

from hemma.evaluation import RegretSplit
from hemma.results.findings import ParetoPoint
from hemma.results.ledger import is_part_of, open_ledger
from hemma.results.progress import Silence
from hemma.results.reading import json_content
from hemma.results.records import DemonstrationRuns, Period, Run
from hemma.results.results import HomeResults
from hemma.results.summary import method_runs


def run(seed=None, cost=1.0, schedule="schedules/a/Rule.csv", curve=None):
    return Run(
        seed=seed,
        energy_cost=cost,
        transaction_cost=cost,
        battery_cost=0.0,
        mean_temperature_deviation=0.1,
        total_temperature_deviation=2.4,
        gap_to_optimum=math.nan,
        regret=cost - 0.5,
        schedule=schedule,
        curve=curve,
    )


def home(methods=None, **found):
    period = Period(start="2021-08-01T00:00:00-06:00", slots=24)
    return HomeResults(
        source="made up",
        currency="$",
        traces_sha256="00",
        slot_length_h=1.0,
        training=period,
        test=period,
        comfort_c=(19.0, 24.0),
        methods={name: method_runs(runs) for name, runs in (methods or {}).items()},
        **found,
    )


def length(days, cost=None):
    runs = (run(0, float(days) if cost is None else cost),)
    return DemonstrationRuns(**dict(method_runs(runs)), days=days, method="AIRL")


def point(deviation=0.0):
    return ParetoPoint(
        series="PPO",
        parameter="beta_T",
        value=0.1,
        energy_cost=30.0,
        mean_temperature_deviation=deviation,
        schedules=("schedules/a/PPO-sweep-0.csv",),
    )


def ledger_of(folder, settings=None, progress=None):
    return open_ledger(folder, "hemma", settings or {}, progress or Silence())


class Notices(Silence):
    def __init__(self):
        self.messages = []

    def noticed(self, message):
        self.messages.append(message)


def content(folder):
    return json.loads((folder / "results.json").read_text())


def test_what_is_undefined_is_null_and_never_nan(tmp_path):
    ledger = ledger_of(tmp_path)
    ledger.put("a", home({"Rule": [run()]}))
    assert "NaN" not in (tmp_path / "results.json").read_text()
    rule = content(tmp_path)["homes"]["a"]["methods"]["Rule"]
    assert rule["runs"][0]["gap_to_optimum"] is None
    assert rule["mean"]["gap_to_optimum"] is None
    assert rule["interval"]["energy_cost"] is None


def test_mean_and_interval_over_seeds():
    runs = tuple(run(seed, cost) for seed, cost in enumerate([1.0, 2.0, 3.0]))
    rule = json_content(method_runs(runs))
    assert rule["mean"]["energy_cost"] == 2.0
    low, high = rule["interval"]["energy_cost"]
    assert (low + high) / 2 == pytest.approx(2.0)
    assert high - 2.0 == pytest.approx(4.302653 / 3**0.5, abs=1e-5)
    assert [r["seed"] for r in rule["runs"]] == [0, 1, 2]


def test_the_same_settings_keep_other_homes(tmp_path):
    ledger_of(tmp_path, {"seeds": 1}).put("a", home())
    ledger = ledger_of(tmp_path, {"seeds": 1})
    ledger.put("b", home())
    assert set(content(tmp_path)["homes"]) == {"a", "b"}


def test_other_settings_replace_everything_and_say_so(tmp_path):
    ledger_of(tmp_path, {"seeds": 1}).put("a", home())
    notices = Notices()
    ledger = ledger_of(tmp_path, {"seeds": 2}, progress=notices)
    ledger.put("b", home())
    assert set(content(tmp_path)["homes"]) == {"b"}
    assert len(notices.messages) == 1
    assert "replaced" in notices.messages[0]


def test_going_on_never_makes_the_file_poorer(tmp_path):
    full = home({"Rule": [run()]})
    ledger_of(tmp_path).put("a", full)
    before = (tmp_path / "results.json").read_bytes()
    ledger = ledger_of(tmp_path)
    ledger.put("a", home())
    assert (tmp_path / "results.json").read_bytes() == before
    ledger.put("a", home({"Rule": [run(cost=5.0)]}))
    assert content(tmp_path)["homes"]["a"]["methods"]["Rule"]["mean"]["energy_cost"] == 5.0


def test_only_files_that_the_old_results_named_are_taken_away(tmp_path):
    folder = tmp_path / "results"
    schedules = folder / "schedules" / "a"
    schedules.mkdir(parents=True)
    for name in ("old.csv", "kept.csv", "mine.csv"):
        (schedules / name).write_text("time\n")
    (tmp_path / "outside.csv").write_text("mine\n")
    (folder / "notes.txt").write_text("mine\n")
    old = (run(0, 1.0, "schedules/a/old.csv"), run(1, 1.0, "schedules/a/kept.csv"))
    foreign = (run(2, 1.0, "../outside.csv"), run(3, 1.0, "notes.txt"))
    ledger_of(folder, {"x": 1}).put("a", home({"M": [*old, *foreign]}))
    ledger = ledger_of(folder, {"x": 2})
    ledger.put("a", home({"M": [run(1, 1.0, "schedules/a/kept.csv")]}))
    ledger.close()
    assert sorted(path.name for path in schedules.iterdir()) == ["kept.csv", "mine.csv"]
    assert (tmp_path / "outside.csv").exists()
    assert (folder / "notes.txt").exists()


def test_schedules_of_a_sweep_are_taken_away_with_it(tmp_path):
    file = tmp_path / "schedules" / "a" / "PPO-sweep-0.csv"
    file.parent.mkdir(parents=True)
    file.write_text("time\n")
    ledger_of(tmp_path, {"x": 1}).put("a", home(pareto=(point(),)))
    ledger = ledger_of(tmp_path, {"x": 1})
    ledger.put("a", home(pareto=(point(),)))
    ledger.close()
    assert file.exists()
    ledger = ledger_of(tmp_path, {"x": 2})
    ledger.put("a", home())
    ledger.close()
    assert not file.exists()


@pytest.mark.parametrize("broken", ["", "{", "[]", '{"homes": 3}', '{"homes": []}', "[" * 100_000])
def test_a_broken_results_file_does_not_stop_a_new_run(tmp_path, broken):
    (tmp_path / "results.json").write_text(broken)
    ledger = ledger_of(tmp_path)
    ledger.put("a", home())
    assert set(content(tmp_path)["homes"]) == {"a"}


def test_a_shorter_list_of_records_does_not_replace_a_longer_one(tmp_path):
    """A repeated run finds one length of demonstrations after the other; the file keeps them all."""
    lengths = tuple(length(days) for days in (3, 7, 15))
    ledger_of(tmp_path).put("a", home(data_efficiency=lengths))
    before = (tmp_path / "results.json").read_bytes()
    ledger = ledger_of(tmp_path)
    ledger.put("a", home(data_efficiency=lengths[:2]))
    assert (tmp_path / "results.json").read_bytes() == before
    ledger.put("a", home(data_efficiency=(length(3, 99.0),)))
    [only] = content(tmp_path)["homes"]["a"]["data_efficiency"]
    assert only["mean"]["energy_cost"] == 99.0


def test_what_follows_from_the_runs_is_computed_anew_when_the_file_is_written(tmp_path):
    """Homes of an earlier run join the comparisons; a repeated run changes nothing."""
    methods = {"HA-1": [run(0, 1.0), run(1, 2.0)], "Rule": [run(None, 3.0)]}
    ledger_of(tmp_path).put("a", home(methods))
    assert content(tmp_path)["aggregate"] is None
    ledger_of(tmp_path).put("b", home(methods))
    written = content(tmp_path)
    assert written["aggregate"]["homes"] == ["a", "b"]
    assert set(written["aggregate"]["methods"]) == {"HA-1", "Rule"}
    [pair] = written["homes"]["a"]["probability_of_improvement"]
    assert (pair["method"], pair["over"], pair["probability"]) == ("HA-1", "Rule", 1.0)
    ledger = ledger_of(tmp_path)
    ledger.put("a", home())
    ledger.close()
    assert content(tmp_path) == written == json.loads(json.dumps(json_content(ledger.results)))


def test_statistics_of_the_runs_of_a_method():
    runs = tuple(run(seed, cost) for seed, cost in enumerate([4.0, 100.0, 2.0, -50.0]))
    learned, rule = json_content(method_runs(runs)), json_content(method_runs([run()]))
    assert learned["interquartile_mean"]["energy_cost"] == 3.0
    assert learned["interquartile_mean"]["share_of_savings"] is None
    assert (learned["worst_seed"], rule["worst_seed"]) == (1, None)
    assert (learned["interval_kind"], rule["interval_kind"]) == ("student", None)
    assert [one["regret"] for one in learned["runs"]] == [3.5, 99.5, 1.5, -50.5]


def test_a_missing_regret_leaves_no_worst_seed():
    broken = run(1).model_copy(update={"regret": None})
    found = method_runs([run(0), broken])
    assert found.worst_seed is found.mean.regret is None


def test_regret_and_pareto_stand_in_the_file():
    results = home(
        regret={"HA-1": RegretSplit(total=3.0, future=2.0, thermal_model=-0.5, policy=1.5)},
        pareto=(point(deviation=math.nan),),
    )
    entry = json_content(results)
    split = {"total": 3.0, "future": 2.0, "thermal_model": -0.5, "policy": 1.5}
    assert entry["regret"] == {"HA-1": split}
    assert entry["pareto"] == [
        {
            "series": "PPO",
            "parameter": "beta_T",
            "value": 0.1,
            "energy_cost": 30.0,
            "mean_temperature_deviation": None,
            "runs": 1,
            "schedules": ["schedules/a/PPO-sweep-0.csv"],
        }
    ]


def test_part_of():
    assert is_part_of({"a": {"b": 1}}, {"a": {"b": 1, "c": 2}, "d": 3})
    assert is_part_of({"a": []}, {"a": [1]})
    assert not is_part_of({"a": 1}, {"a": 2})
    assert not is_part_of({"a": 1}, None)
    assert is_part_of({"a": None}, {"a": 1})
    assert not is_part_of({"a": [1]}, {"a": [1, 2]})
    assert is_part_of({"a": [{"b": 1}]}, {"a": [{"b": 2}, {"b": 1, "c": 3}]})
    assert not is_part_of({"a": [{"b": 1}]}, {"a": [{"b": 2}, {"c": 1}]})


def test_a_damaged_entry_is_made_anew_and_the_others_stay(tmp_path):
    ledger_of(tmp_path).put("a", home({"Rule": [run()]}))
    written = content(tmp_path)
    written["homes"]["b"] = None
    written["homes"]["c"] = {"methods": 3}
    (tmp_path / "results.json").write_text(json.dumps(written))
    notices = Notices()
    ledger = ledger_of(tmp_path, progress=notices)
    ledger.put("d", home())
    assert list(content(tmp_path)["homes"]) == ["a", "d"]
    assert ["b is damaged" in notices.messages[0], "c is damaged" in notices.messages[1]] == [True, True]
