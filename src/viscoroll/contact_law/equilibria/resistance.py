"""Rolling resistance over speed: the humps of M(V), and between them the branches on which it can be inverted.

kappa M is one function of u = kappa V for a material.  A gain G on the speed turns M(V) = load into M(V) - G V = load,
which is the same with another curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import ParameterError
from ...core.typed import Booleans, Floats, Integers
from ...materials.law_table import LawTable
from ..contact_table import rolling
from ..parameters import Rolls, framed, refuse_arrays

#: octaves of u beyond the rates of a material that are looked at, and closely: farther out the curve has one simple
#: extremum at most
_MARGIN, _WIDE = 15, 446
#: nodes an octave, close and far; an extremum keeps others away by this part of u
_CLOSE, _FAR, _APART = 16, 2, 1e-6
#: kappa times a load, and a gain over the longest time, that the nodes reach
LEAST_LOAD, MOST_LOAD = 1e-120, 1e80
_GAINS = (1e-40, 1e8)
#: until a bracket is at rounding
_HALVINGS = 62
#: where a function comes near 0 and turns back, it is looked at this often with so many points
_ZOOMS, _ZOOMED = 4, 33

Function = Callable[[Floats], Floats]


class Humps(NamedTuple):
    """Every local maximum and minimum of M(V), V > 0, by rising V: a maximum comes first and last.

    V : speeds.  M : moments there.  top : whether it is a maximum.
    """

    V: Floats
    M: Floats
    top: Booleans


@dataclass(frozen=True)
class Branches:
    """kappa (M - G V) over the speed: nodes by rising speed, and those between which it is monotone."""

    u: Floats
    rise: Floats
    flat: Booleans
    gain: float
    first: Integers
    last: Integers

    @cached_property
    def curve(self) -> Any:
        """The nodes as kernels take them."""
        from ...kernels.rows.steady import Curve

        return Curve(self.u, self.rise, self.flat, self.gain)

    @cached_property
    def top(self) -> tuple[float, float]:
        """The largest value, and kappa V there."""
        n = int(np.argmax(self.rise))
        return float(self.rise[n]), float(self.u[n])

    def met(self, load: Floats) -> tuple[Integers, Integers]:
        """(Which loads meet a branch, the node behind which they do).

        An extremum, and loads next to it, belong to the branch that ends in it.
        """
        from ...kernels.rows.steady import SNAP

        which, nodes, near = [], [], SNAP * np.abs(load)
        for first, last in zip(self.first.tolist(), self.last.tolist(), strict=True):
            rise = self.rise[first : last + 1]
            rises = rise[-1] > rise[0]
            low, high = (rise[0], rise[-1]) if rises else (rise[-1], rise[0])
            inside = (load > low) & (load < high)
            if self.flat[first]:
                inside &= np.abs(load - rise[0]) > near
            if self.flat[last]:
                inside |= np.abs(load - rise[-1]) <= near
            which.append(of := inside.nonzero()[0])
            at = rise.searchsorted(load[of], "right") if rises else (-rise).searchsorted(-load[of])
            nodes.append(first + np.minimum(np.maximum(at - 1, 0), last - first - 1))
        return np.concatenate(which), np.concatenate(nodes)


def humps(roller: Rolls) -> Humps:
    """Every local maximum and minimum of the rolling resistance M over the speed.

    A rubber of widely spread relaxation times has several, one of one relaxation time a single maximum.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, and kappa are used, or a :class:`Cylinder`; numbers.

    Returns
    -------
    Humps
        ``V``, ``M`` and ``top`` as arrays of one length, of a Cylinder in m/s and N m/m; empty for an elastic
        material.

    Raises
    ------
    ParameterError
        Arrays in what rolls.

    Notes
    -----
    M is good to 1e-14, V to 1e-11 (``tests/test_steady.py``).
    """
    _, scene, scale = framed(roller, "humps")
    refuse_arrays(scene, ("alpha", "kappa"))
    law = scene.table
    assert law is not None
    if law.alpha == 1.0:
        return Humps(np.empty(0), np.empty(0), np.empty(0, dtype=bool))
    found = branches(law, 0.0)
    V, M = found.u[found.flat] / scene.kappa, found.rise[found.flat] / scene.kappa
    return Humps(V * scale["V"], M * scale["M"], np.arange(V.size) % 2 == 0)


@lru_cache(maxsize=16)
def branches(law: LawTable, gain: float) -> Branches:
    """The curve of a material and a gain.

    Raises
    ------
    ParameterError
        A gain that the nodes do not reach.
    """
    longest = float(law.retardation_time.max(initial=1.0 if law.alpha == 1.0 else 0.0))
    if gain and not _GAINS[0] <= abs(gain) / longest <= _GAINS[1]:
        low, high = (bound * longest for bound in _GAINS)
        raise ParameterError("gain on V", f"{gain:g}", f"0, or of a size in [{low:g}, {high:g}]")
    nodes = grid(law)
    flat = np.exp2(zeros(lambda x: _curve(law, gain, np.exp2(x))[1], nodes))
    u = np.exp2(nodes)
    for at in flat:
        u = u[np.abs(u - at) > _APART * at]
    whole = np.concatenate([u, flat])
    order = np.argsort(whole)
    is_flat, u = order >= u.size, whole[order]
    ends = np.concatenate([[0], np.flatnonzero(is_flat), [u.size - 1]])
    return Branches(u, _curve(law, gain, u)[0], is_flat, gain, ends[:-1].copy(), ends[1:].copy())


def grid(law: LawTable) -> Floats:
    """Nodes of log2(u), ascending: close where the material relaxes."""
    times = np.append(law.retardation_time, law.relaxation_time) if law.alpha > 1.0 else np.ones(1)
    low, high = math.floor(-math.log2(times.max())) - _MARGIN, math.ceil(-math.log2(times.min())) + _MARGIN
    parts = (low - _WIDE, low, _FAR), (low, high, _CLOSE), (high, high + _WIDE, _FAR)
    steps = [np.linspace(start, stop, (stop - start) * per, endpoint=False) for start, stop, per in parts]
    return np.concatenate([*steps, [high + _WIDE]])


def _curve(law: LawTable, gain: float, u: Floats) -> Floats:
    """kappa (M - gain V) and its slope over kappa V."""
    return rolling(law, u, "M", "dM_dV") - gain * np.stack([u, np.ones(u.size)])


def zeros(function: Function, nodes: Floats, noise: Floats | float = 0.0) -> Floats:
    """Zeros of a vectorised ``function`` between ascending ``nodes``, pairs closer than the nodes among them.

    A pair is found where |function| has a minimum at a node.  Nodes where it is not above ``noise`` have no sign.
    Zeros are bisected to rounding of the nodes.
    """
    values = function(nodes)
    known = np.abs(values) > noise
    nodes, values = nodes[known], values[known]
    parts = [(nodes, values), *_zoomed(function, nodes, values)]
    brackets = [_changes(*part) for part in parts]
    low, high, rising = (np.concatenate(each) for each in zip(*brackets, strict=True))
    for _ in range(_HALVINGS if low.size else 0):
        middle = 0.5 * (low + high)
        before = (function(middle) > 0.0) != rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.sort(0.5 * (low + high))


def _changes(x: Floats, y: Floats) -> tuple[Floats, Floats, Booleans]:
    """(low, high, whether it rises) of the intervals in which the sign changes."""
    at = np.flatnonzero(np.sign(y[1:]) * np.sign(y[:-1]) < 0.0)
    return x[at], x[at + 1], y[at + 1] > 0.0


def _zoomed(function: Function, x: Floats, y: Floats) -> list[tuple[Floats, Floats]]:
    """Points and values around two zeros between two neighbours of a node."""
    size, sign = np.abs(y), np.sign(y)
    near = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (sign[1:-1] == sign[:-2]) & (sign[1:-1] == sign[2:])
    # a parabola through three nodes reaches 0 between them where it is bent by more than that; rounding is not
    near &= size[1:-1] < size[:-2] - 2.0 * size[1:-1] + size[2:]
    found = []
    for n in np.flatnonzero(near) + 1:
        low, high = x[n - 1], x[n + 1]
        for _ in range(_ZOOMS):
            points = np.linspace(low, high, _ZOOMED)
            values = function(points)
            least = int(np.clip(np.argmin(values * sign[n]), 1, _ZOOMED - 2))
            if values[least] * sign[n] < 0.0:
                found.append((points, values))
                break
            low, high = points[least - 1], points[least + 1]
    return found
