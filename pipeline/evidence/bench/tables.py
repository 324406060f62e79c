"""Error against size and look-up time: tables of one-dimensional ratios, and the atlas over three dimensions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.bessel.ratios import TABLE, ratio_i2, ratio_k, ratio_r

from ..timing import alternating
from .baseline import atlas_law, atlas_of
from .jit import compiled
from .law import explicit_batch
from .splines import at_1, basis, scratch, spline

#: ends of ln x of the ratio splines
_ENDS = (np.log(1e-6), np.log(1e8))


@compiled
def _smooth(name, x):
    """Factor that turns r, k, i2 (name 0, 1, 2) into something that goes from 1 to 1 smoothly in ln x."""
    if name == 0:
        return (2.0 + x) / x
    if name == 1:
        return (1.0 + 1.0 / x) / (1.0 + np.log(1.0 + 1.0 / x))
    return (8.0 + x * x) / (x * x)


@compiled
def _ratio(name, x, knots, coefficients, w):
    first = basis(knots, np.log(x), w)
    return at_1(first, w, coefficients[name]) / _smooth(name, x)


@compiled
def _spline_states(zeta, eta, alpha, knots, coefficients, w, Q, M):
    """Q/mu and kappa M, explicit in (zeta, eta), with cubic splines of the three ratios."""
    for i in range(zeta.size):
        z, e, a = zeta[i], eta[i], alpha[i]
        c = (a - 1.0) / a
        r, k = _ratio(0, a * z, knots, coefficients, w[0]), _ratio(1, z, knots, coefficients, w[0])
        r_eta, k_eta = _ratio(0, a * e, knots, coefficients, w[0]), _ratio(1, e, knots, coefficients, w[0])
        i2 = _ratio(2, a * z, knots, coefficients, w[0])
        H = z * z + 2.0 * z * c * r / (1.0 + r * k)
        H_eta = e * e + 2.0 * e * c * r_eta / (1.0 + r_eta * k_eta)
        lam2 = z * z / H
        Q[i] = 1.0 - H_eta / H
        M[i] = np.sqrt(lam2) / (2.0 * z) * c * (lam2 * i2 + r * k) / (1.0 + r * k)


@compiled
def _atlas_states(kappa_V, delta, alpha, atlas, w, Q, M):
    """The same from the atlas: mu = kappa = 1 turns V into kappa V, M into kappa M."""
    for i in range(alpha.size):
        Q[i], M[i], _ = atlas_law(alpha[i], 1.0, 1.0, kappa_V[i], delta[i], atlas, w)


@compiled
def _ratio_values(x, out):
    for i in range(x.size):
        r, _ = ratio_r(x[i])
        k, _ = ratio_k(x[i])
        i2 = ratio_i2(x[i], r)
        out[0, i], out[1, i], out[2, i] = r * _smooth(0, x[i]), k * _smooth(1, x[i]), i2 * _smooth(2, x[i])


def ratio_splines(nodes: int) -> tuple[NDArray, NDArray]:
    """Knots over ln x and coefficients of the three ratios."""
    axis = np.linspace(*_ENDS, nodes)
    values = np.empty((3, nodes))
    _ratio_values(np.exp(axis), values)
    fits = [spline(row, [axis]) for row in values]
    return fits[0][0][0], np.stack([coefficients for _, coefficients in fits])


def tables(sizes: dict[str, Any]) -> dict[str, Any]:
    """Rows of kind, nodes, bytes, ns a look-up of (Q, M), errors of Q/mu and kappa M at random states.

    One-dimensional tables serve every alpha and kappa V; an atlas only its own range, in which the states lie.
    """
    rng = np.random.default_rng(sizes["seed"])
    n = sizes["states"]
    alpha, kappa_V = (np.exp(rng.uniform(*np.log(sizes[name]), n)) for name in ("alpha", "kappa_V"))
    unit = vr.Scene(alpha=alpha, kappa=1.0, mu=1.0)
    delta = rng.uniform(0.0, 1.0, n) * vr.contact(unit, kappa_V, delta=0.0, fields="delta_star").delta_star
    exact = vr.contact(unit, kappa_V, delta=delta, fields=("Q", "M", "zeta", "beta"))
    zeta, eta, Q, M = exact.zeta, exact.beta * exact.zeta, np.empty(n), np.empty(n)
    w = scratch()
    calls = {("shipped ratios", TABLE.size): lambda: explicit_batch(zeta, eta, alpha, 1.0, 1.0, Q, M)}
    size_of = {("shipped ratios", TABLE.size): TABLE.nbytes}
    for nodes in sizes["ratio_nodes"]:
        fit = ratio_splines(nodes)
        calls["1-D ratio splines", nodes] = lambda fit=fit: _spline_states(zeta, eta, alpha, *fit, w, Q, M)
        size_of["1-D ratio splines", nodes] = fit[1].nbytes
    for nodes in sizes["atlas_nodes"]:
        atlas, key = atlas_of(nodes, sizes["alpha"], sizes["kappa_V"]), ("3-D atlas", "x".join(map(str, nodes)))
        calls[key] = lambda atlas=atlas: _atlas_states(kappa_V, delta, alpha, atlas, w, Q, M)
        size_of[key] = atlas.share.nbytes + atlas.kappa_M.nbytes + atlas.limit.nbytes
    found = {}
    for key, call in calls.items():
        call()
        found[key] = {"Q_over_mu": float(np.max(np.abs(Q - exact.Q))), "kappa_M": float(np.max(np.abs(M - exact.M)))}
    seconds = alternating(calls, sizes["repeats"])
    rows = [
        {"kind": key[0], "nodes": key[1], "bytes": size_of[key], "ns": 1e9 * seconds[key] / n, "error": found[key]}
        for key in calls
    ]
    return {"states": n, "rows": rows}
