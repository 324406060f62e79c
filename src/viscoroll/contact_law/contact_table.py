"""The law at many states, in blocks on threads: one law for all states, or an alpha or a material for each.

All is dimensionless, with load P, radius R, unit of time T_ref, and l0, the contact length at rest of half-spaces:
alpha is the instantaneous divided by the long-time modulus, kappa = R/l0, mu the coefficient of friction, V the speed
over R/T_ref, omega the angular velocity times T_ref, delta = (omega - V)/V the creepage.  Of the fields lam is the
contact length over l0, epsilon its shift ahead of the axis over half the length, zeta half the transit time, Q the
friction force over P, M the rolling moment over P R, and N its factor of dV/dt, M = M(V) + N dV/dt.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats
from ..core.blocks import block_reader, run_blocks
from ..core.checks import broadcast_shape, extent
from ..core.errors import ConvergenceError, OutOfTableError, ParameterError
from ..materials.bodies import Bodies
from ..materials.law.evaluate import evaluate_by_modes
from ..materials.law.per_element import record_of_materials, records_of_alphas, sort_by_octave
from ..materials.law.table import LawTable
from ..materials.prony import Prony
from .contact_fields import UNSTEADY, complete, computed_fields, kernel_rows
from .parameters import Parameters

#: States of a block: some milliseconds of work.
_BLOCK = 1 << 15
#: States of a block in which each has a material of its own, which takes some kilobytes.
_BLOCK_OF_MATERIALS = 1 << 8
#: States of an alpha each that are evaluated together, in records of their own: one after the other, each would wait
#: for its own numbers, which took half as long again; more than four gain nothing.
_ALPHAS_TOGETHER = 4
#: Order of states as they are.
_NO_ORDER = np.empty(0, np.int64)
#: Largest kappa |V|: beyond it zeta underflows.
FASTEST = 1e300
#: Largest kappa |V| for Q by the printed Eq. (15), in which the rounding error of a bracket grows with kappa |V|:
#: beyond it Q has lost four digits of mu and more.
_FASTEST_DIRECT = 1e12


def evaluate_contact(
    scene: Parameters, V: NDArray, creep: NDArray, creep_is_omega: bool, names: tuple[str, ...], method: str = "table"
) -> dict[str, Any]:
    """Return dimensionless fields of the contact by name, at speeds and creepages that were checked to be finite.

    Parameters
    ----------
    scene : dimensionless parameters of the roller, numbers or arrays; its material, alpha, kappa and mu are read.
    V : velocities of the axis divided by R/T_ref, any sign, an array of any shape, () for a number.
    creep : angular velocities times T_ref if ``creep_is_omega``, else creepages (omega - V)/V; any shape.
    creep_is_omega : whether ``creep`` is omega.
    names : fields, as of :func:`.contact_fields.field_names`.
    method : "table", from the rows of the law, or "direct", by root solves of the printed equations.

    Returns
    -------
    dict of str to array
        Name -> field, dimensionless, in the order of ``names`` (one that occurs twice is there once), in the shape to
        which V, creep and alpha, kappa and mu of the scene broadcast; floats (``full_slip``: a bool) if all of these
        are numbers.  At V = 0 zeta is infinite, and delta is infinite where omega is not 0.

    Raises
    ------
    ParameterError
        kappa |V| above :data:`FASTEST` (for Q by method "direct" above :data:`_FASTEST_DIRECT`), shapes that do not
        broadcast, a material with method "direct", N of an array of materials, times of a material beyond 1e-100 to
        1e100 T_ref, a layer too thin for its law; ``$VISCOROLL_THREADS`` that is no whole number >= 1.
    ConvergenceError
        If an iteration of method "direct" reaches its limit.
    """
    arrays: dict[str, Any] = {"alpha": scene.alpha, "kappa": scene.kappa, "mu": scene.mu, "V": V}
    arrays["omega" if creep_is_omega else "delta"] = creep
    direct = method == "direct"
    fastest = _FASTEST_DIRECT if direct and "Q" in names else FASTEST
    shape: tuple[int, ...] = ()
    if V.ndim or creep.ndim or scene.shape:
        arrays = {name: np.asarray(value) for name, value in arrays.items()}
        shape = broadcast_shape(**arrays)
        refuse_overflow(arrays["kappa"], V, fastest)
    elif not abs(scene.kappa * float(V)) <= fastest:
        refuse_overflow(np.asarray(scene.kappa), V, fastest)
    if scene.material is not None and direct:
        raise ParameterError("method", "'direct'", "'table': the equations of the paper have one relaxation time")
    material = None if direct else scene.rolling_law or scene.material_array
    if isinstance(material, Prony | Bodies):
        if UNSTEADY in names:
            allowed = "left out for many materials in one call: compute it for one of them, material[i]"
            raise ParameterError("fields", repr(UNSTEADY), allowed)
        arrays["alpha"] = np.arange(len(material), dtype=np.float64)
    if isinstance(material, LawTable) and material.coupled is not None:
        refuse_beyond(material, scene.kappa * np.abs(V))
        unknown = sorted({"lam", "length", "zeta", "epsilon", "beta"}.intersection(names))
        if unknown and not material.coupled.graded:
            raise ParameterError("fields", unknown[0], "left out: a grid states Q and M alone")
    unlike = material.unlike if isinstance(material, LawTable) else isinstance(material, Bodies)
    computed = computed_fields(names, unlike)
    rows = evaluate_law(material, [*arrays.values()], shape, creep_is_omega, computed, direct)
    return complete(names, computed, rows, shape)


def evaluate_law(
    material: LawTable | Prony | Bodies | None,
    arrays: list[Any],
    shape: tuple[int, ...],
    creep_is_omega: bool,
    names: tuple[str, ...],
    direct: bool = False,
) -> Floats:
    """Evaluate fields of the contact, a row each, at states of one or many laws, on threads.

    Parameters
    ----------
    material : a :class:`LawTable`, the law of all states; or an array of materials, of which each state names one by
        its index; or None: each state has a law of one relaxation time, by its alpha.
    arrays : five numbers or arrays that broadcast to ``shape``, dimensionless: alpha (index of the material, where
        there are many, as a float; not used with a LawTable), kappa, mu, V, and delta or omega.
    shape : shape of the states; () for one state.
    creep_is_omega : whether the last of ``arrays`` is omega, else delta.
    names : fields that kernels compute, as of :func:`.contact_fields.computed_fields`, each once; N not with an array
        of materials or ``direct``.
    direct : whether to solve the printed equations; ``material`` is None then.

    Returns
    -------
    array, (fields, states)
        A row for each of ``names``, dimensionless; the states are those of ``shape``, flattened, of which there may be
        none.  ``full_slip`` is 0 or 1; N of a cover, which is not known, is NaN.

    Raises
    ------
    ParameterError
        Of an array of materials as :func:`.record_of_materials`; ``$VISCOROLL_THREADS`` that is no whole number >= 1.
    ConvergenceError
        If an iteration of the printed equations reaches its limit.
    """
    count = math.prod(shape)
    loop, states = _kernel(direct)
    rows = kernel_rows(names)
    out = np.empty((len(names), count))
    record: Any = material.record if isinstance(material, LawTable) else None
    coupled = record is not None and record.table is not None

    def evaluate_block(start: int, stop: int, alpha: Floats, *parts: Floats) -> None:
        """Evaluate the states ``start`` to ``stop`` - 1 and write them into these columns of ``out``.

        The row of N is written by a kernel of its own, without a LawTable by the formulas of the modes.
        alpha: alphas, or indices of materials, of these states, (stop - start,) or (1,); not used with a LawTable.
        parts: kappa, mu, V and creep of these states, (stop - start,) or (1,) each, dimensionless, read-only.
        Raises ConvergenceError if an iteration of the printed equations reaches its limit, and ParameterError as
        :func:`_laws_of_block`.
        """
        laws, order = ((record,), _NO_ORDER) if record else _laws_of_block(material, alpha, parts, direct)
        request = states.Request(states.State(*parts, creep_is_omega), order, rows, out, start)
        scratch = np.empty(states.SCRATCH_SIZE)
        if coupled:
            from ..kernels.splines.law import table_loop

            table_loop(record.table, request, stop - start)
        elif direct:
            if loop(laws, request, stop - start):
                raise ConvergenceError(
                    f"contact: method='direct' did not converge for a state of elements {start} to {stop - 1}"
                )
        elif names != (UNSTEADY,):
            loop(laws, request, scratch, stop - start)
        if UNSTEADY not in names:
            return
        N = out[names.index(UNSTEADY), start:stop]
        if isinstance(material, LawTable):
            from ..kernels.rows.added_mass import unsteady_loop

            unsteady_loop(material.unsteady_record, parts[0], parts[2], N)
        else:
            zeta = np.empty((1, stop - start))
            loop(laws, request._replace(to=kernel_rows(("zeta",)), out=zeta, first=0), scratch, stop - start)
            N[:] = evaluate_by_modes(alpha, zeta[0]).N

    if count <= states.TOGETHER and record:
        numbers = np.empty((len(arrays), *(shape or (1,))))
        for row, array in zip(numbers, arrays, strict=True):
            row[...] = array
        numbers = numbers.reshape(len(arrays), count)
        numbers.flags.writeable = False  # as all arrays that kernels read (block_reader)
        evaluate_block(0, count, *numbers)
        return out
    readers = [block_reader(np.asarray(array), shape) for array in arrays]
    block = _BLOCK_OF_MATERIALS if isinstance(material, Prony | Bodies) else _BLOCK
    run_blocks(lambda start, stop: evaluate_block(start, stop, *(read(start, stop) for read in readers)), count, block)
    return out


@lru_cache(maxsize=2)
def _kernel(direct: bool) -> tuple[Any, Any]:
    """Return the kernel that evaluates the law at many states.

    direct: whether it solves the printed equations; else it reads the rows of the law.
    Returns (the loop over states; the module :mod:`...kernels.rows.contact_states` with the types of its arguments).
    The loop of the printed equations is called as (alpha, request, count) and returns a status, 0 if all states were
    solved; that of the rows as (laws, request, scratch, count), and returns nothing.  The first call of a loop compiles
    it, unless this machine has done so before.
    """
    from ..kernels.rows import contact_states as states

    if direct:
        from ..kernels.printed.loop import direct_loop as loop
    else:
        from ..kernels.rows.contact import contact_loop as loop
    return loop, states


def _laws_of_block(material: Any, alpha: Floats, parts: tuple[Floats, ...], direct: bool) -> tuple[Any, NDArray]:
    """Make the laws of the states of a block, and choose the order in which the states are evaluated.

    Called where the states have no law in common, which would be evaluated in the order given.
    material: many materials, or None: a law of one relaxation time for each state.
    alpha: alphas of the states, or indices of their materials as floats, (n,) or (1,).
    parts: kappa, mu, V, creep, each (n,) or (1,), dimensionless.
    direct: whether the printed equations are solved, which need alpha alone.
    Returns (laws, order).  The laws are a tuple of records that kernels take: one for materials, and
    :data:`_ALPHAS_TOGETHER` for alphas; each holds the law of one state at a time.  If ``direct`` they are ``alpha``
    itself.  The order is an array of the indices of the states in the order of evaluation, (n,), or empty for the order
    given.  States are ordered by material, or of alphas by octaves of alpha and speed, so that neighbours read the same
    numbers; if ``direct``, of one state, and of one material for all, the order is empty.
    Raises ParameterError for a material with times beyond 1e-100 to 1e100 T_ref, and for a layer that is too thin.
    """
    if material is not None:
        order = np.argsort(alpha, kind="stable") if alpha.size > 1 else _NO_ORDER
        return (record_of_materials(material, alpha.astype(np.int64)),), order
    if direct:
        return alpha, _NO_ORDER
    return records_of_alphas(alpha, _ALPHAS_TOGETHER), sort_by_octave(alpha, parts[0], parts[2])


def pure_rolling_fields(law: LawTable, u: Floats, *names: str) -> Floats:
    """Return fields of the contact without traction, for kappa = mu = 1 and the speed V = u.

    These are functions of u = kappa |V| alone, so that they serve every kappa: ``lam`` and ``epsilon`` as they are,
    ``M`` as kappa M, ``dM_dV`` and ``N`` as they are.
    law: table of the material.
    u: kappa |V|, >= 0, at most 1e300, not checked, (n,).
    names: fields that kernels compute, as "lam", "epsilon", "M", "dM_dV", "N"
        (:func:`.contact_fields.computed_fields`); all are those of kappa = mu = 1.
    Returns a new array (names, n), dimensionless, rows in the order of ``names``; N of a cover is NaN.
    """
    if law.cover is None:
        return evaluate_law(law, [1.0, 1.0, 1.0, u, 0.0], u.shape, False, names)
    free = evaluate_law(law, [1.0, 1.0, 1.0, u, 0.0], u.shape, False, ("delta_0",))[0]
    state = [1.0, 1.0, 1.0, u, free]
    found = evaluate_law(law, state, u.shape, False, names)
    if "dM_dV" in names:  # along free rolling, whose creepage changes with the speed
        of_M, of_V, of_Q = evaluate_law(law, state, u.shape, False, ("dM_ddelta", "dQ_dV", "dQ_ddelta"))
        found[names.index("dM_dV")] -= of_M * of_V / of_Q
    return found


def refuse_beyond(law: LawTable, u: Any) -> None:
    """Raise OutOfTableError where kappa |V| = ``u`` exceeds the last speed of a table ``law``, as of a grid."""
    most = law.coupled.fastest if law.coupled is not None else np.inf
    largest = float(np.max(u, initial=0.0))
    if largest > most * (1.0 + 1e-12):
        raise OutOfTableError("kappa |V|", largest, 0.0, most)


def refuse_overflow(kappa: NDArray, V: NDArray, fastest: float = FASTEST) -> None:
    """Raise ParameterError where kappa |V| exceeds its largest allowed value; else do nothing, as without elements.

    kappa: slenderness R/l0, > 0, any shape.
    V: velocities divided by R/T_ref, any sign, finite; broadcasts with kappa.  V may be in another unit, as m/s, if
        kappa is divided by the size of one unit of the scene, R/T_ref, in it.
    fastest: largest allowed kappa |V|.
    The error states the largest kappa |V|.
    """
    if not (kappa.size and V.size):
        return
    low, high = extent(V)
    if float(extent(kappa)[1]) * float(max(-low, high)) <= fastest:
        return
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > fastest:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {fastest:g}")
