"""Parameters of a cylinder from measurements, with intervals.

Read in this order: :mod:`records`, the measurements; :mod:`unknowns`, their names and a cylinder of their values;
:mod:`problem`, residuals and least squares; :mod:`profile`, intervals and products; :mod:`fit`, the result;
:mod:`identify`, the searches; :mod:`report`, text, dataset and JSON; :mod:`measurements_toml`, files.
"""

from .fit import Identification
from .identify import identify
from .profile import Product
from .records import Coastdown, Resistance, Traction

__all__ = ["Coastdown", "Identification", "Product", "Resistance", "Traction", "identify"]
