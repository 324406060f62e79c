"""A series for each state or motion: its bins are made where they are met, and are gone with the next material.

A bin holds what the table of the whole material would (:mod:`series`), so that a motion is the same to the bit.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..numerics import quartet
from ..numerics.bins import bin_number
from .series import Room, Series, values


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


class Filled(NamedTuple):
    """A material as ``Tabulated``, with the modes that its bins first ... stop - 1 are made from."""

    alpha: float
    T_mean: float
    tau: float
    table: Any
    ends: Ends
    first: int
    stop: int
    series: Series
    work: Room


class Each(NamedTuple):
    """The materials of a block.

    of : material of each state or motion, a row of all that follows
    numbers : alpha, T_mean, tau, and rise, weight, log_weight and squares of ``Ends``
    bins : first and stop of ``Filled``
    count : modes; the arrays of ``series`` have room for the most
    series : arrays of ``Series`` with a leading axis
    table, held : the one table, and whose bins it holds, -1: nobody's
    work : room of an evaluation
    """

    of: Any
    numbers: Any
    bins: Any
    count: Any
    series: Series
    table: Any
    held: Any
    work: Room


@kernel
def _take(row, each):
    """Empty the table of another material's bins."""
    if each.held[0] != row:
        for n in range(each.table.shape[0]):
            each.table[n, 0] = np.nan
        each.held[0] = row


@kernel(inline=True, allocates=True)  # what it returns holds references to arrays
def of_each(each, i):
    """The material of state or motion i."""
    row = each.of[min(i, each.of.size - 1)]
    _take(row, each)
    n, all_of, numbers = each.count[row], each.series, each.numbers[row]
    one = Series(
        all_of.a[row][:n], all_of.b[row][:n], all_of.e[row][:n], all_of.t[row][:n], all_of.Q[row][:n],
    )  # fmt: skip
    return Filled(
        numbers[0], numbers[1], numbers[2], each.table, Ends(True, numbers[3], numbers[4], numbers[5], numbers[6]),
        each.bins[row, 0], each.bins[row, 1], one, each.work,
    )  # fmt: skip


@kernel
def made(row, z, material):
    """Whether the bin of z lies between the ends; then it is in this row now."""
    number = bin_number(z, quartet.BITS)
    if number < material.first or number >= material.stop:
        return False
    for n in range(quartet.TERMS):
        g, h, m, b = values(quartet.node(z, n), material.series, material.work)
        quartet.put(material.table, row, n, g, h, m, b)
    quartet.finish(material.table, row, z)
    return True
