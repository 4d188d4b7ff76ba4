"""Standard output belongs to results, whatever a library prints and whatever the terminal can show.

Each command runs in a process of its own: the tests' own capture would stand between it and its streams.
"""

import json
import os
import re
import subprocess
import sys

import pytest
from synthetic_results import write_results

from hemma.data import load_austin2021, write_canonical

COMMAND = [sys.executable, "-c", "from hemma.cli.main import run; run()"]
TINY = """
learned: [HA-1]
seeds: 1
demonstration_days: 1
identification: {updates: 10, chunk: 10, window_h: 6, batch: 4, width: 2}
data_efficiency: {days: []}
pareto: {relaxations_c: []}
"""


def started(*words, **streams):
    settings = {**os.environ, "HEMMA_CACHE": "off", **streams.pop("env", {})}
    return subprocess.run(
        [*COMMAND, *map(str, words)],
        env=settings,
        check=False,
        **(streams or {"capture_output": True}),
    )


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    place = tmp_path_factory.mktemp("streams")
    for name in ("before", "after"):
        (place / name).mkdir()
        write_results(place / name, ("home",), 2, ("HA-1", "Rule", "optimum"))
    return place / "before", place / "after"


def test_json_of_a_run_that_solves_is_json_and_nothing_else(tmp_path):
    """HiGHS prints a banner from C when it is first made."""
    write_canonical(load_austin2021(2).window(0, 24 * 4), tmp_path / "cottage.csv")
    (tmp_path / "tiny.yaml").write_text(TINY)
    words = ["--traces", tmp_path / "cottage.csv", "--settings", tmp_path / "tiny.yaml"]
    ended = started(
        "demonstrate", *words, "--test-from", "2021-06-04", "--out", tmp_path / "out", "--json",
        env={"JAX_DISABLE_MOST_OPTIMIZATIONS": "1"},
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr.decode()
    assert set(json.loads(ended.stdout)["homes"]) == {"cottage"}
    assert json.loads(ended.stdout) == json.loads((tmp_path / "out" / "results.json").read_text())
    assert b"1 days, 23 transitions" in ended.stderr


def test_what_the_encoding_lacks_is_replaced(folders):
    ended = started("compare", *folders, env={"PYTHONIOENCODING": "cp1252"})
    assert (ended.returncode, ended.stderr) == (0, b"")
    table = ended.stdout.decode("cp1252")
    assert "HA-1" in table
    assert "°C" in table
    assert re.search(r" -\d", table), "a minus sign is a hyphen where there is none"


def test_json_is_whole_in_any_encoding(folders):
    ended = started("compare", *folders, "--json", env={"PYTHONIOENCODING": "ascii"})
    assert json.loads(ended.stdout.decode("ascii"))["folders"] == [str(folder) for folder in folders]


@pytest.mark.parametrize(("words", "status"), [(["reproduce", "--help"], 0), (["report", "no‽where"], 2)])
def test_help_and_messages_need_no_more_than_ascii(words, status):
    ended = started(*words, env={"PYTHONIOENCODING": "ascii"})
    assert ended.returncode == status
    assert len((ended.stdout + ended.stderr).decode("ascii")) > 50
    assert b"Traceback" not in ended.stderr


def test_a_reader_that_goes_away_ends_nothing_badly(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    ended = started("settings", stdout=writing, stderr=subprocess.PIPE)
    os.close(writing)
    assert (ended.returncode, ended.stderr) == (0, b"")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_a_full_disk_is_said():
    with open("/dev/full", "wb") as full:
        ended = started("settings", stdout=full, stderr=subprocess.PIPE)
    assert ended.returncode == 2
    assert b"No space left" in ended.stderr
    assert b"Traceback" not in ended.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="closes descriptors")
def test_closed_streams_are_given_to_no_file(tmp_path):
    """A descriptor that is closed goes to the next file opened, where a banner would end up in it."""
    script = (
        "import os; os.close(1); os.close(2); import sys; sys.stdout = sys.__stdout__ = None;"
        "sys.stderr = sys.__stderr__ = None; from hemma.cli.streams import part_streams; part_streams();"
        f"file = open({str(tmp_path / 'file')!r}, 'w'); os.write(1, b'banner'); sys.stdout.write('x');"
        "sys.exit(file.fileno() <= 2)"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0
    assert (tmp_path / "file").read_text() == ""
