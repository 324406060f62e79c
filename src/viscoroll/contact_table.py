"""The law at many states of one material, from its table, as :mod:`rolling_contact` asks for it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .blocks import elements, run_blocks
from .contact_fields import SLOPES, SLOPES_OF_BODIES, UNSTEADY
from .materials.law_table import LawTable

#: states of a block, and of what a kernel works on side by side
_BLOCK, _TOGETHER = 1 << 15, 64


def states_of(
    table: LawTable, arrays: list[NDArray], shape: tuple[int, ...], creep_is_omega: bool, names: tuple[str, ...]
) -> NDArray:
    """The fields ``names``, a row each, of kappa, mu, V and the creep broadcast to ``shape``."""
    from .kernels.law.states import ROWS, States
    from .kernels.rows.contact import slopes_loop, table_loop, unsteady_loop

    count, law = int(np.prod(shape)), table.record
    to, out, parts = np.full(len(ROWS), -1), np.empty((len(names), count)), [elements(array, shape) for array in arrays]
    to[[ROWS.index(name) for name in names if name != UNSTEADY]] = [
        row for row, name in enumerate(names) if name != UNSTEADY
    ]
    slopes = set(names) & set(SLOPES + SLOPES_OF_BODIES)
    values = set(names) - slopes - {UNSTEADY}

    def work(start: int, stop: int) -> None:
        kappa, mu, V, creep = (part(start, stop) for part in parts)
        states = States(kappa, mu, V, creep, creep_is_omega)
        if values:
            table_loop(law, states, to, out, np.empty((2, _TOGETHER)), start, stop)
        if slopes:
            slopes_loop(law, states, to, out, start, stop)
        if UNSTEADY in names:
            unsteady_loop(law, table.unsteady_rows, states, out[names.index(UNSTEADY)], start, stop)

    run_blocks(work, count, _BLOCK)
    return out
