"""``hemma robustness RESULTS``: what cannot be measured is refused with what to do about it."""

import json

import pytest
from synthetic_results import save_results, write_results

from hemma.data import load_austin2021
from hemma.data.canonical import write_canonical
from hemma.settings.experiment import Experiment
from hemma.settings.keys import outside


@pytest.fixture
def folder(tmp_path):
    """The results of two homes that nobody has but their owners."""
    content = write_results(tmp_path, ("cottage", "villa"), 2, ("HA-1", "Rule"))
    content["settings"] = outside(Experiment())
    save_results(tmp_path, content)
    return tmp_path


def refused(result, *expected):
    status, out, err = result
    assert (status, out) == (2, "")
    for part in expected:
        assert part in " ".join(err.split())


def test_a_folder_brings_its_own_settings(hemma, folder):
    for options in (("--home", 2), ("--seeds", 3), ("--quick",), ("--out", "elsewhere")):
        refused(hemma("robustness", folder, *options), "leave out all but --traces", "--out")


def test_a_folder_without_results_is_refused(hemma, tmp_path):
    refused(hemma("robustness", tmp_path), "results.json", "Run `hemma reproduce` first")


def test_the_home_of_a_trace_file_needs_its_file(hemma, folder, tmp_path):
    refused(hemma("robustness", folder), "cottage is no embedded home", "--traces cottage.csv")
    file = tmp_path / "shed.csv"
    write_canonical(load_austin2021(1), file)
    refused(hemma("robustness", folder, "--traces", file), "cottage, villa", "got that of shed")
    file = tmp_path / "cottage.csv"
    write_canonical(load_austin2021(1), file)
    refused(hemma("robustness", folder, "--traces", file), "cottage was measured on other traces")


def test_settings_of_another_version_are_named(hemma, folder):
    content = json.loads((folder / "results.json").read_text())
    content["settings"]["batery"] = {}
    save_results(folder, content)
    refused(hemma("robustness", folder), "results.json", "batery: unknown key; did you mean battery?")
