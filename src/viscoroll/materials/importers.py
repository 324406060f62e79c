"""Materials as finite element programs and files state them: constructors of :class:`Material`.

All of the programs relax the shear modulus, G(t), and may relax the bulk modulus, K(t).  Where
the bulk terms are not given, Poisson's ratio is taken constant in time, so that E(t) = 2 (1 + nu)
G(t) relaxes alike.  Where they are given and differ from those of shear, nu changes with time;
:func:`plane_strain` keeps what a contact in plane strain feels.
"""

import math
from typing import Any, Self

import numpy as np

from ..core import (
    SI,
    ArrayLike,
    FilePath,
    Floats,
    NDArray,
    ParameterError,
    check_array,
    check_bool,
    check_names,
    check_number,
    check_one_given,
    described_error,
    exactly_one_error,
    shape_error,
    warn_of_model,
)
from .bodies import Bodies
from .prony import Prony

#: keywords that every constructor passes to :class:`Material`
_MATERIAL_KEYWORDS = ("name", "density", "thickness", "measured", "temperature")
#: Poisson's ratio below which imported bulk terms warn: solid rubber has 0.3 (glass) to 0.5; the
#: last digits leave room for rounding of 0.2 itself
_LEAST_POISSON = 0.2 - 1e-9


class FromPrograms:
    """Constructors of :class:`Material`; in those of programs T_ref is 1 s, so that times in s are
    kept as given.

    A ``temperature`` outside -150 to 200 degrees Celsius gives a ModelWarning: it looks like one in
    kelvin.  So do bulk terms by which Poisson's ratio is below 0.2 at some time: they look like
    those of another unit.
    """

    @classmethod
    def abaqus(
        cls,
        E0: float,
        nu: float,
        g: ArrayLike,
        tau: ArrayLike | None = None,
        *,
        k: ArrayLike | None = None,
        long_term: bool = False,
        **more: Any,
    ) -> Any:
        """Make the material of ``*VISCOELASTIC, TIME=PRONY`` under ``*ELASTIC``.

        g_R(t) = G(t)/G0 = 1 - sum g_i (1 - exp(-t/tau_i)), so that E_i = g_i/(1 - sum g), and
        k_R(t) = K(t)/K0 alike: Abaqus 2017, Materials, "Time domain viscoelasticity"
        (abaqus-docs.mit.edu, simamat-c-timevisco).

        Parameters
        ----------
        E0 : modulus of ``*ELASTIC``, Pa, finite, > 0: the instantaneous one, or the long-time one
            where ``long_term`` (``MODULI=LONG TERM``).
        nu : Poisson's ratio of ``*ELASTIC``, in (-1, 0.5], of the same time as E0.  Without ``k``
            it is taken constant in time, as k_i = g_i make it.
        g : g_i, fractions of the instantaneous shear modulus, >= 0, of a sum below 1, (n,); or the
            table (n, 3) of ``*VISCOELASTIC``, a row (g_i, k_i, tau_i) each, without ``tau`` and
            ``k``.
        tau : relaxation times tau_i, s, > 0, (n,); None where ``g`` is the table.
        k : k_i, fractions of the instantaneous bulk modulus, >= 0, of a sum below 1, at the same
            times; zeros are a constant bulk modulus, which is also what Abaqus takes where they are
            left out.  Where they differ from g, nu of the material is that of long times, and its
            series that of E/(1 - nu^2) in plane strain.  For nu = 0.5 they are checked, but have no
            effect.
        long_term : whether E0 and nu are those of long times; default: instantaneous.
        more : ``name``, ``density``, ``thickness``, ``measured``, ``temperature`` of the material.

        Returns
        -------
        Material
            With its long-time modulus, and T_ref = 1 s.  Without ``k``, where k equals g, and for
            nu = 0.5, E is E0 times 1 less the sum of g, or E0 with ``long_term``, and nu is that
            given; else both are those of the long-time moduli G and K.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths, more than 64 terms or times that span
            more than 32 decades, a table of another shape or with ``k``, a ``long_term`` that is no
            truth value, an unknown keyword; where k differs from g, more than 64 creep modes of
            shear and bulk together.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.abaqus(10e6, 0.49, [[0.2, 0.2, 0.1], [0.3, 0.3, 10.0]]).E
        5000000.0
        """
        if tau is None:
            table = check_array("g", g, low=0.0)
            if table.ndim != 2 or table.shape[1] != 3:
                raise ParameterError(
                    "tau",
                    None,
                    "one time for each g",
                    "tau is not given: give one tau for each g; or as g the table *VISCOELASTIC, "
                    f"with the columns g_i, k_i, tau_i; g has shape {table.shape}",
                )
            if k is not None:
                raise ParameterError(
                    "k", k, "left out, since g is a table that contains it (g_i, k_i, tau_i)"
                )
            g, k, tau = table.T
        long_term = check_bool("long_term", long_term)
        return cls._from_fractions(E0, nu, "g", g, tau, k, more, long_term)

    @classmethod
    def ansys(
        cls,
        E0: float,
        nu: float,
        alpha: ArrayLike,
        tau: ArrayLike,
        *,
        k: ArrayLike | None = None,
        **more: Any,
    ) -> Any:
        """Make the material of ``TB,PRONY,,,,SHEAR`` (and ``BULK``) under ``MP,EX`` and
        ``MP,PRXY``.

        G(t) = G0 (alpha_inf + sum alpha_i exp(-t/tau_i)), alpha_inf = 1 - sum alpha_i, K(t) alike:
        Mechanical APDL, Material Reference, "Viscoelasticity", whose elastic constants are those of
        t = 0.

        Parameters
        ----------
        E0 : instantaneous Young's modulus EX, Pa, finite, > 0.
        nu : instantaneous Poisson's ratio PRXY, in (-1, 0.5].  Without ``k`` it is taken constant
            in time, as a bulk table equal to that of shear makes it.
        alpha, tau : the pairs alpha_i (dimensionless, >= 0, of a sum below 1) and tau_i (s, > 0) of
            the table ``SHEAR``, (n,) each.
        k : alpha_i of the table ``BULK`` at the same times, >= 0, of a sum below 1, (n,); zeros are
            a constant bulk modulus.  If that table has other times, give all times of both as
            ``tau``, and 0 in ``alpha`` or ``k`` where a table has no term.  For nu = 0.5 it is
            checked, but has no effect.
        more : as in :meth:`abaqus`.

        Returns
        -------
        Material
            With its long-time modulus, and T_ref = 1 s.  Without ``k``, where k equals alpha, and
            for nu = 0.5, E is E0 (1 - sum alpha), nu is that given, and the series is that of G(t),
            of strengths E_i = alpha_i/(1 - sum alpha).  Else E and nu are those of the long-time
            moduli G and K, and the series is that of E/(1 - nu^2) in plane strain.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths, more than 64 terms or times that span
            more than 32 decades, an unknown keyword; where k differs from alpha, more than 64 creep
            modes of shear and bulk together.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.ansys(10e6, 0.49, alpha=[0.2, 0.3], tau=[0.1, 10.0]).E
        5000000.0
        """
        return cls._from_fractions(E0, nu, "alpha", alpha, tau, k, more)

    @classmethod
    def comsol(
        cls,
        E: float,
        nu: float,
        G: ArrayLike,
        tau: ArrayLike,
        *,
        K: ArrayLike | None = None,
        **more: Any,
    ) -> Any:
        """Make the material of a generalized Maxwell node under Linear Elastic Material.

        G(t) = G + sum G_m exp(-t/tau_m), G that of the main elastic branch: COMSOL Structural
        Mechanics Module User's Guide, "Linear Viscoelasticity" (doc.comsol.com, sme_ug_theory).

        Parameters
        ----------
        E, nu : Young's modulus, Pa, finite, > 0, and Poisson's ratio, in (-1, 0.5], of the elastic
            node: the long-time values (static stiffness "Long-term").  Without ``K`` nu is taken
            constant in time.
        G : shear moduli G_m of the branches, Pa, >= 0, (n,).
        tau : their relaxation times tau_m, s, finite, > 0, (n,).
        K : bulk moduli of the branches, Pa, >= 0, at the same times, (n,); zeros where only
            deviatoric strains are viscoelastic.  For nu = 0.5 they are checked, but have no effect.
        more : as in :meth:`abaqus`.

        Returns
        -------
        Material
            With the given E and nu, and T_ref = 1 s.  Its series is that of G(t), of strengths
            G_m/G with G = E/(2 (1 + nu)); where nu < 0.5 and K(t) is not in proportion to G(t),
            that of E/(1 - nu^2) in plane strain.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths, more than 64 terms or times that span
            more than 32 decades, an unknown keyword; where K is not in proportion to G, more than
            64 creep modes of shear and bulk together.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.comsol(3e6, 0.5, G=[2e6], tau=[0.01]).instant  # long-time G is 1 MPa
        9000000.0
        """
        E = check_number("E", E, unit=SI, above=0.0)
        nu = check_poisson(nu)
        strengths, times = check_pairs("G", G, "tau", tau)
        bulk = None if K is None else check_pairs("K", K, "tau", times)[0]
        G_inf = E / (2.0 * (1.0 + nu))
        return cls._from_moduli(G_inf, nu, strengths, times, bulk, more, E=E)

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
        K: ArrayLike | None = None,
        **more: Any,
    ) -> Any:
        """Make the material of ``*MAT_GENERAL_VISCOELASTIC`` (076), or of ``*MAT_VISCOELASTIC``
        (006) as one pair.

        G(t) = sum G_i exp(-beta_i t), G_i absolute and beta_i = 1/tau_i; a pair with beta = 0 is
        the long-time modulus: LS-DYNA Keyword Manual, Vol. II.  In 006 G(t) = G_inf + (G0 - G_inf)
        exp(-beta t) (help.altair.com, mat_006_viscoelastic): give G = [G0 - G_inf] and G_inf.

        Parameters
        ----------
        G : G_i, Pa, >= 0, (n,).
        beta : beta_i, 1/s, >= 0, (n,).
        nu : Poisson's ratio, in (-1, 0.5], constant in time, with ``K`` that of long times; exactly
            one of this, ``bulk`` and a K_i with beta = 0 is given.
        bulk : constant bulk modulus, Pa, > 0, with ``K`` that of long times.  Then nu(t) is not
            constant; what the contact feels in plane strain is kept exactly (:func:`plane_strain`),
            and ``nu`` of the material is the long-time one.
        G0 : instantaneous shear modulus, Pa, above the sum of all G_i, which is subtracted from it;
            exactly one of this, ``G_inf`` and a pair with beta = 0 is given.
        G_inf : long-time shear modulus, Pa, > 0.
        K : K_i, Pa, >= 0, at the same beta, (n,); that with beta = 0, if it is not 0, is the
            long-time one, in place of ``nu`` and ``bulk``.  None: the bulk modulus is constant if
            ``bulk`` is given, else relaxes in proportion to G.  For nu = 0.5 it is checked, but has
            no effect.
        more : as in :meth:`abaqus`.

        Returns
        -------
        Material
            With its long-time modulus 2 (1 + nu) G(infinity), nu of long times, and T_ref = 1 s.
            Its series is that of G(t), of strengths G_i/G(infinity) and times 1/beta_i; where nu <
            0.5 and K(t) is not in proportion to G(t), that of E/(1 - nu^2) in plane strain.

        Raises
        ------
        ParameterError
            A value out of range, lists of different lengths, more than 64 terms or times that span
            more than 32 decades, no long-time modulus or several, both or neither of nu and bulk,
            an unknown keyword; more than 64 creep modes of shear and bulk together where these do
            not relax in proportion.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.lsdyna(G=[2e6, 1e6], beta=[100.0, 0.0], nu=0.5).E
        3000000.0
        """
        strengths, rates = check_pairs("G", G, "beta", beta)
        resting = rates == 0.0
        rest = _long_time_shear(strengths, G0, G_inf, strengths[resting])
        strengths = strengths[~resting]
        times = 1.0 / rates[~resting]  # beta = 0 is the long-time modulus, no mode
        terms = None
        if K is not None:
            terms, _ = check_pairs("K", K, "beta", rates)
            if terms[resting].any():
                if nu is not None or bulk is not None:
                    raise exactly_one_error("nu (or bulk)", "a K with beta = 0", both=True)
                bulk = math.fsum(terms[resting])
            terms = terms[~resting]
        check_one_given(nu=nu, bulk=bulk)
        if bulk is not None:
            bulk = check_number("bulk", bulk, unit=SI, above=0.0)
            nu = _poisson(rest, bulk)
            # a bulk modulus that does not relax
            terms = np.zeros_like(strengths) if terms is None else terms
        return cls._from_moduli(rest, check_poisson(nu), strengths, times, terms, more, K_inf=bulk)

    @classmethod
    def from_netcdf(cls, path: FilePath) -> Self:
        """Read a file that :meth:`Material.to_netcdf` wrote, to the bit
        (``tests/materials/test_material.py``).

        Parameters
        ----------
        path : file; its SHA-256 is compared before anything is parsed.

        Returns
        -------
        Material
            Equal to the one that was written.

        Raises
        ------
        FileError
            A file that is missing, larger than 128 MiB, damaged in any byte, without the SHA-256 at
            its end, or no material, or has values out of range.

        Examples
        --------
        >>> import viscoroll as vr
        >>> steel = vr.Material.elastic(2.1e11, 0.3)
        >>> steel.to_netcdf("steel.nc")
        >>> vr.Material.from_netcdf("steel.nc") == steel
        True
        """
        from .checked_netcdf import load_material

        return load_material(path, cls)

    @classmethod
    def _from_fractions(
        cls,
        E: float,
        nu: float,
        name: str,
        fractions: ArrayLike,
        tau: ArrayLike,
        bulk: ArrayLike | None,
        more: dict[str, Any],
        long_term: bool = False,
    ) -> Any:
        """Make a material from terms that are fractions of the instantaneous moduli.

        G(t) = G(0) (1 - sum g_i (1 - exp(-t/tau_i))), and K(t) alike with k_i: the long-time
        modulus is G_inf = G(0) (1 - sum g_i), and a term of G(t)/G_inf is g_i/(1 - sum g_i).

        E, nu: Young's modulus, Pa, and Poisson's ratio, of long times if ``long_term``, else
            instantaneous.
        name: name of the parameter ``fractions``, for errors.
        fractions: g_i, dimensionless, (terms,), >= 0, with a sum below 1.
        tau: relaxation times, s, > 0, (terms,).
        bulk: k_i, dimensionless, (terms,), >= 0, with a sum below 1; None: k_i = g_i, so that nu is
            constant in time.  At nu = 0.5, where K is infinite, they are checked and have no
            effect.
        more: further keywords of the material, name -> value, as "name" and "density".
        long_term: True: E and nu are those of long times; False: they are instantaneous.
        Returns the material, of the class ``cls``, with E and nu of long times.
        Raises ParameterError for values out of range, lists of different lengths, too many terms,
        and an unknown keyword.
        """
        E = check_number("E0", E, unit=SI, above=0.0)
        nu = check_poisson(nu)
        values, times = check_pairs(name, fractions, "tau", tau)
        rest = _remaining_fraction(name, values)
        others = values if bulk is None else check_pairs("k", bulk, "tau", times)[0]
        if np.array_equal(values, others):  # nu is constant in time
            late = E if long_term else E * rest
            return cls._from_moduli(1.0, nu, values / rest, times, None, more, E=late)
        rest_of_bulk = _remaining_fraction("k", others)
        G = E / (2.0 * (1.0 + nu))
        # of an incompressible body, which has no bulk strain, K has no effect
        K = E / (3.0 * (1.0 - 2.0 * nu)) if nu < 0.5 else 1.0
        G, K = (G, K) if long_term else (G * rest, K * rest_of_bulk)
        if nu < 0.5:  # nu of long times
            nu = _poisson(G, K)
        bulk_terms = others / rest_of_bulk * K
        return cls._from_moduli(G, nu, values / rest * G, times, bulk_terms, more, K_inf=K)

    @classmethod
    def _from_moduli(
        cls,
        G_inf: float,
        nu: float,
        G: Floats,
        tau: Floats,
        K: Floats | None,
        more: dict[str, Any],
        K_inf: float | None = None,
        E: float | None = None,
    ) -> Any:
        """Make a material from the terms of its moduli.

        G_inf, nu: shear modulus, in any unit (in Pa if ``E`` is None), and Poisson's ratio of long
            times.
        G: terms of G(t), in the unit of G_inf, (terms,).
        tau: relaxation times, s, (terms,).
        K: terms of K(t), in the unit of G_inf, (terms,); None: nu is constant in time.  Ignored for
            an incompressible body, nu = 0.5, which has no bulk strain.
        more: keywords of the material, as ``name`` and ``density``.
        K_inf: bulk modulus of long times, in the unit of G_inf; None: it follows from E and nu.
            Used only with ``K``.
        E: Young's modulus of long times, Pa; None: 2 (1 + nu) G_inf.
        Returns the material, of the class ``cls``, with T_ref = 1 s.  Its series is that of G(t);
        where K is not proportional to G it is that of E/(1 - nu^2) (:func:`plane_strain`).
        Raises ParameterError for values out of range, too many terms, and an unknown keyword.
        """
        E = 2.0 * (1.0 + nu) * G_inf if E is None else E
        prony = Prony(G / G_inf, tau)
        early = None
        if K is not None and nu < 0.5:  # an incompressible body has no bulk strain that could relax
            K_inf = E / (3.0 * (1.0 - 2.0 * nu)) if K_inf is None else K_inf
            if not np.array_equal(K * G_inf, G * K_inf):
                prony = plane_strain(G_inf, G, K_inf, K, tau)
                early = _poisson(G_inf + math.fsum(G), K_inf + math.fsum(K))
            _warn_of_low_poisson(G_inf, G, K_inf, K, tau)
        check_names("argument", more, _MATERIAL_KEYWORDS, "known beside moduli and times")
        return cls(E=E, nu=nu, prony=prony, nu_instant=early, **more)  # type: ignore[call-arg]


def check_poisson(nu: Any, name: str = "nu") -> float:
    """Check Poisson's ratio, and return it as a float.

    nu: what a caller gave.
    name: name of the argument, for the error.
    Raises ParameterError for what is no number in (-1, 0.5].
    """
    return check_number(name, nu, above=-1.0, high=0.5)


def _poisson(G: Any, K: Any) -> Any:
    """Return Poisson's ratio (3 K - 2 G)/(6 K + 2 G) of shear and bulk modulus in one unit, numbers
    or arrays.
    """
    return (3.0 * K - 2.0 * G) / (6.0 * K + 2.0 * G)


def _warn_of_low_poisson(G_inf: float, G: Floats, K_inf: float, K: Floats, tau: Floats) -> None:
    """Give a ModelWarning where G(t) and K(t) make Poisson's ratio lower at some time than that of
    any rubber, :data:`_LEAST_POISSON`; one of them is then likely to be in another unit.

    G_inf, G, K_inf, K, tau: as in :func:`plane_strain`.
    Times that are examined: 0, infinity, and 0.1, 1 and 10 times each of tau.
    """
    # rows: what is left of each term at each of the times, and nothing at infinity
    ratio = np.outer((0.0, 0.1, 1.0, 10.0), tau).reshape(-1, 1) / tau
    left = np.vstack([np.exp(-ratio), np.zeros_like(tau)])
    lowest = np.min(_poisson(G_inf + left @ G, K_inf + left @ K))
    if lowest < _LEAST_POISSON:
        warn_of_model(
            f"terms of shear and bulk give Poisson's ratio {lowest:.3g} at some time, but solid "
            f"rubber has at least {_LEAST_POISSON:g}: check that both are fractions of moduli "
            "(abaqus, ansys), or both moduli in Pa (comsol, lsdyna, there with bulk= too)"
        )


def check_pairs(name: str, values: ArrayLike, other: str, at: ArrayLike) -> tuple[Floats, Floats]:
    """Check two lists of equal length, and return them as arrays in SI units.

    name, values: name of the first list, for errors, and its numbers, >= 0; in Pa if it is called G
        or K, else dimensionless.  Values with a unit are converted.
    other, at: name of the second list, for errors, and its numbers; times in s, > 0, if it is
        called tau, else rates in 1/s, >= 0.
    Returns (numbers of the first list, numbers of the second), (n,) each; n may be 0.
    Raises ParameterError for numbers out of range, lists of different lengths, and other shapes
    than (n,).
    """
    first = check_array(name, values, unit="Pa" if name in ("G", "K") else "1", low=0.0)
    bounds = {"unit": "s", "above": 0.0} if other == "tau" else {"unit": "s-1", "low": 0.0}
    second = check_array(other, at, **bounds)
    if first.ndim != 1:
        raise shape_error(
            name, first.shape, f"a list, as [0.1, 0.2], with one number for each {other}"
        )
    if first.shape != second.shape:
        raise described_error(
            name,
            f"has shape {first.shape} and {other} has shape {second.shape}",
            "lists of the same length",
        )
    return first, second


def _long_time_shear(
    strengths: NDArray, G0: float | None, G_inf: float | None, resting: NDArray
) -> float:
    """Return the long-time shear modulus of LS-DYNA, Pa, > 0, by exactly one of its three ways.

    strengths: all G_i, Pa, (terms,).
    G0: instantaneous shear modulus, Pa, from which all G_i are subtracted; None: not given.
    G_inf: long-time shear modulus, Pa; None: not given.
    resting: those G_i whose beta is 0, Pa, whose sum is the third way; empty: not given.
    Raises ParameterError for none or several of these ways, and for a modulus that is not > 0.
    """
    ways = {
        "G0": None if G0 is None else check_number("G0", G0, unit=SI) - math.fsum(strengths),
        "G_inf": G_inf,
        "beta = 0": math.fsum(resting) if resting.size else None,
    }
    given = {name: value for name, value in ways.items() if value is not None}
    if len(given) != 1:
        raise described_error(
            "the long-time shear modulus",
            f"is given by {' and '.join(given) or 'no argument'}",
            "given by exactly one of G_inf, G0 and a pair (G_i, beta_i) with beta_i = 0",
        )
    name, value = given.popitem()
    named = {
        "G0": "G0 - sum of G (long-time shear modulus, Pa)",
        "beta = 0": "sum of G with beta = 0 (long-time shear modulus, Pa)",
    }
    return check_number(named.get(name, name), value, unit="Pa", above=0.0)


def _remaining_fraction(name: str, fractions: Floats) -> float:
    """Return 1 - sum fractions, the long-time modulus divided by the instantaneous one, in (0, 1].

    name: name of the parameter, for errors.
    fractions: fractions of the instantaneous modulus that relax, >= 0, (terms,); 1 is returned
        without terms.
    Raises ParameterError where the sum is 1 or more, or NaN.
    """
    rest = 1.0 - math.fsum(fractions)
    if not rest > 0.0:
        raise ParameterError(
            f"sum of {name}",
            f"{1.0 - rest:g}",
            "below 1, since 1 minus this sum is the part of the modulus left at long times",
        )
    return rest


def plane_strain(G_inf: float, G: NDArray, K_inf: float, K: NDArray, tau: NDArray) -> Prony:
    """Return the series of E/(1 - nu^2), divided by its long-time value, if shear and bulk modulus
    both relax.

    As operators (1 - nu^2)/E = (3 K + 4 G)/(4 G (3 K + G)) = 1/(4 G) + 3/(4 (3 K + G)): two
    materials in series, whose creep terms are added (the correspondence principle of linear
    viscoelasticity).

    Parameters
    ----------
    G_inf, K_inf : long-time moduli, > 0 (not checked), in one unit.
    G, K : strengths of their terms in that unit, >= 0, shape (n,) each; 0 where one of them has no
        term at that time.
    tau : relaxation times of both, s, > 0, shape (n,).

    Returns
    -------
    Prony
        In creep form, with times in s; up to 2 n modes.  Accurate to 1e-14
        (``test_what_the_contact_feels_under_a_bulk_modulus_that_relaxes``).

    Raises
    ------
    ParameterError
        Strengths or times out of range, more than 64 creep modes of both together, times that span
        more than 32 decades.
    """
    stiff = 3.0 * K_inf + G_inf
    first = Prony(G / G_inf, tau)
    second = Prony((3.0 * K + G) / stiff, tau)
    # long-time compliances of the two materials in series
    soft = 0.25 / G_inf
    hard = 0.75 / stiff
    return Bodies(first, second, soft / (soft + hard)).total
