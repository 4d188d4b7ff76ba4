"""The table again under faults: what was trained under good conditions meets bad ones."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import equinox as eqx
import jax
import numpy as np

from hemma.control.rolling import rolling_mpc
from hemma.control.sensors import SafetyLayer, WatchedStep, watched_replay
from hemma.evaluation import Outcome, measure
from hemma.evaluation.replay import outcome_of
from hemma.forecasting.outlook import Outlook
from hemma.home import Controller
from hemma.home.precision import in_double, in_numpy
from hemma.methods import controls
from hemma.methods.measured import runnable
from hemma.methods.method import AbstractControl, Known
from hemma.methods.planners import AbstractPlanner
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.record import Number, Range
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.results.summary import intervals, means, summarised
from hemma.rl.policies.scaling import NOTHING, Context
from hemma.stages.demonstrate import Expert
from hemma.stages.evaluate import at_equal_comfort
from hemma.stages.folds import outlook_of
from hemma.stages.sight import informed
from hemma.stages.train import Trained
from hemma.studies.robustness.faults import Fault, FaultSettings, faults
from hemma.studies.robustness.records import FaultMeasures, FaultMethod, FaultRun, MetFault
from hemma.studies.robustness.scenes import Scene, scene

STAGE = "robustness"
FOREIGN = Fault(
    "controllers of another home",
    "trained, fitted and identified in the next home; the last home has those of the first",
    lambda scene, _: scene,
)
"""Nothing is wrong with this home but that its controllers have never seen it."""
SEED = 0
"""Of what goes wrong; the same for all methods, so that they can be compared."""


@dataclass(frozen=True)
class Trial:
    """Lets the methods of one home meet every fault in its test period."""

    expert: Expert
    store: Store
    trained: dict[str, Trained]
    """Learned methods by name. Of the others, all take part that know no future."""

    def results(self, neighbour: "Trial | None" = None) -> tuple[MetFault, ...]:
        """One entry a fault, nothing wrong first, what a ``neighbour``'s methods do in this home last."""
        met: list[tuple[Fault, Trial]] = [(fault, self) for fault in faults(self._settings)]
        if neighbour is not None:
            met.append((FOREIGN, neighbour))
        self.store.progress.started(STAGE, len(met))
        found = []
        for number, (fault, actor) in enumerate(met):
            found.append(self._kept(fault, actor))
            self.store.progress.advanced(STAGE, number + 1, fault.name)
        self.store.progress.finished(STAGE, f"{len(met)} faults")
        return tuple(found)

    @property
    def _settings(self) -> FaultSettings:
        return self.expert.case.experiment.faults

    @property
    def _marks(self) -> list[Any]:
        """Fingerprints of all that the controllers depend on."""
        learned = sorted((name, one.mark) for name, one in self.trained.items())
        facts = [(method.name, method.facts(self._known)) for method in self._controls]
        return [self.expert.mark, learned, facts, self.expert.case.experiment.forecast_horizon]

    def _kept(self, fault: Fault, actor: "Trial") -> MetFault:
        layers = code(
            "evaluation", "forecasting", "optimisation", "control", "rl", "home", "stages", "studies"
        )
        mark = fingerprint(STAGE, layers, self._marks, self._settings, fault.name, actor._marks)
        product = f"{STAGE}-{fault.name.replace(' ', '-')}"
        content = self.store.kept(product, mark)
        if content is None:
            case = self.expert.case
            now = fault.happen(scene(case.home, case.test), np.random.default_rng(SEED))
            met = MetFault(
                fault=fault.name,
                meaning=fault.meaning,
                repaired_readings=now.repaired,
                methods={method: _together(runs) for method, runs in actor.runs(now).items()},
            )
            self.store.keep(product, mark, [], met.model_dump(mode="json"))
            return met
        return MetFault.model_validate(content)

    def runs(self, now: Scene) -> dict[str, list[FaultRun]]:
        """What the methods that learned in this home do in a scene, be it of another one."""
        problem = optimum_problem(now.home, now.exogenous, disturbances=now.readings.disturbance)
        runs: dict[str, list[FaultRun]] = {}
        for method in self._controls:
            if isinstance(method, AbstractPlanner):
                runs[method.name] = [self._planned(method, now, problem)]
            else:
                controller = method.controller(self._known)
                runs[method.name] = [self._watched(None, controller, now, problem)]
        for method, one in self.trained.items():
            controllers = informed(one.controllers, self._seen(one, now))
            for seed in range(min(one.runs, self._settings.runs)):
                controller = jax.tree.map(lambda x, seed=seed: x[seed], controllers)
                runs.setdefault(method, []).append(self._watched(seed, controller, now, problem))
        return runs

    def _seen(self, one: Trained, now: Scene) -> Context:
        """What a learned method sees besides the paper's state, as it is read."""
        if one.sight is None:
            return NOTHING
        case = self.expert.case
        return one.sight.over(case.training, now.readings.exogenous, case.parts.test.weekdays())

    @cached_property
    def _known(self) -> Known:
        return Known(self.expert, self.store, outlook_of(self.expert.case))

    @cached_property
    def _controls(self) -> list[AbstractControl]:
        return runnable(tuple(method for method in controls() if method.is_causal), self._known)

    def _watched(
        self, seed: int | None, controller: Controller, now: Scene, problem: OptimumProblem
    ) -> FaultRun:
        safety = SafetyLayer(self.expert.planning_home, self._settings.margin, self._settings.adapts)
        with jax.enable_x64(True):
            inputs = in_double((now.home, now.exogenous, controller, now.readings, safety, jax.random.key(0)))
            watched = in_numpy(_replayed(*inputs))
        changes = watched.interventions
        counts = (int(np.sum(np.asarray(changes.limited))), int(np.sum(np.asarray(changes.comfort))))
        return _judged(seed, outcome_of(watched.step), problem, counts)

    def _planned(self, planner: AbstractPlanner, now: Scene, problem: OptimumProblem) -> FaultRun:
        case = self.expert.case
        outlook = Outlook(
            case.training,
            now.readings.exogenous,
            float(case.home.slot_length),
            case.experiment.forecast_horizon,
        )
        forecasts = planner.forecaster(self._known)(outlook)
        path = rolling_mpc(
            self.expert.planning_home,
            now.home,
            now.exogenous,
            forecasts,
            now.readings,
            adapts=self._settings.adapts,
        )
        return _judged(None, outcome_of(path.steps), problem, None)


@eqx.filter_jit
def _replayed(home, exogenous, controller, readings, safety, key) -> WatchedStep:
    return watched_replay(home, exogenous, controller, readings, safety, key)


def _judged(
    seed: int | None, outcome: Outcome, problem: OptimumProblem, counts: tuple[int, int] | None
) -> FaultRun:
    """Its measures; perfect information knows the changed home, and what will disturb it."""
    reference = at_equal_comfort(problem, outcome.total_deviation)
    return FaultRun(
        **measure(outcome, reference).model_dump(),
        max_temperature_deviation=float(np.max(outcome.temperature_deviation)),
        seed=seed,
        limited=None if counts is None else counts[0],
        comfort_overrides=None if counts is None else counts[1],
    )


def _together(runs: Sequence[FaultRun]) -> FaultMethod:
    summaries = summarised(runs, FaultMeasures)
    return FaultMethod(
        runs=tuple(runs),
        mean=means(FaultMeasures[Number], summaries),
        interval=intervals(FaultMeasures[Range], summaries),
    )
