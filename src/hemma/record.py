"""What all records that are written to JSON and read from it share."""

import math
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict


def _finite_or_none(value: Any) -> Any:
    """JSON has no NaN: a metric that is undefined comes as null, as NaN or as an infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _both_or_none(value: Any) -> Any:
    if isinstance(value, list | tuple) and any(_finite_or_none(bound) is None for bound in value):
        return None
    return value


Number = Annotated[float | None, BeforeValidator(_finite_or_none)]
"""A metric, or None where it is undefined."""
Range = Annotated[tuple[float, float] | None, BeforeValidator(_both_or_none)]
"""Low and high end of a 95 % interval, or None where there is none."""


class Record(BaseModel):
    """Frozen; unknown keys of later versions are left alone."""

    model_config = ConfigDict(frozen=True, extra="ignore", populate_by_name=True)
