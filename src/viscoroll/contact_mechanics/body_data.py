"""Data of the bodies of a cylinder in SI units, and the assumptions that need them:
:class:`BodyData`; among them the strain of a contact, beside that of the data of its materials:
:func:`assess_strain`.

Under an elliptic pressure p_0 sqrt(1 - (x/a)^2) on a half-space the largest shear stress at the
axis is 0.300 p_0, at the depth 0.786 a (K. L. Johnson, Contact Mechanics, 1985, Sect. 4.2), with
p_0 = E* a/(2 R).  In a layer it follows from the field of the layer under such a pressure of the
same load.
"""

import dataclasses
import math
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ..core import SI, Floats, check_number
from ..laws import law_table
from ..materials import Measured, Pair
from .assumptions import (
    LEAST_KAPPA,
    MISFIT_LIMIT,
    Assumption,
    Validity,
    assess_coupling,
    assess_inertia,
    assess_measured_band,
    largest,
    transit_frequency,
    transit_speeds,
)
from .contact_table import pure_rolling_fields
from .parameters import Parameters

# --- The strain of a contact ---

#: Largest shear stress at the axis of a half-space over p_0: the maximum of s - s^2/sqrt(1 + s^2)
#: over the depth s.
SHEAR = math.sqrt(0.5 * (5.0 * math.sqrt(5.0) - 11.0))
#: Largest ratio of the strain of the contact to that of the data, and its inverse the least: filled
#: rubbers soften by up to a factor of 5 between 0.1 and 10 %, so that a factor 3 of strain changes
#: the moduli by up to 1.5.
STRAIN_RATIO = 3.0
#: Half contact lengths, divided by the thickness, at which the field of a layer is computed, and
#: interpolated between.
_THETA = np.geomspace(1e-2, 8.0, 60)
#: Nodes of wavenumber and depth of that field: the error is below 1e-3.
_WAVES = 4000
_DEPTHS = 81


def assess_strain(data: Any, V: Any, length: Any) -> Assumption:
    """Compare the amplitude of engineering shear strain at the axis with that of the data of the
    bodies.

    data: the bodies, a :class:`BodyData`.
    V, length: speed, m/s, and contact length, m, arrays of one shape, which broadcasts with the
        load.
    Returns the assumption ``strain``, whose value is the strain of the softest body, dimensionless;
    it holds where that of each body with data is between a third and three times the strain of its
    data, and is undecided without such.
    """
    strains = _strains(data, V, length)
    value = np.max(np.broadcast_arrays(*strains.values()), axis=0)
    sentence = f"the strain of the contact is up to {100.0 * largest(value):.2g} %"
    known = {
        name: record.strain for name, record in data.records.items() if record.strain is not None
    }
    if not known:
        return Assumption(
            None,
            value,
            f"{sentence} (amplitude of shear strain); that of the measurements is not known: give "
            "vr.Measured(..., strain=) to the material",
        )
    holds = True
    for name, strain in known.items():
        own = strains[name] / strain
        holds = holds & (own <= STRAIN_RATIO) & ((own >= 1.0 / STRAIN_RATIO) | (V == 0.0))
        sentence += f"; {name} was measured at {100.0 * strain:.2g} %"
    return Assumption(
        holds, value, f"{sentence}; a third to three times the measured strain is allowed"
    )


def _strains(data: Any, V: Any, length: Any) -> dict[str, Any]:
    """Return the amplitude of the engineering shear strain at the axis in each deformable body.

    data: the bodies, a :class:`BodyData`.
    V, length: speed, m/s, and contact length, m, arrays of one shape, which broadcasts with the
        load.
    Returns name of the body ("the material" where both are alike, as thick and measured alike) ->
    strain, dimensionless, in the broadcast shape.
    """
    slenderness = 0.25 * length / data.R
    if data.pair is None:  # both of the paper's material
        return {
            "the material": 0.5 * SHEAR * slenderness * _modulus_over_shear(data.nu, data.plane)
        }
    bodies = {name: body for name, (body, _) in data.bodies.items()}
    rate = np.abs(V) / length
    G = {name: body.storage(rate) / (2.0 * (1.0 + body.nu)) for name, body in bodies.items()}
    # compliances 1/E* of both bodies: the peak pressure is E* a/(2 R) with the sum of both
    whole = (
        2.0
        / len(bodies)
        * sum(
            1.0 / (G[name] * _modulus_over_shear(body.nu, data.plane))
            for name, body in bodies.items()
        )
    )
    found = {}
    for name, body in bodies.items():
        if body.is_rigid:
            continue
        found[name] = SHEAR * slenderness / (G[name] * whole)
        if body.thickness is not None:
            part = np.interp(0.5 * length / body.thickness, _THETA, _layer_shear(body.nu))
            # the peak of the elliptic pressure of the load is 4 P/(pi length)
            found[name] = part * 4.0 * data.load / (math.pi * length * G[name])
    return found


def _modulus_over_shear(nu: Any, plane: str) -> Any:
    """Return E*/G of a body beside a rigid one: 2/(1 - nu) in plane strain, 2 (1 + nu) in plane
    stress.
    """
    return 2.0 / (1.0 - nu) if plane == "strain" else 2.0 * (1.0 + nu)


@lru_cache(maxsize=8)
def _layer_shear(nu: float) -> Floats:
    """Return the largest shear stress at the axis of a bonded layer, divided by the peak p_0 of the
    elliptic pressure on it, for the ratios :data:`_THETA` of half contact length to thickness.

    The stress function of the wave number k is f(z) cos(kx) with f = (A + B kz) cosh kz + (C + D
    kz) sinh kz at the depth z.  The stresses are sigma_x = f'' cos(kx), sigma_z = -k^2 f cos(kx)
    and tau = k f' sin(kx).  At z = 0 the pressure is given and tau = 0, so that C = -B; at z = h
    both displacements are 0.  At x = 0 the shear stress is |sigma_x - sigma_z|/2 = |f'' + k^2 f|/2.
    The elliptic pressure of half length a is the integral of p_0 J_1(ka)/k cos(kx) over k.

    nu: Poisson's ratio of the layer.
    Returns a vector, one number for each ratio, dimensionless.
    """
    from scipy import special

    found = np.empty(_THETA.size)
    for n, a in enumerate(_THETA.tolist()):  # of the thickness 1
        k = np.geomspace(1e-4, 60.0 / min(a, 1.0), _WAVES)
        z = np.linspace(0.0, min(2.5 * a, 1.0), _DEPTHS)[:, None]
        s = np.minimum(k, 25.0)
        # beyond k h = 25 cosh and sinh overflow the digits, and the layer is a half-space
        kz = s * z
        B, D = _layer_terms(s, nu)
        cosh = np.cosh(kz)
        sinh = np.sinh(kz)
        # f and f''/k^2 for A = 1, C = -B
        f = (1.0 + B * kz) * cosh + (D * kz - B) * sinh
        bend = (1.0 + B * kz + 2.0 * D) * cosh + (D * kz + B) * sinh
        # a half-space to rounding, where k > s
        difference = np.where(k > s, 2.0 * k * z * np.exp(-k * z), f + bend)
        # dk = k d ln k, in equal steps of ln k, cancels 1/k of the pressure
        shear = 0.5 * difference @ special.j1(k * a) * np.log(k[1] / k[0])
        found[n] = np.abs(shear).max()
    return found


def _layer_terms(s: Floats, nu: float) -> tuple[Floats, Floats]:
    """Return the coefficients B and D of :func:`_layer_shear` for A = 1 and C = -B, by which both
    displacements at z = h are 0.

    s: wave number times thickness, k h, > 0, (n,).
    nu: Poisson's ratio of the layer.
    Returns (B, D), (n,) each, dimensionless.
    """
    # of (1 - nu) f_zz + nu k^2 f = 0 and (1 - nu) f_zzz = (2 - nu) k^2 f_z at z = h
    a = 1.0 - 2.0 * nu
    b = 2.0 * (1.0 - nu)
    sinh = np.sinh(s)
    cosh = np.cosh(s)
    own = a * sinh**2 + b * cosh**2
    det = (a * sinh) ** 2 - (b * cosh) ** 2 - s * s
    return (s - (1.5 - 2.0 * nu) * np.sinh(2.0 * s)) / det, own / det


# --- The bodies of a cylinder ---

#: Acceleration by which a mass is compared with a load, m/s^2.
_GRAVITY = 9.81
#: Radius and thickness of a layer, m, from which a length may be in mm: few rollers are larger.
_LARGE_R = 5.0
_LARGE_THICKNESS = 0.5
#: Contact length over radius below which that radius is in mm: the lengths in mm, with the same
#: load and moduli, make a contact shorter than the radius, as l/R changes by sqrt(1000).
_SHORT_OVER_R = 1000.0**-0.5
#: Contact length over the thickness of a layer below which that thickness is in mm: the layer acts
#: as a half-space, and nobody gives it.
_SHORT_OVER_THICKNESS = 0.2
#: Smallest share of a body in the compliance, dimensionless, at which its data and its thickness
#: matter.
_LEAST_SHARE = 0.01
#: Transit frequency times the shortest relaxation time from which on a series has little loss: that
#: of its last term has fallen to a fifth of its maximum.
BEYOND_SERIES = 10.0
#: kappa lam at which the peak of an ellipse of pressure is E/(1 - nu^2), as in Hertz' theory.
_ABSURD = 0.25
#: (Lowest, highest) speed, m/s, of data that hold at no speed.
NO_SPEEDS = math.inf, 0.0
#: log2 of kappa V at which the contact length of a cover is evaluated: interpolation between them
#: has an error below 1 %.
_OCTAVES_OF_SPEED = np.arange(-80.0, 80.0, 0.25)


@dataclasses.dataclass(frozen=True, eq=False)
class BodyData:
    """Data of the bodies of one cylinder or of several that share their materials.

    Attributes
    ----------
    pair : both bodies; None where both are of the paper's material, one of a single relaxation
        time.
    E, nu : long-time Young's modulus, Pa, and Poisson's ratio of the paper's material, numbers or
        (n,); not used with a pair.
    R, l0 : radius and contact length at rest, m, numbers or (n,).
    T_ref : unit of time of the scene, s.
    plane : "strain" or "stress".
    scene : the dimensionless scene.
    load : N/m, a number or (n,).
    """

    pair: Pair | None
    E: Any
    nu: Any
    R: Any
    l0: Any
    T_ref: float
    plane: str
    scene: Parameters
    load: Any

    @cached_property
    def records(self) -> dict[str, Measured]:
        """Return what was measured of each different body whose share of the compliance counts.

        Returns a dict from the names of :attr:`bodies` to its :class:`Measured`; without bodies
        that have no record or a share of the compliance below 0.01.
        """
        return {
            name: body.measured
            for name, (body, share) in self.bodies.items()
            if share >= _LEAST_SHARE and body.measured is not None
        }

    @cached_property
    def bodies(self) -> dict[str, tuple[Any, Any]]:
        """Return the different bodies, of which some may be rigid.

        Returns a dict from "the material" (of bodies that are alike, as thick and measured alike),
        or "the cylinder" and "the base", to (its :class:`Material`; its share of the compliance);
        empty without a pair.
        """
        pair = self.pair
        if pair is None:
            return {}
        one = pair.cylinder
        other = pair.half_space
        if pair.like and (one.thickness, one.measured) == (other.thickness, other.measured):
            return {"the material": (one, 1.0)}
        return {"the cylinder": (one, pair.share), "the base": (other, 1.0 - pair.share)}

    @cached_property
    def measured_rates(self) -> tuple[float, float] | None:
        """Return (lowest, highest) |V|/l0, 1/s, at which the transit frequency is in
        ``transit_band`` of all bodies.

        |V|/l0 is used because it does not depend on load and radius for half-spaces.  For a cover
        the ends have an error below 1 %.  None where nothing was measured, and for an array of
        materials.  Bands that do not overlap give a lowest rate above the highest.  Raises
        ParameterError for a layer too thin for its law.
        """
        records = self.records.values()
        if not records or self.scene.series is None:
            return None
        lowest, highest = zip(*(data.transit_band for data in records), strict=True)
        low, high = self._rates_at(np.array([max(lowest), min(highest)])).tolist()
        return low, high

    def _rates_at(self, frequencies: Floats) -> Floats:
        """Return |V|/l0, 1/s, at which the transit frequency |V|/(lam l0) has given values, 1/s, >
        0, (n,); not for an array of materials.
        """
        frequencies = frequencies * self.T_ref
        if self.scene.cover is None:
            series: Any = self.scene.series
            return transit_speeds(series, frequencies) / self.T_ref
        u = np.exp2(_OCTAVES_OF_SPEED)
        (lam,) = pure_rolling_fields(law_table(self.scene.cover), u, "lam")
        # of u = |V|/l0 the transit frequency is u/lam, from which u is looked up
        return np.exp(np.interp(np.log(frequencies), np.log(u / lam), np.log(u))) / self.T_ref

    @cached_property
    def series_speeds(self) -> tuple[float, float] | None:
        """Return (0, highest |V|), m/s, at which the transit frequency of each cylinder is below 10
        divided by the shortest relaxation time of each rubber whose band is not known.

        Far above that speed a series has almost no loss, but a rubber has.  None without a body
        that has a temperature shift, no ``measured`` and a share of the compliance of at least
        0.01, and for an array of materials.
        """
        ends = [
            BEYOND_SERIES / (float(np.min(body.prony.tau)) * body.T_ref)
            for body, share in self.bodies.values()
            if share >= _LEAST_SHARE
            and body.measured is None
            and body.shift is not None
            and body.prony.tau.size
        ]
        if not ends or self.scene.series is None:
            return None
        return 0.0, float(self._rates_at(np.array([min(ends)]))[0] * np.min(self.l0))

    @cached_property
    def measured_speeds(self) -> tuple[float, float] | None:
        """Return (lowest, highest) |V|, m/s, at which the transit frequency of each cylinder is in
        ``transit_band``.

        None without data.  A transit frequency at an end of a band is inside.  No speed is between
        them (the lowest is above the highest) where the bands have no speed in common;
        :data:`NO_SPEEDS` for a fit that misses its data by more than 5 %.
        """
        if self.measured_rates is None:
            return None
        if any(data.misfit > MISFIT_LIMIT for data in self.records.values()):
            return NO_SPEEDS
        low, high = self.measured_rates
        # for speeds that are inside for every cylinder
        return low * float(np.max(self.l0)), high * float(np.min(self.l0))

    @cached_property
    def small_at_rest(self) -> bool:
        """Whether no contact at rest is longer than the radius: whether every kappa is at least
        1.
        """
        return bool(np.all(self.scene.kappa >= LEAST_KAPPA))

    @cached_property
    def in_metres(self) -> bool:
        """Whether lengths seem to be in m; False where a radius or the thickness of a layer looks
        like one in mm: it is large, and the contact length of this load is short beside it.
        """
        layers = [body.thickness for body, _ in self.bodies.values() if body.thickness is not None]
        limits = [(h, _LARGE_THICKNESS, _SHORT_OVER_THICKNESS) for h in layers]
        limits.append((self.R, _LARGE_R, _SHORT_OVER_R))
        return not any(
            np.any((size >= least) & (self.l0 < part * size)) for size, least, part in limits
        )

    @cached_property
    def soft_for_load(self) -> bool:
        """Whether the peak pressure on a cover at rest exceeds the modulus E/(1 - nu^2) of long
        times.

        An elliptic pressure has the peak 2 P/(pi a) on the half length a, which exceeds the modulus
        where kappa lam is below 1/4.  False for half-spaces, on which the contact is then longer
        than the radius (:attr:`small_at_rest`), and for many covers.
        """
        if self.scene.cover is None or self.scene.cover.shape:
            return False
        return float(np.min(self.scene.kappa * self.relative_length(0.0))) < _ABSURD

    @cached_property
    def covered_speeds(self) -> tuple[float, float] | None:
        """Return (lowest, highest) |V|, m/s, between which contacts do not warn; None where no
        speed gives a warning.

        :data:`NO_SPEEDS` (or a lowest speed above the highest) where every speed gives one, for
        example where the contact at rest is longer than the radius, or the radius seems to be in
        mm.
        """
        waves = self.wave_speed and (0.0, self.wave_speed)
        bands = [self.measured_speeds, self.series_speeds, waves]
        if self.soft_for_load or not (self.small_at_rest and self.in_metres):
            bands.append(NO_SPEEDS)
        known = [band for band in bands if band]
        if not known:
            return None
        lowest, highest = zip(*known, strict=True)
        return max(lowest), min(highest)

    @cached_property
    def wave_speed(self) -> float | None:
        """Speed of the slowest shear wave in any of the cylinders, m/s; None where no density is
        known.
        """
        # the ratio of a speed of 1 m/s
        slowness = self.wave_ratio(np.ones(()), None)[0]
        return None if slowness is None else 1.0 / float(np.max(slowness))

    def relative_length(self, rate: Any) -> Any:
        """Return the contact length divided by l0, for bodies of one material or pair, or one
        cover.

        rate: |V|/l0, 1/s, >= 0, a number or (n,).
        Returns lam, the length at zero creepage, on which it does not depend, dimensionless, (n,);
        (1,) for a number.
        """
        material, unit = self.scene.in_own_time()
        (lam,) = pure_rolling_fields(
            law_table(material), np.atleast_1d(rate) * unit * self.T_ref, "lam"
        )
        return lam

    def wave_ratio(self, speed: Any, density: float | None) -> tuple[Any, list[str], bool]:
        """Return the ratio of a speed to the slowest shear wave of both bodies, by their long-time
        shear moduli.

        speed: the speed, m/s, >= 0, any shape that broadcasts with G.
        density: density of the cylinder, and of the base where they are alike or the cylinder is
            rigid, kg/m^3; None: as the materials have it.
        Returns (ratio, names, decides): the largest ratio of the bodies whose density is known, in
        the broadcast shape, None if there is none; the names of the other bodies; and whether the
        softest body is among the known ones.  Rigid bodies do not count.  Like bodies of one
        material count as one, "the material".
        """
        if self.pair is None:
            bodies: list[Any] = [("the material", self.E / (2.0 * (1.0 + self.nu)), None)]
        else:
            one = self.pair.cylinder
            other = self.pair.half_space
            bodies = [("the cylinder", one.G, one.density), ("the base", other.G, other.density)]
            if self.pair.like:
                bodies = [("the material", one.G, one.density or other.density)]
            bodies = [body for body in bodies if not np.all(np.isinf(body[1]))]
        if density is not None:
            bodies[0] = (*bodies[0][:2], density)
        # In this order of factors V = 0 gives 0 for every density.
        with np.errstate(over="ignore"):
            ratios = [
                speed * np.sqrt(1.0 / G) * math.sqrt(rho) for _, G, rho in bodies if rho is not None
            ]
        unknown = [name for name, _, rho in bodies if rho is None]
        *_, decisive = min(bodies, key=lambda body: np.min(body[1], initial=np.inf))
        largest = np.max(np.broadcast_arrays(*ratios), axis=0) if ratios else None
        return largest, unknown, decisive is not None

    def extend_validity(
        self, report: Validity, lam: Any, V: Any, omega: Any, density: float | None
    ) -> Validity:
        """Add the assumptions that need quantities in SI units to the report of a state.

        report: report of the dimensionless scene; it is not changed.
        lam: contact length divided by l0, dimensionless, in the shape of the state.
        V, omega: speeds, m/s and rad/s, any sign, arrays that broadcast with lam; omega may be
            None.  Compared with the waves is the larger of |V| and |omega| R, without omega |V|.
        density: density of the cylinder, and of the base where they are alike or the cylinder is
            rigid, kg/m^3; None: as the materials have it.
        Returns a copy of the report with ``quasistatic`` (undecided without the density that
        decides), ``bodies``, ``measured`` (undecided without a measured material) and ``plane``,
        which states the plane and the largest load over m g, and is always undecided.
        Raises ParameterError for a density that is not one finite number > 0.
        """
        if density is not None:
            density = check_number("density", density, unit=SI, above=0.0)
        fastest = np.abs(V) if omega is None else np.maximum(np.abs(V), np.abs(omega) * self.R)
        pair = self.pair
        length = lam * self.l0
        kind = (
            "plane strain: a long cylinder, or one between walls"
            if self.plane == "strain"
            else "plane stress: a thin disc"
        )
        # gamma = P T_ref^2/(m R), so that this is P/(m g)
        weights = extent_of(self.scene.gamma * self.R / (_GRAVITY * self.T_ref**2))
        return report._replace(
            quasistatic=assess_inertia(*self.wave_ratio(fastest, density)),
            bodies=assess_coupling(
                *(pair.dundurs if pair else (0.0, 0.0)),
                like=pair is None or pair.like,
                solved=self.scene.tabulated,
            ),
            measured=assess_measured_band(transit_frequency(V, length), self.records),
            plane=Assumption(
                None,
                None,
                f"the state is taken as {kind}; the load is {weights[1]:.3g} times the weight m g, "
                "g = 9.81 m/s2",
            ),
            strain=assess_strain(self, V, length),
        )


def is_outside(extent: tuple[float, float], band: tuple[float, float]) -> bool:
    """Return whether a range of speeds leaves a band of |V|; a speed of 0 is allowed, since M = 0
    there.

    extent: (smallest, largest) of the speeds, signed.  A range that contains 0 or both signs leaves
        a band at its upper end alone, because its small speeds are not known.
    band: (lowest, highest) |V|, in the same unit, both inside; a range without 0 leaves every band
        whose lowest is above its highest.
    """
    low, high = extent
    lowest, highest = band
    return high > highest or -low > highest or 0.0 < low < lowest or 0.0 < -high < lowest


def extent_of(values: Any) -> tuple[float, float]:
    """Return (smallest, largest) of ``values``, numbers of any shape, as floats.

    NaN is ignored; (0.0, 0.0) if there is no other number.
    """
    low = float(np.fmin.reduce(values, axis=None, initial=np.nan))
    high = float(np.fmax.reduce(values, axis=None, initial=np.nan))
    return (0.0, 0.0) if low != low else (low, high)
