"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

Read in this order: :mod:`ratios` (the Bessel ratios), :mod:`law` (the contact law, explicit
in (zeta, eta), and its two inverses), :mod:`slice_fit` (the law at one alpha),
:mod:`direct` (the same law as the paper prints it), :mod:`stress`, then the motion:
:mod:`full_slip`, :mod:`slide`, :mod:`partial_slip`, :mod:`layer`, :mod:`slow`, :mod:`explicit`, :mod:`stepper`,
their four phases in the modules that end in ``_phase``, :mod:`integrate`; its flow map: :mod:`flow_layout`,
:mod:`flow_slide`, :mod:`flow_slow`, :mod:`flow_layer`, :mod:`flow`, :mod:`flow_inside`.  Array loops over
them are in the modules that end in ``_loop`` or ``_loops``.
"""
