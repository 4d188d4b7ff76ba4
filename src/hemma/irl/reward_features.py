"""What a linear reward may look at: named features of a transition, and the reward that weighs them."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl.environment import Transitions
from hemma.rl.policies.scaling import HOUR
from hemma.rl.task import ExpertData
from hemma.types import Array, PaperState

PV, LOAD, ENERGY, OUTDOOR, INDOOR, PRICE = sorted(PaperState)[:HOUR]
SINE, COSINE = HOUR, HOUR + 1
"""Positions in the scaled state x(s): those of the paper's state, and the hour's sine and cosine."""
BATTERY, HVAC = range(2)
"""Positions in the action fractions."""


class RewardFeatures(eqx.Module):
    """phi(s, a, s'), one field a feature; the weights w of a linear reward are an object of this class, too.

    All quantities are scaled (``StateScaler``), so a feature has no unit and is of about unit size. dE is
    the change of the scaled battery energy from s to s', T' the scaled indoor temperature of s', zero at
    the median that the expert showed.
    """

    charge: Float[Array, "*batch"]
    """dE: the worth of stored energy as such."""
    charge_at_price: Float[Array, "*batch"]
    """u dE: buying low and selling high."""
    charge_at_price_squared: Float[Array, "*batch"]
    """u^2 dE: extreme prices may count more than in proportion."""
    charge_at_sine: Float[Array, "*batch"]
    """sin(2 pi t'/24) dE: charging by the clock."""
    charge_at_cosine: Float[Array, "*batch"]
    """cos(2 pi t'/24) dE."""
    charge_in_sun: Float[Array, "*batch"]
    """p dE: storing the PV surplus."""
    charge_under_load: Float[Array, "*batch"]
    """l dE: covering the load."""
    throughput: Float[Array, "*batch"]
    """|dE|: wear of the battery and losses."""
    level: Float[Array, "*batch"]
    """E': a full store as such."""
    level_squared: Float[Array, "*batch"]
    """E'^2: a middling store as such."""
    level_at_price: Float[Array, "*batch"]
    """u E': being full while it is dear."""
    level_at_sine: Float[Array, "*batch"]
    """sin(2 pi t'/24) E': being full by the clock."""
    level_at_cosine: Float[Array, "*batch"]
    """cos(2 pi t'/24) E'."""
    hvac: Float[Array, "*batch"]
    """a_h: more HVAC power than comfort needs."""
    hvac_squared: Float[Array, "*batch"]
    """a_h^2: HVAC power other than what comfort needs."""
    hvac_at_price: Float[Array, "*batch"]
    """u a_h: more than comfort needs while power is dear."""
    hvac_in_heat: Float[Array, "*batch"]
    """T_out a_h: more than comfort needs while it is hot outside."""
    warmer: Float[Array, "*batch"]
    """[T']^+: a home warmer than the expert's usually is."""
    colder: Float[Array, "*batch"]
    """[-T']^+: a home colder than the expert's usually is."""


def reward_features(transitions: Transitions) -> RewardFeatures:
    """phi of transitions of any leading shape."""
    x, a, after = transitions.features, transitions.fractions, transitions.next_features
    change = after[..., ENERGY] - x[..., ENERGY]
    level, temperature = after[..., ENERGY], after[..., INDOOR]
    price, sine, cosine = x[..., PRICE], x[..., SINE], x[..., COSINE]
    hvac = jnp.clip(a[..., HVAC], -1.0, 1.0)
    return RewardFeatures(
        charge=change,
        charge_at_price=price * change,
        charge_at_price_squared=price**2 * change,
        charge_at_sine=sine * change,
        charge_at_cosine=cosine * change,
        charge_in_sun=x[..., PV] * change,
        charge_under_load=x[..., LOAD] * change,
        throughput=jnp.abs(change),
        level=level,
        level_squared=level**2,
        level_at_price=price * level,
        level_at_sine=sine * level,
        level_at_cosine=cosine * level,
        hvac=hvac,
        hvac_squared=hvac**2,
        hvac_at_price=price * hvac,
        hvac_in_heat=x[..., OUTDOOR] * hvac,
        warmer=jnp.maximum(temperature, 0.0),
        colder=jnp.maximum(-temperature, 0.0),
    )


class LinearReward(eqx.Module):
    """r(s, a, s') = w . phi(s, a, s') / scale, feature by feature."""

    weights: RewardFeatures
    """w, one number a feature; what is learned."""
    scale: RewardFeatures
    """One number a feature; fixed, from the demonstrations."""

    def features(self, transitions: Transitions) -> RewardFeatures:
        """phi / scale of transitions of any leading shape."""
        return jax.tree.map(jnp.divide, reward_features(transitions), self.scale)

    def batch(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """r of many transitions at once."""
        terms = jax.tree.map(jnp.multiply, self.weights, self.features(transitions))
        return jnp.sum(jnp.stack(jax.tree.leaves(terms)), axis=0)


def demonstrated_scale(expert: ExpertData, least: float) -> RewardFeatures:
    """Standard deviation of each feature over the demonstrations, but not below ``least``."""
    features = reward_features(expert.transitions)
    counted = jnp.arange(expert.transitions.fractions.shape[0]) < expert.available
    return jax.tree.map(lambda phi: jnp.maximum(jnp.std(phi, where=counted), least), features)
