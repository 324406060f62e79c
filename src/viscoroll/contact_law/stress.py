"""Pressure and shear along the contact: :func:`stress`."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, overload

import numpy as np

from ..core.array_types import Floats, Numbers
from ..core.blocks import block_reader, run_blocks
from ..core.checks import broadcast_shape, check_array
from ..core.errors import exactly_one_error
from ..core.labels import strip_labels
from ..core.results import Values
from ..materials.bodies import total_series
from ..materials.law.cover_pressure import pressure
from ..materials.law.cover_solve import modes_of_cover
from ..materials.law.evaluate import series_record
from .contact import evaluate_contact
from .parameters import Parameters, Rolls, framed

_BLOCK = 1 << 15


@overload
def stress(roller: Rolls, x: Numbers, V: Numbers, *, delta: Numbers) -> Values: ...
@overload
def stress(roller: Rolls, x: Numbers, V: Numbers, *, omega: Numbers) -> Values: ...
def stress(
    roller: Rolls, x: Numbers, V: Numbers, *, delta: Numbers | None = None, omega: Numbers | None = None
) -> Values:
    """Pressure and shear stress along the contact, Eqs. (11)-(14).

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha, kappa and mu are used; or a :class:`Cylinder`, in SI units.
    x : position over l0, of a Cylinder in m, from the foot of the axis, positive along the axis of V; any
        value, the stresses are 0 outside the contact.
    V, delta, omega : as for :func:`contact`; all arguments broadcast.

    Returns
    -------
    Values
        ``p``: p/E' >= 0.  ``tau``: shear stress on the cylinder over E', of the sign of
        omega - V, |tau| <= mu p.  Of a Cylinder in Pa.  Of a cover ``p`` alone: its shear stress is not known.

    Raises
    ------
    ParameterError, ConvergenceError
        As for :func:`contact`.

    Notes
    -----
    Relative to the peak the error is below 1e-11 for alpha zeta from 1e-8 to 1e8
    (``tests/test_stress.py``).  Where V or the creep are arrays, the state of the contact is
    held beside the result: 56 bytes an element of theirs.
    """
    from ..kernels.rows.stress import Points

    _, scene, scale = framed(roller, "stress")
    if (delta is None) == (omega is None):
        raise exactly_one_error("delta", "omega", both=delta is not None)
    creep_name = "omega" if delta is None else "delta"
    places, labels = strip_labels({"x": x, "V": V, creep_name: omega if delta is None else delta}, scale)
    at, speed, creep = (check_array(*given) for given in places.items())
    places = dict(zip(places, (at, speed, creep), strict=True))
    if scale.si:
        roller.look(speed)
        with np.errstate(over="ignore"):  # a place so far away has no stress, such a speed is refused
            at, speed, creep = at / scale["length"], speed / scale["V"], creep / scale[creep_name]
    state = evaluate_contact(scene, speed, creep, delta is None, ("lam", "epsilon", "beta", "zeta", "delta"))
    # for V < 0 everything is mirrored, tau once more
    mirror = np.where(speed < 0.0, -1.0, 1.0)
    many = scene.each
    given = {"x": at, "kappa": scene.kappa, "mu": scene.mu}
    given |= {name: state[name] for name in ("lam", "epsilon", "beta", "zeta")}
    given |= {"alpha": scene.alpha if many is None else np.arange(len(many), dtype=np.float64)}
    given |= {"mirror": mirror, "sign": np.sign(state["delta"]) * mirror}
    arrays = {name: np.asarray(value, dtype=np.float64) for name, value in given.items()}
    shape = broadcast_shape(**arrays)
    x_of, *others, alpha_of, mirror_of, sign_of = (block_reader(array, shape) for array in arrays.values())
    count = int(np.prod(shape))
    p, tau = np.empty(count), np.empty(count)

    def work(start: int, stop: int) -> None:
        mirrored = mirror_of(start, stop) * x_of(start, stop)
        mirrored.flags.writeable = False  # as all that a kernel reads, see block_reader
        points = Points(mirrored, *(part(start, stop) for part in others))
        _fill(scene, alpha_of(start, stop), points, p[start:stop], tau[start:stop])
        tau[start:stop] = sign_of(start, stop) * tau[start:stop] + 0.0

    run_blocks(work, count, _BLOCK)
    rows = {"p": p} if scene.cover is not None else {"p": p, "tau": tau}
    found = {name: scale.of(name, row.reshape(shape) if shape else row.item()) for name, row in rows.items()}
    return Values(found, places, si=scale.si, title="Stresses", labels=labels)


def _fill(scene: Parameters, numbers: Floats, points: Any, p: Floats, tau: Floats) -> None:
    """The stresses at points; ``numbers``: alphas, or of the materials, which lie together where they share one."""
    from ..kernels.rows.stress import new_memory_weights, stress_loop

    ends: Any = [] if scene.each is None else 1 + np.flatnonzero(np.diff(numbers))
    for first, last in pairwise([0, *ends, p.size]):
        some = points._make(part[first:last] if part.size > 1 else part for part in points)
        if scene.cover is not None:
            p[first:last] = _cover_pressure(scene, int(numbers[min(first, numbers.size - 1)]), some)
            continue
        given: Any = numbers if scene.series is None else scene.series
        if scene.each is not None:
            given = total_series(scene.each[int(numbers[min(first, numbers.size - 1)])])
        series, alpha = series_record(given)
        weights = new_memory_weights(series), new_memory_weights(series)
        stress_loop(series, alpha, *weights, some, p[first:last], tau[first:last])


def _cover_pressure(scene: Parameters, index: int, points: Any) -> Floats:
    """Return p/E' at points on a cover, by one solve for each state of the contact.

    scene: with the cover.  index: which of its covers, if there are many.  points: as the kernels take them.
    """
    cover: Any = scene.cover if scene.each is None else scene.each[index]
    x, *state = np.broadcast_arrays(points.x, points.kappa, points.lam, points.epsilon, points.zeta)
    states_of_contact, which = np.unique(np.array(state), axis=1, return_inverse=True)
    found = np.empty(x.size)
    for n, (kappa, lam, epsilon, zeta) in enumerate(states_of_contact.T.tolist()):
        place = which.ravel() == n
        y = 2.0 * x[place] / lam - epsilon
        found[place] = pressure(modes_of_cover(cover), zeta, 0.5 * lam / cover.thickness, y) / (
            8.0 * np.pi * kappa * lam
        )
    return found
