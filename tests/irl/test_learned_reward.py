"""The learned reward on disk and off: the same numbers, and g and r differ by shaping alone."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from probe_worlds import transitions

from hemma.checkpoint import load_header, save_tree
from hemma.errors import HemmaError
from hemma.irl.learned_reward import LearnedReward, load_rewards, save_rewards
from hemma.irl.reoptimise import ground
from hemma.irl.reward import ShapedReward
from hemma.rl.policies.scaling import StateScaler


def learned(runs=3, hidden=(7, 5)):
    heads = eqx.filter_vmap(lambda key: ShapedReward.random(hidden, 0.9, key))(
        jax.random.split(jax.random.key(0), runs)
    )
    rng = np.random.default_rng(0)
    scalers = [
        StateScaler(jnp.asarray(rng.normal(size=6), float), jnp.asarray(rng.uniform(1, 2, 6), float))
        for _ in range(runs)
    ]
    return LearnedReward(heads, jax.tree.map(lambda *leaves: jnp.stack(leaves), *scalers))


def test_a_stored_reward_pays_the_same_bit_for_bit(tmp_path):
    kept = learned()
    save_rewards(tmp_path / "r.safetensors", kept, {"seeds": [0, 1, 2]})
    again = load_rewards(tmp_path / "r.safetensors")
    assert jax.tree.structure(again) == jax.tree.structure(kept)
    assert load_header(tmp_path / "r.safetensors")["seeds"] == [0, 1, 2]
    assert again.runs == 3
    for run in range(3):
        batch = transitions(9, seed=run)
        paid = [one.run(run).head.rewards(batch) for one in (kept, again)]
        np.testing.assert_array_equal(paid[0], paid[1])
        states = jnp.asarray(np.random.default_rng(run).normal(size=(4, 7)), float)
        np.testing.assert_array_equal(kept.run(run).scaler(states), again.run(run).scaler(states))


@pytest.mark.slow
def test_members_of_a_committee_are_one_more_axis(tmp_path):
    heads = eqx.filter_vmap(eqx.filter_vmap(lambda key: ShapedReward.random((4,), 0.9, key)))(
        jax.random.split(jax.random.key(0), (2, 3))
    )
    kept = LearnedReward(heads, learned(runs=2).scaler)
    save_rewards(tmp_path / "r.safetensors", kept, {})
    again = load_rewards(tmp_path / "r.safetensors")
    for a, b in zip(jax.tree.leaves(kept), jax.tree.leaves(again), strict=True):
        np.testing.assert_array_equal(a, b)
    assert (again.runs, again.members, learned().members) == (2, 3, 1)
    one, third = again.run(1, member=2), jax.tree.map(lambda x: x[1, 2], heads)
    np.testing.assert_array_equal(one.head.rewards(transitions(9)), third.rewards(transitions(9)))


def test_another_checkpoint_is_refused_with_where_to_look(tmp_path):
    save_tree(tmp_path / "policy.safetensors", learned(), {"kind": "policy"})
    with pytest.raises(HemmaError, match=r"expected a learned reward.*reward\.safetensors"):
        load_rewards(tmp_path / "policy.safetensors")


def test_r_less_g_telescopes_along_a_trajectory():
    """sum gamma^t (r_t - g_t) = gamma^T h(s_T) - h(s_0), whatever is done between."""
    head = learned().run(0).head
    batch = transitions(9)
    path = jax.tree.map(
        lambda x: x[:8], eqx.tree_at(lambda t: t.next_features, batch, jnp.roll(batch.features, -1, 0))
    )
    shaping = jnp.sum(0.9 ** jnp.arange(8) * (head.rewards(path) - ground(head).rewards(path)))
    ends = 0.9**8 * head.shaping(batch.features[8])[0] - head.shaping(batch.features[0])[0]
    np.testing.assert_allclose(shaping, ends, rtol=1e-4, atol=1e-5)
