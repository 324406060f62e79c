"""A table against direct solves of the printed equations, at random nodes and between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError, TableError
from ..rolling_contact import contact
from ..scene import Scene
from ..tables import interpolate, schema
from ..tables.grid import ATLAS_MAPS
from .report import Check

if TYPE_CHECKING:
    import xarray as xr
