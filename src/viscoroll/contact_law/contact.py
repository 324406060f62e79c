"""The public contact law: :func:`contact`.

Checks and broadcasts the input, chooses the method, and asks the kernels for no more than
the fields that were named.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Numbers
from ..core.checks import broadcast_shape, check_array, check_array_extent, check_bool
from ..core.errors import ParameterError, exactly_one_error
from ..core.labels import strip_labels
from ..core.results import Values
from ..core.scale import DIMENSIONS
from ..materials.bodies import Bodies
from ..materials.cover import Cover
from ..materials.law.table import LawTable
from ..materials.prony import Prony
from .contact_fields import BEFORE_THE_SPLIT, FREE, OF_BODIES, SAME, SLOPES_OF_BODIES, UNSTEADY, field_names
from .contact_table import FASTEST, evaluate_law, refuse_overflow
from .parameters import Parameters, Rolls, framed

#: of bodies that are alike, half of each
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
#: in Eq. (15) as printed the rounding of a bracket grows with kappa |V|: beyond, Q has lost four digits of mu and more
_FASTEST_DIRECT = 1e12


@overload
def contact(
    roller: Rolls,
    V: Numbers,
    *,
    delta: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
@overload
def contact(
    roller: Rolls,
    V: Numbers,
    *,
    omega: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
def contact(
    roller: Rolls,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values:
    """State of the contact: Eqs. (6)-(10), (15)-(18).

    Arguments broadcast against each other and against array parameters of what rolls; if all are scalars so are the
    results.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, everything dimensionless; or a
        :class:`Cylinder`, in SI units per m of its length.
    V : velocity of the axis, any sign; of a Cylinder m/s.
    delta, omega : exactly one: creep ratio (omega R - V)/V, or angular velocity (rad/s); any sign.
        At V = 0 a given ``delta`` means the limit V -> 0+.
    fields : names out of ``lam zeta epsilon delta_star delta full_slip beta Q M`` (and,
        for one slope alone, ``dQ_dV dQ_ddelta dQ_domega dM_dV dM_half_space_dV dM_cylinder_dV``), and
        ``M_half_space M_cylinder``, the parts of M in either body, and ``N``, of M(V) + N V' where speed
        changes slowly, in units of T_ref^2; ``grip``, 1 - |Q|/mu to all its digits; ``delta_0``, the creep of free
        rolling on a cover by the strain that the pressure makes, 0 of half-spaces;
        ``length`` of the contact, over l0 or in m, and ``C_rr`` = M/(P R), the coefficient of rolling resistance; only
        these are computed.  Default: the first nine; of bodies that differ, and of a Cylinder, the two parts too;
        of a Cylinder ``length`` and ``C_rr``, and of a cover ``delta_0``.
    slopes : also ``dQ_ddelta`` and ``dQ_domega`` at fixed V, ``dM_dV``, and ``dQ_dV`` at
        fixed delta or fixed omega, whichever was given.  Where full slip begins Q has a
        corner in V only; the slopes there are those of full slip.  At rest (V = omega = 0)
        ``dQ_domega`` is infinite.  Of bodies that differ, ``dM_half_space_dV`` and ``dM_cylinder_dV`` too.
    method : "table" (the rows of the law: no equation is solved) or "direct" (the paper's
        equations as printed, solved by Brent-Dekker; no slopes).

    Returns
    -------
    Values
        The fields as attributes and by ``[name]``.  Of a Cylinder ``Q`` is in N/m, ``M`` and its parts in N m/m,
        ``zeta`` in s; force and moment on it, Eqs. (20), (21), are Q - M_half_space/R and Q R + M_cylinder.
        ``zeta`` is infinite at V = 0, ``delta`` at V = 0 with omega != 0.  ``epsilon`` may exceed 1: the contact then
        lies wholly ahead of the axis.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300 (for Q by method "direct" above 1e12), both or
        neither of delta and omega, unknown field or method, shapes that do not broadcast.
    ConvergenceError
        If a solve hits its iteration cap.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
    >>> state = roller.contact(0.01, omega=0.099)
    >>> traction, moment = state.Q, state.M

    Notes
    -----
    Accuracy of method "table" for one material (one alpha, a series or two bodies): 5e-15 relative in delta_star, M and
    Q, the parts of M over M, in lam and epsilon too but for one octave of speed at alpha from 20 to 35, where it is
    1.5e-14 and 3e-14, for any speed and creep (``tests/materials/test_law_table.py``); for an alpha or a material each
    1e-13 for alpha in [1, 1e4], kappa V in [1e-7, 1e5].  beta as lam, and grip, times
    1/(1 - |delta|/delta_star), their condition number, of the grip twice that.  N: 2e-14 of its largest size
    (``tests/kernels/rows/test_unsteady.py``).

    The law of one material is read from polynomials of one variable (:mod:`.materials.law.table`), made on first use in
    some milliseconds and kept.  A state's result depends on nothing else in the call.

    Beside float64 input and its result a call takes a few megabytes, whatever the sizes and
    however they broadcast (``tests/test_invariance.py``).
    """
    _, scene, scale = framed(roller, "contact")
    if (delta is None) == (omega is None):
        raise exactly_one_error("delta", "omega", both=delta is not None)
    if slopes is not False:
        slopes = check_bool("slopes", slopes)
    names = field_names(fields, scene.like_bodies, scale.si, slopes, method)
    if type(scene.material) is Cover:
        names = _of_cover(scene.material, names, fields is None)
    creep_name = "omega" if delta is None else "delta"
    given, labels = strip_labels({"V": V, creep_name: omega if delta is None else delta}, scale)
    speed, ends = check_array_extent("V", given["V"])
    creep = check_array(creep_name, given[creep_name])
    given = {"V": speed, creep_name: creep}
    about = None
    if scale.si:
        roller.look(speed, ends)
        about = roller.about
        speed = speed / scale["V"]
        creep = creep / scale["omega"] if delta is None else creep
    found = evaluate_contact(scene, speed, creep, delta is None, names, method)
    if scale.si:
        found = {name: value * scale[name] if name in DIMENSIONS else value for name, value in found.items()}
    return Values(found, given, si=scale.si, labels=labels, about=about)


def evaluate_contact(
    scene: Parameters, V: NDArray, creep: NDArray, creep_is_omega: bool, names: tuple[str, ...], method: str = "table"
) -> dict[str, Any]:
    """Fields without dimension, at checked speeds, and creeps or angular velocities."""
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
        raise ParameterError("method", "'direct'", "'table': the printed equations know one relaxation time")
    one = None if method == "direct" else scene.table or scene.each
    if isinstance(one, Prony | Bodies):
        if UNSTEADY in names:
            raise ParameterError("fields", repr(UNSTEADY), "asked for with one material, as material[i]")
        arrays["alpha"] = np.arange(len(one), dtype=np.float64)
    # what the kernels are asked for, and what is half of it
    unlike = one.unlike if isinstance(one, LawTable) else isinstance(one, Bodies)
    solved = _solved(names, unlike)
    broadcast = [*arrays.values()], shape, creep_is_omega, solved
    found = evaluate_law(one, *broadcast, method == "direct")
    rows: dict[str, Any] = dict(zip(solved, found if shape else found[:, 0].tolist(), strict=True))
    if solved != names:
        rows |= {name: 0.5 * rows[of] for name, of in _HALVES.items() if name in names and name not in rows}
        rows |= {name: rows[of] for name, of in SAME.items() if name in names}
    if "full_slip" in names:
        rows["full_slip"] = rows["full_slip"] != 0.0
    return {name: rows[name].reshape(shape) if shape else rows[name] for name in names}


def _of_cover(cover: Cover, names: tuple[str, ...], plain: bool) -> tuple[str, ...]:
    """Return the fields of a cover; raise ParameterError of a named one that is not known.

    cover: of the scene.  names: of the call, or the default ones if ``plain``, to which delta_0 is added; if both
    bodies relax, those that need the split of M and slip are left out.
    """
    if cover.other.alpha > 1.0:
        left = tuple(name for name in names if name in BEFORE_THE_SPLIT)
        if left != names and not plain:
            found, allowed = repr(next(name for name in names if name not in left)), ", ".join(BEFORE_THE_SPLIT)
            allowed = f"of {allowed} where the body beside a layer relaxes: the rest is not known"
            raise ParameterError("fields", found, allowed)
        return left
    if UNSTEADY in names:
        raise ParameterError(
            "fields", repr(UNSTEADY), "left out for a cover: N of a layer of finite thickness is not known"
        )
    return (*names, FREE) if plain else names


@lru_cache(maxsize=64)
def _solved(names: tuple[str, ...], unlike: bool) -> tuple[str, ...]:
    """What the kernels are asked for: not what is half of it, or the same in other units."""
    made = SAME if unlike else SAME | _HALVES
    return tuple(dict.fromkeys(made.get(name, name) for name in names))
