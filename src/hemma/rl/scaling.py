"""Scaling of the paper's state for networks, from training data only and robust against price spikes."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.types import Array

HOUR = 6
"""Position of t' in the paper's state."""
SPIKY = np.array([True, True, False, False, False, True])
"""Which of the other quantities have rare values far from the usual ones: p, l and u."""


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

    def quantities(self, features: Float[Array, "*batch 8"]) -> Float[Array, "*batch 6"]:
        """The inverse: (p, l, E, T_out, T_in, u) in their units."""
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
