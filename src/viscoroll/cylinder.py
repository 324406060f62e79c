"""What rolls, in SI units: :class:`Cylinder`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .contact_law import known
from .contact_law.assumptions import (
    WAVE_LIMIT,
    Assumption,
    Validity,
    coupling,
    inertia,
    measurement,
    passage,
    thickness,
)
from .contact_law.free_rolling import rolling
from .contact_law.parameters import same
from .core.checks import broadcast_shape, checked, frozen, number
from .core.drive import slope_factor
from .core.errors import ParameterError, one_of
from .core.results import Row, Shown, short
from .core.scale import Scale
from .core.symbols import MEASURED
from .materials.law_table import LawTable
from .materials.material import Material, refuse_short_retardation
from .materials.measured import Measured
from .materials.pair import Pair, Plane, effective_modulus
from .materials.prony import Prony
from .motion.warned import say
from .scaling import contact_length, scene_of
from .scene import Methods, Scene

_SOLID = ("E", "nu", "T_epsilon", "T_sigma")
_NUMBERS = ("R", "m", *_SOLID, "mu", "j", "g", "pressed")
UNITS = {"R": "m", "m": "kg/m", "E": "Pa", "T_epsilon": "s", "T_sigma": "s", "g": "m/s^2", "load": "N/m"}


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Cylinder(Methods):
    """A viscoelastic cylinder on a half-space, in SI units.

    The functions of the package, and its methods of the same names, take and give SI units, per m of its length.
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
            raise one_of("material", ", ".join(solid), both=True)
        if material is None and len(solid) < len(_SOLID):
            missing = ", ".join(name for name in _SOLID if name not in solid)
            sentence = f"give material=, or all of E, nu, T_epsilon and T_sigma: {missing} not given"
            raise ParameterError(missing, None, "given, or material", sentence)
        for name in ("R", "m", "mu", "j", "g", *(() if material is not None else _SOLID)):
            low, high = (-1.0, 0.5) if name == "nu" else (0.0, math.inf)
            given[name] = frozen(checked(name, given[name], low=low, strict=True, high=high))
        if given["pressed"] is not None:
            given["pressed"] = frozen(checked("load", given["pressed"], low=0.0, strict=True))
        numbers = {name: given[name] for name in _NUMBERS if given[name] is not None}
        broadcast_shape(**{name: np.asarray(value) for name, value in numbers.items()})
        if plane not in ("strain", "stress"):
            raise ParameterError("plane", repr(plane), "'strain' or 'stress'")
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

    def some(self, which: NDArray[np.int64], count: int) -> Cylinder:
        picked = {name: value[which] for name, value in self.numbers.items() if np.shape(value) == (count,)}
        return self.replace(**picked) if picked else self

    def tilted(self, slope: Any) -> Cylinder:
        return self.replace(load=self.load * slope_factor(slope)[1])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Cylinder):
            return NotImplemented
        return all(same(getattr(self, name), getattr(other, name)) for name in (*_NUMBERS, "plane", "material", "base"))

    def __hash__(self) -> int:
        numbers = (getattr(self, name) for name in _NUMBERS)
        # + 0.0: -0 and 0 are equal
        parts = (None if value is None else (np.asarray(value) + 0.0).tobytes() for value in numbers)
        return hash((*parts, self.plane, self.material, self.base))

    def _card(self) -> tuple[str, list[Row]]:
        given = self.numbers | {"load": self.load, "plane": self.plane}
        rows = [Row(name, short(value), UNITS.get(name, "")) for name, value in given.items()]
        for name in ("material", "base"):
            if (body := getattr(self, name)) is not None:
                rows.append(Row(name, getattr(body, "name", "") or repr(body)))
        return "Cylinder, SI units, per m of length", rows

    __repr__, _repr_html_ = Shown.__repr__, Shown._repr_html_

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
        if self._papers:
            slow, fast = (np.asarray(each, np.float64) for each in (self.T_epsilon, self.T_sigma))
            with np.errstate(all="ignore"):
                law = (slow / fast)[()]
            if slow.ndim:
                slow, fast = np.broadcast_arrays(slow, fast)
                law = Prony.creep((1.0 - fast / slow)[:, np.newaxis], (slow / self.T_ref)[:, np.newaxis], alpha=law)
        return scene_of(
            self.R, self.m, self.load, self.E_prime, self.T_ref, self.pair.law if law is None else law, self.mu, self.j
        )

    def known(self, found: Validity, lam: Any, V: Any, omega: Any, density: float | None) -> Validity:
        if density is not None:
            density = number("density", density, low=0.0, strict=True)
        fastest = np.abs(V) if omega is None else np.maximum(np.abs(V), np.abs(omega) * self.R)
        length, like = lam * self.l0, self._papers or self.pair.like
        long = "a long cylinder, or one held between walls (plane strain)"
        return found._replace(
            quasistatic=inertia(*self._slowness(fastest, density)),
            bodies=coupling(*((0.0, 0.0) if self._papers else self.pair.dundurs), like=like),
            measured=measurement(passage(V, length), self._measured),
            thick=thickness(length, {name: body.thickness for name, body in self._bodies.items()}),
            plane=Assumption(None, None, long if self.plane == "strain" else "a thin disc (plane stress)"),
        )

    def look(self, V: Any, extent: tuple[float, float] | None = None) -> None:
        """Warn where the contact at a speed of V, m/s, asks for frequencies that the data of a body do not hold.

        Only extremes are looked at, and rest is passed over: M is 0 there.
        """
        if V is None or self._known_speeds is None:
            return
        extent = known.extent_of(V) if extent is None else extent
        if not known.beyond(extent, self._known_speeds) or known.told(self._measured):
            return
        # the extremes of V and of l0 may be of different cylinders
        l0 = np.reshape(self.l0, np.shape(self.l0) + (1,) * (np.ndim(V) - np.ndim(self.l0)))
        rates = known.extent_of(np.abs(V) / l0)
        assert self._held is not None
        if self._known_speeds == (math.inf, 0.0) or known.beyond(rates, self._held):
            material, unit = self.scene().in_own_time()
            lam = rolling(material, np.array(rates) * unit * self.T_ref, ("lam",))[0]
            known.tell(self._measured, passage(np.array(rates), lam))

    def look_at_starts(self, V0: Any, omega0: Any) -> None:
        """Warn of starts beyond what was measured, and beyond the speed of shear waves where a density is known."""
        self.look(V0)
        if self._wave_speed is None:
            return
        V, omega = (0.0 if speed is None else speed for speed in (V0, omega0))
        if float(np.max(np.maximum(np.abs(V), np.abs(omega) * self.R), initial=0.0)) > self._wave_speed:
            say([f"speeds are beyond those of shear waves (up to {WAVE_LIMIT:g} of them counts as slow)"])

    def _slowness(self, speed: Any, density: float | None) -> tuple[Any, list[str]]:
        G = self.E / (2.0 * (1.0 + self.nu)) if self._papers else None
        return known.slowness(None if self._papers else self.pair, G, speed, density)

    @cached_property
    def _wave_speed(self) -> float | None:
        """That of the slowest shear wave in any of the cylinders, m/s; None where no density is known."""
        per_speed = self._slowness(np.ones(()), None)[0]
        return None if per_speed is None else 1.0 / float(np.max(per_speed))

    @cached_property
    def _bodies(self) -> dict[str, Material]:
        return known.deforming(None if self._papers else self.pair)

    @cached_property
    def _measured(self) -> dict[str, Measured]:
        """What the bodies were measured by, where they tell."""
        return {name: body.measured for name, body in self._bodies.items() if body.measured is not None}

    @cached_property
    def _held(self) -> tuple[float, float] | None:
        """|V|/l0 between which the contact asks for what all bodies' data hold, 1/s; None where nothing is known."""
        series = self.scene().series
        return known.held(self._measured, series, self.T_ref) if self._measured and series is not None else None

    @cached_property
    def _known_speeds(self) -> tuple[float, float] | None:
        """|V| between which every one of the cylinders is held by data, m/s; (inf, 0) of a fit that misses them."""
        if self._held is None:
            return None
        if known.misses(self._measured):
            return math.inf, 0.0
        return self._held[0] * float(np.max(self.l0)), self._held[1] * float(np.min(self.l0))

    @cached_property
    def about(self) -> dict[str, Any]:  # type: ignore[override]
        """Between which speeds the materials were measured, for datasets."""
        return {} if self._held is None or np.ndim(self.l0) else {MEASURED: [rate * self.l0 for rate in self._held]}
