"""The methods, each a value; a new one is one file and one line in ``METHODS``."""

from hemma.forecasting.observations import MODELS
from hemma.methods.airl import AIRL, GAIL, HA_1, HA_2
from hemma.methods.bill import DDPG_METHOD, PPO
from hemma.methods.cloning import CLONING
from hemma.methods.hindsight import DNLP, HMPC, HMPC_JOINT, OPTIMUM
from hemma.methods.imitation import AbstractImitator
from hemma.methods.maxent import MAXENT, MAXENT_NEURAL
from hemma.methods.method import AbstractControl, AbstractLearner, AbstractMethod
from hemma.methods.planners import (
    DEFAULT,
    DEFAULT_PUBLISHED,
    MPC_FORECAST,
    MPC_HOURLY_MEANS,
    MPC_PERFECT,
    MPC_YESTERDAY,
)
from hemma.methods.rules import NO_BATTERY, RULE, THRESHOLDS

METHODS: tuple[AbstractMethod, ...] = (
    HA_1,
    HA_2,
    GAIL,
    MAXENT,
    MAXENT_NEURAL,
    CLONING,
    PPO,
    DDPG_METHOD,
    RULE,
    NO_BATTERY,
    THRESHOLDS,
    MPC_FORECAST,
    DEFAULT,
    MPC_HOURLY_MEANS,
    MPC_YESTERDAY,
    DEFAULT_PUBLISHED,
    MPC_PERFECT,
    HMPC,
    HMPC_JOINT,
    DNLP,
    OPTIMUM,
)
"""All there are. Those that are not trained stand from the simplest to the one that takes most: of methods
that cannot be told from the best the first is recommended."""


def controls() -> tuple[AbstractControl, ...]:
    """Those that are not trained."""
    return tuple(method for method in METHODS if isinstance(method, AbstractControl))


def learners() -> dict[str, AbstractLearner]:
    """Those that are trained, by name: as they stand in ``METHODS``, then with more to see or another teacher."""
    plain = [method for method in METHODS if isinstance(method, AbstractLearner)]
    found = {method.name: method for method in plain}
    for method in plain:
        for model in MODELS.values():
            seeing = method.seeing(model)
            found[seeing.name] = seeing
            if isinstance(seeing, AbstractImitator):
                causal = seeing.taught_causally()
                found[causal.name] = causal
    return found


def method_of(name: str) -> AbstractMethod | None:
    """The method of that name; None if there is none."""
    known = {method.name: method for method in (*METHODS, AIRL)}
    return known.get(name) or learners().get(name)


GRAMMAR = (
    "the name of a method that learns ({names}); behind it, if it is to see more than the paper's state, one of "
    f"{', '.join(name for name in MODELS if name != 'paper')}; behind that, if it imitates and a planner "
    "without hindsight is to demonstrate, causal"
)
"""What a name in the setting ``learned`` may be, for readers."""
