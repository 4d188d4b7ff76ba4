"""The methods, each a value; a new one is one file and one line in ``METHODS``."""

from hemma.errors import HemmaError, shortened
from hemma.forecasting.observations import MODELS, PAPER
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
from hemma.settings.experiment import Experiment

METHODS: tuple[AbstractMethod, ...] = (
    HA_1,
    HA_2,
    GAIL,
    MAXENT,
    MAXENT_NEURAL,
    CLONING,
    PPO,
    DDPG_METHOD,
    DEFAULT,
    MPC_FORECAST,
    MPC_HOURLY_MEANS,
    MPC_YESTERDAY,
    THRESHOLDS,
    RULE,
    NO_BATTERY,
    DEFAULT_PUBLISHED,
    MPC_PERFECT,
    HMPC,
    HMPC_JOINT,
    DNLP,
    OPTIMUM,
)
"""All there are, in the order of tables and figures."""


def controls() -> tuple[AbstractControl, ...]:
    """Those that are not trained."""
    return tuple(method for method in METHODS if isinstance(method, AbstractControl))


def learners() -> dict[str, AbstractLearner]:
    """Those that are trained, by name: as in ``METHODS``, then with more to see or another teacher."""
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


def learned(experiment: Experiment) -> tuple[AbstractLearner, ...]:
    """Those that an experiment asks for, in the order of ``METHODS``; ``HemmaError`` for a name of none."""
    known = learners()
    asked = [name for name in known if experiment.learned is None and not known[name].plain]
    asked += experiment.learned or ()
    for name in asked:
        if name not in known:
            plain = [one for one in known if not known[one].plain]
            models = [one for one in MODELS if one != PAPER.name]
            raise HemmaError(
                f"learned: expected names of methods that learn ({', '.join(plain)}); behind one, if it is "
                f"to see more than the paper's state, one of {', '.join(models)}; behind that, if it "
                f"imitates and a planner without hindsight is to demonstrate, causal; got {shortened(name)}"
            )
    order = list(known)
    return tuple(
        known[name] for name in sorted(asked, key=lambda name: order.index(known[name].plain or name))
    )


def method_of(name: str) -> AbstractMethod | None:
    """The method of that name; None if there is none."""
    known = {method.name: method for method in (*METHODS, AIRL)}
    return known.get(name) or learners().get(name)
