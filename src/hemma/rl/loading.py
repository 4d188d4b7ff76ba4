"""Trained controllers off the disk, without the settings and the task that they were trained with."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp

from hemma.checkpoint import load_header, load_shapes, load_tree
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.rl.policies.committee import CommitteePolicy
from hemma.rl.policies.policy import PolicyController, StochasticPolicy
from hemma.rl.policies.scaling import StateScaler
from hemma.rl.policies.spaces import space_of

Shape = tuple[int, ...]


def load_controllers(path: Path, planning_home: Home) -> PolicyController:
    """The runs of a training, stacked; how many, of what sizes, alone or in committees is as the file has it.

    ``planning_home`` lends its structure alone: each run has its own in the file.
    """
    shapes = load_shapes(path)
    is_committee = ".policy.members.bias" in shapes
    place = ".policy.members" if is_committee else ".policy"
    if f"{place}.bias" not in shapes:
        raise HemmaError(
            f"{path}: expected trained controllers, got another checkpoint; `hemma train` writes them as "
            "models/HOME/METHOD.safetensors in its results folder"
        )
    axes = shapes[f"{place}.bias"][:-1]  # runs, and the members of a committee
    features, quantities = shapes[f"{place}.network.weights[0]"][-1], shapes[".scaler.centre"][-1]
    space = space_of(path, load_header(path))
    policy = _stacked(StochasticPolicy(_hidden(shapes, place), jax.random.key(0), features, space), axes)
    like = PolicyController(
        policy=CommitteePolicy(policy) if is_committee else policy,
        scaler=_stacked(StateScaler(jnp.zeros(quantities), jnp.ones(quantities)), axes[:1]),
        planning_home=_stacked(planning_home, axes[:1]),
    )
    return load_tree(path, like)


def _hidden(shapes: Mapping[str, Shape], place: str) -> tuple[int, ...]:
    """Widths of the hidden layers of the network at this place."""
    biases = f"{place}.network.biases"
    layers = sum(name.startswith(biases) for name in shapes)
    return tuple(shapes[f"{biases}[{layer}]"][-1] for layer in range(layers - 1))


def _stacked(tree: Any, axes: Shape) -> Any:
    """Zeros of the same structure with these axes before those of each leaf."""
    return jax.tree.map(lambda x: jnp.zeros((*axes, *jnp.shape(x)), float), tree)
