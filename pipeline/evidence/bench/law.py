"""The contact law alone: time a state, and the error against 50 digits."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.bessel.ratios import (
    K_LEAST,
    i2_from,
    k_from,
    piece_of,
    place_i2,
    place_k,
    place_r,
    r_from,
    ratio_i2,
    ratio_k,
    ratio_r,
)

from ..peers.reduction import slip_differences
from ..peers.standard import generators, standard
from ..timing import nanoseconds, rounds
from ..truth import contact_precise
from .jit import compiled

FIELDS = ("Q", "M")
#: states of a block, and the rows of what a block holds
_TOGETHER = 64
_Z, _ETA, _C, _X, _Y, _PER_Z, _PER_X, _PER_ETA, _PER_Y, _PIECES = (_TOGETHER * row for row in range(10))
_SIZE, _Q, _M = _PIECES + 5 * _TOGETHER, _PIECES, _PIECES + _TOGETHER
#: below this (zeta - eta)/min(zeta, 1) ``slip_differences`` integrates slopes
_SLIGHT = 1e-3


@compiled
def explicit_state(zeta, eta, alpha, kappa, mu):
    """(V, delta, Q, M), explicit in (zeta, eta): no equation is solved, four Bessel ratios and i2."""
    c = (alpha - 1.0) / alpha
    x = alpha * zeta
    r, _ = ratio_r(x)
    k, _ = ratio_k(zeta)
    p = r * k
    share = c / (1.0 + p)
    g, h = share * p, share * r
    g_eta, h_eta = generators(eta, standard(alpha))
    rise_F, rise_H = slip_differences(zeta, zeta - eta, g, h, g_eta, h_eta, standard(alpha))
    lam2 = 1.0 / (1.0 + 2.0 * h / zeta)
    V = np.sqrt(lam2) / (2.0 * kappa * zeta)
    return V, mu * V * rise_F, mu * rise_H * lam2 / zeta, V * share * (lam2 * ratio_i2(x, r) + p)


@compiled
def _place(count, zeta, eta, alpha, first, block, place):
    """Where the five polynomials of each state are, and their arguments."""
    for i in range(count):
        z, e, a = zeta[first + i], eta[first + i], alpha[first + i]
        per_a, per_z, per_e = 1.0 / a, 1.0 / z, 1.0 / e
        x, per_x, y, per_y = a * z, per_a * per_z, a * e, per_a * per_e
        block[_Z + i], block[_ETA + i], block[_C + i] = z, e, (a - 1.0) * per_a
        block[_X + i], block[_Y + i] = x, y
        block[_PER_Z + i], block[_PER_X + i], block[_PER_ETA + i], block[_PER_Y + i] = per_z, per_x, per_e, per_y
        place[i], block[_PIECES + i] = place_r(x, per_x)
        place[_TOGETHER + i], block[_PIECES + _TOGETHER + i] = place_k(z, per_z)
        place[2 * _TOGETHER + i], block[_PIECES + 2 * _TOGETHER + i] = place_i2(x)
        place[3 * _TOGETHER + i], block[_PIECES + 3 * _TOGETHER + i] = place_r(y, per_y)
        place[4 * _TOGETHER + i], block[_PIECES + 4 * _TOGETHER + i] = place_k(e, per_e)


@compiled
def _assemble(count, block, kappa, mu):
    """Q and M from the values of the polynomials, in place of the first two."""
    per_kappa = 0.5 / kappa
    for i in range(count):
        z, e, c, x, y = block[_Z + i], block[_ETA + i], block[_C + i], block[_X + i], block[_Y + i]
        per_z, per_x, per_y = block[_PER_Z + i], block[_PER_X + i], block[_PER_Y + i]
        at_r, at_k, at_i2 = block[_PIECES + i], block[_PIECES + _TOGETHER + i], block[_PIECES + 2 * _TOGETHER + i]
        at_r_eta, at_k_eta = block[_PIECES + 3 * _TOGETHER + i], block[_PIECES + 4 * _TOGETHER + i]
        r, _ = r_from(at_r, x, at_r * per_x)
        k, _ = k_from(at_k, z, at_k * per_z)
        i2 = i2_from(at_i2, x, r)
        r_eta, _ = r_from(at_r_eta, y, at_r_eta * per_y)
        k_eta, _ = k_from(at_k_eta, e, at_k_eta * block[_PER_ETA + i])
        p, p_eta = r * k, r_eta * k_eta
        both = c / ((1.0 + p) * (1.0 + p_eta))
        share, h_eta = both * (1.0 + p_eta), both * (1.0 + p) * r_eta
        h, ratio = share * r, e * per_z
        lam2 = 1.0 / (1.0 + 2.0 * h * per_z)
        rise_H = (1.0 + ratio) * (z - e) + 2.0 * (h - ratio * h_eta)
        block[_Q + i] = mu * rise_H * lam2 * per_z
        block[_M + i] = np.sqrt(lam2) * per_z * per_kappa * share * (lam2 * i2 + p)


@compiled
def explicit_batch(zeta, eta, alpha, kappa, mu, Q, M):
    """Independent states in blocks: where polynomials are, their values, and what follows, each for all of a block.

    The first and the last then vectorise.  States with little slip or hardly any stick zone go one by one.
    """
    block, place = np.empty(_SIZE), np.empty(5 * _TOGETHER, np.int64)
    for first in range(0, zeta.size, _TOGETHER):
        count = min(zeta.size - first, _TOGETHER)
        _place(count, zeta, eta, alpha, first, block, place)
        for n in range(5):
            for i in range(n * _TOGETHER, n * _TOGETHER + count):
                block[_PIECES + i] = piece_of(place[i], block[_PIECES + i])
        _assemble(count, block, kappa, mu)
        Q[first : first + count], M[first : first + count] = block[_Q : _Q + count], block[_M : _M + count]
        for i in range(first, first + count):
            if zeta[i] - eta[i] < _SLIGHT * min(zeta[i], 1.0) or eta[i] < K_LEAST:
                _, _, Q[i], M[i] = explicit_state(zeta[i], eta[i], alpha[i], kappa, mu)


@compiled
def explicit_chain(zeta, eta, alpha, kappa, mu, Q, M):
    """Each state waits for the one before, as in an integrator."""
    wait = 0.0
    for i in range(zeta.size):
        _, _, Q[i], M[i] = explicit_state(zeta[i] + wait, eta[i] + wait, alpha[i], kappa, mu)
        wait = 1e-300 * (Q[i] + M[i])


def law(sizes: dict[str, Any]) -> dict[str, Any]:
    """ns a state for each way to ask for Q and M, on one core, and the largest error."""
    rng = np.random.default_rng(sizes["seed"])
    n = sizes["states"]
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    alpha = np.exp(rng.uniform(np.log(1.1), np.log(100.0), n))
    each = scene.replace(alpha=alpha)
    V, s = np.exp(rng.uniform(np.log(1e-3), np.log(2.0), n)), rng.uniform(0.0, 1.0, n)
    star = s * vr.contact(each, V, delta=0.0, fields="delta_star").delta_star
    calls, states, few = {}, {}, slice(0, max(n // sizes["direct_share"], 1))
    for name, which, method in (
        ("one_alpha", scene, "table"), ("an_alpha_each", each, "table"), ("alpha_1", scene.replace(alpha=1.0), "table"),
        ("direct_one_alpha", scene, "direct"), ("direct_an_alpha_each", each, "direct"),
    ):  # fmt: skip
        part = few if method == "direct" else slice(None)
        own = which if which.shape == () else which.replace(alpha=alpha[part])
        delta = s[part] * vr.contact(own, V[part], delta=0.0, fields="delta_star").delta_star
        given = {"V": V[part], "delta": delta, "fields": FIELDS, "method": method}
        calls[name] = lambda own=own, given=given: vr.contact(own, **given).as_dict()
        states[name] = np.broadcast_arrays(own.alpha, scene.kappa, scene.mu, V[part], delta)
    state = vr.contact(each, V, delta=star, fields=("zeta", "beta"))
    zeta, eta, found = state.zeta, state.beta * state.zeta, dict(zip(FIELDS, np.empty((2, n))))
    exact = [explicit_state(*one, scene.kappa, scene.mu)[:2] for one in zip(zeta, eta, alpha)]
    for name, kernel in (("explicit_batched", explicit_batch), ("explicit_scalar", explicit_chain)):
        calls[name] = lambda kernel=kernel: kernel(zeta, eta, alpha, scene.kappa, scene.mu, *found.values()) or found
        states[name] = np.broadcast_arrays(alpha, scene.kappa, scene.mu, *np.transpose(exact))
    # at the first states; an explicit kernel is held against the law at the (V, delta) that it stands for
    errors = {name: _errors(zip(*states[name]), call(), sizes["exact_states"]) for name, call in calls.items()}
    seconds = rounds(calls, sizes["repeats"])
    return {name: nanoseconds(seconds[name], states[name][0].size) | {"error": errors[name]} for name in calls}


def _errors(states: Iterable[tuple[Any, ...]], tried: dict[str, NDArray], count: int) -> dict[str, float]:
    """Largest relative error of what was tried at the first states (alpha, kappa, mu, V, delta), against 50 digits."""
    worst = dict.fromkeys(tried, 0.0)
    for i, state in enumerate(islice(states, count)):
        exact = contact_precise(*map(float, state), 50)
        for name, values in tried.items():
            off = abs(float(values[i]) - exact[name])
            worst[name] = max(worst[name], float(off / abs(exact[name]) if exact[name] else off))
    return worst
