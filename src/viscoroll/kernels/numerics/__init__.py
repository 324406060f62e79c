"""How kernels are compiled, and the numerical methods that they share.

:mod:`jit` has the decorator and the disk cache, :mod:`deferred_compilation` one run of LLVM for a
kernel with all that it calls, :mod:`intrinsics` and :mod:`simd` single instructions.
:mod:`newton_polynomial` is one through scattered points, :mod:`interpolation` has nodes and
matrices, in exact arithmetic.  Machine code enters from and leaves to the folder of
:mod:`cache_folder`.
"""
