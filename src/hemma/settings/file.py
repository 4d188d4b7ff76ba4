"""Settings as YAML, read and written: one clear message for an unknown key or a value that cannot be."""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from hemma.errors import HemmaError
from hemma.settings.experiment import Experiment
from hemma.settings.keys import explanations, in_keys_of_today, inside, key_of, outside, section, shown
from hemma.settings.yaml_file import place_in, read_yaml


def read_settings(path: Path) -> Experiment:
    """The experiment that a YAML file describes; what it leaves out keeps its default.

    Raises ``HemmaError`` with the file, the key and the cure for a file that cannot be read, an unknown
    key, and a value of the wrong kind or out of range.
    """
    return experiment_of(read_yaml(path), path)


def experiment_of(given: Any, path: Path) -> Experiment:
    """The experiment that keys and values, found in the file ``path``, describe; see ``read_settings``."""
    given = in_keys_of_today(Experiment, given)
    content = _merged(outside(Experiment()), {} if given is None else given)
    try:
        return inside(Experiment, section(Experiment).model_validate(content), given)
    except ValidationError as error:
        raise HemmaError(f"{path}: {_explained(error, given)}") from error
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


def _explained(error: ValidationError, given: Any) -> str:
    first = error.errors()[0]
    loc, came = first["loc"], first["input"]
    where = place_in(given, loc)
    if first["type"] == "extra_forbidden":
        return f"{where}: unknown key; {_meant(loc)} `hemma settings` prints all of them"
    if first["type"] == "value_error":
        return f"{where}: {first['msg'].removeprefix('Value error, ')}"
    if first["type"] == "model_type":
        return (
            f"{where}: expected lines such as `{next(iter(_known(loc)))}: ...`, got {shown(came)}. Correct it"
        )
    expected = {
        "tuple_type": "expected a list such as [1, 2]",
        "missing": "expected one value more",
        "bool_type": "expected true or false",
        "bool_parsing": "expected true or false",
    }.get(first["type"], first["msg"])
    return f"{where}: {expected}, got {shown(came)}. Correct it"


def _meant(loc: Sequence[str | int]) -> str:
    """Which key an unknown one probably stands for."""
    known = _known(loc[:-1])
    names = {name: key for key, name in known.items()}
    near = difflib.get_close_matches(str(loc[-1]), [*known, *names], 1)
    return (
        f"did you mean {names.get(near[0], near[0])}?" if near else f"the keys there are {', '.join(known)};"
    )


def _known(loc: Sequence[str | int]) -> dict[str, str]:
    """The keys of a section, and the parameters that they stand for."""
    keys: Any = section(Experiment)
    for part in loc:
        keys = next(one.annotation for one in keys.model_fields.values() if one.alias == part)
    return {str(one.alias): name for name, one in keys.model_fields.items()}
