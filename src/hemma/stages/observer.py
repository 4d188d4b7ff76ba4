"""What the policies of a home see: made for the days that they learn from, and for those that they act on."""

from dataclasses import dataclass

import jax
import numpy as np
from jaxtyping import Int

from hemma.forecasting.observations import PAPER, ObservationModel, Observer
from hemma.forecasting.outlook import Outlook, yesterday
from hemma.home import AbstractController
from hemma.home.selling import fit_selling
from hemma.results.fingerprint import code, fingerprint
from hemma.results.store import Store
from hemma.rl.policies.policy import InformedController, PolicyController
from hemma.rl.policies.scaling import NOTHING, Context
from hemma.stages.case import Case
from hemma.stages.default import choose_forecast
from hemma.stages.demonstrate import Expert
from hemma.types import Exogenous


@dataclass(frozen=True)
class HomeObserver:
    """An observation model at work in the home of a case."""

    case: Case
    sees: Observer
    facts: tuple = ()
    """What the forecast depends on, by name."""

    @property
    def model(self) -> ObservationModel:
        """What is seen."""
        return self.sees.model

    @property
    def mark(self) -> str:
        """Fingerprint of what is seen besides the paper's state; empty if nothing is."""
        if self.model == PAPER:
            return ""
        return fingerprint(
            "sight", code("forecasting", "optimisation", "control"), self.case.mark, self.model, self.facts
        )

    def learning(self, days: int, known_days: int | None = None) -> Context:
        """In the first ``days`` days of the training period, of which ``known_days`` are known, or all."""
        if self.model == PAPER:
            return NOTHING
        case = self.case
        known = case.first_days(case.training_days if known_days is None else known_days)
        slots = case.first_days(days).slots
        weekdays = case.parts.training.weekdays()[:slots]
        return self.sees.training_context(known, slots, float(case.home.slot_length), weekdays)

    def in_test(self) -> Context:
        """In the test period."""
        return self.over(self.case.training, self.case.test, self.case.parts.test.weekdays())

    def held_out(self, first: int, slots: int | None = None) -> Context:
        """In the training period from slot ``first`` on (``slots`` or all), which was not learned from."""
        case = self.case
        stop = case.training.slots if slots is None else first + slots
        past, period = case.training.window(0, first), case.training.window(first, stop)
        return self.over(past, period, case.parts.training.weekdays()[first:stop])

    def over(self, past: Exogenous, period: Exogenous, weekdays: Int[np.ndarray, "slots"]) -> Context:
        """In a period, as it was read, after a past; ``weekdays`` are those of the period, Monday 0."""
        if self.model == PAPER:
            return NOTHING
        case = self.case
        outlook = Outlook(past, period, float(case.home.slot_length), case.experiment.forecast_horizon)
        return self.sees.context(outlook, weekdays)


def observer_of(
    model: ObservationModel, expert: Expert, store: Store, forecasts: bool = False
) -> HomeObserver:
    """What a policy sees; a forecast is the one that the default controller plans with.

    ``forecasts`` says whether its teacher needs one where it does not.
    """
    case, settings = expert.case, expert.case.experiment.default
    sells_apart = fit_selling(case.training) is None
    if not (model.forecast or forecasts):
        sees = Observer(model, yesterday, settings.published_at, sells_apart)
        return HomeObserver(case, sees, (settings.published_at,))
    chosen = choose_forecast(expert, store).candidate
    sees = Observer(model, chosen.forecaster, settings.published_at, sells_apart)
    return HomeObserver(case, sees, (chosen.name, settings))


def informed(controllers: PolicyController, context: Context) -> AbstractController:
    """Stacked controllers that see their context while they act."""
    if context is NOTHING:
        return controllers
    runs = controllers.scaler.centre.shape[0]
    stacked = jax.tree.map(lambda x: np.broadcast_to(x, (runs, *np.shape(x))), context)
    return InformedController(controllers, stacked)
