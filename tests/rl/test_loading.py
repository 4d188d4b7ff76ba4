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
from hemma.rl.policies.policy import GaussianPolicy, PolicyController
from hemma.rl.policies.scaling import StateScaler


def filled(tree, axes):
    """Random numbers of the same structure, with these axes before those of each leaf."""
    rng = np.random.default_rng(0)
    return jax.tree.map(lambda x: jnp.asarray(rng.normal(size=(*axes, *np.shape(x))), float), tree)


@pytest.mark.parametrize(
    ("axes", "sizes", "features"), [((2,), (), 8), ((2,), (7, 5), 20), ((2, 3), (4,), 8)]
)
def test_stored_controllers_come_back_bit_for_bit(tmp_path, axes, sizes, features):
    policy = filled(GaussianPolicy(sizes, jax.random.key(0), features), axes)
    kept = PolicyController(
        policy=CommitteePolicy(policy) if len(axes) > 1 else policy,
        scaler=filled(StateScaler(jnp.zeros(6), jnp.ones(6)), axes[:1]),
        planning_home=filled(Home(), axes[:1]),
    )
    save_tree(tmp_path / "c.safetensors", kept, {})
    again = load_controllers(tmp_path / "c.safetensors", Home())
    assert jax.tree.structure(again) == jax.tree.structure(kept)
    for one, other in zip(jax.tree.leaves(kept), jax.tree.leaves(again), strict=True):
        np.testing.assert_array_equal(one, other)


def test_another_checkpoint_is_refused_with_where_to_look(tmp_path):
    save_tree(tmp_path / "other.safetensors", StateScaler(jnp.zeros(6), jnp.ones(6)), {})
    with pytest.raises(HemmaError, match=r"expected trained controllers.*models/HOME/METHOD\.safetensors"):
        load_controllers(tmp_path / "other.safetensors", Home())
