"""The law of one scene as a C function: ``int law(double V, double omega, double out[8], void *scene)``.

One function, compiled once; ``scene`` is its user data, a :data:`SCENE`.  ``out``: Q, M, its parts in half-space and
cylinder, then, where the scene asks for slopes, dQ/dV at fixed omega, dQ/domega and the slopes of the parts; NaN where
the status is not 0.  Nothing is written but ``out``: any number of threads may call.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numba import carray
from numba.core import types
from numpy.typing import NDArray

from ..compile.intrinsics import floats_at, function_address, integers_at, record_at
from ..compile.jit import kernel
from .contact import Q_slopes, signed_traction
from .contact_states import State
from .cover import COVER_FRONT_SIZE, COVER_ROW_SIZE, free_creep_value
from .evaluate import body_moments, length_and_moment, locate_row, moment_factor
from .record import PARTS_PER_ROW, ROW_SIZE, Law

#: beyond this kappa |V| the status is not 0
MAX_U = 1e300
RESULTS = 8
#: address of the function; whether slopes are asked for, whether the bodies differ; addresses of the rows and of the
#: marks of the law, how many these are, and the address of what a cover has beside them; kappa, mu; what 1 of V, omega,
#: Q and M is to the caller
SCENE = np.dtype(
    [(name, np.int64) for name in ("function", "slopes", "unlike", "rows", "marks", "count", "free")]
    + [(name, np.float64) for name in ("kappa", "mu", "V", "omega", "Q", "M")]
)


@kernel(inline=True, allocates=True)
def _law_of(scene):
    rows, marks = floats_at(scene.rows, scene.count * ROW_SIZE), integers_at(scene.marks, scene.count * PARTS_PER_ROW)
    return Law(rows, marks, rows[:0], 0, 0, 0, None)


@kernel(inline=True, allocates=True)
def _law_of_cover(scene):
    law = _law_of(scene)
    free = floats_at(scene.free, COVER_FRONT_SIZE + COVER_ROW_SIZE * (scene.count - 1))
    return Law(law.rows, law.marks, law.N_rows, 0, 0, 0, free)


@kernel(allocates=True)
def _loads(speed_of_axis, spin, to, scenes):
    scene = record_at(scenes)
    return _found(speed_of_axis, spin, to, scene, _law_of(scene))


@kernel(allocates=True)
def _loads_on_cover(speed_of_axis, spin, to, scenes):
    scene = record_at(scenes)
    return _found(speed_of_axis, spin, to, scene, _law_of_cover(scene))


@kernel(inline=True, allocates=True)
def _found(speed_of_axis, spin, to, scene, law):
    out = carray(to, RESULTS)
    V, omega = speed_of_axis / scene.V, spin / scene.omega
    u = scene.kappa * abs(V)
    if not (u <= MAX_U and abs(V) < np.inf and abs(omega) < np.inf):
        for n in range(RESULTS):
            out[n] = np.nan
        return 1
    state = State(scene.kappa, scene.mu, V, omega, True)
    here = locate_row(u, law)
    found = length_and_moment(here, u, law)
    way, free = moment_factor(here, u, found.scale, state), free_creep_value(here, u, law.cover_rows)
    out[0], out[1] = signed_traction(u, found.L, free, state, law), way * found.m
    out[2] = out[3] = 0.5 * out[1]
    out[6] = out[7] = 0.5 * found.d_um
    if scene.unlike:
        half_space, cylinder, out[6], out[7] = body_moments(here, u, law)
        out[2], out[3] = way * half_space, way * cylinder
    if scene.slopes:
        out[4], _, out[5] = Q_slopes(u, found.L, found.dL, free, state, law)
        out[4], out[5] = out[4] * scene.Q / scene.V, out[5] * scene.Q / scene.omega
        out[6], out[7] = out[6] * scene.M / scene.V, out[7] * scene.M / scene.V
    out[0] *= scene.Q
    for n in range(1, 4):
        out[n] *= scene.M
    return 0


def pack_scenes(law: Law, unlike: bool, kappa: float, mu: float, scale: Mapping[str, float]) -> NDArray[Any]:
    """Scenes without slopes and with; the law is to outlive them."""
    found = np.zeros(2, SCENE)
    found["function"], found["slopes"] = law_address(law.cover_rows is not None), [0, 1]
    found["free"] = 0 if law.cover_rows is None else law.cover_rows.ctypes.data
    found["rows"], found["marks"], found["count"] = (
        law.rows.ctypes.data,
        law.marks.ctypes.data,
        law.rows.size // ROW_SIZE,
    )
    found["unlike"], found["kappa"], found["mu"] = unlike, kappa, mu
    for name in ("V", "omega", "Q", "M"):
        found[name] = scale[name]
    return found


def law_address(of_cover: bool) -> int:
    """Address of the function, of half-spaces or of covers."""
    loads = _loads_on_cover if of_cover else _loads
    return function_address(loads, SCENE, types.int32, types.float64, types.float64, types.CPointer(types.float64))
