"""A material by polynomials in z: g, h and m, and their slopes, whatever they cost to compute.

A bin is a quarter of an octave of z; in it each function is a polynomial of degree 11.  Bins are made
where they are met, and kept in a table by the last bits of their numbers: any z is served.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..numerics import quarters
from . import standard
from .standard import Standard

#: bins kept: 64 octaves
KEPT = 256


class Tabulated(NamedTuple):
    """alpha and c as of :class:`Standard`; numbers of the bins that are kept, and their polynomials."""

    alpha: float
    c: float
    numbers: np.ndarray
    pieces: np.ndarray


def tabulated(alpha):
    return Tabulated(alpha, (alpha-1)/alpha, np.full(KEPT, -1), np.empty((KEPT, quarters.COEFFICIENTS, 4)))


@kernel
def fill(number, slot, material):
    """Make a bin."""
    solid, pieces = Standard(material.alpha, material.c), material.pieces
    for n in range(quarters.COEFFICIENTS):
        z = quarters.node(number, n)
        g, h = standard.generators(z, solid)
        lam = 1.0 / np.sqrt(1.0 + 2.0 * h / z)
        pieces[slot, n, 0], pieces[slot, n, 1], pieces[slot, n, 3] = g, h, 0.0
        pieces[slot, n, 2] = standard.moment_of(z, lam, g, h, solid)
    quarters.fit(pieces, slot)
    material.numbers[slot] = number


@kernel(inline=True)
def place(z, material):
    number = quarters.bin_number(z)
    slot = number & (KEPT - 1)
    if material.numbers[slot] != number:
        fill(number, slot, material)
    return slot


@kernel(inline=True)
def generators(z, material):
    if z <= 0.0:
        return 0.0, 0.0
    g, h, _, _ = quarters.values(material.pieces, place(z, material), quarters.bin_offset(z))
    return g, h


@kernel(inline=True)
def generator_slopes(z, material):
    if z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    g, h, _, _, dg, dh, _, _ = quarters.slopes(material.pieces, place(z, material), quarters.bin_offset(z))
    per = quarters.scale(z)
    return g, h, dg * per, dh * per


@kernel(inline=True)
def second_slopes(z, material):
    if z <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    g, h, dg, dh, ddg, ddh, _, _ = at_contact(z, material)
    return g, h, dg, dh, ddg, ddh


@kernel(inline=True)
def at_contact(z, material):
    g, h, m, _, dg, dh, dm, _, ddg, ddh, _, _ = quarters.second_slopes(material.pieces, place(z, material), quarters.bin_offset(z))
    per = quarters.scale(z)
    per2 = per*per
    return g, h, dg * per, dh * per, ddg * per2, ddh * per2, m, dm * per


@kernel(inline=True)
def at_slide(z, material):
    g, h, m, _, dg, dh, _, _ = quarters.slopes(material.pieces, place(z, material), quarters.bin_offset(z))
    return g, h, dh * quarters.scale(z), m


@kernel(inline=True)
def moment_of(zeta, lam, g, h, material):
    _, _, m, _ = quarters.values(material.pieces, place(zeta, material), quarters.bin_offset(zeta))
    return m
