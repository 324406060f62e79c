"""Rows of the law of one material or pair, fitted to the formulas of its modes.

The formulas are evaluated once, at 24 nodes an octave of w = 1/z, with z half the transit time of the contact in units
of T_ref, the unit of time of the material.  The polynomials of w are then inverted: for the functions of u = kappa |V|,
w = 2 u (1 + 2 h/z)^(1/2), for those of v = 1/F(eta), w = v (1 + g/z), with the functions g and h of the material
(:mod:`...kernels.rows.series`).  They give F(z) = z + g and H(z) = z^2 + 2 z h, the contact length over that at rest
lam = (1 + 2 h/z)^(-1/2), and its shift over half the length epsilon = g/z; eta is z of the stick zone.  All quantities
are dimensionless; M/V is in units of P T_ref.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.array_types import Floats
from .evaluate import evaluate_by_modes
from .pack import FUNCTIONS, steady_table
from .rows import Rows

#: as rows._ROUNDING, for N, whose formula has larger rounding errors; dimensionless
_ROUNDING_OF_N = 3e-15
#: Newton steps for w from an error of 1e-3: two leave 1e-13, whose effect is of second order and below rounding
_NEWTON_STEPS = 2


@dataclass(frozen=True)
class _FunctionsOfW:
    """Polynomials of w = 1/z for g/z, h/z, and M/V of half-space and cylinder; dimensionless.

    rows : octaves of w, as :class:`.rows.Rows`.
    powers : coefficients, (4, rows, 24 powers).
    values : values at the nodes, (4, nodes), the nodes of all rows one after another.
    """

    rows: Rows
    powers: Floats
    values: Floats

    def at_speed(self, u: Floats) -> tuple[Floats, Floats]:
        """Return lam, epsilon, and M/V of half-space and cylinder at u, and their derivatives with respect to ln u.

        :func:`fit_rows` fits the rows of u to it.
        u: kappa |V|, dimensionless, > 0, shape (n,), such that w = 2 u (1 + 2 h/z)^(1/2) lies within ``rows``, which is
            not checked.
        Returns (values of the four functions, their derivatives), (4, n) each, dimensionless.
        """
        (shift, rise, *parts), (d_shift, d_rise, *d_parts) = self._solve(u, 1, lambda whole: 2.0 * np.sqrt(whole))
        lam = 1.0 / np.sqrt(1.0 + 2.0 * rise)
        return np.stack([lam, shift, *parts]), np.stack([-(lam**3) * d_rise, d_shift, *d_parts])

    def at_stick_limit(self, v: Floats) -> tuple[Floats, Floats]:
        """Return eta/F and H/F^2 at v, and their derivatives with respect to ln v.

        :func:`fit_rows` fits the rows of v to it.
        v: 1/F(eta), dimensionless, > 0, shape (n,), such that w = v (1 + g/z) lies within ``rows``, which is not
            checked; eta is half the transit time of the stick zone.
        Returns (values of both functions, their derivatives), (2, n) each, dimensionless.
        """
        (shift, rise, *_), (d_shift, d_rise, *_) = self._solve(v, 0, lambda whole: whole)
        share = 1.0 / (1.0 + shift)
        press, fall = (1.0 + 2.0 * rise) * share**2, share * d_shift
        return np.stack([share, press]), np.stack([-share * fall, 2.0 * (d_rise * share**2 - press * fall)])

    def _solve(self, x: Floats, which: int, factor: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
        """Return the functions where w = x factor(1 + g/z) or w = x factor(1 + 2 h/z), by Newton's method.

        Two steps are made from an interpolated start; the error that is left is subtracted to first order from the
        values.
        x: u = kappa |V| or v = 1/F(eta), dimensionless, > 0, (n,), such that w lies within ``rows``, which is not
            checked.
        which: index into ``powers`` of the function in the equation: 0 for g/z, 1 for h/z, of which twice is taken.
        factor: function of the sum in brackets, an array of any shape, that returns an array of that shape.
        Returns (values of g/z, h/z, and M/V of half-space and cylinder; their derivatives with respect to ln x), (4, n)
        each, dimensionless.
        """
        nodes = self.rows.x.ravel()
        x_of_nodes = nodes * (1.0 / factor(1.0 + (1 + which) * self.values[which]))
        w = np.exp(np.interp(np.log(x), np.log(x_of_nodes), np.log(nodes)))
        for _ in range(_NEWTON_STEPS):
            (value,), (slope,) = self.rows.read(self.powers[[which]], w)
            whole = 1.0 + (1 + which) * value
            w += (x * factor(whole) - w) / (1.0 - slope / whole)
        values, slopes = self.rows.read(self.powers, w)
        whole = 1.0 + (1 + which) * values[which]
        dlnw_dlnx = 1.0 / (1.0 - slopes[which] / whole)
        return values + slopes * ((x * factor(whole) / w - 1.0) * dlnw_dlnx), slopes * dlnw_dlnx


def fit_rows(material: Any, rows: Rows, alpha: float, T_mean: Floats) -> Floats:
    """Fit the rows of the law of steady rolling, one polynomial for each function and octave.

    material: alpha > 1 as a float, a :class:`..prony.Prony` of one material or a :class:`..bodies.Bodies` of one pair;
        not elastic, as without modes there is nothing to fit.
    rows: octaves of u = kappa |V| and of v = 1/F(eta), as :class:`.rows.Rows`.
    alpha: instantaneous divided by long-time stiffness, a number > 1, dimensionless.
    T_mean: sums J_j T_j of half-space and cylinder, in units of T_ref, (2,): the limits of M/V at rest.
    Returns the table (rows, 24 powers, 7 functions) with NaN for N; functions as :data:`.pack.FUNCTIONS`.  In the first
    row the limits at rest are set, not fitted: lam = eta/F = H/F^2 = 1, epsilon = 0 with its slope T_mean, and M/V =
    ``T_mean``.
    """
    e0, mean = rows.e0, float(T_mean.sum())
    w = Rows(e0, rows.count + 2 + math.ceil(0.5 * math.log2(alpha)))
    by_modes = evaluate_by_modes(material, 1.0 / w.x.ravel())
    powers = w.fit_slopes(*(part.reshape(-1, *w.x.shape) for part in by_modes[:2]))
    powers[:2, 0, :2], powers[2:, 0, 0] = [0.0, math.ldexp(0.5 * mean, e0)], T_mean
    functions, x = _FunctionsOfW(w, powers, by_modes.values), rows.x.ravel()
    both = zip(functions.at_speed(x), functions.at_stick_limit(x), strict=True)
    powers = rows.fit_slopes(*(np.concatenate(parts).reshape(-1, *rows.x.shape) for parts in both))
    powers[[0, 4, 5], 0, 0], powers[1, 0, :2], powers[2:4, 0, 0] = 1.0, [0.0, math.ldexp(mean, e0)], T_mean
    return steady_table(powers)


def fit_unsteady(material: Any, table: Floats, e0: int) -> Floats:
    """Return a table with the coefficients of N in M = M(V) + N dV/dt, which the rows of steady rolling do not have.

    material: alpha > 1 as a float, a :class:`..prony.Prony` of one material or a :class:`..bodies.Bodies` of one pair;
        not elastic, and no cover.
    table: rows of its steady rolling, (rows, 24 powers, 7 functions), of which lam is read; not changed.
    e0: exponent of the end of the first row, which is [0, 2^e0).
    Returns a copy of the table with the column of N, in units of P T_ref^2; its value at rest is set to the exact
    limit.
    """
    rows, whole = Rows(e0, len(table)), table.copy()
    (lam,), _ = rows.read(table[None, :, :, FUNCTIONS.index("lam")], rows.x.ravel())
    *N, at_rest = evaluate_by_modes(material, np.append(0.5 * lam / rows.x.ravel(), np.inf)).N
    powers = rows.fit(np.reshape(N, rows.x.shape), rounding=_ROUNDING_OF_N)
    powers[0, 0] = at_rest
    whole[:, :, FUNCTIONS.index("N")] = powers
    return whole
