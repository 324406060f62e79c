"""A material by polynomials of z, whatever its functions cost.

The bins of one relaxation time are made where they are met; those of several are there (:mod:`series`), or, where each
motion has a material of its own, made where they are met too (:mod:`each`)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..compile.rarely import rarely
from ..numerics import quartet
from ..numerics.bins import bin_number, offset_slope
from . import standard
from .each import Ends, Filled, FilledPair, made
from .standard import GAUSS_W, GAUSS_X, Standard


class Tabulated(NamedTuple):
    """Numbers as of :class:`Standard`; g, h, m and b of z in a table (:mod:`quartet`)."""

    alpha: float
    T_mean: float
    tau: float
    table: Any
    ends: Ends


def tabulated(alpha: float) -> Tabulated:
    """The material of this alpha, with nothing in its table."""
    return Tabulated(*standard.standard(alpha), quartet.empty_table(), Ends(False, 0.0, 0.0, 0.0, 0.0))


@kernel(inline=True)
def moment_at_an_end(z, T_mean, ends, material):
    """(m, m') where the table of several modes ends, of the whole material or of one body."""
    if z < material.tau:
        half = 0.5 * material.alpha * z * z
        bracket = ends.log_weight - ends.weight * np.log(z)
        return half * (bracket + 0.25 * ends.weight), material.alpha * z * (bracket - 0.25 * ends.weight)
    fall = 4.0 * ends.squares * (0.125 / z)
    return T_mean - fall, fall / z


@kernel(inline=True)
def moment_over_z(z, ends, material):
    """m/z of the whole material, or of one body, at z < tau so small that its square may underflow."""
    return 0.5 * material.alpha * z * (ends.log_weight - ends.weight * np.log(z) + 0.25 * ends.weight)


@kernel(inline=True)
def fast_limit(z, h, material):
    """(g/z, m/z) at a z that is so small that its square may underflow."""
    ends = material.ends
    if not ends.known:
        return standard.fast_limit(z, h, material)
    g = 0.5 * material.alpha * z * (ends.log_weight - ends.weight * np.log(z))
    return g, moment_over_z(z, ends, material)


@kernel
def at_an_end(z, material):
    """(g, h, g', h') where the table of several modes ends: to rounding, the first terms for z -> 0 and infinity."""
    T, ends = material.T_mean, material.ends
    if z < material.tau:
        rise = material.alpha * z
        bracket, dh = ends.log_weight - ends.weight * np.log(z), 0.5 * ends.rise
        return 0.5 * rise * z * bracket, dh * z, rise * (bracket - 0.5 * ends.weight), dh
    per = 0.125 / z
    return 0.5 * T - ends.squares * per, 0.5 * T + T * T * per, ends.squares * per / z, -T * T * per / z


@kernel
def _values(z, material):
    """(g, h, m, b) at z."""
    if material.ends.known:
        g, h, _, dh = at_an_end(z, material)
        m, _ = moment_at_an_end(z, material.T_mean, material.ends, material)
        return g, h, m, m * np.sqrt(1.0 + 2.0 * h / z) / (1.0 + h / z + dh)
    g, h, _, _, m, _, b, _ = standard.at_contact(z, Standard(material.alpha, material.T_mean, material.tau))
    return g, h, m, b


@kernel
def make_own(row, z, material):
    """Make the bin of z; returns its row."""
    if material.ends.known:  # the rows are those of the bins between the ends
        row = quartet.spare_row(material.table)
    for n in range(quartet.TERMS):
        g, h, m, b = _values(quartet.node(z, n), material)
        quartet.put(material.table, row, n, g, h, m, b)
    quartet.finish(material.table, row, z)
    return row


@kernel
def _make_met(row, z, material):
    """As the last, of a material that is one of many."""
    return row if made(row, z, material) else make_own(row, z, material)


#: (row, z, material) -> row of the bin of z, made now
make = by_record(2, (Filled, _make_met), (FilledPair, _make_met), otherwise=make_own)


@kernel(inline=True)
def _beyond_full(z, material):
    """Whether a bin that is not there lies beyond the ends."""
    return material.ends.known


@kernel(inline=True)
def _beyond_met(z, material):
    """As the last, of a material whose bins are made where they are met."""
    number = bin_number(z, quartet.BITS)
    return number < material.first or number >= material.stop


#: (z, material) -> whether z lies where the table ends
beyond = by_record(1, (Filled, _beyond_met), (FilledPair, _beyond_met), otherwise=_beyond_full)


@kernel(inline=True)
def _row(z, material):
    """Row of the bin of z, which is made if it is not there."""
    row, there = quartet.row_of(z, material.table)
    if rarely(not there):
        row = make(row, z, material)
    return row


@kernel(inline=True)
def generators(z, material):
    """(g, h) at z; 0 for z <= 0 (no stick zone)."""
    if z <= 0.0:
        return 0.0, 0.0
    g, h, _, _ = quartet.values(material.table, _row(z, material), quartet.offset(z))
    return g, h


@kernel(inline=True)
def generator_slopes(z, material):
    """(g, h, g', h') at z, all 0 for z <= 0."""
    if z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    g, h, _, _, dg, dh, _, _ = quartet.slopes(material.table, _row(z, material), quartet.offset(z))
    per = offset_slope(z)
    return g, h, dg * per, dh * per


@kernel(inline=True)
def second_slopes(z, material):
    """(g, h, g', h', g'', h'') at z, all 0 for z <= 0."""
    if z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    found = quartet.second_slopes(material.table, _row(z, material), quartet.offset(z))
    g, h, _, _, dg, dh, _, _, ddg, ddh, _, _ = found
    per = offset_slope(z)
    return g, h, dg * per, dh * per, (ddg * per) * per, (ddh * per) * per


@kernel(inline=True)
def at_contact(z, material):
    """(g, h, g', h', m, m', b, b') at z = zeta."""
    g, h, m, b, dg, dh, dm, db = quartet.slopes(material.table, _row(z, material), quartet.offset(z))
    per = offset_slope(z)
    return g, h, dg * per, dh * per, m, dm * per, b, db * per


@kernel(inline=True)
def at_slide(z, material):
    """(g, h, h', m) at z."""
    g, h, m, _, _, dh, _, _ = quartet.slopes(material.table, _row(z, material), quartet.offset(z))
    return g, h, dh * offset_slope(z), m


@kernel(inline=True)
def at_rolling(z, material):
    """(g, h, g', h', m of the half-space, m of the cylinder) at z."""
    row, there = quartet.row_of(z, material.table)
    if rarely(not there):
        if beyond(z, material):
            g, h, dg, dh = at_an_end(z, material)
            m, _ = moment_at_an_end(z, material.T_mean, material.ends, material)
            return g, h, dg, dh, 0.5 * m, 0.5 * m
        row = make(row, z, material)
    g, h, m, _, dg, dh, _, _ = quartet.slopes(material.table, row, quartet.offset(z))
    per = offset_slope(z)
    return g, h, dg * per, dh * per, 0.5 * m, 0.5 * m


@kernel(inline=True)
def moment_of(zeta, lam, g, h, material):
    """m at zeta."""
    return quartet.values(material.table, _row(zeta, material), quartet.offset(zeta))[2]


@kernel
def _gauss_slopes(zeta, D, material):
    """``mean_slopes`` where the ends lie in two bins."""
    slope_g = slope_zh = 0.0
    for n in range(GAUSS_X.size):
        z = zeta - D * GAUSS_X[n]
        _, h, dg, dh = generator_slopes(z, material)
        slope_g += GAUSS_W[n] * dg
        slope_zh += GAUSS_W[n] * (h + z * dh)
    return slope_g, slope_zh


@kernel
def mean_slopes(zeta, D, material):
    """Means of g' and of (z h)' over [zeta - D, zeta]."""
    eta = zeta - D
    if quartet.same_bin(zeta, eta):
        dg, dh, _, _ = quartet.secants(material.table, _row(zeta, material), quartet.offset(zeta), quartet.offset(eta))
        per = offset_slope(zeta)
        return dg * per, generators(zeta, material)[1] + eta * (dh * per)
    return _gauss_slopes(zeta, D, material)
