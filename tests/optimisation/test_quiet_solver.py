"""The solver leaves standard output to whoever calls."""

import subprocess
import sys

SOLVE = """
import numpy as np
from hemma.optimisation.exact.programme import EXACT, Programme
programme = Programme(2)
columns = programme.add_columns(0.0, 1.0, cost=-1.0)
programme.add_rows(-np.inf, 1.5, (columns.reshape(1, 2), 1.0))
print(programme.solve(EXACT).objective)
"""


def test_a_first_solution_prints_nothing_of_its_own():
    done = subprocess.run([sys.executable, "-c", SOLVE], capture_output=True, text=True, check=True)
    assert done.stdout == "-1.5\n"
