"""The main job: one frozen experiment and some traces in, one results folder out."""

from hemma.experiment.load import embedded_homes, own_home
from hemma.experiment.progress import Progress, Silence
from hemma.experiment.run import Job, Stage, run
from hemma.experiment.settings import DataEfficiency, Experiment, quick
from hemma.experiment.settings_file import read_settings, settings_text

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
