"""Numerical methods: interpolation and quadrature, vectors of four doubles, bins of a float, loops over arrays."""
