"""The public contact law: :func:`contact`.

Checks and broadcasts the input, chooses the method, and asks the kernels for no more than
the fields that were named.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from .blocks import elements, solve_blocks
from .checks import broadcast_shape, checked_extent
from .contact_fields import OF_BODIES, SLOPES_OF_BODIES, UNSTEADY, field_names
from .contact_table import states_of
from .errors import ParameterError, one_of
from .labels import unlabelled
from .materials.bodies_array import BodiesArray
from .materials.law_table import LawTable, law_table
from .materials.prony_array import MaterialArray
from .results import Values
from .scene import Scene, checked_scene
from .typed import Numbers

#: of bodies that are alike, half of each
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
_BLOCK = 1 << 15
_FASTEST = 1e300
#: in Eq. (15) as printed the rounding of a bracket grows with kappa |V|: beyond, Q has lost four digits of mu and more
_FASTEST_DIRECT = 1e12


@overload
def contact(
    scene: Scene,
    V: Numbers,
    delta: Numbers,
    omega: None = None,
    *,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
@overload
def contact(
    scene: Scene,
    V: Numbers,
    delta: None = None,
    *,
    omega: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values: ...
def contact(
    scene: Scene,
    V: Numbers,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    *,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct"] = "table",
) -> Values:
    """State of the contact: Eqs. (6)-(10), (15)-(18).

    Everything is dimensionless.  Arguments broadcast against each other and against array
    parameters of the scene; if all are scalars so are the results.

    Parameters
    ----------
    scene : alpha or material, kappa and mu are used.
    V : velocity of the axis, any sign.
    delta, omega : exactly one: creep ratio (omega - V)/V, or angular velocity; any sign.
        At V = 0 a given ``delta`` means the limit V -> 0+.
    fields : names out of ``lam zeta epsilon delta_star delta full_slip beta Q M`` (and,
        for one slope alone, ``dQ_dV dQ_ddelta dQ_domega dM_dV dM_half_space_dV dM_cylinder_dV``), and
        ``M_half_space M_cylinder``, the parts of M in either body, and ``N``, of M(V) + N V' where speed
        changes slowly, in units of T_ref^2; only these are computed.  Default: the first nine, of bodies
        that differ the two parts too.
    slopes : also ``dQ_ddelta`` and ``dQ_domega`` at fixed V, ``dM_dV``, and ``dQ_dV`` at
        fixed delta or fixed omega, whichever was given.  Where full slip begins Q has a
        corner in V only; the slopes there are those of full slip.  At rest (V = omega = 0)
        ``dQ_domega`` is infinite.  Of bodies that differ, ``dM_half_space_dV`` and ``dM_cylinder_dV`` too.
    method : "table" (the rows of the law: no equation is solved) or "direct" (the paper's
        equations as printed, solved by Brent-Dekker; no slopes).

    Returns
    -------
    Values
        The fields as attributes.  ``zeta`` is infinite at V = 0, ``delta`` at V = 0 with
        omega != 0.  ``epsilon`` may exceed 1: the contact then lies wholly ahead of the axis.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300 (for Q by method "direct" above 1e12), both or
        neither of delta and omega, unknown field or method, shapes that do not broadcast.
    ConvergenceError
        If a solve hits its iteration cap.

    Notes
    -----
    Accuracy of method "table" for one material (one alpha, a series or two bodies): 5e-15 relative in delta_star, M and
    Q, the parts of M over M, in lam and epsilon too but for one octave of speed at alpha from 20 to 35, where it is
    1.5e-14 and 3e-14, for any speed and creep (``tests/materials/test_law_table.py``); for an alpha or a material each
    1e-13 for alpha in [1, 1e4], kappa V in [1e-7, 1e5].  beta as lam, times 1/(1 - |delta|/delta_star), its condition
    number.  N: 2e-14 of its largest size (``tests/kernels/law/test_unsteady.py``).

    The law of one material is read from polynomials of one variable (:mod:`.materials.law_table`), made on first use in
    some milliseconds and kept.  A state's result depends on nothing else in the call.

    Beside float64 input and its result a call takes a few megabytes, whatever the sizes and
    however they broadcast (``tests/test_invariance.py``).
    """
    checked_scene(scene, "contact")
    if (delta is None) == (omega is None):
        raise one_of("delta", "omega", both=delta is not None)
    names = field_names(fields, scene.like_bodies, slopes, method)
    plain, labels = unlabelled({"V": V, "delta": delta, "omega": omega})
    V, delta, omega = plain["V"], plain["delta"], plain["omega"]
    creep_name = "omega" if delta is None else "delta"
    inputs = {
        "alpha": scene.alpha, "kappa": scene.kappa, "mu": scene.mu,
        "V": V, creep_name: omega if delta is None else delta,
    }  # fmt: skip
    arrays, extents = {}, {}
    for name, value in inputs.items():
        arrays[name], extents[name] = checked_extent(name, value)
    shape = broadcast_shape(**arrays)
    fastest = _FASTEST_DIRECT if method == "direct" and "Q" in names else _FASTEST
    if extents["kappa"][1] * max(map(abs, extents["V"])) > fastest:
        refuse_overflow(arrays["kappa"], arrays["V"], fastest)
    if scene.material is not None and method == "direct":
        raise ParameterError("method", "'direct'", "'table': the printed equations know one relaxation time")
    one = None if method == "direct" else one_material(scene)
    if isinstance(one, MaterialArray):
        if UNSTEADY in names:
            raise ParameterError("fields", repr(UNSTEADY), "asked for with one material, as material[i]")
        arrays["alpha"] = np.arange(len(one), dtype=np.float64)
    # what the kernels are asked for, and what is half of it
    unlike = one.unlike if isinstance(one, LawTable) else isinstance(one, BodiesArray)
    halved = {} if unlike else {name: _HALVES[name] for name in names if name in _HALVES}
    solved = tuple(dict.fromkeys(halved.get(name, name) for name in names))
    broadcast = list(arrays.values()), shape, creep_name == "omega", solved
    found = _direct(*broadcast) if method == "direct" else states_of(one, *broadcast)
    rows = dict(zip(solved, found, strict=True))
    rows |= {name: 0.5 * rows[whole] for name, whole in halved.items()}
    given = {"V": V, creep_name: omega if delta is None else delta}
    return Values({name: shaped(name, rows[name], shape) for name in names}, given, labels=labels)


def one_material(scene: Scene) -> LawTable | MaterialArray | None:
    """The table that serves all states; many series or pairs; or, None, alphas."""
    if scene.law is not None:
        return scene.law
    if scene.material is None:
        return law_table(float(np.asarray(scene.alpha).item())) if np.size(scene.alpha) == 1 else None
    return scene.in_own_time()[0] if isinstance(scene.material, MaterialArray) else law_table(scene.material)


def refuse_overflow(kappa: NDArray, V: NDArray, fastest: float = _FASTEST) -> None:
    """Raise ParameterError where kappa |V| leaves the range of doubles, or nearly (zeta would be 0), or that given."""
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > fastest:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {fastest:g}")


def _direct(arrays: list[NDArray], shape: tuple[int, ...], creep_is_omega: bool, names: tuple[str, ...]) -> NDArray:
    """The fields ``names`` by the printed equations, a row each, of alpha, kappa, mu, V and the creep."""
    from .kernels.law.states import ROWS, States
    from .kernels.printed.loop import direct_loop

    count = int(np.prod(shape))
    rows = np.array([ROWS.index(name) for name in names], dtype=np.int64)
    out = np.empty((len(names), count))
    alphas, *parts = (elements(array, shape) for array in arrays)

    def solve(start: int, stop: int) -> int:
        found = np.empty((len(names), stop - start))
        kappa, mu, V, creep = (part(start, stop) for part in parts)
        states = States(kappa, mu, V, creep, creep_is_omega)
        status: int = direct_loop(alphas(start, stop), states, rows, found, 0, stop - start)
        out[:, start:stop] = found
        return status

    solve_blocks(solve, count, _BLOCK, "contact: an iteration hit its cap near element {} (method 'direct')")
    return out


def shaped(name: str, row: NDArray, shape: tuple[int, ...]) -> Any:
    """A row of a kernel in the shape of the call; a number where that is ()."""
    values = np.reshape(row, shape)
    if name == "full_slip":
        values = values != 0.0
    return values if shape else values.item()
