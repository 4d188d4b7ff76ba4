"""Stage: the methods that are not learned by trial, from the thermostat to perfect information."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import jax

from hemma.control.comfort import ComfortHold
from hemma.control.rule import Rule
from hemma.control.thresholds import fit_thresholds
from hemma.evaluation import evaluate
from hemma.home import Controller, Schedule
from hemma.optimisation.joint import joint_hmpc
from hemma.optimisation.nonlinear import nonlinear_optimum
from hemma.optimisation.nonlinear_programme import casadi_is_installed
from hemma.results.fingerprint import fingerprint
from hemma.results.records import Optimum, Run
from hemma.stages.case import Case
from hemma.stages.demonstrate import Expert
from hemma.stages.judge import CODE, Judge, Played
from hemma.stages.planners import planners, played_by

STAGE = "baselines"


@dataclass(frozen=True)
class References:
    """Measures the methods of this stage on one home."""

    judge: Judge
    expert: Expert

    def methods(self) -> dict[str, tuple[Run, ...]]:
        """All of them."""
        return {**self._plain(), **self._planned(), **self._hindsight()}

    def _plain(self) -> dict[str, tuple[Run, ...]]:
        case = self._case
        believed = self.expert.planning_home
        return {
            "Rule": self._runs("Rule", self._mark, lambda: Rule(case.home.hvac, case.home.comfort)),
            "no battery": self._runs("no battery", self.expert.mark, lambda: ComfortHold(believed)),
            "thresholds": self._runs(
                "thresholds", self.expert.mark, lambda: fit_thresholds(believed, case.training)
            ),
        }

    def _planned(self) -> dict[str, tuple[Run, ...]]:
        """Every rolling planner, through the identified network."""
        return {
            planner.method: played_by(planner, self.judge, self.expert)
            for planner in planners(self.expert, self.judge.store)
        }

    def _hindsight(self) -> dict[str, tuple[Run, ...]]:
        case, expert, progress = self._case, self.expert, self.judge.store.progress
        made = {
            "HMPC": self._runs("HMPC", expert.mark, lambda: Schedule(expert.plan(case.test))),
            "HMPC joint": self._runs("HMPC joint", expert.mark, self._joint),
            "optimum": self._runs(
                "optimum", self._mark, lambda: Schedule(self.judge.problem.solve().actions)
            ),
        }
        if not casadi_is_installed():
            progress.noticed("DNLP is left out: it needs CasADi, pip install 'hemma[nlp]'")
            return made
        dnlp = self._runs(
            "DNLP", self._mark, lambda: Schedule(nonlinear_optimum(case.home, case.test).actions)
        )
        return {**made, "DNLP": dnlp}

    def _joint(self) -> Controller:
        found = joint_hmpc(self.expert.planning_home, self._case.home, self._case.test)
        return Schedule(found.steps.action)

    @property
    def _case(self) -> Case:
        return self.judge.case

    @property
    def _mark(self) -> str:
        return fingerprint(STAGE, self._case.mark)

    def _runs(self, method: str, mark: str, controller: Callable[[], Controller]) -> tuple[Run, ...]:
        def play() -> Sequence[Played]:
            outcome = evaluate(self._case.home, self._case.test, controller(), jax.random.key(0))
            return [Played(outcome)]

        return self.judge.judged(method, mark, play)


def plain_optimum(judge: Judge) -> Optimum:
    """Perfect information with the least reachable deviation, and its proof."""
    mark = fingerprint("optimum", CODE, judge.case.mark)
    content = judge.store.kept("optimum", mark)
    if content is not None:
        return Optimum.model_validate(content)
    found = judge.problem.solve()
    optimum = Optimum(
        energy_cost=found.cost,
        mean_temperature_deviation=found.deviation / judge.case.test.slots,
        bound=found.bound,
        relative_gap=found.gap,
    )
    judge.store.keep("optimum", mark, [], optimum.model_dump(mode="json"))
    return optimum
