"""Pressure and shear along the contact (stress.py)."""

from __future__ import annotations

from typing import NamedTuple

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol

from viscoroll.kernels.law.length import contact_length
from viscoroll.kernels.law.material import Material, generators, moment_factor
from viscoroll.kernels.law.stick import stick_length
from viscoroll.kernels.law.stress import stress_at

KAPPA, MU = 2.91, 0.2
#: alpha zeta from 5e-5 to 5e5 among them
STATES = [
    (alpha, kappa_V, s)
    for alpha in (1.0, 1.01, 11.0, 1e4)
    for kappa_V in (1e-5, 1e-3, 0.0582, 1.0, 30.0, 1e4)
    for s in (0.05, 0.5, 0.95, 1.0)
]


class State(NamedTuple):
    material: Material
    lam: float
    epsilon: float
    beta: float
    zeta: float
    Q: float
    M: float

    def at(self, x: float, kappa: float = KAPPA) -> tuple[float, float]:
        return stress_at(x, kappa, MU, self.lam, self.epsilon, self.beta, self.zeta, self.material)

    def across(self, low: float, high: float, number: int = 201) -> np.ndarray:
        """Columns x, p, tau between two edge distances in [0, 2] from the rear edge."""
        w = np.linspace(low, high, number)[1:-1]
        x = 0.5 * self.lam * (w - 1.0 + self.epsilon)
        return np.array([(at, *self.at(at)) for at in x])


def state(alpha: float, kappa_V: float, s: float) -> State:
    """s = |delta|/delta_star; 1 and above is full slip."""
    material = Material(alpha, (alpha - 1.0) / alpha)
    lam, _ = contact_length(kappa_V, material)
    zeta = lam / (2.0 * kappa_V)
    g, h = generators(zeta, material)
    eta = stick_length(zeta, s * (zeta + g), material)[0] if s < 1.0 else 0.0
    h_eta = generators(eta, material)[1]
    Q = MU * (1.0 - eta * (eta + 2 * h_eta) / (zeta * (zeta + 2 * h)))
    M = kappa_V / KAPPA * moment_factor(zeta, lam, material)
    return State(material, lam, g / zeta, eta / zeta, zeta, Q, M)


def panels(low: float, high: float, number: int = 26, nodes: int = 12):
    """Nodes and weights of an integral over [low, high] of a function with square roots at both ends.

    Gauss-Legendre in the angle of x = middle - half cos(angle), on panels that halve toward both ends,
    where the layers of width (alpha zeta)^(-1/2) lie.
    """
    halving = 0.5 * np.pi * 0.5 ** np.arange(number // 2)
    edges = np.concatenate([[0.0], halving[::-1], np.pi - halving[1:], [np.pi]])
    t, weight = np.polynomial.legendre.leggauss(nodes)
    width = np.diff(edges)
    angle = (edges[:-1, None] + 0.5 * width[:, None] * (1.0 + t)).ravel()
    weight = (0.5 * width[:, None] * weight).ravel()
    half = 0.5 * (high - low)
    # from the nearer end, so that the edge distances keep their digits
    x = np.where(
        angle < 0.5 * np.pi, low + 2 * half * np.sin(0.5 * angle) ** 2, high - 2 * half * np.cos(0.5 * angle) ** 2
    )
    return x, weight * half * np.sin(angle)


@pytest.mark.parametrize(("alpha", "kappa_V", "s"), STATES)
def test_closures(alpha, kappa_V, s):
    here = state(alpha, kappa_V, s)
    rear, front = 0.5 * here.lam * (here.epsilon - 1.0), 0.5 * here.lam * (here.epsilon + 1.0)
    edge = front - here.lam * here.beta
    load = 1.0 / (32.0 * KAPPA)
    x, weight = panels(rear, front)
    p = np.array([here.at(at)[0] for at in x])
    assert abs(weight @ p - load) <= tol.STRESS_CLOSURE * load
    assert abs(weight @ (x * p) - here.M / 32.0) <= tol.STRESS_CLOSURE * load
    shear = 0.0
    for low, high in ((rear, edge), (edge, front)):
        if high > low:
            x, weight = panels(low, high)
            shear += weight @ np.array([here.at(at)[1] for at in x])
    assert abs(shear - here.Q * load) <= tol.STRESS_CLOSURE * load


@pytest.mark.parametrize(("alpha", "kappa_V", "s"), STATES)
def test_signs_and_friction_bound(alpha, kappa_V, s):
    here = state(alpha, kappa_V, s)
    rows = np.vstack([here.across(0.0, 2.0), here.across(0.0, 1e-6), here.across(2.0 - 1e-6, 2.0)])
    p, tau = rows[:, 1], rows[:, 2]
    assert np.all(p >= -tol.STRESS_SIGN)
    assert np.all(tau >= -tol.STRESS_SIGN)
    assert np.all(tau <= MU * p + tol.STRESS_SIGN)
    if here.beta == 0.0:
        assert np.array_equal(tau, MU * p)
    for outside in (-1e-9, 2.0 + 1e-9):
        assert here.at(0.5 * here.lam * (outside - 1.0 + here.epsilon)) == (0.0, 0.0)


@pytest.mark.parametrize(("alpha", "kappa_V", "s"), [t for t in STATES if t[2] < 1.0])
def test_shear_is_continuous_at_the_stick_edge(alpha, kappa_V, s):
    here = state(alpha, kappa_V, s)
    edge = 0.5 * here.lam * (here.epsilon + 1.0) - here.lam * here.beta
    peak = here.across(0.0, 2.0)[:, 1].max()
    jump = here.at(edge + 1e-12 * here.lam)[1] - here.at(edge - 1e-12 * here.lam)[1]
    assert abs(jump) <= tol.STRESS_EDGE * MU * peak


def printed_stress(alpha: float, kappa_V: float, s: float, places: list[float]):
    """(lam, epsilon, beta, zeta) and rows of (x, p/E', tau/E') by Eqs. (6)-(14) as printed.

    places run from the rear edge (0) to the front edge (1).
    """
    seed = state(alpha, kappa_V, s)
    alpha, kappa, mu = mp.mpf(alpha), mp.mpf(KAPPA), mp.mpf(MU)
    V = mp.mpf(kappa_V) / kappa

    def I(order, x):  # noqa: E743 (the Bessel function's name)
        return mp.besseli(order, x)

    def K(order, x):
        return mp.besselk(order, x)

    def eq_6(lam):
        z = lam / (2 * kappa * V)
        return (1 - lam**2) * (I(0, alpha * z) * K(1, z) + K(0, z) * I(1, alpha * z)) + 2 / z * (
            1 / alpha - 1
        ) * lam**2 * I(1, alpha * z) * K(1, z)

    lam = mp.findroot(eq_6, (mp.mpf(seed.lam), mp.mpf(seed.lam) * (1 - mp.mpf(10) ** -12)))
    zeta = lam / (2 * kappa * V)
    epsilon = (lam**-2 - 1) / 2 * K(0, zeta) / K(1, zeta)
    delta = mp.mpf(s) * mu * lam * (1 + epsilon) / (2 * kappa)

    def eq_10(beta):
        z = beta * zeta
        return (1 + epsilon - beta - 2 * delta * kappa / (mu * lam)) * (
            I(0, alpha * z) * K(1, z) + I(1, alpha * z) * K(0, z)
        ) + (1 / alpha - 1) / zeta * I(1, alpha * z) * K(0, z)

    beta = mp.findroot(eq_10, (mp.mpf(seed.beta), mp.mpf(seed.beta) * (1 - mp.mpf(10) ** -12)))
    a, b = lam * (1 - epsilon) / 2, lam * (1 + epsilon) / 2
    c = b - lam * beta
    ratio = K(1, zeta * beta) / K(0, zeta * beta)
    C_2 = (
        mu
        * beta
        * lam
        / (16 * kappa)
        * (b + c - 2 * kappa * V - 2 * kappa * delta / mu + (b + c - 2 * kappa * delta / mu) * ratio)
    )

    def memory(x, low, density):
        """Int_low^x density(x', angle) exp(alpha (x - x')/(kappa V)) d angle.

        x' = (b + low)/2 - (b - low)/2 cos angle.
        """
        middle, half = (b + low) / 2, (b - low) / 2

        def integrand(angle):
            at = middle - half * mp.cos(angle)
            return density(at, angle) * mp.exp(alpha / (kappa * V) * (x - at))

        return mp.quad(integrand, [0, mp.acos((middle - x) / half)])

    rows = []
    for place in places:
        x = mp.mpf(float(-a + lam * mp.mpf(place)))
        # dx'/sqrt((x' + a)(b - x')) is d angle
        p = (
            -alpha
            / (2 * mp.pi * kappa**2 * V)
            * memory(x, -a, lambda at, _: (lam**2 + 4 * (at - kappa * V) * (lam * epsilon - 2 * at) + 1) / 16)
        )
        tau = mu * p
        if x > c:
            # sqrt((x' - c)/(b - x')) dx' is (b - c)/2 (1 - cos angle) d angle
            tau += (
                mu
                * alpha
                / (8 * mp.pi * kappa**2 * V)
                * memory(
                    x,
                    c,
                    lambda at, angle: (
                        (2 * kappa * V + b - c - 2 * at + 2 * kappa * delta / mu) * (b - c) / 2 * (1 - mp.cos(angle))
                    ),
                )
            )
            tau += alpha * C_2 / (mp.pi * kappa * V) * memory(x, c, lambda at, angle: mp.mpf(1))
        rows.append((float(x), float(p), float(tau)))
    return (float(lam), float(epsilon), float(beta), float(zeta)), rows


@pytest.mark.parametrize(
    ("alpha", "kappa_V", "s"), [(11.0, 2.91 * 0.02, 0.5), (11.0, 0.7, 0.2), (100.0, 5.0, 0.8), (1.5, 0.1, 0.9)]
)
def test_against_the_printed_integrals(alpha, kappa_V, s):
    with mp.workdps(160):
        (lam, epsilon, beta, zeta), rows = printed_stress(alpha, kappa_V, s, [0.02, 0.3, 0.6, 0.8, 0.97])
    material = Material(alpha, (alpha - 1.0) / alpha)
    peak = max(p for _, p, _ in rows)
    assert sum(tau < 0.999 * MU * p for _, p, tau in rows) >= 1  # some of them lie in the stick zone
    for x, p, tau in rows:
        p_here, tau_here = stress_at(x, KAPPA, MU, lam, epsilon, beta, zeta, material)
        assert abs(p_here - p) <= tol.STRESS_PRINTED * peak
        assert abs(tau_here - tau) <= tol.STRESS_PRINTED * MU * peak


def carter(x: float, beta: float) -> tuple[float, float]:
    """Hertz's pressure and Carter's two ellipses."""
    y = 2.0 * x
    p = np.sqrt((1 - y) * (1 + y))
    stuck = max(beta**2 - (y - 1 + beta) ** 2, 0.0) ** 0.5
    return p / (8 * np.pi * KAPPA), MU * (p - stuck) / (8 * np.pi * KAPPA)


@pytest.mark.parametrize(
    ("alpha", "zeta"), [(1.0, 1e-3), (1.0, 1.0), (1.0, 1e5), (1.0, np.inf), (11.0, np.inf), (1e4, np.inf)]
)
@pytest.mark.parametrize("beta", [0.0, 0.3, 0.9])
def test_elastic_cylinder_and_rest_are_carter(alpha, zeta, beta):
    peak = 1.0 / (8 * np.pi * KAPPA)
    for x in np.linspace(-0.4999, 0.4999, 41):
        p, tau = stress_at(x, KAPPA, MU, 1.0, 0.0, beta, zeta, Material(alpha, (alpha - 1.0) / alpha))
        p_0, tau_0 = carter(x, beta)
        assert abs(p - p_0) <= tol.STRESS_ELLIPSE * peak
        assert abs(tau - tau_0) <= MU * peak * tol.STRESS_CARTER
