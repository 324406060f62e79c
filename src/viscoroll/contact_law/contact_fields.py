"""The fields of a contact state: which exist, which a call returns, which of them the kernels compute.

With lengths over l0 (the contact length at rest of half-spaces), forces over the load P and moments over P R: ``lam``
contact length, ``zeta`` half the transit time, ``epsilon`` shift of the contact over half its length, ``delta``
creepage, ``delta_0`` that at which Q = 0, ``full_slip`` whether |delta - delta_0| >= ``delta_star``, ``beta`` stick
zone over contact length, ``Q`` friction force, ``grip`` 1 - |Q|/mu, ``M`` rolling moment, ``M_half_space`` and
``M_cylinder`` its parts, ``N`` its factor of dV/dt, ``dA_dB`` slopes.

This module alone interprets names of fields.  A call resolves its names (:func:`field_names`), asks the kernels for
:func:`computed_fields`, tells them the row of each (:func:`kernel_rows`), and completes the result (:func:`complete`).
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any

import numpy as np

from ..core.checks import check_choice
from ..core.errors import ParameterError, check_names

#: Fields of every call without ``fields=``.
FIELDS = ("lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M")
#: Parts of M in the two bodies.
OF_BODIES = ("M_half_space", "M_cylinder")
#: Slopes of ``slopes=True``.
SLOPES = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")
#: Slopes of the parts of M.
SLOPES_OF_BODIES = ("dM_half_space_dV", "dM_cylinder_dV")
#: Slopes that are 0 of half-spaces, whose M depends on the speed alone; of a cover with ``slopes=True``.
SLOPES_OF_COVERS = ("dM_ddelta", "dM_domega", "dM_half_space_domega", "dM_cylinder_domega")
#: Added mass of slow speed changes.
UNSTEADY = "N"
#: Friction reserve 1 - |Q|/mu.
GRIP = "grip"
#: Creepage of free rolling of a cover, in which stick and the strain by the pressure balance; 0 for half-spaces.
FREE_CREEP = "delta_0"
#: Approach of the bodies, of layers on rigid ground.
DEPTH = "depth"
#: Fields that method "coupled" alone has, with the default ones first.
OF_COUPLED = ("delta_minus", "delta_plus", "loss_slip", "loss_half_space", "loss_cylinder", DEPTH)
#: Accuracy of M by the data of the materials, of a cylinder in SI units alone.
ACCURACY = "M_error"
#: Field -> the field of which it is a multiple, or from which it follows: the length is lam times l0, C_rr is M/(P R).
_MULTIPLES = {"length": "lam", "C_rr": "M", ACCURACY: "lam"}
#: Field of like bodies -> the field of which it is half.
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
_HALVES |= dict.fromkeys(SLOPES_OF_COVERS[2:], "dM_domega")
#: All fields.
_KNOWN = (
    *(*FIELDS, *OF_BODIES, *SLOPES, *SLOPES_OF_BODIES, *SLOPES_OF_COVERS),
    *(UNSTEADY, GRIP, FREE_CREEP, *_MULTIPLES, *OF_COUPLED),
)


def field_names(
    fields: Iterable[str] | None, slopes: bool, method: str, *, like: bool, si: bool, cover: bool
) -> tuple[str, ...]:
    """Return the names of the fields that a call of :func:`.contact.contact` has to return, in their order.

    Parameters
    ----------
    fields : a name or names of fields; None: the default fields of such a roller.  A name may occur twice; of no names
        there are no fields.
    slopes : whether the slopes are added to these fields.
    method : "table"; "direct" (the printed equations), which has no slopes, N, grip and delta_0; or "coupled", which
        has no slopes and no N, and alone has :data:`OF_COUPLED`, of which all but the depth are default fields.
    like : whether both bodies are of one material; if not, the parts of M in either body are default fields, and
        ``slopes`` adds their slopes.
    si : whether the roller is a cylinder, in SI units; ``length``, ``C_rr`` and the parts of M are then default fields.
    cover : whether a body is a cover, a layer of finite thickness; ``delta_0`` is then a default field, and N is not
        available.

    Returns
    -------
    tuple of str
        Those of ``fields`` in their order, or the default fields; then with ``slopes`` those slopes that were not among
        them; then, of a cover with ``fields`` None, ``delta_0``.

    Raises
    ------
    ParameterError
        An unknown field or method; slopes, N, grip or delta_0 with method "direct"; slopes or N with "coupled", and its
        own fields without it; N of a cover.
    """
    check_choice("method", method, "table", "direct", "coupled")
    if fields is not None:
        names = check_names("fields", fields, _KNOWN if si else [x for x in _KNOWN if x != ACCURACY], "a field")
    elif si:
        names = ("lam", "length", *FIELDS[1:], "C_rr", *OF_BODIES)
    else:
        names = FIELDS if like else (*FIELDS, *OF_BODIES)
    if slopes:
        more = SLOPES + (() if like else SLOPES_OF_BODIES) + (SLOPES_OF_COVERS if cover else ())
        names += tuple(name for name in more if name not in names)
    if method == "coupled":
        return _coupled_names(names, fields is None)
    only = next((name for name in names if name in OF_COUPLED), None)
    if only is not None:
        raise ParameterError("fields", repr(only), "left out, or computed with method='coupled'")
    if method == "direct":
        if set(names) & set(SLOPES + SLOPES_OF_BODIES + SLOPES_OF_COVERS):
            raise ParameterError("method", "'direct'", "'table' for slopes: the equations of the paper give none")
        for name in (UNSTEADY, GRIP, FREE_CREEP):
            if name in names:
                raise ParameterError("fields", repr(name), "left out, or computed with method='table'")
    if not cover:
        return names
    if UNSTEADY in names:
        allowed = "left out for a cover: N of a layer of finite thickness is not available"
        raise ParameterError("fields", repr(UNSTEADY), allowed)
    return (*names, FREE_CREEP) if fields is None else names


def _coupled_names(names: tuple[str, ...], default: bool) -> tuple[str, ...]:
    """Return the fields of a call with method "coupled".

    names: fields of the call; default: whether they are the default ones, to which those of the method are added.
    Raises ParameterError for slopes and N.
    """
    for name in names:
        if name in SLOPES + SLOPES_OF_BODIES + SLOPES_OF_COVERS + (UNSTEADY,):
            raise ParameterError("fields", repr(name), "left out: method 'coupled' has no slopes and no N")
    if not default:
        return names
    extra = (*OF_BODIES, *OF_COUPLED[:-1])
    return names + tuple(name for name in extra if name not in names)


@lru_cache(maxsize=64)
def computed_fields(names: tuple[str, ...], unlike: bool) -> tuple[str, ...]:
    """Return the fields that the kernels compute, a row each, from which :func:`complete` makes all fields of a call.

    names: fields of the call, as of :func:`field_names`.
    unlike: whether the bodies are of two materials; if not, each part of M is half of M, and is not computed.
    Returns names without repetition, in the order of their first need: a field that is a multiple of another
    (``length`` of ``lam``, ``C_rr`` of ``M``; of like bodies M_half_space, M_cylinder of ``M`` and their slopes of
    ``dM_dV``) is replaced by that other one.
    """
    derived = _MULTIPLES if unlike else _MULTIPLES | _HALVES
    return tuple(dict.fromkeys(derived.get(name, name) for name in names))


@lru_cache(maxsize=64)
def kernel_rows(names: tuple[str, ...]) -> Any:
    """Return the index of the output row of each field as the record that kernels take.

    names: fields that kernels compute, as of :func:`computed_fields`, each once; field k has row k of the output.
    Returns :class:`...kernels.rows.contact_states.Fields`: an int for each field, -1 for those that are not in
    ``names``.  N is not among them, since a kernel of its own computes it; its row is left free.
    """
    from ..kernels.rows.contact_states import Fields

    return Fields(**{name: row for row, name in enumerate(names) if name != UNSTEADY})


def complete(
    names: tuple[str, ...], computed: tuple[str, ...], rows: np.ndarray, shape: tuple[int, ...]
) -> dict[str, Any]:
    """Return the fields of a call by name, from the rows that the kernels computed.

    names: fields of the call, as of :func:`field_names`.
    computed: name of the field in each row, as of :func:`computed_fields`.
    rows: values, (rows, states), dimensionless; ``full_slip`` is 0 or 1.
    shape: shape of the call, whose product is the number of states; () for one state.
    Returns a dict from each of ``names``, in their order, to an array of ``shape``, for shape () a float; ``full_slip``
    is a boolean array, for shape () a bool.  Arrays that are a row of ``rows`` are views of it.  ``length`` and
    ``C_rr`` have the values of lam and M, which the caller of a Cylinder multiplies by their units, as it makes
    ``M_error`` of lam; parts of M that
    were not computed are half of M, their slopes half of dM_dV.
    """
    found: dict[str, Any] = dict(zip(computed, rows if shape else rows[:, 0].tolist(), strict=True))
    if computed != names:
        found |= {name: 0.5 * found[of] for name, of in _HALVES.items() if name in names and name not in found}
        found |= {name: found[of] for name, of in _MULTIPLES.items() if name in names}
    if "full_slip" in names:
        found["full_slip"] = found["full_slip"] != 0.0
    return {name: found[name].reshape(shape) if shape else found[name] for name in names}
