"""Motions that may be rolled, and the kernel that rolls them: one and many."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.contact import contact
from ..contact_law.parameters import Parameters, Rolls, framed, refuse_cover
from ..contact_law.steadiness import CAUGHT
from ..core.array_types import Floats, Integers
from ..core.blocks import broadcast_vector, run_blocks
from ..core.checks import check_array, check_bool
from ..core.drive import make_dimensionless
from ..core.errors import MotionStatus, ParameterError
from ..core.scale import HasUnits
from ..materials.law.table import law_table
from .checks import controls, in_words, refuse_end, refuse_many
from .driven import LOSSES, ROWS, STATES, Drive, Prepared, prepared, refuse_rest, undriven

_ALL = np.arange(len(ROWS))
#: of a map's motions: as tight as the integrator goes, where with alpha of 1e10 it takes tens of thousands of steps
_RTOL, _MOST_STEPS = 1e-12, 100_000
_BLOCK = 40
#: status, steps, switches, onset and rest time
_INFO = 5
#: no room for switches and ends of steps
NO_NOTES = np.empty((0, 2)), np.empty(0)


class Asked(NamedTuple):
    """How motions are to be rolled: ``rtol``, ``rest``, ``max_steps`` and ``resolve`` of :func:`viscoroll.roll`."""

    rtol: float
    rest: float | None
    max_steps: int
    resolve: float | None = None


class Begun(NamedTuple):
    """Motions that may be rolled, without dimension but for what rolls and its drive.

    roller, scene : on the slope.  caught : those that a rest keeps.  end : the last time.
    limits : rtol, the threshold of rest and max_steps.
    """

    roller: Rolls
    scene: Parameters
    drive: Drive
    ready: Prepared
    caught: Any
    end: float
    limits: tuple[float, float, int]
    unsteady: bool


def begin(
    roller: Rolls, starts: tuple[Any, Any], given: Drive, end: float, asked: Asked,
    *, unsteady: bool, rested: bool | float, one: bool = False,
) -> Begun:  # fmt: skip
    """All that is refused of motions up to a time before any is rolled, or of ``one``.

    Raises ParameterError.
    """
    acts = given.acts
    if one:
        refuse_many(V0=starts[0], omega0=starts[1], **(given.numbers if acts else {}))
    drive, (rtol, rest, max_steps, resolve) = given.acting if acts else given, asked
    roller, scene, scale = framed(roller, "roll" if one else "ensemble", moves=True, slope=drive.slope)
    if one and scene.shape:
        refuse_many(material=roller.material, **roller.numbers)
    if rest is not None and np.ndim(scale["V"]):
        raise ParameterError("rest", rest, "None", "rest needs the same R and T_ref for all motions")
    unsteady = unsteady is not False and check_bool("unsteady", unsteady)
    if unsteady:
        refuse_cover(scene, "N is not known: leave unsteady=True out")
    if unsteady and not scene.like_bodies:
        sentence = "unsteady = True: the bodies differ, and what either has of the added mass is not known then"
        raise ParameterError("unsteady", True, "False where bodies differ", sentence)
    try:
        limits, last = controls(rtol, make_dimensionless("rest", rest, scale), max_steps), float(end) / scale["t"]
        if last == math.inf:
            refuse_end(float(end), scale["t"])
        own = make_dimensionless("V0", starts[0], scale), make_dimensionless("omega0", starts[1], scale)
        spacing = None if resolve is None else make_dimensionless("resolve", resolve, scale)
        ready = prepared(drive.over(scale), *own, last, rtol, spacing)
        if ready.courses is not None:  # a step ends at every corner
            limits = (*limits[:2], limits[2] + ready.courses.corners)
        refuse_rest(limits[1], ready)
        ready, caught = _climbed(ready, scene, _time_of_rest(rested, scale) / scale["t"])
    except ParameterError as error:
        raise in_words(error, scale) from error
    if one and ready.courses is not None and (many := ready.motions) > 1:
        raise ParameterError("drive", f"of {many} motions", "one motion's; for many use ensemble")
    return Begun(roller, scene, drive, ready, caught, last, limits, bool(unsteady))


def _time_of_rest(rested: Any, units: HasUnits) -> float:
    """The time of the rest, infinite for a long one.

    Raises
    ------
    ParameterError
        What is not one number >= 0.
    """
    if isinstance(rested, bool | np.bool_):
        return math.inf if rested else 0.0
    time = check_array("rested", rested, unit=units, low=0.0)
    if time.ndim:
        raise ParameterError("rested", rested, "one time >= 0, or True")
    return float(time)


def _climbed(ready: Prepared, scene: Parameters, rested: float) -> tuple[Prepared, Any]:
    """(What is rolled once the cylinder has left the imprint of a rest, whether it was caught there).

    Raises
    ------
    ParameterError
        A prescribed speed, or a start in full slip, of which the cost is not known.
    """
    if rested == 0.0:
        return ready, False
    refuse_cover(scene, "what leaving the imprint of a rest costs is not known: leave rested out")
    V = np.asarray(ready.V0, np.float64)
    limit = np.abs(V) * contact(scene, V, delta=0.0, fields="delta_star").delta_star
    if ready.prescribed or np.any(np.abs(ready.omega0 - V) > limit):
        what = "a speed is prescribed" if ready.prescribed else "it starts in full slip"
        sentence = f"rested is given, but {what}: what leaving the imprint costs is not known then"
        raise ParameterError("rested", rested, "left out", sentence)
    lost = scene.freely(V).start(rested).speed / np.where(V == 0.0, 1.0, np.abs(V))
    return ready._replace(V0=V * (1.0 - lost), omega0=ready.omega0 * (1.0 - lost)), lost > CAUGHT


def integrate(
    count: int, batch: tuple[Any, ...], drive: tuple[NDArray, NDArray, int], times: Floats,
    limits: tuple[float, float, int], rows: Integers, notes: tuple[NDArray, ...] = NO_NOTES,
) -> tuple[Floats, Floats]:  # fmt: skip
    """(Rows of :data:`ROWS` of ``count`` motions at the times; status, steps, switches, onset and rest time of each).

    ``batch`` : law, whether bodies differ, kappa, mu, gamma, j, V0 and omega0.  ``notes`` : room for the switches and
    for the ends of steps.
    """
    from ..kernels.motion.batch import INFO_COLUMNS, motion_loop

    out, info = np.empty((rows.size, count, times.size)), np.empty((count, len(INFO_COLUMNS)))
    motion_loop(batch, drive, times, limits, rows, out, info, notes)
    return out, info


def rolled(begun: Begun, times: Floats, *notes: NDArray) -> tuple[Floats, list[float]]:
    """What :func:`integrate` finds, of one motion."""
    scene, ready = begun.scene, begun.ready
    if begun.caught:
        return np.full((_ALL.size, times.size), np.nan), [MotionStatus.CAUGHT, 0, 0, np.nan, np.nan]
    law = scene.table
    assert law is not None
    own = np.array((scene.kappa, scene.mu, scene.gamma, scene.j, ready.V0, ready.omega0), float).reshape(-1, 1)
    own.flags.writeable = False  # as in an ensemble: numba would compile for the other kind anew
    batch = law.unsteady_record if begun.unsteady else law.record, law.unlike, *own
    out, info = integrate(1, batch, ready.for_kernel(), times, begun.limits, _ALL, notes)
    return out[:, 0], info[0].tolist()


def motions(
    parameters: tuple[Any, ...], starts: tuple[Floats, Floats], gamma: Floats, t: Floats, *, threads: int | None = 1
) -> tuple[Floats, Floats]:
    """(V, omega, x, angle, delta, regime, slip_loss, rolling_loss of motions at common times; status and the like).

    What a flow map is made from and measured by; none of the kernels is compiled for it alone.

    Parameters
    ----------
    starts : V and omega.
    gamma : one a motion, which makes the common times what that counts in.
    """
    rows = np.array([ROWS.index(name) for name in STATES + LOSSES], np.int64)
    given, kappa, mu, j = parameters
    law, limits = law_table(given), (_RTOL, 0.0, _MOST_STEPS)
    arrays = [broadcast_vector(np.asarray(a, float), np.shape(a)) for a in (kappa, mu, gamma, j, *starts)]
    out, info = np.empty((rows.size, starts[0].size, t.size)), np.empty((starts[0].size, _INFO))

    def work(start: int, stop: int) -> None:
        own = (array[start:stop] if array.size > 1 else array for array in arrays)
        batch = law.record, law.unlike, *own
        out[:, start:stop], info[start:stop] = integrate(stop - start, batch, undriven(), t, limits, rows)

    run_blocks(work, starts[0].size, _BLOCK, threads=threads)
    return out, info
