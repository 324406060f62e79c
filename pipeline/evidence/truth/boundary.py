"""Contact by boundary elements: no Bessel function, no second form of the material, no superposition of two contacts.

Lengths over V T_ref, Y ahead of the middle of the contact.  Pressure p and shear q over mu are linear in elements that
are graded to the edges.  Each slopes the surface by the point load that moves along it, whose creep it leaves behind:

    u'(Y) = int p(y) k(Y - y) dy      pi k(x) = J(0)/x + sum J_j b_j f(b_j x)      f(X) = PV int_0^inf e^-s/(X + s) ds

Contact: u_p' = Y + g at the middles of the elements, p = 0 at both ends, which finds g too.  Friction: q = p behind the
stick zone, u_q' = d in it, the same at every place, which finds d = delta/(mu V).  (G. M. L. Gladwell, Contact problems
in the classical theory of elasticity, 1980, for the elastic kernel.)
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import exp1, expi

from viscoroll.materials.prony import Prony

#: from here on f is its asymptotic series, of so many terms
_FAR, _TERMS = 50.0, 30


class Boundary(NamedTuple):
    """What the elements find.

    H, g, m : load over pi/2, distance of the axis behind the middle, M/V
    shares : of each creep mode in m, slowest first
    d, Q : creep over mu V, and friction over mu
    least : least of p, p - q and q inside, over the largest p, and of the slip behind the stick zone over d: where all
        are positive, no inequality is hurt
    """

    H: float
    g: float
    m: float
    shares: NDArray[np.float64]
    d: float
    Q: float
    least: float


def _memory(X: NDArray[np.float64]) -> NDArray[np.float64]:
    """f(X) + ln|X|, whose slope is f; finite at 0."""
    size, found = np.abs(X), np.full(X.shape, -np.euler_gamma)
    far, near = size > _FAR, (size > 0.0) & (size <= _FAR)
    x = X[near]
    inside = np.where(x > 0.0, np.exp(x) * exp1(np.abs(x)), -np.exp(x) * expi(np.where(x > 0.0, -1.0, -x)))
    found[near] = inside + np.log(size[near])
    term = 1.0 / X[far]
    total, ratio = term.copy(), -term
    for n in range(1, _TERMS):
        term = term * (n * ratio)
        total += term
    found[far] = total + np.log(size[far])
    return found


def _twice(X: NDArray[np.float64]) -> NDArray[np.float64]:
    """Second antiderivative of 1/X, but for what is linear: X ln|X| - X."""
    return X * np.log(np.where(X == 0.0, 1.0, np.abs(X))) - X


class Elements:
    """Elements between nodes, and the slopes that slope jumps of a traction at the nodes make at some places.

    Parameters
    ----------
    p : the material.
    nodes : ends of the elements, ascending.
    """

    def __init__(self, p: Prony, nodes: NDArray[np.float64]) -> None:
        self.p, self.nodes, self.lengths = p, nodes, np.diff(nodes)
        count = nodes.size
        self._jumps = np.zeros((count, count - 2))
        for n in range(count - 2):
            before, behind = 1.0 / self.lengths[n], 1.0 / self.lengths[n + 1]
            self._jumps[n : n + 3, n] = before, -before - behind, behind

    def slopes(self, at: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """u' at places, of tractions at the inner nodes: what is elastic, and of each creep mode."""
        apart = at[:, None] - self.nodes[None, :]
        scaled = ((J * T, apart / T) for J, T in zip(self.p.J, self.p.T, strict=True))
        parts = [_twice(apart) / self.p.alpha, *(size * (_memory(X) + _twice(X)) for size, X in scaled)]
        return [part @ self._jumps / math.pi for part in parts]

    def moments(self, values: NDArray[np.float64]) -> tuple[float, float]:
        """Integral and first moment of a traction with these values at the inner nodes."""
        inside, h, left = np.concatenate([[0.0], values, [0.0]]), self.lengths, self.nodes[:-1]
        a, b = inside[:-1], inside[1:]
        return float(h @ (a + b)) / 2.0, float(h @ (left * (a + b) / 2.0 + h * (a + 2.0 * b) / 6.0))


def graded(first: float, last: float, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(Nodes from ``first`` to ``last``, dense at both, places between them)."""
    steps = np.arange(2 * count + 1) * (math.pi / (4 * count))
    along = first + (last - first) * np.sin(steps) ** 2
    along[-1] = last
    return along[::2], along[1::2]


def contact(p: Prony, z: float, eta: float, count: int = 100) -> Boundary:
    """A contact of half length z with a stick zone of half length 0 < eta < z in front.

    Parameters
    ----------
    p : material, J at least 0.
    z, eta : half lengths over V T_ref.
    count : elements in either zone.

    Returns
    -------
    Boundary
        Off by what falls with the power 2 of 1/count and more.
    """
    edge = z - 2.0 * eta
    behind, middle_behind = graded(-z, edge, count)
    ahead, middle_ahead = graded(edge, z, count)
    elements = Elements(p, np.concatenate([behind, ahead[1:]]))
    middle = np.concatenate([middle_behind, middle_ahead])
    parts = elements.slopes(middle)
    slopes = sum(parts)
    found = np.linalg.solve(np.column_stack([slopes, -np.ones(middle.size)]), middle)
    pressure, g = found[:-1], float(found[-1])
    load, moment = elements.moments(pressure)
    # what is elastic does no work on the way: the pressure is its own mirror image to it
    between = elements.lengths * np.convolve(pressure, [0.5, 0.5])
    shares = np.array([between @ part @ pressure for part in parts[1:]]) / load
    # inner nodes up to the edge of the stick zone, which has no node of its own in front
    inside = slopes[count:, count:]
    known = slopes[count:, :count] @ pressure[:count]
    found = np.linalg.solve(np.column_stack([inside, -np.ones(count)]), -known)
    shear, d = np.concatenate([pressure[:count], found[:-1]]), float(found[-1])
    slip = d - slopes[:count] @ shear
    rest = pressure - shear
    least = min(pressure.min(), rest[count:].min(), shear.min()) / pressure.max()
    slipped = float(min(least, slip.min() / d))
    return Boundary(2.0 * load / math.pi, g, g + moment / load, shares, d, elements.moments(shear)[0] / load, slipped)


def extrapolated(p: Prony, z: float, eta: float, count: int = 50) -> Boundary:
    """The same from ``count`` elements and twice as many: once the layers are resolved, errors are as 8 to 1, those of
    the shares, which a midpoint rule integrates, as 4 to 1.
    """
    coarse, fine = contact(p, z, eta, count), contact(p, z, eta, 2 * count)
    both: Any = zip(coarse, fine, strict=True)
    shares, least = fine.shares + (fine.shares - coarse.shares) / 3.0, min(coarse.least, fine.least)
    return Boundary(*(b + (b - a) / 7.0 for a, b in both))._replace(shares=shares, least=least)
