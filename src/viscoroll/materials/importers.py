"""Materials as other programs state them: the constructors that :class:`Material` has from here.

All of these programs relax the shear modulus, G(t).  Here Poisson's ratio is constant in time, so that
E(t) = 2 (1 + nu) G(t) relaxes alike; what that takes for granted stands with each.
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import ArrayLike, NDArray

from ..core.checks import checked, number, yes_or_no
from ..core.errors import ParameterError, one_of
from ..core.scale import SI
from ..core.typed import Floats
from .bodies import Bodies
from .prony import Prony


class FromPrograms:
    """Constructors of :class:`Material`; times in s, so that T_ref = 1 s and they stay as they are given."""

    @classmethod
    def abaqus(cls, E0: float, nu: float, g: ArrayLike, tau: ArrayLike, *, long_term: bool = False, **more: Any) -> Any:
        """The material of ``*VISCOELASTIC, TIME=PRONY`` under ``*ELASTIC``.

        g_R(t) = G(t)/G0 = 1 - sum g_i (1 - exp(-t/tau_i)), so that E_i = g_i/(1 - sum g): Abaqus 2017,
        Materials, "Time domain viscoelasticity" (abaqus-docs.mit.edu, simamat-c-timevisco).

        Parameters
        ----------
        E0 : modulus of ``*ELASTIC``, Pa: the instantaneous one, or the long-time one where
            ``long_term`` (``MODULI=LONG TERM``).
        nu : Poisson's ratio, taken constant in time, as k_i = g_i would make it.  Without k_i Abaqus holds
            the bulk modulus constant: its nu then rises to nearly 0.5.
        g : g_i, shares of the instantaneous shear modulus, >= 0, of a sum below 1.
        tau : relaxation times tau_i, s, > 0.
        more : ``name`` and ``density`` of the material.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths.
        """
        return cls._relative(E0, nu, "g", g, tau, yes_or_no("long_term", long_term), more)

    @classmethod
    def ansys(cls, E0: float, nu: float, alpha: ArrayLike, tau: ArrayLike, **more: Any) -> Any:
        """The material of ``TB,PRONY,,,,SHEAR`` under ``MP,EX`` and ``MP,PRXY``.

        G(t) = G0 (alpha_inf + sum alpha_i exp(-t/tau_i)), alpha_inf = 1 - sum alpha_i: Mechanical APDL,
        Material Reference, "Viscoelasticity", whose elastic constants are those of t = 0.

        Parameters
        ----------
        E0 : instantaneous Young's modulus EX, Pa.
        nu : Poisson's ratio PRXY, taken constant in time, as a bulk table equal to that of shear makes it.
        alpha, tau : the pairs alpha_i (>= 0, of a sum below 1) and tau_i (s, > 0).
        more : ``name`` and ``density`` of the material.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths.
        """
        return cls._relative(E0, nu, "alpha", alpha, tau, False, more)

    @classmethod
    def comsol(cls, E: float, nu: float, G: ArrayLike, tau: ArrayLike, **more: Any) -> Any:
        """The material of a generalized Maxwell node under Linear Elastic Material.

        G(t) = G + sum G_m exp(-t/tau_m), G that of the main elastic branch: COMSOL Structural Mechanics
        Module User's Guide, "Linear Viscoelasticity" (doc.comsol.com, sme_ug_theory).

        Parameters
        ----------
        E, nu : of the elastic node, Pa: the long-time values (static stiffness "Long-term").  nu is taken
            constant in time; where only deviatoric strains are viscoelastic, COMSOL's rises as G(t) falls.
        G : shear moduli G_m of the branches, Pa, >= 0.
        tau : their relaxation times tau_m, s, > 0.
        more : ``name`` and ``density`` of the material.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths.
        """
        E, nu = number("E", E, unit=SI, low=0.0, strict=True), poisson(nu)
        strengths, tau = pairs("G", G, "tau", tau)
        return cls(E=E, nu=nu, prony=Prony(strengths * (2.0 * (1.0 + nu) / E), tau), **more)  # type: ignore[call-arg]

    @classmethod
    def lsdyna(
        cls,
        G: ArrayLike,
        beta: ArrayLike,
        *,
        nu: float | None = None,
        bulk: float | None = None,
        G0: float | None = None,
        G_inf: float | None = None,
        **more: Any,
    ) -> Any:
        """The material of ``*MAT_GENERAL_VISCOELASTIC`` (076), or of ``*MAT_VISCOELASTIC`` (006) as one pair.

        G(t) = sum G_i exp(-beta_i t), G_i absolute and beta_i = 1/tau_i; a pair with beta = 0 is the
        long-time modulus: LS-DYNA Keyword Manual, Vol. II.  In 006 G(t) = G_inf + (G0 - G_inf) exp(-beta t)
        (help.altair.com, mat_006_viscoelastic): give G = [G0 - G_inf] and G_inf.

        Parameters
        ----------
        G : G_i, Pa, >= 0.
        beta : beta_i, 1/s, >= 0.
        nu : Poisson's ratio, constant in time; this or ``bulk``.
        bulk : constant bulk modulus, Pa.  Then nu(t) is not constant; what the contact feels in plane
            strain, (1 - nu^2)/E = 1/(4 G) + 3/(4 (3 K + G)) of operators, is kept exactly, with modes of both
            terms, and ``nu`` is the long-time one.
        G0 : instantaneous shear modulus, Pa, from which the G_i take away; this, ``G_inf`` or a pair
            with beta = 0.
        G_inf : long-time shear modulus, Pa.
        more : ``name`` and ``density`` of the material.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths, no long-time modulus or several, both or
            neither of nu and bulk.
        """
        strengths, rates = pairs("G", G, "beta", beta, strict=False)
        resting = rates == 0.0
        rest = _long_time(strengths, G0, G_inf, strengths[resting])
        strengths, times = strengths[~resting], 1.0 / rates[~resting]
        if (nu is None) == (bulk is None):
            raise one_of("nu", "bulk", both=nu is not None)
        if bulk is None:
            nu, prony = poisson(nu), Prony(strengths / rest, times)
        else:
            nu, prony = plane_strain(rest, strengths, times, number("bulk", bulk, unit=SI, low=0.0, strict=True))
        return cls(E=2.0 * (1.0 + nu) * rest, nu=nu, prony=prony, **more)  # type: ignore[call-arg]

    @classmethod
    def _relative(
        cls, E: float, nu: float, name: str, shares: ArrayLike, tau: ArrayLike, long: bool, more: dict
    ) -> Any:
        """From shares of the instantaneous modulus; ``long``: E is the long-time modulus."""
        E = number("E0", E, unit=SI, low=0.0, strict=True)
        values, tau = pairs(name, shares, "tau", tau)
        left = 1.0 - math.fsum(values)
        if not left > 0.0:
            raise ParameterError(name, f"{values.tolist()}", "of a sum below 1: no long-time modulus would be left")
        return cls(E=E if long else E * left, nu=nu, prony=Prony(values / left, tau), **more)  # type: ignore[call-arg]


def poisson(nu: Any) -> float:
    """Poisson's ratio in (-1, 0.5]; raises ParameterError."""
    nu = number("nu", nu)
    if not -1.0 < nu <= 0.5:
        raise ParameterError("nu", nu, "in (-1, 0.5]")
    return nu


def pairs(name: str, values: ArrayLike, other: str, at: ArrayLike, *, strict: bool = True) -> tuple[Floats, Floats]:
    """Two lists of one length, the first >= 0, the second > 0 (>= 0 unless ``strict``); raises ParameterError."""
    first = checked(name, values, unit="Pa" if name == "G" else "1", low=0.0)
    second = checked(other, at, unit="s" if other == "tau" else "s-1", low=0.0, strict=strict)
    if first.ndim != 1 or first.shape != second.shape:
        raise ParameterError(other, f"of shape {second.shape}", f"one for each {name}, of shape {first.shape}")
    return first, second


def _long_time(strengths: NDArray, G0: float | None, G_inf: float | None, resting: NDArray) -> float:
    """The long-time shear modulus of LS-DYNA's three ways to give it."""
    ways = {
        "G0": None if G0 is None else number("G0", G0, unit=SI) - math.fsum(strengths),
        "G_inf": G_inf,
        "beta = 0": math.fsum(resting) if resting.size else None,
    }
    given = {name: value for name, value in ways.items() if value is not None}
    if len(given) != 1:
        found = " and ".join(given) or "nothing"
        raise ParameterError("long-time modulus by", found, "one of G_inf, G0 and a pair with beta = 0")
    (name, value), named = given.popitem(), {"G0": "G0 - sum G", "beta = 0": "G of beta = 0"}
    return number(named.get(name, name), value, unit="Pa", low=0.0, strict=True)


def plane_strain(G_inf: float, G: NDArray, tau: NDArray, K: float) -> tuple[float, Prony]:
    """(long-time nu, series of E/(1 - nu^2)) of a relaxing shear modulus and a constant bulk modulus K.

    As operators (1 - nu^2)/E = (3 K + 4 G)/(4 G (3 K + G)) = 1/(4 G) + 3/(4 (3 K + G)): two materials in series,
    whose creep terms add up.
    """
    first, second = Prony(G / G_inf, tau), Prony(G / (3.0 * K + G_inf), tau)
    soft, hard = 0.25 / G_inf, 0.75 / (3.0 * K + G_inf)
    nu = (3.0 * K - 2.0 * G_inf) / (6.0 * K + 2.0 * G_inf)
    return nu, Bodies(first, second, soft / (soft + hard)).total
