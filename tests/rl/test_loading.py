"""Controllers come off the disk as they were trained, and nothing but their file says of what sizes."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.checkpoint import save_tree
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.rl.loading import load_controllers
from hemma.rl.policies.committee import CommitteePolicy
from hemma.rl.policies.policy import PolicyController, StochasticPolicy
from hemma.rl.policies.scaling import StateScaler
from hemma.rl.policies.spaces import FRACTIONS, STORED_VALUE


def filled(tree, axes):
    """Random numbers of the same structure, with these axes before those of each leaf."""
    rng = np.random.default_rng(0)
    return jax.tree.map(lambda x: jnp.asarray(rng.normal(size=(*axes, *np.shape(x))), float), tree)


@pytest.mark.parametrize(
    ("axes", "sizes", "features", "space"),
    [
        ((2,), (), 8, FRACTIONS),
        ((2,), (7, 5), 20, STORED_VALUE),
        ((2, 3), (4,), 8, FRACTIONS),
        ((2, 3), (4,), 8, STORED_VALUE),
    ],
)
def test_stored_controllers_come_back_bit_for_bit(tmp_path, axes, sizes, features, space):
    policy = filled(StochasticPolicy(sizes, jax.random.key(0), features, space), axes)
    kept = PolicyController(
        policy=CommitteePolicy(policy) if len(axes) > 1 else policy,
        scaler=filled(StateScaler(jnp.zeros(6), jnp.ones(6)), axes[:1]),
        planning_home=filled(Home(), axes[:1]),
    )
    save_tree(tmp_path / "c.safetensors", kept, {} if space is FRACTIONS else {"actions": space.name})
    again = load_controllers(tmp_path / "c.safetensors", Home())
    assert jax.tree.structure(again) == jax.tree.structure(kept)
    for one, other in zip(jax.tree.leaves(kept), jax.tree.leaves(again), strict=True):
        np.testing.assert_array_equal(one, other)


def test_actions_of_a_later_version_are_refused(tmp_path):
    policy = filled(StochasticPolicy((4,), jax.random.key(0)), (1,))
    scaler, home = filled(StateScaler(jnp.zeros(6), jnp.ones(6)), (1,)), filled(Home(), (1,))
    save_tree(tmp_path / "c.safetensors", PolicyController(policy, scaler, home), {"actions": "set points"})
    with pytest.raises(HemmaError, match=r"one of fractions, stored value, got set points.*later version"):
        load_controllers(tmp_path / "c.safetensors", Home())


def test_another_checkpoint_is_refused_with_where_to_look(tmp_path):
    save_tree(tmp_path / "other.safetensors", StateScaler(jnp.zeros(6), jnp.ones(6)), {})
    with pytest.raises(HemmaError, match=r"expected trained controllers.*models/HOME/METHOD\.safetensors"):
        load_controllers(tmp_path / "other.safetensors", Home())
