"""What every test sees: the profiles of hypothesis, and which process runs it."""

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")


def pytest_collection_modifyitems(items):
    """One process runs all tests that share the tiny experiment, and every file is run by one process."""
    for item in items:
        group = "finished" if "finished" in item.fixturenames else item.nodeid.split("::")[0]
        item.add_marker(pytest.mark.xdist_group(group))
