"""The embedded data set: six modelled homes, measured Austin weather, real wholesale prices, summer 2021."""

import gzip
import hashlib
from dataclasses import replace
from datetime import datetime
from importlib.resources import files

import numpy as np
from jaxtyping import Float

from hemma.data.canonical import canonical_text
from hemma.data.clock import Clock
from hemma.data.tariff import Tariff, require_at_least_zero
from hemma.data.traces import Traces
from hemma.errors import HemmaError
from hemma.types import Exogenous

AUSTIN2021_HOMES = (1, 2, 3, 4, 5, 6)
START = datetime.fromisoformat("2021-06-01T00:00:00-06:00")
SLOTS = 2208
SOURCE = (
    "Modelled home {home} (NREL End-Use Load Profiles, by way of CityLearn) on measured Austin weather, "
    "with real ERCOT day-ahead prices of summer 2021 and an assumed retail tariff."
)
FIRST_HOUR = (
    "indoor_c: the source gives the temperature at the end of each hour; that at the start of the first hour "
    "is not in it, and the first value stands there"
)


PAPER_TARIFF = Tariff()


def load_austin2021(home: int, tariff: Tariff = PAPER_TARIFF, pv_scale: float = 1.0) -> Traces:
    """One home of ``austin2021``: 2,208 hours from 2021-06-01T00:00:00-06:00, with T_in and HVAC power.

    ``pv_scale`` multiplies the PV generation (the homes' own PV is small, 1.2 to 2.8 kW peak). Standard time
    throughout, no daylight saving. Errors: HemmaError for a home that is not there and for bad parameters.
    """
    if home not in AUSTIN2021_HOMES:
        raise HemmaError(
            f"austin2021: expected one of the homes {', '.join(map(str, AUSTIN2021_HOMES))}, got {home}"
        )
    require_at_least_zero("austin2021: pv_scale", pv_scale)
    clock = Clock(round(START.timestamp()), 3600, np.full(SLOTS, -6.0))
    outdoor_temperature, wholesale = _columns("weather_and_prices.csv.gz")
    pv_generation, load, indoor_temperature, hvac_power = _columns(f"home{home}.csv.gz")
    exogenous = Exogenous(
        pv_generation=pv_scale * pv_generation,
        load=load,
        outdoor_temperature=outdoor_temperature,
        buying_price=tariff.buying_price(wholesale),
        selling_price=tariff.selling_price(wholesale),
        hour_of_day=clock.hour_of_day(),
    )
    traces = Traces(
        name=f"austin2021-{home}",
        clock=clock,
        exogenous=exogenous,
        indoor_temperature=indoor_temperature,
        hvac_power=hvac_power,
        sha256="",
        source=SOURCE.format(home=home),
        notes=(FIRST_HOUR,),
    )
    return replace(traces, sha256=hashlib.sha256(canonical_text(traces).encode()).hexdigest())


def _columns(name: str) -> Float[np.ndarray, "columns slots"]:
    """The columns of an embedded file, its time stamps left out: they are ``SLOTS`` hours from ``START``."""
    text = gzip.decompress((files("hemma.data") / "austin2021" / name).read_bytes()).decode()
    rows = [line.split(",")[1:] for line in text.splitlines()[1:]]
    return np.array(rows, float).T
