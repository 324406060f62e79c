"""The law at many states, by rows of one table, of an alpha each or of a material each, for :mod:`rolling_contact`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .blocks import elements, run_blocks
from .contact_fields import SLOPES, SLOPES_OF_BODIES, UNSTEADY
from .materials.law_each import law_of_alphas, law_of_materials, order_of_alphas
from .materials.law_modes import unsteadiness
from .materials.law_table import LawTable
from .materials.prony_array import MaterialArray

#: states of a block, where each has a material of its own, which takes some kilobytes, and where not
_BLOCK, _BLOCK_EACH = 1 << 15, 1 << 8
#: states of one law that a kernel works on side by side
_TOGETHER = 64


def states_of(
    given: LawTable | MaterialArray | None,
    arrays: list[NDArray],
    shape: tuple[int, ...],
    creep_is_omega: bool,
    names: tuple[str, ...],
) -> NDArray:
    """The fields ``names``, a row each, of the alphas, kappa, mu, V and the creep broadcast to ``shape``.

    ``given``: one law for all; many materials, with their numbers in place of the alphas; or, None, alphas.
    """
    from .kernels.law.states import ROWS, States
    from .kernels.rows.contact import Asked, slopes_loop, table_loop, unsteady_loop

    count, slopes = int(np.prod(shape)), set(names) & set(SLOPES + SLOPES_OF_BODIES)
    values = set(names) - slopes - {UNSTEADY}
    to, out = np.full(len(ROWS), -1), np.empty((len(names), count))
    for row, name in enumerate(names):
        if name != UNSTEADY:
            to[ROWS.index(name)] = row
    own, *parts = (elements(array, shape) for array in arrays)

    def work(start: int, stop: int) -> None:
        kappa, mu, V, creep = (part(start, stop) for part in parts)
        each, order = own(start, stop), np.empty(0, np.int64)
        if isinstance(given, LawTable):
            law: Any = given.record
        elif given is None:
            law, order = law_of_alphas(each), order_of_alphas(each, kappa, V)
        else:
            law = law_of_materials(given, each.astype(np.int64))
            order = np.argsort(each, kind="stable") if each.size > 1 else order
        asked = Asked(States(kappa, mu, V, creep, creep_is_omega), order, to, out, start)
        room = np.empty((2, _TOGETHER if isinstance(given, LawTable) else 1))
        if values:
            table_loop(law, asked, room, stop - start)
        if slopes:
            slopes_loop(law, asked, stop - start)
        if UNSTEADY in names:
            N = names.index(UNSTEADY)
            if isinstance(given, LawTable):
                unsteady_loop(law, given.unsteady_rows, asked.states, out[N], start, stop)
            else:
                to_N = np.where(np.arange(len(ROWS)) == ROWS.index("zeta"), N, -1)
                table_loop(law, asked._replace(to=to_N), room, stop - start)
                out[N, start:stop] = unsteadiness(each, out[N, start:stop])

    run_blocks(work, count, _BLOCK_EACH if isinstance(given, MaterialArray) else _BLOCK)
    return out
