"""Results that somebody edited or that were damaged: one message with file and place, never a traceback."""

import copy

import pytest
from synthetic_results import save_results, write_results

from hemma.cli.console import print_table
from hemma.errors import HemmaError
from hemma.report import write_report
from hemma.results.results import load_results
from hemma.studies.robustness.records import load_robustness

METHODS = ("HA-1", "Rule", "optimum")


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    return write_results(tmp_path_factory.mktemp("whole"), ("home",), 2, METHODS)


def tampered(content, place, value):
    """The content with ``value`` at a place, keys and numbers with dots between them."""
    changed = copy.deepcopy(content)
    *parts, last = [int(part) if part.isdigit() else part for part in place.split(".")]
    inner = changed
    for part in parts:
        inner = inner[part]
    inner[last] = value
    return changed


RECOMMENDED = {"method": "nobody", "days": 3, "judged": [{"method": "Rule"}]}
ODD = [
    ("homes.home.slot_length_h", 0, "slot_length_h"),
    ("homes.home.slot_length_h", 1000, "slot_length_h"),
    ("homes.home.slot_length_h", 10**400, "slot_length_h"),
    ("homes.home.slot_length_h", float("inf"), "slot_length_h"),
    ("homes.home.slot_length_h", float("nan"), "slot_length_h"),
    ("homes.home.comfort_c", [float("nan"), 24], "comfort_c"),
    ("homes.home.comfort_c", [20], "comfort_c"),
    ("homes.home.comfort_c", [25, 20], "comfort_c"),
    ("homes.home.test.slots", 0, "test.slots"),
    ("homes.home.test.slots", 10**12, "test.slots"),
    ("homes.home.test.start", "yesterday", "test.start"),
    ("homes.home.demonstration_days.HA-1", float("inf"), "demonstration_days.HA-1"),
    ("homes.home.data_efficiency.0.days", float("nan"), "data_efficiency.0.days"),
    ("homes.home.data_efficiency.0.days", -1, "data_efficiency.0.days"),
    ("homes.home.recommendation", RECOMMENDED, "one of those judged"),
    ("homes.home.methods.HA-1.runs", [], "methods.HA-1.runs"),
    ("homes.home.methods.HA-1.runs.0.energy_cost", 1e308, "energy_cost"),
    ("homes.home.methods.HA-1.interval.energy_cost", [2, 1], "energy_cost"),
    ("homes.home.methods.HA-1.runs.0.schedule", "a\0b", "'a\\x00b'"),
    ("homes.home.methods.HA-1.runs.0.curve", "\ud800", "'\\ud800'"),
    ("homes.home.currency", "\x1b[2J", "'\\x1b[2J'"),
    ("settings", {"battery": {"\0": 1}}, "'\\x00'"),
    ("homes.other", None, "homes.other"),
    ("homes", [], "homes"),
]


@pytest.mark.parametrize(("place", "value", "part"), ODD, ids=range(len(ODD)))
def test_what_cannot_be_is_refused_with_its_place(tmp_path, content, place, value, part):
    save_results(tmp_path, tampered(content, place, value))
    with pytest.raises(HemmaError) as refused:
        load_results(tmp_path)
    assert str(tmp_path / "results.json") in str(refused.value)
    assert part in str(refused.value)
    assert len(str(refused.value)) < 600


@pytest.mark.parametrize("text", ["[" * 200_000, "{", "", "\xff", '{"schema": 1' + "0" * 5000 + "}", "3"])
@pytest.mark.parametrize(("file", "load"), [("results", load_results), ("robustness", load_robustness)])
def test_what_is_no_such_file_is_refused(tmp_path, text, file, load):
    (tmp_path / f"{file}.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(HemmaError, match=f"{file}.json: expected .*hemma") as refused:
        load(tmp_path)
    assert len(str(refused.value)) < 600


@pytest.mark.usefixtures("undrawn")
def test_markup_in_names_is_text(tmp_path, capsys):
    """Rich reads brackets as markup, Matplotlib dollars as formulas, a browser tags."""
    odd = "[/bold] $x_$ <b>"
    content = write_results(tmp_path, (odd,), 2, METHODS)
    entry = content["homes"][odd]
    entry["methods"][odd] = entry["methods"]["Rule"]
    entry["currency"] = "[/x]"
    save_results(tmp_path, content)
    assert "<b>" not in write_report(tmp_path).read_text(encoding="utf-8")
    print_table(tmp_path)
    out = capsys.readouterr().out
    assert out.count("[/bold] $x_$ <b>") >= 2
    assert "[/x]" in out
