"""The learned reward r = g + gamma h' - h, equation (11) of the paper (Fu et al. 2018)."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl.environment import Transitions
from hemma.rl.network import Network
from hemma.rl.policy import ACTIONS, FEATURES
from hemma.types import Array


class ShapedReward(eqx.Module):
    """The reward approximator g(s, a) and the shaping term h(s)."""

    approximator: Network
    """g."""
    shaping: Network
    """h."""
    discount: float = eqx.field(static=True)
    """gamma."""

    def __init__(self, hidden: tuple[int, ...], discount: float, key: Array):
        """Random weights."""
        g_key, h_key = jax.random.split(key)
        self.approximator = Network((FEATURES + ACTIONS, *hidden, 1), g_key)
        self.shaping = Network((FEATURES, *hidden, 1), h_key)
        self.discount = discount

    def __call__(self, transition: Transitions) -> Float[Array, ""]:
        """r(s, a, s') = g(s, a) + gamma h(s') - h(s) of one transition."""
        inputs = jnp.concatenate([transition.features, transition.fractions])
        g = self.approximator(inputs)[0]
        return (
            g
            + self.discount * self.shaping(transition.next_features)[0]
            - self.shaping(transition.features)[0]
        )

    def batch(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """r of many transitions at once."""
        shape = transitions.fractions.shape[:-1]
        flat = jax.tree.map(lambda x: x.reshape(-1, x.shape[-1]), transitions)
        return jax.vmap(self)(flat).reshape(shape)
