"""Learning curves on disk, one CSV file a run."""

import csv
import io
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path

import numpy as np

from hemma.checkpoint import write_atomically
from hemma.home import Home
from hemma.rl.training import CHUNK, Curve


def write_curves(folder: Path, names: Sequence[str], curves: Curve, home: Home) -> None:
    """Write the curve of each run to the file of that name in ``folder``.

    One row a chunk of iterations, at its last: the means of the learner's own progress over the chunk, then
    train_energy_cost [currency/day] and train_temperature_deviation [degC/day, summed over the slots of a
    day] of the policy without exploration on its own training days.
    """
    slots_of_a_day = 24 / float(home.slot_length)
    iterations = CHUNK * np.arange(1, curves.training_cost.shape[1] + 1)
    progress = {field.name: getattr(curves.progress, field.name) for field in fields(curves.progress)}
    quantities = {
        "iteration": np.broadcast_to(iterations, curves.training_cost.shape),
        **progress,
        "train_energy_cost": curves.training_cost,
        "train_temperature_deviation": slots_of_a_day * curves.training_deviation,
    }
    values = np.stack([np.asarray(quantity, float) for quantity in quantities.values()], axis=-1)
    for name, rows in zip(names, values, strict=True):
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(quantities)
        writer.writerows([int(row[0]), *row[1:]] for row in rows.tolist())
        write_atomically(folder / name, text.getvalue().encode())
