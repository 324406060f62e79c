"""Pictures by name (:data:`FIGURES`): the paper's figures, and what else there is to see.

Each function returns a matplotlib ``Figure`` of its own, without pyplot and its global state,
and takes what it shows as arguments with the paper's values as defaults.  All are readable
in grey.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ..plots.style import save
from .deceleration import figure_5, figure_6, figure_7
from .distribution import ensemble_distribution
from .drive import reversal, wheel_spin
from .geometry import geometry
from .law import figure_2, figure_3
from .material import rolling_resistance
from .portrait import phase_portrait
from .run_distributions import run_distributions
from .sensitivity import sobol_bars
from .series import broad_stresses, law_of_materials, law_of_pairs
from .slope import slope_portrait
from .steady import rolling_equilibria

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "FIGURES", "broad_stresses", "ensemble_distribution", "figure_2", "figure_3", "figure_5",
    "figure_6", "figure_7", "geometry", "law_of_materials", "law_of_pairs", "phase_portrait", "reversal",
    "rolling_equilibria", "rolling_resistance", "run_distributions", "save", "slope_portrait", "sobol_bars",
    "wheel_spin",
]  # fmt: skip

FIGURES: dict[str, Callable[..., Figure]] = {
    "geometry": geometry,
    "figure-2": figure_2,
    "figure-3": figure_3,
    "figure-5": figure_5,
    "figure-6": figure_6,
    "figure-7": figure_7,
    "phase-portrait": phase_portrait,
    "ensemble": ensemble_distribution,
    "rolling-resistance": rolling_resistance,
    "rolling-equilibria": rolling_equilibria,
    "wheel-spin": wheel_spin,
    "reversal": reversal,
    "slope": slope_portrait,
    "law-of-modes": law_of_materials,
    "law-of-pairs": law_of_pairs,
    "broad-stresses": broad_stresses,
}
