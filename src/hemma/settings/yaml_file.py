"""YAML as settings need it: plain mappings, lists, numbers and words, nothing that is built or expanded."""

import re
from collections.abc import Hashable
from pathlib import Path
from typing import Any

import yaml

from hemma.errors import HemmaError, shortened

LARGEST = 1_000_000
"""Of a settings file [bytes]."""
DEEPEST = 16
"""Levels of a settings file; Hemma's have three."""
LONGEST_NUMBER = 40
"""Characters of a number."""


def read_yaml(path: Path) -> Any:
    """What a settings file holds; None where it is empty.

    Raises ``HemmaError`` with file and line where it is no plain YAML: anchors, aliases, merge keys, tags and
    keys that stand twice are refused.
    """
    text = _text(path)
    try:
        _require_plain(text)
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "" if mark is None else f"line {mark.line + 1}: "
        problem = shortened(error.problem or error.context or "it is no YAML")
        raise HemmaError(f"{path}: {line}expected YAML, for example `seeds: 3`: {problem}") from error
    except yaml.YAMLError as error:
        raise HemmaError(
            f"{path}: expected YAML, for example `seeds: 3`: {shortened(error)}. Save it as plain UTF-8 text"
        ) from error


def _text(path: Path) -> str:
    start = f"{path}: expected a settings file (YAML)"
    try:
        content = path.read_bytes()
    except OSError as error:
        raise HemmaError(f"{start}, cannot read it: {error.strerror or error}") from error
    if len(content) > LARGEST:
        raise HemmaError(f"{start} of at most {LARGEST} bytes, cannot read it: it has {len(content)}")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise HemmaError(f"{start}, cannot read it: line {line} is not UTF-8 text") from error


def _require_plain(text: str) -> None:
    """Look at the file piece by piece, before anything is built from it."""
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        mark = event.start_mark
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None) is not None:
            raise _refused("anchors and aliases (& and *) are not understood; write the values out", mark)
        if getattr(event, "tag", None) is not None:
            raise _refused(f"tags such as {shortened(event.tag)} are not understood; leave it out", mark)
        if isinstance(event, yaml.ScalarEvent) and event.value == "<<" and event.style is None:
            raise _refused("merge keys (<<) are not understood; write the values out", mark)
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > DEEPEST:
            raise _refused(f"more than {DEEPEST} levels", mark)


def _refused(problem: str, mark: yaml.Mark) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


class _Loader(yaml.SafeLoader):
    """Knows words, decimal numbers, switches and null; refuses a key that stands twice."""

    yaml_implicit_resolvers: dict = {}  # noqa: RUF012 - the class's own table of the library, filled below

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen: set[str] = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise _refused("expected a word as key", key.start_mark)
            if key.value in seen:
                raise _refused(f"the key {shortened(key.value)} stands twice", key.start_mark)
            seen.add(key.value)
        return super().construct_mapping(node, deep)

    def number(self, node: yaml.ScalarNode) -> int | float:
        """A decimal number."""
        if len(node.value) > LONGEST_NUMBER:
            raise _refused(f"a number of {len(node.value)} characters", node.start_mark)
        return int(node.value) if re.fullmatch(r"[-+]?[0-9]+", node.value) else float(node.value)

    def special(self, node: yaml.ScalarNode) -> float:
        """.inf and .nan, which every setting refuses by name."""
        return float(node.value.replace(".", "", 1))


_NUMBER = re.compile(r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?\Z")
_SPECIAL = re.compile(r"[-+]?\.(inf|Inf|INF)\Z|\.(nan|NaN|NAN)\Z")
_SWITCH = re.compile(r"(yes|Yes|YES|no|No|NO|true|True|TRUE|false|False|FALSE|on|On|ON|off|Off|OFF)\Z")
_NULL = re.compile(r"(~|null|Null|NULL|)\Z")
_Loader.add_implicit_resolver("tag:yaml.org,2002:int", _NUMBER, list("-+.0123456789"))
_Loader.add_implicit_resolver("tag:yaml.org,2002:float", _SPECIAL, list("-+."))
_Loader.add_implicit_resolver("tag:yaml.org,2002:bool", _SWITCH, list("yYnNtTfFoO"))
_Loader.add_implicit_resolver("tag:yaml.org,2002:null", _NULL, ["~", "n", "N", ""])
_Loader.add_constructor("tag:yaml.org,2002:int", _Loader.number)
_Loader.add_constructor("tag:yaml.org,2002:float", _Loader.special)
