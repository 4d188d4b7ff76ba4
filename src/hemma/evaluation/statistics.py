"""Mean over seeds and homes, how well it is known, and what the middle half of the runs does."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr, stdtrit

from hemma.evaluation.bootstrap import resampled_means

FEW = 9
"""With fewer degrees of freedom (runs less homes) a bootstrap cannot see how far the mean may stray."""


class IntervalKind(StrEnum):
    """How an interval of a mean was found."""

    STUDENT = "student"
    BOOTSTRAP = "bootstrap"


@dataclass(frozen=True)
class Interval:
    """A range in which the truth lies with the stated confidence."""

    low: float
    high: float


@dataclass(frozen=True)
class Summary:
    """What a handful of runs says about all runs."""

    mean: float | None
    """Arithmetic mean; None where a run has no value."""
    interval: Interval | None
    """95 % interval of the mean; None for one run, whose spread nobody can know."""
    interquartile_mean: float | None
    """Mean of the middle half of the runs."""


MISSING = Summary(mean=None, interval=None, interquartile_mean=None)


def summarise(values: Sequence[float | None], confidence: float = 0.95) -> Summary:
    """One metric over independent seeds.

    A missing value (None or NaN) makes everything missing: averaging the rest would flatter the method.
    Runs that share a seed-independent schedule have no spread and get an interval of no width.
    """
    return summarise_homes((values,), confidence)


def summarise_homes(homes: Sequence[Sequence[float | None]], confidence: float = 0.95) -> Summary:
    """One metric over several homes, each with its own runs; every home counts the same.

    The mean is that of the homes' means, and its interval says where the mean over *these* homes lies with
    other seeds: the homes are strata, drawn once and for all, and a seed that is bad on one home is not
    taken to be bad on another. Variance and degrees of freedom (Welch,
    Satterthwaite) are, with n_h runs of standard deviation s_h on each of H homes,

        v = sum_h s_h^2/n_h / H^2,    nu = (sum_h s_h^2/n_h)^2 / sum_h (s_h^2/n_h)^2/(n_h-1).

    With few runs (see ``interval_kind``) the interval is m +- t_{(1+c)/2,nu} sqrt(v): five runs cannot show
    how far a sixth may stray, so that a bootstrap of them, which never leaves their range, is too narrow.
    With more it is a percentile bootstrap, which follows a skewed distribution, at the levels
    Phi(-t) and Phi(t) instead of (1-c)/2 and (1+c)/2, since the spread is still estimated (Hesterberg 2015,
    "What teachers should know about the bootstrap", arXiv 1411.5279). Of normal runs, 10 of one home, it
    covers 95 %, the plain percentile interval 90 %.
    """
    if not homes or any(_is_missing(values) for values in homes):
        return MISSING
    samples = [np.asarray(values, float) for values in homes]
    mean = float(np.mean([np.mean(sample) for sample in samples]))
    weights = [1 / len(sample) for sample in samples for _ in sample]
    middle = _middle_mean(np.concatenate(samples), np.asarray(weights))
    return Summary(mean, _interval(samples, mean, confidence), middle)


def interval_kind(runs: Sequence[int]) -> IntervalKind | None:
    """The kind of interval of a mean over homes with so many runs each; None where there can be none."""
    if not runs or min(runs) < 2:
        return None
    return IntervalKind.BOOTSTRAP if sum(runs) - len(runs) >= FEW else IntervalKind.STUDENT


def interquartile_mean(values: Sequence[float | None]) -> float | None:
    """Mean of the middle half of the values: less at the mercy of one run than the mean, and less wasteful
    than the median (Agarwal et al. 2021, arXiv 2108.13264).

    A value at the border of the middle half counts with the part of it that lies inside: of five values in
    order, the second and fourth with 3/4. None where a value is missing.
    """
    return summarise(values).interquartile_mean


def _is_missing(values: Sequence[float | None]) -> bool:
    return not values or any(value is None or not np.isfinite(value) for value in values)


def _middle_mean(values: Float[np.ndarray, "runs"], weights: Float[np.ndarray, "runs"]) -> float:
    """Each value covers its share of [0, 1] in order of size; its weight is what it covers of [1/4, 3/4]."""
    order = np.argsort(values, kind="stable")
    ends = np.cumsum(weights[order]) / np.sum(weights)
    starts = np.concatenate([[0.0], ends[:-1]])
    inside = np.maximum(np.minimum(ends, 0.75) - np.maximum(starts, 0.25), 0.0)
    return float(values[order] @ inside / np.sum(inside))


def _interval(samples: list[Float[np.ndarray, "_"]], mean: float, confidence: float) -> Interval | None:
    kind = interval_kind([len(sample) for sample in samples])
    if kind is None:
        return None
    variances = np.array([np.var(sample, ddof=1) / len(sample) for sample in samples])
    if not np.any(variances > 0):
        return Interval(mean, mean)
    shares = variances / np.sum(variances)
    freedom = 1 / np.sum(shares**2 / np.array([len(sample) - 1 for sample in samples]))
    quantile = float(stdtrit(freedom, (1 + confidence) / 2))
    if kind is IntervalKind.STUDENT:
        half = quantile * float(np.sqrt(np.sum(variances))) / len(samples)
        return Interval(mean - half, mean + half)
    low, high = np.quantile(resampled_means(samples), [ndtr(-quantile), ndtr(quantile)])
    return Interval(float(low), float(high))
