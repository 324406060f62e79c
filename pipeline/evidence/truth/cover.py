"""Rolling on a bonded layer by boundary elements: its kernels by elasticity, wave by wave, and no spectral solve.

The surface of a layer of thickness h under tractions exp(i k x) is solved as a 4 by 4 system of Airy's function in its
thickness, f = (A + B y) e^(k (y - h)) + (C + D y) e^(-k y), at every wave number.  What it slopes beyond a half-space
decays with the wave number and is added to the elements of :mod:`.boundary` by quadrature, with the complex compliance
of the creep series.  Lengths over V T_ref.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from viscoroll.materials.prony import Prony

from .boundary import Elements, graded

Floats = NDArray[np.float64]
#: wave numbers times h up to which the layer differs from a half-space, intervals halved towards 0, and Gauss's points
_LAST, _HALVED, _POINTS, _EQUAL = 22.0, 24, 16, 12
#: Gauss's points on an element
_ON_ELEMENT = 4


class OnLayer(NamedTuple):
    """What the elements find.

    H, g, m : as of :class:`.boundary.Boundary`.  star : delta_star/(mu V).  strain : of the surface by the pressure,
    beyond that of a half-space, weighted with the pressure.  d, Q : delta/(mu V) and Q/mu of the stick zone, without
    coupling.  least : of the inequalities, over their scales.
    """

    H: float
    g: float
    m: float
    star: float
    strain: float
    d: float
    Q: float
    least: float


def kernels(u: Floats, nu: float) -> Floats:
    """L, T and C at u = k h: normal displacement by pressure, tangential by shear, tangential by pressure, over those
    of a half-space by its own traction."""
    e = np.exp(-u)
    one, nothing = np.ones_like(u), np.zeros_like(u)
    found = np.empty((3, u.size))
    # f, f', f'', f''' over powers of k, of the four terms at y = 0 and y = h (k = u, h = 1)
    at = {}
    for y, up, down in ((0.0, e, one), (1.0, one, e)):
        at[y] = [
            np.array([up, y * up, down, y * down]),
            np.array([up, (1.0 / u + y) * up, -down, (1.0 / u - y) * down]),
            np.array([up, (2.0 / u + y) * up, down, (-2.0 / u + y) * down]),
            np.array([up, (3.0 / u + y) * up, -down, (3.0 / u - y) * down]),
        ]

    def displacements(y: float) -> tuple[Floats, Floats]:
        """i u_x and u_y times 2 G/k."""
        f, f_1, f_2, f_3 = at[y]
        return (1.0 - nu) * f_2 + nu * f, -2.0 * f_1 + (1.0 - nu) * f_3 + nu * f_1

    top, bottom = displacements(1.0), displacements(0.0)
    system = np.moveaxis(np.array([*bottom, at[1.0][0], at[1.0][1]]), -1, 0)
    pressed, sheared = (
        np.moveaxis(np.array([nothing, nothing, *sides]), -1, 0) for sides in ((one, nothing), (nothing, one))
    )
    for sides in (pressed, sheared):
        terms = np.linalg.solve(system, sides[..., None])[..., 0].T
        along, across = (part * terms for part in top)
        if sides is pressed:  # f = 1/k^2 is the pressure -1
            found[0], found[2] = -across.sum(axis=0), along.sum(axis=0)
        else:
            found[1] = along.sum(axis=0)
    return found / (2.0 * (1.0 - nu)) * np.array([[1.0], [1.0], [-1.0]])


def _panels() -> tuple[Floats, Floats]:
    x, w = np.polynomial.legendre.leggauss(_POINTS)
    ends = np.concatenate([[0.0], _LAST * 2.0 ** np.arange(-_HALVED, -2.0), _LAST * np.arange(1, _EQUAL + 1) / _EQUAL])
    ends = np.unique(ends)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


class Layer:
    """A layer under elements: its kernels and the transforms of the elements, at the wave numbers of a quadrature.

    Parameters
    ----------
    p : series.  nu : Poisson's ratio.  h : thickness over V T_ref.  elements : of the contact.
    part : the layer's of the long-time compliance.
    """

    def __init__(self, p: Prony, nu: float, h: float, elements: Elements, part: float = 1.0) -> None:
        u, self.weights = _panels()
        self.k, self.h = u / h, h
        self.L, self.T, self.C = kernels(u, nu)
        series = sum(J / (1.0 - 1j * self.k * T) for J, T in zip(p.J, p.T, strict=True))
        self.compliance = part * (1.0 / p.alpha + series)
        x, w = np.polynomial.legendre.leggauss(_ON_ELEMENT)
        places = elements.nodes[:-1, None] + 0.5 * elements.lengths[:, None] * (1.0 + x)
        waves = np.exp(-1j * self.k[:, None, None] * places) * elements.lengths[:, None]
        right = waves @ (0.25 * (1.0 + x) * w)
        left = waves @ (0.5 * w) - right
        #: transforms of the hats at the inner nodes
        self.hats = right[:, :-1] + left[:, 1:]

    def slopes(self, kernel: Floats, at: Floats) -> Floats:
        """Slopes at places by tractions at the inner nodes, of a kernel over that of a half-space, which decays."""
        factor = kernel * self.weights * self.compliance / (math.pi * self.h)
        result: Floats = np.imag((np.exp(1j * at[:, None] * self.k) * factor) @ self.hats)
        return result

    def strain(self, pressure: Floats, load: float, limit: float) -> float:
        """Of the surface by the pressure, weighted with it, by C less its limit for short waves."""
        power = np.abs(self.hats @ pressure) ** 2
        whole = np.sum((self.C - limit) * self.weights / self.h * self.compliance.real * power)
        return float(-whole / (math.pi * load))


def contact(p: Prony, nu: float, z: float, theta: float, eta: float, count: int, part: float = 1.0) -> OnLayer:
    """A contact of half length z on a layer of thickness z/theta, with a stick zone of half length eta in front.

    ``part`` : the layer's of the long-time compliance; the other body is an elastic half-space.
    """
    total = Prony.creep(part * p.J, p.T, alpha=1.0 / (part / p.alpha + 1.0 - part))
    edge = z - 2.0 * eta
    behind, middle_behind = graded(-z, edge, count)
    ahead, middle_ahead = graded(edge, z, count)
    elements = Elements(total, np.concatenate([behind, ahead[1:]]))
    middle = np.concatenate([middle_behind, middle_ahead])
    layer, half = Layer(p, nu, z / theta, elements, part), sum(elements.slopes(middle))
    slopes = half + layer.slopes(layer.L - 1.0, middle)
    found = np.linalg.solve(np.column_stack([slopes, -np.ones(middle.size)]), middle)
    pressure, g = found[:-1], float(found[-1])
    load, moment = elements.moments(pressure)
    # at the front edge the kernel of pressure gives the slope of the cylinder, z + g
    star = z + g + float((layer.slopes(layer.T - layer.L, np.array([z])) @ pressure)[0])
    slopes = half + layer.slopes(layer.T - 1.0, middle)
    known = slopes[count:, :count] @ pressure[:count]
    found = np.linalg.solve(np.column_stack([slopes[count:, count:], -np.ones(count)]), -known)
    shear, d = np.concatenate([pressure[:count], found[:-1]]), float(found[-1])
    rest, slip = pressure - shear, d - slopes[:count] @ shear
    least = min(min(pressure.min(), rest[count:].min(), shear.min()) / pressure.max(), slip.min() / d)
    strain = layer.strain(pressure, load, (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu))
    return OnLayer(
        2.0 * load / math.pi, g, g + moment / load, star, strain, d, elements.moments(shear)[0] / load, least
    )


def extrapolated(
    p: Prony, nu: float, z: float, theta: float, eta: float, part: float = 1.0, count: int = 60
) -> OnLayer:
    """The same from ``count`` elements in either zone and twice as many: errors fall by 8."""
    coarse, fine = (contact(p, nu, z, theta, eta, n, part) for n in (count, 2 * count))
    both: Any = zip(coarse, fine, strict=True)
    return OnLayer(*(b + (b - a) / 7.0 for a, b in both))._replace(least=min(coarse.least, fine.least))
