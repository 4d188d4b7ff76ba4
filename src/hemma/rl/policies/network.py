"""A small multilayer perceptron whose leaves are all arrays, so that it can be carried through a scan."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.types import Array


class Network(eqx.Module):
    """Affine layers with tanh between them; the last layer is linear."""

    weights: tuple[Float[Array, "_ _"], ...]
    biases: tuple[Float[Array, "_"], ...]

    def __init__(self, sizes: tuple[int, ...], key: Array, last_scale: float = 1.0):
        """Layers of these ``sizes``, input first, with weights uniform within 1/sqrt(inputs).

        ``last_scale`` shrinks the last layer's weights; biases start at 0.
        """
        keys = jax.random.split(key, len(sizes) - 1)
        scales = [1.0] * (len(sizes) - 2) + [last_scale]
        self.weights = tuple(
            scale * jax.random.uniform(k, (b, a), minval=-1.0, maxval=1.0) / jnp.sqrt(a)
            for a, b, k, scale in zip(sizes[:-1], sizes[1:], keys, scales, strict=True)
        )
        self.biases = tuple(jnp.zeros(size) for size in sizes[1:])

    def __call__(self, inputs: Float[Array, "inputs"]) -> Float[Array, "outputs"]:
        """Output of shape (outputs,) for one input."""
        hidden = jnp.asarray(inputs)
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            hidden = jnp.tanh(weight @ hidden + bias)
        return self.weights[-1] @ hidden + self.biases[-1]
