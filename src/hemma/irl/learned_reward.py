"""The learned reward as an asset: r = g + gamma h' - h and the scaling that it was learned in, on disk."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.checkpoint import load_header, load_shapes, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.irl.reward import ShapedReward
from hemma.rl.environment import Transitions
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.policy import FEATURES
from hemma.rl.policies.scaling import StateScaler
from hemma.rl.policies.spaces import FRACTIONS, space_of
from hemma.types import Array, Observation

KIND = "learned reward"


class LearnedReward(eqx.Module):
    """What AIRL leaves behind besides a policy: one reward, or those of many runs along a first axis.

    Where several agents learned in a run, the rewards of a run lie along a second axis of the head.

    It reads states in their units through its scaler, and actions as the deeds of its ``space`` are read:
    which powers these are is a matter of the home it is asked about.
    """

    head: ShapedReward
    """r, of scaled states."""
    scaler: StateScaler
    """That of the demonstrations."""
    space: ActionSpace = eqx.field(static=True, default=FRACTIONS)
    """Whose deeds it reads."""

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return self.scaler.centre.shape[0]

    @property
    def members(self) -> int:
        """How many rewards a run has."""
        axes = self._axes
        return axes[1] if len(axes) > 1 else 1

    @property
    def _axes(self) -> tuple[int, ...]:
        return self.head.approximator.biases[-1].shape[:-1]

    def run(self, number: int, member: int = 0) -> "LearnedReward":
        """That of one run, or of one agent of it."""
        place = (number, member) if len(self._axes) > 1 else (number,)
        head = jax.tree.map(lambda x: x[place], self.head)
        return LearnedReward(head, jax.tree.map(lambda x: x[number], self.scaler), self.space)

    def transitions(
        self,
        observation: Observation,
        fractions: Float[Array, "*batch actions"],
        after: Observation,
    ) -> Transitions:
        """(s, a, s') of what is observed as the head reads it, where it sees no context."""
        reach = jnp.zeros((*fractions.shape[:-1], 0))
        return Transitions(self.scaler.observed(observation), fractions, self.scaler.observed(after), reach)


def save_rewards(path: Path, rewards: LearnedReward, header: Mapping[str, Any]) -> None:
    """Store stacked rewards whole or not at all; ``header`` goes beside what loading them again takes."""
    g = rewards.head.approximator
    shape = {
        "kind": KIND,
        "axes": list(rewards._axes),
        "hidden": [bias.shape[-1] for bias in g.biases[:-1]],
        "features": rewards.head.shaping.weights[0].shape[-1],
        "discount": rewards.head.discount,
        "actions": rewards.space.name,
    }
    save_tree(path, rewards, {**header, **shape})


def load_rewards(path: Path) -> LearnedReward:
    """What ``save_rewards`` stored, bit for bit; all it takes is the file."""
    header = load_header(path)
    if header.get("kind") != KIND:
        raise HemmaError(
            f"{path}: expected a learned reward, got another checkpoint; AIRL writes them as "
            "models/HOME/METHOD.reward.safetensors in its results folder"
        )
    sizes, width = tuple(header["hidden"]), header.get("features", FEATURES)
    head = ShapedReward.random(sizes, header["discount"], jax.random.key(0), width)
    quantities = load_shapes(path)[".scaler.centre"][-1]
    one = LearnedReward(head, StateScaler(jnp.zeros(quantities), jnp.ones(quantities)))
    axes = tuple(header["axes"])
    runs = axes[:1]  # the members of a committee share the scaler of their run
    space = space_of(path, header)
    like = LearnedReward(_stacked(one.head, axes), _stacked(one.scaler, runs), space)
    return load_tree(path, like)


def _stacked(tree: Any, axes: tuple[int, ...]) -> Any:
    return jax.tree.map(lambda x: jnp.zeros((*axes, *x.shape), x.dtype), tree)
