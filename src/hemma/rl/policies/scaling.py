"""Scaling of the paper's state for networks, from training data only and robust against price spikes."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.types import Array

HOUR = 6
"""Position of t' in the paper's state."""
SPIKY = np.array([True, True, False, False, False, True])
"""Which of the other quantities have rare values far from the usual ones: p, l and u."""


PLAIN = -1
"""Kind of a figure that has no unit and is of about unit size as it is."""


class Context(eqx.Module):
    """What a policy sees in each slot besides the paper's state, in units: figures, counted from origins."""

    figures: Float[Array, "*slots figures"]
    origins: Float[Array, "*slots figures"]
    """What each figure is counted from, mostly the present value of its quantity, in its unit."""
    kinds: Int[Array, "*runs figures"]
    """Position in the paper's state of the quantity that a figure is of, or PLAIN."""

    def at(self, slot: Array) -> "Context":
        """That of one slot."""
        return Context(self.figures[slot], self.origins[slot], self.kinds)


NOTHING = Context(np.zeros((1, 0)), np.zeros((1, 0)), np.zeros(0, int))
"""The paper's state and nothing else."""


class StateScaler(eqx.Module):
    """Maps s = (p, l, E, T_out, T_in, u, t') to eight features of about unit size.

    Battery energy and temperatures become (x - centre) / spread: holding a temperature is a linear law that
    must go on beyond the hottest training day. PV, load and price become asinh((x - centre) / spread),
    linear around the usual values and logarithmic far out, so that one price spike in the training days
    neither crushes the usual prices to nothing nor throws the network off when a higher one comes. The hour
    becomes its sine and cosine.
    """

    centre: Float[Array, " quantities"]
    """Median of each of the six quantities, in their units."""
    spread: Float[Array, " quantities"]
    """Half the distance between the 10 % and 90 % quantiles, in their units."""

    def __call__(self, state: Float[Array, "*batch 7"]) -> Float[Array, "*batch 8"]:
        """Features of a state in its units."""
        angle = 2 * jnp.pi * state[..., HOUR] / 24
        scaled = (state[..., :HOUR] - self.centre) / self.spread
        quantities = jnp.where(SPIKY, jnp.arcsinh(scaled), scaled)
        return jnp.concatenate([quantities, jnp.sin(angle)[..., None], jnp.cos(angle)[..., None]], axis=-1)

    def context(self, context: Context) -> Float[Array, "*slots figures"]:
        """Features of what is seen besides the state: b(x) - b(x_0) of each figure x and its origin x_0.

        b is what this scaler does to the quantity; figures that are PLAIN stay as they are.
        """
        if context.kinds.shape[-1] == 0:
            return jnp.asarray(context.figures, float)
        is_plain = context.kinds == PLAIN
        of = jnp.where(is_plain, 0, context.kinds)

        def bent(x: Array) -> Array:
            scaled = (x - self.centre[of]) / self.spread[of]
            return jnp.where(jnp.asarray(SPIKY)[of], jnp.arcsinh(scaled), scaled)

        return jnp.where(is_plain, context.figures, bent(context.figures) - bent(context.origins))

    def quantities(self, features: Float[Array, "*batch features"]) -> Float[Array, "*batch 6"]:
        """The inverse, from the first of the features: (p, l, E, T_out, T_in, u) in their units."""
        scaled = features[..., :HOUR]
        return self.centre + self.spread * jnp.where(SPIKY, jnp.sinh(scaled), scaled)


def fit_scaler(states: Float[np.ndarray, "samples 7"]) -> StateScaler:
    """Scaler of the given states, shape (samples, 7), in their units.

    A quantity whose 10 % and 90 % quantiles agree (PV in a home without, say) is scaled by its standard
    deviation, or left in its unit if it never changes.
    """
    quantities = np.asarray(states, float)[:, :HOUR]
    low, high = np.quantile(quantities, [0.1, 0.9], axis=0)
    deviation = quantities.std(axis=0)
    spread = np.where(high > low, (high - low) / 2, np.where(deviation > 0, deviation, 1.0))
    return StateScaler(centre=jnp.asarray(np.median(quantities, axis=0)), spread=jnp.asarray(spread))
