"""A made-up baseline and a made-up learned method: each a file like this one, and a line in ``METHODS``."""

from dataclasses import dataclass, field

import jax.numpy as jnp

from hemma.control.comfort import ComfortHold
from hemma.home import AbstractController
from hemma.irl.cloning import BehaviourCloning, CloningSettings
from hemma.methods.imitation import AbstractImitator
from hemma.methods.method import AbstractControl, Group
from hemma.types import Action


class Clockwork(AbstractController):
    """Charges at night and discharges in the evening, whatever the price."""

    comfort: ComfortHold

    def __call__(self, observation, memory, key):
        """Action of the observed slot [kW]."""
        held, memory = self.comfort(observation, memory, key)
        hour = observation.hour_of_day
        power = jnp.where(hour < 5, 1.0, jnp.where((hour >= 17) & (hour < 21), -1.0, 0.0))
        return Action(battery_power=power, hvac_power=held.hvac_power), memory


@dataclass(frozen=True, kw_only=True)
class ClockworkMethod(AbstractControl):
    """A battery by the clock."""

    group: Group = Group.RULES

    def controller(self, known):
        """Comfort by the building as it was identified."""
        return Clockwork(ComfortHold(known.expert.planning_home))


@dataclass(frozen=True, kw_only=True)
class WideCloning(AbstractImitator):
    """Cloning with settings of its own."""

    group: Group = Group.DEMONSTRATED
    cloning: CloningSettings = field(default_factory=lambda: CloningSettings(iterations=25, hidden=(6, 6)))

    def algorithm(self, experiment):
        """Its own cloning."""
        return BehaviourCloning(self.cloning)


CLOCKWORK = ClockworkMethod(name="clockwork", meaning="charges at night, discharges in the evening", effort=1)
WIDE = WideCloning(name="wide cloning", meaning="cloning with a wider network")
