"""One results folder in, its figures and its report out."""

from pathlib import Path

from hemma.checkpoint import write_atomically
from hemma.report.figures import draw_all
from hemma.report.page import report_page
from hemma.report.results import load_results


def write_report(folder: Path) -> Path:
    """Write ``figures/*.png``, ``figures/*.svg`` and ``report.html`` into a results folder.

    Reads only files of that folder and nothing but what ``results.json`` names. Returns the path of the
    report. Raises ``HemmaError`` naming the file that is missing, foreign or broken; nothing that was there
    is removed.
    """
    results = load_results(folder)
    pictures = draw_all(folder, results)
    path = folder / "report.html"
    write_atomically(path, report_page(results, pictures).encode())
    return path
