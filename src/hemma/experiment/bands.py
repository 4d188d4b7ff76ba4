"""Other comfort bands: the same home, whose expert aims a little warmer or cooler."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import equinox as eqx

from hemma.experiment.demonstrate import Expert
from hemma.experiment.fingerprint import fingerprint
from hemma.home import ComfortBand, Home


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
