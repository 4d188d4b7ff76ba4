"""What a file holds, in plain lines for people."""

import numpy as np

from hemma.data.clock import duration
from hemma.data.traces import Traces
from hemma.types import Array


def report_quality(traces: Traces) -> list[str]:
    """Source, span, totals [kWh], ranges and everything that was repaired or found odd, one line each."""
    e = traces.exogenous
    stamps = traces.time_stamps()
    days = traces.slots * traces.slot_length / 24
    lines = [
        f"{traces.name}: {traces.source}",
        f"{stamps[0]} to {stamps[-1]}: {days:.1f} days, {traces.slots} slots of "
        f"{duration(traces.slot_length)}, none missing",
        _power("PV", e.pv_generation, traces),
        _power("load", e.load, traces),
        _range("outdoor temperature", e.outdoor_temperature, "degC"),
        _range("buying price", e.buying_price, "per kWh"),
        _range("selling price", e.selling_price, "per kWh"),
    ]
    if traces.indoor_temperature is not None:
        lines.append(_range("indoor temperature", traces.indoor_temperature, "degC"))
    if traces.hvac_power is not None:
        lines.append(_power("HVAC", traces.hvac_power, traces))
    if traces.indoor_temperature is None or traces.hvac_power is None:
        lines.append(
            "no logged indoor temperature with HVAC power: no thermal model can be identified from it"
        )
    lines += [f"note: {note}" for note in traces.notes]
    return [*lines, f"sha256 {traces.sha256}"]


def _power(what: str, power: Array, traces: Traces) -> str:
    energy = power.sum() * traces.slot_length
    share = 100 * np.mean(power > 0)
    return (
        f"{what}: {energy:.1f} kWh in all, at most {power.max():.3g} kW, above zero {share:.0f} % of the time"
    )


def _range(what: str, values: Array, unit: str) -> str:
    return f"{what}: {values.min():.4g} to {values.max():.4g} {unit}, mean {values.mean():.4g}"
