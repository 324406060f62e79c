"""Laws: the contact law of a material as tables that kernels read.

A material enters :func:`.law_tables.law_table`, arrays of materials :mod:`.laws_per_element`, a
file :func:`.law_netcdf.load_law`.  Values by the modes (:mod:`.law_rows`, :mod:`.cover_solve`) are
fitted by rows, which :mod:`.row_layout` alone arranges, or stand on a grid (:mod:`.law_grid`).  A
law leaves as a record for kernels, or as a dataset (:mod:`.law_netcdf`).
"""

from .. import _open_room

__getattr__ = _open_room(__name__, __file__)
