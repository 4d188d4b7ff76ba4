"""Scaling of what policies see for networks, from training data only and robust against price spikes."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from hemma.home import paper_state
from hemma.types import Array, Observation, PaperState

HOUR, PRICE = int(PaperState.HOUR_OF_DAY), int(PaperState.BUYING_PRICE)
SELLING = 6
"""Position of u- among the quantities that are scaled, behind the six of the paper's state."""
SPIKY = np.array([True, True, False, False, False, True, True])
"""Which of these quantities have rare values far from the usual ones: p, l, u and u-."""
UNMOVED = 1e-6
"""A quantity that moves by less than this share of its largest value never changes: the rest is rounding."""


PLAIN = -1
"""Kind of a figure that has no unit and is of about unit size as it is."""


class Context(eqx.Module):
    """What a policy sees in each slot besides the paper's state, in units: figures, counted from origins."""

    figures: Float[Array, "*slots figures"]
    origins: Float[Array, "*slots figures"]
    """What each figure is counted from, mostly the present value of its quantity, in its unit."""
    kinds: Int[Array, "*runs figures"]
    """Position in the paper's state of the quantity that a figure is of, SELLING, or PLAIN."""

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

    Where the selling price is no line of the buying price, the state does not tell it. It is then a seventh
    quantity, scaled as the other price is, and seen behind the state.
    """

    centre: Float[Array, " quantities"]
    """Median of each of the six or seven quantities, in their units."""
    spread: Float[Array, " quantities"]
    """Half the distance between the 10 % and 90 % quantiles, in their units."""

    def __call__(self, state: Float[Array, "*batch 7"]) -> Float[Array, "*batch 8"]:
        """Features of a state in its units."""
        angle = 2 * jnp.pi * state[..., HOUR] / 24
        scaled = (state[..., :HOUR] - self.centre[:HOUR]) / self.spread[:HOUR]
        quantities = jnp.where(SPIKY[:HOUR], jnp.arcsinh(scaled), scaled)
        return jnp.concatenate([quantities, jnp.sin(angle)[..., None], jnp.cos(angle)[..., None]], axis=-1)

    def observed(self, observation: Observation) -> Float[Array, "*batch features"]:
        """Features of what is observed: the paper's state, and the selling price where it is a quantity."""
        features = self(paper_state(observation))
        return jnp.concatenate([features, self.selling(observation.selling_price)], axis=-1)

    def price(self, price: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """A price, or what a kWh is worth [currency/kWh], scaled as the buying price is."""
        return jnp.arcsinh((price - self.centre[PRICE]) / self.spread[PRICE])

    def selling(self, price: Float[Array, "*batch"]) -> Float[Array, "*batch prices"]:
        """The feature of a selling price [currency/kWh], or none where the state tells it."""
        scaled = (jnp.asarray(price, float)[..., None] - self.centre[SELLING:]) / self.spread[SELLING:]
        return jnp.arcsinh(scaled)

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
        units = jnp.where(SPIKY[:HOUR], jnp.sinh(scaled), scaled)
        return self.centre[:HOUR] + self.spread[:HOUR] * units


def fit_scaler(
    states: Float[np.ndarray, "samples 7"], selling_price: Float[np.ndarray, "samples"] | None = None
) -> StateScaler:
    """Scaler of the given states, shape (samples, 7), and of a selling price that they do not tell, in units.

    A quantity whose 10 % and 90 % quantiles agree (PV in a home without, say) is scaled by its standard
    deviation, or left in its unit if it never changes.
    """
    quantities = np.asarray(states, float)[:, :HOUR]
    if selling_price is not None:
        quantities = np.column_stack([quantities, selling_price])
    low, high = np.quantile(quantities, [0.1, 0.9], axis=0)
    spread = np.where(high > low, (high - low) / 2, quantities.std(axis=0))
    moves = spread > UNMOVED * np.max(np.abs(quantities), axis=0)
    centre = np.median(quantities, axis=0)
    return StateScaler(centre=jnp.asarray(centre), spread=jnp.asarray(np.where(moves, spread, 1.0)))
