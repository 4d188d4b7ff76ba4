"""The stochastic policy pi(a|s) and the controller that it becomes."""

from typing import Protocol, runtime_checkable

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home import AbstractController, Home, Memory
from hemma.rl.policies.actions import to_power
from hemma.rl.policies.network import Network
from hemma.rl.policies.scaling import Context, StateScaler
from hemma.types import Action, Array, Observation

FEATURES = 8
"""Of the paper's state; what else a policy sees follows them."""
ACTIONS = 2
SLOPE_BEYOND = 0.05
"""Slope of the mean where it lies beyond [-1, 1]: a flat one would have no gradient to come back by."""


@runtime_checkable
class Policy(Protocol):
    """What a learner ends with: a module that says what to do, without randomness."""

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """Fractions of what is feasible (``hemma.rl.policies.actions``) in a state of these features."""
        ...


class GaussianPolicy(eqx.Module):
    """A Gaussian over action fractions with a simple mean: HVAC affine in the state, battery by a network.

    The HVAC's fraction corrects the comfort action (``rl.policies.actions``), and the correction must go on
    beyond the hottest training day; a network would bend it there. Both means are bent at -1 and 1 only, and
    keep a little slope beyond for the gradient. The fractions that are sampled are not bounded: the
    home takes those beyond [-1, 1] as the bound, and the density stays that of the sample, so log pi is
    finite everywhere (see ``hemma.rl.policies.actions``).
    """

    network: Network
    """Features to the battery's fraction."""
    linear: Float[Array, "actions state"]
    """Of the features of the paper's state alone."""
    bias: Float[Array, "actions"]

    def __init__(self, sizes: tuple[int, ...], key: Array, features: int = FEATURES):
        """Random weights, hidden layers of these sizes; the mean starts near 0, battery at rest."""
        self.network = Network((features, *sizes, 1), key, last_scale=0.01)
        self.linear = jnp.zeros((ACTIONS, FEATURES))
        self.bias = jnp.zeros(ACTIONS)

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """Mean fractions at one state: y = W x + b + (network(x, c), 0), bent at -1 and 1; x are the features
        of the paper's state, c what else is seen."""
        affine = self.linear @ features[:FEATURES] + self.bias
        raw = jnp.concatenate([affine[:1] + self.network(features), affine[1:]])
        bounded = jnp.clip(raw, -1.0, 1.0)
        return bounded + SLOPE_BEYOND * (raw - bounded)


def log_density(
    fractions: Float[Array, "*batch actions"],
    mean: Float[Array, "*batch actions"],
    deviation: Float[Array, "actions"],
) -> Float[Array, "*batch"]:
    """log pi(a|s) of a diagonal Gaussian: -sum (a - mu)^2 / (2 sigma^2) - sum log(sigma sqrt(2 pi))."""
    distance = (fractions - mean) / deviation
    return -0.5 * jnp.sum(distance**2, axis=-1) - jnp.sum(jnp.log(deviation * jnp.sqrt(2 * jnp.pi)))


class PolicyController(AbstractController):
    """A trained policy as a controller: the mean action, no randomness.

    Called as it is, it sees the paper's state, and a selling price that it does not tell. A policy that
    learned with more must be ``informed``.
    """

    policy: Policy
    scaler: StateScaler
    planning_home: Home
    """The home as far as it is known, to turn fractions into powers: its limits, and a thermal model."""

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """The action (e, h) [kW]."""
        return self.act(observation, self.scaler.observed(observation)), memory

    def act(self, observation: Observation, features: Float[Array, "features"]) -> Action:
        """The action (e, h) [kW] when all that the policy sees is ``features``."""
        return to_power(self.planning_home, observation, self.policy.mean(features))


class InformedController(AbstractController):
    """A trained policy that sees more than the paper's state, with what there is to see in a period."""

    controller: PolicyController
    context: Context
    """One row a slot of the period that is replayed."""

    def __call__(self, observation: Observation, memory: Memory, key: Array) -> tuple[Action, Memory]:
        """The action (e, h) [kW]."""
        scaler = self.controller.scaler
        seen = scaler.context(self.context.at(observation.slot))
        features = jnp.concatenate([scaler.observed(observation), seen])
        return self.controller.act(observation, features), memory
