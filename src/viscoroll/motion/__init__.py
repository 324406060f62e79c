"""Motion of the cylinder, Eq. (22): :func:`roll` one, or an :func:`ensemble`."""

from .batch import ensemble
from .many import Ensemble
from .one import Motion
from .single import roll

__all__ = ["Ensemble", "Motion", "ensemble", "roll"]
