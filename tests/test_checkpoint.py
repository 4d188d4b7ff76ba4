"""Checkpoints: what was saved comes back bit for bit, and anything else is refused."""

import os
import stat

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from safetensors.numpy import save

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


@pytest.fixture
def umask():
    before = os.umask(0o027)
    yield
    os.umask(before)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.usefixtures("umask")
def test_a_new_file_follows_the_umask_and_a_replaced_one_keeps_its_mode(tmp_path):
    write_atomically(tmp_path / "new", b"new")
    assert mode(tmp_path / "new") == 0o640
    (tmp_path / "secret").write_bytes(b"old")
    (tmp_path / "secret").chmod(0o600)
    write_atomically(tmp_path / "secret", b"new")
    assert mode(tmp_path / "secret") == 0o600
    assert (tmp_path / "secret").read_bytes() == b"new"


def test_a_write_protected_file_stays_as_it_is(tmp_path):
    (tmp_path / "mine").write_bytes(b"old")
    (tmp_path / "mine").chmod(0o444)
    with pytest.raises(PermissionError, match="write-protected"):
        write_atomically(tmp_path / "mine", b"new")
    assert (tmp_path / "mine").read_bytes() == b"old"


def test_a_link_is_written_through(tmp_path):
    (tmp_path / "there").mkdir()
    for name in ("old", "missing"):
        (tmp_path / name).symlink_to(tmp_path / "there" / name)
    (tmp_path / "there" / "old").write_bytes(b"old")
    for name in ("old", "missing"):
        write_atomically(tmp_path / name, b"new")
        assert (tmp_path / name).is_symlink()
        assert (tmp_path / "there" / name).read_bytes() == b"new"
    assert sorted(file.name for file in (tmp_path / "there").iterdir()) == ["missing", "old"]


def test_a_pipe_is_written_and_not_replaced(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    reading = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    write_atomically(tmp_path / "pipe", b"new")
    assert os.read(reading, 10) == b"new"
    os.close(reading)
    assert (tmp_path / "pipe").is_fifo()


@pytest.mark.parametrize("header", [None, "[]", "{", "[" * 100_000])
def test_a_damaged_header_is_refused(tmp_path, header):
    path = tmp_path / "state.safetensors"
    path.write_bytes(save({}, metadata=None if header is None else {"hemma": header}))
    with pytest.raises(HemmaError, match="another safetensors file"):
        load_header(path)
