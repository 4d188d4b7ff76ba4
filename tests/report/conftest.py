"""Results folders that several tests look at; they must not change them."""

from dataclasses import dataclass
from pathlib import Path

import pytest
from synthetic_results import write_results

from hemma.report import write_report


@dataclass(frozen=True)
class Written:
    """A results folder with its report."""

    folder: Path
    content: dict
    """What stands in ``results.json``."""
    html: str


@pytest.fixture(scope="session")
def written(tmp_path_factory) -> Written:
    folder = tmp_path_factory.mktemp("results")
    content = write_results(folder, seeds=3)
    return Written(folder, content, write_report(folder).read_text(encoding="utf-8"))


@pytest.fixture
def undrawn(monkeypatch) -> None:
    """Figures are made but not rendered, which is what takes the time: for tests of the page."""

    def save(figure, folder, name) -> bytes:
        folder.mkdir(exist_ok=True)
        for ending in ("png", "svg"):
            (folder / f"{name}.{ending}").write_bytes(b"<svg/>")
        return b"<svg/>"

    monkeypatch.setattr("hemma.report.pictures.save", save)


@pytest.fixture
def small(tmp_path) -> tuple[Path, dict]:
    """A folder that a test may break, without a report."""
    return tmp_path, write_results(tmp_path, homes=("home",), seeds=2, methods=("HA-1", "Rule", "optimum"))
