"""What a learner knows, read in another home: the same share of the battery, all else in its units."""

import equinox as eqx
import jax.numpy as jnp

from hemma.home.battery import Battery
from hemma.rl.policies.scaling import StateScaler
from hemma.types import PaperState

ENERGY = PaperState.BATTERY_ENERGY


def carried_over(scaler: StateScaler, origin: Battery, target: Battery) -> StateScaler:
    """The scaler by which what was learned with one battery reads the energy of another.

    E' = E'^min + (E - E^min) k, k = (E'^max - E'^min) / (E^max - E^min): full is full and empty is empty.
    Temperatures, prices, PV and load keep their units: 24 degC and 0.10 $/kWh mean the same in any home.
    """
    share = (target.max_energy - target.min_energy) / (origin.max_energy - origin.min_energy)
    centre, spread = jnp.asarray(scaler.centre), jnp.asarray(scaler.spread)
    moved = target.min_energy + (centre[..., ENERGY] - origin.min_energy) * share
    return eqx.tree_at(
        lambda s: (s.centre, s.spread),
        scaler,
        (centre.at[..., ENERGY].set(moved), spread.at[..., ENERGY].multiply(share)),
    )
