"""The fields of a contact state by name: which exist, which a call returns, and which follow from others."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any

from ..core.checks import check_choice
from ..core.errors import ParameterError, check_names
from ..materials.bodies import Bodies
from ..materials.cover import Cover

#: Fields of every contact state.
FIELDS = ("lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M")
#: Parts of M.
OF_BODIES = ("M_half_space", "M_cylinder")
#: Derivatives of Q and M.
SLOPES = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")
#: Derivatives of the parts of M, in their order.
SLOPES_OF_BODIES = ("dM_half_space_dV", "dM_cylinder_dV")
#: Added mass of slow changes of speed; on request alone, and not by the printed equations.
UNSTEADY = "N"
#: Friction reserve; likewise.
GRIP = "grip"
#: Creepage of free rolling by the strain that the pressure makes: of covers, 0 of half-spaces.
FREE = "delta_0"
#: Fields that differ from another one by units alone: the length is divided by l0, C_rr = M/(P R).
SAME = {"length": "lam", "C_rr": "M"}
#: Fields that are half of another one where both bodies are alike.
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
#: All names that a caller may give.
ALL_FIELDS = (*FIELDS, *OF_BODIES, *SLOPES, *SLOPES_OF_BODIES, UNSTEADY, GRIP, FREE, *SAME)


def field_names(fields: Iterable[str] | None, material: Any, si: bool, slopes: bool, method: str) -> tuple[str, ...]:
    """Return the names of the fields and slopes that a call of :func:`.contact.contact` returns.

    fields: names of the caller; None: the default of like bodies, of others, of a cylinder and of a cover.
    material: of the scene; None for an alpha.
    si: whether the roller is a cylinder in SI units.
    slopes, method: as of ``contact``.
    Raises ParameterError for an unknown name or method, and for a field that the method or the material does not have.
    """
    check_choice("method", method, "table", "direct")
    like, cover = not isinstance(material, Bodies) or material.like, isinstance(material, Cover)
    if fields is not None:
        names = check_names("fields", fields, ALL_FIELDS, "a field")
    elif si:
        names = ("lam", "length", *FIELDS[1:], "C_rr", *OF_BODIES)
    else:
        names = FIELDS if like else (*FIELDS, *OF_BODIES)
    if slopes:
        names += tuple(name for name in (SLOPES if like else SLOPES + SLOPES_OF_BODIES) if name not in names)
    if method == "direct" and set(names) & set(SLOPES + SLOPES_OF_BODIES):
        raise ParameterError("slopes", True, "False with method='direct': the printed equations give none")
    for name in (UNSTEADY, GRIP, FREE):
        if method == "direct" and name in names:
            raise ParameterError("fields", repr(name), "computed by method='table' alone: it is not in the paper")
    if cover and UNSTEADY in names:
        allowed = "left out for a cover: N of a layer of finite thickness is not known"
        raise ParameterError("fields", repr(UNSTEADY), allowed)
    return (*names, FREE) if cover and fields is None else names


@lru_cache(maxsize=64)
def solved_fields(names: tuple[str, ...], unlike: bool) -> tuple[str, ...]:
    """Return the fields that the kernels compute, from which :func:`add_derived` makes the others.

    names: of the fields of a call.
    unlike: whether the bodies differ.
    """
    derived = SAME if unlike else SAME | _HALVES
    return tuple(dict.fromkeys(derived.get(name, name) for name in names))


def add_derived(state: dict[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Return the fields of a call from those that were computed, with ``full_slip`` as booleans.

    state: fields of :func:`solved_fields` by name, numbers or arrays.
    names: of the fields of the call, in order.
    """
    halves = {name: 0.5 * state[whole] for name, whole in _HALVES.items() if name in names and name not in state}
    state = state | halves | {name: state[other] for name, other in SAME.items() if name in names}
    if "full_slip" in names:
        state["full_slip"] = state["full_slip"] != 0.0
    return {name: state[name] for name in names}
