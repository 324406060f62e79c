"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

``numerics`` compiles kernels and has their numerical methods, ``law`` evaluates the contact law,
``motion`` integrates Eq. (22).  Data enter as arrays and records of floats, which the layers above
have checked.  They leave as arrays of the caller and as status codes, which ``core.errors`` turns
into exceptions.  The only file that is read is ``law/ratios.npy``.  :mod:`.records` needs no numba.
"""
