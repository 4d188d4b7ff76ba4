"""One way to refuse a parameter that makes no sense."""

from typing import Any

from jax.core import Tracer

from hemma.errors import ParameterError


def require(owner: str, holds: Any, expected: str, came: Any) -> None:
    """Raise a ``HemmaError`` unless ``holds``; traced values pass, they were checked outside."""
    if isinstance(holds, Tracer) or isinstance(came, Tracer):
        return
    if not bool(holds):
        raise ParameterError(owner, expected, came)
