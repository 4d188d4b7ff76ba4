"""Stage: cost against comfort, by sweeps of what trades one for the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from hemma.experiment.bands import ShiftedBand, shifted_experts
from hemma.experiment.demonstrate import Expert, demonstration
from hemma.experiment.explicit import Sweep
from hemma.experiment.fingerprint import fingerprint
from hemma.experiment.judge import Judge
from hemma.experiment.lessons import airl
from hemma.experiment.play import play
from hemma.experiment.results import MethodResults, ParetoPoint, Run
from hemma.experiment.store import Store
from hemma.experiment.train import Lesson, train_lesson
from hemma.rl.task import make_task, stack

BUDGETS = 9
"""Points of the proven frontier."""


@dataclass(frozen=True)
class Pareto:
    """Sweeps on one home."""

    judge: Judge

    def points(
        self, expert: Expert, sweep: Sweep | None, methods: Sequence[MethodResults]
    ) -> tuple[ParetoPoint, ...]:
        """All sweeps; the frontier goes as far as the method that deviates most."""
        runs = [run.metrics.total_temperature_deviation for method in methods for run in method.runs]
        swept = () if sweep is None else self.comfort_prices(sweep)
        bands = self.comfort_bands(expert) if "HA-1" in self.judge.case.experiment.learned else ()
        return (*self.frontier(max(runs)), *swept, *bands)

    def frontier(self, largest: float) -> tuple[ParetoPoint, ...]:
        """The proven least cost for total deviations from the least up to ``largest`` [degC].

        The budgets are spaced by squares: the frontier is steepest where comfort is nearly kept.
        """
        problem, slots = self.judge.problem, self.judge.case.test.slots
        least = problem.least_deviation
        points = []
        for share in np.linspace(0.0, 1.0, BUDGETS) ** 2:
            found = problem.solve(float(least + share * max(largest - least, 0.0)))
            mean = found.deviation / slots
            points.append(ParetoPoint("optimum", "total deviation budget", found.budget, found.cost, mean, 1))
        return tuple(points)

    def comfort_prices(self, sweep: Sweep) -> tuple[ParetoPoint, ...]:
        """PPO with each beta_T, trained on the first part of the training period."""
        lesson, trained = sweep.lesson, sweep.trained
        runs = self.judge.judged(lesson.label, trained.mark, partial(play, self.judge.case, lesson, trained))
        points = []
        for price in dict.fromkeys(sweep.prices):
            same = [run for own, run in zip(sweep.prices, runs, strict=True) if own == price]
            points.append(_point("PPO", "beta_T", price, same))
        return tuple(points)

    def comfort_bands(self, expert: Expert) -> tuple[ParetoPoint, ...]:
        """HA-1 whose expert aims at another edge of the band; measured against the band that people want."""
        case, store = self.judge.case, self.judge.store
        bands = shifted_experts(expert, case.experiment.pareto.relaxations)
        if not bands:
            return ()
        lesson = _bands_lesson(bands, store)
        trained = train_lesson(lesson, store)
        runs = self.judge.judged(lesson.label, trained.mark, partial(play, case, lesson, trained))
        edge = "lower comfort limit" if case.home.hvac.heats else "upper comfort limit"
        seeds = case.experiment.pareto.seeds
        return tuple(
            _point("HA-1", edge, band.limit, runs[i * seeds : (i + 1) * seeds])
            for i, band in enumerate(bands)
        )


def _bands_lesson(bands: Sequence[ShiftedBand], store: Store) -> Lesson:
    """HA-1 on the demonstrations of each band's expert, all bands and seeds side by side."""
    experiment = bands[0].expert.case.experiment
    shown = [demonstration(store, band.expert, experiment.demonstration_days) for band in bands]
    tasks = [
        make_task(band.expert.case.home, band.expert.case.first_days(d.days), d.demonstrated, seed)
        for band, d in zip(bands, shown, strict=True)
        for seed in range(experiment.pareto.seeds)
    ]
    basis = fingerprint("bands", [d.mark for d in shown])
    return Lesson("HA-1-bands", airl(experiment), stack(tasks), basis)


def _point(series: str, parameter: str, value: float, runs: Sequence[Run]) -> ParetoPoint:
    cost = float(np.mean([run.metrics.energy_cost for run in runs]))
    deviation = float(np.mean([run.metrics.mean_temperature_deviation for run in runs]))
    return ParetoPoint(series, parameter, value, cost, deviation, len(runs))
