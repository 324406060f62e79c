"""All fields of a table at many states."""

import numpy as np

from ..compile.jit import kernel
from .table import FIELD_COUNT, field_at, locate_creep, locate_speed, place_of


@kernel(allocates=True)
def look_up(table, u, D):
    """Return all fields of a table (:mod:`.table`) at speeds and creeps, (n, fields).

    u, D : kappa |V| and 2 kappa delta, (n,).
    """
    out = np.empty((u.size, np.int64(table[FIELD_COUNT])))
    for n in range(u.size):
        speed = locate_speed(u[n], table)
        state = place_of(D[n], u[n], speed, table)
        place = locate_creep(state.w, state.sigma, table)
        for name in range(out.shape[1]):
            out[n, name] = field_at(name, state.w, speed, place, table).value
    return out
