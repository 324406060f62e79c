"""From a dynamic mechanical analysis (DMA) to a Prony series.

:func:`read_dma` gives :class:`DynamicModuli`, :func:`fit_prony` makes of them a :class:`Fit`; :func:`read_relaxation`
gives a :class:`RelaxationModulus`, :func:`fit_relaxation` makes of it a :class:`RelaxationFit`. Storage and loss
modulus are fitted alike, by relative errors, since rolling resistance follows from the loss modulus. A fit reports
the misfit, modes beyond the measured frequencies, whether storage and loss modulus go together, and what wider grids
of times would change.

A file goes through :mod:`.reader` or :mod:`.relaxation_reader`, which share :mod:`.table_reader`, :mod:`.vocabulary`
and :mod:`.column_quantities`, and :mod:`.moduli_from_pair`; curves at several temperatures through
:mod:`.temperature_sets` and :mod:`.master_curve`; a curve through :mod:`.spectrum` and :mod:`.mode_selection`;
:mod:`.fit_results`, :mod:`.fit_report` and :mod:`.spectrum_sensitivity` describe the fit.
"""

from .dynamic_moduli import DynamicModuli
from .fit import fit_prony, fit_relaxation
from .fit_results import Fit, RelaxationFit
from .reader import read_dma
from .relaxation_reader import RelaxationModulus, read_relaxation

__all__ = [
    "DynamicModuli", "Fit", "RelaxationFit", "RelaxationModulus", "fit_prony", "fit_relaxation", "read_dma",
    "read_relaxation",
]  # fmt: skip
