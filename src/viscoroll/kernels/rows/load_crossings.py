"""The speeds at which M(V) - gain V meets a load, over arrays.

kappa M is one function of u = kappa V, so that kappa (M - gain V) = load is one equation between two nodes where its
left side is monotone.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from .evaluate import length_and_moment, locate_row

#: a load this close to an extremum, relative, is at it
EXTREMUM_RTOL = 1e-15
_MAX_STEPS = 40
#: a step of Newton's iteration of this size in ln u, over the distance from an extremum, leaves its square
_SQUARED = 1e-8


class LoadCurve(NamedTuple):
    """Nodes of kappa (M - gain V) by rising speed: u, value, whether it is an extremum; gain."""

    u: Any
    rise: Any
    flat: Any
    gain: float


@kernel
def _on_curve(u, gain, law):
    """(kappa (M - gain V), its slope over ln u) at u."""
    found = length_and_moment(locate_row(u, law), u, law)
    return u * found.scale * found.m - u * gain, u * (found.d_um - gain)


@kernel
def _crossing(load, n, curve, law):
    """u between the nodes n and n + 1 where the curve meets the load: Newton's iteration in a closed bracket.

    Beside an extremum steps may end in rounding, not below the bound: the last is then as near as others, 4e-15 of the
    load, measured.
    """
    low, high = curve.u[n], curve.u[n + 1]
    if curve.flat[n + 1] and abs(load - curve.rise[n + 1]) <= EXTREMUM_RTOL * abs(load):
        return high
    part = (load - curve.rise[n]) / (curve.rise[n + 1] - curve.rise[n])
    top = 0.0
    if curve.flat[n]:  # beside an extremum the curve is a parabola
        part, top = np.sqrt(part), low
    elif curve.flat[n + 1]:
        part, top = 1.0 - np.sqrt(1.0 - part), high
    u = low * (high / low) ** part
    rising = curve.rise[n + 1] > curve.rise[n]
    for _ in range(_MAX_STEPS):
        value, slope = _on_curve(u, curve.gain, law)
        if (value <= load) == rising:
            low = u
        else:
            high = u
        step = (load - value) / slope
        new = u * np.exp(step)
        if not low <= new <= high:
            new, step = np.sqrt(low) * np.sqrt(high), 1.0
        old, u = u, new
        if abs(step) <= _SQUARED * min(1.0, abs(old - top) / old):
            break
    return u


@kernel
def crossing_loop(law, curve, load, node, out, start, stop):
    """u where the curve meets each load between a node and the next."""
    for n in range(start, stop):
        out[n] = _crossing(load[n], node[n], curve, law)
