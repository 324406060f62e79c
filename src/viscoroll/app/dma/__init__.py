"""From a dynamic mechanical analysis (DMA) to a Prony series.

:func:`read_dma` gives :class:`DynamicModuli`, :func:`fit_prony` makes of them a :class:`Fit`, and
:func:`fit_relaxation` of a relaxation modulus a :class:`RelaxationFit`.  Storage and loss modulus are fitted alike,
by relative errors, since rolling resistance follows from the loss modulus.  A fit reports the misfit, modes beyond
the measured frequencies, whether storage and loss modulus go together, and what wider grids of times would change.

A file goes through :mod:`.reader`, :mod:`.vocabulary`, :mod:`.column_quantities` and :mod:`.moduli_from_pair`;
curves at several temperatures through :mod:`.temperature_sets` and :mod:`.master_curve`; a curve through
:mod:`.spectrum` and :mod:`.mode_selection`; :mod:`.fit_results`, :mod:`.fit_report` and :mod:`.spectrum_sensitivity`
describe the fit.
"""

from .dynamic_moduli import DynamicModuli
from .fit import fit_prony, fit_relaxation
from .fit_results import Fit, RelaxationFit
from .reader import read_dma

__all__ = ["DynamicModuli", "Fit", "RelaxationFit", "fit_prony", "fit_relaxation", "read_dma"]
