"""Bins of a series: its functions at the nodes, four at a time, and their polynomials."""

from __future__ import annotations

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..numerics import quartet
from ..numerics.bins import bin_place
from ..numerics.four import LANES
from .series import AT_G, AT_HALF_SPACE, AT_ZEROS, Parts, Series, room, shares, values


@kernel(inline=True)
def _nodes(z, first):
    """Four nodes of the bin of z; beyond the last, that once more."""
    last = quartet.TERMS - 1
    return (
        quartet.node(z, min(first, last)), quartet.node(z, min(first + 1, last)),
        quartet.node(z, min(first + 2, last)), quartet.node(z, min(first + 3, last)),
    )  # fmt: skip


@kernel(inline=True)
def _put(row, first, start, work, table):
    """Four functions at four nodes into a row; ``start``: of the first in ``found``."""
    found = work.found
    for n in range(min(LANES, quartet.TERMS - first)):
        a, b, c, d = start + n, start + n + LANES, start + n + 2 * LANES, start + n + 3 * LANES
        quartet.put(table, row, first + n, found[a], found[b], found[c], found[d])


@kernel
def fill_bin(z, series, work, row, table):
    """Make the bin of z of g, h, m and b."""
    for first in range(0, quartet.TERMS, LANES):
        values(_nodes(z, first), True, series, work)
        _put(row, first, AT_G, work, table)
    quartet.finish(table, row, z)


@kernel(inline=True)
def _take_apart(z, first, parts, work):
    """At four nodes g, h and m, what two bodies have in m, and two zeros."""
    places = _nodes(z, first)
    values(places, False, parts, work)
    shares(places, parts, work)
    work.found[AT_ZEROS:] = 0.0


@kernel
def fill_bin_of_parts(z, parts, work, row, table):
    """Make the bin of z of what two bodies have in m, and of two zeros."""
    for first in range(0, quartet.TERMS, LANES):
        _take_apart(z, first, parts, work)
        _put(row, first, AT_HALF_SPACE, work, table)
    quartet.finish(table, row, z)


@kernel
def fill_bins(z, parts, work, row, table, table_of_parts):
    """Both, without b, which motions of bodies that differ do not ask for."""
    for first in range(0, quartet.TERMS, LANES):
        _take_apart(z, first, parts, work)
        _put(row, first, AT_G, work, table)
        _put(row, first, AT_HALF_SPACE, work, table_of_parts)
    quartet.finish(table, row, z)
    quartet.finish(table_of_parts, row, z)


#: of a material, or of the parts that two bodies have in it
_fill = by_record(1, (Series, fill_bin), (Parts, fill_bin_of_parts))


@kernel(allocates=True)
def fill(series, first, stop, table):
    """Make the bins first..stop of z, of a material, or of the parts that two bodies have in it."""
    work = room(series)
    for number in range(first, stop):
        middle = bin_place(number, quartet.BITS, 0.5)
        row, _ = quartet.row_of(middle, table)
        _fill(middle, series, work, row, table)
