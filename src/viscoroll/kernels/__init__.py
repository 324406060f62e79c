"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

Rooms, each standing on those before it:

    compile    the decorator, its cache, fused arithmetic
    numerics   nodes and matrices of interpolation and quadrature, brackets, loops over arrays
    bessel     the ratios r = I1/I0, k = K0/K1, i2 = I2/I0
    material   what the law knows of a material or of two bodies: g, h, m, b of z, by Bessel ratios or from a table
    law        the contact law, explicit in (zeta, eta), its inverses and slopes, stresses
    rows       the law of one material or pair as polynomials, an octave each: states read from them, and a C function
    motion     Eq. (22): full slip, the boundary layer, the slow manifold, and what hands a motion from one to the next
    flow       many motions of one scene: its flow map, filled and read
    drive      Eq. (22) with what drives it, and of bodies that differ
    printed    the law as the paper prints it, by root solves: for comparison alone

Loops over arrays are in the modules whose name holds ``loop``.
"""
