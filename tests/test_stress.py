"""Pressure and shear along the contact, by the public call alone."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import tolerances as tol

import viscoroll as vr

KAPPA, MU = 2.91, 0.2
#: alpha zeta from 5e-5 to 5e5 among them
STATES = [
    (alpha, kappa_V, s)
    for alpha in (1.0, 1.01, 11.0, 1e4)
    for kappa_V in (1e-5, 1e-3, 0.0582, 1.0, 30.0, 1e4)
    for s in (0.05, 0.5, 0.95, 1.0)
]


class Contact:
    """One state, s = |delta|/delta_star; 1 is full slip."""

    def __init__(self, alpha: float, kappa_V: float, s: float) -> None:
        self.scene, self.V = vr.Scene(alpha, KAPPA, MU), kappa_V / KAPPA
        self.delta = s * vr.contact(self.scene, self.V, delta=0.0, fields="delta_star").delta_star
        self.state = vr.contact(self.scene, self.V, delta=self.delta)
        middle = 0.5 * self.state.lam * self.state.epsilon
        self.rear, self.front = middle - 0.5 * self.state.lam, middle + 0.5 * self.state.lam
        self.edge = self.front - self.state.lam * self.state.beta

    def at(self, x: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        found = vr.stress(self.scene, x, self.V, delta=self.delta)
        return found.p, found.tau

    def across(self, low: float, high: float, number: int = 201) -> tuple[np.ndarray, np.ndarray]:
        """p and tau between two edge distances in [0, 2] from the rear edge."""
        w = np.linspace(low, high, number)[1:-1]
        return self.at(0.5 * self.state.lam * (w - 1.0 + self.state.epsilon))


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


def test_closures():
    """Load, moment and traction are the integrals of the stress."""
    load = 1.0 / (32.0 * KAPPA)
    for given in STATES:
        here = Contact(*given)
        x, weight = panels(here.rear, here.front)
        p, _ = here.at(x)
        assert abs(weight @ p - load) <= tol.STRESS_CLOSURE * load, given
        assert abs(weight @ (x * p) - here.state.M / 32.0) <= tol.STRESS_CLOSURE * load, given
        shear = 0.0
        for low, high in ((here.rear, here.edge), (here.edge, here.front)):
            if high > low:
                x, weight = panels(low, high)
                shear += weight @ here.at(x)[1]
        assert abs(shear - here.state.Q * load) <= tol.STRESS_CLOSURE * load, given


def test_signs_and_friction_bound():
    for given in STATES:
        here = Contact(*given)
        p, tau = np.hstack([here.across(0.0, 2.0), here.across(0.0, 1e-6), here.across(2.0 - 1e-6, 2.0)])
        assert np.all(p >= -tol.STRESS_SIGN), given
        assert np.all(tau >= -tol.STRESS_SIGN), given
        assert np.all(tau <= MU * p + tol.STRESS_SIGN), given
        assert here.state.beta > 0.0 or np.array_equal(tau, MU * p), given
        outside = 0.5 * here.state.lam * (np.array([-1e-9, 2.0 + 1e-9]) - 1.0 + here.state.epsilon)
        assert not np.any(here.at(outside)), given


def test_shear_is_continuous_at_the_stick_edge():
    for given in STATES:
        here = Contact(*given)
        if here.state.full_slip:
            continue
        below, above = here.at(here.edge + 1e-12 * here.state.lam * np.array([-1.0, 1.0]))[1]
        assert abs(above - below) <= tol.STRESS_EDGE * MU * here.across(0.0, 2.0)[0].max(), given


def printed_stress(alpha: float, kappa_V: float, s: float, places: list[float]):
    """Rows of (x, p/E', tau/E') by Eqs. (6)-(14) as printed.

    places run from the rear edge (0) to the front edge (1).
    """
    seed = Contact(alpha, kappa_V, s).state
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
    return rows


def test_against_the_printed_integrals():
    for given in ((11.0, 2.91 * 0.02, 0.5), (11.0, 0.7, 0.2), (100.0, 5.0, 0.8), (1.5, 0.1, 0.9)):
        with mp.workdps(40 + int(0.5 * given[0] / given[1])):  # exp(alpha (x - x')/(kappa V)) cancels
            x, p, tau = np.transpose(printed_stress(*given, [0.02, 0.3, 0.6, 0.8, 0.97]))
        peak = p.max()
        assert np.any(tau < 0.999 * MU * p), given  # some of them lie in the stick zone
        p_here, tau_here = Contact(*given).at(x)
        assert np.all(abs(p_here - p) <= tol.STRESS_PRINTED * peak), given
        assert np.all(abs(tau_here - tau) <= tol.STRESS_PRINTED * MU * peak), given


def test_elastic_cylinder_and_rest_are_carter():
    """Hertz's pressure and Carter's two ellipses, at alpha = 1 or at V = 0."""
    x, peak = np.linspace(-0.4999, 0.4999, 41), 1.0 / (8 * np.pi * KAPPA)
    p_0 = np.sqrt((1 - 2 * x) * (1 + 2 * x))
    for alpha, kappa_V in ((1.0, 500.0), (1.0, 0.5), (1.0, 5e-6), (1.0, 0.0), (11.0, 0.0), (1e4, 0.0)):
        for s in (1.0, 0.7, 0.1):
            here = Contact(alpha, kappa_V, s)
            p, tau = here.at(x)
            beta = here.state.beta
            stuck = np.sqrt(np.maximum(beta**2 - (2 * x - 1 + beta) ** 2, 0.0))
            assert np.all(abs(p - peak * p_0) <= tol.STRESS_ELLIPSE * peak), (alpha, kappa_V)
            assert np.all(abs(tau - MU * peak * (p_0 - stuck)) <= MU * peak * tol.STRESS_CARTER), (alpha, kappa_V, s)
