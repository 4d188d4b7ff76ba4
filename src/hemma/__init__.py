"""Hemma: home energy management that learns from an optimiser.

The names below are all that a notebook needs; each is loaded when it is first used.

    import hemma
    [home] = hemma.embedded_homes(hemma.Experiment(), (1,))
    hemma.run(hemma.Job(hemma.quick(hemma.Experiment()), (home,), pathlib.Path("results")))
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from hemma.data import Split, Traces, read_canonical, split
    from hemma.errors import HemmaError
    from hemma.evaluation import Outcome, evaluate, measure
    from hemma.experiment import Job, Stage, embedded_homes, own_home, quick, read_settings, run
    from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Home, Hvac, Schedule, replay
    from hemma.methods import METHODS
    from hemma.optimisation.optimum import optimum_problem
    from hemma.results.results import Results, load_results
    from hemma.rl.loading import load_controllers
    from hemma.settings.experiment import Experiment
    from hemma.types import Action, Costs, Exogenous, Observation

_PLACES = {
    "hemma.data": ("Split", "Traces", "read_canonical", "split"),
    "hemma.errors": ("HemmaError",),
    "hemma.evaluation": ("Outcome", "evaluate", "measure"),
    "hemma.experiment": ("Job", "Stage", "embedded_homes", "own_home", "quick", "read_settings", "run"),
    "hemma.home": ("Battery", "ComfortBand", "ExplicitThermalModel", "Home", "Hvac", "Schedule", "replay"),
    "hemma.methods": ("METHODS",),
    "hemma.optimisation.optimum": ("optimum_problem",),
    "hemma.results.results": ("Results", "load_results"),
    "hemma.rl.loading": ("load_controllers",),
    "hemma.settings.experiment": ("Experiment",),
    "hemma.types": ("Action", "Costs", "Exogenous", "Observation"),
}
_MODULES = {name: module for module, names in _PLACES.items() for name in names}

__all__ = [
    "METHODS",
    "Action",
    "Battery",
    "ComfortBand",
    "Costs",
    "Exogenous",
    "Experiment",
    "ExplicitThermalModel",
    "HemmaError",
    "Home",
    "Hvac",
    "Job",
    "Observation",
    "Outcome",
    "Results",
    "Schedule",
    "Split",
    "Stage",
    "Traces",
    "embedded_homes",
    "evaluate",
    "load_controllers",
    "load_results",
    "measure",
    "optimum_problem",
    "own_home",
    "quick",
    "read_canonical",
    "read_settings",
    "replay",
    "run",
    "split",
]


def __getattr__(name: str) -> Any:
    """Load a public name."""
    if name not in _MODULES:
        raise AttributeError(f"module 'hemma' has no attribute '{name}'")
    return getattr(import_module(_MODULES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
