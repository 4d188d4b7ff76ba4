"""What all records that are written to JSON and read from it share."""

import math
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

MOST = 1e100
"""No number of a home is as large; sums and squares of such numbers are still numbers."""


def _finite_or_none(value: Any) -> Any:
    """JSON has no NaN: a metric that is undefined comes as null, as NaN or as an infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _both_or_none(value: Any) -> Any:
    if isinstance(value, list | tuple) and any(_finite_or_none(bound) is None for bound in value):
        return None
    return value


def _ordered(ends: tuple[float, float]) -> tuple[float, float]:
    if ends[0] > ends[1]:
        raise ValueError("the low end should come first")
    return ends


Finite = Annotated[float, Field(ge=-MOST, le=MOST)]
"""A number that must be there."""
Number = Annotated[Finite | None, BeforeValidator(_finite_or_none)]
"""A metric, or None where it is undefined."""
Band = Annotated[tuple[Finite, Finite], AfterValidator(_ordered)]
"""Low and high end."""
Range = Annotated[Band | None, BeforeValidator(_both_or_none)]
"""Low and high end of a 95 % interval, or None where there is none."""


class Record(BaseModel):
    """Frozen; unknown keys of later versions are left alone."""

    model_config = ConfigDict(frozen=True, extra="ignore", populate_by_name=True)
