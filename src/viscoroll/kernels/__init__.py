"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

Rooms, each standing on those before it:

    compile    the decorator, its cache, fused arithmetic
    numerics   nodes and matrices of interpolation and quadrature, vectors of four, loops over arrays
    bessel     the ratios r = I1/I0, k = K0/K1, i2 = I2/I0
    rows       the law as polynomials, an octave each: what makes them from the modes of a material, states and stresses
               read from them, and a C function
    motion     Eq. (22), with what drives it, of one material or of one each
    flow       many motions of one scene: its flow map, filled and read
    printed    the law as the paper prints it, by root solves: for comparison alone

Loops over arrays are in the modules whose name holds ``loop``.
"""
