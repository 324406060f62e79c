"""Tables of the contact law for other tools: build, save, load, interpolate.

:class:`AtlasGrid` asks for the universal table over (alpha, kappa V, s), one for every mu and
kappa; :class:`LiteralGrid` for Q, beta, ... over (V, delta, alpha) at one kappa and mu;
:class:`MaterialGrid` for them over (V, delta) of one material of several relaxation times, or of a pair.

    import viscoroll as vr
    atlas = vr.tables.build(vr.tables.AtlasGrid())
    vr.tables.save(atlas, "atlas.nc")
    vr.tables.interpolate(vr.tables.load("atlas.nc"), alpha=11.0, kappa_V=0.7, s=0.3).Q_over_mu

Read in this order: :mod:`grid` (axes and coordinate maps), :mod:`of_material`, :mod:`solving`, :mod:`literal`,
:mod:`build`, :mod:`schema` (what a file holds), :mod:`survey`, :mod:`content` and :mod:`rehearsal` (what its
bytes hold, checked), :mod:`store` (atomic save, checked load), :mod:`interpolate`, :mod:`accuracy` (the exact law
at a table's coordinates), :mod:`export` (formats of other programs).
"""

from .build import build
from .export import check_format, export
from .grid import AtlasGrid, LiteralGrid, spread
from .interpolate import Interpolant, interpolate
from .of_material import MaterialGrid
from .store import info, load, save

__all__ = [
    "AtlasGrid",
    "Interpolant",
    "LiteralGrid",
    "MaterialGrid",
    "build",
    "check_format",
    "export",
    "info",
    "interpolate",
    "load",
    "save",
    "spread",
]
