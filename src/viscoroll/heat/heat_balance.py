"""Zeros of the balance of heat: loss less heat given off, over the temperature.

With the rise r = theta - ambient they are those of f(r) = w(ambient + r)/conductance - r, which is
> 0 below ambient.  w changes with log2 a_T, so that nodes of the temperature are even in it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics.contact_table import pure_rolling_fields
from ..core.checks import Booleans, Floats, Integers
from ..laws.law_table import LawTable
from .heated_bodies import HeatStates
from .shift_curve import FARTHEST, NODES, ShiftCurve

#: states of a block: arrays over nodes and states then stay in the cache
_BLOCK = 256
#: distance from a zero at which it is found, relative, and absolute in K
_TOLERANCE = {"xrtol": 1e-14, "xatol": 1e-15}
#: No kappa M exceeds this: the pressure acts at most half the contact length at rest ahead of the
#: axis; twice that, for b_T down to 1/4.
_MOST = 1.0

#: Function of indices of states and temperatures, degrees Celsius, (m,) each, that returns W/m.
Heat = Callable[[Integers, Floats], Floats]


class Zeros(NamedTuple):
    """Zeros of a balance.

    state : index of the state, (m,).
    theta : temperature, degrees Celsius, (m,).
    stable : whether f falls with temperature there, (m,).
    """

    state: Integers
    theta: Floats
    stable: Booleans


def zeros_at_speed(
    states: HeatStates, n: Integers, V: Floats, more: Any = 1.0, hottest: float | None = None
) -> Zeros:
    """Find all equilibria of states at speeds.

    n: indices of the states; V: m/s, any sign; more: as in :meth:`.HeatStates.heat`, (m,) each.
    hottest: temperature up to which they are sought; None: as high as the loss of free rolling
    allows.
    Returns the zeros, whose ``state`` counts the elements of n.
    """
    kappa = states.kappa[n] / np.sqrt(more)
    ambient = states.ambient[n]
    conductance = states.conductance[n]
    speed = np.abs(V)
    rise = states.body.part * states.load[n] * more * speed / (kappa * conductance)
    top = ambient + _MOST * rise if hottest is None else np.full(n.size, hottest)
    curve = states.curve
    if isinstance(states.law, LawTable) and states.loads is None and curve.slope:
        x = kappa * np.where(speed == 0.0, 1.0, speed * states.roller.T_ref / states.R[n])
        return _zeros_by_kernel(states.law, curve, np.log2(x), ambient, rise, top)

    def heat(k: Integers, theta: Floats) -> Floats:
        return states.heat(n[k], theta, V[k], more if np.ndim(more) == 0 else more[k])

    return zeros_of(heat, curve, ambient, conductance, top)


def _zeros_by_kernel(
    law: LawTable, curve: ShiftCurve, x: Floats, ambient: Floats, rise: Floats, hottest: Floats
) -> Zeros:
    """Return the zeros of half-spaces of one law that roll freely, by a shift with a pole.

    x: log2 of kappa V at the reference; rise: loss over kappa M and conductance, K; (n,) each.
    """
    from ..kernels.law.heat_zeros import HeatRequest, heat_loop

    request = HeatRequest(
        x_hot=x - curve.own,
        ambient=ambient,
        power=rise,
        hottest=hottest,
        pole=curve.pole,
        slope=curve.slope,
        curve=_kept_curve(law),
        density=NODES,
        farthest=FARTHEST,
    )
    size = count = 3 * x.size
    while count >= size:  # some states have more zeros than three
        size = count + 1
        number = np.empty(size, np.int64)
        above = np.empty(size)
        stable = np.empty(size, bool)
        count = heat_loop(law.record, request, number, above, stable)
    n = number[:count]
    return Zeros(n, ambient[n] + above[:count], stable[:count])


@lru_cache(maxsize=16)
def _kept_curve(law: LawTable) -> Floats:
    """Return kappa M of a law at log2 kappa V = n/16 - 900, all of them."""
    x = np.arange(2 * FARTHEST * NODES + 1) / NODES - FARTHEST
    return pure_rolling_fields(law, np.exp2(x), "M")[0]


def zeros_of(
    heat: Heat, curve: ShiftCurve, ambient: Floats, conductance: Floats, hottest: Floats
) -> Zeros:
    """Find all zeros of balances: changes of sign between nodes, and pairs of zeros between
    neighbouring nodes.

    heat: of the states; curve: the shift of their body.
    ambient, conductance: of the states, degrees Celsius and W/(m K); hottest: temperature up to
    which zeros are sought; (n,) each, n may be 0.
    A pair is found where |f| has a minimum at a node near which a parabola reaches 0 and f has the
    other sign at the extremum; zeros at which f only touches 0 are not found.
    Returns the :class:`Zeros`, to the rounding of f.
    """
    from scipy.optimize.elementwise import find_minimum, find_root

    def rest(rise: Floats, n: Integers, sign: Any = 1.0) -> Floats:
        return sign * (heat(n, ambient[n] + rise) / conductance[n] - rise)

    parts = [(np.empty(0, np.int64), np.empty(0), np.empty(0, bool))]
    for first in range(0, ambient.size, _BLOCK):
        own = np.arange(first, min(first + _BLOCK, ambient.size))
        nodes = curve.nodes(ambient[own].min() - 1.0, hottest[own].max() + 1.0)
        rise = nodes - ambient[own, np.newaxis]
        f = rest(rise.ravel(), np.repeat(own, nodes.size)).reshape(rise.shape)
        n, k = _extrema(f)
        if n.size:  # they take the places of their nodes
            triple = rise[n, k - 1], rise[n, k], rise[n, k + 1]
            sign = np.sign(f[n, k])
            found = find_minimum(rest, triple, args=(own[n], sign))
            rise[n, k] = found.x
            f[n, k] = sign * found.f_x
        positive = f > 0.0
        n, k = (positive[:, 1:] != positive[:, :-1]).nonzero()
        ends = rise[n, k], rise[n, k + 1]
        found = find_root(rest, ends, args=(own[n],), tolerances=_TOLERANCE)
        parts.append((own[n], ambient[own[n]] + found.x, positive[n, k]))
    n, theta, stable = (np.concatenate(each) for each in zip(*parts, strict=True))
    found = theta <= hottest[n]
    return Zeros(n[found], theta[found], stable[found])


def _extrema(f: Floats) -> tuple[Integers, Integers]:
    """Return (rows, columns) of nodes of f, (states, nodes), at which |f| has a minimum near which
    a parabola reaches 0.
    """
    size = np.abs(f)
    before, at, after = (size[:, k : f.shape[1] - 2 + k] for k in range(3))
    near = (at <= before) & (at <= after) & (at < np.abs(np.diff(f, 2)))
    one_sign = np.abs(np.diff(np.sign(f), axis=1)) == 0.0
    n, k = (near & one_sign[:, 1:] & one_sign[:, :-1]).nonzero()
    return n, k + 1
