"""Learning curves on disk, one CSV file a run."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hemma.checkpoint import write_atomically
from hemma.home import Home
from hemma.irl.airl import CHUNK
from hemma.irl.training import Curve

COLUMNS = (
    "iteration",
    "discriminator_loss",
    "expert_accuracy",
    "agent_accuracy",
    "learned_reward",
    "train_energy_cost",
    "train_temperature_deviation",
)


def write_curves(folder: Path, names: Sequence[str], curves: Curve, home: Home) -> None:
    """Write the curve of each run to the file of that name in ``folder``.

    One row a chunk of iterations, at its last. Cost [currency/day] and deviation [degC/day, summed over the
    slots of a day] are those of the policy without exploration on its own training days.
    """
    slots_of_a_day = 24 / float(home.slot_length)
    progress = curves.progress
    quantities = (
        progress.discriminator_loss,
        progress.expert_accuracy,
        progress.agent_accuracy,
        progress.learned_reward,
        curves.training_cost,
        slots_of_a_day * curves.training_deviation,
    )
    values = np.stack([np.asarray(quantity, float) for quantity in quantities], axis=-1)
    for name, rows in zip(names, values, strict=True):
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([(i + 1) * CHUNK, *row] for i, row in enumerate(rows.tolist()))
        write_atomically(folder / name, text.getvalue().encode())
