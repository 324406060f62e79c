"""The balance of heat of a body that rolls: its parameters, and the zeros of loss less heat given off.

One temperature a body, W per m of length: capacity dtheta/dt = w(V, theta) - conductance (theta - ambient).  By
time-temperature superposition w(V, theta) = P V C(kappa V a_T)/kappa, with one curve C for all loads and radii.
With x = log2(kappa V a_T), in units of the scene, the zeros over temperature are zeros over x of

    F(x) = power C(x) - conductance (theta(x - x_0) - ambient),     x_0 = log2(kappa V), power = P V/kappa

where theta falls as x rises.  Under given loads the speed follows from the temperature, kappa V a_T is that of the
load at the reference, and w = w_0/a_T: the same equation with C = 2^-x and x_0 = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..contact_law.contact_table import evaluate_law, pure_rolling_fields
from ..contact_law.equilibria.resistance import speed_nodes
from ..core.array_types import Booleans, Floats, Integers
from ..materials.law.table import LawTable
from .shift_curve import ShiftCurve

#: nodes in an octave of kappa V a_T, as of the scan over speed of ``steady``: C has at most one extremum between two
NODES = 16
#: log2 of kappa V a_T beyond which no contact is evaluated
_FARTHEST = 900.0
#: nodes that are kept together
_KEPT = 256
#: states of a block: arrays over nodes and states then stay in the cache
_BLOCK = 256
#: steps of bracketed Newton: bisection alone needs 50 from a node to rounding
_STEPS = 60
#: sections of an interval around a minimum: 0.62^40 of two nodes is rounding
_SECTIONS = 40
#: distance in x that a step may leave: it changes a steep loss by 1e-12, to first order of which it is corrected
_TOLERANCE = 1e-14
#: Newton steps with the shift itself, from a temperature that is right to 1e-2 K: four reach rounding
_POLISHED = 5


class Curve(NamedTuple):
    """The curve C over x = log2(kappa V a_T).

    values : function of (indices of the states, (n,); x, (n,)) that returns C and dC/dx there, (n,) each.
    nodes : function of a range of node numbers (first, stop; x = number/16) and the indices of states that returns C
        there, (stop - first,), or (states, stop - first) where it differs between states.
    """

    values: Callable[[Integers, Floats], tuple[Floats, Floats]]
    nodes: Callable[[int, int, Integers], Floats]


@dataclass(frozen=True, eq=False)
class Balance:
    """The balance of several states, vectors of one length (n,).

    curve, shift : the curve C and the :class:`.shift_curve.ShiftCurve` of the body.
    x_0 : log2 of kappa V at the reference temperature.
    power : loss divided by C at the reference, W/m.
    conductance : W/(m K).
    ambient : degrees Celsius.
    hottest : temperature up to which zeros are looked for, degrees Celsius, (n,).
    """

    curve: Curve
    shift: ShiftCurve
    x_0: Floats
    power: Floats
    conductance: Floats
    ambient: Floats
    hottest: Floats

    def heat(self, n: Integers, x: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return F, dF/dx, the loss and its slope over x, of states by their indices, (m,) each."""
        theta = self.shift.temperature_of(x - self.x_0[n])
        C, slope = self.curve.values(n, x)
        loss = self.power[n] if self.shift.exact else self.power[n] / self.shift.root_b(theta)
        F = loss * C - self.conductance[n] * (theta - self.ambient[n])
        return F, loss * slope - self.conductance[n] / self.shift.slope(theta), loss * C, loss * slope


class Zeros(NamedTuple):
    """Zeros of a balance, sorted by state and rising temperature.

    state : index of the state, (m,).
    theta : temperature, degrees Celsius, (m,).
    stable : whether F falls with temperature there, (m,).
    """

    state: Integers
    theta: Floats
    stable: Booleans


def rolling_curve(law: Any, materials: Floats) -> Curve:
    """Return the curve of free rolling, C = kappa M; the part of the body is not in it.

    law: a :class:`LawTable`, or an array of materials.
    materials: index of the material of each state, (n,); not used with a LawTable.
    """

    def values(n: Integers, x: Floats) -> tuple[Floats, Floats]:
        u = np.exp2(x)
        if isinstance(law, LawTable):
            M, slope = pure_rolling_fields(law, u, "M", "dM_dV")
        else:
            M, slope = evaluate_law(law, [materials[n], 1.0, 1.0, u, 0.0], u.shape, False, ("M", "dM_dV"))
        return M, np.log(2.0) * u * slope

    def nodes(first: int, stop: int, n: Integers) -> Floats:
        if not isinstance(law, LawTable):
            x = np.arange(first, stop) / NODES
            return values(np.repeat(n, x.size), np.tile(x, n.size))[0].reshape(n.size, x.size)
        low = first // _KEPT
        parts = [_kept_nodes(law, block) for block in range(low, -(-stop // _KEPT))]
        return np.concatenate(parts)[first - low * _KEPT : stop - low * _KEPT]

    return Curve(values, nodes)


@lru_cache(maxsize=32)
def _peak(law: LawTable) -> float:
    """Return a number above kappa M of a law at any speed: its largest value at the nodes of speed, and 1 %."""
    return 1.01 * float(pure_rolling_fields(law, np.exp2(speed_nodes(law)), "M").max())


def peak_of(law: Any) -> float:
    """Return a number that kappa M exceeds at no speed: of a :class:`LawTable` its own, of an array of materials 1/2.

    Of one relaxation time it is at most 1/4 (docs/theory.md).
    """
    return _peak(law) if isinstance(law, LawTable) else 0.5


@lru_cache(maxsize=512)
def _kept_nodes(law: LawTable, block: int) -> Floats:
    """Return kappa M of a law at the nodes of a block of :data:`_KEPT`, (256,)."""
    x = np.arange(block * _KEPT, (block + 1) * _KEPT) / NODES
    return pure_rolling_fields(law, np.exp2(np.clip(x, -_FARTHEST, _FARTHEST)), "M")[0]


def hot_curve() -> Curve:
    """Return the curve of a given load, C = 2^-x, with x = log2 a_T: the speed, and the loss, are divided by a_T."""

    def values(_: Integers, x: Floats) -> tuple[Floats, Floats]:
        C = np.exp2(-x)
        return C, -np.log(2.0) * C

    return Curve(values, lambda first, stop, _: np.exp2(-np.arange(first, stop) / NODES))


def zeros_of(balance: Balance) -> Zeros:
    """Find all zeros of a balance: changes of sign between nodes, and pairs of zeros between neighbouring nodes.

    A pair is found where |F| has a minimum at a node near which a parabola reaches 0 and F has the other sign at the
    extremum, which is sought by sections; zeros at which F only touches 0 are not found.
    balance: the balance of n states; n may be 0.
    Returns the :class:`Zeros`, to the rounding of F.
    """
    parts = [_brackets(balance, start, min(start + _BLOCK, balance.x_0.size)) for start in
             range(0, balance.x_0.size, _BLOCK)]  # fmt: skip
    if not parts:
        return Zeros(np.empty(0, np.int64), np.empty(0), np.empty(0, bool))
    n, low, high, stable, first = parts[0] if len(parts) == 1 else map(np.concatenate, zip(*parts, strict=True))
    theta = _refine(balance, n, low, high, stable, first)
    if not balance.shift.exact:
        theta = _polish(balance, n, theta)
    order = np.lexsort((theta, n))
    order = order[theta[order] <= balance.hottest[n[order]]]
    return Zeros(n[order], theta[order], stable[order])


def _brackets(balance: Balance, start: int, stop: int) -> tuple[Integers, Floats, Floats, Booleans, Floats]:
    """Find intervals of x in which F of the states ``start`` to ``stop`` - 1 changes its sign.

    Returns (indices of the states; lower and upper ends; whether F > 0 at the upper end, the colder one, so that F
    falls with temperature; a point within to begin with, or NaN), (m,) each.
    """
    part = slice(start, stop)
    shift = balance.shift
    x_0 = balance.x_0[part]
    if not np.isfinite(x_0).any():
        return start + np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0, bool), np.empty(0)
    ends = x_0 + shift.log2_of(np.array([balance.hottest[part], balance.ambient[part]]))
    low, high = np.clip([ends[0][ends[0] > -np.inf].min(), ends[1].max()], -_FARTHEST, _FARTHEST)
    first, last = int(np.floor(low * NODES)) - 2, int(np.ceil(high * NODES)) + 3
    x = np.arange(first, last) / NODES
    C = balance.curve.nodes(first, last, np.arange(start, stop))
    theta = shift.temperature_of(x - x_0[:, np.newaxis])
    power, conductance, ambient = (
        each[part, np.newaxis] for each in (balance.power, balance.conductance, balance.ambient)
    )
    with np.errstate(invalid="ignore"):
        F = power * (C if shift.exact else C / shift.root_b(theta)) - conductance * (theta - ambient)
    positive = F > 0.0
    n, k = np.nonzero(positive[:, 1:] != positive[:, :-1])
    with np.errstate(invalid="ignore"):
        secant = x[k] - F[n, k] / (F[n, k + 1] - F[n, k]) / NODES
    crossing = start + n, x[k], x[k + 1], positive[n, k + 1], secant
    size = np.abs(F)
    with np.errstate(invalid="ignore"):
        minimum = (size[:, 1:-1] <= size[:, :-2]) & (size[:, 1:-1] <= size[:, 2:])
        minimum &= size[:, 1:-1] < size[:, :-2] - 2.0 * size[:, 1:-1] + size[:, 2:]
    minimum &= (positive[:, 1:-1] == positive[:, :-2]) & (positive[:, 1:-1] == positive[:, 2:])
    n, k = np.nonzero(minimum & np.isfinite(size[:, :-2]) & np.isfinite(size[:, 2:]))
    if not n.size:
        return crossing
    up = positive[n, k + 1]
    sign = np.where(up, 1.0, -1.0)
    extremum, least = minimum_of(lambda at: sign * balance.heat(start + n, at)[0], x[k], x[k + 2])
    n, k, up, extremum = start + n[least < 0.0], k[least < 0.0], up[least < 0.0], extremum[least < 0.0]
    lower, upper = (n, x[k], extremum, ~up), (n, extremum, x[k + 2], up)
    pairs = [(*pair, 0.5 * (pair[1] + pair[2])) for pair in (lower, upper)]
    return tuple(map(np.concatenate, zip(crossing, *pairs, strict=True)))  # type: ignore[return-value]


def minimum_of(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return places and values of the minima of functions of one variable, by golden sections, (m,) each.

    function: takes places (m,), one for each function, and returns values there.
    low, high: ends of the intervals, in each of which a function has one minimum, (m,).
    """
    part = 0.5 * (3.0 - np.sqrt(5.0))
    inner = [low + part * (high - low), high - part * (high - low)]
    values = [function(x) for x in inner]
    for _ in range(_SECTIONS):
        left = values[0] < values[1]  # the minimum is left of the upper of the inner points
        low, high = np.where(left, low, inner[0]), np.where(left, inner[1], high)
        new = np.where(left, low + part * (high - low), high - part * (high - low))
        value = function(new)
        inner = [np.where(left, new, inner[1]), np.where(left, inner[0], new)]
        values = [np.where(left, value, values[1]), np.where(left, values[0], value)]
    first = values[0] < values[1]
    return np.where(first, inner[0], inner[1]), np.where(first, *values)


def _refine(balance: Balance, n: Integers, low: Floats, high: Floats, rising: Booleans, first: Floats) -> Floats:
    """Return the temperatures of the zeros of F within brackets of x, by Newton's method with bisection.

    n: indices of the states; low, high: ends of the brackets; rising: whether F > 0 at the upper end; first:
        points within to begin with, or NaN, (m,) each.
    """
    x, last, loss = np.where((first > low) & (first < high), first, 0.5 * (low + high)), high - low, np.empty(n.size)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS if n.size else 0):
            F, slope, loss, rise = balance.heat(n, x)
            beyond = (F > 0.0) == rising
            low, high = np.where(beyond, low, x), np.where(beyond, x, high)
            new = x - F / slope
            outside = ~((new > low) & (new < high)) & (F != 0.0)
            new[outside] = 0.5 * (low + high)[outside]
            loss = loss + rise * (new - x)
            step = np.abs(new - x)
            left = step * np.minimum(step / last, 1.0) ** 2  # what a quadratic method leaves
            x, last = new, step
            if (left <= _TOLERANCE).all():
                break
    # so that a small rise has as many digits as the loss
    return balance.ambient[n] + loss / balance.conductance[n]


def _polish(balance: Balance, n: Integers, theta: Floats) -> Floats:
    """Refine zeros of a balance whose shift was interpolated, by Newton's method with the shift itself.

    n: indices of the states; theta: temperatures, (m,) each.  Beyond the range of the shift they stay.
    """
    shift = balance.shift
    for _ in range(_POLISHED):
        a_T, root_b = shift.factors(theta)
        x = balance.x_0[n] + np.log2(a_T * root_b)
        C, slope = balance.curve.values(n, np.where(np.isfinite(x), x, 0.0))
        loss = balance.power[n] / root_b
        F = loss * C - balance.conductance[n] * (theta - balance.ambient[n])
        step = F / (loss * slope * shift.slope(theta) - balance.conductance[n])
        new = balance.ambient[n] + (loss * (C - slope * shift.slope(theta) * step)) / balance.conductance[n]
        theta = np.where(np.isfinite(step), new, theta)
    return theta
