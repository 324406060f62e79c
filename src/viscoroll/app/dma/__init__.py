"""From a dynamic mechanical analysis (DMA) to a Prony series: :func:`read_dma` gives :class:`DynamicModuli`,
:func:`fit_prony` makes of them a :class:`Fit`, and :func:`fit_relaxation` of a relaxation modulus a
:class:`RelaxationFit`.

Storage and loss modulus over angular frequency are fitted alike, by relative errors, since rolling resistance is
made of the loss modulus.  What the data do not say is said: misfit, modes beyond the measured frequencies, whether
storage and loss go together, and what wider grids of times would change.
"""

from .dynamic_moduli import DynamicModuli
from .fit import fit_prony, fit_relaxation
from .fit_results import Fit, RelaxationFit
from .reader import read_dma

__all__ = ["DynamicModuli", "Fit", "RelaxationFit", "fit_prony", "fit_relaxation", "read_dma"]
