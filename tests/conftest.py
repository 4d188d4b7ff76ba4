"""What every test sees: the profiles of hypothesis, quick compilation, and who runs which tests."""

import jax
import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")

jax.config.update("jax_disable_most_optimizations", True)
"""Most tests run each program for a moment only. Those that compare bits optimise (``companions``)."""


def pytest_collection_modifyitems(items):
    """One process runs all tests that share the tiny experiment, and every file is run by one process."""
    for item in items:
        group = "finished" if "finished" in item.fixturenames else item.nodeid.split("::")[0]
        item.add_marker(pytest.mark.xdist_group(group))
