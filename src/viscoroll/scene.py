"""What rolls: :class:`Scene` (dimensionless), :class:`Cylinder` (SI), the paper's presets."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .bodies import Bodies
from .checks import broadcast_shape, checked, checked_extent, number
from .errors import ParameterError
from .prony import HIGHEST_ALPHA, Prony
from .validity import Validity, contact_reach, judge, unsteadiness


def _frozen(array: NDArray[np.float64]) -> float | NDArray[np.float64]:
    if array.ndim == 0:
        return float(array)
    array = array.copy()
    array.flags.writeable = False
    return array


#: of mu/kappa, in which delta_star is measured
RATIO_RANGE = (1e-290, 1e290)


@dataclass(frozen=True, eq=False)
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
    gamma : P T_epsilon^2/(m R), > 0; only scales time.  Not used by contact or stress.
    j : J/(m R^2), > 0; 1/2 for a solid cylinder.  Not used by contact or stress.
    material : a :class:`Prony` series, or two (:class:`Bodies`), in place of ``alpha``, which is then
        that of the material; the unit of time is T_ref, in which a series counts its times.

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, the shapes do not broadcast, or both or neither of
        ``alpha`` and ``material`` are given.
    """

    alpha: Any = None
    kappa: Any = None
    mu: Any = None
    gamma: Any = 1.0
    j: Any = 0.5
    material: Prony | Bodies | None = None

    def __post_init__(self) -> None:
        if self.material is not None:
            if self.alpha is not None:
                raise ParameterError("alpha, material given", "both", "one of the two")
            if not isinstance(self.material, Prony | Bodies):
                raise ParameterError("material", f"{self.material!r:.60}", "a Prony series, or Bodies of two")
            object.__setattr__(self, "alpha", self.material.alpha)
        arrays = {"alpha": checked("alpha", self.alpha, low=1.0, high=HIGHEST_ALPHA)}
        extents = {}
        for name in ("kappa", "mu", "gamma", "j"):
            arrays[name], extents[name] = checked_extent(name, getattr(self, name), low=0.0, strict=True)
        broadcast_shape(**arrays)
        if arrays["mu"].size and arrays["kappa"].size:
            low, high = RATIO_RANGE
            (least_mu, most_mu), (least_kappa, most_kappa) = extents["mu"], extents["kappa"]
            if not (least_mu >= low * most_kappa and most_mu <= high * least_kappa):
                _refuse_ratio(arrays["mu"], arrays["kappa"])
        for name, array in arrays.items():
            object.__setattr__(self, name, _frozen(array))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape that the parameters broadcast to; () for one scene."""
        return np.broadcast_shapes(*(np.shape(getattr(self, f.name)) for f in fields(self)))

    def replace(self, **changes: Any) -> Scene:
        """A copy with some parameters changed; an alpha takes the place of a material, and the reverse."""
        if "material" in changes and "alpha" not in changes:
            changes["alpha"] = None
        elif "alpha" in changes and "material" not in changes:
            changes["material"] = None
        elif self.material is not None and "alpha" not in changes:
            changes["alpha"] = None
        return replace(self, **changes)

    def in_own_time(self) -> tuple[Any, float]:
        """(alpha, or the series with its slow time near 1; the time that this is counted in over T_ref)."""
        if self.material is None:
            return self.alpha, 1.0
        series = self.material.total if isinstance(self.material, Bodies) else self.material
        return series.in_own_time() if series.E.size else (1.0, 1.0)

    @property
    def like_bodies(self) -> bool:
        """Whether cylinder and half-space deform alike, each taking half of M."""
        return not isinstance(self.material, Bodies) or self.material.like

    def validity(self, V: ArrayLike) -> Validity:
        """Which assumptions of the model the contact at speed V strains.

        Returns
        -------
        Validity
            For each assumption a number, whether it holds, and a sentence; ``print`` shows them.

        Raises
        ------
        ParameterError
            NaN or infinite V, shapes that do not broadcast.
        """
        return self._validity(V, None, "the cylinder is long or held between walls (plane strain), or a thin disc")

    def _validity(self, V: ArrayLike, wave_ratio: Any, plane: str) -> Validity:
        speed = checked("V", V)
        broadcast_shape(alpha=np.asarray(self.alpha), kappa=np.asarray(self.kappa), V=speed)
        material, unit = self.in_own_time()
        nu = np.asarray(self.gamma * self._unsteadiness() / (1.0 + np.asarray(self.j)))
        return judge(*contact_reach(material, self.kappa, speed * unit), wave_ratio, nu, plane)

    def _unsteadiness(self) -> Any:
        """The most that |N| may be, over the unit of time squared."""
        if self.material is None:
            alpha = np.asarray(self.alpha)
            return unsteadiness((alpha - 1.0) / alpha**2, (alpha - 1.0) / alpha)
        series = self.material.total if isinstance(self.material, Bodies) else self.material
        return unsteadiness((series.E * series.tau**2).sum(), (series.J * series.T**2).sum())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    __hash__ = None  # type: ignore[assignment]


def _refuse_ratio(mu: NDArray[np.float64], kappa: NDArray[np.float64]) -> None:
    """Raise ParameterError where mu/kappa, and with it delta_star, leaves the range of doubles, or nearly."""
    low, high = RATIO_RANGE
    with np.errstate(over="ignore", under="ignore"):
        ratio = np.asarray(mu / kappa)
    wrong = ratio[~((low <= ratio) & (ratio <= high))]
    if wrong.size:
        raise ParameterError("mu/kappa", f"{wrong.flat[0]:g}", f"in [{low:g}, {high:g}]")


def effective_modulus(E: Any, nu: Any, plane: str) -> Any:
    """E' of Sect. 3.1, Pa."""
    return math.pi * E / (1.0 - nu**2 if plane == "strain" else 1.0)


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """l0 of Sect. 3.1, m."""
    return np.sqrt(32.0 * R * load / E_prime)


def scene_from_si(
    R: Any, m: Any, E: Any, nu: Any, T_epsilon: Any, T_sigma: Any, mu: Any, j: Any, g: Any, plane: str
) -> Scene:
    """The scene of a :class:`Cylinder`, or of many: its fields, unchecked, numbers or arrays."""
    R, m, T_epsilon, T_sigma = (np.asarray(value, np.float64)[()] for value in (R, m, T_epsilon, T_sigma))
    # what leaves the range of doubles becomes 0 or infinite, which Scene refuses by name
    with np.errstate(all="ignore"):
        l0 = contact_length(R, m * g, effective_modulus(E, nu, plane))
        alpha, kappa, gamma = T_epsilon / T_sigma, R / l0, m * g * T_epsilon**2 / (m * R)
    return Scene(alpha, kappa, mu, gamma, j)


@dataclass(frozen=True)
class Cylinder:
    """A viscoelastic cylinder on a half-space of the same material, in SI units.

    Parameters
    ----------
    R : radius, m.
    m : mass per unit length, kg/m.
    E : long-time Young's modulus, Pa.
    nu : Poisson's ratio, in (-1, 0.5].
    T_epsilon, T_sigma : retardation and relaxation time, s, T_epsilon >= T_sigma.
    mu : coefficient of friction.
    j : J/(m R^2); 1/2 for a solid cylinder.
    g : gravitational acceleration, m/s^2; the load is P = m g (Sect. 3.5).
    plane : "strain", or "stress" (then E' = pi E).

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range.

    Notes
    -----
    ``*_from_si`` and ``*_to_si`` take numbers or arrays and are good to a few roundings
    (``tests/test_scene.py``).
    """

    R: float
    m: float
    E: float
    nu: float
    T_epsilon: float
    T_sigma: float
    mu: float
    j: float = 0.5
    g: float = 9.81
    plane: Literal["strain", "stress"] = "strain"

    def __post_init__(self) -> None:
        for name in ("R", "m", "E", "T_epsilon", "T_sigma", "mu", "j", "g"):
            object.__setattr__(self, name, number(name, getattr(self, name), low=0.0, strict=True))
        object.__setattr__(self, "nu", number("nu", self.nu))
        if not -1.0 < self.nu <= 0.5:
            raise ParameterError("nu", self.nu, "in (-1, 0.5]")
        if self.T_epsilon < self.T_sigma:
            raise ParameterError("T_epsilon", self.T_epsilon, f">= T_sigma = {self.T_sigma}")
        if self.plane not in ("strain", "stress"):
            raise ParameterError("plane", repr(self.plane), "'strain' or 'stress'")

    @property
    def load(self) -> float:
        """P = m g, N/m."""
        return self.m * self.g

    @property
    def E_prime(self) -> float:
        """E' = pi E/(1 - nu^2) in plane strain, pi E in plane stress, Pa (Sect. 3.1)."""
        return effective_modulus(self.E, self.nu, self.plane)

    @property
    def l0(self) -> float:
        """Contact length at rest, sqrt(32 R P/E'), m."""
        return float(contact_length(self.R, self.load, self.E_prime))

    def scene(self) -> Scene:
        """The dimensionless scene: alpha, kappa, gamma of Sect. 3.1 and Eq. (4)."""
        return scene_from_si(**{f.name: getattr(self, f.name) for f in fields(self)})

    def validity(self, V: ArrayLike, density: float | None = None) -> Validity:
        """Which assumptions of the model the contact at (dimensionless) speed V strains.

        Parameters
        ----------
        V : speed of the axis, T_epsilon V_si/R.
        density : of the material, kg/m^3; without it the speed of shear waves is not known.

        Returns
        -------
        Validity
            As :meth:`Scene.validity`; ``quasistatic`` compares the speed of the axis with the
            slowest shear wave, sqrt(G/density), G = E/(2 (1 + nu)) of long times.  Compare
            omega R too where the cylinder spins faster than it moves.

        Raises
        ------
        ParameterError
            NaN or infinite V, a density that is not one positive number.
        """
        ratio = None
        if density is not None:
            # in this order V = 0 gives 0 at any density; a ratio beyond the doubles is infinite
            softness, weight = 2.0 * (1.0 + self.nu) / self.E, number("density", density, low=0.0, strict=True)
            with np.errstate(over="ignore"):
                ratio = np.abs(self.V_to_si(checked("V", V))) * math.sqrt(softness) * math.sqrt(weight)
        long = "a long cylinder, or one held between walls (plane strain)"
        return self.scene()._validity(V, ratio, long if self.plane == "strain" else "a thin disc (plane stress)")

    def V_from_si(self, V_si: ArrayLike) -> Any:
        """Dimensionless V = T_epsilon V_si/R from m/s."""
        return np.asarray(V_si, float)[()] * (self.T_epsilon / self.R)

    def V_to_si(self, V: ArrayLike) -> Any:
        """Speed in m/s."""
        return np.asarray(V, float)[()] * (self.R / self.T_epsilon)

    def omega_from_si(self, omega_si: ArrayLike) -> Any:
        """Dimensionless omega = T_epsilon omega_si from rad/s."""
        return np.asarray(omega_si, float)[()] * self.T_epsilon

    def omega_to_si(self, omega: ArrayLike) -> Any:
        """Angular velocity in rad/s."""
        return np.asarray(omega, float)[()] / self.T_epsilon

    def t_from_si(self, t_si: ArrayLike) -> Any:
        """Dimensionless time t_si/T_epsilon from s."""
        return np.asarray(t_si, float)[()] / self.T_epsilon

    def t_to_si(self, t: ArrayLike) -> Any:
        """Time in s."""
        return np.asarray(t, float)[()] * self.T_epsilon

    def x_to_si(self, x: ArrayLike) -> Any:
        """Distance travelled in m, from units of R."""
        return np.asarray(x, float)[()] * self.R

    def traction_to_si(self, Q: ArrayLike, M: ArrayLike) -> Any:
        """Horizontal force F_xi = Q - M/(2R) of Eq. (20), N per m of length."""
        return self.load * (np.asarray(Q, float) - 0.5 * np.asarray(M, float))[()]

    def torque_to_si(self, Q: ArrayLike, M: ArrayLike) -> Any:
        """Moment about the axis M_zeta = R Q + M/2 of Eq. (21), N m per m of length."""
        return self.load * self.R * (np.asarray(Q, float) + 0.5 * np.asarray(M, float))[()]


#: Sect. 5 as it was computed: from the dimensional list of Sect. 4 with g = 9.81 m/s^2 and
#: mu = 0.2.  Gives alpha = 11.031, kappa = 2.9210, gamma = 11231 and the paper's numbers.
PAPER_CYLINDER = Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
PAPER_SECTION_5 = PAPER_CYLINDER.scene()
#: The rounded parameters printed at the end of Sect. 4; stick onset of IC1 moves 2 % later.
PAPER_SECTION_5_ROUNDED = Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4, j=0.5)
#: Figs. 2 and 3 use kappa = 29.1, ten times that of Sects. 4-5; alpha is varied there
#: (1, 1.5, 21.5, 81.5 in Figs. 2 and 3b, 11 in Fig. 3a).
PAPER_FIGURES_2_3 = Scene(alpha=11.0, kappa=29.1, mu=0.2, gamma=1.1e4, j=0.5)
PRESETS = {
    "paper-section-5": PAPER_SECTION_5,
    "paper-section-5-rounded": PAPER_SECTION_5_ROUNDED,
    "paper-figures-2-3": PAPER_FIGURES_2_3,
}
#: Initial conditions (V, omega) of Sect. 5.1.
PAPER_STARTS = {"IC1": (1.5, 0.5), "IC2": (-1.5, 0.5), "IC3": (-1.5, -2.0)}


def kernel_scene(material: float | Prony, kappa: float, mu: float, j: float) -> Any:
    """The record that the kernels of a motion take, for this thread alone."""
    from .kernels.motion import records
    from .material_tables import record

    return records.Scene(record(material), kappa, mu, j)
