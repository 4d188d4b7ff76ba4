"""The action spaces there are; a new one is one file and one line here."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hemma.errors import HemmaError, shortened
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.fractions import Fractions
from hemma.rl.policies.stored_value import StoredValue

FRACTIONS: ActionSpace = Fractions()
STORED_VALUE: ActionSpace = StoredValue()
SPACES = {space.name: space for space in (FRACTIONS, STORED_VALUE)}
"""By the names that settings and files have."""


def space_of(path: Path, header: Mapping[str, Any]) -> ActionSpace:
    """That of the policies or rewards of a file; one of before there was a choice does not say."""
    name = header.get("actions", FRACTIONS.name)
    if name not in SPACES:
        raise HemmaError(
            f"{path}: expected actions that are one of {', '.join(SPACES)}, got {shortened(str(name))}; the "
            "file is damaged or of a later version of Hemma"
        )
    return SPACES[name]
