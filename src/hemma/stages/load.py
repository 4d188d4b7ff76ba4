"""Stage: load the traces that an experiment runs on."""

from collections.abc import Sequence
from pathlib import Path

from hemma.data import Traces, load_austin2021
from hemma.data.canonical import read_canonical
from hemma.settings.experiment import Experiment
from hemma.stages.case import scale_pv


def embedded_homes(experiment: Experiment, homes: Sequence[int]) -> tuple[Traces, ...]:
    """Homes of the embedded data set, with the experiment's tariff and PV scale."""
    return tuple(
        load_austin2021(home, tariff=experiment.tariff, pv_scale=experiment.pv_scale) for home in homes
    )


def own_home(experiment: Experiment, file: Path) -> tuple[Traces, ...]:
    """The home of a canonical trace file, named after the file.

    Its prices are those of the file; the tariff's selling ratio stands in where it has no selling price.
    """
    traces = read_canonical(file, selling_ratio=experiment.tariff.selling_ratio)
    return (scale_pv(traces, experiment.pv_scale),)
