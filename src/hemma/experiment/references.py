"""Stage: the methods that are not learned, from the thermostat to perfect information."""

from collections.abc import Callable, Sequence
from dataclasses import asdict

import jax

from hemma.baselines.comfort import ComfortHold
from hemma.baselines.rule import Rule
from hemma.evaluation import evaluate
from hemma.experiment.case import Case
from hemma.experiment.demonstrate import Expert
from hemma.experiment.fingerprint import fingerprint
from hemma.experiment.judge import CODE, Judge, Played
from hemma.experiment.results import MethodResults, PlainOptimum
from hemma.home import Controller, Schedule

STAGE = "baselines"


def references(case: Case, judge: Judge, expert: Expert) -> tuple[MethodResults, ...]:
    """Rule, no battery, the expert in hindsight on the test period, and the optimum."""

    def controlled(controller: Callable[[], Controller]) -> Callable[[], Sequence[Played]]:
        return lambda: [Played(evaluate(case.home, case.test, controller(), jax.random.key(0)))]

    def optimum() -> Controller:
        return Schedule(judge.problem.solve().actions)

    def hindsight() -> Controller:
        return Schedule(expert.plan(case.test))

    def result(method: str, mark: str, controller: Callable[[], Controller]) -> MethodResults:
        return MethodResults(method, judge.judged(method, mark, controlled(controller)))

    mark = fingerprint(STAGE, case.mark)
    return (
        result("Rule", mark, lambda: Rule(case.home.hvac, case.home.comfort)),
        result("no battery", mark, lambda: ComfortHold(case.home)),
        result("HMPC", expert.mark, hindsight),
        result("optimum", mark, optimum),
    )


def plain_optimum(case: Case, judge: Judge) -> PlainOptimum:
    """Perfect information with the least reachable deviation, and its proof."""
    mark = fingerprint("optimum", CODE, case.mark)
    content = judge.store.kept("optimum", mark)
    if content is not None:
        return PlainOptimum(**content)
    found = judge.problem.solve()
    optimum = PlainOptimum(
        energy_cost=found.cost,
        mean_temperature_deviation=found.deviation / case.test.slots,
        bound=found.bound,
        relative_gap=found.gap,
    )
    judge.store.keep("optimum", mark, [], asdict(optimum))
    return optimum
