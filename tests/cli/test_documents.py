"""docs/how-to-run.md says what the commands really offer."""

import inspect
import re
from pathlib import Path

from hemma.cli import data, experiment
from hemma.cli.main import app
from hemma.experiment import DataEfficiency, Experiment, quick

TEXT = (Path(__file__).parents[2] / "docs" / "how-to-run.md").read_text()


def options(command):
    """Names of the options of a Typer command (a first name stands where a default would)."""
    parameters = inspect.signature(command).parameters.values()
    infos = [info for parameter in parameters for info in parameter.annotation.__metadata__]
    names = [name for info in infos for name in (info.default, *(info.param_decls or ()))]
    return [name for name in names if isinstance(name, str) and name.startswith("--")]


def test_every_command_and_option_is_explained():
    for command in [*app.registered_commands, *data.app.registered_commands]:
        name = command.name or command.callback.__name__.replace("_", "-")
        assert f"hemma {name}" in TEXT or f"hemma data {name}" in TEXT, name
    shared = options(app.registered_commands[0].callback)
    assert len(shared) == 9
    for option in shared:
        assert f"`{option}" in TEXT, option


def test_every_option_that_is_shown_exists():
    known = {option for command in app.registered_commands for option in options(command.callback)}
    known |= {option for command in data.app.registered_commands for option in options(command.callback)}
    assert set(re.findall(r"--[a-z][a-z-]+", TEXT)) <= known
    assert set(re.findall(r"hemma ([a-z]+)", TEXT)) <= {
        *experiment.VERBS,
        "report",
        "settings",
        "data",
        "compare",
        "robustness",
        "transfer",
    }


def test_numbers_of_the_defaults_are_right():
    default, fast = Experiment(), quick(Experiment())
    assert f"{default.seeds} by default" in TEXT
    assert f"first {default.demonstration_days} days" in TEXT
    assert f"first {default.long_demonstration_days} days" in TEXT
    mains = (default.demonstration_days, default.long_demonstration_days)
    *first, last = [str(days) for days in DataEfficiency().days if days not in mains]
    assert f"from {', '.join(first)} and {last} days" in TEXT
    assert f"{fast.seeds} seeds, {fast.airl.iterations} iterations" in TEXT
