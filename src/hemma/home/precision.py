"""Numbers of a pytree in float64: for compiled code that new values do not recompile, and for solvers."""

from typing import TypeVar

import jax
import jax.numpy as jnp
import numpy as np

Tree = TypeVar("Tree")


def in_double(tree: Tree) -> Tree:
    """Every float and floating array of ``tree`` as a JAX array of float64.

    Call it inside ``with jax.enable_x64(True)``. Integers, keys and anything else stay as they are.
    """
    return jax.tree.map(lambda leaf: jnp.asarray(leaf, float) if _is_number(leaf) else leaf, tree)


def in_numpy(tree: Tree) -> Tree:
    """Every float and floating array of ``tree`` as NumPy float64, ready for arithmetic outside JAX."""
    return jax.tree.map(lambda leaf: np.asarray(leaf, np.float64)[()] if _is_number(leaf) else leaf, tree)


def _is_number(leaf: object) -> bool:
    array = isinstance(leaf, jax.Array | np.ndarray | np.generic)
    return isinstance(leaf, float) or (array and jnp.issubdtype(leaf.dtype, jnp.floating))
