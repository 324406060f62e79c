"""What rolls, dimensionless: :class:`Scene`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import broadcast_shape, checked, checked_extent
from .errors import ParameterError, one_of
from .free_rolling import Free, Strained
from .materials.bodies import Bodies
from .materials.bodies_array import BodiesArray
from .materials.law_table import LawTable
from .materials.prony import Prony
from .materials.prony_array import MaterialArray
from .materials.prony_forms import HIGHEST_ALPHA
from .steadiness import Steadiness
from .validity import Assumption, Validity, judge, unlike_speeds


def frozen(array: NDArray[np.float64]) -> float | NDArray[np.float64]:
    """A number, or a copy that nobody can write to."""
    if array.ndim == 0:
        return float(array)
    array = array.copy()
    array.flags.writeable = False
    return array


PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")


def same(one: Any, other: Any) -> bool:
    """Whether two parameters are equal, arrays or not."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    return bool(one == other)


#: of mu/kappa, in which delta_star is measured
RATIO_RANGE = (1e-290, 1e290)


def _in_own_time(series: Prony) -> tuple[float | Prony, float]:
    return series.in_own_time() if series.E.size else (1.0, 1.0)


def _short(value: Any) -> str:
    """A number, or what an array holds, in few words."""
    if not isinstance(value, np.ndarray):
        return f"{value:.12g}" if isinstance(value, float) else repr(value)
    return f"<{value.shape} in [{value.min():.6g}, {value.max():.6g}]>" if value.size else f"<{value.shape}>"


@dataclass(frozen=True, eq=False, repr=False)
class Scene:
    """Dimensionless parameters of the rolling cylinder (Eqs. (4) and Sect. 3.1).

    Each number may be an array; they broadcast against each other and against speeds.

    Parameters
    ----------
    alpha : T_epsilon/T_sigma, retardation over relaxation time, >= 1 (1: elastic) and <= 1e12;
        the unit of time is T_epsilon.
    kappa : R/l0 = sqrt(E' R/(32 P)), radius over contact length at rest, > 0;
        the half-space theory asks for kappa >> 1.
    mu : coefficient of friction, > 0.
    gamma : P T_epsilon^2/(m R), > 0; only scales time.  What moves needs it: roll and ensemble.
    j : J/(m R^2), > 0; 1/2 for a solid cylinder.  Not used by contact or stress.
    material : a :class:`Prony` series, or two (:class:`Bodies`), or n of either, an array parameter
        (n,), in place of ``alpha``, which is then that of the material; the unit of time is T_ref, in which a series
        counts its times.  A law of :func:`viscoroll.load_law` stands for its material, or its alpha.

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, the shapes do not broadcast, or both or neither of
        ``alpha`` and ``material`` are given.
    """

    alpha: Any = None
    kappa: Any = None
    mu: Any = None
    gamma: Any = None
    j: Any = 0.5
    material: Prony | Bodies | MaterialArray | LawTable | None = None
    _law: ClassVar[LawTable | None] = None

    def __post_init__(self) -> None:
        if self.material is not None:
            if self.alpha is not None:
                raise one_of("alpha", "material", both=True)
            if isinstance(self.material, LawTable):
                object.__setattr__(self, "_law", self.material)
                material = self.material.material
                of_alpha = not isinstance(material, Prony | Bodies)
                object.__setattr__(self, "alpha", material if of_alpha else None)
                object.__setattr__(self, "material", None if of_alpha else material)
        if self.material is not None:
            if not isinstance(self.material, Prony | Bodies | MaterialArray):
                raise ParameterError("material", f"{self.material!r:.60}", "a Prony series, or Bodies of two")
            object.__setattr__(self, "alpha", self.material.alpha)
        if self.alpha is None:
            raise one_of("alpha", "material", both=False)
        arrays = {"alpha": checked("alpha", self.alpha, low=1.0, high=HIGHEST_ALPHA)}
        extents = {}
        for name in ("kappa", "mu", "gamma", "j") if self.gamma is not None else ("kappa", "mu", "j"):
            arrays[name], extents[name] = checked_extent(name, getattr(self, name), low=0.0, strict=True)
        broadcast_shape(**arrays)
        if arrays["mu"].size and arrays["kappa"].size:
            low, high = RATIO_RANGE
            (least_mu, most_mu), (least_kappa, most_kappa) = extents["mu"], extents["kappa"]
            if not (least_mu >= low * most_kappa and most_mu <= high * least_kappa):
                _refuse_ratio(arrays["mu"], arrays["kappa"])
        for name, array in arrays.items():
            object.__setattr__(self, name, frozen(array))

    @property
    def law(self) -> LawTable | None:
        """The law that was given in place of its material."""
        return self._law

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape that the parameters broadcast to; () for one scene."""
        return np.broadcast_shapes(*map(np.shape, self.numbers.values()))

    @property
    def numbers(self) -> dict[str, Any]:
        """alpha, kappa, mu, gamma and j by name, those that are given."""
        values = {name: getattr(self, name) for name in PARAMETERS}
        return {name: value for name, value in values.items() if value is not None}

    def replace(self, **changes: Any) -> Scene:
        """A copy with some parameters changed; an alpha takes the place of a material, and the reverse."""
        if self.law is not None and not changes.keys() & {"alpha", "material"}:
            changes["material"] = self.law
        if "material" in changes and "alpha" not in changes:
            changes["alpha"] = None
        elif "alpha" in changes and "material" not in changes:
            changes["material"] = None
        elif self.material is not None and "alpha" not in changes:
            changes["alpha"] = None
        return replace(self, **changes)

    @property
    def series(self) -> Prony | None:
        """The series of the material, or of both bodies together; None of an alpha and of a material each."""
        if isinstance(self.material, Bodies):
            return self.material.total
        return self.material if isinstance(self.material, Prony) else None

    def in_own_time(self) -> tuple[Any, float]:
        """(alpha, or the series with its slow time near 1; the time that this is counted in over T_ref).

        Of a material each as they are.
        """
        if self.series is None:
            if isinstance(self.material, BodiesArray) and self.material.like:
                return self.material.cylinder, 1.0
            return self.alpha if self.material is None else self.material, 1.0
        return _in_own_time(self.series)

    @property
    def like_bodies(self) -> bool:
        """Whether cylinder and half-space deform alike, each taking half of M."""
        return not isinstance(self.material, Bodies | BodiesArray) or self.material.like

    def validity(self, V: ArrayLike, omega: ArrayLike | None = None) -> Validity:
        """Which assumptions of the model the contact at speed V strains.

        Parameters
        ----------
        V : speed of the axis, any sign.
        omega : angular velocity; without it the creep is not known.

        Returns
        -------
        Validity
            For each assumption a number, whether it holds, and a sentence; ``print`` shows them.

        Raises
        ------
        ParameterError
            NaN or infinite speeds, shapes that do not broadcast.
        """
        return self._validity(V, omega)[0]

    def _validity(self, V: ArrayLike, omega: ArrayLike | None) -> tuple[Validity, Strained]:
        """Also what the contact strains, for what a cylinder adds."""
        given = {"V": checked("V", V)} | ({} if omega is None else {"omega": checked("omega", omega)})
        broadcast_shape(**given, **{name: np.asarray(value) for name, value in self.numbers.items()})
        free = self.freely(given["V"])
        found = free.strained(self.kappa)
        steady = Assumption(None, None, "whether the law of steady rolling may drive a motion needs gamma")
        if self.gamma is not None:
            steady = Steadiness.of(free)
        delta, full_slip = None, None
        if omega is not None:
            speed, spin = given["V"], given["omega"]
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                delta = np.where(spin == speed, 0.0, (spin - speed) / speed)
            full_slip = np.abs(delta) >= self.mu * np.asarray(found.reach)
        return judge(found, steady, unlike_speeds(delta, full_slip)), found

    def freely(self, V: Any) -> Free:
        """What rolls at V, let go."""
        materials: Any
        unit: Any
        if isinstance(self.material, MaterialArray):
            each = (_in_own_time(one.total if isinstance(one, Bodies) else one) for one in self.material)
            materials, unit = np.array([*each], object).reshape(-1, 2).T
            which, unit = np.arange(unit.size), unit.astype(np.float64)
        else:
            given, unit = self.in_own_time()
            materials, which = np.unique(given, return_inverse=True) if np.ndim(given) else ([given], np.zeros((), int))
            which = which.reshape(np.shape(given))
        gamma = np.nan if self.gamma is None else self.gamma
        with np.errstate(over="ignore"):
            u = np.asarray(self.kappa * np.abs(V) * unit + 0.0 * which)
            g = gamma * unit * unit / (1.0 + np.asarray(self.j))
        shape = np.broadcast_shapes(u.shape, np.shape(g))
        u, which = np.broadcast_to(u, shape), np.broadcast_to(which, shape)
        return Free(materials, which, u, g, 1.0 / (self.kappa * unit), unit, 1.0 / self.kappa)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return all(same(getattr(self, name), getattr(other, name)) for name in (*PARAMETERS, "material"))

    def __hash__(self) -> int:
        parts = [np.asarray(value, np.float64) for value in self.numbers.values()]
        # + 0.0: -0 and 0 are equal
        return hash((*((part.shape, (part + 0.0).tobytes()) for part in parts), self.material))

    def __repr__(self) -> str:
        given = self.numbers if self.material is None else {"material": self.material} | self.numbers
        if self.material is not None:
            del given["alpha"]
        return f"Scene({', '.join(f'{name}={_short(value)}' for name, value in given.items())})"


def checked_scene(given: Any, call: str, *, moves: bool = False) -> Scene:
    """``given`` where it is a scene; ``moves``: with a gamma.

    Raises
    ------
    ParameterError
        Otherwise; of a cylinder with a word on what to write.
    """
    if not isinstance(given, Scene):
        kind = type(given).__name__
        if hasattr(given, "scene"):
            own = f", or call .{call}(...) of it in SI units" if hasattr(given, call) else "; it is dimensionless"
            sentence = f"{call} takes a Scene, not a {kind}: give its .scene(){own}"
        else:
            sentence = f"{call} takes a Scene, not {given!r:.60}"
        raise ParameterError("scene", kind, "a Scene", sentence)
    if moves and given.gamma is None:
        sentence = f"{call} needs the scene's gamma = P T_epsilon^2/(m R), which sets the time scale: it is not given"
        raise ParameterError("gamma", None, "a number > 0", sentence)
    return given


def _refuse_ratio(mu: NDArray[np.float64], kappa: NDArray[np.float64]) -> None:
    """Raise ParameterError where mu/kappa, and with it delta_star, leaves the range of doubles, or nearly."""
    low, high = RATIO_RANGE
    with np.errstate(over="ignore", under="ignore"):
        ratio = np.asarray(mu / kappa)
    wrong = ratio[~((low <= ratio) & (ratio <= high))]
    if wrong.size:
        raise ParameterError("mu/kappa", f"{wrong.flat[0]:g}", f"in [{low:g}, {high:g}]")
