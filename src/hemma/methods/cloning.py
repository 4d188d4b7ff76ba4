"""Behavioural cloning."""

from dataclasses import dataclass

from hemma.irl.cloning import BehaviourCloning
from hemma.methods.imitation import AbstractImitator
from hemma.methods.looks import MIXED, PURPLE, Look
from hemma.methods.method import Group
from hemma.settings.experiment import Experiment


@dataclass(frozen=True, kw_only=True)
class Cloner(AbstractImitator):
    """A regression from states to the demonstrated actions."""

    group: Group = Group.DEMONSTRATED
    is_candidate: bool = False

    def algorithm(self, experiment: Experiment) -> BehaviourCloning:
        """Without any trial."""
        return BehaviourCloning(experiment.cloning, experiment.space)


CLONING = Cloner(
    name="BC",
    meaning="behavioural cloning: a regression from states to the demonstrated actions, without any trial",
    look=Look(PURPLE, MIXED, "^"),
)
