"""The bootstrap: what the mean would have been with other runs, many times over."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from jaxtyping import Float

RESAMPLES = 10_000
SEED = 2021
"""Of the resampling: the same runs always give the same interval."""


def resampled_means(homes: Sequence[Float[np.ndarray, "_"]]) -> Float[np.ndarray, "resamples"]:
    """Means over the homes of the means over their runs, the runs of each home resampled by themselves.

    Of the n runs of a home n - 1 are drawn, with replacement: the mean of n draws varies with (n-1)/n of the
    variance that the mean of new runs has, that of n - 1 draws with all of it (Rao and Wu 1988, "Resampling
    inference with complex survey data"). Every home needs at least two runs.
    """
    means = [_weights(len(runs), home) @ runs for home, runs in enumerate(homes)]
    return np.mean(means, axis=0)


@lru_cache(maxsize=32)
def _weights(runs: int, home: int) -> Float[np.ndarray, "resamples runs"]:
    """How much each run counts in each resample; independent from home to home."""
    random = np.random.default_rng((SEED, runs, home))
    return random.multinomial(runs - 1, np.full(runs, 1 / runs), RESAMPLES) / (runs - 1)
