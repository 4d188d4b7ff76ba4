"""The stochastic policy pi(a|s) and the controller that it becomes."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import Home, paper_state
from hemma.rl.actions import to_power
from hemma.rl.network import Network
from hemma.rl.scaling import StateScaler
from hemma.types import Action, Array, Observation

FEATURES = 8
ACTIONS = 2


class GaussianPolicy(eqx.Module):
    """A Gaussian over action fractions whose mean is a small network plus a linear map of the features.

    The linear map is there because holding a temperature is nearly linear in the indoor and outdoor ones.
    Fractions are not squashed: the home takes those beyond [-1, 1] as the bound, and the density stays that
    of the unbounded sample, so log pi is finite everywhere (see ``hemma.rl.actions``).
    """

    network: Network
    linear: Float[Array, "actions features"]

    def __init__(self, sizes: tuple[int, ...], key: Array):
        """Random weights, hidden layers of these sizes; the mean starts near 0, battery at rest."""
        self.network = Network((FEATURES, *sizes, ACTIONS), key, last_scale=0.01)
        self.linear = jnp.zeros((ACTIONS, FEATURES))

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """Mean fractions at one state."""
        return self.network(features) + self.linear @ features


def log_density(
    fractions: Float[Array, "*batch actions"],
    mean: Float[Array, "*batch actions"],
    deviation: Float[Array, "actions"],
) -> Float[Array, "*batch"]:
    """log pi(a|s) of a diagonal Gaussian: -sum (a - mu)^2 / (2 sigma^2) - sum log(sigma sqrt(2 pi))."""
    distance = (fractions - mean) / deviation
    return -0.5 * jnp.sum(distance**2, axis=-1) - jnp.sum(jnp.log(deviation * jnp.sqrt(2 * jnp.pi)))


class PolicyController(eqx.Module):
    """A trained policy as a controller: the mean action, no randomness. It sees the paper's state only."""

    policy: GaussianPolicy
    scaler: StateScaler
    home: Home
    """Limits of battery and HVAC, to turn fractions into powers."""

    def __call__(self, observation: Observation, key: Array) -> Action:
        """The action (e, h) [kW]."""
        fractions = self.policy.mean(self.scaler(paper_state(observation)))
        return to_power(self.home, observation.battery_energy, fractions)
