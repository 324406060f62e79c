"""What a cylinder does, in SI units: :class:`InSI`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal

from ..drive import Feedback
from ..results import Values
from ..typed import Driving, Numbers

if TYPE_CHECKING:
    from ..equilibria import Steady
    from ..motion.single import Acting, Schedule
    from ..validity import Validity
    from .motion import EnsembleSI, MotionSI


class InSI:
    """Contact, stresses, motions and steady rolling of a cylinder; each takes and gives SI units, per m of length."""

    def contact(
        self,
        V: Numbers,
        omega: Numbers | None = None,
        *,
        delta: Numbers | None = None,
        fields: Iterable[str] | None = None,
        slopes: bool = False,
        method: Literal["table", "direct"] = "table",
    ) -> Values:
        """State of the contact as :func:`viscoroll.contact`, in SI units, per m of length.

        Parameters
        ----------
        V, omega : m/s and rad/s.  delta : creep ratio (omega R - V)/V, in place of omega.
        fields, slopes, method : as there, and among the fields ``length`` and ``C_rr``.

        Returns
        -------
        Values
            ``length`` of the contact in m; ``Q`` in N/m; ``M``, ``M_half_space`` and ``M_cylinder`` in N m/m; slopes of
            these; ratios as there, and ``C_rr`` = M/(P R), the coefficient of rolling resistance.  Force and moment on
            the cylinder, Eqs. (20), (21), are Q - M_half_space/R and Q R + M_cylinder.

        Raises
        ------
        ParameterError, ConvergenceError
            As there; where a value of a message is dimensionless, it says so.

        Examples
        --------
        >>> import viscoroll as vr
        >>> roller = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
        >>> state = roller.contact(V=0.01, omega=0.099)
        >>> traction, moment = state.Q, state.M
        """
        from .contact import contact_of

        return contact_of(self, V, omega, delta, fields=fields, slopes=slopes, method=method)

    def stress(self, x: Numbers, V: Numbers, omega: Numbers | None = None, *, delta: Numbers | None = None) -> Values:
        """Pressure and shear stress along the contact as :func:`viscoroll.stress`, in Pa.

        Parameters
        ----------
        x : position from the foot of the axis, m, positive along the axis of V.
        V, omega, delta : as for :meth:`contact`.

        Returns
        -------
        Values
            ``p`` and ``tau``, Pa.

        Raises
        ------
        ParameterError, ConvergenceError
            As there.
        """
        from .contact import stress_of

        return stress_of(self, x, V, omega, delta)

    def validity(self, V: Numbers, density: float | None = None, *, omega: Numbers | None = None) -> Validity:
        """Which assumptions of the model the contact at speed V strains.

        Parameters
        ----------
        V : speed of the axis, m/s.
        density : of the cylinder, and of the base where they are alike, kg/m^3; default: as the materials have
            it; without it the speed of shear waves is not known.
        omega : rad/s; without it the creep is not known.

        Returns
        -------
        Validity
            As :meth:`Scene.validity`; ``quasistatic`` compares the speed of the axis, and that of the
            circumference where omega is given, with the slowest shear wave, sqrt(G/density), G = E/(2 (1 + nu)) of
            long times, of the bodies whose density is known.  ``bodies`` holds Dundurs' constant, ``measured`` 1/s at
            which the contact is passed, and ``thick`` its length over the thickness of the layer.

        Raises
        ------
        ParameterError
            NaN or infinite speeds, a density that is not one positive number.
        """
        from .validity import validity_of

        return validity_of(self, V, density, omega)

    def steady(
        self,
        *,
        force: Numbers | Feedback | None = None,
        torque: Numbers | Feedback | None = None,
        slope: Numbers | None = None,
        V: Numbers | None = None,
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
            ``V`` in m/s, ``omega`` in rad/s, ``force``, ``Q`` in N/m, ``torque``, ``M`` and its parts in N m/m,
            ``eigenvalues`` in 1/s, powers of ``loss`` in W/m.

        Raises
        ------
        ParameterError, ConvergenceError
            As :func:`viscoroll.steady`; values in messages are dimensionless, but those of ``reason``.
        """
        from .steady import steady_of

        return steady_of(self, force, torque, slope, V)

    def roll(
        self,
        V0: float | None,
        omega0: float | None,
        t: Numbers,
        rtol: float = 1e-8,
        *,
        force: Acting = 0.0,
        torque: Acting = 0.0,
        slope: float | None = None,
        brake: Schedule | None = None,
        omega: Schedule | None = None,
        V: Schedule | None = None,
        rest: float | None = None,
        unsteady: bool = False,
        rested: bool | float = False,
        max_steps: int = 100_000,
    ) -> MotionSI:
        """Motion as :func:`viscoroll.roll`, in SI units, per m of length.

        Parameters
        ----------
        V0, omega0 : start speeds, m/s and rad/s.
        t : output times, s, or one end time.
        rtol, unsteady, max_steps : as there.
        force, torque : N and N m per m: a number; (times in s, values); a callable of t in s; or a :class:`Feedback`
            of any of these with gains over m/s and rad/s.
        slope : rad, > 0 pushes along +V; the load is then P cos(slope), and P sin(slope) adds to ``force``.
        brake : most torque that a brake takes, N m per m, as for ``force``.
        omega, V : prescribed speed, rad/s of the motor or m/s of the axis, likewise.
        rest : end the motion where both |V| and R |omega| fall below this, m/s.
        rested : whether the contact had rested long before it starts to roll, or for how long, s.

        Returns
        -------
        MotionSI
            ``V`` in m/s, ``omega`` in rad/s, ``x`` in m, ``force`` and ``torque`` as above, works and losses in J/m,
            ``power_force`` and ``power_torque`` in W/m, times of switches and reversals in s.  It is the dimensionless
            motion of :meth:`scene`, ``motion``, to a few roundings (``tests/si/test_motion.py``).

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
        from ..motion.driven import Drive
        from .motion import roll_of

        drive = Drive(force, torque, slope, brake, omega, V)
        options = {"rtol": rtol, "unsteady": unsteady, "max_steps": max_steps}
        return roll_of(self, (V0, omega0), t, drive, rest, rested, **options)

    def ensemble(
        self,
        V0: Numbers | None,
        omega0: Numbers | None,
        t: Numbers,
        *,
        force: Driving | Feedback = 0.0,
        torque: Driving | Feedback = 0.0,
        slope: Numbers | None = None,
        brake: Driving | None = None,
        omega: Driving | None = None,
        V: Driving | None = None,
        rest: float | None = None,
        rested: bool | float = False,
        **options: Any,
    ) -> EnsembleSI:
        """Roll n motions as :func:`viscoroll.ensemble`, in SI units, per m of length.

        Parameters
        ----------
        V0, omega0 : start speeds, m/s and rad/s, numbers or arrays (n,); the cylinder's numbers may be arrays too.
            Labels of xarray and pandas come back in ``to_xarray`` and ``to_pandas``.
        t : output times, s, common to all; one number: the final state only.
        force, torque, slope, brake, omega, V : as for :meth:`roll`; numbers may be arrays of n, values of
            (times, values) of shape (n, k).
        rest, rested : m/s and s, as for :meth:`roll`.
        **options : method, rtol, unsteady, fields, max_steps, speed (m/s), threads, progress, as there.

        Returns
        -------
        EnsembleSI
            The fields of :class:`Ensemble` in m/s, rad/s, m, s, N/m, N m/m and J/m.

        Raises
        ------
        ParameterError
            As there; where a value of a message is dimensionless, the message says over what.

        Examples
        --------
        The distance of a hundred rollers of uncertain friction.

        >>> import numpy as np, viscoroll as vr
        >>> friction = np.random.default_rng(0).uniform(0.2, 0.4, 100)
        >>> rollers = vr.RUBBER_CYLINDER.replace(mu=friction)
        >>> e = rollers.ensemble(0.5, 0.0, [0.1, 1.0], rtol=1e-6)
        >>> distance = e.x[:, -1]
        """
        from ..motion.driven import Drive
        from .motion import ensemble_of

        drive = Drive(force, torque, slope, brake, omega, V)
        return ensemble_of(self, (V0, omega0), t, drive, rest, rested, **options)
