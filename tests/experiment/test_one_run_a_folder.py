"""One run at a time works in a results folder, and what cannot be done is refused before its first stage."""

import os
import subprocess
import sys
from dataclasses import replace

import pytest

from hemma.errors import HemmaError
from hemma.experiment.run import Stage, run
from hemma.results.lock import LOCK, locked
from hemma.results.progress import Silence
from hemma.stages import job as jobs
from hemma.stages.job import at_work, checked
from hemma.studies.robustness.run import run_faults
from hemma.studies.transfer.run import TransferJob, transfer
from tiny_experiment import Watching, tiny_experiment, tiny_job


def transfer_of(job):
    days = job.experiment.demonstration_days
    experiment = replace(job.experiment, demonstration_days=1 if days == 2 else days)
    return TransferJob(experiment, job.homes[0], job.folder, job.test_from)


STARTS = {
    "reproduce": run,
    "identify": lambda job, progress=None: run(job, Stage.IDENTIFY, progress),
    "robustness": run_faults,
    "transfer": lambda job, progress=None: transfer(transfer_of(job), progress),
}
every_command = pytest.mark.parametrize("start", STARTS.values(), ids=STARTS.keys())


@pytest.fixture
def no_stage(monkeypatch):
    """Fails where a stage begins."""

    def begun(*_, **__):
        pytest.fail("a stage began")

    for module in ("experiment.home_run", "studies.robustness.run", "studies.transfer.run"):
        monkeypatch.setattr(f"hemma.{module}.identify", begun)


@every_command
@pytest.mark.usefixtures("no_stage")
def test_a_second_run_is_refused_at_once_and_told_who_works_there(tmp_path, start):
    script = (
        "import sys, time; from pathlib import Path; from hemma.results.lock import locked\n"
        "from hemma.results.progress import Silence\n"
        "with locked(Path(sys.argv[1]), 'hemma train --seeds 4', Silence()):\n"
        "    print('working', flush=True); time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", script, tmp_path], stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"working\n"
        with pytest.raises(HemmaError, match=f"process {other.pid} on .* since 20.*: hemma train --seeds 4"):
            start(tiny_job(tmp_path))
        other.kill()


def test_a_run_that_was_killed_holds_nobody_up(tmp_path):
    (tmp_path / LOCK).write_text("process 1 on vm since 2026-01-01: hemma train")
    watching = Watching()
    with locked(tmp_path, "hemma train", watching):
        assert f"process {os.getpid()} on" in (tmp_path / LOCK).read_text()
        with pytest.raises(HemmaError, match="no other run"), locked(tmp_path, "again", Silence()):
            pass
    assert ["process 1 on vm" in notice for notice in watching.notices] == [True]
    assert (tmp_path / LOCK).read_text() == ""
    again = Watching()
    with locked(tmp_path, "hemma train", again):
        pass
    assert again.notices == []


def test_where_there_are_no_locks_that_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr("hemma.results.lock.fcntl", None)
    watching = Watching()
    with locked(tmp_path, "hemma train", watching):
        pass
    assert "cannot be locked" in watching.notices[0]


@every_command
@pytest.mark.usefixtures("no_stage")
def test_a_file_where_the_folder_should_be(tmp_path, start):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(HemmaError, match="file: expected a results folder"):
        start(tiny_job(tmp_path / "file"))


@every_command
@pytest.mark.usefixtures("no_stage")
def test_a_folder_full_of_other_things(tmp_path, start):
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(HemmaError, match=r"thesis.tex among them. Name a folder of its own.*--out"):
        start(tiny_job(tmp_path))
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("file", ["run.log", ".gitignore", LOCK, "models/home/network.json"])
def test_folders_that_will_do(tmp_path, file):
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text("")
    with at_work(tmp_path, "hemma train", Silence()):
        pass


def test_somebody_elses_results_are_not_replaced(tmp_path):
    (tmp_path / "results.json").write_text('{"homes": {}}')
    with pytest.raises(HemmaError, match=r"results.json among them"), at_work(tmp_path, "", Silence()):
        pass
    (tmp_path / "results.json").write_text('{"schema": 1, "hemma": "0.0.1", "homes"')
    with at_work(tmp_path, "", Silence()):
        pass


@every_command
@pytest.mark.usefixtures("no_stage")
@pytest.mark.parametrize("error", [RuntimeError("Unknown backend 'cuda'"), AssertionError()])
def test_no_device_is_one_message(tmp_path, start, error, monkeypatch):
    def none():
        raise error

    monkeypatch.setattr(jobs.jax, "devices", none)
    with pytest.raises(HemmaError, match=r"expected a device to compute on.*JAX_PLATFORMS"):
        start(tiny_job(tmp_path / "out"))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", [name for name in STARTS if name != "identify"])
@pytest.mark.usefixtures("no_stage")
def test_too_many_days_of_demonstrations(tmp_path, command):
    job = tiny_job(tmp_path / "out", replace(tiny_experiment(), demonstration_days=10_000))
    with pytest.raises(HemmaError, match=r"austin2021-2: expected a training period of .*0000 days"):
        STARTS[command](job)
    assert not (tmp_path / "out").exists()


def test_periods_too_short_for_a_stage():
    job = tiny_job("out")
    with pytest.raises(HemmaError, match="austin2021-2: identification: expected a record of at least"):
        checked(replace(job, test_from="2021-06-01T05:00"))
    with pytest.raises(HemmaError, match="expected a test period of at least 24 h, got 5 slots"):
        checked(replace(job, test_from="2021-06-07T19:00"))
    short = replace(tiny_experiment(), identification=replace(tiny_experiment().identification, window=1.0))
    with pytest.raises(HemmaError, match="austin2021-2: forecast: expected a past of at least one day"):
        checked(replace(job, experiment=short, test_from="2021-06-01T20:00"))


def test_names_that_no_folder_should_have():
    job = tiny_job("out")
    odd = replace(job.homes[0], name="caf\udce9")
    with pytest.raises(HemmaError, match=r"readable name, got 'caf\\udce9'"):
        checked(replace(job, homes=(odd,)))


def test_two_homes_one_after_the_other_both_stand_in_the_results(tmp_path):
    job = tiny_job(tmp_path)
    other = replace(job, homes=(replace(job.homes[0], name="cottage"),))
    run(job, Stage.IDENTIFY)
    assert set(run(other, Stage.IDENTIFY)["homes"]) == {"austin2021-2", "cottage"}
