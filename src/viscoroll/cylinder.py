"""What rolls, in SI units: :class:`Cylinder`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .contact_law.assumptions import WAVE_LIMIT, Validity
from .contact_law.known import Known, say
from .core.checks import broadcast_shape, check_array, check_choice, read_only
from .core.drive import slope_tan_cos
from .core.errors import ParameterError, exactly_one_error
from .core.results import Result, SummaryRow, format_value
from .core.scale import SI, Scale
from .core.symbols import MEASURED
from .materials.law.table import LawTable
from .materials.material import Material, refuse_short_retardation
from .materials.pair import Pair, Plane, effective_modulus
from .materials.prony import Prony
from .scene import Methods, Scene

#: thicknesses over l0 this near, relative, are one
_SAME_THICKNESS = 1e-9
_SOLID = ("E", "nu", "T_epsilon", "T_sigma")
_NUMBERS = ("R", "m", *_SOLID, "mu", "j", "g", "pressed")
UNITS = {"R": "m", "m": "kg/m", "E": "Pa", "T_epsilon": "s", "T_sigma": "s", "g": "m/s^2", "load": "N/m"}


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Cylinder(Methods):
    """A viscoelastic cylinder on a half-space, in SI units.

    The functions of the package, and its methods of the same names, take and give SI units, per m of its length.
    Arguments that carry another unit are converted, or refused (``docs/howto/contact.md``).
    :meth:`scene` is its dimensionless counterpart; ``scale`` holds what 1 of each of its quantities is.

    Parameters
    ----------
    R : radius, m; this and every other number may be an array, one value a cylinder.
    m : mass per unit length, kg/m.
    E : long-time Young's modulus, Pa; with the next three, of both bodies, in place of ``material``.
    nu : Poisson's ratio, in (-1, 0.5].
    T_epsilon, T_sigma : retardation and relaxation time, s, T_epsilon >= T_sigma.  If T_epsilon is an array (n,),
        each cylinder has its own material, and T_ref is the largest T_epsilon.
    mu : coefficient of friction.
    j : J/(m R^2); 1/2 for a solid cylinder.
    g : gravitational acceleration, m/s^2.
    plane : "strain", or "stress" (then E' = pi E).
    material : a :class:`Material`, in place of E, nu, T_epsilon and T_sigma; or a law of :func:`viscoroll.load_law` of
        such a material, which brings its ``base`` with it.
    base : the :class:`Material` of the half-space; default: that of the cylinder.
    load : P, N/m; default: the weight m g (Sect. 3.5).  A roller may be pressed with more or less.

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, both or neither of material and E, nu, T_epsilon, T_sigma
        are given, or both bodies are rigid.

    Notes
    -----
    Dimensionless times are over ``T_ref``.
    """

    R: Any
    m: Any
    E: Any
    nu: Any
    T_epsilon: Any
    T_sigma: Any
    mu: Any
    j: Any
    g: Any
    plane: Plane
    material: Material | LawTable | None
    base: Material | None
    #: the load as it was given: :meth:`replace` with another m makes the weight anew
    pressed: Any

    def __init__(
        self, R: ArrayLike, m: ArrayLike, E: ArrayLike | None = None, nu: ArrayLike | None = None,
        T_epsilon: ArrayLike | None = None, T_sigma: ArrayLike | None = None, mu: ArrayLike | None = None,
        j: ArrayLike = 0.5, g: ArrayLike = 9.81, plane: Plane = "strain", *,
        material: Material | LawTable | None = None, base: Material | None = None, load: ArrayLike | None = None,
        pressed: ArrayLike | None = None,
    ) -> None:  # fmt: skip
        given: dict[str, Any] = {
            "R": R, "m": m, "E": E, "nu": nu, "T_epsilon": T_epsilon, "T_sigma": T_sigma, "mu": mu, "j": j, "g": g,
            "plane": plane, "material": material, "base": base, "pressed": pressed if load is None else load,
        }  # fmt: skip
        solid = [name for name in _SOLID if given[name] is not None]
        if material is not None and solid:
            raise exactly_one_error("material", ", ".join(solid), both=True)
        if material is None and len(solid) < len(_SOLID):
            missing = ", ".join(name for name in _SOLID if name not in solid)
            sentence = f"give material=, or all of E, nu, T_epsilon and T_sigma: {missing} not given"
            raise ParameterError(missing, None, "given, or material", sentence)
        for name in ("R", "m", "mu", "j", "g", *(() if material is not None else _SOLID)):
            low, high = (-1.0, 0.5) if name == "nu" else (0.0, math.inf)
            given[name] = read_only(check_array(name, given[name], unit=SI, low=low, strict=True, high=high))
        if given["pressed"] is not None:
            given["pressed"] = read_only(check_array("load", given["pressed"], unit=SI, low=0.0, strict=True))
        numbers = {name: given[name] for name in _NUMBERS if given[name] is not None}
        broadcast_shape(**{name: np.asarray(value) for name, value in numbers.items()})
        check_choice("plane", plane, "strain", "stress")
        for name, value in given.items():
            object.__setattr__(self, name, value)
        if material is None:
            if np.ndim(given["T_epsilon"]) > 1:
                raise ParameterError("T_epsilon", f"of shape {given['T_epsilon'].shape}", "a number or a vector (n,)")
            refuse_short_retardation(given["T_epsilon"], given["T_sigma"])
        if material is not None or base is not None:
            _ = self.pair  # refuses what the materials do not allow

    @property
    def _papers(self) -> bool:
        """Whether both bodies are of the paper's material, by its own parameters."""
        return self.material is None and (self.base is None or self.pair.like)

    @cached_property
    def pair(self) -> Pair:
        """Both materials."""
        if isinstance(self.material, LawTable):
            return self._pair_of_law(self.material)
        if self.material is not None:
            return Pair(self.material, self.base, self.plane)
        solid: dict[str, Any] = {name: getattr(self, name) for name in _SOLID}
        return Pair(Material.sls(**solid), self.base, self.plane)

    def _pair_of_law(self, law: LawTable) -> Pair:
        """The bodies of a law; raises ParameterError where it has none in SI units, or they are not those given."""
        pair = law.pair
        if pair is None:
            raise ParameterError("material", "a law without units", "the law of a Material, in SI units")
        if self.base is not None:
            raise ParameterError("base", "given", "left out: the law knows its bodies")
        if self.plane != pair.plane and not pair.like:
            raise ParameterError("plane", repr(self.plane), f"{pair.plane!r}, as of the law")
        return Pair(pair.cylinder, pair.base, self.plane)

    @property
    def T_ref(self) -> float:
        """What dimensionless times are counted in, s: T_epsilon, or T_ref of the materials."""
        if self.T_epsilon is None or not self._papers:
            return self.pair.T_ref
        return float(np.max(self.T_epsilon, initial=0.0)) if np.ndim(self.T_epsilon) else self.T_epsilon

    def replace(self, **changes: Any) -> Cylinder:
        """A copy with some parameters changed; ``material`` takes the place of E to T_sigma, and the reverse.

        A load that was given stays; ``load=None`` makes it the weight again.
        """
        given = {name: getattr(self, name) for name in (*_NUMBERS, "plane", "material", "base")}
        given["load"] = given.pop("pressed")
        if changes.get("material") is not None:
            given |= dict.fromkeys(_SOLID)
        elif changes.keys() & set(_SOLID):
            given["material"] = None
        return Cylinder(**(given | changes))

    @property
    def numbers(self) -> dict[str, Any]:
        """What was given in numbers, by name."""
        given = {"load" if name == "pressed" else name: getattr(self, name) for name in _NUMBERS}
        return {name: value for name, value in given.items() if value is not None}

    def tilted(self, slope: Any) -> Cylinder:
        return self.replace(load=self.load * slope_tan_cos(slope)[1])

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        given = self.numbers | {"load": self.load, "plane": self.plane}
        rows = [SummaryRow(name, format_value(value), UNITS.get(name, "")) for name, value in given.items()]
        for name in ("material", "base"):
            if (body := getattr(self, name)) is not None:
                rows.append(SummaryRow(name, getattr(body, "name", "") or repr(body)))
        return "Cylinder, SI units, per m of length", rows

    __repr__, _repr_html_ = Result.__repr__, Result._repr_html_

    @property
    def load(self) -> Any:
        """P, N/m: as given, or m g."""
        return self.m * self.g if self.pressed is None else self.pressed

    @property
    def E_prime(self) -> Any:
        """E' = pi E/(1 - nu^2) in plane strain, pi E in plane stress, Pa (Sect. 3.1).

        Of two bodies 2/(1/E'_1 + 1/E'_2).
        """
        return effective_modulus(self.E, self.nu, self.plane) if self._papers else self.pair.E_prime

    @property
    def l0(self) -> Any:
        """Contact length at rest, sqrt(32 R P/E'), m."""
        return contact_length(self.R, self.load, self.E_prime)

    @cached_property
    def scale(self) -> Scale:  # type: ignore[override]
        """What 1 of each quantity of the scene is, in SI units: ``scale["V"]`` in m/s."""
        return Scale(self.R, self.T_ref, self.load, self.m, self.l0, self.E_prime)

    def scene(self) -> Scene:
        """The dimensionless scene: alpha or the series of the materials, kappa, gamma of Sect. 3.1 and Eq. (4)."""
        return self._scene

    @cached_property
    def _scene(self) -> Scene:
        law: Any = self.material if isinstance(self.material, LawTable) else None
        if law is not None and law.cover is not None:
            self._refuse_other_load(law)
        if self._papers:
            slow, fast = (np.asarray(each, np.float64) for each in (self.T_epsilon, self.T_sigma))
            with np.errstate(all="ignore"):
                law = (slow / fast)[()]
            if slow.ndim:
                slow, fast = np.broadcast_arrays(slow, fast)
                law = Prony.creep((1.0 - fast / slow)[:, np.newaxis], (slow / self.T_ref)[:, np.newaxis], alpha=law)
        if law is None:
            law = self.pair.law if self.pair.covered is None else self.pair.cover(self.l0)
        return scene_of(self.R, self.m, self.load, self.E_prime, self.T_ref, law, self.mu, self.j)

    def _refuse_other_load(self, law: LawTable) -> None:
        """Raise ParameterError where the law of a layer is that of another l0."""
        given: Any = law.material
        own = self.pair.cover(self.l0)
        if own.shape or abs(own.thickness / given.thickness - 1.0) > _SAME_THICKNESS:
            found = f"the law of a layer of {given.thickness:.6g} l0"
            raise ParameterError(
                "material", found, f"that of {format_value(own.thickness)} l0, as the load and R have it"
            )

    @cached_property
    def _known(self) -> Known:
        pair, G = (None, self.E / (2.0 * (1.0 + self.nu))) if self._papers else (self.pair, None)
        return Known(pair, G, self.R, self.l0, self.T_ref, self._scene)

    def known(self, found: Validity, lam: Any, V: Any, omega: Any, density: float | None) -> Validity:
        return self._known.judge(found, lam, V, omega, density, self.plane)

    @property
    def watched(self) -> bool:
        return self._known.silent is not None

    def look(self, V: Any, extent: tuple[float, float] | None = None) -> None:
        """Warn where the contact at a speed of V, m/s, is longer than the radius or than a layer allows, or asks for
        frequencies that the data of a body do not hold.
        """
        if V is not None and self._known.silent is not None:
            self._known.look(V, extent)

    def look_at_starts(self, V0: Any, omega0: Any) -> None:
        """Warn of starts beyond the speed of shear waves, where a density is known."""
        if self._known.wave_speed is None:
            return
        V, omega = (0.0 if speed is None else speed for speed in (V0, omega0))
        if float(np.max(np.maximum(np.abs(V), np.abs(omega) * self.R), initial=0.0)) > self._known.wave_speed:
            fault = f"speeds are beyond those of shear waves (up to {WAVE_LIMIT:g} of them counts as slow)"
            say([fault], "motion", "validity() of cylinder or result")

    def look_at_motion(self, V0: Any, V: Any) -> None:
        """Warn where the fastest speed of a motion, or of each, asks for frequencies that the data do not hold, or its
        contact is longer than a layer allows.
        """
        if self._known.silent is not None:
            fastest = np.abs(0.0 if V0 is None else V0)
            self._known.look(
                fastest if V is None else np.fmax(fastest, np.fmax.reduce(np.abs(V), axis=-1)), None, motion=True
            )

    @cached_property
    def about(self) -> dict[str, Any]:  # type: ignore[override]
        """Between which speeds the materials were measured, for datasets."""
        held = self._known.held
        return {} if held is None or np.ndim(self.l0) else {MEASURED: [rate * self.l0 for rate in held]}


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """l0 of Sect. 3.1, m."""
    return np.sqrt(32.0 * R * load / E_prime)


def scene_of(R: Any, m: Any, load: Any, E_prime: Any, T_ref: Any, law: Any, mu: Any, j: Any) -> Scene:
    """The scene of a :class:`Cylinder`, or of many: numbers or arrays, unchecked.

    ``law`` : alpha, one or one each, or what a scene takes for its material, with times over ``T_ref``.
    """
    R, m, load, T = (np.asarray(value, np.float64)[()] for value in (R, m, load, T_ref))
    # what leaves the range of doubles becomes 0 or infinite, which Scene refuses by name
    with np.errstate(all="ignore"):
        kappa, gamma = R / contact_length(R, load, E_prime), load * T**2 / (m * R)
    of = "alpha" if isinstance(law, float | np.ndarray) else "material"
    return Scene(kappa=kappa, mu=mu, gamma=gamma, j=j, **{of: law})
