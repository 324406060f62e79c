"""One motion: :func:`roll` and its result."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import MOTION_STATUS, MotionStatus, ParameterError
from ..material_tables import record
from ..rolling_contact import Values, contact
from ..scene import Scene
from .checks import controls, like_bodies, output_times, start_speeds

if TYPE_CHECKING:
    import xarray as xr

REGIMES = ("full slip", "partial slip", "rest")
_QUANTITIES = ("V", "omega", "x", "angle", "delta")
_SWITCHES_KEPT = 1000
#: room for the ends of steps at first
_STEPS = 1000
_NO_SWITCHES = np.empty((0, 2))


class Switch(NamedTuple):
    """A change of regime: when, and what follows."""

    t: float
    regime: str


@dataclass(frozen=True)
class Motion:
    """One motion of the cylinder; everything dimensionless.

    Attributes
    ----------
    t, V, omega : output times and speeds.
    x, angle : distance travelled over R, and angle turned in radians, both 0 at t = 0.
    delta : creep ratio (infinite where V = 0 while sliding).
    regime : 0 full slip, 1 partial slip, 2 rest (see ``REGIMES``).
    switches : every change of regime, located to rounding.
    onset_time : first change from full to partial slip; NaN if there is none.
    rest_time : when max(|V|, |omega|) fell below ``rest``; NaN if it did not.
    status, message : how the motion ended; outputs it did not reach are NaN.
    steps : integration steps taken, rejected ones included.
    """

    scene: Scene
    t: NDArray[np.float64]
    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    x: NDArray[np.float64]
    angle: NDArray[np.float64]
    delta: NDArray[np.float64]
    regime: NDArray[np.int8]
    switches: tuple[Switch, ...]
    onset_time: float
    rest_time: float
    status: MotionStatus
    steps: int
    _inputs: tuple = field(repr=False)

    @property
    def message(self) -> str:
        """The status in words."""
        return MOTION_STATUS[self.status]

    def contact(self, fields: Iterable[str] | None = None, **options: Any) -> Values:
        """Contact state (:func:`viscoroll.contact`) along the motion.

        At rest, and where V passes through zero while sliding, the limits V -> 0 stand.  At times that the
        motion did not reach everything is NaN, and ``full_slip`` False.

        Parameters
        ----------
        fields, **options : as for :func:`viscoroll.contact`.

        Returns
        -------
        Values
            Each field over t.  The law is exact to rounding: errors are those of V and delta, which beta
            and Q magnify near full slip (``tests/motion/test_motion.py``).

        Raises
        ------
        ParameterError
            Unknown fields or options out of range.
        """
        reached = self.regime >= 0
        V, delta = self.V[reached], self.delta[reached]
        delta = np.where(np.isfinite(delta), delta, np.copysign(1e300, delta))
        found = contact(self.scene, V, delta=delta, fields=fields, **options)
        return found if reached.all() else Values({k: _with_gaps(v, reached) for k, v in found.as_dict().items()})

    def at(self, t: ArrayLike) -> Motion:
        """The same motion at other times within [0, end]; by the continuous output of the methods.

        Parameters
        ----------
        t : times, ascending.

        Returns
        -------
        Motion
            As exact between the steps as at their ends (``tests/motion/test_motion.py``).

        Raises
        ------
        ParameterError
            Times that are not ascending or lie beyond the end of the motion.
        """
        times = output_times(t)
        V0, omega0, end, rtol, rest, max_steps = self._inputs
        if times[-1] > end:
            raise ParameterError("t", times[-1], f"within the motion, [0, {end:.6g}]")
        return _integrate(self.scene, V0, omega0, times, end, rtol, rest, max_steps)

    def to_xarray(self) -> xr.Dataset:
        """Dataset over t with V, omega, x, angle, delta, regime and the scene as attributes."""
        from .export import motion_dataset

        return motion_dataset(self)


def _with_gaps(values: NDArray, reached: NDArray[np.bool_]) -> NDArray:
    """``values`` where ``reached``, and between them NaN, or False among booleans."""
    whole = np.full(reached.shape, False if values.dtype == bool else np.nan)
    whole[reached] = values
    return whole


def roll(
    scene: Scene,
    V0: float,
    omega0: float,
    t: ArrayLike,
    rtol: float = 1e-8,
    *,
    rest: float | None = None,
    max_steps: int = 100_000,
) -> Motion:
    """Motion of the cylinder from (V0, omega0), Eq. (22), through all regimes.

    Parameters
    ----------
    scene : one scene (no arrays).
    V0, omega0 : start speeds, any sign; the larger of the two 0, or in [1e-300, 1e100] in size.
    t : output times, ascending, or one end time: then output falls on the steps taken.
    rtol : tolerance in [1e-12, 1e-2]; the global relative error of x and the switch times is
        proportional to it, that of V and omega too, times t |V'|/|V|, by which a late
        speed magnifies any earlier error: mostly below rtol, at most 30 rtol on the scenes
        of ``tests/motion/test_motion.py``; rare motions elsewhere may exceed that a little.
    rest : end the motion where max(|V|, |omega|) falls below this.  Nothing stops in
        finite time: at small V the speed decays like exp(-gamma c t/(1 + j)) with
        c = (alpha - 1)/alpha, and an elastic cylinder (alpha = 1) rolls for ever.  From
        there on V = omega = 0 and x, angle stay; the distance so left out is close to
        (1 + j) V/(gamma c).
    max_steps : step limit, at most 10^7.

    Returns
    -------
    Motion

    Raises
    ------
    ParameterError
        NaN, infinite or oversized input, unsorted times, an array where one number belongs.

    Warns
    -----
    RuntimeWarning
        Where the motion could not be rolled to the end; ``status`` and ``message`` say why.
    """
    like_bodies(scene)
    times = output_times(t)
    inputs = start_speeds(V0, omega0)
    for name, value in (("scene", scene), ("V0", inputs[0]), ("omega0", inputs[1])):
        if value.shape != ():
            raise ParameterError(name, f"array of shape {value.shape}", "one motion's; for many use ensemble")
    rtol, threshold, max_steps = controls(rtol, rest, max_steps)
    start = (scene, float(inputs[0]), float(inputs[1]))
    if np.ndim(t) == 0:
        times = _step_times(*start, times, rtol, threshold, max_steps)
    motion = _integrate(*start, times, times[-1], rtol, threshold, max_steps)
    if motion.status > MotionStatus.RESTED:
        warnings.warn(f"roll: {motion.message}; outputs not reached are NaN", RuntimeWarning, stacklevel=2)
    return motion


def _step_times(
    scene: Scene, V0: float, omega0: float, end: NDArray, rtol: float, rest: float, max_steps: int
) -> NDArray:
    """0, the ends of the steps and the nodes between them, and the end time."""
    ends = np.empty(0)
    while ends.size < max_steps and not np.isnan(ends).any():  # full: there may be more
        ends = np.full(min(max(4 * ends.size, _STEPS), max_steps), np.nan)
        rolled(scene, V0, omega0, end, (rtol, rest, max_steps), (_NO_SWITCHES, ends))
    return np.unique(np.concatenate(([0.0], ends[ends < end], end)))


def _integrate(
    scene: Scene, V0: float, omega0: float, times: NDArray, end: float, rtol: float, rest: float, max_steps: int
) -> Motion:
    asked = times if times[-1] == end else np.append(times, end)
    switches = np.empty((_SWITCHES_KEPT, 2))
    out, (status, steps, turns, onset_time, rest_time) = rolled(
        scene, V0, omega0, asked, (rtol, rest, max_steps), (switches, np.empty(0))
    )
    rows = dict(zip(_QUANTITIES, out[:, : times.size], strict=False))
    regime = np.where(np.isnan(out[5]), -1, out[5]).astype(np.int8)[: times.size]
    kept = switches[: min(int(turns), _SWITCHES_KEPT)]
    changes = tuple(Switch(float(when), REGIMES[int(what)]) for when, what in kept)
    inputs = (V0, omega0, end, rtol, rest, max_steps)
    return Motion(
        scene, times, **rows, regime=regime, switches=changes, onset_time=onset_time, rest_time=rest_time,
        status=MotionStatus(int(status)), steps=int(steps), _inputs=inputs,
    )  # fmt: skip


def rolled(
    scene: Scene, V0: float, omega0: float, times: NDArray, limits: tuple, notes: tuple
) -> tuple[NDArray, list[float]]:
    """Outputs of one motion, and its status, steps, switches, onset time, rest time: by the kernel for many motions.

    ``limits`` and ``notes`` are those of ``kernels.motion.records``, which the switches and the ends of steps are put
    into.  The kernel counts time in the material's own unit.
    """
    rtol, rest, max_steps = limits
    from ..kernels.motion.loop import INFO, motion_loop
    from ..kernels.motion.output import OUTPUTS

    material, unit = scene.in_own_time()
    gamma = scene.gamma * unit * unit
    one = np.array((scene.kappa, scene.mu, gamma, scene.j, V0 * unit, omega0 * unit)).reshape(-1, 1)
    one.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    out, info = np.empty((OUTPUTS, 1, times.size)), np.empty((1, len(INFO)))
    given, own = (record(material), *one), (rtol, rest * unit, max_steps)
    motion_loop(given, times / unit, own, np.arange(OUTPUTS), out, info, notes, 0, 1)
    out, info = out[:, 0], info[0]
    if unit != 1.0:
        switches, ends = notes
        out[:2] /= unit
        info[3:] *= unit
        switches[: int(info[2]), 0] *= unit
        ends *= unit
    return out, info.tolist()
