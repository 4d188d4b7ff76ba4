"""Fitted models on disk: a safetensors file whose header tells how the model came about."""

from dataclasses import asdict
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.identification.fit import Fit
from hemma.identification.pcnn import InputScaling, PcnnWeights, PhysicallyConsistentNetwork, ThermalResponse

KIND = "physically consistent neural network"


def save_model(path: Path, fit: Fit, seed: int) -> None:
    """Save the model of ``fit``, with its settings, seed, sizes, slot length and validation error."""
    header = {
        "kind": KIND,
        "settings": asdict(fit.settings),
        "seed": seed,
        "width": fit.settings.width,
        "depth": fit.settings.depth,
        "slot_length_h": float(fit.model.slot_length),
        "best_update": fit.best_update,
        "validation_rmse_c": float(np.min(fit.curve.validation[fit.curve.updates == fit.best_update])),
    }
    save_tree(path, fit.model, header)


def load_model(path: Path) -> PhysicallyConsistentNetwork:
    """Load what ``save_model`` saved. Raises ``HemmaError`` for any other file."""
    header = load_header(path)
    if header.get("kind") != KIND:
        raise HemmaError(
            f"{path}: expected a {KIND}, found a checkpoint of kind {header.get('kind')!r}; "
            "give the file of an identified thermal model"
        )
    like = PhysicallyConsistentNetwork(
        weights=PcnnWeights.create(jax.random.key(0), header["width"], header["depth"]),
        start=ThermalResponse(heating=jnp.ones(()), cooling=jnp.ones(()), loss=jnp.full((), 0.5)),
        scaling=InputScaling(jnp.zeros(()), jnp.ones(()), jnp.ones(())),
        slot_length=header["slot_length_h"],
    )
    return load_tree(path, like)
