"""The transfer test: which days it uses, what changes and what does not, and a tiny one from end to end."""

import json
from dataclasses import replace

import jax
import numpy as np
import pytest

from hemma.checkpoint import load_header
from hemma.data import load_austin2021
from hemma.errors import HemmaError
from hemma.irl.learned_reward import load_rewards
from hemma.irl.reward import ShapedReward
from hemma.settings.experiment import Experiment
from hemma.studies.transfer.changes import CHANGES, changed_cases
from hemma.studies.transfer.run import GAIL, POLICY, TransferJob, transfer
from tiny_experiment import Watching, tiny_experiment

BY_NAME = {change.name: change for change in CHANGES}
FEW = tuple(BY_NAME[name] for name in ("unchanged", "twice the battery"))


@pytest.fixture(scope="module")
def all_cases():
    made = changed_cases(Experiment(), load_austin2021(1))
    return {place.change.name: place.case for place in made}


def tiny_transfer(folder):
    experiment = tiny_experiment(iterations=25)
    learner = replace(experiment.explicit, iterations=25, ppo=experiment.ppo)
    experiment = replace(experiment, explicit=learner, demonstration_days=1)
    traces = load_austin2021(2).window(0, 24 * 7)
    return TransferJob(experiment, traces, folder, test_from="2021-06-06", changes=FEW)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("transfer")
    return folder, transfer(tiny_transfer(folder))


def test_june_teaches_july_measures_and_august_is_never_seen(all_cases):
    for name, case in all_cases.items():
        first = "2021-07-01" if name == "other month" else "2021-06-01"
        assert case.parts.training.time_stamps()[0].startswith(first)
        assert case.parts.test.time_stamps()[0].startswith("2021-07-16T00:00")
        assert case.parts.test.time_stamps()[-1].startswith("2021-07-31T23:00")


def test_every_change_changes_what_it_says_and_nothing_else(all_cases):
    same = all_cases["unchanged"]
    battery = all_cases["twice the battery"].home.battery
    assert (battery.max_energy, battery.max_charging_power) == (12.0, 6.0)
    slow = all_cases["half the power"].home.battery
    assert (slow.max_energy, slow.max_discharging_power) == (6.0, 1.5)
    assert all_cases["leaky house"].home.thermal_model.conductance == pytest.approx(1.5 * 0.252)
    for name in ("twice the battery", "half the power", "leaky house"):
        np.testing.assert_array_equal(all_cases[name].training.buying_price, same.training.buying_price)
    for name in ("twice the spread", "time of use"):
        assert all_cases[name].home == same.home
        np.testing.assert_array_equal(all_cases[name].training.load, same.training.load)


def test_changed_prices_have_the_mean_of_the_real_ones(all_cases):
    def prices(case):
        return np.concatenate([case.training.buying_price, case.test.buying_price])

    real = prices(all_cases["unchanged"])
    wide, two = prices(all_cases["twice the spread"]), prices(all_cases["time of use"])
    np.testing.assert_allclose([wide.mean(), two.mean()], real.mean(), rtol=1e-9)
    np.testing.assert_allclose(wide.std(), 2 * real.std(), rtol=1e-9)
    assert len(np.unique(two.round(9))) == 2
    np.testing.assert_allclose(two.max(), 3 * two.min())
    hours = all_cases["time of use"].training.hour_of_day
    dear = all_cases["time of use"].training.buying_price > real.mean()
    assert set(hours[dear]) == {15.0, 16.0, 17.0, 18.0, 19.0}


def test_too_short_a_training_period_is_refused():
    with pytest.raises(HemmaError, match="expected a training period of more than 30 days"):
        changed_cases(Experiment(), load_austin2021(1).window(0, 24 * 50))


@pytest.mark.slow
def test_airl_leaves_the_rewards_of_all_its_runs_and_gail_none(done):
    folder, _ = done
    models = folder / "models" / "austin2021-2"
    kept = load_rewards(models / "unchanged-AIRL.reward.safetensors")
    assert isinstance(kept.head, ShapedReward)
    assert kept.runs == 2
    assert load_header(models / "unchanged-AIRL.reward.safetensors")["seeds"] == [0, 1]
    assert not list(models.glob("*GAIL.reward*"))
    files = json.loads((models / "unchanged-AIRL.json").read_text())["files"]
    assert any(name.endswith("unchanged-AIRL.reward.safetensors") for name in files)
    leaves = jax.tree.leaves(kept)
    assert all(np.isfinite(leaf).all() for leaf in leaves)


@pytest.mark.slow
def test_every_home_has_every_method_and_a_policy_is_not_trained_twice(done):
    _, content = done
    assert list(content["places"]) == ["unchanged", "twice the battery"]
    for name, place in content["places"].items():
        anew = set() if name == "unchanged" else {"AIRL anew"}
        known = {POLICY, GAIL, "adapted by r", "PPO on r", "PPO on g", "PPO on the bill"}
        assert set(place["methods"]) == known | anew
        assert all(len(method["runs"]) == 2 for method in place["methods"].values())


@pytest.mark.slow
def test_differences_are_taken_seed_by_seed(done):
    _, content = done
    place = content["places"]["twice the battery"]
    shares = {
        name: [run["share_of_savings"] for run in method["runs"]] for name, method in place["methods"].items()
    }
    [pair] = [pair for pair in place["paired"] if pair["method"] == "PPO on r"]
    assert pair["over"] == POLICY
    expected = np.subtract(shares["PPO on r"], shares[POLICY])
    np.testing.assert_allclose(pair["differences"], expected)
    np.testing.assert_allclose(pair["mean"], expected.mean())


@pytest.mark.slow
def test_figures_and_table_lie_in_the_folder(done):
    folder, _ = done
    for name in ("reward-battery", "reward-comfort", "transfer"):
        assert (folder / "figures" / f"{name}.png").stat().st_size > 10_000
    assert (folder / "transfer.md").read_text().startswith("| Home | Method |")


@pytest.mark.slow
def test_the_same_call_trains_nothing_again_and_says_the_same(done):
    folder, content = done
    watching = Watching()
    assert transfer(tiny_transfer(folder), watching) == content
    assert watching.done == []
