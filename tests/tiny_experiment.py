"""A tiny experiment: a week of an embedded home, all stages, hardly any training."""

from dataclasses import replace
from pathlib import Path

from hemma.data import load_austin2021
from hemma.experiment.run import Job
from hemma.results.progress import Silence
from hemma.settings.experiment import ComfortPrices, DataEfficiency, Experiment, ParetoSettings


def tiny_experiment(iterations=50):
    """Two seeds, two days of demonstrations, and one day for the data efficiency; HA-1 alone is learned."""
    default = Experiment()
    ppo = replace(default.ppo, rollouts=4, slots=12, epochs=1, minibatches=2, hidden=(4,))
    airl = replace(
        default.airl,
        iterations=iterations,
        hidden=(4,),
        batch=16,
        steps=1,
        members=2,
        rollouts=4,
        agent_rollouts=2,
        replayed=2,
    )
    return replace(
        default,
        airl=airl,
        ppo=ppo,
        identification=replace(default.identification, updates=20, chunk=10, window=6.0, batch=8, width=4),
        learned=("HA-1",),
        forecast_horizon=12.0,
        pareto=ParetoSettings(relaxations=(0.5,), seeds=2),
        seeds=2,
        demonstration_days=2,
        data_efficiency=DataEfficiency(days=(1, 2, 60), seeds=2),
    )


def every_method():
    """The same with all learned methods."""
    experiment = tiny_experiment()
    return replace(
        experiment,
        learned=None,
        maxent=replace(experiment.maxent, iterations=25, windows=2, slots=12),
        cloning=replace(experiment.cloning, iterations=25),
        explicit=replace(experiment.explicit, iterations=25),
        ddpg=replace(experiment.ddpg, iterations=25, steps=1),
        comfort_price=ComfortPrices(multiples=(1.0, 4.0), seeds=1),
    )


def tiny_job(folder, experiment=None):
    """Five days to train, two to test."""
    traces = load_austin2021(2).window(0, 24 * 7)
    return Job(
        experiment=tiny_experiment() if experiment is None else experiment,
        homes=(traces,),
        folder=Path(folder),
        test_from="2021-06-06",
        command="hemma reproduce --for-tests",
    )


class Watching(Silence):
    """Remembers what the stages said."""

    def __init__(self):
        self.done, self.kept, self.notices = [], [], []

    def finished(self, stage, message):
        self.done.append(stage)

    def reused(self, stage, message):
        self.kept.append(stage)

    def noticed(self, message):
        self.notices.append(message)
