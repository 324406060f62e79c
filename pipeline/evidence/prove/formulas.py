"""Formulas of others beside the exact law -> data/results/formulas.json (kept in git).

    python -m pipeline.evidence.prove.formulas [-o FILE]

Persson's rolling friction over speed, Jonkers' formula and the half-space for the belt of the
how-to, and the law in the limits of Hunter and of May, Morris & Atack.  Each is for a rigid
cylinder that rolls freely.  pipeline/evidence/document/ puts the tables into
docs/accuracy_independent.md.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import i0e, i1e, k0e, k1e

import viscoroll as vr

from ...stage import Row
from ..results import run
from .layer import MATERIAL, springs_moment

# --- closed formulas of others ---

#: Below this argument differences of Bessel functions cancel; their first terms are right to 4e-6.
_FROZEN = 1e-3


class Rolled(NamedTuple):
    """What a formula states.

    C_rr : coefficient of rolling resistance M/(P R), dimensionless.
    length : contact length, m.
    """

    C_rr: float
    length: float


def _weights(a):
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

    def effective(s):
        return glassy + strengths @ _weights(s / (V * times))[1]

    def hertz(share):
        return np.sqrt(4.0 * load * R * compliance * share / np.pi)

    low = hertz(glassy)
    high = hertz(1.0)
    s = brentq(lambda s: s - hertz(effective(s)), 0.999 * low, 1.001 * high, rtol=1e-12)
    lost = strengths @ _weights(s / (V * times))[0]
    return Rolled(8.0 * load / (np.pi * s) * compliance * lost, 2.0 * s)


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

    def front(omega):
        """Length ahead of the axis, m, and loss angle."""
        angle = float(np.arctan(material.tan_delta(omega)))
        wave = (np.pi + 2.0 * angle) * np.cos(angle) * (1.0 + np.sin(angle)) / 4.0
        return np.cbrt(load * thickness * diameter * wave / material.storage(omega)), angle

    def excess(log_omega):
        omega = np.exp(log_omega)
        ahead, angle = front(omega)
        return log_omega - np.log((np.pi + 2.0 * angle) * V / (2.0 * ahead))

    guess = np.log(np.pi * V / (2.0 * front(0.0)[0]))
    omega = np.exp(brentq(excess, guess - 5.0, guess + 10.0, xtol=1e-12))
    ahead, angle = front(omega)
    shape = (np.pi + 2.0 * angle) * np.cos(angle) / (4.0 * np.sqrt(1.0 + np.sin(angle)))
    bed = np.cbrt(load * thickness / (material.storage(omega) * diameter**2))
    C_rr = 0.5 * np.pi * np.tan(angle) * shape ** (4.0 / 3.0) * bed
    return Rolled(C_rr, 2.0 * np.pi * ahead / (np.pi + 2.0 * angle))


# --- beside the law ---

#: Idler and belt cover of docs/howto/covers.md: m, N per m of width, m.
R = 0.08
LOAD = 2e3
THICKNESS = 6e-3
BELT = vr.Material(
    E=4e6,
    nu=0.49,
    prony=vr.Prony(E=[0.3, 0.6, 1.5, 4.0, 10.0, 30.0], tau=[0.1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11]),
    T_ref=1.0,
)
SHIFT = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
TEMPERATURES = (-20.0, 20.0, 40.0)
BELT_SPEEDS = (1.0, 5.0)
#: Rubbers of Persson's formula; speeds in contact lengths at rest per longest retardation time.
THREE = vr.Prony(BELT.prony.E[:3], BELT.prony.tau[:3])
RUBBERS = {"one": replace(BELT, prony=MATERIAL), "three": replace(BELT, prony=THREE)}
SPEEDS = (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 1e2, 1e3, 1e4)
#: Speeds kappa V of the limits; at the highest the contact is glassy to the digits of the table.
SLOWEST = 1e-4
FASTEST = 1e4
#: Of the layers that tend to springs: Poisson's ratio, thickness over l0, kappa V.
SPRINGS_NU = 0.3
SPRINGS_THICKNESS = (1.0, 0.5, 0.2, 0.1)
SPRINGS_SPEEDS = (0.3, 3.0)


def idler(rubber: vr.Material) -> vr.Cylinder:
    """Return the rigid idler on ``rubber``."""
    return vr.Cylinder(R=R, m=40.0, material=vr.Material.rigid(), base=rubber, mu=0.5, load=LOAD)


def freely(rubber: vr.Material, V: float) -> Rolled:
    """Return resistance over load, and contact length, of the idler that rolls freely at V, m/s.

    Towed without a torque: at delta = 0 the pressure on a layer drives it, and M is no resistance.
    """
    roller = idler(rubber)
    state = roller.steady(V=V, torque=0.0)
    length = roller.contact(V, delta=float(state.delta[0]), fields="length").length
    return Rolled(float(state.force[0]) / LOAD, float(length))


def speeds(rubber: vr.Material) -> Iterator[tuple[float, float]]:
    """Yield the speeds of Persson's formula: contact lengths per retardation time, and m/s."""
    rest = 2.0 * np.sqrt(4.0 * LOAD * R * (1.0 - rubber.nu**2) / (np.pi * rubber.E))
    for share in SPEEDS:
        yield share, share * rest / rubber.prony.T.max()


def over_speed() -> list[Row]:
    """Persson's C_rr and contact length less those of the law, relative."""
    rows = []
    for name, rubber in RUBBERS.items():
        for share, V in speeds(rubber):
            exact = idler(rubber).contact(V, delta=0.0, fields=("C_rr", "length"))
            formula = persson(rubber, R, LOAD, V)
            rows.append(
                {
                    "modes": name,
                    "share": share,
                    "C_rr": float(exact.C_rr),
                    "formula": formula.C_rr,
                    "off": formula.C_rr / float(exact.C_rr) - 1.0,
                    "length": formula.length / float(exact.length) - 1.0,
                }
            )
    return rows


def belt() -> list[Row]:
    """Half-space, Jonkers and Persson over the layer of the how-to."""
    rows = []
    for temperature in TEMPERATURES:
        rubber = BELT.at(temperature, SHIFT)
        for V in BELT_SPEEDS:
            layer = freely(replace(rubber, thickness=THICKNESS), V)
            others = {
                "half": freely(rubber, V),
                "jonkers": jonkers(rubber, THICKNESS, R, LOAD, V),
                "persson": persson(rubber, R, LOAD, V),
            }
            rows.append(
                {"temperature": temperature, "V": V, "C_rr": layer.C_rr, "length": layer.length}
                | {name: each.C_rr for name, each in others.items()}
                | {f"{name}_off": each.C_rr / layer.C_rr - 1.0 for name, each in others.items()}
            )
    return rows


def limits() -> list[Row]:
    """Limits of Hunter, and of May, Morris & Atack: quantity, the law, and what it tends to."""
    half = vr.Scene(material=vr.Bodies(MATERIAL, vr.Prony.elastic(), 1.0), kappa=1.0, mu=1.0)
    slow = half.contact(SLOWEST, delta=0.0, fields=("M", "lam"))
    fast = half.contact(FASTEST, delta=0.0, fields=("M", "lam"))
    lost = 1.0 - float(MATERIAL.tau[0]) / float(MATERIAL.T[0])
    hunter = {
        "M/(P V (T_epsilon - T_sigma)), slow": float(slow.M) / SLOWEST / lost,
        "contact length over that of the relaxed body, slow": float(slow.lam),
        "contact length over that of the glassy body, fast": float(fast.lam)
        * float(MATERIAL.alpha) ** 0.5,
    }
    compared = [("Hunter", name, law, 1.0) for name, law in hunter.items()]
    for thickness in SPRINGS_THICKNESS:
        cover = vr.Cover(MATERIAL, nu=SPRINGS_NU, thickness=thickness)
        # springs know no shear: neither does the fast law without traction
        scene = half.replace(material=cover, coupled=False)
        for u in SPRINGS_SPEEDS:
            delta = float(scene.contact(u, delta=0.0, fields="delta_0").delta_0)
            law = float(scene.contact(u, delta=delta, fields="M").M)
            limit = springs_moment(u, thickness, SPRINGS_NU)
            name = f"kappa M at h/l0 = {thickness:g}, kappa V = {u:g}"
            compared.append(("May, Morris & Atack", name, law, limit))
    return [
        {"source": source, "quantity": name, "law": law, "limit": limit, "off": law / limit - 1.0}
        for source, name, law, limit in compared
    ]


def found() -> Row:
    """Return the comparisons with the law."""
    return {"persson": over_speed(), "belt": belt(), "limits": limits()}


if __name__ == "__main__":
    sys.exit(run("prove.formulas", found, __doc__, "formulas.json", sizes=False))
