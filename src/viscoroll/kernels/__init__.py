"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

Read in this order: :mod:`ratios` (the Bessel ratios), :mod:`law` (the contact law, explicit
in (zeta, eta), and its two inverses), :mod:`direct` (the same law as the paper prints it),
:mod:`stress`, then the motion: :mod:`full_slip`, :mod:`partial_slip`, :mod:`stepper`,
:mod:`integrate`.  Array loops over them are in :mod:`loops`.
"""
