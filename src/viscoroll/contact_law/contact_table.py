"""The law at many states, by rows of one table, of an alpha each or of a material each, for :mod:`rolling_contact`."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.blocks import block_reader, run_blocks
from ..core.checks import broadcast_shape, extent
from ..core.errors import ConvergenceError, ParameterError
from ..materials.bodies import Bodies
from ..materials.law_each import law_of_alphas, law_of_materials, order_of_alphas
from ..materials.law_modes import by_modes
from ..materials.law_table import LawTable
from ..materials.prony import Prony
from .contact_fields import UNSTEADY, add_derived, solved_fields
from .parameters import Parameters

#: states of a block, where each has a material of its own, which takes some kilobytes, and where not
_BLOCK, _BLOCK_EACH = 1 << 15, 1 << 8
#: states of one law that a kernel works on side by side; up to so many take no blocks
_TOGETHER = 64
_NO_ORDER = np.empty(0, np.int64)
#: Largest kappa |V|, dimensionless: beyond it zeta is 0 in doubles, or nearly.
FASTEST = 1e300
#: Largest kappa |V| for Q by the printed equations, dimensionless: the rounding of a bracket of Eq. (15) grows with
#: kappa |V|, and beyond this value Q has lost four digits of mu and more.
_FASTEST_DIRECT = 1e12


def contact_states(
    scene: Parameters, V: NDArray, creep: NDArray, creep_is_omega: bool, names: tuple[str, ...], method: str = "table"
) -> dict[str, Any]:
    """Return fields of contact states, dimensionless.

    scene: parameters, numbers or arrays.
    V: speeds, checked, an array of any shape; broadcasts with the parameters.
    creep: creepages or angular velocities, checked; broadcasts with V.
    creep_is_omega: whether ``creep`` is the angular velocity.
    names: of the fields, all known.
    method: "table" or "direct".
    Returns the fields by name, arrays in the common shape, or numbers if that is ().
    Raises ParameterError where kappa |V| is too large, and for a method or a field that the material does not have.
    """
    arrays: dict[str, Any] = {"alpha": scene.alpha, "kappa": scene.kappa, "mu": scene.mu, "V": V}
    arrays["omega" if creep_is_omega else "delta"] = creep
    fastest = _FASTEST_DIRECT if method == "direct" and "Q" in names else FASTEST
    shape: tuple[int, ...] = ()
    if V.ndim or creep.ndim or scene.shape:
        arrays = {name: np.asarray(value) for name, value in arrays.items()}
        shape = broadcast_shape(**arrays)
        refuse_overflow(arrays["kappa"], V, fastest)
    elif not abs(scene.kappa * float(V)) <= fastest:
        refuse_overflow(np.asarray(scene.kappa), V, fastest)
    if scene.material is not None and method == "direct":
        raise ParameterError("method", "'direct'", "'table': the printed equations have one relaxation time")
    law = None if method == "direct" else scene.table or scene.material_array
    if isinstance(law, Prony | Bodies):
        if UNSTEADY in names:
            raise ParameterError("fields", repr(UNSTEADY), "requested with one material, as material[i]")
        arrays["alpha"] = np.arange(len(law), dtype=np.float64)
    solved = solved_fields(names, law.unlike if isinstance(law, LawTable) else isinstance(law, Bodies))
    found = evaluate_law(law, [*arrays.values()], shape, creep_is_omega, solved, method == "direct")
    if not shape:
        return add_derived(dict(zip(solved, found[:, 0].tolist(), strict=True)), names)
    return add_derived({name: row.reshape(shape) for name, row in zip(solved, found, strict=True)}, names)


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
            law = law_of_materials(given, each.astype(np.int64))
            order = np.argsort(each, kind="stable") if each.size > 1 else order
        elif not direct:
            law, order = law_of_alphas(each), order_of_alphas(each, parts[0], parts[2])
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
            N[:] = by_modes(each, N).N

    if count <= _TOGETHER and single:
        states = np.empty((len(arrays), *(shape or (1,))))
        for row, array in zip(states, arrays, strict=True):
            row[...] = array
        states = states.reshape(len(arrays), count)
        states.flags.writeable = False  # as all that a kernel reads, see elements
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
