"""The law at many states, by rows of one table, of an alpha each or of a material each, for :mod:`rolling_contact`."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.blocks import elements, run_blocks
from ..core.checks import extent
from ..core.errors import ParameterError
from ..materials.bodies import Bodies
from ..materials.law_each import law_of_alphas, law_of_materials, order_of_alphas
from ..materials.law_modes import by_modes
from ..materials.law_table import LawTable
from ..materials.prony import Prony
from .contact_fields import UNSTEADY

#: states of a block, where each has a material of its own, which takes some kilobytes, and where not
_BLOCK, _BLOCK_EACH = 1 << 15, 1 << 8
#: states of one law that a kernel works on side by side; up to so many take no blocks
_TOGETHER = 64
_NO_ORDER = np.empty(0, np.int64)
#: kappa |V|, where zeta is 0 in doubles, or nearly
FASTEST = 1e300


def states_of(
    given: LawTable | Prony | Bodies | None,
    arrays: list[Any],
    shape: tuple[int, ...],
    creep_is_omega: bool,
    names: tuple[str, ...],
) -> NDArray:
    """The fields ``names``, a row each, of the alphas, kappa, mu, V and the creep broadcast to ``shape``.

    ``given``: one law for all; many materials, with their numbers in place of the alphas; or, None, alphas.
    """
    count = math.prod(shape)
    out = np.empty((len(names), count))
    if count <= _TOGETHER and isinstance(given, LawTable):
        states = np.empty((len(arrays), *(shape or (1,))))
        for row, array in zip(states, arrays, strict=True):
            row[...] = array
        states = states.reshape(len(arrays), count)
        states.flags.writeable = False  # as all that a kernel reads, see elements
        _fill(given, given.record, tuple(states), _NO_ORDER, creep_is_omega, names, out, 0, count)
        return out
    parts = [elements(np.asarray(array), shape) for array in arrays]

    def work(start: int, stop: int) -> None:
        each, *others = [part(start, stop) for part in parts]
        order = _NO_ORDER
        if isinstance(given, LawTable):
            law: Any = given.record
        elif given is None:
            law, order = law_of_alphas(each), order_of_alphas(each, others[0], others[2])
        else:
            law = law_of_materials(given, each.astype(np.int64))
            order = np.argsort(each, kind="stable") if each.size > 1 else order
        _fill(given, law, (each, *others), order, creep_is_omega, names, out, start, stop)

    run_blocks(work, count, _BLOCK_EACH if isinstance(given, Prony | Bodies) else _BLOCK)
    return out


def _fill(
    given: LawTable | Prony | Bodies | None, law: Any, parts: tuple[NDArray, ...], order: NDArray, creep_is_omega: bool,
    names: tuple[str, ...], out: NDArray, start: int, stop: int,
) -> None:  # fmt: skip
    """The fields of some states."""
    loop, of, to = _asked(names)
    each, kappa, mu, V, creep = parts
    asked = of.Asked(of.States(kappa, mu, V, creep, creep_is_omega), order, to, out, start)
    room = np.empty((3, _TOGETHER if isinstance(given, LawTable) else 1))
    if set(names) - {UNSTEADY}:
        loop(law, asked, room, stop - start)
    if UNSTEADY in names:
        N = out[names.index(UNSTEADY), start:stop]
        if isinstance(given, LawTable):
            from ..kernels.rows.added import unsteady_loop

            unsteady_loop(given.unsteady_record, kappa, V, N)
        else:
            loop(law, asked._replace(to=_asked(("zeta",))[-1], out=N[None], first=0), room, stop - start)
            N[:] = by_modes(each, N).N


@lru_cache(maxsize=64)
def _asked(names: tuple[str, ...]) -> tuple[Any, Any, Any]:
    """(The kernel, what it takes, the row of each field)."""
    from ..kernels.rows import states
    from ..kernels.rows.contact import contact_loop

    return contact_loop, states, states.Fields(**{name: row for row, name in enumerate(names) if name != UNSTEADY})


def refuse_overflow(kappa: NDArray, V: NDArray, fastest: float = FASTEST) -> None:
    """Raise ParameterError where kappa |V| leaves the range of doubles, or nearly (zeta would be 0), or that given."""
    if not (kappa.size and V.size):
        return
    low, high = extent(V)
    if extent(kappa)[1] * max(-low, high) <= fastest:
        return
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > fastest:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {fastest:g}")
