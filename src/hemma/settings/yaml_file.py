"""YAML as settings need it: plain mappings, lists, numbers and words, nothing that is built or expanded."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from hemma.errors import HemmaError, shortened

LARGEST = 100_000
"""Of a settings file [bytes]; all of Hemma's settings with their explanations take an eighth of it."""
DEEPEST = 16
"""Levels of a settings file; Hemma's have three."""
LONGEST_NUMBER = 40
"""Characters of a number."""

NUMBER = re.compile(r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?")
SPECIAL = re.compile(r"[-+]?\.inf|\.nan", re.IGNORECASE)
SWITCHES = {"yes": True, "true": True, "on": True, "no": False, "false": False, "off": False}
NOTHING = ("", "~", "null")


class YamlMapping(dict[str, Any]):
    """A mapping of the file."""

    lines: dict[str, int]
    """The line of each key, counted from 1."""


def read_yaml(path: Path) -> Any:
    """What a settings file holds; None where it is empty.

    Raises ``HemmaError`` with file and line where it is no plain YAML: anchors, aliases, merge keys, tags and
    keys that stand twice are refused.
    """
    text = _text(path)
    start = "expected YAML such as `seeds: 3`, indented by spaces"
    try:
        node = _Composer(text).get_single_node()
        return None if node is None else _content(node)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "" if mark is None else f"line {mark.line + 1}: "
        problem = shortened(error.problem or error.context or "it is none")
        raise HemmaError(f"{path}: {line}{start}: {problem}. Correct it") from error
    except yaml.reader.ReaderError as error:
        line = text[: error.position].count("\n") + 1
        raise HemmaError(
            f"{path}: line {line}: {start}, got a control character. Save it as plain UTF-8 text"
        ) from error


def place_in(content: Any, keys: Sequence[str | int]) -> str:
    """``line 3: comfort.low_c``: where a setting stands, or would stand; the line where it is known."""
    line, inner = None, content
    for key in keys:
        if isinstance(inner, YamlMapping):
            line = inner.lines.get(str(key), line)
        inner = inner.get(str(key)) if isinstance(inner, Mapping) else None
    name = ".".join(shortened(key) for key in keys) or "the file"
    return name if line is None else f"line {line}: {name}"


def _text(path: Path) -> str:
    start = f"{path}: expected a settings file (YAML)"
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except OSError as error:
        raise HemmaError(f"{start}, cannot read it: {error.strerror or error}. Name another") from error
    if len(content) > LARGEST:
        raise HemmaError(f"{start} of at most {LARGEST} bytes, this one is larger. Is it another file?")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise HemmaError(
            f"{start}, cannot read it: line {line} is not UTF-8 text. Save it as plain UTF-8 text"
        ) from error


class _Composer(yaml.SafeLoader):
    """Looks at each piece before anything is made of it."""

    depth = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        event = self.peek_event()
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None) is not None:
            raise _refused("& and * (anchors, aliases) are not read; write values out", event.start_mark)
        if getattr(event, "tag", None) is not None:
            raise _refused("tags (words that begin with !) are not read; leave it out", event.start_mark)
        self.depth += 1
        if self.depth > DEEPEST:
            raise _refused(f"more than {DEEPEST} levels", event.start_mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


def _refused(problem: str, mark: yaml.Mark) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


def _content(node: yaml.Node) -> Any:
    if isinstance(node, yaml.MappingNode):
        return _section(node)
    if isinstance(node, yaml.SequenceNode):
        return [_content(item) for item in node.value]
    assert isinstance(node, yaml.ScalarNode)
    return _plain(node) if node.style is None else _word(node)


def _section(node: yaml.MappingNode) -> YamlMapping:
    section = YamlMapping()
    section.lines = {}
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise _refused("expected a word as key", key.start_mark)
        name = _word(key)
        if name == "<<":
            raise _refused("merge keys (<<) are not read; write the values out", key.start_mark)
        if name in section:
            raise _refused(f"the key {name[:30]} stands twice", key.start_mark)
        section[name] = _content(value)
        section.lines[name] = key.start_mark.line + 1
    return section


def _word(node: yaml.Node) -> str:
    if not node.value.isprintable():
        raise _refused("a word with characters that cannot be shown", node.start_mark)
    return node.value


def _plain(node: yaml.Node) -> Any:
    """A word without quotes: nothing, a switch, a decimal number, or else the word."""
    word = _word(node)
    if word.lower() in NOTHING:
        return None
    if word.lower() in SWITCHES:
        return SWITCHES[word.lower()]
    if SPECIAL.fullmatch(word):
        return float(word.replace(".", "", 1))
    if not NUMBER.fullmatch(word):
        return word
    if len(word) > LONGEST_NUMBER:
        raise _refused(f"a number of {len(word)} characters", node.start_mark)
    return int(word) if word.lstrip("+-").isdigit() else float(word)
