"""The main job: one frozen experiment and some traces in, one results folder out."""

from hemma.experiment.run import Job, Stage, run
from hemma.results.progress import Progress, Silence
from hemma.settings.experiment import DataEfficiency, Experiment, quick
from hemma.settings.file import read_settings, settings_text
from hemma.stages.load import embedded_homes, own_home

__all__ = [
    "DataEfficiency",
    "Experiment",
    "Job",
    "Progress",
    "Silence",
    "Stage",
    "embedded_homes",
    "own_home",
    "quick",
    "read_settings",
    "run",
    "settings_text",
]
