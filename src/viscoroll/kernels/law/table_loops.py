"""The contact law over the grids of the tables: root solves at every node, nothing else.

Both loops run over pairs of the two outer axes; that of the atlas solves the contact length once a
pair; ``start`` and ``stop`` cut the flattened pairs into blocks for the threads.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import Own, moment_of, standard
from ..numerics.arrays import copy
from .contact_loop import contact_loop
from .length import OK, contact_solution, near_length
from .state import BETA, DELTA_STAR, EPSILON, LAM, UNSOLVED, M, Need, Q, States, stick

#: Rows of ``plane`` and ``volume`` of :func:`atlas_loop`, by the names of the file.
ATLAS_PLANE = ("lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu")
ATLAS_VOLUME = ("beta", "Q_over_mu")
#: Likewise of :func:`literal_loop`.
LITERAL_PLANE = ("lam", "epsilon", "M", "delta_star")
LITERAL_VOLUME = ("beta", "Q")


@kernel
def atlas_loop(alpha, kappa_V, s, plane, volume, start, stop):
    """Pairs start..stop of (alpha, kappa_V): ``plane`` (4, pairs), ``volume`` (2, pairs, s)."""
    worst = OK
    for i in range(start, stop):
        material, w = standard(alpha[i // kappa_V.size]), kappa_V[i % kappa_V.size]
        guess = near_length(w, material, 1.0 / np.sqrt(material.alpha))
        solved = contact_solution(guess, w, material)
        lam, zeta, g, h, _, status = solved
        worst = max(worst, status)
        epsilon = g / zeta
        # mu = kappa = 1 turns V into kappa V, Q into Q/mu, delta_star into kappa delta_star/mu
        delta_star = 0.5 * lam * (1.0 + epsilon)
        plane[0, i] = lam
        plane[1, i] = epsilon
        plane[2, i] = w * moment_of(zeta, lam, g, h, material)
        plane[3, i] = delta_star
        for n in range(s.size):
            if s[n] >= 1.0:
                volume[0, i, n], volume[1, i, n] = 0.0, 1.0
                continue
            _, _, beta, share, status = stick(w, s[n] * delta_star, 1.0, solved, delta_star, UNSOLVED, material)
            worst = max(worst, status)
            volume[0, i, n], volume[1, i, n] = beta, share
    return worst


@kernel(allocates=True)
def literal_loop(V, delta, alpha, kappa, mu, plane, volume, start, stop):
    """Pairs start..stop of (V, alpha): ``plane`` (4, pairs), ``volume`` (2, pairs, delta)."""
    need = Need(True, True, True, True, False)
    rows = np.array([LAM, EPSILON, M, DELTA_STAR, BETA, Q])
    kappas, mus, out = np.full(1, kappa), np.full(1, mu), np.empty((rows.size, delta.size))
    worst = OK
    for i in range(start, stop):
        v, a = i // alpha.size, i % alpha.size
        states = States(kappas, mus, V[v : v + 1], delta, False)
        status = contact_loop(Own(alpha[a : a + 1]), states, need, rows, out, 0, delta.size)
        worst = max(worst, status)
        for m in range(plane.shape[0]):
            plane[m, i] = out[m, 0]
        for m in range(volume.shape[0]):
            copy(out[plane.shape[0] + m], volume[m, i])
    return worst
