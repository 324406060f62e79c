"""Two bodies in contact, in SI units: :class:`Pair`.

Compliances are added: 2/E' = 1/E'_1 + 1/E'_2, E'_k = pi E_k/(1 - nu_k^2) (Sect. 3.1), and each body
creeps in proportion to its part of them.  Shear and pressure do not couple where Dundurs' constant
beta_D is 0 at all times.  Layers and half-spaces of one Poisson's ratio differ by
:func:`layer_excess`.
"""

import dataclasses
import math
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from ..core import (
    Floats,
    ParameterError,
    broadcast_shape,
    describe_value,
    described_error,
    format_value,
)
from .bodies import Bodies, Cover
from .material import Material
from .prony import Prony

Plane = Literal["strain", "stress"]
#: largest relative difference of two thicknesses divided by l0 that count as the same
_SAME_THICKNESS = 1e-9


class Solid(NamedTuple):
    """The properties of a :class:`Material` that the law depends on; of many bodies as arrays and
    as many series.

    E : long-time Young's modulus, Pa, a number or (n,); infinite for a rigid body.
    nu : Poisson's ratio, a number or (n,).
    prony : one series or n of them, times in units of T_ref.
    T_ref : unit of these times, s.
    thickness : thickness of a layer, m, a number or (n,); None: a half-space.
    nu_instant : as in :class:`Material`; None: nu is constant in time.
    """

    E: Any
    nu: Any
    prony: Prony
    T_ref: float
    thickness: Any = None
    nu_instant: float | None = None

    @property
    def G(self) -> Any:
        """Long-time shear modulus E/(2 (1 + nu)), Pa, a number or (n,)."""
        return self.E / (2.0 * (1.0 + self.nu))


@dataclasses.dataclass(frozen=True)
class Pair:
    """Cylinder and half-space; with a :class:`Solid` only the law and the moduli are available.

    Parameters
    ----------
    cylinder : material of the cylinder, a :class:`Material` or :class:`Solid`.
    base : material of the half-space, likewise; None: that of the cylinder.
    plane : "strain", or "stress".

    Raises
    ------
    ParameterError
        A body that is no :class:`Material` or :class:`Solid`; two rigid bodies; a layer in plane
        stress; a Poisson's ratio that changes with time, of a layer or in plane stress.
    """

    cylinder: Any
    base: Any = None
    plane: Plane = "strain"

    def __post_init__(self) -> None:
        """Check the bodies, and what a layer of finite thickness allows.

        Of many pairs two rigid bodies are refused only where all of them are; ``plane`` is not
        checked without a layer.
        Raises ParameterError as the class states.
        """
        for name, body in zip(("material", "base"), self.bodies):
            if not isinstance(body, Material | Solid):
                raise ParameterError(
                    name, describe_value(body), "a Material, as vr.Material(E=..., nu=...)"
                )
        if all(np.all(np.isinf(modulus)) for modulus in self._moduli):
            raise ParameterError(
                "base",
                "rigid",
                "a deformable body, since material (the cylinder) is rigid; if base is left out, "
                "material is that of both bodies",
            )
        if self.covered is not None and self.plane != "strain":
            raise ParameterError(
                "plane", repr(self.plane), "'strain' where a material has a thickness"
            )
        for name, body in zip(("material", "base"), self.bodies):
            reason = "is in plane stress" if self.plane != "strain" else "has a thickness"
            if body.nu_instant is not None and (
                body.thickness is not None or self.plane != "strain"
            ):
                raise described_error(
                    "nu_instant",
                    f"of {name} is given (or follows from bulk terms unlike those of shear), but "
                    f"{name} {reason}",
                    "left out, and the bulk terms too: a Poisson's ratio that changes with time is "
                    "possible only for a half-space in plane strain",
                )

    @property
    def covered(self) -> Any:
        """Name of the body that is a layer of finite thickness, of two layers "cylinder", or
        None.
        """
        if self.cylinder.thickness is not None:
            return "cylinder"
        return "base" if self.half_space.thickness is not None else None

    @property
    def half_space(self) -> Any:
        """Material of the half-space."""
        return self.cylinder if self.base is None else self.base

    @property
    def bodies(self) -> tuple[Any, Any]:
        """Materials of the cylinder and of the half-space."""
        return self.cylinder, self.half_space

    @property
    def like(self) -> bool:
        """Whether both bodies deform and relax alike: one body is given for both, or E, nu, series
        and T_ref are equal.

        Two different objects of which one is a :class:`Solid` are never alike: its fields may be
        arrays of many bodies, which have no single answer.  A thickness is not compared.
        """
        one, other = self.cylinder, self.half_space  # asked often: no call more
        if one is other or Solid in (type(one), type(other)):
            return one is other
        return all(
            getattr(one, name) == getattr(other, name) for name in ("E", "nu", "prony", "T_ref")
        )

    @cached_property
    def _moduli(self) -> list[Any]:
        """E' of the cylinder and of the half-space at long times, Pa."""
        return [effective_modulus(body.E, body.nu, self.plane) for body in self.bodies]

    @property
    def E_prime(self) -> Any:
        """Return the contact modulus E' of the pair at long times, 2/E' = 1/E'_1 + 1/E'_2 (Sect.
        3.1), Pa.

        A float, or an array (n,) of many pairs, NaN where both bodies are rigid; that of one body
        if both are alike; if one body is rigid twice that of the other.
        """
        one, other = self._moduli
        if self.like:
            return one
        # divided by the stiffer one, which may be infinite
        softer = np.minimum(one, other)
        stiffer = np.maximum(one, other)
        found = 2.0 * softer / (1.0 + softer / stiffer)
        return found if found.ndim else float(found)

    @property
    def share(self) -> Any:
        """The cylinder's part of the long-time compliance, dimensionless, a number or (n,): 0 if it
        is rigid, 1 on a rigid base, 1/2 of like bodies.
        """
        one, other = self._moduli
        return 1.0 / (1.0 + one / other)

    @property
    def T_ref(self) -> float:
        """Unit of time, s: the cylinder's T_ref if it relaxes or is many series, else that of the
        half-space.
        """
        series = self.cylinder.prony
        return (self.cylinder if series.shape or series.alpha > 1.0 else self.half_space).T_ref

    @cached_property
    def law(self) -> Prony | Bodies:
        """Return the material of the law: a :class:`Prony` series for like bodies, else
        :class:`Bodies`.

        Its times are in units of ``T_ref``; strengths are divided by the long-time modulus or
        compliance.  Of many bodies it is as many series or pairs.

        Raises
        ------
        ParameterError
            A body with a thickness: its law depends on the load and the radius too
            (:meth:`cover`);
            a time of the other body that no double holds in units of ``T_ref``; n pairs of more
            than 64 modes; many series and many parts of the compliance whose numbers differ.
        """
        if self.covered is not None:
            raise described_error(
                "thickness",
                f"of a cover on the {self.covered} is given",
                "left out here, since the contact law of a cover depends on load and radius too; "
                "or give a vr.Cylinder of these materials (in a file: add the section [cylinder])",
            )
        if self.like:
            return self.cylinder.prony
        one, other = (body.prony.slower(body.T_ref / self.T_ref) for body in self.bodies)
        ratios: Any = [body.nu for body in self.bodies]
        if any(map(np.ndim, ratios)):
            ratios = None
        elif self.plane != "strain":  # as plane strain with another ratio
            ratios = [nu / (1.0 + nu) for nu in ratios]
        return Bodies(one, other, self.share, ratios)

    def cover(self, l0: Any) -> Cover:
        """Return the layer of finite thickness and the other body, a layer or not, as a
        dimensionless :class:`Cover`.

        One of the bodies must have a thickness (:attr:`covered`).

        Parameters
        ----------
        l0 : contact length at rest that the bodies would have as half-spaces, m; a number, or an
            array (n,) for n covers.

        Returns
        -------
        Cover
            Its thickness is divided by ``l0``, its times are in units of ``T_ref``.

        Raises
        ------
        ParameterError
            Many series; beside a body that is not rigid many parts of the compliance, or an array
            of its nu; a thickness or Poisson's ratio out of the range of :class:`Cover`; a time
            that no double holds in units of ``T_ref``.
        """
        on = self.covered
        layer, other = self.bodies if on == "cylinder" else self.bodies[::-1]
        parts = self.share if on == "cylinder" else 1.0 - np.asarray(self.share)
        found = "has several values"
        if layer.prony.shape:
            raise described_error(
                f"the Prony series of the cover (of the {on})",
                found,
                "the same for all cylinders (thickness, load and R may differ; E and nu too if the "
                "other body is rigid)",
            )
        if np.ptp(parts) > 0.0:
            raise described_error(
                "E or nu of a body",
                found,
                "the same for all cylinders, as one body has a cover and the other is not rigid: "
                "let thickness, load or R differ, or make the other body rigid (E = inf)",
            )
        # both in the unit of time of the pair
        series, other_series = (
            body.prony.slower(body.T_ref / self.T_ref) for body in (layer, other)
        )
        part = float(np.max(parts))
        # beside a rigid body the layer has all of the compliance
        more = {} if part == 1.0 else {"other_nu": other.nu, "other": other_series}
        if other.thickness is not None and part < 1.0:
            more["other_thickness"] = np.broadcast_to(
                other.thickness / l0, np.shape(layer.thickness / l0)
            )
        return Cover(series, nu=layer.nu, thickness=layer.thickness / l0, on=on, part=part, **more)

    def refuse_thick_layer(self, R: Any) -> None:
        """Raise ParameterError where a layer on the cylinder is thicker than R, for example since
        its thickness was given in mm.

        R: radius, m, a number or (n,), which a thickness may be equal to.
        Raises ParameterError also where its shape does not broadcast with that of R.
        """
        thickness = self.cylinder.thickness
        if thickness is None:
            return
        broadcast_shape(thickness=thickness, R=R)
        if (np.asarray(thickness) > R).any():
            raise described_error(
                "thickness",
                f"of the layer on the cylinder is {format_value(thickness)} m",
                f"at most R = {format_value(R)} m",
            )

    def refuse_other_cover(self, cover: Any, l0: Any) -> None:
        """Raise ParameterError if a law that was made for a cover does not hold for these bodies.

        It holds for one thickness divided by l0, which depends on load and R.  So it is refused
        for another load or radius than it was made for, and for several cylinders.

        cover: the :class:`Cover` for which the law was made.
        l0: contact length at rest of these bodies as half-spaces, m, as in :meth:`cover`.
        Raises ParameterError where the thickness of this pair divided by ``l0`` differs from
        ``cover.thickness`` by more than 1e-9, relative, or is an array.
        """
        own = self.cover(l0)
        # a shape other than () is that of several cylinders
        if own.shape or abs(own.thickness / cover.thickness - 1.0) > _SAME_THICKNESS:
            raise described_error(
                "material",
                f"is the law of a cover with thickness/l0 = {cover.thickness:.6g}",
                f"that for {format_value(own.thickness)}, which follows from load and R (l0: "
                "contact length at rest of half-spaces of the same materials); make the law again "
                "with this load and R",
            )

    def refuse_coupled_ratios(self, law: Prony | Bodies | Cover, limit: float) -> None:
        """Raise ParameterError where half-spaces with an array of nu need the coupled solution.

        law: of the bodies; :class:`Bodies` have no Poisson's ratios where one of them is an array.
        limit: Dundurs' constant up to which bodies count as uncoupled, dimensionless.
        """
        if type(law) is Bodies and law.poisson is None:
            # in size, of long times or at once, of any of many pairs
            if max(np.abs(each).max() for each in self.dundurs) > limit:
                raise several_tables_error("nu", "one number")

    @cached_property
    def dundurs(self) -> tuple[Any, Any]:
        """Dundurs' constant beta_D as (that of the long-time moduli, that of the instantaneous
        moduli), dimensionless, any sign: floats, of many pairs lists.

        The moduli relax from one end to the other; the two numbers serve the check that shear and
        pressure do not couple.  Body 1 of the formula of :func:`dundurs` is the cylinder; one body
        may be rigid.  It is exactly (0.0, 0.0) for like bodies.
        """
        of_pairs = np.vectorize(dundurs, otypes=[float])
        late = [(body.G, body.nu) for body in self.bodies]
        early = []
        for body in self.bodies:
            nu = body.nu if body.nu_instant is None else body.nu_instant
            # alpha is that of E/(1 - nu^2) = 2 G/(1 - nu)
            early.append((body.G * body.prony.alpha * ((1.0 - nu) / (1.0 - body.nu)), nu))
        long, instant = (
            of_pairs(*one, *other, self.plane).tolist() for one, other in (late, early)
        )
        return long, instant


def effective_modulus(E: Any, nu: Any, plane: str) -> Any:
    """Return the contact modulus E' = pi E/(1 - nu^2) of Sect. 3.1 of the paper; in plane stress pi
    E.

    E: Young's modulus, a number or an array; infinite for a rigid body.
    nu: Poisson's ratio, in (-1, 0.5], not checked, likewise; they broadcast.  Ignored in plane
    stress.
    plane: "strain"; any other text is taken as "stress".
    Returns E' in the unit of E, a number or an array.
    """
    return math.pi * E / (1.0 - nu**2 if plane == "strain" else 1.0)


def several_tables_error(name: str, one: str) -> ParameterError:
    """Return the error of a parameter with several values, each of which needs the coupled
    solution.

    name: name of the parameter; one: words for what it must be, as "one number".
    """
    return described_error(
        name,
        "has several values, but where shear acts on the pressure only one is possible",
        f"{one}; or take the fast law, which neglects or approximates this action of shear, by "
        "coupled=False of the roller (in a file: coupled = false in [cylinder])",
    )


def dundurs(G_1: float, nu_1: float, G_2: float, nu_2: float, plane: str = "strain") -> float:
    """Return Dundurs' constant beta_D of two bodies; where it is 0, shear does not change the
    pressure.

    beta_D = (G_1 (k_2 - 1) - G_2 (k_1 - 1))/(G_1 (k_2 + 1) + G_2 (k_1 + 1)), with k = 3 - 4 nu in
    plane strain and k = (3 - nu)/(1 + nu) in plane stress.

    G_1, G_2: shear moduli in one unit, > 0; one of them may be infinite, and its nu then has no
    effect on the result.
    nu_1, nu_2: Poisson's ratios, in (-1, 0.5], not checked.
    plane: "strain"; any other text is taken as "stress".
    Returns a float, dimensionless; its sign changes where the bodies are exchanged, and it is 0.0
    for like bodies.
    """
    k_1, k_2 = (
        3.0 - 4.0 * nu if plane == "strain" else (3.0 - nu) / (1.0 + nu) for nu in (nu_1, nu_2)
    )
    # over the larger one, which may be infinite: inf/inf would be NaN
    largest = max(G_1, G_2)
    g_1, g_2 = (1.0 if G == largest else G / largest for G in (G_1, G_2))
    return (g_1 * (k_2 - 1.0) - g_2 * (k_1 - 1.0)) / (g_1 * (k_2 + 1.0) + g_2 * (k_1 + 1.0))


def layer_excess(nu: float, u: Floats) -> Floats:
    """Return what distinguishes a bonded layer from a half-space under a wave of traction.

    nu: Poisson's ratio of the layer, in [0, 0.5], not checked.
    u: wave number times the thickness, > 0, (n,).
    Returns L - 1, T - L, and C less :func:`local_coupling`, dimensionless, (3, n), without
    cancellation.
    """
    # with D = kap (1 + e^2) + (4 u^2 + 1 + kap^2) e: L = (kap (1 - e^2) - 4 u e)/D, and T has + 4 u
    # e; e = exp(-2 u) in place of hyperbolic functions, which overflow
    kap = 3.0 - 4.0 * nu
    e = np.exp(-2.0 * u)
    denominator = kap * (1.0 + e * e) + (4.0 * u * u + 1.0 + kap * kap) * e
    coupling = (kap * (kap - 1.0) * (1.0 - e) ** 2 - 8.0 * u * u * e) / (
        (kap + 1.0) * denominator
    ) - local_coupling(nu)
    rest = 2.0 * kap * e + 4.0 * u * u + 1.0 + kap * kap + 4.0 * u
    return np.array([-e * rest / denominator, 8.0 * u * e / denominator, coupling])


def local_coupling(nu: Any) -> Any:
    """Return (1 - 2 nu)/(2 - 2 nu), by which shear tilts a half-space of Poisson's ratio ``nu``."""
    return (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu)


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """Return the contact length at rest of half-spaces, l0 = sqrt(32 R P/E'), Sect. 3.1.

    R: radius, m, > 0.
    load: force per length P that presses the cylinder on the base, N/m, > 0.
    E_prime: contact modulus E' (:attr:`Cylinder.E_prime`; of one material in plane strain pi E/(1 -
    nu^2)), Pa, > 0.
    Returns l0, m, in the broadcast shape of the arguments, which are numbers of numpy or arrays and
    are not checked.
    """
    return np.sqrt(32.0 * R * load / E_prime)


def describe_body(body: Any) -> str:
    """Return a body in a few words for a printed report.

    body: :class:`Material`, or the table of a law.
    Returns, of a Material, its name, "rigid", or modulus, Poisson's ratio and number of modes, with
    the thickness of a layer; of a table its ``repr``.
    """
    if not isinstance(body, Material):
        return repr(body)
    modes = f"{body.prony.E.size} Prony term{'s' * (body.prony.E.size != 1)}"
    text = body.name or (
        "rigid" if body.is_rigid else f"E = {body.E:g} Pa, nu = {body.nu:g}, {modes}"
    )
    return text if body.thickness is None else f"{text}, {body.thickness:g} m thick"
