"""The canonical trace file: CSV, one row a slot, start of slot, ISO 8601 with offset."""

import numpy as np

from hemma.data.traces import Traces

REQUIRED = ("time", "pv_kw", "load_kw", "outdoor_c", "buy_per_kwh")
OPTIONAL = ("sell_per_kwh", "indoor_c", "hvac_kw")


def canonical_text(traces: Traces) -> str:
    """The canonical CSV text of traces; numbers in the shortest form that reads back to the same float64."""
    exogenous = traces.exogenous
    columns = {
        "pv_kw": exogenous.pv_generation,
        "load_kw": exogenous.load,
        "outdoor_c": exogenous.outdoor_temperature,
        "buy_per_kwh": exogenous.buying_price,
        "sell_per_kwh": exogenous.selling_price,
        "indoor_c": traces.indoor_temperature,
        "hvac_kw": traces.hvac_power,
    }
    present = {name: np.asarray(series) for name, series in columns.items() if series is not None}
    cells = [traces.time_stamps(), *([repr(x) for x in series.tolist()] for series in present.values())]
    header = ",".join(["time", *present])
    return "\n".join([header, *(",".join(row) for row in zip(*cells, strict=True))]) + "\n"
