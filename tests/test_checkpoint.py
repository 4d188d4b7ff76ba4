"""Checkpoints: what was saved comes back bit for bit, and anything else is refused."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.checkpoint import load_header, load_shapes, load_tree, save_tree, write_atomically
from hemma.errors import HemmaError


def tree(seed=0):
    random = np.random.default_rng(seed)
    return {
        "scalar": jnp.asarray(random.normal(), jnp.float32),
        "counter": jnp.asarray(seed + 7),
        "key": jax.random.key(seed),
        "keys": jax.random.split(jax.random.key(seed), 3),
        "double": random.normal(size=(2, 3)),
        "number": random.normal(),
        "columns": jnp.asarray(random.normal(size=(3, 4)), jnp.float32).T,
    }


def test_every_kind_of_leaf_comes_back_bit_for_bit(tmp_path):
    path = tmp_path / "state.safetensors"
    save_tree(path, tree(1), {"fingerprint": "abc", "seconds": 1.5})
    back = load_tree(path, tree(2))
    for name, leaf in tree(1).items():
        assert type(back[name]) is type(leaf)
        if isinstance(leaf, jax.Array | np.ndarray):
            assert back[name].dtype == leaf.dtype
            assert back[name].shape == leaf.shape
        same = back[name] == leaf
        assert jnp.all(same), name
    assert load_header(path) == {"fingerprint": "abc", "seconds": 1.5}


def test_shapes_are_known_without_the_structure(tmp_path):
    path = tmp_path / "state.safetensors"
    save_tree(path, {"a": (jnp.zeros(()), jnp.zeros((2, 3)))}, {})
    assert load_shapes(path) == {"['a'][0]": (), "['a'][1]": (2, 3)}


def test_another_structure_is_refused(tmp_path):
    path = tmp_path / "state.safetensors"
    save_tree(path, {"a": jnp.zeros(3)}, {})
    with pytest.raises(HemmaError, match="not a checkpoint of this kind"):
        load_tree(path, {"b": jnp.zeros(3)})
    with pytest.raises(HemmaError, match=r"shape \(3,\), expected \(4,\)"):
        load_tree(path, {"a": jnp.zeros(4)})


def test_a_file_that_is_no_checkpoint_is_refused(tmp_path):
    path = tmp_path / "state.safetensors"
    path.write_bytes(b"not a checkpoint")
    with pytest.raises(HemmaError, match="expected a Hemma checkpoint"):
        load_header(path)
    with pytest.raises(HemmaError, match="cannot read it"):
        load_tree(tmp_path / "missing.safetensors", {})


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "results.json"
    write_atomically(path, b"old")

    def broken(*_):
        raise OSError("disk full")

    monkeypatch.setattr("os.replace", broken)
    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert [file.name for file in tmp_path.iterdir()] == ["results.json"]
