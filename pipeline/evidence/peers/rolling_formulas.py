"""Closed formulas of others for the rolling resistance of a rigid cylinder on rubber.

Persson: rolling friction of a cylinder on a half-space from the complex modulus (Eur. Phys. J. E
33, 327, 2010).  Jonkers: indentation rolling resistance of a belt on an idler (Foerdern und Heben
30, 312, 1980).  Neither text was at hand, so both are derived here from their assumptions;
tests/evidence/test_formulas.py holds the derivations to their limits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import i0e, i1e, k0e, k1e

import viscoroll as vr

#: Below this argument differences of Bessel functions cancel; their first terms are right to 4e-6.
_FROZEN = 1e-3


class Rolled(NamedTuple):
    """What a formula states.

    C_rr : coefficient of rolling resistance M/(P R), dimensionless.
    length : contact length, m.
    """

    C_rr: float
    length: float


def _weights(a: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the shares of each mode in loss and in compliance under a pressure of Hertz.

    Of the integrals over the wave number k of the pressure, (2 J_1(k)/k)^2, with a mode of
    retardation time T at the speed V, and ``a`` = s/(V T), s the half-length, dimensionless.

    Returns
    -------
    loss : 1/a (1/2 - I_1(a) K_1(a)), of Im 1/E; the integral of J_1(k)^2/k^2 k/a/(1 + (k/a)^2).
    compliance : 1 - G, of Re 1/E; G is 8 a^2 times the integral of J_1(k)^2/(k (k^2 + a^2)^2).
    """
    a = np.asarray(a, dtype=float)
    x = np.maximum(a, _FROZEN)
    product = i1e(x) * k1e(x)
    slope = i0e(x) * k1e(x) - i1e(x) * k0e(x) - 2.0 * product / x
    G = 8.0 * (0.5 - product) / x**2 + 4.0 * slope / x
    first = 0.25 * a * (np.log(2.0 / a) - np.euler_gamma + 0.25)
    frozen = a < _FROZEN
    return np.where(frozen, first, (0.5 - product) / x), np.where(frozen, 0.0, 1.0 - G)


def persson(material: vr.Material, R: float, load: float, V: float) -> Rolled:
    """Return the rolling friction of a rigid cylinder on a half-space.

    The pressure is that of Hertz, p = 2 P/(pi s) sqrt(1 - (x/s)^2), with the transform
    2 P J_1(q s)/(q s).  A half-space moves by 2/(q E(q V)) p(q), E = E/(1 - nu^2) complex.  So the
    power of p on the surface is, over V,

    F = (8 P^2/pi) int_0^inf (J_1(q s)/(q s))^2 Im(1/E(q V)) dq,  Im(1/E) = E''/|E|^2.

    The half-length s makes elastic energy and work of the load stationary: s^2 = (4 P R/pi) times
    the mean of Re(1/E) with the weight -d/dk (2 J_1(k)/k)^2, k = q s, which is Hertz's for an
    elastic body.  With a Prony series both integrals are Bessel functions.

    Parameters
    ----------
    material : half-space; its nu is constant.
    R, load, V : m, N per m, m/s.
    """
    series = material.prony
    compliance = (1.0 - material.nu**2) / material.E
    strengths = np.asarray(series.J)
    times = np.asarray(series.T) * material.T_ref
    glassy = 1.0 - strengths.sum()

    def effective(s: float) -> float:
        return float(glassy + strengths @ _weights(s / (V * times))[1])

    def hertz(share: float) -> float:
        return float(np.sqrt(4.0 * load * R * compliance * share / np.pi))

    low = hertz(glassy)
    high = hertz(1.0)
    s = brentq(lambda s: s - hertz(effective(s)), 0.999 * low, 1.001 * high, rtol=1e-12)
    lost = strengths @ _weights(s / (V * times))[0]
    return Rolled(float(8.0 * load / (np.pi * s) * compliance * lost), 2.0 * s)


def jonkers(material: vr.Material, thickness: float, R: float, load: float, V: float) -> Rolled:
    """Return the indentation rolling resistance of a belt cover on an idler.

    The cover is a bed of independent columns of Young's modulus |E| and height h.  From the front
    edge on, where the stress is zero, the stress is half a wave, E_0 eps sin(phi), and the
    indentation h eps (sin(phi - delta) + sin(delta)), which is largest, a^2/(2 R), above the axis,
    at phi = pi/2 + delta, x = 0.  Load and work over the half wave give, with D = 2 R,

    C_rr = pi/2 tan(delta) ((pi + 2 delta) cos(delta)/(4 sqrt(1 + sin(delta))))^(4/3)
    (P h/(E' D^2))^(1/3),  a^3 = P h D (pi + 2 delta) cos(delta) (1 + sin(delta))/(4 E').

    E' and delta are those at the frequency of that wave, (pi + 2 delta) V/(2 a).

    Parameters
    ----------
    material : rubber of the cover.
    thickness, R, load, V : m, m, N per m, m/s.
    """
    diameter = 2.0 * R

    def front(omega: float) -> tuple[float, float]:
        """Length ahead of the axis, m, and loss angle."""
        angle = float(np.arctan(material.tan_delta(omega)))
        wave = (np.pi + 2.0 * angle) * np.cos(angle) * (1.0 + np.sin(angle)) / 4.0
        return np.cbrt(load * thickness * diameter * wave / material.storage(omega)), angle

    def excess(log_omega: float) -> float:
        omega = np.exp(log_omega)
        ahead, angle = front(omega)
        return float(log_omega - np.log((np.pi + 2.0 * angle) * V / (2.0 * ahead)))

    guess = np.log(np.pi * V / (2.0 * front(0.0)[0]))
    omega = np.exp(brentq(excess, guess - 5.0, guess + 10.0, xtol=1e-12))
    ahead, angle = front(omega)
    shape = (np.pi + 2.0 * angle) * np.cos(angle) / (4.0 * np.sqrt(1.0 + np.sin(angle)))
    bed = np.cbrt(load * thickness / (material.storage(omega) * diameter**2))
    C_rr = 0.5 * np.pi * np.tan(angle) * shape ** (4.0 / 3.0) * bed
    return Rolled(float(C_rr), float(2.0 * np.pi * ahead / (np.pi + 2.0 * angle)))
