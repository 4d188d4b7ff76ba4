"""From a log as somebody wrote it to traces: repairs are reported, what cannot be repaired is refused."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from hemma.data.clock import Clock, require_whole_days
from hemma.data.gaps import duration, fill_gaps, runs
from hemma.data.plausibility import oddities, require_plausible
from hemma.data.tariff import require_ratio
from hemma.data.traces import Traces
from hemma.errors import HemmaError
from hemma.types import Exogenous


@dataclass(frozen=True)
class Columns:
    """The columns of the canonical file, one value a slot, NaN where a value is missing."""

    pv_kw: Float[np.ndarray, "slots"]
    load_kw: Float[np.ndarray, "slots"]
    outdoor_c: Float[np.ndarray, "slots"]
    buy_per_kwh: Float[np.ndarray, "slots"]
    sell_per_kwh: Float[np.ndarray, "slots"] | None = None
    indoor_c: Float[np.ndarray, "slots"] | None = None
    """At the start of each slot."""
    hvac_kw: Float[np.ndarray, "slots"] | None = None

    def names(self) -> list[str]:
        """Names of the columns that are there."""
        return [field.name for field in fields(self) if getattr(self, field.name) is not None]

    def series(self) -> list[Float[np.ndarray, "slots"]]:
        """The columns that are there, in the order of ``names``."""
        return [getattr(self, name) for name in self.names()]

    def with_series(self, names: Sequence[str], series: Sequence[np.ndarray]) -> "Columns":
        """The same with other values in the named columns."""
        return replace(self, **dict(zip(names, series, strict=True)))


@dataclass(frozen=True)
class Log:
    """What a reader found, on a regular clock."""

    name: str
    """Of the home."""
    file: str
    """Where a person finds what the messages speak of: the path."""
    clock: Clock
    columns: Columns
    sha256: str
    source: str
    """One plain sentence."""
    notes: tuple[str, ...] = ()
    """What the reader already repaired."""


@dataclass(frozen=True)
class Repairs:
    """What is repaired (and reported) rather than refused."""

    longest_gap: float = 1.0
    """Holes of at most this [h] are interpolated."""
    noise: float = 0.05
    """Powers between minus this [kW] and 0 are meter noise and become 0."""
    selling_ratio: float = 0.9
    """Selling price over buying price where there is no column for it."""

    def __post_init__(self):
        """Refuse negative lengths, negative noise and ratios outside [0, 1]."""
        if not (self.longest_gap >= 0 and self.noise >= 0):
            raise HemmaError(
                f"repairs: expected longest_gap and noise of at least 0, got {self.longest_gap} h and "
                f"{self.noise} kW. Correct them"
            )
        require_ratio("selling_ratio", self.selling_ratio)


DEFAULT_REPAIRS = Repairs()


def validated(log: Log, repairs: Repairs = DEFAULT_REPAIRS) -> Traces:
    """The traces of a log; HemmaError if units, signs or holes make it useless."""
    names = log.columns.names()
    require_whole_days(log.clock, log.file)
    require_plausible(log.file, log.clock, names, log.columns.series())
    columns, clipped = _without_noise(log, repairs)
    filled = fill_gaps(log.file, log.clock, names, columns.series(), repairs.longest_gap)
    columns = columns.with_series(names, filled.columns)
    traces = _assembled(log, columns, repairs)
    supposed = (
        ()
        if columns.sell_per_kwh is not None
        else (f"sell_per_kwh is not given: {repairs.selling_ratio:g} of buy_per_kwh is assumed",)
    )
    odd = oddities(traces, log.clock, dict(zip(names, filled.columns, strict=True)))
    return replace(traces, notes=(*log.notes, *filled.notes, *clipped, *supposed, *odd))


def _assembled(log: Log, columns: Columns, repairs: Repairs) -> Traces:
    selling_price = columns.sell_per_kwh
    return Traces(
        name=log.name,
        time=log.clock.index(),
        exogenous=Exogenous(
            pv_generation=columns.pv_kw,
            load=columns.load_kw,
            outdoor_temperature=columns.outdoor_c,
            buying_price=columns.buy_per_kwh,
            selling_price=repairs.selling_ratio * columns.buy_per_kwh
            if selling_price is None
            else selling_price,
            hour_of_day=log.clock.hour_of_day(),
        ),
        indoor_temperature=columns.indoor_c,
        hvac_power=columns.hvac_kw,
        sha256=log.sha256,
        source=log.source,
        utc_offset=log.clock.offset if log.clock.changes_offset() else None,
    )


def _without_noise(log: Log, repairs: Repairs) -> tuple[Columns, tuple[str, ...]]:
    """PV, load and HVAC are magnitudes: noise below 0 becomes 0, more than noise is refused."""
    columns, notes, problems = log.columns, [], []
    for name in ("pv_kw", "load_kw", "hvac_kw"):
        series = getattr(columns, name)
        if series is None or not (series < 0).any():
            continue
        wrong = series < -repairs.noise
        if wrong.any():
            problems.append(_negative(log.clock, name, series, wrong))
        length = duration(int((series < 0).sum()) * log.clock.slot_length)
        notes.append(f"{length} of {name} just below zero (lowest {np.nanmin(series):.3g} kW) set to 0")
        columns = columns.with_series([name], [np.where(series < 0, 0.0, series)])
    if problems:
        raise HemmaError(
            f"{log.file}: expected magnitudes, at least 0: {'; '.join(problems)}. If PV or export is counted "
            "negative turn the sign; if the meter failed empty these cells"
        )
    return columns, tuple(notes)


def _negative(clock: Clock, name: str, series: np.ndarray, wrong: np.ndarray) -> str:
    worst = int(np.nanargmin(series))
    return (
        f"{name} is negative in {duration(int(wrong.sum()) * clock.slot_length)} ({len(runs(wrong))} times), "
        f"lowest {series[worst]:.4g} kW at {clock.text(worst)}"
    )
