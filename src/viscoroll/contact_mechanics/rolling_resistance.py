"""Rolling resistance over speed: extrema of M(V), and the branches between them on which M(V) is
inverted.

With M over P R and kappa = R/l0, kappa M is a function of u = kappa V alone for a material.  A gain
G on the speed turns M(V) = load into M(V) - G V = load, the same problem with another curve.  All
is dimensionless unless units are named; a law is a :class:`LawTable`, the rows of one material.
"""

import functools
import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..core import Booleans, Floats, Integers, described_error
from ..laws import LawTable
from .contact_table import pure_rolling_fields
from .model_warnings import warn_of_contact
from .parameters import Roller, refuse_arrays, resolve_model

#: octaves of u on either side of the rates of a material with closely spaced nodes
_CLOSE_OCTAVES = 15
#: octaves of u beyond these with wide spacing: the curve has at most one simple extremum there
_FAR_OCTAVES = 446
#: octaves between nodes, closely spaced
_CLOSE_STEP = 1.0 / 16.0
#: octaves between nodes, widely spaced
_FAR_STEP = 0.5
#: relative distance in u within which an extremum replaces other nodes
_SEPARATION = 1e-6
#: range of a gain divided by the longest retardation time
_GAIN_RANGE = (1e-40, 1e8)
#: distance from a zero at which it is found, relative and absolute: rounding
_ZERO_TOLERANCE = {"xrtol": 1e-15, "xatol": 1e-16}


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


class Branches(NamedTuple):
    """The curve kappa (M - G V) over u = kappa V at nodes, and its branches, on each of which it
    rises or falls throughout.

    The branches lie between the first node, the extrema and the last node.  G is a gain on the
    speed, as for a feedback.
    u : nodes of kappa V, ascending, (n,).
    resistance : kappa (M - G V) at the nodes, (n,).
    extremum : whether a node is a local extremum of the curve, (n,).
    gain : G.
    maximum : (largest value of the curve at a node, u of that node, of equal ones the first),
        floats; without a gain that is the maximum of kappa M, for elastic bodies 0.
    """

    u: Floats
    resistance: Floats
    extremum: Booleans
    gain: float
    maximum: tuple[float, float]

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
        for first, last in itertools.pairwise([0, *self.extremum.nonzero()[0], self.u.size - 1]):
            # searchsorted needs rising values: a falling branch is searched with the other sign
            rising = self.resistance[last] > self.resistance[first]
            sign = 1.0 if rising else -1.0
            values = sign * self.resistance[first : last + 1]
            wanted = sign * load
            inside = (wanted > values[0]) & (wanted < values[-1])
            if self.extremum[first]:
                inside &= np.abs(wanted - values[0]) > tolerance
            if self.extremum[last]:
                inside |= np.abs(wanted - values[-1]) <= tolerance
            index = inside.nonzero()[0]
            above = values.searchsorted(wanted[index], "right" if rising else "left")
            indices.append(index)
            nodes.append(first + np.minimum(np.maximum(above - 1, 0), last - first - 1))
        return np.concatenate(indices), np.concatenate(nodes)


def resistance_extrema(roller: Roller) -> ResistanceExtrema:
    """Find every local maximum and minimum of the rolling resistance moment M of a cylinder over
    its speed.

    They bound the loads under which it can roll steadily: M rises from 0 and falls to 0 again.  For
    one relaxation time it is Eq. (16) of Zobova and Goryacheva (2020), with one maximum; widely
    separated times give several.  Of layers, and of half-spaces with Dundurs' constant above 0.05,
    M is that of the fast law without creep force, also where :func:`contact` takes the coupled
    solution; of a table or a grid that was given as the law it is that of the table.

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
    found = branches(law, 0.0)
    V = found.u[found.extremum] / scene.kappa * scale["V"]
    M = found.resistance[found.extremum] / scene.kappa * scale["M"]
    warn_of_contact(roller, V)
    # M rises from 0: the first extremum is a maximum, and both kinds alternate
    return ResistanceExtrema(V, M, is_maximum=np.arange(V.size) % 2 == 0)


@functools.lru_cache(maxsize=16)
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
    longest = law.retardation_time.max(initial=1.0 if law.alpha == 1.0 else 0.0)
    low, high = (bound * longest for bound in _GAIN_RANGE)
    if gain and not low <= abs(gain) <= high:
        # in units that are 1 in a scene
        raise described_error(
            "the gain V= of a Feedback (that of force plus that of torque divided by R)",
            f"is {gain:g} times load T_ref/R (T_ref: unit of time)",
            f"0, or in magnitude {low:g} to {high:g} times load T_ref/R",
        )
    nodes = speed_nodes(law)
    flat = np.exp2(find_zeros(lambda x: _curve(law, gain, np.exp2(x))[1], nodes))
    u = np.exp2(nodes)
    for at in flat:
        u = u[np.abs(u - at) > _SEPARATION * at]
    u = np.union1d(u, flat)
    resistance = _curve(law, gain, u)[0]
    n = resistance.argmax()
    return Branches(
        u=u,
        resistance=resistance,
        extremum=np.isin(u, flat),
        gain=gain,
        maximum=(resistance[n], u[n]),
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
    return np.concatenate(
        [
            np.arange(low - _FAR_OCTAVES, low, _FAR_STEP),
            np.arange(low, high, _CLOSE_STEP),
            np.arange(high, high + _FAR_OCTAVES + _FAR_STEP, _FAR_STEP),
        ]
    )


def _curve(law: LawTable, gain: float, u: Floats) -> Floats:
    """Return the curve kappa (M - gain V) and its slope over u at u = kappa V > 0, (n,), as two
    rows, (2, n).
    """
    return pure_rolling_fields(law, u, "M", "dM_dV") - gain * np.stack([u, np.ones(u.size)])


def find_zeros(
    function: Callable[[Floats], Floats], nodes: Floats, noise: Floats | float = 0.0
) -> Floats:
    """Find the zeros of a function between nodes, including pairs of zeros between neighbouring
    nodes, as :func:`zeros_between` does.

    function : takes points (m,) and returns its values there, (m,).
    nodes : points, ascending, (n,).
    noise : rounding error of the function at the nodes, absolute, a number or (n,); nodes with
        values no larger than it have no sign and are left out, so that with 0 a zero at a node is
        found between its neighbours.
    Returns the zeros, ascending, (zeros,), to the rounding of the nodes; empty if there are none.
    """
    values = function(nodes)
    signed = np.abs(values) > noise
    return zeros_between(
        lambda x, _: function(x),
        nodes[None, signed],
        values[None, signed],
        np.broadcast_to(noise, nodes.shape)[signed],
    )[1]


def zeros_between(
    function: Callable[[Floats, Integers], Floats],
    x: Floats,
    y: Floats,
    noise: Floats | float = 0.0,
) -> tuple[Integers, Floats, Booleans]:
    r"""Find the zeros of several functions between their nodes, including pairs of zeros between
    neighbouring nodes.

    A zero lies where a function changes its sign between two nodes.  Two zeros between neighbouring
    nodes are found where \|y\| has a minimum at a node near which a parabola reaches 0, and the
    function has the other sign at the extremum there; zeros at which it only touches 0 are not
    found.

    function : takes points and the index of the function of each, (m,) each, and returns the
        values, (m,).
    x : nodes, ascending along the last axis, (functions, nodes); an extremum that separates two
        zeros takes the place of its node.
    y : values at the nodes, none of them 0, (functions, nodes), changed likewise.
    noise : rounding error of the values, absolute, broadcast with y: no smaller value at an
        extremum counts as one of the other sign.
    Returns (index of the function; zero, by function and ascending, to the rounding of x; whether
    the function falls there), (zeros,) each.
    """
    from scipy.optimize import elementwise

    n, k = _extrema(y)
    if n.size:
        sign = np.sign(y[n, k])
        found = elementwise.find_minimum(
            lambda x, n, sign: sign * function(x, n),
            (x[n, k - 1], x[n, k], x[n, k + 1]),
            args=(n, sign),
        )
        other = found.f_x < -np.broadcast_to(noise, y.shape)[n, k]
        n = n[other]
        k = k[other]
        x[n, k] = found.x[other]
        y[n, k] = (sign * found.f_x)[other]
    positive = y > 0.0
    n, k = (positive[:, 1:] != positive[:, :-1]).nonzero()
    found = elementwise.find_root(
        function, (x[n, k], x[n, k + 1]), args=(n,), tolerances=_ZERO_TOLERANCE
    )
    # a node whose value is rounding may have the other sign here: the zero is at that node
    return n, np.where(found.success, found.x, found.bracket[0]), positive[n, k]


def _extrema(y: Floats) -> tuple[Integers, Integers]:
    r"""Return the nodes at which \|y\| has a minimum near which a parabola through three nodes
    reaches 0; y has one sign at the three, of which rounding errors have no such parabola.

    y: values of functions, (functions, nodes).
    Returns (rows, columns) of these nodes, (m,) each.
    """
    size = np.abs(y)
    before, at, after = (size[:, k : y.shape[1] - 2 + k] for k in range(3))
    near = (at <= before) & (at <= after) & (at < np.abs(np.diff(y, 2)))
    one_sign = np.diff(np.sign(y), axis=1) == 0.0
    n, k = (near & one_sign[:, 1:] & one_sign[:, :-1]).nonzero()
    return n, k + 1
