"""The fields of a contact state: which exist, which a call returns, which of them the kernels compute.

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
#: Added mass of slow speed changes.
UNSTEADY = "N"
#: Friction reserve 1 - |Q|/mu.
GRIP = "grip"
#: Creepage of free rolling by the strain that the pressure causes in a cover; 0 for half-spaces.
FREE_CREEP = "delta_0"
#: Field -> the field of which it is a multiple: the length is lam times l0, C_rr is M/(P R).
_MULTIPLES = {"length": "lam", "C_rr": "M"}
#: Field of like bodies -> the field of which it is half.
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
#: Fields that are known if both bodies relax and one of them is a layer.
_BEFORE_THE_SPLIT = ("lam", "length", "zeta", "epsilon", "delta_star", "delta", "M", "C_rr", "dM_dV")
#: All fields.
_KNOWN = (*FIELDS, *OF_BODIES, *SLOPES, *SLOPES_OF_BODIES, UNSTEADY, GRIP, FREE_CREEP, *_MULTIPLES)


def field_names(
    fields: Iterable[str] | None, slopes: bool, method: str, *, like: bool, si: bool, cover: bool, split: bool = True
) -> tuple[str, ...]:
    """Return the names of the fields of a call.

    Parameters
    ----------
    fields, slopes, method : arguments of :func:`.contact.contact`.
    like : whether both bodies are of one material.
    si : whether the roller is a cylinder.
    cover : whether it has a cover of finite thickness.
    split : whether it is known how slip and M are split between the bodies; not if the body beside a cover relaxes.

    Raises
    ------
    ParameterError
        An unknown field or method, or a field that the method or the roller does not have.
    """
    check_choice("method", method, "table", "direct")
    if fields is not None:
        names = check_names("fields", fields, _KNOWN, "a field")
    elif si:
        names = ("lam", "length", *FIELDS[1:], "C_rr", *OF_BODIES)
    else:
        names = FIELDS if like else (*FIELDS, *OF_BODIES)
    if slopes:
        names += tuple(name for name in (SLOPES if like else SLOPES + SLOPES_OF_BODIES) if name not in names)
    if method == "direct":
        if set(names) & set(SLOPES + SLOPES_OF_BODIES):
            raise ParameterError("method", "'direct'", "'table' for slopes: the equations of the paper give none")
        for name in (UNSTEADY, GRIP, FREE_CREEP):
            if name in names:
                raise ParameterError("fields", repr(name), "left out, or computed with method='table'")
    if not cover:
        return names
    if not split:
        known = tuple(name for name in names if name in _BEFORE_THE_SPLIT)
        if fields is None or known == names:
            return known
        unknown = next(name for name in names if name not in known)
        allowed = f"one of {', '.join(_BEFORE_THE_SPLIT)}: others are not available if both bodies are viscoelastic"
        raise ParameterError("fields", repr(unknown), allowed)
    if UNSTEADY in names:
        allowed = "left out for a cover: N of a layer of finite thickness is not available"
        raise ParameterError("fields", repr(UNSTEADY), allowed)
    return (*names, FREE_CREEP) if fields is None else names


@lru_cache(maxsize=64)
def computed_fields(names: tuple[str, ...], unlike: bool) -> tuple[str, ...]:
    """Return the fields that the kernels compute, a row each, so that :func:`complete` has all fields of a call.

    names: fields of the call.
    unlike: whether the bodies are of two materials; if not, the parts of M are halves.
    """
    derived = _MULTIPLES if unlike else _MULTIPLES | _HALVES
    return tuple(dict.fromkeys(derived.get(name, name) for name in names))


@lru_cache(maxsize=64)
def kernel_rows(names: tuple[str, ...]) -> Any:
    """Return the row of each of the fields ``names`` as the record that kernels take; N has a kernel of its own."""
    from ..kernels.rows.contact_states import Fields

    return Fields(**{name: row for row, name in enumerate(names) if name != UNSTEADY})


def complete(
    names: tuple[str, ...], computed: tuple[str, ...], rows: np.ndarray, shape: tuple[int, ...]
) -> dict[str, Any]:
    """Return the fields of a call by name, numbers or arrays.

    names: fields of the call.
    computed: field of each row.
    rows: values, (fields, states).
    shape: shape of the call.
    """
    found: dict[str, Any] = dict(zip(computed, rows if shape else rows[:, 0].tolist(), strict=True))
    if computed != names:
        found |= {name: 0.5 * found[of] for name, of in _HALVES.items() if name in names and name not in found}
        found |= {name: found[of] for name, of in _MULTIPLES.items() if name in names}
    if "full_slip" in names:
        found["full_slip"] = found["full_slip"] != 0.0
    return {name: found[name].reshape(shape) if shape else found[name] for name in names}
