"""HMPC-AIRL, the paper's method, and GAIL: the same loop with another head."""

from dataclasses import dataclass, replace

from hemma.irl.airl import AdversarialImitation
from hemma.irl.reward import AbstractHead, ImitationScore, ShapedReward
from hemma.methods.imitation import AbstractImitator, Length
from hemma.methods.looks import BLUE, DASHED, GREEN, SKY, Look
from hemma.methods.method import Group
from hemma.rl.improvement import Proximal
from hemma.rl.policies.committee import Committee
from hemma.settings.experiment import Experiment


@dataclass(frozen=True, kw_only=True)
class AdversarialImitator(AbstractImitator):
    """A discriminator tells expert from agent, PPO follows its reward (Algorithm 1); several agents a run."""

    group: Group = Group.DEMONSTRATED
    head: type[AbstractHead] = ShapedReward
    """r = g + gamma h' - h for AIRL, a score without structure for GAIL."""

    def algorithm(self, experiment: Experiment) -> Committee:
        """A committee of learners."""
        settings = experiment.airl
        by_ppo = Proximal(replace(experiment.ppo, rollouts=settings.rollouts), experiment.space)
        return Committee(AdversarialImitation(settings, by_ppo, self.head), settings.members)


HA_1 = AdversarialImitator(
    name="HA-1",
    meaning="HMPC-assisted adversarial inverse reinforcement learning, the shorter demonstrations",
    look=Look(BLUE, "-", "o"),
)
HA_2 = AdversarialImitator(
    name="HA-2",
    meaning="the same method with the longer demonstrations",
    length=Length.LONG,
    look=Look(SKY, DASHED, "s"),
    is_candidate=False,
)
AIRL = AdversarialImitator(
    name="AIRL",
    meaning="the method of HA-1 and HA-2 at other demonstration lengths",
    look=Look(BLUE, "-", "o"),
    is_candidate=False,
)
"""Not a row of its own: the data efficiency study gives it lengths. It wears the colour of HA-1."""
GAIL = AdversarialImitator(
    name="GAIL",
    meaning="generative adversarial imitation of the demonstrations, without a reward to keep",
    head=ImitationScore,
    look=Look(GREEN, DASHED, "s"),
    is_candidate=False,
)
