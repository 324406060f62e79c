"""Parts of a flow map: piecewise polynomials, and the motions to which they are fitted.

Piecewise polynomials of one variable, one for each octave: fit, integral, value, inverse.

A scene for which a flow map is built: its contact states, and integrated motions in partial
slip.

A flow map is a set of tables from which any free motion of a scene follows without integration.
All is dimensionless.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..core import Floats
from ..kernels.motion import flow_layout
from ..kernels.motion.flow_layout import states
from ..kernels.numerics.interpolation import (
    Interpolation,
    chebyshev,
    powers_of_chebyshev,
    to_chebyshev,
)
from ..kernels.numerics.simd import TERMS
from ..kernels.records import PARTIAL_SLIP
from .motion_problem import integrate_motions

# --- Piecewise polynomials of one variable, one for each octave ---

#: limit of Newton's iteration for the inverse function
_MAX_ITERATIONS = 20
#: relative step after which the iteration ends: the error that remains is about its square
_CONVERGED = 1e-8


class Nodes:
    """Chebyshev nodes in [-1, 1], and linear maps of the values of functions there, along the last
    axis.

    An integral is fitted through its values; this drops its highest Chebyshev term, which the
    values do not determine.

    count : number of nodes.
    t : the nodes, ascending, (count,).
    """

    def __init__(self, count: int) -> None:
        rule = Interpolation(chebyshev(count))
        self.t = rule.nodes
        self._integrals = rule.integrals([*rule.exact, 1])
        self._chebyshev = to_chebyshev(count)
        self._powers = powers_of_chebyshev(count, 0.0, 1.0).T.copy()

    def powers(self, values: Floats) -> Floats:
        """Return the coefficients of the powers of t in [-1, 1] of the polynomials through values
        at the nodes.

        They are computed by way of Chebyshev coefficients, which limits the rounding errors.

        values : values at the nodes, (..., nodes).
        Returns the coefficients, ascending, (..., nodes).
        """
        return _multiply(self._powers, _multiply(self._chebyshev, values))

    def integrals(self, slopes: Floats, half: Any, start: Any = 0.0) -> Floats:
        """Return the integral of a piecewise polynomial at the nodes, continuous over all rows.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, a number, (rows,) or (..., rows).
        start : value of the integral at the left end of the first row, a number.
        Returns the integral from that end to each node plus ``start``, in the shape of ``slopes``.
        """
        whole = _multiply(self._integrals, slopes) * np.asarray(half)[..., None]
        rises = np.cumsum(whole[..., -1], axis=-1) - whole[..., -1]
        return whole[..., :-1] + (start + rises)[..., None]

    def end(self, slopes: Floats, half: Any) -> Floats:
        """Return the integral over all rows together.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, (rows,) or (..., rows).
        Returns one integral for each function, (...), a number for slopes of shape (rows, nodes).
        """
        return (_multiply(self._integrals[-1:], slopes)[..., 0] * half).sum(axis=-1)


def _multiply(matrix: Floats, values: Floats) -> Floats:
    """Return the products of a matrix with vectors along the last axis.

    BLAS is not used, as its last bits differ between machines.

    matrix : (m, n).
    values : vectors, (..., n).
    Returns the products, (..., m).
    """
    return np.einsum("...n,mn->...m", values, matrix)


NODES = Nodes(TERMS)


class Rows:
    """Consecutive intervals of one variable, the rows, with a polynomial in each.

    edges : ends of the rows, ascending, (rows + 1,).
    half : half the length of each row, (rows,).
    x : interpolation nodes of all rows, (rows, nodes).
    """

    def __init__(self, edges: Floats) -> None:
        self.edges = edges
        self.half = 0.5 * np.diff(edges)
        self.x = self.node_positions(NODES)

    def node_positions(self, nodes: Nodes) -> Floats:
        """Return interpolation nodes of all rows, (rows, nodes), ascending; nodes: :class:`Nodes`
        in [-1, 1].
        """
        return self.edges[:-1, None] + self.half[:, None] * (1.0 + nodes.t)

    def value(self, powers: Floats, x: Floats) -> Floats:
        """Evaluate a piecewise polynomial.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers).
        x : arguments, an array of any shape; beyond the ends the polynomial of the first or last
        row is continued, and an inner edge belongs to the row on its right.
        Returns the values, of the shape of x.
        """
        row = np.searchsorted(self.edges[1:-1], x, side="right")
        t = (x - self.edges[row]) / self.half[row] - 1.0
        return np.asarray(polyval(t, np.moveaxis(powers[row], -1, 0), tensor=False))

    def inverse(self, powers: Floats, target: Floats) -> Floats:
        """Return the arguments at which an increasing piecewise polynomial takes given values, by
        Newton's iteration.

        It ends when all relative steps are at most :data:`_CONVERGED`, or after
        :data:`_MAX_ITERATIONS` steps without an error.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers); its
        values are > 0.
        target : values, > 0, of any shape.
        Returns the arguments, of the shape of ``target``; the upper end of the last row for values
        beyond it; for values below those of the first row, those of its polynomial continued.
        """
        slopes = powers[:, 1:] * np.arange(1, powers.shape[1]) / self.half[:, None]
        x = np.interp(np.log(target), np.log(self.value(powers, self.x).ravel()), self.x.ravel())
        for _ in range(_MAX_ITERATIONS):
            change = (self.value(powers, x) - target) / self.value(slopes, x)
            x = np.minimum(x - change, self.edges[-1])
            if (np.abs(change) <= _CONVERGED * np.abs(x)).all():
                break
        return x


def octaves(low: int, high: int) -> Rows:
    """Return the :class:`Rows` of the high - low octaves from 2^low to 2^high; low, high: ints, low
    < high.
    """
    return Rows(np.ldexp(1.0, np.arange(low, high + 1)))


# --- A scene for which a flow map is built ---

#: Reason: the rolling resistance exceeds the friction.
STOPS = "the sliding cylinder can reach a steady speed"
#: Reason: a motion of the slow manifold leaves partial slip.
FULL_SLIP_RETURNS = "full slip returns"
#: Reason: a motion of a boundary layer leaves partial slip.
STICK_ENDS = "the cylinder can return from partial slip to full slip"
#: Reason: numbers that are not finite.
OUT_OF_RANGE = "its speeds or times exceed the range of double precision"

#: Octaves of the tables over kappa V.
SPEEDS = octaves(flow_layout.LOW, flow_layout.HIGH)


class NoFlowMap(Exception):
    """The scene has no flow map; the message is the reason."""


class FlowProblem(NamedTuple):
    """A scene for which a map is made.

    parameters : (material, kappa, mu, j), numbers; the material is alpha, or a :class:`Prony`
    series in its own unit of time.
    law : the kernels' record of the contact law of the material.
    slow_rate : rate at which ln V falls at low speeds, in units of gamma, > 0.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    """

    parameters: tuple[Any, ...]
    law: Any
    slow_rate: float
    threads: int | None

    def contact_states(self, V: Floats, delta: Floats) -> Floats:
        """Return critical creepage, moment, traction and its slope at speeds and creepages inside
        the stick zone.

        V, delta : speeds, > 0, and creepages, |delta| < delta_star, dimensionless, of one shape.
        Returns (4, ...), dimensionless, in this order, each in the shape of V: delta_star, M, Q
        with the sign of delta (0 at delta = 0), dQ/d delta at fixed V; :mod:`.flow_layout`
        names the indices.
        """
        _, kappa, mu, _ = self.parameters
        out = np.empty((4, V.size))
        states(
            np.ascontiguousarray(V).ravel(),
            np.ascontiguousarray(delta).ravel(),
            kappa,
            mu,
            self.law,
            out,
        )
        return out.reshape(4, *V.shape)

    def integrate(
        self, V: Floats, delta: Floats, gamma: Floats, t: Floats, reason: str
    ) -> tuple[Floats, Floats]:
        """Integrate motions that start and stay in partial slip, or start just before its onset.

        V, delta : start speeds, > 0 (not checked), and creepages, (n,), n >= 1, dimensionless.
        gamma : ratio of the load to inertia, which sets the time scale, of each motion, > 0, (n,)
        or (1,).
        t : output times since the start, >= 0, ascending, (times,), common to all, dimensionless;
        the tables count the time gamma t, so that t is the time of the tables divided by the gamma
        of each motion.
        reason : message of :class:`NoFlowMap` if a motion is not in partial slip with V > 0 at an
        output time.
        Raises :class:`NoFlowMap` for this reason, which includes motions that could not be
        integrated to the end; and for OUT_OF_RANGE if V, delta, gamma, their product or t is not
        finite, or gamma is not positive.
        Returns (V, delta), each (n, times), dimensionless.
        """
        if not (
            np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()
        ):
            raise NoFlowMap(OUT_OF_RANGE)
        starts = V, V * (1.0 + delta)
        (V, _, _, _, delta, regime, *_), _ = integrate_motions(
            self.parameters, starts, gamma, t, threads=self.threads
        )
        if not ((regime == PARTIAL_SLIP) & (V > 0.0)).all():
            raise NoFlowMap(reason)
        return V, delta
