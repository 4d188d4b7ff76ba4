"""The table again under faults: what was trained under good conditions meets bad ones."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import jax
import numpy as np

from hemma.control.estimation import StateEstimator
from hemma.control.safety import Interventions, SafetyLayer
from hemma.control.sensors import Sensors
from hemma.evaluation import measure
from hemma.evaluation.replay import outcome_of
from hemma.home import AbstractController, Trajectory, replay_in_double
from hemma.methods import controls
from hemma.methods.measured import runnable
from hemma.methods.method import AbstractControl, Known
from hemma.optimisation.optimum import OptimumProblem, optimum_problem
from hemma.record import Number, Range
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.results.summary import intervals, means, summarised
from hemma.rl.policies.scaling import NOTHING, Context
from hemma.stages.demonstrate import Expert
from hemma.stages.evaluate import at_equal_comfort
from hemma.stages.folds import outlook_of
from hemma.stages.observer import informed
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

        def make() -> tuple[dict, list[str]]:
            case = self.expert.case
            now = fault.happen(scene(case.home, case.test), np.random.default_rng(SEED))
            met = MetFault(
                fault=fault.name,
                meaning=fault.meaning,
                repaired_readings=now.repaired,
                methods={method: _together(runs) for method, runs in actor.runs(now).items()},
            )
            return met.model_dump(mode="json"), []

        return MetFault.model_validate(self.store.product(product, mark, make))

    def runs(self, now: Scene) -> dict[str, list[FaultRun]]:
        """What the methods that learned in this home do in a scene, be it of another one."""
        problem = optimum_problem(now.home, now.exogenous, disturbances=now.readings.disturbance)
        known = replace(self._known, outlook=replace(self._known.outlook, period=now.readings.exogenous))
        runs: dict[str, list[FaultRun]] = {}
        for method in self._controls:
            controller = method.controller(known)
            if method.is_guarded:
                runs[method.name] = [self._guarded(None, controller, now, problem)]
            else:
                runs[method.name] = [_evaluated(None, self._run(controller, now), problem)]
        for method, one in self.trained.items():
            controllers = informed(one.controllers, self._seen(one, now))
            for seed in range(min(one.runs, self._settings.runs)):
                controller = jax.tree.map(lambda x, seed=seed: x[seed], controllers)
                runs.setdefault(method, []).append(self._guarded(seed, controller, now, problem))
        return runs

    def _seen(self, one: Trained, now: Scene) -> Context:
        """What a learned method sees besides the paper's state, as it is read."""
        if one.observer is None:
            return NOTHING
        case = self.expert.case
        return one.observer.over(case.training, now.readings.exogenous, case.parts.test.weekdays())

    @cached_property
    def _known(self) -> Known:
        """What methods may go by where nothing is wrong."""
        return Known(self.expert, self.store, outlook_of(self.expert.case))

    @cached_property
    def _controls(self) -> list[AbstractControl]:
        return runnable(tuple(method for method in controls() if method.is_causal), self._known)

    def _guarded(
        self, seed: int | None, controller: AbstractController, now: Scene, problem: OptimumProblem
    ) -> FaultRun:
        """Behind a safety layer."""
        safety = SafetyLayer(controller, self.expert.planning_home, self._settings.margin)
        path = self._run(safety, now)
        return _evaluated(seed, path, problem, path.memory.inner.inner.own)

    def _run(self, controller: AbstractController, now: Scene) -> Trajectory:
        """By what the sensors say."""
        estimator = StateEstimator(controller, self.expert.planning_home, self._settings.adapts)
        sensors = Sensors(estimator, now.readings, now.home.battery)
        return replay_in_double(now.home, now.exogenous, sensors, disturbances=now.readings.disturbance)


def _evaluated(
    seed: int | None, path: Trajectory, problem: OptimumProblem, changed: Interventions | None = None
) -> FaultRun:
    """Its measures; perfect information knows the changed home, and what will disturb it."""
    outcome = outcome_of(path.steps)
    reference = at_equal_comfort(problem, outcome.total_deviation)
    return FaultRun(
        **measure(outcome, reference).model_dump(),
        max_temperature_deviation=float(np.max(outcome.temperature_deviation)),
        seed=seed,
        limited=None if changed is None else int(changed.limited),
        comfort_overrides=None if changed is None else int(changed.comfort),
    )


def _together(runs: Sequence[FaultRun]) -> FaultMethod:
    summaries = summarised(runs, FaultMeasures)
    return FaultMethod(
        runs=tuple(runs),
        mean=means(FaultMeasures[Number], summaries),
        interval=intervals(FaultMeasures[Range], summaries),
    )
