"""Roots of Eqs. (6) and (10) for many states side by side.

A root takes two or three steps of Halley's iteration, each a long chain of dependent operations.  All states of a
block take their first step, then their second, and no branch depends on how soon one arrives: the arithmetic
vectorises, and the processor works on the polynomials of several states at once.  The few that so many steps do
not bring to their root are left to the iterations of :mod:`law`, which take the same steps.
"""

from __future__ import annotations

import numpy as np

from ..bessel.ratios import K_LEAST, k_from, piece_of, place_k, place_r, r_from, slopes_of
from ..compile.jit import kernel
from ..material.standard import Standard, assemble, standard
from .length import NOT_CONVERGED, OK, at_an_end, contact_solution, length_step, near_length, small_step
from .stick import near_eta, root_bracket, root_step

#: states of a block; a block is one vector, so that the compiler sees how far apart its rows are
TOGETHER = 64
#: rows of a block: given; found for Eq. (6); y of F(eta) = y given; found for Eq. (10) where FOUND = 1; scratch
(
    ALPHA, KAPPA_V, LAM, ZETA, G, H, DG, STATUS, Y, ETA, G_ETA, H_ETA, FOUND,
    _C, _LOW, _PER_W, _Z, _A, _PER_X, _AT_R, _AT_K, _NOW_C, _NOW_Y,
) = (TOGETHER * row for row in range(23))  # fmt: skip
SIZE = 23 * TOGETHER
#: steps for eta; lam takes two
_ROUNDS = 3
#: rows of numbers of polynomials
_ROW_R, _ROW_K, PLACES = 0, TOGETHER, 2 * TOGETHER


@kernel(inline=True)
def _material(i, block):
    """The material of state i."""
    alpha = block[ALPHA + i]
    return Standard(alpha, block[_C + i], 1.0 / alpha)


@kernel
def _pieces(count, block, place):
    """Values of the polynomials of r(alpha z) and k(z) at z = _Z, alpha = _A, and 1/(alpha z)."""
    for i in range(count):
        z, alpha = block[_Z + i], block[_A + i]
        x = alpha * z
        per_x = 1.0 / x
        block[_PER_X + i] = per_x
        place[_ROW_R + i], block[_AT_R + i] = place_r(x, per_x)
        place[_ROW_K + i], block[_AT_K + i] = place_k(z, alpha * per_x)
    for i in range(count):
        block[_AT_R + i] = piece_of(place[_ROW_R + i], block[_AT_R + i])
    for i in range(count):
        block[_AT_K + i] = piece_of(place[_ROW_K + i], block[_AT_K + i])


@kernel(inline=True)
def _second_slopes(i, c, block):
    """``second_slopes`` at z = _Z, from the polynomials."""
    z, alpha, per_x = block[_Z + i], block[_A + i], block[_PER_X + i]
    per_z = alpha * per_x
    r, r_complement = r_from(block[_AT_R + i], alpha * z, block[_AT_R + i] * per_x)
    k, k_complement = k_from(block[_AT_K + i], z, block[_AT_K + i] * per_z)
    s, dk = slopes_of(r, r_complement, k, k_complement, per_x, per_z)
    return assemble(per_z, per_x, r, k, s, dk, Standard(alpha, c, 1.0 / alpha))


@kernel
def _length_steps(count, block, place):
    """The next step of those that have not arrived."""
    for i in range(count):
        block[_Z + i], block[_A + i] = block[LAM + i] * block[_PER_W + i], block[ALPHA + i]
    _pieces(count, block, place)
    for i in range(count):
        lam, z, per_w = block[LAM + i], block[_Z + i], block[_PER_W + i]
        slopes = _second_slopes(i, block[_C + i], block)
        new, zeta, g, h, dg, _, _ = length_step(lam, z, 2.0 * block[KAPPA_V + i], per_w, slopes, block[_LOW + i], 1.0)
        there = block[STATUS + i] == OK
        block[LAM + i] = lam if there else new
        block[ZETA + i] = block[ZETA + i] if there else zeta
        block[G + i] = block[G + i] if there else g
        block[H + i] = block[H + i] if there else h
        block[DG + i] = block[DG + i] if there else dg
        block[STATUS + i] = OK if there or (small_step(lam, new) and z >= K_LEAST) else NOT_CONVERGED


@kernel
def solve_lengths(count, block, place):
    """Eq. (6): from alpha and kappa |V| lam, zeta, g, h, g' and a status."""
    inside = 0
    for i in range(count):
        material, w = standard(block[ALPHA + i]), 2.0 * block[KAPPA_V + i]
        low = 1.0 / np.sqrt(material.alpha)
        block[_C + i], block[_LOW + i], block[_PER_W + i], block[STATUS + i] = (
            material.T_mean,
            low,
            1.0 / w,
            NOT_CONVERGED,
        )
        inside += 0 if at_an_end(w, low, material) else 1
    if inside:
        for i in range(count):
            block[LAM + i] = near_length(block[KAPPA_V + i], _material(i, block), block[_LOW + i])
        _length_steps(count, block, place)
        _length_steps(count, block, place)
    for i in range(count):
        material, kappa_V, low = _material(i, block), block[KAPPA_V + i], block[_LOW + i]
        if block[STATUS + i] != OK or at_an_end(2.0 * kappa_V, low, material):
            found = contact_solution(near_length(kappa_V, material, low), kappa_V, material)
            block[LAM + i], block[ZETA + i], block[G + i], block[H + i], block[DG + i], block[STATUS + i] = found


@kernel
def _root_steps(count, some, block, place):
    """The next step of the states ``some``, which then lists those that have not arrived; returns how many."""
    for n in range(count):
        i = some[n]
        block[_Z + n], block[_A + n], block[_NOW_C + n], block[_NOW_Y + n] = (
            block[ETA + i], block[ALPHA + i], block[_C + i], block[Y + i],
        )  # fmt: skip
    _pieces(count, block, place)
    for n in range(count):
        z, y, c = block[_Z + n], block[_NOW_Y + n], block[_NOW_C + n]
        low, high = root_bracket(y, Standard(block[_A + n], c, 1.0 / block[_A + n]))
        new, g, h, _, _ = root_step(z, y, _second_slopes(n, c, block), low, high)
        block[_AT_R + n], block[_AT_K + n], block[_PER_X + n] = new, g, h
        block[_Z + n] = 1.0 if small_step(z, new) and z >= K_LEAST else 0.0
    left = 0
    for n in range(count):
        i = some[n]
        block[ETA + i], block[G_ETA + i], block[H_ETA + i] = block[_AT_R + n], block[_AT_K + n], block[_PER_X + n]
        block[FOUND + i] = block[_Z + n]
        some[left] = i
        left += 0 if block[_Z + n] == 1.0 else 1
    return left


@kernel
def solve_roots(count, some, block, place):
    """Eq. (10): from y > 0, and what ``solve_lengths`` has found, eta with g and h there where FOUND = 1."""
    for n in range(count):
        i = some[n]
        block[ETA + i] = near_eta(block[Y + i], block[ZETA + i], block[G + i], block[DG + i])
    for _ in range(_ROUNDS):
        count = _root_steps(count, some, block, place)
