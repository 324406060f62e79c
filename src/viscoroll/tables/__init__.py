"""Tables of the contact law: files of one material or pair, and grids for other programs.

    import viscoroll as vr
    law = vr.tables.law(vr.presets.RUBBER_CYLINDER)
    vr.tables.save(law, "rubber.nc")  # for vr.load_law, and any program that reads netCDF
    vr.tables.export(law, "rubber.h")  # table and evaluator in one header of C

    roller = vr.presets.RUBBER_CYLINDER
    V = vr.tables.spread(1e-3, 10.0, 201, "log")
    grid = vr.tables.build(roller, V=V, delta=[-0.01, 0.0, 0.01])
    vr.tables.export(grid, "rubber.txt")  # Modelica

Modules, in the order of reading: :mod:`law_dataset` (laws as datasets, checks of tables),
:mod:`grid_build` (grids), :mod:`table_files` (files of both, interpolation), :mod:`table_export`
(formats of other programs).
"""

from .grid_build import build, creep_nodes, spread
from .law_dataset import law
from .table_export import export
from .table_files import Interpolant, info, interpolate, load, save

__all__ = [
    "Interpolant",
    "build",
    "creep_nodes",
    "export",
    "info",
    "interpolate",
    "law",
    "load",
    "save",
    "spread",
]
