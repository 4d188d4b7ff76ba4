"""The command line: quick help, results and messages apart, and no traceback for a user's mistake."""

import importlib
import json
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from hemma.cli import console, experiment
from hemma.data import load_austin2021, read_canonical

main_job = importlib.import_module("hemma.experiment.run")
"""The module; the package has a function of that name."""


def refused(result, *expected):
    status, out, err = result
    assert status == 2, err
    assert out == ""
    assert "Traceback" not in err
    assert len(err.strip()) < 600
    for part in expected:
        assert part in err.replace("\n", " ")


def test_help_imports_nothing_heavy():
    """What takes seconds to import must not stand between a user and the help page."""
    heavy = "jax numpy scipy pandas pydantic yaml matplotlib highspy equinox hemma.experiment hemma.report"
    script = f"import sys, hemma.cli.main; print([m for m in {heavy.split()} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_help_names_every_command_and_the_exit_statuses(hemma):
    status, out, _ = hemma("--help")
    assert status == 0
    for word in ("reproduce", "identify", "demonstrate", "train", "evaluate", "report", "settings", "130"):
        assert word in out


def test_version(hemma):
    import hemma as package

    assert hemma("--version") == (0, f"{package.__version__}\n", "")


def test_settings_are_printed_as_a_file_that_can_be_used(hemma, tmp_path):
    status, out, err = hemma("settings")
    assert (status, err) == (0, "")
    assert yaml.safe_load(out)["battery"]["max_energy_kwh"] == 6.0
    (tmp_path / "mine.yaml").write_text("battery: {max_energy_kwh: 13.5}")
    _, out, _ = hemma("settings", "--settings", tmp_path / "mine.yaml")
    assert yaml.safe_load(out)["battery"]["max_energy_kwh"] == 13.5


def test_export_and_check_of_a_home(hemma, tmp_path):
    file = tmp_path / "cottage.csv.gz"
    status, out, _ = hemma("data", "export", file, "--home", 3)
    assert status == 0
    assert "austin2021-3" in out
    assert (read_canonical(file).exogenous.load == load_austin2021(3).exogenous.load).all()
    status, out, err = hemma("data", "check", file)
    assert (status, err) == (0, "")
    assert "cottage" in out
    assert "2208 slots" in out


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["--home", "7"], ["austin2021", "got 7"]),
        (["--home", "1", "--home", "1"], ["austin2021-1 twice"]),
        (["--seeds", "0"], ["--seeds", "from 1 to 1000, got 0"]),
        (["--seeds", "-3"], ["--seeds", "from 1 to 1000, got -3"]),
        (["--seeds", "99999999999999999999"], ["--seeds", "from 1 to 1000, got 99999999999999999999"]),
        (["--seeds", "1e20"], ["--seeds"]),
        (["--traces", "missing.csv"], ["missing.csv"]),
        (["--traces", "missing.csv", "--home", "1"], ["leave one of them out"]),
        (["--settings", "missing.yaml"], ["missing.yaml", "cannot read it"]),
        (["--test-from", "yesterday"], ["--test-from", "yesterday"]),
        (["--test-from", "2031-01-01"], ["2031-01-01"]),
        (["--seeds", "many"], ["--seeds"]),
        (["--homes"], ["--homes"]),
        (["--homes", "1,7"], ["--homes", "all", "1 to 6", "'7' in '1,7'"]),
        (["--homes", "1,,2"], ["got nothing in '1,,2'"]),
        (["--homes", "three"], ["'three'"]),
        (["--homes", "2,3,2"], ["got 2 twice"]),
        (["--homes", "all", "--home", "1"], ["--home N or --homes LIST, got both"]),
        (["--homes", "all", "--traces", "missing.csv"], ["leave one of them out"]),
    ],
)
def test_mistakes_in_the_options(hemma, tmp_path, monkeypatch, words, parts):
    monkeypatch.chdir(tmp_path)
    refused(hemma("reproduce", *words), *parts)
    assert not (tmp_path / "results").exists()


def test_mistakes_in_files(hemma, tmp_path):
    (tmp_path / "wrong.yaml").write_text("battery: {max_enrgy_kwh: 5}")
    refused(
        hemma("reproduce", "--settings", tmp_path / "wrong.yaml"),
        "wrong.yaml",
        "battery.max_enrgy_kwh",
        "did you mean max_energy_kwh?",
    )
    (tmp_path / "wrong.csv").write_text("time,pv_kw\n2021-06-01T00:00:00Z,1\n")
    refused(hemma("data", "check", tmp_path / "wrong.csv"), "wrong.csv")
    refused(hemma("report", tmp_path / "nothing"), "nothing", "hemma reproduce")


def test_a_folder_that_cannot_be_written(hemma, tmp_path):
    (tmp_path / "results").write_text("a file where the folder should be")
    refused(hemma("identify", "--out", tmp_path / "results"), "results", "folder")


def test_prices_of_pecan_street_come_from_one_place(hemma, tmp_path):
    convert = [
        "data",
        "convert-pecan-street",
        "homes.csv",
        tmp_path / "x.csv",
        "--home",
        661,
        "--weather",
        "w.csv",
    ]
    refused(hemma(*convert), "either --prices FILE, or both --off-peak and --peak")
    refused(hemma(*convert, "--prices", "p.csv", "--peak", 0.3), "either --prices FILE")
    refused(hemma(*convert, "--peak", 0.3, "--off-peak", 0.1), "homes.csv")


CONTENT = {
    "homes": {"cottage": {"methods": {}, "identification": {"rmse_c": {"1 h": 0.1, "24 h": 0.25}}}},
}


@pytest.fixture
def pretended(monkeypatch):
    """An experiment that only says what it was asked for."""
    asked = []

    def pretend(job, last, progress):
        asked.append((job, last))
        progress.started("identify", 10)
        progress.finished("identify", "well enough")
        progress.noticed("a notice")
        return CONTENT

    monkeypatch.setattr(main_job, "run", pretend)
    return asked


def test_results_and_messages_are_apart(hemma, pretended, tmp_path):
    status, out, err = hemma("identify", "--json", "--out", tmp_path)
    assert status == 0
    assert json.loads(out) == CONTENT
    assert err.splitlines() == ["identify ...", "identify: well enough", "note: a notice"]
    status, out, _ = hemma("identify", "--out", tmp_path)
    assert "cottage: free-run error 1 h: 0.1 °C, 24 h: 0.25 °C" in out


def test_options_reach_the_experiment(hemma, pretended, tmp_path):
    file = tmp_path / "cottage.csv"
    hemma("data", "export", file, "--home", 2)
    (tmp_path / "mine.yaml").write_text("battery: {max_energy_kwh: 13.5}\npv_scale: 2")
    words = [
        "--traces",
        file,
        "--test-from",
        "2021-08-15",
        "--seeds",
        "4",
        "--out",
        tmp_path / "out",
        "--quick",
    ]
    assert hemma("demonstrate", *words, "--settings", tmp_path / "mine.yaml")[0] == 0
    [(job, last)] = pretended
    assert last.name == "DEMONSTRATE"
    assert (job.folder, job.test_from, job.experiment.seeds) == (tmp_path / "out", "2021-08-15", 4)
    assert job.experiment.battery.max_energy == 13.5
    [home] = job.homes
    assert home.name == "cottage"
    assert home.exogenous.pv_generation.max() == pytest.approx(
        2 * load_austin2021(2).exogenous.pv_generation.max()
    )
    assert job.command.startswith("hemma demonstrate --traces")


@pytest.mark.parametrize(
    ("words", "numbers"),
    [
        (["--homes", "all"], [1, 2, 3, 4, 5, 6]),
        (["--homes", "5, 1"], [5, 1]),
        (["--home", "2", "--home", "4"], [2, 4]),
        ([], [1]),
    ],
)
def test_homes_are_those_that_were_asked_for(hemma, pretended, tmp_path, words, numbers):
    assert hemma("identify", "--out", tmp_path, *words)[0] == 0
    [(job, _)] = pretended
    assert [home.name for home in job.homes] == [f"austin2021-{number}" for number in numbers]


def test_every_verb_goes_as_far_as_its_name(hemma, pretended, tmp_path):
    for verb in experiment.VERBS:
        hemma(verb, "--out", tmp_path)
    assert [last.name for _, last in pretended] == ["REPORT", "IDENTIFY", "DEMONSTRATE", "TRAIN", "EVALUATE"]


def test_an_interruption_says_how_to_go_on(hemma, monkeypatch, tmp_path):
    def interrupted(job, last, progress):
        raise KeyboardInterrupt

    monkeypatch.setattr(main_job, "run", interrupted)
    status, out, err = hemma("reproduce", "--out", tmp_path)
    assert (status, out) == (130, "")
    assert "run the same command to go on" in err


def test_lines_in_a_pipe_are_few(capsys, monkeypatch):
    moments = iter(range(0, 1000, 3))
    monkeypatch.setattr(console.time, "monotonic", lambda: float(next(moments)))
    lines = console.PlainLines()
    lines.started("HA-1", 100)
    for done in range(0, 100, 5):
        lines.advanced("HA-1", done, "")
    shown = capsys.readouterr().err.splitlines()
    assert shown[0] == "HA-1 ..."
    assert 3 <= len(shown) <= 8


def test_compiled_code_is_kept_where_it_may_be(monkeypatch, tmp_path):
    import jax

    from hemma.cli.compilation import keep_compiled_code

    before = jax.config.jax_compilation_cache_dir
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    monkeypatch.delenv("HEMMA_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    try:
        keep_compiled_code()
        assert Path(jax.config.jax_compilation_cache_dir).parent == tmp_path / "hemma"
        jax.config.update("jax_compilation_cache_dir", before)
        (tmp_path / "file").write_text("")
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
        keep_compiled_code()
        assert jax.config.jax_compilation_cache_dir == before
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
        monkeypatch.setenv("HEMMA_CACHE", "off")
        keep_compiled_code()
        assert jax.config.jax_compilation_cache_dir == before
    finally:
        jax.config.update("jax_compilation_cache_dir", before)
