"""Fields of a contact state, and their computation at many states, in blocks on threads: one law
for all states, or an alpha or a material for each.

This module alone interprets names of fields.  A call resolves its names (:func:`field_names`), asks
the kernels for :func:`computed_fields`, tells them the row of each (:func:`kernel_rows`), and
completes the result (:func:`complete`).

All is dimensionless, with load P, radius R, unit of time T_ref, and l0, the contact length at rest
of half-spaces: alpha is the instantaneous divided by the long-time modulus, kappa = R/l0, mu the
coefficient of friction, V the speed over R/T_ref, omega the angular velocity times T_ref, delta =
(omega - V)/V the creepage.  The fields are

- ``lam``, contact length over l0; ``epsilon``, its shift ahead of the axis over half the length;
  ``zeta``, half the transit time; ``beta``, stick zone over contact length;
- ``delta``; ``delta_0``, the creepage at which Q = 0; ``full_slip``, whether |delta - delta_0| >=
  ``delta_star``;
- ``Q``, friction force over P; ``grip``, 1 - |Q|/mu;
- ``M``, rolling moment over P R; ``M_half_space`` and ``M_cylinder``, its parts; ``N``, its factor
  of dV/dt, M = M(V) + N dV/dt;
- ``dA_dB``, slope of the field A over B.
"""

import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    ConvergenceError,
    Floats,
    OutOfTableError,
    ParameterError,
    block_reader,
    broadcast_rows,
    broadcast_shape,
    check_choice,
    check_names,
    extent,
    run_blocks,
)
from ..laws import (
    LawTable,
    evaluate_by_modes,
    record_of_materials,
    records_of_alphas,
    sort_by_octave,
)
from ..materials import Bodies, Cover, Prony
from .parameters import Parameters

# --- The fields of a contact state ---

#: Fields of every call without ``fields=``.
FIELDS = ("lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M")
#: Parts of M in the two bodies.
OF_BODIES = ("M_half_space", "M_cylinder")
#: Slopes of ``slopes=True``.
SLOPES = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")
#: Slopes of the parts of M.
SLOPES_OF_BODIES = ("dM_half_space_dV", "dM_cylinder_dV")
#: Slopes that are 0 of half-spaces, whose M depends on the speed alone; of a cover with
#: ``slopes=True``.
SLOPES_OF_COVERS = ("dM_ddelta", "dM_domega", "dM_half_space_domega", "dM_cylinder_domega")
_ALL_SLOPES = SLOPES + SLOPES_OF_BODIES + SLOPES_OF_COVERS
#: Added mass of slow speed changes.
UNSTEADY = "N"
#: Creepages at which full slip begins: default fields of method "coupled".
ONSETS = ("delta_minus", "delta_plus")
#: Fields that the law of a grid of another program does not have.
NOT_IN_GRIDS = ("beta", "epsilon", "lam", "length", "zeta", "full_slip", "delta_star", *ONSETS)
#: Fields that method "coupled" alone has, with the default ones first.
OF_COUPLED = ("loss_slip", "loss_half_space", "loss_cylinder", "depth")
#: Field -> the field of which it is a multiple, or from which it follows: the length is lam times
#: l0, C_rr is M/(P R).
_MULTIPLES = {"length": "lam", "C_rr": "M", "M_error": "lam"}
#: Field of like bodies -> the field of which it is half.
_HALVES = dict.fromkeys(OF_BODIES, "M") | dict.fromkeys(SLOPES_OF_BODIES, "dM_dV")
_HALVES |= dict.fromkeys(SLOPES_OF_COVERS[2:], "dM_domega")
#: All fields.
_KNOWN = (
    *(*FIELDS, *OF_BODIES, *_ALL_SLOPES),
    *(UNSTEADY, "grip", "delta_0", *_MULTIPLES, *ONSETS, *OF_COUPLED),
)


def field_names(
    fields: Iterable[str] | None, slopes: bool, method: str, scene: Parameters, si: bool
) -> tuple[str, ...]:
    """Return the names of the fields that a call of :func:`.contact_states.contact` has to return,
    in their order.

    Parameters
    ----------
    fields : a name or names of fields; None: the default fields of such a roller.  A name may occur
        twice; of no names there are no fields.
    slopes : whether the slopes are added to these fields.
    method : "table"; "direct" (the printed equations), which has no slopes, N, grip, delta_0 and
        onsets; or "coupled", which has no slopes and no N, and alone has :data:`OF_COUPLED`, of
        which all but the depth are default fields, as are the onsets.
    scene : dimensionless parameters of the roller.  The parts of M in either body of two materials
        are default fields, and ``slopes`` adds their slopes.  Where the law has a cover or a table
        of the coupled solution ``delta_0`` is a default field, and N is not available.  Of a grid
        only fields that it contains are default fields.
    si : whether the roller is a cylinder, in SI units; ``length``, ``C_rr`` and the parts of M are
        then default fields.

    Returns
    -------
    tuple of str
        Those of ``fields`` in their order, or the default fields; then with ``slopes`` those slopes
        that were not among them; then, of a cover with ``fields`` None, ``delta_0``.

    Raises
    ------
    ParameterError
        An unknown field or method; what "direct" does not have; slopes or N
        with "coupled", and its own fields without it; N of a cover.
    """
    check_choice("method", method, "table", "direct", "coupled")
    like = scene.like_bodies
    cover = scene.tabulated or isinstance(scene.material, Cover)
    if fields is not None:
        names = check_names(
            "fields", fields, _KNOWN if si else [x for x in _KNOWN if x != "M_error"], "a field"
        )
    elif si:
        names = ("lam", "length", *FIELDS[1:], "C_rr", *OF_BODIES)
    else:
        names = FIELDS + OF_BODIES * (not like)
    if slopes:
        more = SLOPES + SLOPES_OF_BODIES * (not like) + SLOPES_OF_COVERS * cover
        names += tuple(name for name in more if name not in names)
    added = ("delta_0",) * cover
    if method == "coupled":
        allowed = (
            "left out, and slopes=True too: method 'coupled' computes no slopes and no added mass N"
        )
        refuse_fields(names, (*_ALL_SLOPES, UNSTEADY), allowed)
        added = (*OF_BODIES, *ONSETS, *OF_COUPLED[:-1])
    else:
        refuse_fields(names, OF_COUPLED, "left out, or computed with method='coupled'")
        if method == "direct":
            if not set(_ALL_SLOPES).isdisjoint(names):
                allowed = (
                    "'table' if slopes=True or fields= asks for derivatives, as dQ_dV, which "
                    "method 'direct' does not compute"
                )
                raise ParameterError("method", "'direct'", allowed)
            only_table = (UNSTEADY, "grip", "delta_0", *ONSETS)
            refuse_fields(only_table, names, "left out, or computed with method='table'")
        if cover:
            allowed = "left out: the added mass N is not known for a layer of finite thickness"
            if scene.cover is None:
                allowed = (
                    "left out: the added mass N is not known where pressure and shear are solved "
                    "together, nor of a grid; a roller of half-spaces with coupled=False has N"
                )
            refuse_fields((UNSTEADY,), names, allowed)
    if fields is not None:
        return names
    names = tuple(dict.fromkeys(names + added))
    return tuple(name for name in names if name not in NOT_IN_GRIDS) if scene.gridded else names


def refuse_fields(names: Iterable[str], refused: Iterable[str], allowed: str) -> None:
    """Raise ParameterError for the first of ``names`` that is among ``refused``; ``allowed``: what
    the error says.
    """
    for name in names:
        if name in refused:
            raise ParameterError("fields", repr(name), allowed)


@lru_cache(maxsize=64)
def computed_fields(names: tuple[str, ...], unlike: bool) -> tuple[str, ...]:
    """Return the fields that the kernels compute, a row each, from which :func:`complete` makes all
    fields of a call.

    names: fields of the call, as in :func:`field_names`.
    unlike: whether the bodies are of two materials; if not, each part of M is half of M, and is not
    computed.
    Returns names without repetition, in the order of their first need: a field that is a multiple
    of another (``length`` of ``lam``, ``C_rr`` of ``M``; of like bodies M_half_space, M_cylinder of
    ``M`` and their slopes of ``dM_dV``) is replaced by that other one.
    """
    derived = _MULTIPLES if unlike else _MULTIPLES | _HALVES
    return tuple(dict.fromkeys(derived.get(name, name) for name in names))


@lru_cache(maxsize=64)
def kernel_rows(names: tuple[str, ...]) -> Any:
    """Return the index of the output row of each field as the record that kernels take.

    names: fields that kernels compute, as in :func:`computed_fields`, each once; field k has row k
    of the output.
    Returns :class:`.law_record.Fields`: an int for each field, -1 for those that
    are not in ``names``.  N is not among them, since a kernel of its own computes it; its row is
    left free.
    """
    from ..kernels.law.law_record import Fields

    return Fields(**{name: row for row, name in enumerate(names) if name != UNSTEADY})


def complete(
    names: tuple[str, ...], computed: tuple[str, ...], rows: np.ndarray, shape: tuple[int, ...]
) -> dict[str, Any]:
    """Return the fields of a call by name, from the rows that the kernels computed.

    names: fields of the call, as in :func:`field_names`.
    computed: name of the field in each row, as in :func:`computed_fields`.
    rows: values, (rows, states), dimensionless; ``full_slip`` is 0 or 1.
    shape: shape of the call, whose product is the number of states; () for one state.
    Returns a dict from each of ``names``, in their order, to an array of ``shape``, for shape () a
    float; ``full_slip`` is a boolean array, for shape () a bool.  Arrays that are a row of ``rows``
    are views of it.  ``length`` and ``C_rr`` have the values of lam and M, which the caller of a
    Cylinder multiplies by their units, as it makes ``M_error`` of lam; parts of M that
    were not computed are half of M, their slopes half of dM_dV.
    """
    values: Any = rows.reshape(len(computed), *shape) if shape else rows[:, 0].tolist()
    found = dict(zip(computed, values, strict=True))
    for name in names:
        if name in _MULTIPLES:
            found[name] = found[_MULTIPLES[name]]
        elif name not in found:
            found[name] = 0.5 * found[_HALVES[name]]
    if "full_slip" in found:
        found["full_slip"] = found["full_slip"] != 0.0
    return found if names == computed else {name: found[name] for name in names}


# --- The law at many states, in blocks on threads ---

#: States of a block: some milliseconds of work.
_BLOCK = 1 << 15
#: States of a block in which each has a material of its own, which takes some kilobytes.
_BLOCK_OF_MATERIALS = 1 << 8
#: States of an alpha each that are evaluated together, in records of their own: one after the
#: other, each would wait for its own numbers, which took half as long again; more than four gain
#: nothing.
_ALPHAS_TOGETHER = 4
#: Order of states as they are.
_NO_ORDER = np.empty(0, np.int64)
#: Name of kappa |V| in messages, where the roller may be a cylinder.
_SPEED = "|V| T_ref/l0 (of a Scene: kappa |V|)"
#: Largest kappa |V|: beyond it zeta underflows.
FASTEST = 1e300
#: Largest kappa |V| for Q by the printed Eq. (15), in which the rounding error of a bracket grows
#: with kappa |V|: beyond it Q has lost four digits of mu and more.
_FASTEST_DIRECT = 1e12


def evaluate_contact(
    scene: Parameters,
    V: Floats,
    creep: Floats,
    creep_is_omega: bool,
    names: tuple[str, ...],
    method: str = "table",
) -> dict[str, Any]:
    """Return dimensionless fields of the contact by name, at speeds and creepages that were checked
    to be finite.

    Parameters
    ----------
    scene : dimensionless parameters of the roller, numbers or arrays; its material, alpha, kappa
        and mu are read.
    V : velocities of the axis divided by R/T_ref, any sign, an array of any shape, () for a number.
    creep : angular velocities times T_ref if ``creep_is_omega``, else creepages (omega - V)/V; any
        shape.
    creep_is_omega : whether ``creep`` is omega.
    names : fields, as in :func:`field_names`.
    method : "table", from the rows of the law, or "direct", by root solves of the printed
        equations.

    Returns
    -------
    dict of str to array
        Name -> field, dimensionless, in the order of ``names`` (one that occurs twice is there
        once), in the shape to which V, creep and alpha, kappa and mu of the scene broadcast; floats
        (``full_slip``: a bool) if all of these are numbers.  At V = 0 zeta is infinite, and delta
        is infinite where omega is not 0.

    Raises
    ------
    ParameterError
        kappa |V| above :data:`FASTEST` (for Q by method "direct" above :data:`_FASTEST_DIRECT`),
        shapes that do not broadcast, a material with method "direct", N of an array of materials,
        times of a material beyond 1e-100 to 1e100 T_ref, a layer too thin for its law;
        ``$VISCOROLL_THREADS`` that is no whole number >= 1.
    ConvergenceError
        If an iteration of method "direct" reaches its limit.
    """
    arrays: dict[str, Any] = {"alpha": scene.alpha, "kappa": scene.kappa, "mu": scene.mu, "V": V}
    arrays["omega" if creep_is_omega else "delta"] = creep
    direct = method == "direct"
    fastest = _FASTEST_DIRECT if direct and "Q" in names else FASTEST
    shape: tuple[int, ...] = ()
    if V.ndim or creep.ndim or scene.shape:
        shape = broadcast_shape(**arrays)
        refuse_overflow(scene.kappa, V, fastest)
    elif not abs(scene.kappa * float(V)) <= fastest:  # true of NaN too
        refuse_overflow(scene.kappa, V, fastest)
    if (scene.material is not None or scene.gridded) and direct:
        raise ParameterError(
            "method",
            "'direct'",
            "'table' if a material or grid is given: method 'direct' needs one relaxation time, "
            "given by alpha of a Scene, or by T_epsilon and T_sigma of a Cylinder",
        )
    material = None if direct else scene.rolling_law or scene.material_array
    if isinstance(material, Prony | Bodies):
        allowed = "left out where the call has several materials: make a call for each material"
        refuse_fields(names, (UNSTEADY,), allowed)
        # the index of the material stands in the place of alpha
        arrays["alpha"] = np.arange(len(material), dtype=float)
    if isinstance(material, LawTable) and material.coupled is not None:
        refuse_beyond(material, scene.kappa * np.abs(V))
        if material.gridded:
            allowed = (
                "left out: the law of this roller is a grid, and a grid contains only Q and M (so "
                "that stresses cannot be computed from it either)"
            )
            refuse_fields(NOT_IN_GRIDS, names, allowed)
    unlike = material.unlike if isinstance(material, LawTable) else isinstance(material, Bodies)
    computed = computed_fields(names, unlike)
    rows = evaluate_law(
        material, [*arrays.values()], shape, creep_is_omega, names=computed, direct=direct
    )
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
    material : a :class:`LawTable`, the law of all states; or an array of materials, of which each
        state names one by its index; or None: each state has a law of one relaxation time, by its
        alpha.
    arrays : five numbers or arrays that broadcast to ``shape``, dimensionless: alpha (index of the
        material, where there are many, as a float; not used with a LawTable), kappa, mu, V, and
        delta or omega.
    shape : shape of the states; () for one state.
    creep_is_omega : whether the last of ``arrays`` is omega, else delta.
    names : fields that kernels compute, as in :func:`computed_fields`, each once; N
        not with an array of materials or ``direct``.
    direct : whether to solve the printed equations; ``material`` is None then.

    Returns
    -------
    array, (fields, states)
        A row for each of ``names``, dimensionless; the states are those of ``shape``, flattened, of
        which there may be none.  ``full_slip`` is 0 or 1; N of a cover, which is not known, is NaN.

    Raises
    ------
    ParameterError
        Of an array of materials as :func:`.record_of_materials`; ``$VISCOROLL_THREADS`` that is no
        whole number >= 1.
    ConvergenceError
        If an iteration of the printed equations reaches its limit.
    """
    contact_loop, states = _kernel()
    count = math.prod(shape)
    record: Any = material.record if isinstance(material, LawTable) else None
    rows = kernel_rows(names)
    out = np.empty((len(names), count))

    def evaluate_block(start: int, stop: int, alpha: Floats, *parts: Floats) -> None:
        """Evaluate the states ``start`` to ``stop`` - 1 and write them into these columns of
        ``out``.

        The row of N is written by a kernel of its own, without a LawTable by the formulas of the
        modes.
        alpha: alphas, or indices of materials, of these states, (stop - start,) or (1,); not used
        with a LawTable.
        parts: kappa, mu, V and creep of these states, (stop - start,) or (1,) each, dimensionless,
        read-only.
        Raises ConvergenceError if an iteration of the printed equations reaches its limit;
        ParameterError for a material with times beyond 1e-100 to 1e100 T_ref, and for a layer that
        is too thin.
        """
        kappa, mu, V, creep = parts
        # States without a law in common are ordered by material, or by octaves of alpha and speed,
        # so that neighbours read the same numbers.  A record holds the law of one state at a time.
        laws: Any = (record,)
        order = _NO_ORDER
        if not record and isinstance(material, Prony | Bodies):
            laws = (record_of_materials(material, alpha.astype(np.int64)),)
            if alpha.size > 1:
                order = np.argsort(alpha, kind="stable")
        elif material is None and not direct:
            laws = records_of_alphas(alpha, _ALPHAS_TOGETHER)
            order = sort_by_octave(alpha, kappa, V)
        given = states.State(kappa=kappa, mu=mu, V=V, creep=creep, creep_is_omega=creep_is_omega)
        request = states.Request(states=given, order=order, to=rows, out=out, first=start)
        scratch = np.empty(states.SCRATCH_SIZE)
        if record and record.table is not None:
            from ..kernels.law.spline_law import table_loop

            table_loop(record.table, request, stop - start)
        elif direct:
            from ..kernels.law.printed_law import direct_loop

            if direct_loop(alpha, request, stop - start):
                raise ConvergenceError(
                    "contact: method='direct' found no solution at one of the elements "
                    f"[{start}:{stop}] of the flattened result: use method='table'"
                )
        elif names != (UNSTEADY,):
            contact_loop(laws, request, scratch, stop - start)
        if UNSTEADY not in names:
            return
        N = out[names.index(UNSTEADY), start:stop]
        if isinstance(material, LawTable):
            from ..kernels.motion.motion_law import unsteady_loop

            unsteady_loop(material.unsteady_record, kappa, V, N)
        else:
            # the state has no table of N: its zeta, and N by the modes at that zeta
            zeta = np.empty((1, stop - start))
            request = request._replace(to=kernel_rows(("zeta",)), out=zeta, first=0)
            contact_loop(laws, request, scratch, stop - start)
            N[:] = evaluate_by_modes(alpha, zeta[0]).N

    # few states of one law: no blocks, threads and readers, which would take longer than the states
    if count <= states.TOGETHER and record:
        numbers = broadcast_rows(arrays, shape)
        numbers.flags.writeable = False  # as all arrays that kernels read (block_reader)
        evaluate_block(0, count, *numbers)
        return out
    readers = [block_reader(np.asarray(array), shape) for array in arrays]
    block = _BLOCK_OF_MATERIALS if isinstance(material, Prony | Bodies) else _BLOCK
    run_blocks(
        lambda start, stop: evaluate_block(start, stop, *(read(start, stop) for read in readers)),
        count,
        block,
    )
    return out


@lru_cache(maxsize=1)
def _kernel() -> tuple[Any, Any]:
    """Return the kernel that evaluates the law at many states, and the module of the types of its
    arguments.

    They are imported at the first call, and kept: the statement takes a microsecond each time.
    """
    from ..kernels.law import contact_kernel, law_record

    return contact_kernel.contact_loop, law_record


class Contacts(NamedTuple):
    """The contacts of one law at a slenderness and a coefficient of friction.

    law : table of the material.
    kappa, mu : slenderness R/l0 and coefficient of friction, numbers or (n,).
    """

    law: LawTable
    kappa: Any
    mu: Any

    def fields(self, V: Floats, delta: Any, *names: str) -> Floats:
        """Return fields of the contact at V > 0 and a creepage, one row for each of ``names``.

        V : speeds, dimensionless, > 0, which is not checked, (n,).
        delta : creepage, dimensionless, any sign, a number or (n,).
        names : fields that kernels compute, as ``Q`` or ``dQ_dV``; ``full_slip`` is 0 or 1,
            ``dQ_dV`` is at fixed delta.
        Returns the fields, (names, n), dimensionless.
        """
        state = [1.0, self.kappa, self.mu, V, delta]
        return evaluate_law(self.law, state, shape=V.shape, creep_is_omega=False, names=names)

    def free_creep(self, V: Floats) -> Any:
        """Return delta_0 at V > 0, (n,), the creepage without creep force, at which Q = 0; it does
        not depend on mu.

        Returns the creepage, dimensionless: (n,) of a cover, whose pressure strains it, and of a
        table; the float 0.0 of half-spaces.
        """
        return 0.0 if self.law.moment_of_speed_alone else self.fields(V, 0.0, "delta_0")[0]


def pure_rolling_fields(law: LawTable, u: Floats, *names: str) -> Floats:
    """Return fields of the contact without traction, for kappa = mu = 1 and the speed V = u.

    These are functions of u = kappa |V| alone, so that they serve every kappa: ``lam`` and
    ``epsilon`` as they are, ``M`` as kappa M, ``dM_dV`` and ``N`` as they are.
    law: table of the material.
    u: kappa |V|, >= 0, at most 1e300, not checked, (n,).
    names: fields that kernels compute, as "lam", "epsilon", "M", "dM_dV", "N"
        (:func:`computed_fields`); all are those of kappa = mu = 1.
    Returns a new array (names, n), dimensionless, rows in the order of ``names``; N of a cover is
    NaN.
    """
    contacts = Contacts(law, 1.0, 1.0)
    free = contacts.free_creep(u)
    found = contacts.fields(u, free, *names)
    # along free rolling, whose creepage changes
    if not law.moment_of_speed_alone and "dM_dV" in names:
        slopes = "dM_ddelta", "dQ_dV", "dQ_ddelta"
        of_M, of_V, of_Q = contacts.fields(u, free, *slopes)
        found[names.index("dM_dV")] -= of_M * of_V / of_Q
    return found


def refuse_beyond(law: LawTable, u: Any) -> None:
    """Raise OutOfTableError where a speed exceeds the last one of a table.

    law: the law; one without a table, and one whose table has the limit of fast rolling, allows
        every speed.
    u: kappa |V|, dimensionless, any shape; 1e-12 beyond, relative, counts as rounding.
    """
    most = law.coupled.fastest if law.coupled is not None else np.inf
    largest = float(np.max(u, initial=0.0))
    if largest > most * (1.0 + 1e-12):
        raise OutOfTableError(_SPEED, largest, 0.0, most)


def refuse_overflow(kappa: Any, V: Floats, fastest: float = FASTEST) -> None:
    """Raise ParameterError where kappa |V| exceeds its largest allowed value; else do nothing, as
    without elements.

    kappa: slenderness R/l0, > 0, a number or an array of any shape.
    V: velocities divided by R/T_ref, any sign, finite; broadcasts with kappa.  V may be in another
        unit, as m/s, if kappa is divided by the size of one unit of the scene, R/T_ref, in it.
    fastest: largest allowed kappa |V|.
    The error states the largest kappa |V|.
    """
    kappa = np.asarray(kappa)
    if not (kappa.size and V.size):
        return
    low, high = extent(V)
    if extent(kappa)[1] * max(-low, high) <= fastest:
        return
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max()
    if largest > fastest:
        allowed = f"at most {fastest:g}" + (
            " for Q by method 'direct': use method='table'"
            if fastest == _FASTEST_DIRECT
            else ": reduce V"
        )
        raise ParameterError(_SPEED, f"{largest:g}", allowed)
