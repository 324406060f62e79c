"""What rolls, in SI units: :class:`Cylinder`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import broadcast_shape, checked
from .errors import ParameterError, one_of
from .materials.law_table import LawTable
from .materials.material import Material, refuse_short_retardation
from .materials.measured import Measured
from .materials.pair import Pair, Plane, effective_modulus
from .results import Row, Shown, short
from .scene import Scene, frozen, same
from .si.conversions import Conversions
from .si.methods import InSI
from .si.scaling import contact_length, scene_from_si, scene_of_pair, scene_of_solids
from .si.validity import deforming, slowness
from .validity import MISFIT_LIMIT, held_speeds

_SOLID = ("E", "nu", "T_epsilon", "T_sigma")
_NUMBERS = ("R", "m", *_SOLID, "mu", "j", "g", "pressed")
_UNITS = {"R": "m", "m": "kg/m", "E": "Pa", "T_epsilon": "s", "T_sigma": "s", "g": "m/s^2", "load": "N/m"}


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Cylinder(InSI, Conversions):
    """A viscoelastic cylinder on a half-space, in SI units.

    Its methods take and give SI units, per m of its length: :meth:`contact`, :meth:`stress`, :meth:`roll`,
    :meth:`ensemble`, :meth:`steady`, :meth:`validity`.  :meth:`scene` is its dimensionless counterpart.

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
    Dimensionless times are over ``T_ref``.  ``*_from_si`` and ``*_to_si`` take numbers or arrays and are good to a
    few roundings (``tests/test_scene.py``).
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

    def _some(self, which: NDArray[np.int64], count: int) -> Cylinder:
        """Some of ``count`` cylinders, by their numbers."""
        arrays = {name: value for name in _NUMBERS if np.shape(value := getattr(self, name)) == (count,)}
        picked = {"load" if name == "pressed" else name: value[which] for name, value in arrays.items()}
        return self.replace(**picked) if picked else self

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
        names = (*(name for name in _NUMBERS if name != "pressed"), "load", "plane")
        given = {name: value for name in names if (value := getattr(self, name)) is not None}
        rows = [Row(name, short(value), _UNITS.get(name, "")) for name, value in given.items()]
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

    def scene(self) -> Scene:
        """The dimensionless scene: alpha or the series of the materials, kappa, gamma of Sect. 3.1 and Eq. (4)."""
        if self._papers and np.ndim(self.T_epsilon):
            return scene_of_solids(
                self.R, self.m, self.E, self.nu, self.T_ref, (self.T_epsilon, self.T_sigma), self.mu, self.j, self.g,
                self.plane, self.pressed,
            )  # fmt: skip
        if self._papers:
            solid: dict[str, Any] = {name: getattr(self, name) for name in (*_SOLID, "R", "m", "mu", "j", "g", "plane")}
            return scene_from_si(**solid, load=self.pressed)
        scene = scene_of_pair(self.R, self.m, self.pair, self.mu, self.j, self.g, self.pressed)
        return scene.replace(material=self.material) if isinstance(self.material, LawTable) else scene

    @cached_property
    def _wave_speed(self) -> float | None:
        """That of the slowest shear wave in any of the cylinders, m/s; None where no density is known."""
        per_speed = slowness(self, np.ones(()), None)[0]
        return None if per_speed is None else 1.0 / float(np.max(per_speed))

    @cached_property
    def _measured(self) -> dict[str, Measured]:
        """What the bodies were measured by, where they tell."""
        return {name: body.measured for name, body in deforming(self).items() if body.measured is not None}

    @cached_property
    def _held(self) -> tuple[float, float] | None:
        """|V|/l0 between which the contact asks for what all bodies' data hold, 1/s; None where nothing is known."""
        if not self._measured:
            return None
        series, T = self.scene().series, self.T_ref
        assert series is not None  # bodies that tell are materials
        ends = max(data.low for data in self._measured.values()), min(data.high for data in self._measured.values())
        low, high = held_speeds(series, *(rate * T for rate in ends))
        return low / T, high / T

    @cached_property
    def _known_speeds(self) -> tuple[float, float] | None:
        """|V| between which every one of the cylinders is held by data, m/s; (inf, 0) of a fit that misses them."""
        if self._held is None:
            return None
        if any(data.misfit > MISFIT_LIMIT for data in self._measured.values()):
            return math.inf, 0.0
        return self._held[0] * float(np.max(self.l0)), self._held[1] * float(np.min(self.l0))
