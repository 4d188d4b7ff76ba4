"""Maximum-entropy inverse reinforcement learning, with a linear and a neural reward."""

from dataclasses import dataclass

from hemma.irl.maxent import linear_maxent, neural_maxent
from hemma.methods.imitation import AbstractImitator, Length
from hemma.methods.looks import DOTTED, GREEN, MIXED, Look
from hemma.methods.method import Group
from hemma.rl.improvement import Proximal
from hemma.rl.training import Algorithm
from hemma.settings.experiment import Experiment


@dataclass(frozen=True, kw_only=True)
class MaxEntImitator(AbstractImitator):
    """The reward whose soft-optimal policy has the expert's expected features (Ziebart et al. 2008)."""

    group: Group = Group.DEMONSTRATED
    length: Length | int = Length.LONG
    is_candidate: bool = False
    is_neural: bool = False

    def algorithm(self, experiment: Experiment) -> Algorithm:
        """PPO under a reward that is linear in named features, or a network."""
        make = neural_maxent if self.is_neural else linear_maxent
        return make(experiment.maxent, Proximal(experiment.ppo, experiment.space))


MAXENT = MaxEntImitator(
    name="MaxEnt IRL",
    meaning="maximum-entropy inverse reinforcement learning from demonstrations, a reward linear in named "
    "features",
    look=Look(GREEN, DOTTED, "v"),
)
MAXENT_NEURAL = MaxEntImitator(
    name="MaxEnt IRL neural",
    meaning="the same with a neural network as the reward",
    is_neural=True,
    look=Look(GREEN, MIXED, "d"),
)
