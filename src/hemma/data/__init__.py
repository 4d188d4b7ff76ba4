"""Traces: readers of foreign formats, tariffs, and the embedded data set."""

from hemma.data.canonical import read_canonical, write_canonical
from hemma.data.embedded import AUSTIN2021_HOMES, load_austin2021
from hemma.data.pecan_street import (
    PecanStreetHome,
    PecanStreetOptions,
    list_pecan_street_homes,
    read_pecan_street,
)
from hemma.data.quality import report_quality
from hemma.data.tariff import Tariff
from hemma.data.time_of_use import TimeOfUse
from hemma.data.traces import Split, Traces, split

__all__ = [
    "AUSTIN2021_HOMES",
    "PecanStreetHome",
    "PecanStreetOptions",
    "Split",
    "Tariff",
    "TimeOfUse",
    "Traces",
    "list_pecan_street_homes",
    "load_austin2021",
    "read_canonical",
    "read_pecan_street",
    "report_quality",
    "split",
    "write_canonical",
]
