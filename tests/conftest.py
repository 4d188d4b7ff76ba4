"""What every test sees: the profiles of hypothesis, and which tests run in one process."""

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")


def pytest_collection_modifyitems(items):
    """The tests of a file run in one process, and those that read the finished experiment in one as well.

    For ``--dist loadgroup``.
    """
    for item in items:
        shares = "finished" in item.fixturenames
        item.add_marker(pytest.mark.xdist_group("finished" if shares else item.nodeid.partition("::")[0]))
