"""Other comfort bands: the same home, whose expert aims a little warmer or cooler."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import equinox as eqx

from hemma.home import ComfortBand, Home
from hemma.methods.airl import HA_1
from hemma.methods.imitation import demonstrated_task
from hemma.methods.method import AbstractLearner
from hemma.results.fingerprint import fingerprint
from hemma.results.store import Store
from hemma.rl.task import stack
from hemma.stages.demonstrate import Expert, demonstration
from hemma.stages.train import TrainingJob

LABEL = "HA-1-bands"


@dataclass(frozen=True)
class Bands:
    """HA-1 on the demonstrations of each band's expert, all bands and seeds side by side."""

    job: TrainingJob
    """Its runs are sorted by band."""
    limits: tuple[float, ...]
    """The edges that the experts aim at [degC]."""


@dataclass(frozen=True)
class ShiftedBand:
    """The edge of the comfort band at which energy is saved, moved."""

    limit: float
    """T^upp of the expert where the home cools, T^low where it heats [degC]."""
    expert: Expert


def shifted(home: Home, relaxation: float) -> Home:
    """``home`` with a comfort band that is ``relaxation`` [degC] wider (negative: narrower) at that edge."""
    low, high = float(home.comfort.low), float(home.comfort.high)
    if home.hvac.heats:
        band = ComfortBand(min(low - relaxation, high), high)
    else:
        band = ComfortBand(low, max(high + relaxation, low))
    return eqx.tree_at(lambda h: h.comfort, home, band)


def shifted_experts(expert: Expert, relaxations: Sequence[float]) -> tuple[ShiftedBand, ...]:
    """The experts of the moved bands. The building stays as identified: comfort is none of its business."""
    bands = []
    for relaxation in relaxations:
        home = shifted(expert.case.home, relaxation)
        mark = fingerprint("band", expert.case.mark, home.comfort)
        case = replace(expert.case, home=home, mark=mark)
        limit = float(home.comfort.low if home.hvac.heats else home.comfort.high)
        variant = f"-limit-{limit:g}"
        bands.append(ShiftedBand(limit, replace(expert, case=case, variant=variant)))
    return tuple(bands)


def bands_job(expert: Expert, store: Store, methods: Sequence[AbstractLearner]) -> Bands | None:
    """The experts of all moved bands demonstrate, if any are asked for and HA-1 is among the ``methods``."""
    experiment = expert.case.experiment
    bands = shifted_experts(expert, experiment.pareto.relaxations)
    if not bands or HA_1 not in methods:
        return None
    shown = [demonstration(store, band.expert, experiment.demonstration_days) for band in bands]
    tasks = [
        demonstrated_task(band.expert, d, seed)
        for band, d in zip(bands, shown, strict=True)
        for seed in range(experiment.pareto.seeds)
    ]
    basis = fingerprint("bands", [d.mark for d in shown])
    job = TrainingJob(LABEL, HA_1.algorithm(experiment), stack(tasks), basis)
    return Bands(job, tuple(band.limit for band in bands))
