"""Commands in this process, and the made-up results of the report's tests."""

import sys
from pathlib import Path

import pytest

from hemma.cli.main import run

sys.path.append(str(Path(__file__).parents[1] / "report"))


@pytest.fixture
def hemma(monkeypatch, capsys):
    """Runs a command in this process; gives exit status, standard output and standard error."""

    def command(*words):
        monkeypatch.setattr(sys, "argv", ["hemma", *map(str, words)])
        status = 0
        try:
            run()
        except SystemExit as end:
            status = end.code or 0
        output = capsys.readouterr()
        return status, output.out, output.err

    monkeypatch.setenv("HEMMA_CACHE", "off")
    return command
