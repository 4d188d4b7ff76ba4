"""The action value Q(s, a) of DDPG."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl.policies.network import Network
from hemma.rl.policies.policy import ACTIONS, FEATURES
from hemma.types import Array


class Rectified(eqx.Module):
    """Affine layers with max(0, x) between them; the last layer is linear.

    What comfort costs has a kink at each end of the band and nothing inside. Smooth units round it off, and
    an actor that follows their slope keeps well away from the end where HVAC power is saved.
    """

    weights: tuple[Float[Array, "_ _"], ...]
    biases: tuple[Float[Array, "_"], ...]

    def __init__(self, sizes: tuple[int, ...], key: Array):
        """Layers of these ``sizes``, input first, that start as those of ``Network`` do."""
        start = Network(sizes, key)
        self.weights, self.biases = start.weights, start.biases

    def __call__(self, inputs: Float[Array, "inputs"]) -> Float[Array, "outputs"]:
        """Output of shape (outputs,) for one input."""
        hidden = inputs
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            hidden = jax.nn.relu(weight @ hidden + bias)
        return self.weights[-1] @ hidden + self.biases[-1]


class Critic(eqx.Module):
    """Q(s, a) = V(s) + A(s, a), of two networks.

    The state decides nearly all of Q, an action a few per cent. A network of its own lets A follow the
    action while V follows the state (compare Wang et al. 2016, arXiv 1511.06581); nothing else ties the two.
    """

    value: Rectified
    """V."""
    advantage: Rectified
    """A."""

    def __init__(self, hidden: tuple[int, ...], key: Array, features: int = FEATURES):
        """Random weights."""
        value_key, advantage_key = jax.random.split(key)
        self.value = Rectified((features, *hidden, 1), value_key)
        self.advantage = Rectified((features + ACTIONS, *hidden, 1), advantage_key)

    def __call__(
        self, features: Float[Array, "features"], fractions: Float[Array, "actions"]
    ) -> Float[Array, ""]:
        """Q of one state and action."""
        return self.value(features)[0] + self.advantage(jnp.concatenate([features, fractions]))[0]
