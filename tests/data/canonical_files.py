"""Synthetic canonical files."""

from datetime import datetime, timedelta

import pytest

from hemma.data import read_canonical
from hemma.errors import HemmaError

HEADER = "time,pv_kw,load_kw,outdoor_c,buy_per_kwh"
FULL = f"{HEADER},sell_per_kwh,indoor_c,hvac_kw"


def stamps(count, step=timedelta(hours=1), first="2021-06-01T00:00:00-06:00"):
    start = datetime.fromisoformat(first)
    return [(start + k * step).isoformat() for k in range(count)]


def sun(stamp):
    return max(0.0, 6.0 - abs(datetime.fromisoformat(stamp).hour + 0.5 - 12.5))


def rows(times):
    return [f"{t},{sun(t)},0.{5 + k % 4},30.{k % 7},0.1{k % 5}" for k, t in enumerate(times)]


def refusal(path, **options):
    with pytest.raises(HemmaError) as caught:
        read_canonical(path, **options)
    return str(caught.value)
