"""Motion of the cylinder, Eq. (22): :func:`roll` one, or an :func:`ensemble`."""

from .batch import Ensemble, ensemble
from .single import Motion, roll

__all__ = ["Ensemble", "Motion", "ensemble", "roll"]
