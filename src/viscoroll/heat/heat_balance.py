"""The balance of heat of a body that rolls: its parameters, and the zeros of loss less heat given
off.

One temperature a body, W per m of length: capacity dtheta/dt = w(V, theta) - conductance (theta -
ambient).  By time-temperature superposition w(V, theta) = P V C(kappa V a_T)/kappa, with one curve
C for all loads and radii.  Zeros of the rise r = theta - ambient are those of

    f(r) = power C(x_0 + log2 a_T)/conductance - r,     x_0 = log2(kappa V) at the reference, power = P V/kappa

where a_T falls as r rises.  Under given loads the speed follows from the temperature, kappa V a_T
is that of the load at the reference, and w = w_0/a_T: the same equation with C = 2^-x and x_0 = 0.
"""  # noqa: E501

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics.contact_table import pure_rolling_fields
from ..core.checks import Booleans, Floats, Integers
from ..laws.law_table import LawTable
from .shift_curve import ShiftCurve

#: nodes in an octave of kappa V a_T, as in the scan over speed of ``steady``: C has at most one
#: extremum between two
NODES = 16
#: log2 of kappa V a_T beyond which no contact is evaluated
FARTHEST = 900
#: states of a block: arrays over nodes and states then stay in the cache
_BLOCK = 256
#: steps of bracketed Newton: bisection alone needs 50 from a node to rounding
_STEPS = 60
#: step of difference quotients over a bracket: rounding and curvature both change a slope by some
#: 1e-5
_DIFFERENCE = 1e-5
#: distance from a zero at which it is found, relative, and absolute in K
_TOLERANCE = 1e-12, 1e-15


@dataclass(frozen=True, eq=False)
class Balance:
    """The balance of several states, vectors of one length (n,).

    curve : function of (indices of the states, (m,); x, (m,)) that returns C, (m,).
    law : law of all states whose curve this is, so that its values at nodes are kept; None: they
    are computed.
    shift : the :class:`.shift_curve.ShiftCurve` of the body.
    x_0 : log2 of kappa V at the reference temperature.
    power : loss divided by C at the reference, W/m.
    conductance : W/(m K).
    ambient : degrees Celsius.
    hottest : temperature up to which zeros are looked for, degrees Celsius, (n,).
    """

    curve: Callable[[Integers, Floats], Floats]
    law: LawTable | None
    shift: ShiftCurve
    x_0: Floats
    power: Floats
    conductance: Floats
    ambient: Floats
    hottest: Floats

    def heat(self, n: Integers, theta: Floats) -> Floats:
        """Return the heat of the body, W/m, of states by their indices at temperatures, (m,)
        each.
        """
        log2, root_b = self.shift.exactly(theta)
        return self.power[n] / root_b * self.curve(n, self.x_0[n] + log2)

    def rest(self, n: Integers, rise: Floats) -> Floats:
        """Return f, K, of states by their indices at rises of the temperature, K, (m,) each."""
        return self.heat(n, self.ambient[n] + rise) / self.conductance[n] - rise


class Zeros(NamedTuple):
    """Zeros of a balance.

    state : index of the state, (m,).
    theta : temperature, degrees Celsius, (m,).
    stable : whether f falls with temperature there, (m,).
    """

    state: Integers
    theta: Floats
    stable: Booleans


@lru_cache(maxsize=16)
def kept_curve(law: LawTable) -> Floats:
    """Return kappa M of a law at all nodes, x = n/16 - 900, which are kept."""
    x = np.arange(2 * FARTHEST * NODES + 1) / NODES - FARTHEST
    return pure_rolling_fields(law, np.exp2(x), "M")[0]


def zeros_of(balance: Balance) -> Zeros:
    """Find all zeros of a balance: changes of sign between nodes, and pairs of zeros between
    neighbouring nodes.

    A pair is found where |f| has a minimum at a node near which a parabola reaches 0 and f has the
    other sign at the extremum; zeros at which f only touches 0 are not found.
    balance: the balance of n states; n may be 0.
    Returns the :class:`Zeros`, to the rounding of f.
    """
    if balance.law is not None and balance.law.coupled is None and balance.shift.slope:
        return _zeros_by_kernel(balance, balance.law)
    blocks = range(0, balance.x_0.size, _BLOCK)
    parts = [_brackets(balance, np.arange(at, min(at + _BLOCK, balance.x_0.size))) for at in blocks]
    if not parts:
        return Zeros(np.empty(0, np.int64), np.empty(0), np.empty(0, bool))
    n, low, high, first, stable = (
        parts[0] if len(parts) == 1 else map(np.concatenate, zip(*parts, strict=True))
    )
    theta = balance.ambient[n] + refine(balance.rest, n, low, high, first, ~stable)
    found = theta <= balance.hottest[n]
    return Zeros(n[found], theta[found], stable[found])


def _zeros_by_kernel(balance: Balance, law: LawTable) -> Zeros:
    """Return :func:`zeros_of` a balance of one law and a shift with a pole, found by a kernel."""
    from ..kernels.law.heat_zeros import HeatRequest, heat_loop

    shift = balance.shift
    request = HeatRequest(
        x_hot=balance.x_0 - shift.own,
        ambient=balance.ambient,
        power=balance.power / balance.conductance,
        hottest=balance.hottest,
        pole=shift.pole,
        slope=shift.slope,
        curve=kept_curve(law),
        density=NODES,
        farthest=FARTHEST,
    )
    size = count = 3 * balance.x_0.size
    while count >= size:  # some states have more zeros than three
        size = count + 1
        number = np.empty(size, np.int64)
        rise = np.empty(size)
        stable = np.empty(size, bool)
        count = heat_loop(law.record, request, number, rise, stable)
    n = number[:count]
    return Zeros(n, balance.ambient[n] + rise[:count], stable[:count])


def _brackets(balance: Balance, states: Integers) -> tuple[Any, ...]:
    """Find intervals of the temperature rise in which f changes its sign.

    balance: the balance of all states.
    states: indices of the states that are examined, (k,).
    Returns (indices of the states; lower and upper ends, K; a point within to begin with; whether f
    > 0 at the lower end, the colder one, so that f falls with temperature), (m,) each.
    """
    shift = balance.shift
    x_0, power, G, ambient, hottest = (
        each[states, np.newaxis]
        for each in (
            balance.x_0,
            balance.power,
            balance.conductance,
            balance.ambient,
            balance.hottest,
        )
    )
    ends = NODES * (x_0 + shift.log2_of(np.concatenate([hottest, ambient], axis=1)))
    first = max(int(ends[:, 0].min().clip(-FARTHEST * NODES)) - 3, -FARTHEST * NODES)
    last = min(int(ends[:, 1].max().clip(max=FARTHEST * NODES)) + 4, FARTHEST * NODES)
    x = np.arange(first, last) / NODES
    if balance.law is not None:
        C = kept_curve(balance.law)[first + FARTHEST * NODES : last + FARTHEST * NODES]
    else:
        C = balance.curve(np.repeat(states, x.size), np.tile(x, states.size)).reshape(
            states.size, x.size
        )
    theta = np.minimum(shift.temperature_of(x - x_0), 2.0 * hottest - ambient + 1.0)
    rise = theta - ambient
    f = power / G * C / shift.root_b(theta) - rise
    positive = f > 0.0
    n, k = (positive[:, 1:] != positive[:, :-1]).nonzero()
    part = f[n, k] / (f[n, k] - f[n, k + 1])
    secant = rise[n, k] + part * (rise[n, k + 1] - rise[n, k])
    more = 0 if shift.sampled_root_b is None else 1  # samples may displace a zero beyond its node
    reach = rise[n, np.minimum(k + 1 + more, x.size - 1)], rise[n, np.maximum(k - more, 0)]
    crossings = states[n], *reach, secant, positive[n, k + 1]
    bend = f[:, :-2] - 2.0 * f[:, 1:-1] + f[:, 2:]
    n, k = (np.abs(f[:, 1:-1]) < np.abs(bend)).nonzero()
    near = np.abs(f[n, k + 1]) <= np.minimum(np.abs(f[n, k]), np.abs(f[n, k + 2]))
    near &= (positive[n, k] == positive[n, k + 1]) & (positive[n, k + 2] == positive[n, k + 1])
    if not near.any():
        return crossings
    from scipy.optimize.elementwise import find_minimum

    up = positive[n, k + 1][near]
    n = n[near]
    k = k[near]
    triple = rise[n, k + 2], rise[n, k + 1], rise[n, k]
    found = find_minimum(
        lambda r, n, sign: sign * balance.rest(n, r),
        triple,
        args=(states[n], np.where(up, 1.0, -1.0)),
    )
    below = found.f_x < 0.0
    n = states[n[below]]
    at = found.x[below]
    up = up[below]
    low, _, high = (end[below] for end in triple)
    cold = (n, low, at, 0.5 * (low + at), up)
    hot = (n, at, high, 0.5 * (at + high), ~up)
    return tuple(map(np.concatenate, zip(crossings, cold, hot, strict=True)))


def refine(
    function: Callable[[Integers, Floats], Floats],
    n: Integers,
    low: Floats,
    high: Floats,
    x: Floats,
    rising: Booleans,
) -> Floats:
    """Return zeros of functions of one variable within brackets, by Newton's method with bisection,
    (m,).

    function: takes (numbers of the functions; points), (k,) each, and returns values (k,).
    n: numbers of the functions, (m,).
    low, high: ends of the brackets; x: points to begin with, of which those outside give way to the
    middle, (m,) each.
    rising: whether a function is negative at the lower end and positive at the upper one, else the
    reverse, (m,).
    """
    step = high - low
    both = np.concatenate([n, n])
    ahead = _DIFFERENCE * step
    x = np.where((x > low) & (x < high), x, 0.5 * (low + high))
    for _ in range(_STEPS if n.size else 0):
        value, there = function(both, np.concatenate([x, x + ahead])).reshape(2, -1)
        beyond = (value > 0.0) == rising
        low = np.where(beyond, low, x)
        high = np.where(beyond, x, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            new = x - value * ahead / (there - value)
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        last = step
        step = np.abs(new - x)
        x = new
        left = step * np.maximum((step / np.maximum(last, 1e-300)) ** 2, _DIFFERENCE)
        if (left <= _TOLERANCE[0] * np.abs(x) + _TOLERANCE[1]).all():
            break
    return x
