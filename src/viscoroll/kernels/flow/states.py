"""The law at the states that a flow map is made from."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..rows.law import place, press, speed

#: rows of what is found: delta_star, M, Q, dQ/d delta
DELTA_STAR, MOMENT, TRACTION, STIFFNESS = range(4)


@kernel
def states(V, delta, kappa, mu, law, out):
    """Fill ``out`` at every V > 0 and delta within the stick zone."""
    for i in range(V.size):
        u = kappa * V[i]
        found = speed(place(u, law), u, law)
        edge = 0.5 * mu / kappa * found.L
        w = found.L * max(1.0 - abs(delta[i]) / edge, 1e-300)
        v = 2.0 * u / w
        value, slope = press(place(v, law), v, law)
        out[DELTA_STAR, i], out[MOMENT, i] = edge, V[i] * found.scale * found.m
        out[TRACTION, i] = np.sign(delta[i]) * mu * (1.0 - w * w * value)
        out[STIFFNESS, i] = 4.0 * kappa * w * (value - 0.5 * v * slope)
