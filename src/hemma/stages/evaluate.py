"""Stage: measure a method's runs on the test period, at equal comfort, and write down what they did."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from hemma.evaluation import EqualComfort, Outcome, measure
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import OptimumRecord, Run
from hemma.results.schedules import write_exogenous, write_schedule
from hemma.results.store import Store
from hemma.stages.case import Case

STAGE = "evaluate"
CODE = code("evaluation", "forecasting", "optimisation", "control")


@dataclass(frozen=True)
class Played:
    """One run of a method on the test period."""

    outcome: Outcome
    seed: int | None = None
    seconds_to_train: float | None = None
    curve: str | None = None


@dataclass(frozen=True)
class Evaluator:
    """Measures methods on one home; the perfect-information problem is set up once, when first needed."""

    case: Case
    store: Store

    @cached_property
    def problem(self) -> OptimumProblem:
        """Perfect information over the test period."""
        return optimum_problem(self.case.home, self.case.test)

    def evaluated(self, label: str, mark: str, play: Callable[[], Sequence[Played]]) -> tuple[Run, ...]:
        """The runs of ``label``, which depend on ``mark``: measured now, or kept from an earlier run."""
        mark = fingerprint(STAGE, label, CODE, self.case.mark, mark)
        product = f"{_slug(label)}.runs"

        def make() -> tuple[dict, list[str]]:
            runs = [self._measured(label, played) for played in play()]
            files = [name for run in runs for name in (run.schedule, run.curve) if name is not None]
            return {"runs": [run.model_dump(mode="json") for run in runs]}, files

        return tuple(Run.model_validate(run) for run in self.store.product(product, mark, make)["runs"])

    def write_exogenous(self) -> None:
        """Write what the home did not decide in the test period, beside the schedules."""
        path = self.store.folder / self.store.schedule("exogenous.csv")
        write_exogenous(path, self.case.parts.test.time_stamps(), self.case.test)

    def _measured(self, label: str, played: Played) -> Run:
        file = _slug(label) + (".csv" if played.seed is None else f"-{played.seed}.csv")
        schedule = self.store.schedule(file)
        write_schedule(self.store.folder / schedule, self.case.parts.test.time_stamps(), played.outcome)
        reference = at_equal_comfort(self.problem, played.outcome.total_deviation)
        metrics = measure(played.outcome, reference, played.seconds_to_train)
        return Run(**metrics.model_dump(), seed=played.seed, schedule=schedule, curve=played.curve)


def at_equal_comfort(problem: OptimumProblem, deviation: float) -> EqualComfort:
    """Perfect information with the ``deviation`` [degC in total] that a run itself caused."""
    optimum, no_battery = problem.solve(deviation), problem.solve(deviation, battery=False)
    return EqualComfort(optimum.cost, no_battery.cost, max(optimum.gap, no_battery.gap))


def plain_optimum(evaluator: Evaluator) -> OptimumRecord:
    """Perfect information with the least reachable deviation, and its proof."""
    mark = fingerprint("optimum", CODE, evaluator.case.mark)

    def make() -> tuple[dict, list[str]]:
        found = evaluator.problem.solve()
        optimum = OptimumRecord(
            energy_cost=found.cost,
            mean_temperature_deviation=found.deviation / evaluator.case.test.slots,
            bound=found.bound,
            relative_gap=found.gap,
        )
        return optimum.model_dump(mode="json"), []

    return OptimumRecord.model_validate(evaluator.store.product("optimum", mark, make))


def _slug(label: str) -> str:
    """A file name: ``no battery`` becomes ``no-battery``."""
    return label.replace(" ", "-")
