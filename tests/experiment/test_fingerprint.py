"""Fingerprints: equal for equal content, different for any difference that matters."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

import hemma
from hemma.home import Battery, Home
from hemma.results.fingerprint import code, fingerprint, source_digest
from hemma.settings.experiment import Experiment


def test_equal_content_has_an_equal_fingerprint():
    assert fingerprint("train", Experiment(), np.arange(3.0)) == fingerprint(
        "train", Experiment(), np.arange(3.0)
    )


@pytest.mark.parametrize(
    "other",
    [
        ("identify", Home(), (1, 2)),
        ("train", Home(battery=Battery(max_energy=6.000001)), (1, 2)),
        ("train", Home(), (1, 3)),
        ("train", Home(), (1, 2), None),
        ("train", Home(), (1, np.float32(2))),
    ],
)
def test_any_difference_shows(other):
    assert fingerprint("train", Home(), (1, 2)) != fingerprint(*other)


def test_one_digit_of_one_number_of_the_traces_shows():
    trace = np.linspace(0.0, 1.0, 1000)
    changed = trace.copy()
    changed[500] = np.nextafter(changed[500], 1.0)
    assert fingerprint("case", trace) != fingerprint("case", changed)
    assert fingerprint("case", trace) != fingerprint("case", trace.reshape(2, 500))


def test_another_version_of_hemma_makes_everything_anew(monkeypatch):
    before = fingerprint("train", Experiment())
    monkeypatch.setattr(hemma, "__version__", "99.0")
    assert fingerprint("train", Experiment()) != before


def test_nested_settings_count():
    experiment = Experiment()
    ppo = replace(experiment.ppo, discount=0.9)
    other = replace(experiment, ppo=ppo)
    assert fingerprint("train", experiment) != fingerprint("train", other)


def test_what_cannot_be_covered_is_refused():
    with pytest.raises(TypeError, match="cannot cover a set"):
        fingerprint("train", {1, 2})


def test_a_function_counts_by_where_it_is_defined():
    assert fingerprint("x", fingerprint) == fingerprint("x", fingerprint)
    assert fingerprint("x", fingerprint) != fingerprint("x", source_digest)


def test_arrays_of_jax_count_like_those_of_numpy():
    assert fingerprint("x", jnp.arange(3, dtype=jnp.float32)) == fingerprint(
        "x", np.arange(3, dtype=np.float32)
    )


def test_a_changed_renamed_or_added_source_file_shows(tmp_path):
    layer = tmp_path / "rl"
    (layer / "deep").mkdir(parents=True)
    (layer / "ppo.py").write_text("gamma = 0.95\n")
    (layer / "deep" / "net.py").write_text("width = 64\n")
    (layer / "notes.txt").write_text("not code")
    seen = {source_digest([layer])}
    (layer / "notes.txt").write_text("still not code")
    assert source_digest([layer]) in seen
    for change in (
        lambda: (layer / "deep" / "net.py").write_text("width = 32\n"),
        lambda: (layer / "ppo.py").rename(layer / "trpo.py"),
        lambda: (layer / "new.py").write_text(""),
    ):
        change()
        digest = source_digest([layer])
        assert digest not in seen
        seen.add(digest)


def test_layers_have_digests_of_their_own():
    assert code("rl") != code("irl") != code("rl", "irl")
