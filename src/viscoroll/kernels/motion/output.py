"""Output of a motion: dense output within steps, the closed form of the last decay, rest."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..numerics.arrays import copy
from .events import EXPLICIT, interpolant, speeds
from .explicit import explicit_step
from .stepper import PARTIAL, REST, dense

#: rows of the output: V, omega, x, angle, delta, regime
OUTPUTS = 6


@kernel
def put(out, column, direction, regime, V, omega, delta, X, angle, gamma):
    """One output column, back in the frame and units of the caller."""
    out[0, column], out[1, column] = direction * V, direction * omega
    out[2, column], out[3, column] = X / gamma, angle / gamma
    out[4, column], out[5, column] = delta, regime


@kernel(allocates=True)
def write_outputs(tau_out, at, tau, h, last, method, direction, old, new, slope, K, terms, scene, gamma, offset, out):
    """Outputs that fall within the step in partial slip (or, if ``last``, on its end); returns the next column.

    In the boundary layer steps are long beside its time: there each output is a step of its own.
    """
    if at >= tau_out.size or not (last or tau_out[at] < tau + h):
        return at
    stepped = method == EXPLICIT
    point, error = np.empty(4), np.empty(4)
    if h > 0.0 and not stepped:
        interpolant(method, old, new, h, scene, K, terms)
    while at < tau_out.size and (last or tau_out[at] < tau + h):
        theta = min((tau_out[at] - tau) / h, 1.0) if h > 0.0 else 1.0
        if theta == 1.0:
            copy(new, point)
        elif stepped:
            copy(slope, K[0])
            explicit_step(old, theta * h, scene, K, point, error)
        else:
            for m in range(4):
                point[m] = dense(theta, old, new, terms, m)
        V, omega, delta = speeds(PARTIAL, point[0], point[1], scene)
        put(out, at, direction, PARTIAL, V, omega, delta,
            offset[0] + direction * point[2], offset[1] + direction * point[3], gamma)  # fmt: skip
        at += 1
    return at


@kernel
def coast(tau_out, at, tau, u, direction, scene, gamma, offset, rest, out):
    """Slow motion at vanishing speed, in closed form: V' = -c V/(1 + j), delta/V constant.

    Relative corrections are of the order of kappa V < 1e-17.  Returns (next column, time
    at which the rest threshold is crossed or infinity).
    """
    material, _, _, j = scene
    c = material.c
    rate = c / (1.0 + j)
    V, omega, delta = speeds(PARTIAL, u[0], u[1], scene)
    crossing = np.inf
    if rest > 0.0 and rate > 0.0:
        crossing = tau + np.log(max(abs(V), abs(omega)) / rest) / rate
    while at < tau_out.size and tau_out[at] <= crossing:
        decay = np.exp(-rate * (tau_out[at] - tau))
        length = V * (tau_out[at] - tau) if rate == 0.0 else -V * np.expm1(-rate * (tau_out[at] - tau)) / rate
        put(out, at, direction, PARTIAL, V * decay, omega * decay, delta * decay,
            offset[0] + direction * (u[2] + length), offset[1] + direction * (u[3] + length), gamma)  # fmt: skip
        at += 1
    return at, crossing


@kernel
def at_rest(out, at, x, angle, gamma):
    """Outputs after rest: V = omega = 0 at the place where the threshold was crossed."""
    for column in range(at, out.shape[1]):
        put(out, column, 1.0, REST, 0.0, 0.0, 0.0, x, angle, gamma)
