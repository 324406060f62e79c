"""Materials: their series, pairs of bodies, files, and the tables that kernels read."""

from .measured import Measured
from .shift import WLF, Arrhenius

__all__ = ["WLF", "Arrhenius", "Measured"]
