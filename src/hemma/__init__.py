"""Hemma: home energy management that learns from an optimiser."""

import os

__version__ = "0.1.0"

os.environ.setdefault("NPROC", "2")
"""Threads that XLA shares its work among, whatever the cores: it cuts products and sums by their number, and
rounds them otherwise. It reads this when JAX is first used, so import Hemma before."""
