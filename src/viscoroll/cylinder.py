"""What rolls, in SI units: :class:`Cylinder`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .checks import checked, number
from .drive import Feedback
from .errors import ParameterError
from .importers import poisson
from .material import Material, refuse_short_retardation
from .pair import Pair, Plane, effective_modulus
from .scene import Scene
from .validity import Validity, coupling, inertia

if TYPE_CHECKING:
    from .equilibria import Steady
    from .motion.si import MotionSI
    from .motion.single import Acting, Schedule

_SOLID = ("E", "nu", "T_epsilon", "T_sigma")


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """l0 of Sect. 3.1, m."""
    return np.sqrt(32.0 * R * load / E_prime)


def scene_from_si(
    R: Any, m: Any, E: Any, nu: Any, T_epsilon: Any, T_sigma: Any, mu: Any, j: Any, g: Any, plane: str, load: Any = None
) -> Scene:
    """The scene of a :class:`Cylinder`, or of many: its fields, unchecked, numbers or arrays."""
    T_epsilon, T_sigma = (np.asarray(value, np.float64)[()] for value in (T_epsilon, T_sigma))
    # what leaves the range of doubles becomes 0 or infinite, which Scene refuses by name
    with np.errstate(all="ignore"):
        alpha = T_epsilon / T_sigma
    return Scene(alpha, *_scaled(R, m, g, load, effective_modulus(E, nu, plane), T_epsilon, mu), j)


def scene_of_pair(R: Any, m: Any, pair: Pair, mu: Any, j: Any, g: Any, load: Any = None) -> Scene:
    """As :func:`scene_from_si`, of a pair of materials; times over its T_ref."""
    kappa, mu, gamma = _scaled(R, m, g, load, pair.E_prime, np.float64(pair.T_ref), mu)
    return Scene(kappa=kappa, mu=mu, gamma=gamma, j=j, material=pair.law)


def scene_of_series(
    R: Any, m: Any, E: Any, nu: Any, T_ref: float, series: Any, mu: Any, j: Any, g: Any, plane: str, load: Any = None
) -> Scene:
    """As :func:`scene_from_si`, of a series, or of one each, with the long-time modulus E; times over T_ref."""
    kappa, mu, gamma = _scaled(R, m, g, load, effective_modulus(E, nu, plane), np.float64(T_ref), mu)
    return Scene(kappa=kappa, mu=mu, gamma=gamma, j=j, material=series)


def _scaled(R: Any, m: Any, g: Any, load: Any, E_prime: Any, T: Any, mu: Any) -> tuple[Any, Any, Any]:
    """(kappa, mu, gamma) of Sect. 3.1 and Eq. (4)."""
    R, m = (np.asarray(value, np.float64)[()] for value in (R, m))
    with np.errstate(all="ignore"):
        P = m * g if load is None else np.asarray(load, np.float64)[()]
        return R / contact_length(R, P, E_prime), mu, P * T**2 / (m * R)


@dataclass(frozen=True, init=False)
class Cylinder:
    """A viscoelastic cylinder on a half-space, in SI units.

    Parameters
    ----------
    R : radius, m.
    m : mass per unit length, kg/m.
    E : long-time Young's modulus, Pa; with the next three, of both bodies, in place of ``material``.
    nu : Poisson's ratio, in (-1, 0.5].
    T_epsilon, T_sigma : retardation and relaxation time, s, T_epsilon >= T_sigma.
    mu : coefficient of friction.
    j : J/(m R^2); 1/2 for a solid cylinder.
    g : gravitational acceleration, m/s^2.
    plane : "strain", or "stress" (then E' = pi E).
    material : a :class:`Material`, in place of E, nu, T_epsilon and T_sigma.
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

    R: float
    m: float
    E: float | None
    nu: float | None
    T_epsilon: float | None
    T_sigma: float | None
    mu: float
    j: float
    g: float
    plane: Plane
    material: Material | None
    base: Material | None
    #: the load as it was given: ``dataclasses.replace`` with another m makes the weight anew
    pressed: float | None

    def __init__(
        self, R: float, m: float, E: float | None = None, nu: float | None = None, T_epsilon: float | None = None,
        T_sigma: float | None = None, mu: float | None = None, j: float = 0.5, g: float = 9.81, plane: Plane = "strain",
        *, material: Material | None = None, base: Material | None = None, load: float | None = None,
        pressed: float | None = None,
    ) -> None:  # fmt: skip
        given: dict[str, Any] = {
            "R": R, "m": m, "E": E, "nu": nu, "T_epsilon": T_epsilon, "T_sigma": T_sigma, "mu": mu, "j": j, "g": g,
            "plane": plane, "material": material, "base": base, "pressed": pressed if load is None else load,
        }  # fmt: skip
        solid = [name for name in _SOLID if given[name] is not None]
        if material is not None and solid:
            names = ", ".join(("material", *solid))
            raise ParameterError(f"{names} given", "both", f"one of material and {', '.join(_SOLID)}")
        for name in ("R", "m", "mu", "j", "g", *(() if material is not None else _SOLID)):
            low = {"nu": -math.inf}.get(name, 0.0)
            given[name] = number(name, given[name], low=low, strict=True)
        if given["pressed"] is not None:
            given["pressed"] = number("load", given["pressed"], low=0.0, strict=True)
        if plane not in ("strain", "stress"):
            raise ParameterError("plane", repr(plane), "'strain' or 'stress'")
        for name, value in given.items():
            object.__setattr__(self, name, value)
        if material is None:
            poisson(given["nu"])
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
        if self.material is not None:
            return Pair(self.material, self.base, self.plane)
        solid: dict[str, Any] = {name: getattr(self, name) for name in _SOLID}
        return Pair(Material.sls(**solid), self.base, self.plane)

    @property
    def T_ref(self) -> float:
        """What dimensionless times are counted in, s: T_epsilon, or T_ref of the materials."""
        return self.T_epsilon if self.T_epsilon is not None and self._papers else self.pair.T_ref

    @property
    def load(self) -> float:
        """P, N/m: as given, or m g."""
        return self.m * self.g if self.pressed is None else self.pressed

    @property
    def E_prime(self) -> float:
        """E' = pi E/(1 - nu^2) in plane strain, pi E in plane stress, Pa (Sect. 3.1).

        Of two bodies 2/(1/E'_1 + 1/E'_2).
        """
        return effective_modulus(self.E, self.nu, self.plane) if self._papers else self.pair.E_prime

    @property
    def l0(self) -> float:
        """Contact length at rest, sqrt(32 R P/E'), m."""
        return float(contact_length(self.R, self.load, self.E_prime))

    def scene(self) -> Scene:
        """The dimensionless scene: alpha or the series of the materials, kappa, gamma of Sect. 3.1 and Eq. (4)."""
        if self._papers:
            solid: dict[str, Any] = {name: getattr(self, name) for name in (*_SOLID, "R", "m", "mu", "j", "g", "plane")}
            return scene_from_si(**solid, load=self.pressed)
        return scene_of_pair(self.R, self.m, self.pair, self.mu, self.j, self.g, self.pressed)

    def validity(self, V: ArrayLike, density: float | None = None) -> Validity:
        """Which assumptions of the model the contact at (dimensionless) speed V strains.

        Parameters
        ----------
        V : speed of the axis, T_ref V_si/R.
        density : of the cylinder, and of the base where they are alike, kg/m^3; default: as the materials have
            it; without it the speed of shear waves is not known.

        Returns
        -------
        Validity
            As :meth:`Scene.validity`; ``quasistatic`` compares the speed of the axis with the slowest shear wave,
            sqrt(G/density), G = E/(2 (1 + nu)) of long times, of the bodies whose density is known.  Compare
            omega R too where the cylinder spins faster than it moves.  ``bodies`` holds Dundurs' constant.

        Raises
        ------
        ParameterError
            NaN or infinite V, a density that is not one positive number.
        """
        if density is not None:
            density = number("density", density, low=0.0, strict=True)
        speed, slowness, unknown = np.abs(self.V_to_si(checked("V", V))), [], []
        for name, body, given in self._weighed(density):
            if given is not None:
                slowness.append((1.0 / body.G, given))
            elif not body.is_rigid:
                unknown.append(name)
        ratio = None
        if slowness:
            with np.errstate(over="ignore"):  # in this order V = 0 gives 0 at any density; else it may be infinite
                ratio = np.max([speed * math.sqrt(soft) * math.sqrt(weight) for soft, weight in slowness], axis=0)
        long = "a long cylinder, or one held between walls (plane strain)"
        return self.scene()._validity(
            V, inertia(ratio, unknown), coupling(*self.pair.dundurs, like=self.pair.like),
            long if self.plane == "strain" else "a thin disc (plane stress)",
        )  # fmt: skip

    def _weighed(self, density: float | None) -> list[tuple[str, Material, float | None]]:
        """The different bodies, with their densities."""
        first, second = self.pair.cylinder, self.pair.half_space
        own = first.density if density is None else density
        if self.pair.like:
            return [("the material", first, second.density if own is None else own)]
        return [("the cylinder", first, own), ("the base", second, second.density)]

    def V_from_si(self, V_si: ArrayLike) -> Any:
        """Dimensionless V = T_ref V_si/R from m/s."""
        return np.asarray(V_si, float)[()] * (self.T_ref / self.R)

    def V_to_si(self, V: ArrayLike) -> Any:
        """Speed in m/s."""
        return np.asarray(V, float)[()] * (self.R / self.T_ref)

    def omega_from_si(self, omega_si: ArrayLike) -> Any:
        """Dimensionless omega = T_ref omega_si from rad/s."""
        return np.asarray(omega_si, float)[()] * self.T_ref

    def omega_to_si(self, omega: ArrayLike) -> Any:
        """Angular velocity in rad/s."""
        return np.asarray(omega, float)[()] / self.T_ref

    def t_from_si(self, t_si: ArrayLike) -> Any:
        """Dimensionless time t_si/T_ref from s."""
        return np.asarray(t_si, float)[()] / self.T_ref

    def t_to_si(self, t: ArrayLike) -> Any:
        """Time in s."""
        return np.asarray(t, float)[()] * self.T_ref

    def x_to_si(self, x: ArrayLike) -> Any:
        """Distance travelled in m, from units of R."""
        return np.asarray(x, float)[()] * self.R

    def traction_to_si(self, Q: ArrayLike, M: ArrayLike | None = None, *, M_half_space: ArrayLike | None = None) -> Any:
        """Horizontal force F_xi = P (Q - M_half_space), N per m of length; of like bodies by M/2, Eq. (20).

        Raises
        ------
        ParameterError
            Both or neither moment, or M alone where the bodies differ: the half-space's part is needed.
        """
        return self.load * (np.asarray(Q, float) - self._part(M, M_half_space, "M_half_space"))[()]

    def torque_to_si(self, Q: ArrayLike, M: ArrayLike | None = None, *, M_cylinder: ArrayLike | None = None) -> Any:
        """Moment about the axis M_zeta = P R (Q + M_cylinder), N m per m of length; of like bodies by M/2, Eq. (21).

        Raises
        ------
        ParameterError
            Both or neither moment, or M alone where the bodies differ: the cylinder's part is needed.
        """
        return self.load * self.R * (np.asarray(Q, float) + self._part(M, M_cylinder, "M_cylinder"))[()]

    def steady(
        self,
        *,
        force: ArrayLike | Feedback | None = None,
        torque: ArrayLike | Feedback | None = None,
        slope: ArrayLike | None = None,
        V: ArrayLike | None = None,
    ) -> Steady:
        """Steady rolling under load as :func:`viscoroll.steady`, in SI units.

        Parameters
        ----------
        force, torque : N and N m per m of length, numbers, arrays or a :class:`Feedback` with gains over m/s and rad/s.
        slope : rad, > 0 drives along +V; the load is then P cos(slope), and P sin(slope) adds to ``force``.
        V : m/s, in place of one of force and torque.

        Returns
        -------
        Steady
            ``V`` in m/s, ``omega`` in rad/s, ``force`` and ``torque`` as above, ``eigenvalues`` in 1/s, powers of
            ``loss`` in W/m; ``Q``, ``M`` and its parts over load, and load times R, as everywhere.

        Raises
        ------
        ParameterError, ConvergenceError
            As :func:`viscoroll.steady`; values in messages are dimensionless, but those of ``reason``.
        """
        from .equilibria.si import steady_of

        return steady_of(self, force, torque, slope, V)

    def roll(
        self,
        V0: float | None,
        omega0: float | None,
        t: ArrayLike,
        rtol: float = 1e-8,
        *,
        force: Acting = 0.0,
        torque: Acting = 0.0,
        slope: float | None = None,
        brake: Schedule | None = None,
        omega: Schedule | None = None,
        V: Schedule | None = None,
        rest: float | None = None,
        max_steps: int = 100_000,
    ) -> MotionSI:
        """Motion as :func:`viscoroll.roll`, in SI units, per m of length.

        Parameters
        ----------
        V0, omega0 : start speeds, m/s and rad/s.
        t : output times, s, or one end time.
        rtol, max_steps : as there.
        force, torque : N and N m per m: a number; (times in s, values); a callable of t in s; or a :class:`Feedback`
            of any of these with gains over m/s and rad/s.
        slope : rad, > 0 pushes along +V; the load is then P cos(slope), and P sin(slope) adds to ``force``.
        brake : most torque that a brake takes, N m per m, as for ``force``.
        omega, V : prescribed speed, rad/s of the motor or m/s of the axis, likewise.
        rest : end the motion where both |V| and R |omega| fall below this, m/s.

        Returns
        -------
        MotionSI
            ``V`` in m/s, ``omega`` in rad/s, ``x`` in m, ``force`` and ``torque`` as above, works and losses in J/m,
            ``power_force`` and ``power_torque`` in W/m, times of switches and reversals in s.  It is the dimensionless
            motion of :meth:`scene`, ``motion``, to a few roundings (``tests/motion/test_motion_si.py``).

        Raises
        ------
        ParameterError
            As :func:`viscoroll.roll`; where a value of a message is dimensionless, the message says over what.

        Warns
        -----
        RuntimeWarning
            Where the motion could not be rolled to the end.

        Examples
        --------
        A roller on a slope of 2 degrees, driven by 1 N m/m for the first second, then braked.

        >>> import numpy as np, viscoroll as vr
        >>> roller = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
        >>> down = np.radians(2.0)
        >>> m = roller.roll(0.0, 0.0, 3.0, torque=([1.0, 1.0], [1.0, 0.0]), brake=([1.0, 1.0], [0.0, 5.0]), slope=down)
        """
        from .motion.driven import Drive
        from .motion.si import roll_of

        drive = Drive(force, torque, slope, brake, omega, V)
        return roll_of(self, (V0, omega0), t, drive, rtol, rest, max_steps)

    def _part(self, M: ArrayLike | None, own: ArrayLike | None, name: str) -> Any:
        """The moment of one body."""
        if (M is None) == (own is None):
            raise ParameterError(f"M, {name} given", "neither" if M is None else "both", "exactly one of the two")
        if own is not None:
            return np.asarray(own, float)
        if not self.pair.like:
            raise ParameterError("M given", "for both bodies", f"{name}=: the bodies differ, and with them their parts")
        return 0.5 * np.asarray(M, float)
