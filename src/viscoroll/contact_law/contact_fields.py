"""What a contact state holds, by name."""

from __future__ import annotations

from collections.abc import Iterable

from ..core.checks import check_choice
from ..core.errors import ParameterError, check_names

FIELDS = ("lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M")
OF_BODIES = ("M_half_space", "M_cylinder")
SLOPES = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")
SLOPES_OF_BODIES = ("dM_half_space_dV", "dM_cylinder_dV")
#: on request alone, and not by the printed equations
UNSTEADY, GRIP = "N", "grip"
#: creep of free rolling by the strain that the pressure makes: of covers, 0 of half-spaces
FREE = "delta_0"
#: known where both bodies relax and one of them is a layer
BEFORE_THE_SPLIT = ("lam", "length", "zeta", "epsilon", "delta_star", "delta", "M", "C_rr", "dM_dV")
#: of which field each of these is made by units alone: the length is over l0, C_rr = M/(P R)
SAME = {"length": "lam", "C_rr": "M"}
KNOWN = (*FIELDS, *OF_BODIES, *SLOPES, *SLOPES_OF_BODIES, UNSTEADY, GRIP, FREE, *SAME)
#: what is given without a word, of like bodies and of others, and of a cylinder in SI units
DEFAULT = {
    (True, False): FIELDS,
    (False, False): (*FIELDS, *OF_BODIES),
    **dict.fromkeys(((True, True), (False, True)), ("lam", "length", *FIELDS[1:], "C_rr", *OF_BODIES)),
}


def field_names(fields: Iterable[str] | None, like: bool, si: bool, slopes: bool, method: str) -> tuple[str, ...]:
    """The fields and slopes of a call by name; of bodies that are ``like``, in units of SI.

    Raises
    ------
    ParameterError
        A name or a method that there is not, or one that the other does not give.
    """
    check_choice("method", method, "table", "direct")
    names = DEFAULT[like, si] if fields is None else check_names("fields", fields, KNOWN, "a field")
    if slopes:
        names += tuple(name for name in (SLOPES if like else SLOPES + SLOPES_OF_BODIES) if name not in names)
    if method == "direct" and set(names) & set(SLOPES + SLOPES_OF_BODIES):
        raise ParameterError("slopes", True, "False with method='direct': the printed equations give none")
    for name in (UNSTEADY, GRIP, FREE):
        if method == "direct" and name in names:
            raise ParameterError("fields", repr(name), "computed by method='table' alone: it is not in the paper")
    return names
