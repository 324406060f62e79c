"""Make check_elements.json: steady contacts by boundary elements, on half-spaces and on layers of
finite thickness.

    python -m data.reference.check_elements [-o FILE]        in some ten minutes

There is no Bessel function, no second form of the material, no superposition of two contacts.
Lengths over V T_ref, Y ahead of the middle of the contact.  Pressure p and shear q over mu are
linear in elements that are graded to the edges.  Each slopes the surface by the point load that
moves along it, whose creep it leaves behind:

    u'(Y) = int p(y) k(Y - y) dy      pi k(x) = J(0)/x + sum J_j b_j f(b_j x)      f(X) = PV int_0^inf e^-s/(X + s) ds

Contact: u_p' = Y + g at the middles of the elements, p = 0 at both ends, which finds g too.
Friction: q = p behind the stick zone, u_q' = d in it, the same at every place, which finds d =
delta/(mu V).  (G. M. L. Gladwell, Contact problems in the classical theory of elasticity, 1980, for
the elastic kernel.)

The surface of a layer of thickness h under tractions exp(i k x) is solved as a 4 by 4 system of
Airy's function in its thickness, f = (A + B y) e^(k (y - h)) + (C + D y) e^(-k y), at every wave
number.  What it slopes beyond a half-space decays with the wave number and is added to the elements
by quadrature, with the complex compliance of the creep series.

The package places the states: its half lengths are the elements', which find load, offset, moment,
creep and friction.
"""  # noqa: E501

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import exp1, expi
from tqdm import tqdm

import viscoroll as vr
from viscoroll.materials.prony import Prony

Floats = NDArray[np.float64]
TARGET = Path(__file__).with_suffix(".json")
#: Seed of the states, and how many there are of bodies, of covers, and of covers of free creep.
SEED = 20412
BODIES = 200
COVERS = 60
#: Elements in either zone, and twice as many, of bodies.
_ELEMENTS = 60
#: Materials of the covers.
MATERIALS = (vr.Prony([10.0], [1.0 / 11.0]), vr.Prony([2.0, 6.0, 3.0], [1.0, 0.1, 0.003]))
#: kappa and mu of the covers.
KAPPA = 10.0
MU = 0.5
#: Thickness over l0, kappa V, and the share of the stick zone, of the covers.
_THICKNESS = (0.2, 20.0)
_SPEEDS = (0.05, 4.0)
_STICK = (0.1, 0.9)

#: from here on f is its asymptotic series, of so many terms
_FAR, _TERMS = 50.0, 30


class Boundary(NamedTuple):
    """What the elements find.

    H, g, m : load over pi/2, distance of the axis behind the middle, M/V
    shares : of each creep mode in m, slowest first
    d, Q : creep over mu V, and friction over mu
    least : least of p, p - q and q inside, over the largest p, and of the slip behind the stick
        zone over d: where all are positive, no inequality is hurt
    """

    H: float
    g: float
    m: float
    shares: Floats
    d: float
    Q: float
    least: float


def _memory(X: Floats) -> Floats:
    """f(X) + ln|X|, whose slope is f; finite at 0."""
    size, found = np.abs(X), np.full(X.shape, -np.euler_gamma)
    far, near = size > _FAR, (size > 0.0) & (size <= _FAR)
    x = X[near]
    inside = np.where(
        x > 0.0, np.exp(x) * exp1(np.abs(x)), -np.exp(x) * expi(np.where(x > 0.0, -1.0, -x))
    )
    found[near] = inside + np.log(size[near])
    term = 1.0 / X[far]
    total, ratio = term.copy(), -term
    for n in range(1, _TERMS):
        term = term * (n * ratio)
        total += term
    found[far] = total + np.log(size[far])
    return found


def _twice(X: Floats) -> Floats:
    """Second antiderivative of 1/X, but for what is linear: X ln|X| - X."""
    return X * np.log(np.where(X == 0.0, 1.0, np.abs(X))) - X


class Elements:
    """Elements between nodes, and the slopes that slope jumps of a traction at the nodes make at
    some places.

    Parameters
    ----------
    p : the material.
    nodes : ends of the elements, ascending.
    """

    def __init__(self, p: Prony, nodes: Floats) -> None:
        self.p, self.nodes, self.lengths = p, nodes, np.diff(nodes)
        count = nodes.size
        self._jumps = np.zeros((count, count - 2))
        for n in range(count - 2):
            before, behind = 1.0 / self.lengths[n], 1.0 / self.lengths[n + 1]
            self._jumps[n : n + 3, n] = before, -before - behind, behind

    def slopes(self, at: Floats) -> list[Floats]:
        """u' at places, of tractions at the inner nodes: what is elastic, and of each creep
        mode.
        """
        apart = at[:, None] - self.nodes[None, :]
        scaled = ((J * T, apart / T) for J, T in zip(self.p.J, self.p.T, strict=True))
        parts = [
            _twice(apart) / self.p.alpha,
            *(size * (_memory(X) + _twice(X)) for size, X in scaled),
        ]
        return [part @ self._jumps / math.pi for part in parts]

    def moments(self, values: Floats) -> tuple[float, float]:
        """Integral and first moment of a traction with these values at the inner nodes."""
        inside, h, left = np.concatenate([[0.0], values, [0.0]]), self.lengths, self.nodes[:-1]
        a, b = inside[:-1], inside[1:]
        return float(h @ (a + b)) / 2.0, float(h @ (left * (a + b) / 2.0 + h * (a + 2.0 * b) / 6.0))


def graded(first: float, last: float, count: int) -> tuple[Floats, Floats]:
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
    return Boundary(
        2.0 * load / math.pi,
        g,
        g + moment / load,
        shares,
        d,
        elements.moments(shear)[0] / load,
        slipped,
    )


def extrapolated(p: Prony, z: float, eta: float, count: int = 50) -> Boundary:
    """The same from ``count`` elements and twice as many: once the layers are resolved, errors are
    as 8 to 1, those of the shares, which a midpoint rule integrates, as 4 to 1.
    """
    coarse, fine = contact(p, z, eta, count), contact(p, z, eta, 2 * count)
    both: Any = zip(coarse, fine, strict=True)
    shares, least = fine.shares + (fine.shares - coarse.shares) / 3.0, min(coarse.least, fine.least)
    return Boundary(*(b + (b - a) / 7.0 for a, b in both))._replace(shares=shares, least=least)


# --- Layers ---

#: wave numbers times h up to which the layer differs from a half-space, intervals halved towards 0,
#: and Gauss's points
_LAST, _HALVED, _POINTS, _EQUAL = 22.0, 24, 16, 12
#: Gauss's points on an element
_ON_ELEMENT = 4


class OnLayer(NamedTuple):
    """What the elements find.

    H, g, m : as of :class:`Boundary`.  star : delta_star/(mu V).  free : delta/V of free rolling
    with stick, by the strain of the surface by the pressure beyond that of a half-space.  mirrored
    : mean of that strain, mirrored about the middle of the contact and weighted with the pressure.
    d, Q : delta/(mu V) and Q/mu of the stick zone, without coupling.  least : of the inequalities,
    over their scales.
    """

    H: float
    g: float
    m: float
    star: float
    free: float
    mirrored: float
    d: float
    Q: float
    least: float


def kernels(u: Floats, nu: float) -> Floats:
    """L, T and C at u = k h: normal displacement by pressure, tangential by shear, tangential by
    pressure, over those of a half-space by its own traction."""
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
        np.moveaxis(np.array([nothing, nothing, *sides]), -1, 0)
        for sides in ((one, nothing), (nothing, one))
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
    ends = np.concatenate(
        [[0.0], _LAST * 2.0 ** np.arange(-_HALVED, -2.0), _LAST * np.arange(1, _EQUAL + 1) / _EQUAL]
    )
    ends = np.unique(ends)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


class Layer:
    """A layer under elements: its kernels and the transforms of the elements, at the wave numbers
    of a quadrature.

    Parameters
    ----------
    p : series.  nu : Poisson's ratio.  h : thickness over V T_ref.  elements : of the contact.
    part : the layer's of the long-time compliance.
    """

    def __init__(
        self, p: Prony, nu: float, h: float, elements: Elements, part: float = 1.0
    ) -> None:
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
        """Slopes at places by tractions at the inner nodes, of a kernel over that of a half-space,
        which decays.
        """
        factor = kernel * self.weights * self.compliance / (math.pi * self.h)
        result: Floats = np.imag((np.exp(1j * at[:, None] * self.k) * factor) @ self.hats)
        return result

    def strain(self, pressure: Floats, limit: float, at: Floats) -> Floats:
        """Strains of the surface at places by a pressure at the inner nodes, by C less its limit
        for short waves.
        """
        factor = (self.C - limit) * self.weights * self.compliance / (math.pi * self.h)
        result: Floats = -np.real(
            np.exp(1j * at[:, None] * self.k) @ (factor * (self.hats @ pressure))
        )
        return result

    def mirrored(self, pressure: Floats, load: float, limit: float) -> float:
        """Mean of these strains, mirrored about 0, with the pressure as weight."""
        whole = (
            (self.C - limit)
            * self.weights
            / self.h
            * (self.compliance * (self.hats @ pressure) ** 2).real
        )
        return float(-np.sum(whole) / (math.pi * load))


def contact_on_layer(
    p: Prony, nu: float, z: float, theta: float, eta: float, count: int, part: float = 1.0
) -> OnLayer:
    """A contact of half length z on a layer of thickness z/theta, with a stick zone of half length
    eta in front.

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
    least = min(
        min(pressure.min(), rest[count:].min(), shear.min()) / pressure.max(), slip.min() / d
    )
    limit = (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu)
    # stick without slip: the traction balances the strain by the pressure, and is 0 at both edges
    strain = layer.strain(pressure, limit, middle)
    stick = np.linalg.solve(np.column_stack([slopes, -np.ones(middle.size)]), -strain)
    free = float(stick[-1]) - 0.5 * star * elements.moments(stick[:-1])[0] / load
    mirrored = layer.mirrored(pressure, load, limit)
    return OnLayer(
        2.0 * load / math.pi,
        g,
        g + moment / load,
        star,
        free,
        mirrored,
        d,
        elements.moments(shear)[0] / load,
        least,
    )


def extrapolated_on_layer(
    p: Prony, nu: float, z: float, theta: float, eta: float, part: float = 1.0, count: int = 60
) -> OnLayer:
    """The same from ``count`` elements in either zone and twice as many: errors fall by 8."""
    coarse, fine = (contact_on_layer(p, nu, z, theta, eta, n, part) for n in (count, 2 * count))
    both: Any = zip(coarse, fine, strict=True)
    return OnLayer(*(b + (b - a) / 7.0 for a, b in both))._replace(
        least=min(coarse.least, fine.least)
    )


# --- The file ---


def bodies_states(random: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Yield states of one to four modes in two bodies: bodies, V and delta at kappa = 1 and mu =
    0.5, half lengths.

    random: random numbers.
    """
    for _ in range(BODIES):
        modes = int(random.integers(1, 5))
        tau = 10.0 ** random.uniform(-2.0, 0.0, modes)
        E, both = 10.0 ** random.uniform(-0.5, 1.0, modes), int(random.integers(0, modes + 1))
        parts = [
            {"E": E[part].tolist(), "tau": (tau[part] / tau.max()).tolist()}
            for part in (slice(both), slice(both, None))
        ]
        share, V = float(random.uniform(0.2, 0.8)), float(10.0 ** random.uniform(-1.5, 1.0))
        bodies = vr.Bodies(*(vr.Prony(**part) for part in parts), share=share)
        scene = vr.Scene(alpha=None, kappa=1.0, mu=0.5, material=bodies)
        delta = random.uniform(0.05, 0.95) * float(
            vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        )
        c = vr.contact(scene, V, delta=delta)
        z, eta = float(c.zeta), float(c.beta * c.zeta)
        truth = extrapolated(bodies.total, z, eta, _ELEMENTS)._asdict()
        truth["shares"] = truth["shares"].tolist()
        yield {"bodies": parts, "share": share, "V": V, "delta": delta, "z": z, "eta": eta} | truth


def cover_states(random: np.random.Generator, is_free: bool) -> Iterator[dict[str, Any]]:
    """Yield states of covers of both materials in turn: cover, V, half lengths and what the
    elements find.

    random: random numbers; thickness and speed in their logarithms.
    is_free: on a rigid base with nu = 1/2, where all strain by the pressure comes of the finite
    thickness.
    """
    for n in range(COVERS):
        thickness, u = (
            float(np.exp(random.uniform(*np.log(ends)))) for ends in (_THICKNESS, _SPEEDS)
        )
        nu, share = (float(random.uniform(*ends)) for ends in ((0.0, 0.5), _STICK))
        on, part = (
            ("base", "cylinder")[n // 2 % 2],
            1.0 if n % 3 else float(random.uniform(0.2, 1.0)),
        )
        if is_free:
            nu, share, on, part = 0.5, 0.5, "base", 1.0
        p = MATERIALS[n % 2]
        given = {"nu": nu, "thickness": thickness, "on": on, "part": part}
        scene = vr.Scene(material=vr.Cover(p, **given), kappa=KAPPA, mu=MU)
        free = vr.contact(scene, u / KAPPA, delta=0.0, fields="delta_0").delta_0
        lam = float(vr.contact(scene, u / KAPPA, delta=free, fields="lam").lam)
        z = 0.5 * lam / u
        truth = extrapolated_on_layer(p, nu, z, 0.5 * lam / thickness, share * z, part)
        series = {"E": p.E.tolist(), "tau": p.tau.tolist()}
        yield {
            "series": series,
            "cover": given,
            "V": u / KAPPA,
            "z": z,
            "eta": share * z,
        } | truth._asdict()


def main() -> None:
    """Solve all states, and write the file, a line for each."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    output = parser.parse_args().output
    states = {
        name: make(np.random.default_rng([SEED, n]))
        for n, (name, make) in enumerate(
            {
                "bodies": bodies_states,
                "covers": lambda random: cover_states(random, is_free=False),
                "free_creep": lambda random: cover_states(random, is_free=True),
            }.items()
        )
    }
    groups = (
        f'"{name}": [\n' + ",\n".join(map(json.dumps, tqdm(rows, name))) + "\n]"
        for name, rows in states.items()
    )
    output.write_text("{" + ",\n".join(groups) + "}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
