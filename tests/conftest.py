"""What every test sees: the profiles of hypothesis, which process runs it, what was compiled before."""

import re
from pathlib import Path

import jax
import pytest
from hypothesis import HealthCheck, settings
from xdist.scheduler import LoadScopeScheduling

from hemma.cli.compilation import processor

TESTS = Path(__file__).parent
SHARE_THE_EXPERIMENT = {
    file.relative_to(TESTS.parent).as_posix()
    for file in (TESTS / "experiment").glob("test_*.py")
    if re.search(r"def \w+\([^)]*\bfinished\b", file.read_text(encoding="utf-8"))
}
"""Files whose tests or fixtures take the fixture ``finished``."""

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")


def pytest_configure(config):
    """Most of the time goes into compiling: processes and later runs share what was compiled."""
    if not config.pluginmanager.has_plugin("cacheprovider"):
        return
    jax.config.update("jax_compilation_cache_dir", str(config.cache.mkdir(f"compiled-{processor()}")))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Every file is run by one process, and all files that share the tiny experiment by the same."""
    return _ByFile(config, log)


class _ByFile(LoadScopeScheduling):
    def _split_scope(self, nodeid):
        file = nodeid.split("::")[0]
        return "experiment" if file in SHARE_THE_EXPERIMENT else file
