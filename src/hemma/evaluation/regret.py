"""Regret, and where it comes from: the unknown future, the thermal model, the policy.

regret(x) = cost(x) - optimum(D_x) [currency], where D_x is the total deviation that x itself caused: what
perfect information would have saved at equal comfort. A ratio to the optimum loses its meaning where the
optimum is near zero or negative; a difference does not, and it can be split into a sum.

The split goes from the optimum to the controller x through two planners that know of the future what a
controller can know: M, a rolling model predictive controller, once planning through the home's true thermal
model and once through the identified network.

    future        = regret(M through the true model)
    thermal model = regret(M through the network) - regret(M through the true model)
    policy        = regret(x) - regret(M through the network)

M is the planner with the best causal forecast. A row that is itself a rolling planner is split by itself
with its own forecast, so that its policy part is zero.
"""

import math

from hemma.errors import HemmaError
from hemma.record import Number, Record


class RegretSplit(Record):
    """total = future + thermal_model + policy, all [currency].

    ``future`` is at least zero, up to the solver's gap: nobody beats perfect information at equal comfort.
    With a perfect forecast it is what the planner's short horizon costs.

    A negative ``thermal_model`` says that the errors of the network happened to help: its plans, wrong about
    the building, turned out cheaper at equal comfort than the right ones, which are right only for the
    forecast.

    A negative ``policy`` says that the controller is better than planning on that forecast: it has learned
    to allow for what a forecast leaves out. A positive one is what better learning could still gain
    without knowing more of the future.

    All parts are linear in the regrets: the split of the means over seeds, homes or periods is the mean of
    the splits.
    """

    total: Number = None
    """regret(x)."""
    future: Number = None
    """The part that comes from not knowing the future."""
    thermal_model: Number = None
    """The part that comes from planning through the identified network instead of the true building."""
    policy: Number = None
    """The part that comes from not deciding as the planner does."""

    @property
    def parts(self) -> tuple[float, float, float] | None:
        """Future, thermal model and policy; None unless all are known."""
        if self.future is None or self.thermal_model is None or self.policy is None:
            return None
        return self.future, self.thermal_model, self.policy


def regret(cost: float, optimum: float) -> float:
    """cost(x) - optimum(D_x) [currency]; ``optimum`` must be solved for the deviation of the run itself."""
    return cost - optimum


def split_regret(controller: float, planner: float, planner_with_true_model: float) -> RegretSplit:
    """Where the regret of ``controller`` comes from; three regrets of the same home and period [currency].

    ``planner`` is M through the identified network, ``planner_with_true_model`` is M through the thermal
    model of the simulated home. For a row that is such a planner ``controller`` and ``planner`` are the same.
    Raises ``HemmaError`` where one of them is not finite.
    """
    regrets = {
        "the controller": controller,
        "the planner": planner,
        "the planner with the true model": planner_with_true_model,
    }
    for name, value in regrets.items():
        if not math.isfinite(value):
            raise HemmaError(f"regret: expected finite regrets, got {value} of {name}; measure it again")
    return RegretSplit(
        total=controller,
        future=planner_with_true_model,
        thermal_model=planner - planner_with_true_model,
        policy=controller - planner,
    )
