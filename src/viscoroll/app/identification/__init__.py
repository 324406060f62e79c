"""From measurements to parameters: records, the fit, and what it says.

Read in this order: :mod:`records`, what was measured; :mod:`unknowns`, names and a cylinder of their values;
:mod:`problem`, residuals and least squares; :mod:`profile`, intervals and products; :mod:`fit`, what is found;
:mod:`identify`, all of it by searches; :mod:`report`, in words; :mod:`measurements_toml`, of TOML.
"""

from .fit import Identification
from .identify import identify
from .profile import Product
from .records import Coastdown, Resistance, Traction

__all__ = ["Coastdown", "Identification", "Product", "Resistance", "Traction", "identify"]
