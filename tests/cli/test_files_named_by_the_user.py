"""Files that a command writes where the user says: new ones, unless ``--force`` says otherwise."""

import pytest
from synthetic_results import write_results

MINE = "my own log of a year"


@pytest.fixture
def two(tmp_path):
    for name in ("before", "after"):
        (tmp_path / name).mkdir()
        write_results(tmp_path / name, ("home",), 2, ("HA-1", "Rule", "optimum"))
    return tmp_path / "before", tmp_path / "after"


def test_an_export_replaces_nothing_unless_forced(hemma, tmp_path):
    file = tmp_path / "my-home.csv"
    file.write_text(MINE)
    status, out, err = hemma("data", "export", file)
    assert (status, out) == (2, "")
    assert "my-home.csv" in err
    assert "--force" in err
    assert file.read_text() == MINE
    assert hemma("data", "export", file, "--force")[0] == 0
    assert file.read_text().startswith("time,pv_kw")
    file.chmod(0o444)
    status, _, err = hemma("data", "export", file, "--force")
    assert status == 2
    assert "write-protected" in err


@pytest.mark.parametrize("ending", ["html", "csv", "json"])
def test_a_comparison_replaces_nothing_unless_forced(hemma, two, tmp_path, ending):
    file = tmp_path / f"mine.{ending}"
    file.write_text(MINE)
    status, out, err = hemma("compare", *two, "--out", file)
    assert (status, out) == (2, "")
    assert "--force" in err
    assert file.read_text() == MINE
    assert hemma("compare", *two, "--out", file, "--force")[0] == 0
    assert MINE not in file.read_text()


def test_a_conversion_refuses_before_it_reads(hemma, tmp_path):
    file = tmp_path / "mine.csv"
    file.write_text(MINE)
    convert = ["data", "convert-pecan-street", tmp_path / "missing.csv", file, "--home", 661]
    prices = ["--weather", "w.csv", "--peak", 0.3, "--off-peak", 0.1]
    assert "--force" in hemma(*convert, *prices)[2]
    assert "missing.csv" in hemma(*convert, *prices, "--force")[2]
    assert file.read_text() == MINE
    convert[3] = tmp_path / "mine.xlsx"
    assert "ends in .csv, .csv.gz, got .xlsx" in hemma(*convert, *prices)[2]


NOTHING = [
    ["report", ""],
    ["compare", "", "x"],
    ["data", "check", ""],
    ["transfer", "--out", " "],
    ["settings", "--settings", ""],
]


@pytest.mark.parametrize("words", NOTHING)
def test_no_name_is_no_name(hemma, words):
    """What an unset variable of a script leaves."""
    status, out, err = hemma(*words)
    assert (status, out) == (2, "")
    assert "got nothing" in err


def test_a_folder_where_a_file_should_be(hemma, tmp_path):
    (tmp_path / "x.csv").mkdir()
    assert "got a folder" in hemma("data", "export", tmp_path / "x.csv", "--force")[2]
