"""The contact law at one alpha as piecewise polynomials in one variable: how they are fitted.

At a fixed alpha Eqs. (6), (8)-(10), (15), (16) hold two functions of one variable each,
kappa |V| and y = F(eta).  Of kappa |V|, an octave at a time:

    lam, epsilon, 2 kappa V F(zeta) = 2 kappa delta_star/mu, M/V

and of y

    eta/y, H(eta)/y^2, H'(eta)/(2 y F'(eta))

the last being the slope of H(F^-1(y)) over 2 y.  Bins and degree are those of the Bessel
ratios (:mod:`bessel.layout`): the functions are analytic where Re > 0, and so the same
argument bounds the error.  :mod:`slice_loop` reads them.
"""

from __future__ import annotations

import numpy as np

from ..bessel.layout import BINS, COEFFICIENTS
from ..compile.jit import kernel
from ..numerics.nodes import chebyshev, rounded, to_chebyshev
from .length import OK, contact_length
from .material import generator_slopes, generators, moment_factor
from .standard import standard
from .stick import root_of_F

LENGTH, SHIFT, CREEP, MOMENT = range(4)
SHARE, PRESS, RISE = range(3)

_HALF_BIN = 0.5 / BINS
#: Chebyshev nodes, the middle one at the centre of the bin
_NODES = rounded(chebyshev(COEFFICIENTS))
#: from values at the nodes to Chebyshev coefficients
_TO_CHEBYSHEV = to_chebyshev(COEFFICIENTS)
#: from these to coefficients of powers of the offset from the centre of the bin
_TO_POWERS = np.zeros((COEFFICIENTS, COEFFICIENTS))
for _n in range(COEFFICIENTS):
    _TO_POWERS[: _n + 1, _n] = np.polynomial.chebyshev.cheb2poly(np.eye(COEFFICIENTS)[_n, : _n + 1])
_TO_POWERS /= _HALF_BIN ** np.arange(COEFFICIENTS)[:, None]


@kernel
def _node(octave, index, n):
    """Argument of node ``n`` of a bin: exact but for one rounding."""
    return 2.0**octave * (1.0 + (index + 0.5 + 0.5 * _NODES[n]) / BINS)


@kernel(allocates=True)
def _fitted(values):
    """Coefficients[bin, function, power] from values[bin, function, node].

    Only the differences from the value at the centre are fitted, and by way of the rapidly
    falling Chebyshev coefficients: both keep rounding out of the powers.
    """
    out = np.zeros(values.shape)
    chebyshev = np.empty(COEFFICIENTS)
    for index in range(values.shape[0]):
        for f in range(values.shape[1]):
            centre = values[index, f, COEFFICIENTS // 2]
            for k in range(COEFFICIENTS):
                chebyshev[k] = 0.0
                for n in range(COEFFICIENTS):
                    chebyshev[k] += _TO_CHEBYSHEV[k, n] * (values[index, f, n] - centre)
            out[index, f, 0] = centre
            for m in range(1, COEFFICIENTS):
                for k in range(m, COEFFICIENTS):
                    out[index, f, m] += _TO_POWERS[m, k] * chebyshev[k]
    return out


@kernel(allocates=True)
def speed_octave(alpha, octave):
    """(coefficients[bin, function, power], status) for kappa |V| in [2^octave, 2^(octave + 1))."""
    material = standard(alpha)
    values = np.empty((BINS, 4, COEFFICIENTS))
    worst = OK
    for index in range(BINS):
        for n in range(COEFFICIENTS):
            kappa_V = _node(octave, index, n)
            lam, status = contact_length(kappa_V, material)
            zeta = 0.5 * lam / kappa_V
            g, _ = generators(zeta, material)
            values[index, LENGTH, n] = lam
            values[index, SHIFT, n] = g / zeta
            values[index, CREEP, n] = lam * (1.0 + g / zeta)
            values[index, MOMENT, n] = moment_factor(zeta, lam, material)
            worst = max(worst, status)
    return _fitted(values), worst


@kernel(allocates=True)
def stick_octave(alpha, octave):
    """(coefficients[bin, function, power], status) for y = F(eta) in [2^octave, 2^(octave + 1))."""
    material = standard(alpha)
    values = np.empty((BINS, 3, COEFFICIENTS))
    worst = OK
    for index in range(BINS):
        for n in range(COEFFICIENTS):
            y = _node(octave, index, n)
            eta, _, _, status = root_of_F(y, y, material)
            _, h, dg, dh = generator_slopes(eta, material)
            share = eta / y
            values[index, SHARE, n] = share
            values[index, PRESS, n] = share * (eta + 2.0 * h) / y
            values[index, RISE, n] = (eta + h + eta * dh) / (y * (1.0 + dg))
            worst = max(worst, status)
    return _fitted(values), worst
