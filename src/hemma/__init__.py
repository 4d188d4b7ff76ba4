"""Hemma: home energy management that learns from an optimiser."""

__version__ = "0.1.0"
