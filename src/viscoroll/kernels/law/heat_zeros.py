"""The temperatures at which the loss of rolling equals the heat given off, of many states of one
law.

With the rise r of the temperature above ambient, K, they are the zeros of

    f(r) = power kappa M(u) - r,    log2 u = x_hot + slope/(ambient - pole + r)

where u = kappa V a_T, with the time-temperature shift a_T of the speed, and kappa M without
traction is a function of u alone.  log2 a_T of the laws of Williams, Landel and Ferry and of
Arrhenius is slope/(theta - pole) plus a constant, with the temperature theta = ambient + r in
degrees Celsius; the constant is part of x_hot.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from .law_functions import length_and_moment, locate_row

#: steps of bracketed Newton: bisection alone needs 50 from a node to rounding
_STEPS = 60
#: distance from a zero at which it is found, relative, and absolute in K
_RELATIVE = 1e-12
_ABSOLUTE = 1e-15


class HeatRequest(NamedTuple):
    """States of one law, vectors of one length (n,), and nodes of its curve.

    x_hot : log2 of kappa V a_T in the limit of an infinite temperature, finite, (n,).
    ambient : ambient temperature, degrees Celsius, above the pole, (n,).
    power : loss over kappa M and conductance, K, >= 0, (n,).
    hottest : temperature up to which zeros are looked for, degrees Celsius, (n,).
    pole : of the shift, degrees Celsius, a number.
    slope : of log2 a_T over 1/(theta - pole), K, > 0, a number.
    curve : kappa M at the nodes log2 u = k/density - farthest, k = 0, 1, ..., dimensionless, (2
        farthest density + 1,).
    density : int, nodes of the curve in a unit of log2 u.
    farthest : int, largest |log2 u| of the curve.
    """

    x_hot: Any
    ambient: Any
    power: Any
    hottest: Any
    pole: float
    slope: float
    curve: Any
    density: int
    farthest: int


@inline_kernel
def _rest(n, r, request, law):
    """Return f, K, and its slope df/dr, dimensionless, floats.

    n : int, index of the state.
    r : float, rise of the temperature above ambient, K, such that the temperature is above the
        pole.
    request : :class:`HeatRequest`, the states, of which x_hot, ambient, power, pole and slope are
        read.
    law : :class:`.law_record.Law` of the material, with all rows, of which those of M/V are read.
    """
    above = request.ambient[n] - request.pole + r  # temperature above the pole, K
    u = np.exp2(request.x_hot[n] + request.slope / above)
    functions = length_and_moment(locate_row(u, law), u, law)
    # u = 2^x with dx/dr = -slope/above^2
    du_dr = -np.log(2.0) * u * request.slope / (above * above)
    # kappa M = u m scale, and d(kappa M)/du = d_um (law_functions.LengthAndMoment).
    return (
        request.power[n] * u * functions.scale * functions.m - r,
        request.power[n] * functions.d_um * du_dr - 1.0,
    )


@kernel
def _find_zero(n, low, high, r, falling, request, law):
    """Return the zero of f in a bracket, a float, K, by Newton's iteration with bisection.

    n : int, index of the state.
    low, high : floats, rises between which f changes its sign, K.
    r : float, first guess, K; outside of the bracket the middle is taken.
    falling : bool, whether f > 0 at ``low`` and < 0 at ``high``; else the reverse; not checked.
    request : :class:`HeatRequest`, the states.
    law : :class:`.law_record.Law` of the material.
    """
    if not low < r < high:
        r = 0.5 * (low + high)
    for _ in range(_STEPS):
        value, slope = _rest(n, r, request, law)
        # the zero is above r where f has the sign that it has at ``low``
        if (value > 0.0) == falling:
            low = r
        else:
            high = r
        new = r - value / slope
        if not low <= new <= high:  # outside of the bracket, or NaN
            new = 0.5 * (low + high)
        step = abs(new - r)
        r = new
        if step <= _RELATIVE * abs(r) + _ABSOLUTE:
            break
    return r


@kernel
def _find_turn(n, low, high, positive, request, law):
    """Return a rise near a minimum of |f| at which f has changed its sign, K; NaN if there is none.

    The minimum is bracketed by the sign of the slope of f.

    n : int, index of the state.
    low, high : floats, rises between which the minimum lies, K.
    positive : bool, whether f > 0 at both; else f < 0 at both.
    request : :class:`HeatRequest`, the states.
    law : :class:`.law_record.Law` of the material.
    """
    for _ in range(_STEPS):
        r = 0.5 * (low + high)
        value, slope = _rest(n, r, request, law)
        if (value > 0.0) != positive:
            return r
        # |f| falls towards its minimum, which is above r where f > 0 falls or f < 0 rises
        if (slope < 0.0) == positive:
            low = r
        else:
            high = r
    return np.nan


@inline_kernel
def _write(n, rise, stable, count, request, number, out, is_stable):
    """Append one zero to the output, and return the number of zeros so far, an int.

    A zero above the hottest temperature is left out; beyond the end of ``out`` it is only counted.

    n : int, index of the state.
    rise : float, the zero, K above ambient.
    stable : bool, whether the equilibrium is stable, that is f falls there.
    count : int, number of zeros before, of all states; entry ``count`` is written.
    request : :class:`HeatRequest`, of which ambient and hottest are read.
    number, out, is_stable : (m,) each, vectors of state, rise, K, and stability of all zeros.
    """
    if request.ambient[n] + rise > request.hottest[n]:
        return count
    if count < out.size:
        number[count] = n
        out[count] = rise
        is_stable[count] = stable
    return count + 1


@kernel
def heat_loop(law, request, number, out, is_stable):
    """Find all zeros of f of each state: changes of sign between nodes, and pairs of zeros between
    neighbouring nodes.

    A pair is found where |f| has a minimum at a node near which a parabola reaches 0 and f has the
    other sign at the extremum; zeros at which f only touches 0 are not found.

    law : :class:`.law_record.Law` of the material, of which the polynomials of M/V or, beyond the
    last row, the head are read.
    request : :class:`HeatRequest`.
    number, out, is_stable : (m,) each, ints, floats, bools, of which the first are written: index
        of the state, rise, K, and whether f falls there; ordered by state, and of a state by rise
        but for pairs between nodes.
    Returns the number of zeros, which may exceed m: those beyond are not written.
    """
    count = 0
    density = request.density
    offset = request.farthest * density  # index in the curve of log2 u = 0
    for n in range(request.x_hot.size):
        x_hot = request.x_hot[n]
        above = request.ambient[n] - request.pole
        most = request.hottest[n] - request.ambient[n]  # largest rise, K
        # Nodes k, with log2 u = k/density, from a little below that of the largest rise to a little
        # above that of no rise: some nodes more, as int() rounds towards 0 and a pair of zeros is
        # seen from the nodes on either side.  u falls with the temperature.
        first = max(int(density * (x_hot + request.slope / (above + most))) - 3, -offset)
        last = min(int(density * (x_hot + request.slope / above)) + 4, offset)
        # f and the rise at the last node (old, low) and at the one before it (older, cold), which
        # are not read before so many nodes were passed.
        older = 0.0
        old = 0.0
        low = -above
        cold = -above
        for k in range(last, first - 1, -1):  # from cold to hot
            # The rise of this u; where no temperature has it, or one far beyond the hottest, a rise
            # above the largest.
            distance = k / density - x_hot
            r = 2.0 * most + 1.0
            if distance > 0.0:
                r = min(request.slope / distance - above, r)
            f = request.power[n] * request.curve[k + offset] - r
            # A change of sign between the last node and this one; old > 0 means that f falls there.
            if k < last and (f > 0.0) != (old > 0.0):
                start = low + old / (old - f) * (r - low)  # zero of the chord
                zero = _find_zero(n, low, r, start, old > 0.0, request, law)
                count = _write(n, zero, old > 0.0, count, request, number, out, is_stable)
            elif k < last - 1 and (old > 0.0) == (older > 0.0):
                # |f| is least at the last node; the second difference bounds by how much the
                # extremum of a parabola through the three nodes may lie nearer to 0.
                near = abs(old) <= min(abs(older), abs(f))
                if near and abs(old) < abs(older - 2.0 * old + f):
                    up = old > 0.0
                    turn = _find_turn(n, cold, r, up, request, law)
                    if turn == turn:  # not NaN: a zero on either side of it
                        for side in range(2):
                            begin = cold if side == 0 else turn
                            end = turn if side == 0 else r
                            falls = up == (side == 0)
                            zero = _find_zero(n, begin, end, begin, falls, request, law)
                            count = _write(n, zero, falls, count, request, number, out, is_stable)
            older = old
            cold = low
            old = f
            low = r
    return count
