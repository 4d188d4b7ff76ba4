"""A linear programme with whole-number columns, written down block by block and solved by HiGHS."""

import os
from dataclasses import dataclass, field, replace
from functools import cache

import highspy
import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import csr_array

from hemma.errors import HemmaError
from hemma.types import Scalar

STANDARD_OUTPUT, STANDARD_ERROR = 1, 2
PRIMAL_SIMPLEX = 4
"""HiGHS's number for it."""
FEASIBILITY = 1e-9
"""How far the solver may break a constraint or a reduced cost; the replay forgives no more than this."""


@dataclass(frozen=True)
class SolverSettings:
    """When the solver may stop. Work decides, never a clock, so that no result depends on the machine."""

    relative_gap: float = 1e-6
    """Largest (objective - bound) / |objective| at which it stops."""
    max_nodes: int = 200
    """Nodes after which branch and bound gives up, with what it has proved by then."""
    rounds: int = 32
    """How often modes are sought with better duals, where prices are odd (``odd_prices``)."""
    most_branched: int = 300
    """Odd slots up to which branch and bound tries to close the gap that modes have left."""


@dataclass(frozen=True)
class Solution:
    """What the solver found and what it proved."""

    values: Float[np.ndarray, "columns"]
    """Value of every column, in the order in which they were added."""
    objective: float
    """c'x of these values."""
    bound: float
    """No feasible x has a smaller objective: by the duals of a linear programme, else by branch and bound."""
    row_duals: Float[np.ndarray, "rows"]
    """What one more unit of each row's limit costs; of no use where there are whole numbers."""


EXACT = SolverSettings()
"""The default: within a millionth of the optimum."""

Bound = Scalar | Float[np.ndarray, "entries"]


@dataclass
class Programme:
    """minimise c'x subject to L <= A x <= U, l <= x <= u, some x whole numbers.

    Columns and rows are added in blocks, one entry a slot; a number stands for a whole block.
    """

    slots: int
    """Entries of a block unless it says otherwise."""
    _columns: list[np.ndarray] = field(default_factory=list)
    _rows: list[np.ndarray] = field(default_factory=list)
    _entries: list[np.ndarray] = field(default_factory=list)
    _column_count: int = 0
    _row_count: int = 0

    def add_columns(
        self, lower: Bound, upper: Bound, cost: Bound = 0.0, whole: bool = False, entries: int | None = None
    ) -> Int[np.ndarray, "entries"]:
        """Add a block of columns l <= x <= u with cost c; give their indices."""
        entries = self.slots if entries is None else entries
        block = np.empty((entries, 4))
        block[:, 0], block[:, 1], block[:, 2], block[:, 3] = lower, upper, cost, whole
        self._columns.append(block)
        self._column_count += entries
        return np.arange(self._column_count - entries, self._column_count)

    @property
    def whole_numbers(self) -> int:
        """How many there are; with none it is a linear programme."""
        return sum(int(np.count_nonzero(block[:, 3])) for block in self._columns)

    def relaxed(self) -> "Programme":
        """The same without whole numbers."""
        columns = np.concatenate(self._columns)
        columns[:, 3] = 0.0
        return replace(self, _columns=[columns])

    def fixed(self, values: Float[np.ndarray, "whole"]) -> "Programme":
        """The same with these values of the whole numbers, in the order in which they were added."""
        columns = np.concatenate(self._columns)
        columns[columns[:, 3] > 0, :2] = values[:, None]
        columns[:, 3] = 0.0
        return replace(self, _columns=[columns])

    def add_rows(
        self, lower: Bound, upper: Bound, *terms: tuple[np.ndarray, Bound]
    ) -> Int[np.ndarray, "entries"]:
        """Add rows L <= sum of coefficient * x <= U, one for each entry of the terms' column blocks.

        Gives their indices.

        Each term is (columns, coefficient); columns of shape (rows, several) are all summed in their row.
        """
        entries = len(terms[0][0])
        rows = np.arange(self._row_count, self._row_count + entries)
        for columns, coefficient in terms:
            columns = columns.reshape(entries, 1) if columns.ndim == 1 else columns
            values = np.broadcast_to(np.reshape(np.asarray(coefficient, float), (-1, 1)), columns.shape)
            at = np.broadcast_to(rows[:, None], columns.shape)
            self._entries.append(np.stack([at.ravel(), columns.ravel(), values.ravel()]))
        block = np.empty((entries, 2))
        block[:, 0], block[:, 1] = lower, upper
        self._rows.append(block)
        self._row_count += entries
        return rows

    def solve(self, settings: SolverSettings) -> Solution:
        """Solve it the same way every time (one thread, fixed seed).

        Raises ``HemmaError`` where there is no solution, or none was found within the limit of work.
        """
        columns, rows, matrix = np.concatenate(self._columns), np.concatenate(self._rows), self._matrix()
        solver = _solver(settings)
        solver.passModel(_model(columns, rows, matrix))
        solver.run()
        if solver.getModelStatus() == highspy.HighsModelStatus.kSolveError:
            # The dual simplex sometimes gives up on long quarter-hour months; the primal one does not.
            solver.clearSolver()
            solver.setOptionValue("simplex_strategy", PRIMAL_SIMPLEX)
            solver.run()
        status, info = solver.getModelStatus(), solver.getInfo()
        if info.primal_solution_status != highspy.SolutionStatus.kSolutionStatusFeasible:
            raise HemmaError(_no_solution(status, solver, settings))
        found = solver.getSolution()
        if columns[:, 3].any():
            bound = float(info.mip_dual_bound)
        else:
            bound = dual_bound(columns, rows, matrix, np.asarray(found.row_dual))
        return Solution(
            values=np.asarray(found.col_value),
            objective=float(info.objective_function_value),
            bound=bound,
            row_duals=np.asarray(found.row_dual),
        )

    def _matrix(self) -> csr_array:
        row, column, value = np.concatenate(self._entries, axis=1)
        indices = (row.astype(np.int32), column.astype(np.int32))
        return csr_array((value, indices), shape=(self._row_count, self._column_count))


def dual_bound(
    columns: Float[np.ndarray, "columns 4"],
    rows: Float[np.ndarray, "rows 2"],
    matrix: csr_array,
    duals: Float[np.ndarray, "rows"],
) -> float:
    """A lower bound of c'x that any duals y prove, whoever computed them.

    c'x = y'(A x) + (c - A'y)'x >= sum_i min(y_i L_i, y_i U_i) + sum_j min(z_j l_j, z_j u_j), z = c - A'y.
    A dual whose side is infinite counts as 0.
    """
    y = np.where(np.isfinite(np.where(duals > 0, rows[:, 0], rows[:, 1])), duals, 0.0)
    z = columns[:, 2] - matrix.T @ y
    return _least(y, rows[:, 0], rows[:, 1]) + _least(z, columns[:, 0], columns[:, 1])


def _least(slope: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> float:
    used = slope != 0
    return float(np.sum(slope[used] * np.where(slope > 0, lower, upper)[used]))


def _solver(settings: SolverSettings) -> highspy.Highs:
    _greeted()
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("threads", 1)
    solver.setOptionValue("random_seed", 0)
    solver.setOptionValue("mip_rel_gap", settings.relative_gap)
    solver.setOptionValue("mip_max_nodes", settings.max_nodes)
    solver.setOptionValue("primal_feasibility_tolerance", FEASIBILITY)
    solver.setOptionValue("dual_feasibility_tolerance", FEASIBILITY)
    return solver


@cache
def _greeted() -> None:
    """Let HiGHS print its banner to standard error: its first constructor does so before it can be told not
    to, and standard output belongs to whoever calls."""
    try:
        kept = os.dup(STANDARD_OUTPUT)
    except OSError:  # it is closed
        return
    try:
        os.dup2(STANDARD_ERROR, STANDARD_OUTPUT)
        highspy.Highs()
    finally:
        os.dup2(kept, STANDARD_OUTPUT)
        os.close(kept)


def _model(columns: np.ndarray, rows: np.ndarray, matrix: csr_array) -> highspy.HighsLp:
    model = highspy.HighsLp()
    model.num_col_, model.num_row_ = len(columns), len(rows)
    model.col_lower_, model.col_upper_, model.col_cost_ = columns[:, 0], columns[:, 1], columns[:, 2]
    model.row_lower_, model.row_upper_ = rows[:, 0], rows[:, 1]
    model.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    model.a_matrix_.start_ = np.asarray(matrix.indptr, np.int32)
    model.a_matrix_.index_ = np.asarray(matrix.indices, np.int32)
    model.a_matrix_.value_ = np.asarray(matrix.data, np.float64)
    if columns[:, 3].any():
        kinds = (highspy.HighsVarType.kContinuous, highspy.HighsVarType.kInteger)
        model.integrality_ = [kinds[int(whole)] for whole in columns[:, 3]]
    return model


def _no_solution(status: highspy.HighsModelStatus, solver: highspy.Highs, settings: SolverSettings) -> str:
    came = solver.modelStatusToString(status).lower()
    if status == highspy.HighsModelStatus.kSolutionLimit:
        cure = f"allow more than {settings.max_nodes} nodes (max_nodes) or plan a shorter horizon"
    else:
        cure = "check that the traces are finite and that the home's initial state is within its limits"
    return f"optimiser: expected a schedule, the solver reports '{came}'; {cure}"
