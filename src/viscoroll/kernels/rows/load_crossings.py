"""The speeds at which kappa (M(V) - gain V) equals a load, over arrays.

Here M is the rolling moment divided by P R, the normal load times the radius of the cylinder, V > 0 the speed, kappa =
R/l0 the slenderness, and gain the slope over V of a force plus torque that rises or falls with the speed.  A "load" of
this file is kappa times a force plus torque that does not depend on the speed.

kappa M is one function of u = kappa V, so that kappa (M - gain V) = load is one equation between two nodes between
which its left side is monotone.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from .evaluate import length_and_moment, locate_row

#: A load this close to an extremum, relative, is taken to be at it: some ulp of kappa M.
EXTREMUM_RTOL = 1e-15
#: Newton steps after which an iteration ends; with bisection in its bracket it needs fewer.
_MAX_STEPS = 40
#: A Newton step of this size in ln u, divided by the distance from an extremum, leaves its square, which is rounding.
_LAST_STEP = 1e-8


class LoadCurve(NamedTuple):
    """Nodes of kappa (M - gain V) by rising speed; all dimensionless.

    u : kappa V, > 0, (n,).
    value : kappa (M - gain V), (n,), monotone between two nodes.
    is_extremum : bool, whether a node is an extremum of the curve, (n,).
    gain : slope of force plus torque over V, of either sign.
    """

    u: Any
    value: Any
    is_extremum: Any
    gain: float


@kernel
def _find_crossing(load, n, curve, law):
    """Return u between the nodes ``n`` and n + 1 where the curve equals ``load``: Newton's iteration in a bracket.

    load : float, value of kappa (M - gain V), between those of the two nodes, dimensionless; not checked.
    n : int, index of the lower node, from 0 to the number of nodes - 2.
    curve : :class:`LoadCurve`: nodes u, kappa (M - gain V) there, whether it is an extremum, gain.
    law : :class:`Law` of the material, of which the polynomials of M/V or, beyond the last row, the head are read.
    Returns u = kappa V, a float, > 0, dimensionless, from u of node n to that of node n + 1.  Where the load equals an
    extremum at the node n + 1 to rounding (EXTREMUM_RTOL), it is that node; where it equals one at the node n to
    rounding, it is that node to about the square root of rounding, 5e-8 relative.

    The iteration, in ln u, starts from interpolation between the nodes, and takes the middle of the bracket where a
    step would leave it.  It ends when a step is so small that the next one would be rounding, at the latest after 40
    steps.  Beside an extremum steps may end in rounding, above the bound.  The last one is then as near as others:
    4e-15 of the load, measured.
    """
    low = curve.u[n]
    high = curve.u[n + 1]
    rise = curve.value[n + 1] - curve.value[n]
    if curve.is_extremum[n + 1] and abs(load - curve.value[n + 1]) <= EXTREMUM_RTOL * abs(load):
        return high
    part = (load - curve.value[n]) / rise
    top = 0.0
    if curve.is_extremum[n]:  # beside an extremum the curve is a parabola
        part = np.sqrt(part)
        top = low
    elif curve.is_extremum[n + 1]:
        part = 1.0 - np.sqrt(1.0 - part)
        top = high
    u = low * (high / low) ** part
    for _ in range(_MAX_STEPS):
        functions = length_and_moment(locate_row(u, law), u, law)
        value = u * functions.scale * functions.m - u * curve.gain
        slope = u * (functions.d_um - curve.gain)  # over ln u
        if (value <= load) == (rise > 0.0):
            low = u
        else:
            high = u
        step = (load - value) / slope
        new = u * np.exp(step)
        if not low <= new <= high:
            new = np.sqrt(low) * np.sqrt(high)
            step = 1.0
        old = u
        u = new
        if abs(step) <= _LAST_STEP * min(1.0, abs(old - top) / old):
            break
    return u


@kernel
def crossing_loop(law, curve, load, node, out, start, stop):
    """Find u = kappa V where kappa (M(V) - gain V) equals each load.

    law : :class:`Law` of the material, of which the polynomials of M/V or, beyond the last row, the head are read.
    curve : :class:`LoadCurve`: nodes u, kappa (M - gain V) there, whether it is an extremum, gain.
    load : values of kappa (M - gain V), (n,), dimensionless, each between the values at its two nodes; not checked.
    node : for each load the index of the node below the crossing, from 0 to the number of nodes - 2, int, (n,).
    out : (n,) floats, of which the numbers ``start`` to ``stop`` - 1 are written: u > 0, dimensionless, between the two
        nodes of the load.
    start, stop : int, index of the first load and of the one after the last.  Returns nothing.
    """
    for n in range(start, stop):
        out[n] = _find_crossing(load[n], node[n], curve, law)
