"""Scalar numba kernels: numbers in, numbers out; no validation, no I/O, no exceptions.

Folders, each of which uses only those before it:

    compile    the decorator, its disk cache, LLVM's instructions
    numerics   nodes and matrices of interpolation and quadrature, vectors of four doubles, loops over arrays
    bessel     the ratios r = I1/I0, k = K0/K1, i2 = I2/I0
    rows       the law as polynomials, one octave each: how they are made from the modes of a material, contact states
               and stresses evaluated from them, and a C function
    motion     Eq. (22), with loads, of one material or of one material for each motion
    flow       many motions of one scene: its flow map, filled and evaluated
    printed    the law as the paper prints it, by root solves: for comparison alone
    splines    the law of a grid at one alpha, by splines

Loops over arrays are in the modules whose name contains ``loop``.
"""
