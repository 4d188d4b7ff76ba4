"""Identification: a physically consistent neural network from simulated or logged temperatures."""

from hemma.identification.excitation import Excitation, excite
from hemma.identification.fit import Fit, LearningCurve, fit
from hemma.identification.pcnn import (
    InputScaling,
    PcnnWeights,
    PhysicallyConsistentNetwork,
    ThermalResponse,
)
from hemma.identification.record import ThermalRecord, logged_record
from hemma.identification.settings import IdentificationSettings
from hemma.identification.start import input_scaling, least_squares_response
from hemma.identification.store import load_model, save_model
from hemma.identification.validation import FreeRunErrors, free_run, free_run_errors, run_free

__all__ = [
    "Excitation",
    "Fit",
    "FreeRunErrors",
    "IdentificationSettings",
    "InputScaling",
    "LearningCurve",
    "PcnnWeights",
    "PhysicallyConsistentNetwork",
    "ThermalRecord",
    "ThermalResponse",
    "excite",
    "fit",
    "free_run",
    "free_run_errors",
    "input_scaling",
    "least_squares_response",
    "load_model",
    "logged_record",
    "run_free",
    "save_model",
]
