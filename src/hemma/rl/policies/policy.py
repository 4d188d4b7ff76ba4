"""The stochastic policy pi(a|s) and the controller that it becomes."""

from typing import Protocol, runtime_checkable

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from hemma.home import AbstractController, Home, Memory
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.network import Network
from hemma.rl.policies.scaling import Context, StateScaler
from hemma.rl.policies.spaces import FRACTIONS
from hemma.types import Action, Array, Observation

FEATURES = 8
"""Of the paper's state; what else a policy sees follows them."""
ACTIONS = 2


@runtime_checkable
class Policy(Protocol):
    """What a learner ends with: a module that says what to do, without randomness."""

    @property
    def space(self) -> ActionSpace:
        """What its decisions mean."""
        ...

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """The decision in a state of these features."""
        ...


class StochasticPolicy(eqx.Module):
    """Decisions around a simple mean: the HVAC's affine in the state, the battery's by a network.

    The HVAC's fraction corrects the comfort action (``hemma.rl.policies.fractions``), and the correction must
    go on beyond the hottest training day; a network would bend it there. What decisions mean, and how the
    policy explores around its mean, is a matter of its ``space``.
    """

    network: Network
    """Features to the battery's decision."""
    linear: Float[Array, "actions state"]
    """Of the features of the paper's state alone."""
    bias: Float[Array, "actions"]
    space: ActionSpace = eqx.field(static=True)
    """What its decisions mean, and how it explores."""

    def __init__(
        self,
        sizes: tuple[int, ...],
        key: Array,
        features: int = FEATURES,
        space: ActionSpace = FRACTIONS,
    ):
        """Random weights, hidden layers of these sizes; the mean starts near 0."""
        self.network = Network((features, *sizes, 1), key, last_scale=0.01)
        self.linear = jnp.zeros((ACTIONS, FEATURES))
        self.bias = jnp.zeros(ACTIONS)
        self.space = space

    def mean(self, features: Float[Array, "features"]) -> Float[Array, "actions"]:
        """Mean decision at one state: y = W x + b + (network(x, c), 0), bent as its space has it; x are the
        features of the paper's state, for the battery those that its space heeds, c what else is seen."""
        heeded = np.asarray(self.space.heeds)
        state, context = features[:FEATURES], features[FEATURES:]
        affine = jnp.where(np.stack([heeded, np.ones(FEATURES, bool)]), self.linear, 0.0) @ state + self.bias
        battery = affine[:1] + self.network(jnp.concatenate([jnp.where(heeded, state, 0.0), context]))
        return self.space.bent(jnp.concatenate([battery, affine[1:]]))


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
        decision, space = self.policy.mean(features), self.policy.space
        return space.carry_out(self.planning_home, observation, decision, self.scaler).action


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
