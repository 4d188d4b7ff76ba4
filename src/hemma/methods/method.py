"""What a method is: a value that says what it is called, what it may know, how it looks, and how it acts."""

import zlib
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import TypeVar

from hemma.forecasting.observations import PAPER, ObservationModel
from hemma.forecasting.outlook import Outlook
from hemma.home import AbstractController
from hemma.methods.looks import UNKNOWN, Look
from hemma.optimisation.optimum import OptimumProblem
from hemma.results.store import Store
from hemma.settings.experiment import Experiment
from hemma.stages.default import Choice, choose_forecast
from hemma.stages.demonstrate import Expert
from hemma.stages.train import TrainingJob

Learner = TypeVar("Learner", bound="AbstractLearner")


class Group(StrEnum):
    """Methods that may know the same things, in the order of tables and figures."""

    DEMONSTRATED = "Learned from demonstrations"
    REWARDED = "Learned from a hand-written reward"
    PLANS = "Plans again in every slot"
    RULES = "Fixed rules"
    PUBLISHED = "Knows tomorrow's prices"
    HINDSIGHT = "Knows the future"


@dataclass(frozen=True, kw_only=True)
class AbstractMethod(ABC):
    """What every method says of itself; its settings are the other fields of its class."""

    name: str
    """In tables, files and settings."""
    group: Group
    meaning: str
    """What it is, in plain words."""
    look: Look | None = None
    """How it is drawn; without one, a look that depends on its name alone."""
    is_candidate: bool = True
    """Whether it may be recommended for a home, if what it has learned from leaves days to judge it on."""
    effort: int = 4
    """What it takes to set up and run, from 0, a thermostat, to 4, a trained policy: of methods that cannot
    be told from the best, the one that takes least is recommended."""

    @property
    def is_causal(self) -> bool:
        """Whether it knows no more than what has happened or been published."""
        return self.group is not Group.HINDSIGHT

    @property
    def drawn(self) -> Look:
        """Its look."""
        return self.look or UNKNOWN[zlib.crc32(self.name.encode()) % len(UNKNOWN)]


@dataclass(frozen=True)
class Known:
    """What a method that is not trained may go by in a period."""

    expert: Expert
    """Of the home: its settings and constants, and the building as it was identified (``planning_home``)."""
    store: Store
    outlook: Outlook
    """The past, which anything may be fitted to, and the period as it is read; a forecast that is made in a
    slot may look at the slots of the period up to that one."""
    problem: OptimumProblem | None = None
    """Perfect information over the period, for those that know the future."""

    @cached_property
    def choice(self) -> Choice:
        """The forecast that the default controller plans with."""
        return choose_forecast(self.expert, self.store)


@dataclass(frozen=True, kw_only=True)
class AbstractControl(AbstractMethod):
    """A method that is not trained."""

    is_guarded: bool = True
    """Whether a safety layer stands behind it under faults."""

    @abstractmethod
    def controller(self, known: Known) -> AbstractController:
        """What acts in the period, fitted to the past if to anything."""

    def facts(self, known: Known) -> tuple:
        """What the controller depends on besides the home, its traces and this method's own fields."""
        return ()

    def needed_past(self, known: Known) -> int:
        """The shortest past that it can be fitted to [slots]."""
        return 0

    def seconds_to_fit(self, known: Known) -> float | None:
        """How long fitting took [s], where that is worth telling."""
        return None


@dataclass(frozen=True, kw_only=True)
class AbstractLearner(AbstractMethod):
    """A method that is trained."""

    observation_model: ObservationModel = PAPER
    """What its policy sees."""
    is_taught_causally: bool = False
    """Whether a planner that knows no more than the policy demonstrates, not the expert in hindsight."""
    plain: str = ""
    """Name of the method that sees the paper's state and has the usual teacher; empty where it is that."""

    @abstractmethod
    def training_job(self, expert: Expert, store: Store) -> TrainingJob:
        """What its runs, one a seed, are to learn in the home of ``expert``."""

    @abstractmethod
    def seen_days(self, experiment: Experiment, training_days: int) -> int:
        """How many of the first days of the training period it learns from."""

    def seeing(self: Learner, model: ObservationModel) -> Learner:
        """The same method with more to see."""
        if model == PAPER:
            return self
        return replace(
            self,
            name=f"{self.name} {model.name}",
            meaning=f"as {self.name}, which also sees {model.meaning}",
            group=Group.PUBLISHED if model.published else self.group,
            observation_model=model,
            plain=self.plain or self.name,
            look=None,
            is_candidate=False,
        )
