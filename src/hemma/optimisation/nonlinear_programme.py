"""A nonlinear programme in CasADi's symbols, written down block by block and solved by IPOPT."""

import warnings
from dataclasses import dataclass, field
from importlib.util import find_spec
from types import ModuleType
from typing import Any, TypeAlias

import numpy as np
from jaxtyping import Bool, Float

from hemma.errors import HemmaError
from hemma.types import Scalar

SMOOTHINGS = (0.3, 0.03, 1e-3)
"""delta / x_max of |x| ~ sqrt(x^2 + delta^2), one solution after the other, each starting from the last.

To start with a round kink leads to better local optima than to start with a sharp one.
"""
SMALLEST_KINK = 1e-6
"""Least delta, so that the slope exists at x = 0 whatever the limits."""
MAX_ITERATIONS = 3000
"""A convex month needs about 50. A limit in seconds would make the result depend on the machine."""
SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
"""What IPOPT reports of a point that satisfies its conditions of optimality."""
OPTIONS = {
    "print_time": False,
    "show_eval_warnings": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.max_iter": MAX_ITERATIONS,
}

Symbols: TypeAlias = Any
"""CasADi's symbolic columns, one row a slot; their class is known only where CasADi is installed."""
Limit: TypeAlias = Scalar | np.ndarray


@dataclass(frozen=True)
class Found:
    """Where a programme was solved."""

    casadi: ModuleType
    variables: Symbols
    values: Any
    status: str

    def of(self, expression: Symbols) -> Float[np.ndarray, "rows"]:
        """Value of an expression at the solution."""
        evaluate = self.casadi.Function("evaluate", [self.variables], [expression])
        return np.asarray(evaluate(self.values), np.float64).ravel()


@dataclass
class NonlinearProgramme:
    """minimise f(x) subject to L <= g(x) <= U, l <= x <= u, written down block by block."""

    slots: int
    """Entries of a block."""
    convex: bool = True
    """Whether no absolute value had to be smooth."""
    _variables: list[Symbols] = field(default_factory=list)
    _limits: list[np.ndarray] = field(default_factory=list)
    """Of each block of variables l, u and where to start, shape (3, slots)."""
    _rows: list[Symbols] = field(default_factory=list)
    _ranges: list[np.ndarray] = field(default_factory=list)
    """Of each block of rows L and U, shape (2, rows)."""

    def __post_init__(self):
        """Import CasADi; ``HemmaError`` where it is not installed."""
        self._casadi = _casadi()
        self._smoothing = self._casadi.SX.sym("smoothing")

    def variable(self, lower: Limit, upper: Limit, start: Limit) -> Symbols:
        """One variable a slot."""
        symbols = self._casadi.SX.sym(f"x{len(self._variables)}", self.slots)
        self._variables.append(symbols)
        self._limits.append(np.stack([np.broadcast_to(x, self.slots) for x in (lower, upper, start)]))
        return symbols

    def constrain(self, expression: Symbols, lower: Limit, upper: Limit) -> None:
        """One constraint for each row of ``expression``."""
        self._rows.append(expression)
        self._ranges.append(np.stack([np.full(expression.shape[0], x) for x in (lower, upper)]))

    def before(self, first: float, symbols: Symbols) -> Symbols:
        """The values one slot earlier, ``first`` before the first slot."""
        return self._casadi.vertcat(first, symbols)[:-1]

    def size(self, x: Symbols, most: Limit, smooth: Bool[np.ndarray, "slots"]) -> Symbols:
        """|x|, where it is at most ``most``: a variable with |x| >= x and |x| >= -x, smooth in some slots.

        In all other slots a larger value must not be able to lower the objective.
        """
        size = self.variable(0.0, 2 * np.asarray(most) + SMALLEST_KINK, np.asarray(most) / 2)
        self.constrain(size - x, 0.0, np.inf)
        self.constrain(size + x, 0.0, np.inf)
        if np.any(smooth):
            self.convex = False
            kink = self._smoothing * np.broadcast_to(most, self.slots) + SMALLEST_KINK
            rounded = self._casadi.sqrt(x**2 + kink**2)
            self.constrain((size - rounded)[np.flatnonzero(smooth).tolist()], 0.0, 0.0)
        return size

    def total(self, block: Symbols) -> Symbols:
        """Sum of the rows of a block."""
        return self._casadi.sum1(block)

    def minimise(self, objective: Symbols) -> Found:
        """A point that satisfies the conditions of optimality; ``HemmaError`` if none was found."""
        x, g = self._casadi.vertcat(*self._variables), self._casadi.vertcat(*self._rows)
        problem = {"x": x, "f": objective, "g": g, "p": self._smoothing}
        solver = self._casadi.nlpsol("solver", "ipopt", problem, OPTIONS)
        lower, upper, values = np.concatenate(self._limits, axis=1)
        least, most = np.concatenate(self._ranges, axis=1)
        for smoothing in SMOOTHINGS[-1:] if self.convex else SMOOTHINGS:
            found = solver(x0=values, lbx=lower, ubx=upper, lbg=least, ubg=most, p=smoothing)
            values = found["x"]
        status = str(solver.stats()["return_status"])
        if status not in SOLVED:
            raise HemmaError(
                f"DNLP: expected IPOPT to converge, it reports {status}; check the home's settings, take a "
                "shorter period or use the proven optimum (hemma.optimisation.optimum)"
            )
        return Found(self._casadi, x, values, status)


def casadi_is_installed() -> bool:
    """Whether programmes can be solved here."""
    return find_spec("casadi") is not None


def _casadi() -> ModuleType:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # about the bindings, not about their use
            import casadi
    except ImportError as error:
        raise HemmaError(
            "DNLP: expected CasADi, which is not installed; install it with: pip install 'hemma[nlp]'"
        ) from error
    return casadi
