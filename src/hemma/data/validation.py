"""From a log as somebody wrote it to traces: repairs are reported, what cannot be repaired is refused."""

from dataclasses import dataclass, replace

import numpy as np

from hemma.data.clock import Clock, duration, require_whole_days, runs
from hemma.data.columns import OPTIONAL, REQUIRED, Columns, Series
from hemma.data.gaps import fill_gaps
from hemma.data.plausibility import oddities, require_plausible
from hemma.data.tariff import require_ratio
from hemma.data.traces import Traces
from hemma.errors import HemmaError
from hemma.types import Exogenous


@dataclass(frozen=True)
class Log:
    """What a reader found, on a regular clock."""

    name: str
    """Of the home."""
    file: str
    """Where a person finds what the messages speak of: the path."""
    columns: Columns
    """All that are required; their notes say what the reader already repaired."""
    sha256: str
    source: str
    """One plain sentence."""


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
    columns, clock = _in_order(log.columns), log.columns.clock
    require_whole_days(clock, log.file)
    require_plausible(log.file, columns)
    magnitudes, clipped = _without_noise(log.file, columns, repairs)
    columns = fill_gaps(log.file, replace(columns, series=magnitudes), repairs.longest_gap)
    series, supposed = columns.series, []
    selling_price = series.get("sell_per_kwh")
    if selling_price is None:
        supposed.append(f"sell_per_kwh is not given: {repairs.selling_ratio:g} of buy_per_kwh is assumed")
        selling_price = repairs.selling_ratio * series["buy_per_kwh"]
    traces = Traces(
        name=log.name,
        clock=clock,
        exogenous=Exogenous(
            pv_generation=series["pv_kw"],
            load=series["load_kw"],
            outdoor_temperature=series["outdoor_c"],
            buying_price=series["buy_per_kwh"],
            selling_price=selling_price,
            hour_of_day=clock.hour_of_day(),
        ),
        indoor_temperature=series.get("indoor_c"),
        hvac_power=series.get("hvac_kw"),
        sha256=log.sha256,
        source=log.source,
    )
    return replace(traces, notes=(*columns.notes, *clipped, *supposed, *oddities(traces, columns)))


def _in_order(columns: Columns) -> Columns:
    known = columns.series
    return replace(columns, series={name: known[name] for name in (*REQUIRED, *OPTIONAL) if name in known})


def _without_noise(file: str, columns: Columns, repairs: Repairs) -> tuple[dict[str, Series], list[str]]:
    """PV, load and HVAC are magnitudes: noise below 0 becomes 0, more than noise is refused."""
    clock, magnitudes, notes, problems = columns.clock, dict(columns.series), [], []
    for name, series in columns.series.items():
        if not name.endswith("_kw") or not (series < 0).any():
            continue
        wrong = series < -repairs.noise
        if wrong.any():
            problems.append(_negative(clock, name, series, wrong))
        length = duration(int((series < 0).sum()) * clock.slot_length)
        notes.append(f"{length} of {name} just below zero (lowest {np.nanmin(series):.3g} kW) set to 0")
        magnitudes[name] = np.where(series < 0, 0.0, series)
    if problems:
        raise HemmaError(
            f"{file}: expected magnitudes, at least 0: {'; '.join(problems)}. If PV or export is counted "
            "negative turn the sign; if the meter failed empty these cells"
        )
    return magnitudes, notes


def _negative(clock: Clock, name: str, series: np.ndarray, wrong: np.ndarray) -> str:
    worst = int(np.nanargmin(series))
    return (
        f"{name} is negative in {duration(int(wrong.sum()) * clock.slot_length)} ({len(runs(wrong))} times), "
        f"lowest {series[worst]:.4g} kW at {clock.text(worst)}"
    )
