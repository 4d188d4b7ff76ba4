"""Stage: cost against comfort, by sweeps of what trades one for the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from hemma.methods.bill import Sweep
from hemma.methods.measured import play
from hemma.results.findings import ParetoPoint
from hemma.results.records import Run
from hemma.results.summary import method_runs
from hemma.stages.evaluate import Evaluator
from hemma.stages.train import Trained
from hemma.studies.pareto.bands import Bands

BUDGETS = 9
"""Points of the proven frontier."""


@dataclass(frozen=True)
class Pareto:
    """Sweeps on one home."""

    evaluator: Evaluator

    def frontier(self, largest: float) -> tuple[ParetoPoint, ...]:
        """The proven least cost for total deviations from the least up to ``largest`` [degC].

        The budgets are spaced by squares: the frontier is steepest where comfort is nearly kept.
        """
        problem, slots = self.evaluator.problem, self.evaluator.case.test.slots
        least = problem.least_deviation
        points = []
        for share in np.linspace(0.0, 1.0, BUDGETS) ** 2:
            found = problem.solve(float(least + share * max(largest - least, 0.0)))
            mean = found.deviation / slots
            points.append(
                ParetoPoint(
                    series="optimum",
                    parameter="total deviation budget",
                    value=found.budget,
                    energy_cost=found.cost,
                    mean_temperature_deviation=mean,
                )
            )
        return tuple(points)

    def comfort_prices(self, method: str, sweep: Sweep) -> tuple[ParetoPoint, ...]:
        """A method with each beta_T, trained on the first part of the training period."""
        job, trained = sweep.job, sweep.trained
        runs = self.evaluator.evaluated(
            job.label, trained.mark, partial(play, self.evaluator.case, job, trained)
        )
        points = []
        for price in dict.fromkeys(sweep.prices):
            same = [run for own, run in zip(sweep.prices, runs, strict=True) if own == price]
            points.append(_point(method, "beta_T", price, same))
        return tuple(points)

    def comfort_bands(self, bands: Bands, trained: Trained, usual: Sequence[Run]) -> tuple[ParetoPoint, ...]:
        """HA-1 whose expert aims at another edge of the band; measured against the band that people want.

        ``usual`` are the runs of HA-1 itself, whose expert aims at that band.
        """
        case, job = self.evaluator.case, bands.job
        runs = self.evaluator.evaluated(job.label, trained.mark, partial(play, case, job, trained))
        edge = "lower comfort limit" if case.home.hvac.heats else "upper comfort limit"
        seeds = case.experiment.pareto.seeds
        parts = [runs[i * seeds : (i + 1) * seeds] for i in range(len(bands.limits))]
        own = case.home.comfort.low if case.home.hvac.heats else case.home.comfort.high
        swept = [*zip(bands.limits, parts, strict=True), (float(own), usual)]
        return tuple(_point("HA-1", edge, x, part) for x, part in sorted(swept, key=lambda pair: pair[0]))


def _point(series: str, parameter: str, value: float, runs: Sequence[Run]) -> ParetoPoint:
    mean = method_runs(runs).mean
    return ParetoPoint(
        series=series,
        parameter=parameter,
        value=value,
        energy_cost=mean.energy_cost,
        mean_temperature_deviation=mean.mean_temperature_deviation,
        runs=len(runs),
        schedules=tuple(run.schedule for run in runs if run.schedule is not None),
    )
