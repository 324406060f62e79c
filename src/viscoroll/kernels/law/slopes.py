"""A = H'/F', the slope of Q over that of delta, and its differences."""

from __future__ import annotations

from ..compile.jit import kernel
from ..material.functions import generator_slopes, second_slopes
from ..material.standard import GAUSS_W, GAUSS_X


@kernel
def slope_ratio(z, material):
    """A = H'/F' at z."""
    _, h, dg, dh = generator_slopes(z, material)
    return 2.0 * (z + h + z * dh) / (1.0 + dg)


@kernel
def slope_ratio_rise(z, D, material):
    """A(z) - A(z - D) for small D, as the integral of A': no digits cancel."""
    total = 0.0
    for n in range(5):
        x = z - D * GAUSS_X[n]
        _, h, dg, dh, ddg, ddh = second_slopes(x, material)
        dH, ddH = 2.0 * (x + h + x * dh), 2.0 + 4.0 * dh + 2.0 * x * ddh
        dF = 1.0 + dg
        total += GAUSS_W[n] * (ddH * dF - dH * ddg) / (dF * dF)
    return D * total
