"""From measurements to parameters: records, the fit, and what it says.

Read in this order: :mod:`records`, what was measured; :mod:`unknowns`, names and a cylinder of their values;
:mod:`problem`, residuals and least squares; :mod:`search`, starts and minima; :mod:`profile`, intervals; :mod:`said`,
what the data do not tell; :mod:`fit`, all of it together; :mod:`report`, in words; :mod:`file`, of a TOML file.
"""

from .fit import Identification, Product, identify
from .records import Coastdown, Resistance, Traction

__all__ = ["Coastdown", "Identification", "Product", "Resistance", "Traction", "identify"]
