"""Two bodies that deform unlike each other: what is theirs in m, beside the functions of the pair.

The contact sees the sum of both compliances, one series, so g, h, m and b are those of a material of several modes
(:mod:`tabulated`).  Eq. (22) asks for more: how much of M is spent in either body (:func:`series.shares`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.jit import kernel
from ..compile.rarely import rarely
from ..numerics import quartet
from ..numerics.bins import offset_slope
from .each import Body, Ends
from .tabulated import at_an_end, beyond, make, moment_at_an_end


class Pair(NamedTuple):
    """As :class:`tabulated.Tabulated`, and m of the half-space and of the cylinder in a table of the same bins.

    Where each motion has a pair of its own: :class:`each.FilledPair`.
    """

    alpha: float
    T_mean: float
    tau: float
    table: Any
    ends: Ends
    parts: Any
    half_space: Body
    cylinder: Body


@kernel(inline=True)
def parts(z, material):
    """(m of the half-space, m of the cylinder, their slopes) at z > 0."""
    row, there = quartet.row_of(z, material.parts)
    if rarely(not there):
        if beyond(z, material):
            return _parts_at_an_end(z, material)
        row = make(row, z, material)
    half_space, cylinder, _, _, d_half_space, d_cylinder, _, _ = quartet.slopes(material.parts, row, quartet.offset(z))
    per = offset_slope(z)
    return half_space, cylinder, d_half_space * per, d_cylinder * per


@kernel(inline=True)
def _parts_at_an_end(z, material):
    """``parts`` where the table ends."""
    one, other = material.half_space, material.cylinder
    half_space, d_half_space = moment_at_an_end(z, one.T_mean, one.ends, material)
    cylinder, d_cylinder = moment_at_an_end(z, other.T_mean, other.ends, material)
    return half_space, cylinder, d_half_space, d_cylinder


@kernel(inline=True)
def at_rolling(z, material):
    """(g, h, g', h', m of the half-space, m of the cylinder) at z > 0."""
    row, there = quartet.row_of(z, material.table)
    if rarely(not there):
        if beyond(z, material):
            g, h, dg, dh = at_an_end(z, material)
            half_space, cylinder, _, _ = _parts_at_an_end(z, material)
            return g, h, dg, dh, half_space, cylinder
        row = make(row, z, material)
    at, per = quartet.offset(z), offset_slope(z)
    g, h, _, _, dg, dh, _, _ = quartet.slopes(material.table, row, at)
    half_space, cylinder, _, _ = quartet.values(material.parts, row, at)
    return g, h, dg * per, dh * per, half_space, cylinder
