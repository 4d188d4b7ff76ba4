"""Models and training states on disk: safetensors with a JSON header, written whole or not at all."""

import errno
import json
import os
import secrets
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import jax
import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from hemma.errors import HemmaError

Tree = TypeVar("Tree")


def write_atomically(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` by way of a temporary name in the same folder, then rename.

    A symbolic link is written through. A new file has the mode that the umask leaves, a replaced one keeps
    its own; one that may not be written is refused, and a device or a pipe is written as it is.
    """
    target = Path(os.path.realpath(path))
    mode = _mode(target)
    if mode is not None and not stat.S_ISREG(mode):
        target.write_bytes(content)
        return
    if mode is not None and not (mode & 0o222 and os.access(target, os.W_OK)):
        raise PermissionError(errno.EACCES, "it is write-protected", str(path))
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{secrets.token_hex(8)}.partial")
    try:
        with open(temporary, "xb") as file:
            file.write(content)
        if mode is not None:
            temporary.chmod(stat.S_IMODE(mode))
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _mode(path: Path) -> int | None:
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def save_tree(path: Path, tree: Any, header: Mapping[str, Any]) -> None:
    """Save the leaves of a pytree by their paths, with ``header`` (anything JSON can say) beside them.

    Random keys are stored as their raw data. The structure is not stored: ``load_tree`` takes it from a
    tree of the same kind.
    """
    tensors = {name: _raw(leaf) for name, leaf in _named_leaves(tree)}
    write_atomically(path, save(tensors, metadata={"hemma": json.dumps(dict(header))}))


def load_tree(path: Path, like: Tree) -> Tree:
    """Load what ``save_tree`` saved into the structure of ``like``; shapes and names must agree.

    Each leaf comes back as what it is in ``like``: a JAX array, a NumPy array or a Python number.
    """
    with _opened(path) as file:
        stored = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
    expected = _named_leaves(like)
    if {name for name, _ in expected} != set(stored):
        missing = sorted({name for name, _ in expected} ^ set(stored))
        raise HemmaError(
            f"{path}: not a checkpoint of this kind; entries {missing[:4]} differ. Train it again"
        )
    leaves = [_restored(path, name, stored[name], leaf) for name, leaf in expected]
    return jax.tree.unflatten(jax.tree.structure(like), leaves)


def load_shapes(path: Path) -> dict[str, tuple[int, ...]]:
    """Paths and shapes of the leaves that ``save_tree`` saved: what a structure to load them into needs."""
    with _opened(path) as file:
        return {name: tuple(file.get_slice(name).get_shape()) for name in file.keys()}  # noqa: SIM118


def load_header(path: Path) -> dict[str, Any]:
    """The header that was saved with a checkpoint."""
    with _opened(path) as file:
        metadata = file.metadata() or {}
    try:
        header = json.loads(metadata["hemma"])
    except (KeyError, ValueError, RecursionError):
        header = None
    if not isinstance(header, dict):
        raise HemmaError(f"{path}: expected a Hemma checkpoint, found another safetensors file")
    return header


def _opened(path: Path):
    try:
        return safe_open(path, framework="numpy")
    except (OSError, SafetensorError) as error:
        raise HemmaError(
            f"{path}: expected a Hemma checkpoint (.safetensors), cannot read it: {error}"
        ) from error


def _named_leaves(tree: Any) -> list[tuple[str, Any]]:
    return [(jax.tree_util.keystr(path), leaf) for path, leaf in jax.tree_util.tree_leaves_with_path(tree)]


def _is_key(leaf: Any) -> bool:
    return isinstance(leaf, jax.Array) and jax.numpy.issubdtype(leaf.dtype, jax.dtypes.prng_key)


def _raw(leaf: Any) -> np.ndarray:
    return np.asarray(jax.random.key_data(leaf) if _is_key(leaf) else leaf, order="C")


def _restored(path: Path, name: str, stored: np.ndarray, like: Any) -> Any:
    if stored.shape != _raw(like).shape:
        raise HemmaError(
            f"{path}: {name} has shape {stored.shape}, expected {_raw(like).shape}. Train it again"
        )
    if _is_key(like):
        return jax.random.wrap_key_data(jax.numpy.asarray(stored))
    if isinstance(like, jax.Array):
        return jax.numpy.asarray(stored, dtype=like.dtype)
    if isinstance(like, np.ndarray):
        return stored.astype(like.dtype)
    return type(like)(stored.item())
