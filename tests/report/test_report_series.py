"""The CSV files of a results folder: what is read, and the words for what cannot be."""

from pathlib import Path

import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.report import write_report
from hemma.report.series import SeriesReader


def _free_run(folder: Path, stamps: list[str]) -> SeriesReader:
    rows = [f"{stamp},20.5,20.0,30" for stamp in stamps]
    (folder / "run.csv").write_text("\n".join(["time,measured_c,predicted_c,outdoor_c", *rows]))
    return SeriesReader(folder)


def test_local_time_keeps_the_first_offset_through_the_end_of_summer_time(tmp_path):
    stamps = ["2021-10-31T01:00:00+02:00", "2021-10-31T02:00:00+02:00", "2021-10-31T02:00:00+01:00"]
    clock = _free_run(tmp_path, stamps).free_run("run.csv").clock
    assert clock.offset == "UTC+02:00"
    assert np.all(np.diff(clock.start) == np.timedelta64(1, "h"))
    assert clock.start[0] == np.datetime64("2021-10-31T01:00:00")
    assert clock.fence_posts(3)[-1] == np.datetime64("2021-10-31T04:00:00")
    assert clock.fence_posts(1)[-1] == np.datetime64("2021-10-31T02:00:00")


def test_time_stamps_without_an_offset_are_refused(tmp_path):
    reader = _free_run(tmp_path, ["2021-08-01T00:00:00"])
    with pytest.raises(HemmaError, match=r"run\.csv.*with an offset.*found 2021-08-01T00:00:00"):
        reader.free_run("run.csv")


def test_what_is_not_a_time_stamp_is_refused(tmp_path):
    reader = _free_run(tmp_path, ["yesterday"])
    with pytest.raises(HemmaError, match=r"run\.csv.*ISO 8601"):
        reader.free_run("run.csv")


def test_only_the_iteration_is_compulsory_in_a_curve(tmp_path):
    (tmp_path / "curve.csv").write_text("iteration,learned_reward\n0,1.5\n10,2.5\n")
    curve = SeriesReader(tmp_path).curve("curve.csv")
    assert curve.iteration.tolist() == [0, 10]
    assert curve.quantities.keys() == {"learned_reward"}
    assert curve.quantities["learned_reward"].tolist() == [1.5, 2.5]
    assert curve.share.tolist() == [0.0, 1.0]


def test_a_curve_without_rows_is_refused(tmp_path):
    (tmp_path / "curve.csv").write_text("iteration,learned_reward\n")
    with pytest.raises(HemmaError, match=r"curve\.csv: expected a row a chunk of iterations, found none"):
        SeriesReader(tmp_path).curve("curve.csv")


@pytest.mark.parametrize(
    "name", ["schedules/home/HA-1-1.csv", "curves/home/HA-1-0.csv", "schedules/home/exogenous.csv"]
)
def test_a_missing_file_is_named_whether_it_is_drawn_or_not(small, name):
    folder, _ = small
    (folder / name).unlink()
    with pytest.raises(HemmaError, match=f"{name}.*missing"):
        write_report(folder)
    assert not (folder / "report.html").exists()


def test_a_missing_column_is_named(small):
    folder, _ = small
    path = folder / "schedules/home/exogenous.csv"
    path.write_text(path.read_text().replace("buy_per_kwh", "price"))
    with pytest.raises(HemmaError, match=r"exogenous\.csv.*buy_per_kwh is missing"):
        write_report(folder)


def test_a_schedule_of_another_length_is_refused(small):
    folder, _ = small
    path = folder / "schedules/home/Rule-0.csv"
    path.write_text("".join(path.read_text().splitlines(keepends=True)[:-1]))
    with pytest.raises(HemmaError, match=r"Rule-0\.csv: expected 744 rows.*found 743"):
        write_report(folder)


def test_text_among_the_numbers_is_refused(small):
    folder, _ = small
    path = folder / "curves/home/HA-1-1.csv"
    path.write_text("iteration,learned_reward\n0,high\n")
    with pytest.raises(HemmaError, match=r"HA-1-1\.csv.*numbers in the column learned_reward"):
        write_report(folder)


def test_an_empty_file_is_named(small):
    folder, _ = small
    (folder / "schedules/home/optimum-0.csv").write_text("")
    with pytest.raises(HemmaError, match=r"optimum-0\.csv: expected a CSV file"):
        write_report(folder)


@pytest.mark.parametrize("name", ["../secret.csv", "/etc/hostname"])
def test_nothing_outside_the_folder_is_read(tmp_path, name):
    (tmp_path / "secret.csv").write_text("iteration\n0\n")
    folder = tmp_path / "results"
    folder.mkdir()
    with pytest.raises(HemmaError, match="expected a file inside"):
        SeriesReader(folder).curve(name)
