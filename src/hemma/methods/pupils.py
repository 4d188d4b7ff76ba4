"""What the name of a learned method says: how it learns, what it sees, and who teaches it."""

from dataclasses import dataclass

from hemma.forecasting.observations import MODELS, PAPER, ObservationModel

IMITATING = ("HA-1", "HA-2", "GAIL", "MaxEnt IRL", "MaxEnt IRL neural", "BC")
PAID = ("PPO", "DDPG")
LEARNED = (*IMITATING, *PAID)
"""All methods that learn, each of which may see more than the paper's state."""
CAUSAL = " causal"
GRAMMAR = (
    f"one of {', '.join(LEARNED)}; behind it, if it is to see more than the paper's state, one of "
    f"{', '.join(name for name in MODELS if name != PAPER.name)}; behind that, if it imitates and a planner "
    "without hindsight is to demonstrate, causal"
)
"""What a name may be, for readers."""


@dataclass(frozen=True)
class Pupil:
    """A learned method."""

    method: str
    """One of ``LEARNED``."""
    model: ObservationModel = PAPER
    """What it sees."""
    is_causal: bool = False
    """Whether a rolling planner that knows no more than the pupil may demonstrates, instead of the expert in
    hindsight."""

    @property
    def name(self) -> str:
        """``HA-1``, ``PPO published``, ``HA-1 forecast causal``."""
        seen = "" if self.model == PAPER else f" {self.model.name}"
        return f"{self.method}{seen}{CAUSAL if self.is_causal else ''}"

    @property
    def is_plain(self) -> bool:
        """Whether it is the method as the paper has it."""
        return self.model == PAPER and not self.is_causal


def _all() -> dict[str, Pupil]:
    pupils = (
        Pupil(method, model, is_causal)
        for method in LEARNED
        for model in MODELS.values()
        for is_causal in ((False, True) if method in IMITATING else (False,))
    )
    return {pupil.name: pupil for pupil in pupils}


PUPILS = _all()
"""All there are, by name."""
