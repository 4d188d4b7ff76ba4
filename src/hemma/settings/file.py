"""Settings as YAML, read and written: one clear message for an unknown key or a value that cannot be."""

import difflib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from hemma.errors import HemmaError, shortened
from hemma.settings.experiment import Experiment
from hemma.settings.keys import explanations, inside, key_of, outside, section
from hemma.settings.yaml_file import read_yaml


def read_settings(path: Path) -> Experiment:
    """The experiment that a YAML file describes; what it leaves out keeps its default.

    Raises ``HemmaError`` with the file, the key and the cure for a file that cannot be read, an unknown
    key, and a value of the wrong kind or out of range.
    """
    return experiment_of(read_yaml(path), path)


def experiment_of(given: Any, path: Path) -> Experiment:
    """The experiment that keys and values, found in the file ``path``, describe; see ``read_settings``."""
    content = _merged(outside(Experiment()), {} if given is None else given)
    try:
        return inside(Experiment, section(Experiment).model_validate(content), given)
    except ValidationError as error:
        raise HemmaError(f"{path}: {_explained(error, content)}") from error
    except HemmaError as error:
        raise HemmaError(f"{path}: {error}") from error


def settings_text(experiment: Experiment) -> str:
    """The whole settings file of an experiment, each key with its explanation; ``read_settings`` reads it."""
    lines = ["# Settings of Hemma. Leave out what should keep its default.", *_lines(experiment, "")]
    return "\n".join(lines) + "\n"


def _lines(value: Any, indent: str) -> list[str]:
    texts = explanations(type(value))
    lines = []
    for field in fields(value):
        key, item = key_of(type(value), field.name), getattr(value, field.name)
        if key in texts:
            lines.append(f"{indent}# {texts[key]}")
        if is_dataclass(item):
            lines += [f"{indent}{key}:", *_lines(item, indent + "  ")]
        else:
            plain = yaml.safe_dump(outside(item), default_flow_style=True).replace("...", "").strip()
            lines.append(f"{indent}{key}: {plain}")
    return lines


def _merged(defaults: Any, given: Any) -> Any:
    """``given`` over ``defaults``; an empty section keeps its defaults."""
    if not isinstance(defaults, Mapping):
        return given
    if given is None:
        return defaults
    if not isinstance(given, Mapping):
        return given
    return {**defaults, **{key: _merged(defaults.get(key), value) for key, value in given.items()}}


def _explained(error: ValidationError, content: Any) -> str:
    first = error.errors()[0]
    place = ".".join(shortened(part) for part in first["loc"]) or "the file"
    if first["type"] != "extra_forbidden":
        wrong, came = first["msg"].removeprefix("Value error, "), shortened(repr(first["input"]))
        return f"{place}: {wrong}, got {came}. Correct it"
    siblings = content
    for part in first["loc"][:-1]:
        siblings = siblings[part]
    known = [str(key) for key in siblings if key != first["loc"][-1]]
    near = difflib.get_close_matches(str(first["loc"][-1]), known, 1)
    hint = f"did you mean {near[0]}?" if near else f"the keys there are {', '.join(known)}"
    return f"{place}: unknown key; {hint} `hemma settings` prints all of them"
