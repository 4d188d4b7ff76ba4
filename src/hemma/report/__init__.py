"""Figures and the HTML report, from a results folder alone."""

from hemma.report.report import write_report
from hemma.report.tables.cells import Cell
from hemma.report.tables.results import TableRow, results_table

__all__ = ["Cell", "TableRow", "results_table", "write_report"]
