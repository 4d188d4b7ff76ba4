"""One step of a gradient method on a module: where Optax's types meet Equinox's."""

from typing import Any, TypeVar

import equinox as eqx
import jax
import optax

from hemma.types import Array

Module = TypeVar("Module")


def begin(method: optax.GradientTransformation, module: Any) -> optax.OptState:
    """The method's initial state for a module all of whose leaves are trained arrays."""
    return method.init(module)


def descend(
    method: optax.GradientTransformation,
    gradient: Any,
    state: optax.OptState,
    module: Module,
    share: Array | float = 1.0,
) -> tuple[Module, optax.OptState]:
    """The module after this ``share`` of a step along ``gradient``, and the method's next state."""
    updates, state = method.update(gradient, state, module)  # type: ignore[arg-type]
    return eqx.apply_updates(module, jax.tree.map(lambda u: share * u, updates)), state
