"""One results folder in, its figures and its report out."""

from pathlib import Path

from hemma.checkpoint import write_atomically
from hemma.report.page.page import report_page
from hemma.report.pictures import draw_all
from hemma.results.results import load_results


def write_report(folder: Path, week: int = 1) -> Path:
    """Write ``figures/*.png``, ``figures/*.svg`` and ``report.html`` into a results folder.

    ``week`` is the week of the test period that the figures over time show, counted from 1. Reads only
    files of that folder and nothing but what ``results.json`` names. Returns the path of the report. Raises
    ``HemmaError`` naming the file that is missing, foreign or broken, or the week that the test period does
    not have; nothing that was there is removed.
    """
    results = load_results(folder)
    pictures = draw_all(folder, results, week)
    path = folder / "report.html"
    write_atomically(path, report_page(results, pictures).encode())
    return path
