"""A replay memory of fixed size, as arrays."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float, Int

from hemma.rl.environment import Transitions
from hemma.types import Array


class Experience(eqx.Module):
    """Transitions and what they earned."""

    transitions: Transitions
    rewards: Float[Array, "*batch"]


class Memory(eqx.Module):
    """A ring: the newest experience takes the place of the oldest."""

    experience: Experience
    """Shape (capacity, ...); zeros where nothing was stored yet."""
    stored: Int[Array, "*runs"]
    """How much was ever stored."""

    def add(self, fresh: Experience) -> "Memory":
        """The memory with ``fresh``, shape (samples, ...), of at most its capacity."""
        capacity, samples = self.experience.rewards.shape[0], fresh.rewards.shape[0]
        places = (self.stored + jnp.arange(samples)) % capacity
        experience = jax.tree.map(lambda old, new: old.at[places].set(new), self.experience, fresh)
        return Memory(experience, self.stored + samples)

    def sample(self, batch: int, key: Array) -> Experience:
        """So many of those stored, drawn with replacement."""
        capacity = self.experience.rewards.shape[0]
        rows = jax.random.randint(key, (batch,), 0, jnp.minimum(self.stored, capacity))
        return jax.tree.map(lambda x: x[rows], self.experience)


def empty_memory(example: Experience, capacity: int) -> Memory:
    """Room for ``capacity`` experiences of the form of ``example``, shape (samples, ...)."""
    room = jax.tree.map(lambda x: jnp.zeros((capacity, *x.shape[1:]), x.dtype), example)
    return Memory(room, jnp.zeros((), int))
