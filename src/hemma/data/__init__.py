"""Traces: readers of foreign formats, tariffs, and the embedded data set."""

from hemma.data.canonical import read_canonical, write_canonical
from hemma.data.embedded import AUSTIN2021_HOMES, load_austin2021
from hemma.data.quality import report_quality
from hemma.data.tariff import Tariff
from hemma.data.traces import Split, Traces, split

__all__ = [
    "AUSTIN2021_HOMES",
    "Split",
    "Tariff",
    "Traces",
    "load_austin2021",
    "read_canonical",
    "report_quality",
    "split",
    "write_canonical",
]
