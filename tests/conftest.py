"""What every test sees: the profiles of hypothesis, which process runs it, what was compiled before."""

import jax
import pytest
from hypothesis import HealthCheck, settings

from hemma.cli.compilation import processor

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")


def pytest_configure(config):
    """Most of the time goes into compiling: processes and later runs share what was compiled."""
    jax.config.update("jax_compilation_cache_dir", str(config.cache.mkdir(f"compiled-{processor()}")))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """One process runs all tests that share the tiny experiment, and every file is run by one process.

    First of all hooks: xdist's own reads the marks.
    """
    for item in items:
        group = "finished" if "finished" in item.fixturenames else item.nodeid.split("::")[0]
        item.add_marker(pytest.mark.xdist_group(group))
