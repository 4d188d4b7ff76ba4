"""What a file must look like: numbers, quotes, names of columns, line ends, encodings; short messages."""

import gzip
import subprocess
import sys

import numpy as np
import pytest
from canonical_files import HEADER, refusal, rows, stamps
from dataport_files import bad_cell, body
from dataport_files import refusal as dataport_refusal

from hemma.data import list_pecan_street_homes, read_canonical
from hemma.errors import HemmaError


def with_load(text, line=10):
    lines = rows(stamps(48))
    cells = lines[line - 2].split(",")
    lines[line - 2] = ",".join([*cells[:2], text, *cells[3:]])
    return lines


@pytest.mark.parametrize("cell", ["0.5", "+0.5", ".5", "5e-1", "5.E-1", "0.5 ", '"0.5"', "\t0.5", "00.50"])
def test_numbers_as_files_have_them(write, cell):
    assert read_canonical(write(with_load(cell))).exogenous.load[8] == 0.5


@pytest.mark.parametrize(
    "cell",
    ["1_0", "0x10", '"1,5"', "١٢", "１２", "1e", "--1", "1e400", "-inf", "infinity", "1 0", "1.2.3",
     "0b1", "1j", "1d3", "True", "unavailable", "NA", "½", "1²", "'1", "$1", "1kW", "−1"],
)  # fmt: skip
def test_other_text_is_refused_by_line(write, cell):
    message = refusal(write(with_load(cell)))
    assert "line 10: expected a finite number (or an empty cell) in load_kw, got " in message
    assert cell.strip('"') in message
    assert "Write it like 0.35 or 3.5e-1, or empty the cell" in message


@pytest.mark.parametrize("cell", ["1_0", "0x10", "١٢", "1e400", "True"])
def test_dataport_numbers_are_as_strict(folder, cell):
    message = dataport_refusal(folder, bad_cell(body(192), 10, cell))
    assert f"line 12: expected a number in solar, got '{cell.replace('1e400', 'inf')}" in message


@pytest.mark.parametrize("home", ["661.5", "1e300", "six"])
def test_a_dataport_home_is_a_whole_number(folder, home):
    rows = body(192)
    rows[5] = rows[5].replace("661,", f"{home},", 1)
    assert "line 7: expected a" in dataport_refusal(folder, rows)


@pytest.mark.parametrize("days", [3, 800])
def test_an_unclosed_quote_is_named_where_it_opens(tmp_path, days):
    """Longer files are longer than the cells that Python's reader takes."""
    lines = [HEADER, *rows(stamps(24 * days))]
    lines[10] = lines[10].replace(",0.", ',"0.', 1)
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress("\n".join(lines).encode()))
    message = refusal(path)
    assert f"{path}, line 11: expected quotes in pairs, each cell within its line" in message
    assert "Take the quotes out" in message
    assert len(message) < 500


def test_a_stray_quote_behind_a_number_is_named(write):
    assert "line 10: expected a finite number" in refusal(write(with_load('0.5"')))
    assert "line 10: expected quotes in pairs" in refusal(write(with_load('"0.5"1')))


def test_an_unclosed_quote_of_a_dataport_file_is_named(folder):
    message = dataport_refusal(folder, bad_cell(body(192), 10, '"1.5'))
    assert "a quote that is never closed in line 12" in message


@pytest.mark.parametrize("size", [5000, 200_000])
@pytest.mark.parametrize("cell", ["7{}", "x{}", '"x{}"'])
def test_a_huge_cell_is_cut_in_the_message(write, size, cell):
    message = refusal(write(with_load(cell.format("7" * size))))
    assert "line 10: expected" in message
    assert len(message) < 500


def test_huge_headers_are_cut(write):
    assert len(refusal(write(rows(stamps(4)), HEADER + ",x" * 50_000))) < 900
    assert len(refusal(write(rows(stamps(4)), "y" * 50_000))) < 900


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda line: line + ",", "column 6 has no name (a comma too many at the end of each line?)"),
        (lambda line: line + ",,", "column 6 has no name"),
        (lambda line: "7," + line if line[0] == "2" else "," + line, "column 1 has no name (the row numbers"),
        (lambda line: line.replace(",", ",,", 1), "column 2 has no name. Take it out"),
    ],
)
def test_columns_without_a_name_are_told_by_number(write, change, message):
    lines = [change(line) for line in [HEADER, *rows(stamps(48))]]
    assert message in refusal(write(lines[1:], lines[0]))


def test_commas_at_the_end_of_rows_alone_are_told(write):
    lines = [line + "," for line in rows(stamps(48))]
    message = refusal(write(lines))
    assert "line 2: expected 5 cells as in the header, got 6. Take the commas at its end out" in message


@pytest.mark.parametrize("column", ["sell_per_kwh", "indoor_c", "hvac_kw"])
def test_an_empty_optional_column_is_told(write, column):
    lines = [f"{line}," for line in rows(stamps(48))]
    message = refusal(write(lines, f"{HEADER},{column}"))
    assert f"got none in any of the 48 rows: {column} is empty: take the column out" in message


def test_an_empty_required_column_is_told(write):
    lines = [",".join([*line.split(",")[:2], "", *line.split(",")[3:]]) for line in rows(stamps(48))]
    assert "load_kw is empty: fill it" in refusal(write(lines))


def test_every_kind_of_line_end_is_read(tmp_path):
    lines = [HEADER, *rows(stamps(48))]
    read = []
    for k, end in enumerate(["\n", "\r\n", "\r"]):
        (tmp_path / f"{k}.csv").write_bytes(end.join(lines).encode())
        read.append(read_canonical(tmp_path / f"{k}.csv").exogenous.load)
    np.testing.assert_array_equal(read[0], read[1])
    np.testing.assert_array_equal(read[0], read[2])


def test_control_characters_do_not_shift_the_count_of_lines(write):
    """Python's own splitlines takes a form feed for the end of a line."""
    lines = rows(stamps(48))
    lines[3] += "\x0c"
    lines[20] = lines[20].replace("0.", "x.", 1)
    assert "line 22: expected a finite number" in refusal(write(lines))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.encode("utf-16"), "line 1: expected text in UTF-8, got byte 0xff"),
        (lambda text: text.encode("utf-16-le"), "line 1: expected text in UTF-8, got a byte 0x00"),
        (lambda text: text.replace("30.3", "30.\0").encode(), "line 5: expected text in UTF-8, got a byte"),
        (lambda text: text.replace("30.3", "30.µ").encode("cp1252"), "line 5: expected text in UTF-8"),
        (lambda text: text.replace("\n", "\r", 1).replace("30.3", "3\r").encode(), "expected 5 cells"),
    ],
)
def test_other_encodings_and_broken_bytes_are_told(tmp_path, change, message):
    (tmp_path / "a.csv").write_bytes(change("\n".join([HEADER, *rows(stamps(30))])))
    assert message in refusal(tmp_path / "a.csv")


def test_a_folder_or_a_damaged_archive_is_no_dataport_file(tmp_path):
    with pytest.raises(HemmaError, match="expected a readable file"):
        list_pecan_street_homes(tmp_path)


def test_the_command_line_says_one_sentence(write):
    """Exit status 2, nothing on standard output, no traceback."""
    path = write(with_load('"0.5'), HEADER)
    code = "from hemma.cli.main import run; run()"
    command = [sys.executable, "-c", code, "data", "check", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"hemma: {path}, line 10: expected quotes in pairs")
    assert done.stderr.count("\n") == 1
