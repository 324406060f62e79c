"""Pictures by name (:data:`FIGURES`): the paper's, the drawing behind the symbols, and those of the
site's gallery.

A picture of the gallery is the code of its page: it is run here as a reader runs it.
"""

from __future__ import annotations

import runpy
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from viscoroll.core.plots import draw
from viscoroll.motion.summaries import drawn_summary

from ..stage import ROOT
from .geometry import geometry
from .law import figure_2, figure_3, grid, rubber_roller
from .stresses import figure_7

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GALLERY = ROOT / "docs/examples/gallery"


def of_page(page: str, name: str = "figure") -> Figure:
    """The figure that a page of the gallery gives this name."""
    figure: Figure = runpy.run_path(str(GALLERY / f"{page}.py"))[name]
    return figure


#: picture -> page of the gallery, and the name of its figure there if it is another
PAGES = {
    "figure-5": "motion/b_section_5",
    "figure-6": "motion/b_section_5 contact",
    "phase-portrait": "motion/c_phase_portrait",
    "rolling-resistance": "materials/b_three_temperatures",
    "rolling-equilibria": "drive/a_equilibria",
    "wheel-spin": "drive/b_wheel_spin",
    "reversal": "drive/c_reversal",
    "slope": "drive/d_slope",
    "law-of-modes": "contact/d_broad_rubber",
    "law-of-pairs": "materials/c_rubber_on_steel",
    "broad-stresses": "contact/d_broad_rubber stresses",
    "load-speed": "heat/c_load_speed",
}
FIGURES: dict[str, Callable[..., Figure]] = {
    "rubber-roller": rubber_roller,
    "grid": grid,
    "geometry": geometry,
    "figure-2": figure_2,
    "figure-3": figure_3,
    "figure-7": figure_7,
    "ensemble": lambda motions: draw(drawn_summary(motions)),
} | {name: partial(of_page, *page.split()) for name, page in PAGES.items()}
