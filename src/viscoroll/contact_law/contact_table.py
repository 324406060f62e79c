"""The law at many states, by rows of one table, of an alpha each or of a material each, for :mod:`rolling_contact`."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.blocks import block_reader, run_blocks
from ..core.checks import extent
from ..core.errors import ConvergenceError, ParameterError
from ..materials.bodies import Bodies
from ..materials.law.evaluate import evaluate_by_modes
from ..materials.law.per_element import record_of_alphas, record_of_materials, sort_by_octave
from ..materials.law.table import LawTable
from ..materials.prony import Prony
from .contact_fields import UNSTEADY

#: states of a block, where each has a material of its own, which takes some kilobytes, and where not
_BLOCK, _BLOCK_EACH = 1 << 15, 1 << 8
#: states of one law that a kernel works on side by side; up to so many take no blocks
_TOGETHER = 64
_NO_ORDER = np.empty(0, np.int64)
#: kappa |V|, where zeta is 0 in doubles, or nearly
FASTEST = 1e300


def evaluate_law(
    given: LawTable | Prony | Bodies | None,
    arrays: list[Any],
    shape: tuple[int, ...],
    creep_is_omega: bool,
    names: tuple[str, ...],
    direct: bool = False,
) -> NDArray:
    """The fields ``names``, a row each, of the alphas, kappa, mu, V and the creep broadcast to ``shape``.

    ``given``: one law for all; many materials, with their numbers in place of the alphas; or, None, alphas.
    ``direct``: by the printed equations, of alphas.
    """
    count = math.prod(shape)
    out = np.empty((len(names), count))
    loop, of, to = _asked(names, direct)
    single = isinstance(given, LawTable)
    room = _TOGETHER if single else 1

    def fill(start: int, stop: int, each: NDArray, *parts: NDArray) -> None:
        law: Any = each
        order = _NO_ORDER
        if isinstance(given, LawTable):
            law = given.record
        elif given is not None:
            law = record_of_materials(given, each.astype(np.int64))
            order = np.argsort(each, kind="stable") if each.size > 1 else order
        elif not direct:
            law, order = record_of_alphas(each), sort_by_octave(each, parts[0], parts[2])
        asked = of.Request(of.State(*parts, creep_is_omega), order, to, out, start)
        if direct:
            if loop(law, asked, stop - start):
                raise ConvergenceError(f"contact: an iteration hit its cap near element {start} (method 'direct')")
            return
        if set(names) - {UNSTEADY}:
            loop(law, asked, np.empty((4, room)), stop - start)
        if UNSTEADY not in names:
            return
        N = out[names.index(UNSTEADY), start:stop]
        if isinstance(given, LawTable):
            from ..kernels.rows.added_mass import unsteady_loop

            unsteady_loop(given.unsteady_record, parts[0], parts[2], N)
        else:
            to_zeta = _asked(("zeta",), direct)[-1]
            loop(law, asked._replace(to=to_zeta, out=N[None], first=0), np.empty((4, room)), stop - start)
            N[:] = evaluate_by_modes(each, N).N

    if count <= _TOGETHER and single:
        states = np.empty((len(arrays), *(shape or (1,))))
        for row, array in zip(states, arrays, strict=True):
            row[...] = array
        states = states.reshape(len(arrays), count)
        states.flags.writeable = False  # as all that a kernel reads, see block_reader
        fill(0, count, *states)
        return out
    parts = [block_reader(np.asarray(array), shape) for array in arrays]
    block = _BLOCK_EACH if isinstance(given, Prony | Bodies) else _BLOCK
    run_blocks(lambda start, stop: fill(start, stop, *(part(start, stop) for part in parts)), count, block)
    return out


def pure_rolling_fields(law: LawTable, u: NDArray, *names: str) -> NDArray:
    """Fields in pure rolling at kappa |V| = u, a row each; kappa = mu = 1."""
    return evaluate_law(law, [1.0, 1.0, 1.0, u, 0.0], u.shape, False, names)


@lru_cache(maxsize=64)
def _asked(names: tuple[str, ...], direct: bool) -> tuple[Any, Any, Any]:
    """(The kernel, what it takes, the row of each field)."""
    from ..kernels.rows import contact_states

    if direct:
        from ..kernels.printed.loop import direct_loop as loop
    else:
        from ..kernels.rows.contact import contact_loop as loop
    to = contact_states.Fields(**{name: row for row, name in enumerate(names) if name != UNSTEADY})
    return loop, contact_states, to


def refuse_overflow(kappa: NDArray, V: NDArray, fastest: float = FASTEST) -> None:
    """Raise ParameterError where kappa |V| leaves the range of doubles, or nearly (zeta would be 0), or that given."""
    if not (kappa.size and V.size):
        return
    low, high = extent(V)
    if float(extent(kappa)[1]) * float(max(-low, high)) <= fastest:
        return
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > fastest:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {fastest:g}")
