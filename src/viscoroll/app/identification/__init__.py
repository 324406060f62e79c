"""From measurements to parameters: records, the fit, and what it says.

Read in this order: :mod:`records`, what was measured; :mod:`unknowns`, names and a cylinder of their values;
:mod:`problem`, residuals and least squares; :mod:`profile`, intervals and products; :mod:`fit`, what is found;
:mod:`ask`, all of it by searches; :mod:`report`, in words; :mod:`file`, of TOML.
"""

from .ask import identify
from .fit import Identification
from .profile import Product
from .records import Coastdown, Resistance, Traction

__all__ = ["Coastdown", "Identification", "Product", "Resistance", "Traction", "identify"]
