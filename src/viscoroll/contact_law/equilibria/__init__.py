"""Steady rolling under load: all equilibria, and the rolling resistance over speed that they lie on."""

from .resistance import Humps, humps
from .result import Loss, Steady
from .rolling import steady

__all__ = ["Humps", "Loss", "Steady", "humps", "steady"]
