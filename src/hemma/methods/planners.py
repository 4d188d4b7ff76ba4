"""Rolling planners: they plan again in every slot, through the identified building, by a forecast."""

from abc import abstractmethod
from dataclasses import dataclass

from hemma.control.rolling import RollingPlanner
from hemma.forecasting.outlook import Forecaster, hourly_means, perfect, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.forecasting.ridge import fitted, needed_past
from hemma.home import Home
from hemma.methods.looks import DASHED, DOTTED, GREY, MIXED, SKY, Look
from hemma.methods.method import AbstractControl, Group, Known


@dataclass(frozen=True, kw_only=True)
class AbstractPlanner(AbstractControl):
    """Plans battery and HVAC together, does the first slot, measures, plans again; always within the limits,
    and comfort is a part of the plan."""

    group: Group = Group.PLANS
    is_guarded: bool = False

    @abstractmethod
    def forecaster(self, known: Known) -> Forecaster:
        """What it believes of the hours to come."""

    def controller(self, known: Known) -> RollingPlanner:
        """Through the building as it was identified."""
        return self.through(known.expert.planning_home, known)

    def through(self, planning_home: Home, known: Known) -> RollingPlanner:
        """The same through any building."""
        return RollingPlanner(planning_home, self.forecaster(known)(known.outlook))


@dataclass(frozen=True, kw_only=True)
class SimplePlanner(AbstractPlanner):
    """With a forecast that needs no choice."""

    forecast: Forecaster

    def forecaster(self, known: Known) -> Forecaster:
        """As it is."""
        return self.forecast


@dataclass(frozen=True, kw_only=True)
class FittedPlanner(AbstractPlanner):
    """With ridge regressions fitted to the past, where it is long enough."""

    def forecaster(self, known: Known) -> Forecaster:
        """Fitted once."""
        return fitted

    def needed_past(self, known: Known) -> int:
        """History and a day of examples."""
        return needed_past(known.outlook)


@dataclass(frozen=True, kw_only=True)
class DefaultPlanner(AbstractPlanner):
    """With the forecast that cost least to plan with on training days that it had not seen."""

    knows_published: bool = False
    """Whether it knows prices as far as they are published."""

    def forecaster(self, known: Known) -> Forecaster:
        """The chosen one; published prices stand in for it where there are some."""
        forecaster = known.choice.candidate.forecaster
        if not self.knows_published:
            return forecaster
        return PublishedPrices(forecaster, known.expert.case.experiment.default.published_at)

    def facts(self, known: Known) -> tuple:
        """What was chosen, and how."""
        return known.choice.candidate.name, known.expert.case.experiment.default

    def needed_past(self, known: Known) -> int:
        """As the chosen forecast."""
        return known.choice.candidate.needed

    def seconds_to_fit(self, known: Known) -> float:
        """How long the choice took."""
        return known.choice.seconds


MPC_PERFECT = SimplePlanner(
    name="MPC perfect",
    effort=2,
    group=Group.HINDSIGHT,
    forecast=perfect,
    meaning="the same planner as MPC forecast, told the next hours exactly: what is left is due to its "
    "horizon and to the identified building",
    look=Look(GREY, MIXED, "v"),
    is_candidate=False,
)
DEFAULT = DefaultPlanner(
    name="default",
    effort=3,
    meaning="the controller that Hemma uses unless told otherwise: plans battery and HVAC of the next hours "
    "together in every slot, does the first slot of the plan, measures, and plans again; the building is the "
    "identified network, and of several forecasts fitted to the past it takes the one that cost least to "
    "plan with on training days that the forecast had not seen",
    look=Look(SKY, "-", "P"),
)
DEFAULT_PUBLISHED = DefaultPlanner(
    name="default published",
    effort=3,
    group=Group.PUBLISHED,
    knows_published=True,
    meaning="the same controller where prices are published ahead: it knows today's, and from the afternoon "
    "on tomorrow's",
    look=Look(SKY, DOTTED, "X"),
    is_candidate=False,
)
MPC_FORECAST = FittedPlanner(
    name="MPC forecast",
    effort=2,
    meaning="the same planner with the simplest fitted forecast: yesterday, corrected by how today differs "
    "from it",
    look=Look(GREY, "-", "o"),
)
MPC_HOURLY_MEANS = SimplePlanner(
    name="MPC hourly means",
    effort=2,
    forecast=hourly_means,
    meaning="the same planner, expecting the training period's mean at each time of day",
    look=Look(GREY, DASHED, "s"),
    is_candidate=False,
)
MPC_YESTERDAY = SimplePlanner(
    name="MPC yesterday",
    effort=2,
    forecast=yesterday,
    meaning="the same planner, expecting the last known value at the same time of day",
    look=Look(GREY, DOTTED, "^"),
    is_candidate=False,
)
