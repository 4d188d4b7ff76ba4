"""Stage: the expert's demonstrations on the first training days, and its schedule for the test period."""

import time
from dataclasses import dataclass

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from hemma.home import Home
from hemma.optimisation.demonstrations import (
    Demonstrations,
    TracesOrigin,
    demonstrate,
    load_demonstrations,
    save_demonstrations,
)
from hemma.optimisation.hierarchy import run_hierarchy
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.task import Demonstrated
from hemma.stages.case import Case
from hemma.stages.identify import IdentifiedBuilding
from hemma.types import Action, Exogenous, PaperState

STAGE = "demonstrate"
INDOOR = PaperState.INDOOR_TEMPERATURE
"""Position of T_in in the paper's state."""


@dataclass(frozen=True)
class Demonstration:
    """The product of the stage: what a learner gets to see of the expert."""

    days: int
    """Length, from the first training day on."""
    demonstrated: Demonstrated
    mark: str


@dataclass(frozen=True)
class Expert:
    """HMPC: plans through the identified network, acts on the simulated home."""

    case: Case
    identification: IdentifiedBuilding
    variant: str = ""
    """Ends the names of the files of an expert that aims at another comfort band."""

    @property
    def mark(self) -> str:
        """Fingerprint of all that the expert's decisions depend on besides the period."""
        settings = self.case.experiment.expert
        return fingerprint("expert", code("optimisation"), self.identification.mark, self.case.mark, settings)

    @property
    def planning_home(self) -> Home:
        """The home as the expert believes it to be."""
        return eqx.tree_at(lambda home: home.thermal_model, self.case.home, self.identification.model)

    def plan(self, exogenous: Exogenous) -> Action:
        """Its schedule over a period in hindsight, as carried out without thermal disturbance."""
        quiet = eqx.tree_at(lambda home: home.disturbance_deviation, self.case.home, 0.0)
        run = run_hierarchy(self.planning_home, quiet, exogenous, self.case.experiment.expert)
        return run.trajectory.steps.action

    def demonstrations(self, days: int, store: Store) -> Demonstrations:
        """Its transitions over the first ``days`` days of the training period, which is all it knows then."""
        exogenous = self.case.first_days(days)
        stamps = self.case.parts.training.time_stamps()
        origin = TracesOrigin(
            self.case.name, self.case.traces.sha256, start=stamps[0], stop=stamps[exogenous.slots - 1]
        )
        store.progress.started(STAGE, exogenous.slots)
        return demonstrate(
            self.planning_home,
            self.case.home,
            exogenous,
            self.case.experiment.expert,
            origin,
            lambda done, _: store.progress.advanced(STAGE, done, f"{days} days"),
        )


def demonstration(store: Store, expert: Expert, days: int) -> Demonstration:
    """Let the expert demonstrate ``days`` days, or take what it demonstrated in an earlier run."""
    mark = fingerprint(STAGE, expert.mark, days)
    product = f"demonstrations-{days}-days{expert.variant}"
    file = store.model(f"{product}.safetensors")

    def make() -> tuple[dict, list[str]]:
        begun = time.monotonic()
        shown = expert.demonstrations(days, store)
        save_demonstrations(store.folder / file, shown)
        deviation = np.mean(expert.case.home.comfort.deviation(shown.next_states[:, INDOOR]))
        message = f"{days} days, {shown.samples} transitions, mean deviation {float(deviation):.3f} °C"
        store.progress.finished(STAGE, message)
        return {"message": message, "seconds": time.monotonic() - begun}, [file]

    store.product(product, mark, make, STAGE)
    kept = load_demonstrations(store.folder / file)
    arrays = (jnp.asarray(a, float) for a in (kept.states, kept.actions, kept.next_states))
    return Demonstration(days, Demonstrated(*arrays), mark)
