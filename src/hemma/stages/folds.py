"""Training days to judge controllers on, each part with the days before it: what was not fitted to them."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from hemma.forecasting.outlook import DAY, Outlook
from hemma.stages.case import Case


def outlook_of(case: Case) -> Outlook:
    """The test period, and the training period before it."""
    return Outlook(case.training, case.test, float(case.home.slot_length), case.experiment.forecast_horizon)


def training_folds(case: Case) -> Sequence[Outlook]:
    """The last days of the training period, whole days in parts; none if the period is too short."""
    settings, slot_length = case.experiment.default, float(case.home.slot_length)
    first = case.training_days - int(case.training_days * settings.judged)
    days = np.linspace(first, case.training_days, settings.folds + 1).astype(int)
    if first < 1 or np.any(np.diff(days) < 1):
        return ()
    slots = (days * round(DAY / slot_length)).tolist()
    training, horizon = case.training, case.experiment.forecast_horizon
    return [
        Outlook(training.window(0, start), training.window(start, stop), slot_length, horizon)
        for start, stop in pairwise(slots)
    ]
