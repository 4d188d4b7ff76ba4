"""Cards of finished stages: whatever is damaged counts as not done."""

import json

import pytest

from hemma.results.progress import Silence
from hemma.results.store import Store

CONTENT = {"errors": [["1 h", 0.1]], "seconds": 1e-3, "by day": {1: "one", 10: "ten", 9: "nine"}}


@pytest.fixture
def store(tmp_path):
    store = Store(tmp_path, "cottage", Silence())
    (tmp_path / "models" / "cottage").mkdir(parents=True)
    (tmp_path / store.model("network.bin")).write_bytes(b"weights")
    store.keep("network", "mark", [store.model("network.bin")], CONTENT)
    return store


def card(store):
    return store.folder / store.model("network.json")


def test_what_was_kept_comes_back(store):
    assert store.kept("network", "mark") == json.loads(json.dumps(CONTENT))
    assert store.kept("network", "other") is None
    assert store.mark_of("network") == "mark"


def test_a_changed_file_is_noticed(store):
    (store.folder / store.model("network.bin")).write_bytes(b"others")
    assert store.kept("network", "mark") is store.mark_of("network") is None


@pytest.mark.parametrize("key", ["fingerprint", "files", "content", "seal"])
@pytest.mark.parametrize(
    "value", ["missing", None, [], {}, 3, "x", ["models/cottage/network.bin"], {"x": None}]
)
def test_a_damaged_card_is_none(store, key, value):
    found = json.loads(card(store).read_text())
    found[key] = value
    if value == "missing":
        del found[key]
    card(store).write_text(json.dumps(found))
    assert store.kept("network", "mark") is store.mark_of("network") is None
    store.keep("network", "mark", [], CONTENT)
    assert store.kept("network", "mark") is not None


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", "[" * 200_000, "\ufeff{}", "1" * 5000, '{"seal": "\\u0000"}']
)
def test_a_card_that_is_none(store, text):
    card(store).write_text(text)
    assert store.kept("network", "mark") is store.mark_of("network") is None
