"""Fixed rules: a thermostat, comfort without a battery, two price thresholds."""

from dataclasses import dataclass

from hemma.control.comfort import ComfortHold
from hemma.control.rule import Rule
from hemma.control.thresholds import PriceThresholds, fit_thresholds
from hemma.methods.looks import DASHED, DOTTED, PURPLE, VERMILLION, Look
from hemma.methods.method import AbstractControl, Group, Known


@dataclass(frozen=True, kw_only=True)
class Thermostat(AbstractControl):
    """The paper's Rule."""

    group: Group = Group.RULES

    def controller(self, known: Known) -> Rule:
        """Hysteresis within the comfort band."""
        home = known.expert.case.home
        return Rule(home.hvac, home.comfort)


@dataclass(frozen=True, kw_only=True)
class NoBattery(AbstractControl):
    """What a home costs when nothing shifts energy in time."""

    group: Group = Group.RULES

    def controller(self, known: Known) -> ComfortHold:
        """Comfort by the building as it was identified."""
        return ComfortHold(known.expert.planning_home)


@dataclass(frozen=True, kw_only=True)
class Thresholds(AbstractControl):
    """Two prices, fitted to the past."""

    group: Group = Group.RULES

    def controller(self, known: Known) -> PriceThresholds:
        """Fitted through the building as it was identified."""
        return fit_thresholds(known.expert.planning_home, known.outlook.past)

    def needed_past(self, known: Known) -> int:
        """A day."""
        return known.outlook.day


RULE = Thermostat(
    name="Rule",
    meaning="a thermostat with hysteresis; the battery rests",
    look=Look(VERMILLION, DASHED, "X"),
)
NO_BATTERY = NoBattery(
    name="no battery",
    meaning="holds the temperature at the edge of comfort by the identified building; there is no battery",
    look=Look(VERMILLION, DOTTED, "P"),
)
THRESHOLDS = Thresholds(
    name="thresholds",
    meaning="charges below one price and discharges above another, both fitted on the training period; the "
    "HVAC holds the edge of comfort by the identified building",
    look=Look(PURPLE, DOTTED, "D"),
)
