"""How boldly a policy explores as training goes on, and the average of its weights that is the result."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home.checks import require
from hemma.rl.policies.policy import StochasticPolicy
from hemma.types import Array


@dataclass(frozen=True)
class Exploration:
    """sigma, the standard deviation of the policy's fractions, over the iterations, and the averaging."""

    first_deviation: tuple[float, float] = (0.2, 0.1)
    """sigma at the first iteration, of battery and HVAC."""
    last_deviation: tuple[float, float] = (0.2, 0.1)
    """sigma once it has shrunk, geometrically, over the first ``shrinking`` of the iterations."""
    shrinking: float = 0.8
    """Share of the iterations over which sigma shrinks."""
    averaging: float = 0.99
    """Share of the old average kept an iteration in the averaged policy, which is the result."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("first_deviation", "last_deviation"):
            value = getattr(self, name)
            require("exploration", len(value) == 2 and min(value) > 0, f"{name} two numbers > 0", value)
        require("exploration", 0 < self.shrinking <= 1, "0 < shrinking <= 1", self.shrinking)
        require("exploration", 0 <= self.averaging < 1, "0 <= averaging < 1", self.averaging)

    def deviation(self, iteration: Array, iterations: int) -> Float[Array, "actions"]:
        """sigma at an iteration of so many: coarse strokes first, fine ones later."""
        first, last = jnp.asarray(self.first_deviation), jnp.asarray(self.last_deviation)
        share = jnp.minimum(iteration / (self.shrinking * iterations), 1.0)
        return first * (last / first) ** share

    def averaged(
        self, average: StochasticPolicy, policy: StochasticPolicy, iteration: Array
    ) -> StochasticPolicy:
        """The exponential moving average of the weights after an iteration; short at first."""
        keep = jnp.minimum(self.averaging, iteration / (iteration + 10.0))
        return jax.tree.map(lambda a, p: keep * a + (1 - keep) * p, average, policy)


def falling(iteration: Array, iterations: int) -> Array:
    """Share of the learning rates at an iteration: falls linearly from 1 to a tenth."""
    return 1.0 - 0.9 * iteration / iterations
