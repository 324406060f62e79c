"""A series or a pair for each state or motion: its bins are made where they are met, and are gone with the next.

A bin holds what the table of the whole material would (:mod:`series`), so that a motion is the same to the bit.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..numerics import quartet
from ..numerics.bins import bin_number
from .fill import fill_bin, fill_bins
from .series import unpacked


class Ends(NamedTuple):
    """Several modes: the table is full but for its ends, where g, h and m are known by these numbers.

    rise : alpha - 1 = sum E_i
    weight, log_weight : sum J_j b_j, and sum J_j b_j (ln(2/b_j) - gamma), gamma that of Euler
    squares : sum E_i tau_i^2 + sum J_j T_j^2
    """

    known: bool
    rise: float
    weight: float
    log_weight: float
    squares: float


class Body(NamedTuple):
    """What is one body's in m: sum of its J_j T_j, m as z -> infinity; and its terms in the ends of the table."""

    T_mean: float
    ends: Ends


class Filled(NamedTuple):
    """A material as ``Tabulated``, with the modes that its bins first ... stop - 1 are made from.

    modes : how many; numbers : theirs, packed (:func:`series.unpacked`), with room for an evaluation behind them
    """

    alpha: float
    T_mean: float
    tau: float
    table: Any
    ends: Ends
    first: int
    stop: int
    modes: int
    numbers: Any


class FilledPair(NamedTuple):
    """Two bodies as ``Pair``, likewise."""

    alpha: float
    T_mean: float
    tau: float
    table: Any
    ends: Ends
    first: int
    stop: int
    modes: int
    numbers: Any
    parts: Any
    half_space: Body
    cylinder: Body


#: columns of ``Each.numbers``: alpha, T_mean, tau, those of ``Ends``; of pairs also those of ``Body``, of either
ALPHA, T_MEAN, TAU, ENDS = range(4)
HALF_SPACE, CYLINDER, COLUMNS_OF_PAIRS = 7, 12, 17
COLUMNS = HALF_SPACE
#: columns of ``Each.bins``: of ``Filled``
FIRST, STOP, MODES = range(3)


class Each(NamedTuple):
    """The materials of a block.

    of : material of each state or motion, a row of all that follows
    numbers, bins : the numbers of ``Filled``
    packed : numbers of its modes
    table, held : the one table, and whose bins it holds, -1: nobody's
    work : ``numbers`` of ``Filled``
    """

    of: Any
    numbers: Any
    bins: Any
    packed: Any
    table: Any
    held: Any
    work: Any


class EachPair(NamedTuple):
    """The pairs of a block: as :class:`Each`.

    parts : the one table of the parts of m
    """

    of: Any
    numbers: Any
    bins: Any
    packed: Any
    table: Any
    held: Any
    work: Any
    parts: Any


@kernel
def _take(row, each):
    """Whether the tables held another material; then that of this row takes its place."""
    if each.held[0] == row:
        return False
    each.held[0] = row
    quartet.clear(each.table)
    for n in range(each.packed.shape[1]):
        each.work[n] = each.packed[row, n]
    return True


@kernel(inline=True, allocates=True)  # what it returns holds references to arrays
def of_each(each, i):
    """The material of state or motion i."""
    row = each.of[min(i, each.of.size - 1)]
    _take(row, each)
    numbers, bins = each.numbers[row], each.bins[row]
    return Filled(
        numbers[ALPHA], numbers[T_MEAN], numbers[TAU], each.table, _ends(numbers, ENDS),
        bins[FIRST], bins[STOP], bins[MODES], each.work,
    )  # fmt: skip


@kernel(inline=True)
def _ends(numbers, at):
    return Ends(True, numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3])


@kernel(inline=True)
def _body(numbers, at):
    return Body(numbers[at], _ends(numbers, at + 1))


@kernel(inline=True, allocates=True)
def of_each_pair(each, i):
    """The pair of state or motion i."""
    row = each.of[min(i, each.of.size - 1)]
    if _take(row, each):
        quartet.clear(each.parts)
    numbers, bins = each.numbers[row], each.bins[row]
    return FilledPair(
        numbers[ALPHA], numbers[T_MEAN], numbers[TAU], each.table, _ends(numbers, ENDS),
        bins[FIRST], bins[STOP], bins[MODES], each.work, each.parts,
        _body(numbers, HALF_SPACE), _body(numbers, CYLINDER),
    )  # fmt: skip


@kernel
def _fill(row, z, material):
    series, work = unpacked(material.numbers, material.modes)
    fill_bin(z, series, work, row, material.table)


@kernel
def _fill_pair(row, z, material):
    series, work = unpacked(material.numbers, material.modes)
    fill_bins(z, series, work, row, material.table, material.parts)


_fill_met = by_record(2, (Filled, _fill), (FilledPair, _fill_pair))


@kernel
def made(row, z, material):
    """Whether the bin of z lies between the ends; then it is in this row now."""
    number = bin_number(z, quartet.BITS)
    if number < material.first or number >= material.stop:
        return False
    _fill_met(row, z, material)
    return True
