"""Names of learned methods, and a home whose learners see more than the paper's state."""

from dataclasses import replace

import numpy as np
import pytest

from hemma.checkpoint import load_header, load_shapes
from hemma.data import load_austin2021
from hemma.errors import HemmaError
from hemma.experiment.run import Stage, run
from hemma.forecasting.observations import MODELS, Observer
from hemma.forecasting.outlook import hourly_means
from hemma.forecasting.shape import ShapeForecast
from hemma.methods import METHODS, learned, learners
from hemma.methods.cloning import CLONING
from hemma.methods.measured import play
from hemma.report.methods import grouped, in_order, meaning_of, plain
from hemma.results.results import load_results
from hemma.results.store import Store
from hemma.stages.case import make_case
from hemma.stages.causal import causal_demonstration
from hemma.stages.demonstrate import Expert
from hemma.stages.identify import identify
from hemma.stages.observer import HomeObserver
from hemma.stages.train import train_job
from tiny_experiment import Watching, every_method, tiny_job

HOME = "austin2021-2"
SEEING = ("BC", "BC published", "PPO past")


def test_every_name_says_what_it_is_and_nothing_is_called_twice():
    assert len({method.name for method in METHODS}) == len(METHODS)
    known = learners()
    assert [method.name for method in known.values()] == list(known)
    assert len(known) == 6 * 6 * 2 + 2 * 6
    assert not any(method.is_taught_causally and method.plain in ("PPO", "DDPG") for method in known.values())


def test_the_report_knows_all_names():
    for name, method in learners().items():
        assert plain(name) == (method.plain or name)
        assert meaning_of(name)
    present = ["PPO past", "HA-1 published", "Rule", "HA-1 causal", "HA-1"]
    assert in_order(present) == ["HA-1", "HA-1 published", "HA-1 causal", "PPO past", "Rule"]
    assert grouped(present)["Knows tomorrow's prices"] == ["HA-1 published"]
    assert plain("HA-1 of mine") == "HA-1 of mine"
    assert meaning_of("HA-1 of mine") is None


@pytest.mark.parametrize("name", ["HA-1 future", "PPO causal", "HA-1 causal past", "xyzzy"])
def test_a_name_that_says_nothing_is_refused(name):
    with pytest.raises(HemmaError, match=rf"learned.*published.*causal.*got {name}"):
        learned(replace(every_method(), learned=("HA-1", name)))


@pytest.fixture(scope="module")
def case():
    """Six days to train, two to test."""
    return make_case(every_method(), load_austin2021(2).window(0, 24 * 8), "2021-06-07")


@pytest.fixture
def expert(case, tmp_path):
    """Who has identified the building; its store."""
    store = Store(tmp_path, case.name, Watching())
    return Expert(case, identify(case, store)), store


@pytest.mark.slow
def test_a_policy_that_sees_more_is_taught_and_acts_by_what_it_sees(case, expert):
    one, store = expert
    made = [method.training_job(one, store) for method in (CLONING, CLONING.seeing(MODELS["published"]))]
    assert [training_job.task.environment.width for training_job in made] == [8, 20]
    assert made[0].kind != made[1].kind
    played = [play(case, training_job, train_job(training_job, store))[0].outcome for training_job in made]
    assert not np.allclose(played[0].battery_power, played[1].battery_power)
    for training_job, model in zip(made, ("paper", "published"), strict=True):
        path = store.folder / store.model(f"{training_job.label}.safetensors")
        assert load_header(path)["observation_model"] == model


@pytest.mark.slow
def test_learners_that_see_more_are_measured_beside_the_others_and_kept(tmp_path):
    job = tiny_job(tmp_path, replace(every_method(), learned=SEEING))
    run(job, Stage.EVALUATE)
    methods = load_results(tmp_path).homes[HOME].methods
    costs = {name: [run.energy_cost for run in methods[name].runs] for name in SEEING}
    assert all(len(set(found)) == 2 for found in costs.values())
    assert costs["BC"] != costs["BC published"]
    progress = Watching()
    run(job, Stage.TRAIN, progress)
    assert set(SEEING) <= set(progress.kept)
    assert not set(SEEING) & set(progress.done)
    shapes = load_shapes(tmp_path / "models" / HOME / "PPO past.safetensors")
    assert shapes[".policy.network.weights[0]"][-1] == 106


def test_a_causal_expert_shows_what_a_planner_did(case, expert):
    """Its states follow each other and have the traces' prices; published prices make it act otherwise."""
    (one, store), shown = expert, []
    for name in ("paper", "published"):
        observer = HomeObserver(case, Observer(MODELS[name], hourly_means))
        shown.append(causal_demonstration(store, one, observer, 2))
        assert causal_demonstration(store, one, observer, 2).mark == shown[-1].mark
    unpublished, published = (np.asarray(one.demonstrated.actions) for one in shown)
    assert unpublished.shape == published.shape == (47, 2)
    assert not np.allclose(unpublished, published)
    states = np.asarray(shown[0].demonstrated.states)
    np.testing.assert_allclose(states[1:], np.asarray(shown[0].demonstrated.next_states)[:-1])
    np.testing.assert_allclose(states[:, 5], case.training.buying_price[:47], rtol=1e-6)


def test_too_few_days_for_a_forecast_that_has_not_seen_them_are_said(case):
    observer = HomeObserver(case, Observer(MODELS["forecast"], ShapeForecast()))
    with pytest.raises(HemmaError, match="give longer training traces"):
        observer.learning(6)
