"""Methods that know the period before it begins."""

from dataclasses import dataclass

from hemma.errors import HemmaError
from hemma.home import Schedule
from hemma.methods.looks import BLACK, DASHED, DOTTED, MIXED, Look
from hemma.methods.method import AbstractControl, Group, Known
from hemma.optimisation.joint import joint_hmpc
from hemma.optimisation.nonlinear import nonlinear_optimum


@dataclass(frozen=True, kw_only=True)
class HierarchicalExpert(AbstractControl):
    """HMPC, which makes the demonstrations."""

    group: Group = Group.HINDSIGHT
    is_candidate: bool = False

    def controller(self, known: Known) -> Schedule:
        """Its schedule."""
        return Schedule(known.expert.plan(known.outlook.period))


@dataclass(frozen=True, kw_only=True)
class JointExpert(AbstractControl):
    """Both levels of HMPC in one exact plan."""

    group: Group = Group.HINDSIGHT
    is_candidate: bool = False

    def controller(self, known: Known) -> Schedule:
        """Its schedule, carried out without a correction."""
        expert = known.expert
        found = joint_hmpc(expert.planning_home, expert.case.home, known.outlook.period)
        return Schedule(found.steps.action)


@dataclass(frozen=True, kw_only=True)
class NonlinearProgramming(AbstractControl):
    """The paper's DNLP."""

    group: Group = Group.HINDSIGHT
    is_candidate: bool = False

    def controller(self, known: Known) -> Schedule:
        """A local optimum by an interior-point method."""
        return Schedule(nonlinear_optimum(known.expert.case.home, known.outlook.period).actions)


@dataclass(frozen=True, kw_only=True)
class ProvenOptimum(AbstractControl):
    """Perfect information."""

    group: Group = Group.HINDSIGHT
    is_candidate: bool = False

    def controller(self, known: Known) -> Schedule:
        """The schedule of least cost with the least deviation."""
        if known.problem is None:
            raise HemmaError("optimum: expected a period that is known, got one without its problem")
        return Schedule(known.problem.solve().actions)


HMPC = HierarchicalExpert(
    name="HMPC",
    meaning="the expert: the two-level optimiser in hindsight, with the identified network as its model",
    look=Look(BLACK, DASHED, "s"),
)
HMPC_JOINT = JointExpert(
    name="HMPC joint",
    meaning="HVAC and battery planned together and exactly in hindsight through the identified network, "
    "carried out on the real home without a correction: what the expert's two levels give away",
    look=Look(BLACK, "-", "o"),
)
DNLP = NonlinearProgramming(
    name="DNLP",
    meaning="the optimum's problem again as a nonlinear programme over the whole period in hindsight, solved "
    "by an interior-point method; a local optimum, so an independent check of the proven one",
    look=Look(BLACK, MIXED, "D"),
)
OPTIMUM = ProvenOptimum(
    name="optimum",
    meaning="the proven least cost in hindsight, with the least deviation that is possible",
    look=Look(BLACK, DOTTED, "*"),
)
