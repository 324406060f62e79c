"""Materials: series, pairs of bodies, covers, materials in SI units, and their files.

:class:`.prony.Prony`, :class:`.bodies.Bodies` and :class:`.bodies.Cover` are dimensionless;
:class:`.material.Material` and :class:`.pair.Pair` have SI units.  Moduli and times enter as
arguments, from finite element programs (:mod:`.importers`) and from files (:mod:`.material_toml`,
:mod:`.checked_netcdf`).  They leave as series, from which ``laws`` makes tables.
"""

from .. import _open_room

__getattr__ = _open_room(__name__, __file__)
