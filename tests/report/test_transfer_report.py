"""The figure and the table of a transfer test, from a made-up file."""

import json

import pytest

from hemma.errors import HemmaError
from hemma.studies.transfer.records import load_transfer
from hemma.studies.transfer.report import paired_lines, transfer_rows, write_transfer_report


def method(share):
    metrics = {"share_of_savings": share, "mean_temperature_deviation": 0.01}
    return {
        "runs": [{"seed": 0, **metrics}, {"seed": 1, **metrics}],
        "mean": metrics,
        "interval": {"share_of_savings": [share - 0.1, share + 0.1]},
    }


@pytest.fixture
def folder(tmp_path):
    places = {
        "unchanged": {"meaning": "the same", "methods": {"policy of AIRL": method(0.9)}},
        "time of use": {
            "meaning": "two prices",
            "methods": {"policy of AIRL": method(-3.0), "PPO on r": method(0.5)},
            "paired": [{"method": "PPO on r", "over": "policy of AIRL", "mean": 3.5, "interval": [3.0, 4.0]}],
        },
    }
    content = {
        "schema": 1,
        "home": "home-1",
        "currency": "$",
        "days": 15,
        "measured": {"start": "2021-07-16T00:00:00-06:00", "slots": 384},
        "places": places,
    }
    (tmp_path / "transfer.json").write_text(json.dumps(content))
    return tmp_path


def test_rows_have_means_and_intervals(folder):
    rows = transfer_rows(load_transfer(folder))
    assert rows[0] == (
        "unchanged",
        "policy of AIRL",
        "2",
        "90.0\u00a0% [80.0, 100.0]",
        "0.0100\u00a0°C",
    )
    assert [row[1] for row in rows] == ["policy of AIRL", "policy of AIRL", "PPO on r"]
    assert paired_lines(load_transfer(folder)) == [
        "time of use: PPO on r less policy of AIRL: 350.0 [300.0, 400.0] points"
    ]


def test_the_same_numbers_give_the_same_bytes(folder):
    write_transfer_report(folder)
    files = [folder / "figures" / "transfer.svg", folder / "figures" / "transfer.png", folder / "transfer.md"]
    first = [file.read_bytes() for file in files]
    write_transfer_report(folder)
    assert [file.read_bytes() for file in files] == first


def test_what_lies_beyond_the_axis_is_written(folder):
    write_transfer_report(folder)
    assert (folder / "figures" / "transfer.svg").stat().st_size > 10_000
    assert "−300.0" in (folder / "transfer.md").read_text()


def test_a_folder_without_the_file_is_refused_with_the_cure(tmp_path):
    with pytest.raises(HemmaError, match="expected what `hemma transfer` writes"):
        load_transfer(tmp_path)
