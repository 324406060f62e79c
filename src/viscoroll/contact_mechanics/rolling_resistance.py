"""Rolling resistance over speed: extrema of M(V), and the branches between them on which M(V) is
inverted.

With M over P R and kappa = R/l0, kappa M is a function of u = kappa V alone for a material.  A gain
G on the speed turns M(V) = load into M(V) - G V = load, the same problem with another curve.  All
is dimensionless unless units are named; a law is a :class:`LawTable`, the rows of one material.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..core import Booleans, Floats, Integers, ParameterError
from ..laws import LawTable
from .contact_table import pure_rolling_fields
from .model_warnings import warn_of_contact
from .parameters import Roller, refuse_arrays, resolve_model

#: octaves of u on either side of the rates of a material with closely spaced nodes
_CLOSE_OCTAVES = 15
#: octaves of u beyond these with wide spacing: the curve has at most one simple extremum there
_FAR_OCTAVES = 446
#: nodes in an octave, closely spaced
_CLOSE_NODES = 16
#: nodes in an octave, widely spaced
_FAR_NODES = 2
#: relative distance in u within which an extremum replaces other nodes
_SEPARATION = 1e-6
#: least size of kappa times a load, other than 0, for which the nodes have a crossing
LEAST_LOAD = 1e-120
#: largest size of kappa times a load
MOST_LOAD = 1e80
#: range of a gain divided by the longest retardation time
_GAIN_RANGE = (1e-40, 1e8)
#: bisections after which a bracket has the width of rounding
_BISECTIONS = 62
#: refinements of an interval in which a function approaches 0 and turns back
_REFINEMENTS = 4
#: points of such a refinement
_REFINED_NODES = 33

Function = Callable[[Floats], Floats]


class ResistanceExtrema(NamedTuple):
    """Every local maximum and minimum of M(V) for V > 0, by rising V; the first and the last are
    maxima.

    Maxima and minima alternate; an elastic material has none.

    V : speeds, (n,), of a cylinder in m/s, of a scene divided by R/T_ref.
    M : rolling resistance moments there, (n,), of a cylinder in N m/m, of a scene divided by P R.
    is_maximum : whether it is a maximum, else a minimum, (n,).
    """

    V: Floats
    M: Floats
    is_maximum: Booleans


@dataclass(frozen=True)
class Branches:
    """The curve kappa (M - G V) over u = kappa V at nodes, and its branches, on each of which it
    rises or falls throughout.

    The branches lie between the first node, the extrema and the last node.  G is a gain on the
    speed, as for a feedback.
    u : nodes of kappa V, ascending, (n,).
    resistance : kappa (M - G V) at the nodes, (n,).
    extremum : whether a node is a local extremum of the curve, (n,).
    gain : G.
    first, last : indices of the nodes at the ends of each branch, (branches,).
    """

    u: Floats
    resistance: Floats
    extremum: Booleans
    gain: float
    first: Integers
    last: Integers

    @cached_property
    def curve(self) -> Any:
        """The nodes as the record that kernels take."""
        from ..kernels.law.law_functions import LoadCurve

        return LoadCurve(self.u, self.resistance, self.extremum, self.gain)

    @cached_property
    def maximum(self) -> tuple[float, float]:
        """Return (largest value of the curve at a node, u of that node, of equal ones the first),
        floats; without a gain that is the maximum of kappa M, for elastic bodies 0.
        """
        n = int(np.argmax(self.resistance))
        return float(self.resistance[n]), float(self.u[n])

    def locate_loads(self, load: Floats) -> tuple[Integers, Integers]:
        """Locate the intervals between nodes in which the curve takes given values, as brackets for
        a root solve.

        load : values of kappa (M - G V), dimensionless, any sign, (n,).
        Returns (index of the load; index of the node below the crossing, which lies between that
        node and the next one), one entry for each crossing, (crossings,) each, integers, branch by
        branch.  A load has none to many: none if it is outside the values of the curve at the
        nodes, or equal to the value at the first or the last node.  A load within 1e-15 of an
        extremum, relative, has one crossing there, on the branch that ends at the extremum.
        """
        from ..kernels.law.law_functions import EXTREMUM_RTOL

        indices = []
        nodes = []
        tolerance = EXTREMUM_RTOL * np.abs(load)
        for first, last in zip(self.first.tolist(), self.last.tolist(), strict=True):
            values = self.resistance[first : last + 1]
            rising = values[-1] > values[0]
            low, high = (values[0], values[-1]) if rising else (values[-1], values[0])
            inside = (load > low) & (load < high)
            if self.extremum[first]:
                inside &= np.abs(load - values[0]) > tolerance
            if self.extremum[last]:
                inside |= np.abs(load - values[-1]) <= tolerance
            # searchsorted needs rising values: a falling branch is searched with the other sign
            indices.append(index := inside.nonzero()[0])
            above = (
                values.searchsorted(load[index], "right")
                if rising
                else (-values).searchsorted(-load[index])
            )
            nodes.append(first + np.minimum(np.maximum(above - 1, 0), last - first - 1))
        return np.concatenate(indices), np.concatenate(nodes)


def resistance_extrema(roller: Roller) -> ResistanceExtrema:
    """Find every local maximum and minimum of the rolling resistance moment M of a cylinder over
    its speed.

    They bound the loads under which it can roll steadily: M rises from 0 and falls to 0 again.  For
    one relaxation time it is Eq. (16) of Zobova and Goryacheva (2020), with one maximum; widely
    separated times give several.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material and kappa are used, or a
        :class:`Cylinder`; alpha, material and kappa must be single: of a Cylinder R, E, nu,
        T_epsilon, T_sigma and load, or without a load m and g; mu and the others may be arrays.

    Returns
    -------
    ResistanceExtrema
        Named tuple of ``V``, the speeds > 0, ascending, ``M``, the moments there, and
        ``is_maximum``, true for a maximum and false for a minimum, arrays of one length; of a
        Cylinder V is in m/s and M in N m/m, of a Scene they are divided by R/T_ref (T_ref is its
        unit of time) and P R.  M is odd in V.  Empty arrays for elastic bodies.

    Raises
    ------
    ParameterError
        Arrays in alpha, kappa or material; no scene or cylinder; a layer too thin, times beyond
        1e-100 to 1e100 T_ref.

    Notes
    -----
    M is accurate to 1e-14, V to 1e-11 (``tests/test_steady.py``).

    Examples
    --------
    >>> import viscoroll as vr
    >>> extrema = vr.resistance_extrema(vr.presets.RUBBER_CYLINDER)
    >>> extrema.is_maximum[0]
    np.True_
    """
    _, scene, scale = resolve_model(roller, "resistance_extrema")
    refuse_arrays(roller, scene, ("alpha", "kappa"))
    law = scene.table
    assert law is not None
    if law.alpha == 1.0:
        return ResistanceExtrema(np.empty(0), np.empty(0), np.empty(0, dtype=bool))
    found = branches(law, 0.0)
    V = found.u[found.extremum] / scene.kappa
    M = found.resistance[found.extremum] / scene.kappa
    warn_of_contact(roller, V * scale["V"])
    # M rises from 0: the first extremum is a maximum, and both kinds alternate
    return ResistanceExtrema(V * scale["V"], M * scale["M"], np.arange(V.size) % 2 == 0)


@lru_cache(maxsize=16)
def branches(law: LawTable, gain: float) -> Branches:
    """Return the curve kappa (M - G V) over speed, divided into branches on which it is monotone.

    law : table of the material.
    gain : G, slope of the load in V, dimensionless, any sign; 0 for a load that does not depend on
    V.
    Returns the :class:`Branches` for u > 0, which are kept for the next call (the last 16).  The
    nodes are those of :func:`speed_nodes`, of which those within 1e-6, relative, of an extremum
    give way to it.  Without an extremum, as for elastic bodies, there is one branch over all nodes.

    Raises
    ------
    ParameterError
        A gain other than 0 whose size, over the longest retardation time (elastic: 1), is not in
        :data:`_GAIN_RANGE`.
    """
    longest = float(law.retardation_time.max(initial=1.0 if law.alpha == 1.0 else 0.0))
    if gain and not _GAIN_RANGE[0] <= abs(gain) / longest <= _GAIN_RANGE[1]:
        low, high = (bound * longest for bound in _GAIN_RANGE)
        raise ParameterError("gain on V", f"{gain:g}", f"0, or {low:g} to {high:g} in magnitude")
    nodes = speed_nodes(law)
    flat = np.exp2(find_zeros(lambda x: _curve(law, gain, np.exp2(x))[1], nodes))
    u = np.exp2(nodes)
    for at in flat:
        u = u[np.abs(u - at) > _SEPARATION * at]
    whole = np.concatenate([u, flat])
    order = np.argsort(whole)
    # extrema were put behind the nodes
    is_flat = order >= u.size
    u = whole[order]
    ends = np.concatenate([[0], np.flatnonzero(is_flat), [u.size - 1]])
    return Branches(
        u=u,
        resistance=_curve(law, gain, u)[0],
        extremum=is_flat,
        gain=gain,
        first=ends[:-1].copy(),
        last=ends[1:].copy(),
    )


def speed_nodes(law: LawTable) -> Floats:
    """Return nodes of log2(u), u = kappa V, closely spaced where the material relaxes.

    law : table of the material, of which alpha and both forms of the times, in T_ref, are read.
    Returns the nodes, ascending, (n,): 16 in an octave from 15 octaves below to 15 octaves above
    the rates of the modes, of an elastic material around u = 1; 2 in an octave for 446 octaves
    beyond on either side.
    """
    times = np.append(law.retardation_time, law.relaxation_time) if law.alpha > 1.0 else np.ones(1)
    low = math.floor(-math.log2(times.max())) - _CLOSE_OCTAVES
    high = math.ceil(-math.log2(times.min())) + _CLOSE_OCTAVES
    ends = low - _FAR_OCTAVES, low, high, high + _FAR_OCTAVES
    densities = _FAR_NODES, _CLOSE_NODES, _FAR_NODES
    parts = [
        np.linspace(start, stop, (stop - start) * density, endpoint=False)
        for (start, stop), density in zip(pairwise(ends), densities, strict=True)
    ]
    return np.concatenate([*parts, ends[-1:]])


def _curve(law: LawTable, gain: float, u: Floats) -> Floats:
    """Return the curve kappa (M - gain V) and its slope over u at u = kappa V > 0, (n,), as two
    rows, (2, n).
    """
    return pure_rolling_fields(law, u, "M", "dM_dV") - gain * np.stack([u, np.ones(u.size)])


def find_zeros(function: Function, nodes: Floats, noise: Floats | float = 0.0) -> Floats:
    """Find the zeros of a function between nodes, including pairs of zeros between neighbouring
    nodes.

    function : takes points (m,) and returns its values there, (m,).
    nodes : points, ascending, (n,).
    noise : rounding error of the function at the nodes, absolute, a number or (n,); nodes with
        values no larger than it have no sign and are left out, so that with 0 a zero at a node is
        found between its neighbours.
    Returns the zeros, ascending, (zeros,), to the rounding of the nodes; empty if there are none.
    They are bisected from the changes of sign between nodes.  A pair of zeros without such a change
    is found if |function| has a minimum at a node and points nearby show the other sign; a zero at
    which the function touches 0 is not found.
    """
    values = function(nodes)
    signed = np.abs(values) > noise
    nodes = nodes[signed]
    values = values[signed]
    parts = [(nodes, values), *_refine_near_double_roots(function, nodes, values)]
    brackets = [_sign_changes(*part) for part in parts]
    low, high, rising = (np.concatenate(each) for each in zip(*brackets, strict=True))
    for _ in range(_BISECTIONS if low.size else 0):
        middle = 0.5 * (low + high)
        # the middle has the sign of the lower end
        before = (function(middle) > 0.0) != rising
        low = np.where(before, middle, low)
        high = np.where(before, high, middle)
    return np.sort(0.5 * (low + high))


def _sign_changes(x: Floats, y: Floats) -> tuple[Floats, Floats, Booleans]:
    """Find the intervals between points in which a function changes its sign.

    x: points, ascending, (n,).
    y: values of the function there, (n,); an interval with the value 0 at an end counts as none.
    Returns (lower ends, upper ends, whether the function rises), (intervals,) each.
    """
    at = np.flatnonzero(np.sign(y[1:]) * np.sign(y[:-1]) < 0.0)
    return x[at], x[at + 1], y[at + 1] > 0.0


def _refine_near_double_roots(
    function: Function, x: Floats, y: Floats
) -> list[tuple[Floats, Floats]]:
    """Find points that separate two zeros between the neighbours of a node, where the nodes show no
    change of sign.

    Candidates are the nodes with a local minimum of |function| near which a parabola through three
    nodes passes 0, the first and the last node excepted.  The interval around each is divided into
    32 and narrowed around the point nearest to the other sign, four times at most.
    function : takes points (m,) and returns its values there, (m,).
    x, y : nodes, ascending, and values of the function there, none of them 0, (n,); n may be 0.
    Returns a list of (points, values), (33,) each, one for each pair of zeros that was separated:
    the values have one sign at both ends and the other one between them.  Empty if none was; zeros
    that only touch 0 are not found.
    """
    size = np.abs(y)
    sign = np.sign(y)
    minimum = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
    minimum &= (sign[1:-1] == sign[:-2]) & (sign[1:-1] == sign[2:])
    # A parabola through three nodes reaches 0 between them if its second difference exceeds the
    # value at the node; rounding errors have no such difference.
    minimum &= size[1:-1] < size[:-2] - 2.0 * size[1:-1] + size[2:]
    found = []
    for n in np.flatnonzero(minimum) + 1:
        low = x[n - 1]
        high = x[n + 1]
        for _ in range(_REFINEMENTS):
            points = np.linspace(low, high, _REFINED_NODES)
            values = function(points)
            # nearest to the other sign; not an end, so that a point is left on either side
            least = int(np.clip(np.argmin(values * sign[n]), 1, _REFINED_NODES - 2))
            if values[least] * sign[n] < 0.0:
                found.append((points, values))
                break
            low = points[least - 1]
            high = points[least + 1]
    return found
