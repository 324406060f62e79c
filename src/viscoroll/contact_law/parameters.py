"""What rolls, as the functions of the package see it: :class:`Rolls`, and its dimensionless :class:`Parameters`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Self

import numpy as np

from ..core.array_types import Floats, Integers
from ..core.checks import broadcast_shape, check_array, check_array_extent, read_only
from ..core.drive import slope_tan_cos
from ..core.errors import ParameterError, exactly_one_error
from ..core.results import format_value
from ..core.scale import DIMENSIONLESS, Scale
from ..materials.bodies import Bodies, total_series
from ..materials.cover import Cover
from ..materials.law.grid import LawGrid
from ..materials.law.table import LawTable, law_table
from ..materials.prony import Prony
from ..materials.prony_forms import HIGHEST_ALPHA
from .assumptions import Validity
from .free_rolling import Free

PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")


#: of mu/kappa, in which delta_star is measured
RATIO_RANGE = (1e-290, 1e290)


def _in_own_time(series: Prony) -> tuple[float | Prony, float]:
    return series.in_own_time() if series.E.size else (1.0, 1.0)


class Rolls:
    """What rolls: a scene, or a cylinder.  Functions take its parameters, and answer in the units of its scale.

    A dataclass, whose fields may be arrays.
    """

    scale: Scale
    material: Any
    #: attributes of datasets
    about: ClassVar[dict[str, Any]] = {}

    @property
    def watched(self) -> bool:
        """Whether there are speeds of which :meth:`look` warns."""
        return False

    def scene(self) -> Parameters:
        """The dimensionless parameters."""
        raise NotImplementedError

    @property
    def numbers(self) -> dict[str, Any]:
        """Its parameters that are numbers or arrays, by name."""
        raise NotImplementedError

    def tilted(self, slope: Any) -> Self:
        """The same on a slope, under the load P cos(slope).

        Raises
        ------
        ParameterError
            A slope that is not within (-pi/2, pi/2).
        """
        raise NotImplementedError

    def replace(self, **changes: Any) -> Self:
        """A copy with some parameters changed."""
        raise NotImplementedError

    def some(self, which: Integers, count: int) -> Self:
        """Some of ``count``, by their numbers."""
        parts = {name: each[which] for name, each in self._given.items() if getattr(each, "shape", ()) == (count,)}
        return self.replace(**parts) if parts else self

    @property
    def _given(self) -> dict[str, Any]:
        """What of it may be of many, by name."""
        return self.numbers

    def _key(self) -> tuple[Any, ...]:
        """All of it, to compare and to hash."""
        parts = (getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]
        # + 0.0: -0 and 0 are equal
        return tuple((each.shape, (each + 0.0).tobytes()) if isinstance(each, np.ndarray) else each for each in parts)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Rolls) and type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def known(self, found: Validity, lam: Any, V: Any, omega: Any, density: float | None) -> Validity:
        """What it adds of itself to the validity of a state, of which ``lam`` is."""
        if density is not None:
            raise ParameterError(
                "density", density, "None", "density needs a Cylinder: a Scene knows no speed of waves"
            )
        return found

    def look(self, V: Any, extent: tuple[float, float] | None = None) -> None:
        """Warn where a contact at V is outside of what the model or the data of a material hold.

        V : speeds, in the unit of what rolls.  extent : the least and the largest of them, where they are known.
        """

    def look_at_starts(self, V0: Any, omega0: Any) -> None:
        """Warn of starts that are beyond the speed of waves."""

    def look_at_motion(self, V0: Any, V: Any) -> None:
        """Warn where the fastest speed of a motion, or of each, asks more of a material than was measured."""


@dataclass(frozen=True, eq=False, repr=False)
class Parameters(Rolls):
    """Dimensionless parameters: what a :class:`viscoroll.Scene` is given."""

    alpha: Any = None
    kappa: Any = None
    mu: Any = None
    gamma: Any = None
    j: Any = 0.5
    material: Prony | Bodies | LawTable | None = None
    _law: ClassVar[LawTable | None] = None
    #: that the parameters broadcast to; () for one scene
    shape: ClassVar[tuple[int, ...]] = ()
    scale: ClassVar[Scale] = DIMENSIONLESS  # type: ignore[misc]

    def __post_init__(self) -> None:
        given: dict[str, Any] = {name: getattr(self, name) for name in PARAMETERS}
        material: Any = self.material
        if (material is None) == (given["alpha"] is None):
            raise exactly_one_error("alpha", "material", both=material is not None)
        if isinstance(material, LawTable):
            object.__setattr__(self, "_law", material)
            material = material.material
            if not isinstance(material, Prony | Bodies):
                given["alpha"], material = material, None
        if material is not None:
            if not isinstance(material, Prony | Bodies):
                raise ParameterError("material", f"{material!r:.60}", "a Prony series, or Bodies of two")
            given["alpha"] = material.alpha
        arrays = {"alpha": check_array("alpha", given.pop("alpha"), low=1.0, high=HIGHEST_ALPHA)}
        extents = {}
        for name, value in given.items():
            if name != "gamma" or value is not None:
                arrays[name], extents[name] = check_array_extent(name, value, low=0.0, strict=True)
        object.__setattr__(self, "shape", broadcast_shape(**arrays))
        object.__setattr__(self, "material", material)
        if arrays["mu"].size and arrays["kappa"].size:
            low, high = RATIO_RANGE
            (least_mu, most_mu), (least_kappa, most_kappa) = extents["mu"], extents["kappa"]
            if not (least_mu >= low * most_kappa and most_mu <= high * least_kappa):
                _refuse_ratio(arrays["mu"], arrays["kappa"])
        for name, array in arrays.items():
            object.__setattr__(self, name, read_only(array))

    @property
    def table(self) -> LawTable | None:
        """The law of its one material: the one that was given, or made; None of an alpha or a material each."""
        if self._law is not None:
            return self._law
        if self.material is not None:
            return law_table(self.material) if self.each is None else None
        if type(self.alpha) is float:
            return law_table(self.alpha)
        return law_table(self.alpha.item()) if self.alpha.size == 1 else None

    @property
    def numbers(self) -> dict[str, Any]:
        """alpha, kappa, mu, gamma and j by name, those that are given."""
        values = {name: getattr(self, name) for name in PARAMETERS}
        return {name: value for name, value in values.items() if value is not None}

    def scene(self) -> Self:
        return self

    def replace(self, **changes: Any) -> Self:
        """A copy with some parameters changed; an alpha takes the place of a material, and the reverse."""
        given: dict[str, Any] = {}
        if changes.keys() & {"alpha", "material"}:
            given = {"alpha": None, "material": None}
        elif self._law is not None or self.material is not None:
            given = {"alpha": None, "material": self._law or self.material}
        return replace(self, **(given | changes))

    @property
    def series(self) -> Prony | None:
        """The series of the material, or of both bodies together; None of an alpha and of a material each."""
        given: Any = None if self.each is not None else self.material
        return given.total if isinstance(given, Bodies) else given

    @property
    def each(self) -> Prony | Bodies | None:
        """Many materials, of pairs that are alike their series."""
        given: Any = self.material
        if given is None or not given.shape:
            return None
        return given.cylinder if isinstance(given, Bodies) and given.like else given

    def in_own_time(self) -> tuple[Any, float]:
        """(alpha, or the series with its slow time near 1; the time that this is counted in over T_ref).

        Of a cover it and 1: its law is not that of the series alone.
        """
        if self.cover is not None:
            return self.cover, 1.0
        return (self.alpha, 1.0) if self.series is None else _in_own_time(self.series)

    @property
    def cover(self) -> Cover | None:
        """The layer of finite thickness that it rolls with or on; None of half-spaces."""
        return self.material if isinstance(self.material, Cover) else None

    @property
    def like_bodies(self) -> bool:
        """Whether cylinder and half-space deform alike, each taking half of M."""
        return not isinstance(self.material, Bodies) or self.material.like

    def tilted(self, slope: Any) -> Self:
        cosine = slope_tan_cos(slope)[1]
        more = {}
        if self.cover is not None:  # over the l0 of the load that is left
            more = {"material": self.cover.of_thickness(self.cover.thickness / np.sqrt(cosine))}
        return self.replace(
            kappa=self.kappa / np.sqrt(cosine), gamma=None if self.gamma is None else self.gamma * cosine, **more
        )

    def freely(self, V: Any) -> Free:
        """What rolls at V, let go; raises ParameterError of a cover."""
        refuse_cover(self, "how it rolls freely from rest needs N, which is not known")
        given: Any
        materials: Any
        unit: Any
        if self.each is None:
            given, unit = self.in_own_time()
            materials, which = np.unique(given, return_inverse=True) if np.ndim(given) else ([given], np.zeros((), int))
        else:
            given, unit = zip(*(_in_own_time(total_series(one)) for one in self.each), strict=True)
            unit = np.array(unit, np.float64)
            materials, which = given, np.arange(unit.size)
        gamma = np.nan if self.gamma is None else self.gamma
        with np.errstate(over="ignore"):
            u = np.asarray(self.kappa * np.abs(V) * unit + 0.0 * which)
            g = gamma * unit * unit / (1.0 + np.asarray(self.j))
        u, which = np.broadcast_arrays(u, which, g)[:2]
        return Free(materials, which, u, g, 1.0 / (self.kappa * unit), unit, 1.0 / self.kappa)

    @property
    def _given(self) -> dict[str, Any]:
        """Its parameters but the alpha of a material."""
        if self.material is None:
            return self.numbers
        return {"material": self.material} | {name: each for name, each in self.numbers.items() if name != "alpha"}

    def __repr__(self) -> str:
        return f"Scene({', '.join(f'{name}={format_value(value)}' for name, value in self._given.items())})"


def scale_of(given: Any) -> Scale:
    """Scale of what rolls; what is neither a scene nor a cylinder has that of a scene, and is refused elsewhere."""
    return given.scale if isinstance(given, Rolls) else DIMENSIONLESS


#: functions that answer where both bodies relax and one of them is a layer
_BEFORE_THE_SPLIT = ("contact", "stress", "validity", "resistance_extrema")


def framed(given: Any, call: str, *, moves: bool = False, slope: Any = None) -> tuple[Rolls, Parameters, Scale]:
    """What rolls, on its slope, its parameters and its scale; ``moves``: with a gamma.

    Raises
    ------
    ParameterError
        What is no scene and no cylinder, a slope out of range.
    """
    if not isinstance(given, Rolls):
        sentence = f"{call} takes a Scene or a Cylinder, not {given!r:.60}"
        if isinstance(given, LawGrid):
            sentence = f"{call} reads the rows of a law, as motions do, not a grid: vr.law(grid) gives its splines to "
            sentence += "an integrator of your own (docs/howto/law.md)"
        raise ParameterError("roller", type(given).__name__, "a Scene or a Cylinder", sentence)
    roller = given if slope is None else given.tilted(slope)
    scene = roller.scene()
    if scene.cover is not None and call not in _BEFORE_THE_SPLIT:
        scene.cover.refuse_unknown_split(call)
    if moves and scene.gamma is None:
        sentence = f"{call} needs the scene's gamma = P T_epsilon^2/(m R), which sets the time scale: it is not given"
        raise ParameterError("gamma", None, "a number > 0", sentence)
    return roller, scene, roller.scale


def refuse_cover(scene: Parameters, why: str) -> None:
    """Raise ParameterError where a body is a layer of finite thickness; ``why``: what is not known of it."""
    if scene.cover is not None:
        sentence = f"thickness = {format_value(scene.cover.thickness)} (over l0): of a layer of finite thickness {why}"
        raise ParameterError("thickness", scene.cover.thickness, "left out", sentence)


def refuse_arrays(scene: Parameters, names: Iterable[str], allowed: str = "a single number") -> None:
    """Raise ParameterError where a parameter is an array, by its name."""
    for name in names:
        if shape := np.shape(getattr(scene, name)):
            raise ParameterError(name, f"an array of shape {shape}", allowed)


def _refuse_ratio(mu: Floats, kappa: Floats) -> None:
    """Raise ParameterError where mu/kappa, and with it delta_star, leaves the range of doubles, or nearly."""
    low, high = RATIO_RANGE
    with np.errstate(over="ignore", under="ignore"):
        ratio = np.asarray(mu / kappa)
    wrong = ratio[~((low <= ratio) & (ratio <= high))]
    if wrong.size:
        raise ParameterError("mu/kappa", f"{wrong.flat[0]:g}", f"in [{low:g}, {high:g}]")
