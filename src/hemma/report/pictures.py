"""The figures of a results folder: drawn, written to the disk, and handed on with their words."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from hemma.checkpoint import write_atomically
from hemma.report import figures
from hemma.report.drawing.canvas import drawing_style, save
from hemma.report.figures.figure import Picture, ReportFigure
from hemma.report.series import SeriesReader
from hemma.report.subject import read_subject
from hemma.results.results import Results

LIST_FILE = "written-by-report.txt"
"""Names the files that the report wrote into its folder: what it no longer writes, it may remove."""
Subject = TypeVar("Subject")


@dataclass(frozen=True)
class Pictures:
    """All figures of the report by their names; those that the folder has nothing for are left out."""

    homes: dict[str, dict[str, Picture]]
    over_homes: dict[str, Picture]


@dataclass(frozen=True)
class Shelf:
    """The folder of the figures."""

    folder: Path
    written: list[str] = field(default_factory=list)
    """Names of files."""

    def draw(
        self, prefix: str, known: Iterable[ReportFigure[Subject, object]], subject: Subject
    ) -> dict[str, Picture]:
        """Write the figures that the subject has all for as PNG and SVG, ``prefix`` before their names."""
        pictures = {}
        for figure in known:
            if (need := figure.needs(subject)) is not None:
                svg = save(figure.draw(need), self.folder, f"{prefix}{figure.name}")
                pictures[figure.name] = Picture(svg, figure.words(need))
                self.written.extend(f"{prefix}{figure.name}.{ending}" for ending in ("png", "svg"))
        return pictures

    def tidy(self) -> None:
        """Remove what an earlier report wrote and this one did not, and nothing else."""
        path = self.folder / LIST_FILE
        text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
        left = set(text.splitlines()) - set(self.written)
        for file in list(self.folder.iterdir()):
            if file.name in left and file.suffix in (".png", ".svg") and file.is_file():
                file.unlink()
        write_atomically(path, "".join(f"{name}\n" for name in self.written).encode())


def draw_all(folder: Path, results: Results, week: int = 1) -> Pictures:
    """Write the figures of all homes to ``folder``/figures as PNG and SVG.

    One home: each figure under its own name. Several homes: the same with the home's name in front,
    ``results.*`` is that of the first, and the figures over homes begin with ``homes-``. ``week`` counts the
    weeks of the test period from 1.
    """
    reader = SeriesReader(folder)
    subjects = {name: read_subject(reader, name, home, week) for name, home in results.finished.items()}
    prefixes = _prefixes(subjects)
    shelf = Shelf(folder / "figures")
    with drawing_style():
        pictures = Pictures(
            homes={name: shelf.draw(prefixes[name], figures.FIGURES, it) for name, it in subjects.items()},
            over_homes=shelf.draw("homes-", figures.FIGURES_OVER_HOMES, results),
        )
        first, *others = subjects.values()
        if others:
            shelf.draw("", [figure for figure in figures.FIGURES if figure.section is None], first)
    shelf.tidy()
    return pictures


def _prefixes(homes: Iterable[str]) -> dict[str, str]:
    """What stands before a home's file names: nothing for one home, else its name made safe and unique."""
    names = list(homes)
    if len(names) == 1:
        return {names[0]: ""}
    safe = [re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "home" for name in names]
    return {
        name: f"{text}-" if safe.count(text) == 1 and text != "homes" else f"{text}-{number}-"
        for number, (name, text) in enumerate(zip(names, safe, strict=True), start=1)
    }
