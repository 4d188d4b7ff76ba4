"""Settings of the fit. Where Di Natale et al. 2022 print a value it is named beside ours."""

from dataclasses import dataclass

from hemma.home.checks import require


@dataclass(frozen=True)
class IdentificationSettings:
    """How the network is fitted; where each default comes from stands in ``docs/identification.md``."""

    width: int = 16
    """Units of a hidden layer of f; the paper's LSTM has 64."""
    depth: int = 1
    """Hidden layers of f."""
    window: float = 48.0
    """Length of a training sequence [h]; the paper: 12 to 72 h."""
    batch: int = 64
    """Windows in an update, from random start slots."""
    updates: int = 1500
    """Most updates."""
    learning_rate: float = 1e-2
    """First step of Adam, falling to zero along a cosine; the paper: 5e-4, constant."""
    gain_penalty: float = 0.01
    """Weight of the mean square of f / dt [(degC/h)^2] beside the mean square error [degC^2]."""
    validation_share: float = 0.2
    """Last part of the record, which chooses the checkpoint and takes no part in the updates."""
    chunk: int = 50
    """Updates between two looks at the validation error."""
    patience: int = 10
    """Chunks without a better validation error before training stops."""
    least_improvement: float = 0.1
    """Share by which training must lower the validation error, or the start is kept: noise gives some."""

    def __post_init__(self):
        """Refuse settings without meaning."""
        for name in ("width", "depth", "batch", "updates", "chunk", "patience"):
            require("identification", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        for name in ("window", "learning_rate"):
            require("identification", getattr(self, name) > 0, f"{name} > 0", getattr(self, name))
        require("identification", self.gain_penalty >= 0, "gain_penalty >= 0", self.gain_penalty)
        inside = 0 < self.validation_share < 1
        require("identification", inside, "validation_share in (0, 1)", self.validation_share)
        below_one = 0 <= self.least_improvement < 1
        require("identification", below_one, "least_improvement in [0, 1)", self.least_improvement)
