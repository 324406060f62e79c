"""The public contact law: :func:`contact`, the state of the contact at given speeds and creepages."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, overload

from ..core.array_types import Numbers
from ..core.checks import check_array, check_array_extent, check_bool
from ..core.errors import check_one_given
from ..core.labels import strip_labels
from ..core.results import Values
from ..core.scale import DIMENSIONS
from ..materials.cover import Cover
from .contact_fields import field_names
from .contact_table import evaluate_contact
from .parameters import Roller, resolve_model
from .validity.model_warnings import warn_of_contact


@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    omega: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values:
    """Return the state of the contact: Eqs. (6)-(10), (15)-(18).

    Arguments broadcast against each other and against array parameters of the roller; if all are scalars so are the
    results.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, everything dimensionless; or a
        :class:`Cylinder`, in SI units per m of its length.
    V : velocity of the axis, any sign; of a Cylinder m/s.
    delta, omega : exactly one: creepage (omega R - V)/V, or angular velocity (rad/s); any sign.
        At V = 0 a given ``delta`` means the limit V -> 0+.
    fields : names of the fields to compute.  ``lam zeta epsilon delta_star delta full_slip beta Q M`` are the
        default; of bodies that differ, and of a Cylinder, ``M_half_space M_cylinder`` too, the parts of M in either
        body; of a Cylinder also ``length``, the contact length in m, and ``C_rr`` = M/(P R), the coefficient of rolling
        resistance; of a cover also ``delta_0``, the creepage of free rolling by the strain that the pressure causes.
        Further ``grip``, the friction reserve 1 - |Q|/mu with all its digits; ``N``, the added mass of slow speed
        changes, where the moment is M(V) + N dV/dt (of a Scene in units of T_ref^2); and single slopes: ``dQ_dV
        dQ_ddelta dQ_domega dM_dV dM_half_space_dV dM_cylinder_dV``.
    slopes : also ``dQ_ddelta`` and ``dQ_domega`` at fixed V, ``dM_dV``, and ``dQ_dV`` at
        fixed delta or fixed omega, whichever was given.  Where full slip begins Q has a
        corner in V only; the slopes there are those of full slip.  At rest (V = omega = 0)
        ``dQ_domega`` is infinite.  Of bodies that differ, ``dM_half_space_dV`` and ``dM_cylinder_dV`` too.
    method : "table" (from the rows of the law: no equation is solved) or "direct" (the equations as the paper prints
        them, solved by Brent-Dekker; no slopes).

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
        If an iteration reaches its limit.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
    >>> state = roller.contact(0.01, omega=0.099)
    >>> traction, moment = state.Q, state.M

    Notes
    -----
    Accuracy of method "table" for one material (one alpha, a series or two bodies): the relative error of delta_star, M
    and Q is below 5e-15, that of the parts of M too, relative to M.  For lam and epsilon it is 5e-15, and 1.5e-14 and
    3e-14 in one octave of speed at alpha from 20 to 35.  This holds for any speed and creepage
    (``tests/materials/test_law_table.py``).  Where each state has its own alpha or material it is 1e-13 for alpha in
    [1, 1e4] and kappa V in [1e-7, 1e5].  The error of beta is that of lam times 1/(1 - |delta|/delta_star), its
    condition number, and the error of grip twice that.  The error of N is 2e-14 of its largest value
    (``tests/kernels/rows/test_unsteady.py``).

    The law of one material is evaluated from polynomials of one variable (:mod:`.materials.law.table`), which are
    computed at first use in some milliseconds and kept.  The result of a state does not depend on other states of the
    call.

    Beside float64 input and its result a call takes a few megabytes, for any sizes and any
    broadcasting (``tests/test_invariance.py``).
    """
    _, scene, scale = resolve_model(roller, "contact")
    creep_name = check_one_given(delta=delta, omega=omega)
    if slopes is not False:
        slopes = check_bool("slopes", slopes)
    cover = scene.material if type(scene.material) is Cover else None
    split = cover is None or cover.other.alpha == 1.0
    like, of_cover = scene.like_bodies, cover is not None
    names = field_names(fields, slopes, method, like=like, si=scale.si, cover=of_cover, split=split)
    given, labels = strip_labels({"V": V, creep_name: omega if delta is None else delta}, scale)
    speed, ends = check_array_extent("V", given["V"])
    creep = check_array(creep_name, given[creep_name])
    given = {"V": speed, creep_name: creep}
    about = None
    if scale.si:
        warn_of_contact(roller, speed, ends)
        about = roller.about
        speed = speed / scale["V"]
        creep = creep / scale["omega"] if delta is None else creep
    found = evaluate_contact(scene, speed, creep, delta is None, names, method)
    if scale.si:
        found = {name: value * scale[name] if name in DIMENSIONS else value for name, value in found.items()}
    return Values(found, given, si=scale.si, labels=labels, about=about)
