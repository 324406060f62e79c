"""The public contact law: :func:`contact`.

Checks and broadcasts the input, chooses the method, and asks the kernels for no more than
the fields that were named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from .blocks import elements, run_blocks, solve_blocks
from .checks import broadcast_shape, checked_extent
from .contact_fields import OF_BODIES, SLOPES, SLOPES_OF_BODIES, UNSTEADY, field_names
from .errors import ParameterError, one_of
from .labels import unlabelled
from .materials.bodies import Bodies
from .materials.bodies_array import BodiesArray
from .materials.prony import Prony
from .materials.prony_array import MaterialArray
from .materials.tables import inverses, record, unsteadiness
from .results import Values
from .scene import Scene, checked_scene
from .typed import Numbers

#: of bodies that are alike, half of each
_HALVES = dict(zip(OF_BODIES + SLOPES_OF_BODIES, ("M", "M", "dM_dV", "dM_dV"), strict=True))
_NEEDS_STICK = {"beta", "Q", "dQ_dV", "dQ_ddelta", "dQ_domega"}
_NEEDS_SHIFT = _NEEDS_STICK | {"epsilon", "delta_star", "delta", "full_slip"}
#: slopes over a speed, which follows the unit of time
_PER_SPEED = {"zeta", "dQ_dV", "dQ_domega", "dM_dV", *SLOPES_OF_BODIES}
_BLOCK = 1 << 15
#: where each has a material of its own, which costs tens of microseconds and some kilobytes
_BLOCK_EACH = 1 << 8
#: states from which on those of one alpha are read from tables, which cost as much as some hundreds without
WORTHWHILE = 4096
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
    method : "table" (the explicit law on tabulated Bessel ratios) or "direct" (the paper's
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
    Accuracy of method "table": 1e-13 relative in lam, epsilon, delta_star, M and Q for
    alpha in [1, 1e4], kappa V in [1e-7, 1e5]; beta likewise times 1/(1 - |delta|/delta_star),
    its condition number (``tests/test_contact.py``, ``tests/materials/test_material_tables.py``).  Parts of M in two
    bodies: 1e-13 of M (``tests/kernels/material/test_pair.py``).  N, away from its zero: 2e-11 relative for one
    mode and series over four decades (``tests/kernels/law/test_unsteady.py``).

    From 4096 states on with one alpha > 1, and no slopes, the law is read from polynomials of one
    variable, which are made where they are met and kept for later calls; only threads that share
    a call, of more than 32,768 states, make them anew in each.  Such a call agrees with
    calls of single states to 2e-14 and not bit for bit; full slip begins at the delta_star that
    the call reports, within 16 units in the last place of the other.  Either way a state's
    result depends on nothing else in the call but the number of states and the fields.

    Beside float64 input and its result a call takes a few megabytes, whatever the sizes and
    however they broadcast (``tests/test_hostile.py``).
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
    material, unit = scene.in_own_time()
    if scene.material is not None and method == "direct":
        raise ParameterError("method", "'direct'", "'table': the printed equations know one relaxation time")
    if unit != 1.0:
        arrays |= {name: arrays[name] * unit for name in ("V", "omega") if name in arrays}
    one = one_material(scene, material, names)
    if isinstance(one, MaterialArray):
        arrays["alpha"] = np.arange(len(one), dtype=np.float64)
    # what the kernels are asked for, and what is half of it
    halved = {} if isinstance(one, Bodies | BodiesArray) else {name: _HALVES[name] for name in names if name in _HALVES}
    asked = ("zeta" if name == UNSTEADY else halved.get(name, name) for name in names)
    solved = tuple(dict.fromkeys(asked))
    found = _compute(one, list(arrays.values()), shape, creep_name == "omega", solved, method)
    rows = dict(zip(solved, found, strict=True))
    rows |= {name: 0.5 * rows[whole] for name, whole in halved.items()}
    if UNSTEADY in names:
        if isinstance(one, MaterialArray):
            raise ParameterError("fields", repr(UNSTEADY), "asked for with one material, as material[i]")
        rows[UNSTEADY] = _unsteady(material, arrays["alpha"], rows["zeta"], shape) * unit**2
    for name in _PER_SPEED & rows.keys():
        rows[name] *= unit
    given = {"V": V, creep_name: omega if delta is None else delta}
    return Values({name: shaped(name, rows[name], shape) for name in names}, given, labels=labels)


def _unsteady(material: Any, alpha: NDArray, zeta: NDArray, shape: tuple[int, ...]) -> NDArray:
    """N at every zeta, in the material's own time."""
    found, alphas = np.empty(zeta.size), elements(alpha, shape)

    def work(start: int, stop: int) -> None:
        given = material if isinstance(material, Prony) else alphas(start, stop)
        found[start:stop] = unsteadiness(given, zeta[start:stop])

    run_blocks(work, zeta.size, _BLOCK)
    return found


def one_material(scene: Scene, material: Any, names: tuple[str, ...]) -> Prony | MaterialArray | Bodies | None:
    """What serves all states: a series; many series or pairs; bodies that differ, for parts of M; or, None, alphas."""
    if isinstance(material, MaterialArray):
        return material
    if not isinstance(material, Prony):
        return None
    if scene.like_bodies or not _HALVES.keys() & set(names):
        return material
    assert isinstance(scene.material, Bodies)
    return scene.material.in_own_time()[0]


def refuse_overflow(kappa: NDArray, V: NDArray, fastest: float = _FASTEST) -> None:
    """Raise ParameterError where kappa |V| leaves the range of doubles, or nearly (zeta would be 0), or that given."""
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > fastest:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {fastest:g}")


def _compute(
    material: Any,
    arrays: list[NDArray],
    shape: tuple[int, ...],
    creep_is_omega: bool,
    names: tuple[str, ...],
    method: str,
) -> NDArray:
    """The fields ``names`` by ``method``, a row each, of alpha, kappa, mu, V and the creep broadcast to ``shape``.

    ``material``: a series or bodies in place of the alphas, or None; or many of them, with their numbers in place of
    the alphas.
    """
    from .kernels.law.state import ROWS, Need, States

    wanted = set(names)
    need = Need(
        bool(wanted & _NEEDS_SHIFT), bool(wanted & _NEEDS_STICK), "beta" in wanted,
        bool(wanted & {"M", "dM_dV", *_HALVES}), bool(wanted & set(SLOPES + SLOPES_OF_BODIES)),
    )  # fmt: skip
    count = int(np.prod(shape))
    rows = np.array([ROWS.index(name) for name in names], dtype=np.int64)
    out = np.empty((len(names), count))
    loop = _chosen_loop(material, arrays[0], need.slopes, count, method)
    alphas, *parts = (elements(array, shape) for array in arrays)

    def solve(start: int, stop: int) -> int:
        found = np.empty((len(names), stop - start))
        kappa, mu, V, creep = (part(start, stop) for part in parts)
        states = States(kappa, mu, V, creep, creep_is_omega)
        status: int = loop(alphas(start, stop), states, need, rows, found, 0, stop - start)
        out[:, start:stop] = found
        return status

    block = _BLOCK_EACH if isinstance(material, MaterialArray) else _BLOCK
    solve_blocks(solve, count, block, f"contact: an iteration hit its cap near element {{}} (method {method!r})")
    return out


def _chosen_loop(material: Any, alpha: NDArray, slopes: bool, count: int, method: str) -> Callable:
    """The kernel for a call, which takes the alphas of a block in place of its material."""
    from .kernels.law.contact_loop import contact_loop, state_loop
    from .kernels.law.lockstep import TOGETHER
    from .kernels.material.functions import Own

    if isinstance(material, MaterialArray):
        from .contact_each import states_each

        return states_each(material, _PER_SPEED)
    if method == "direct":
        from .kernels.printed.loop import direct_loop

        return lambda alphas, *rest: direct_loop(Own(alphas), *rest)
    # at alpha = 1 the law has closed forms
    if count >= WORTHWHILE and alpha.size == 1 and alpha.item() > 1.0 and not slopes:
        from .kernels.law.inverse_loop import inverse_loop

        return lambda alphas, *rest: inverse_loop(inverses(material or alphas.item()), *rest)
    if material is not None:
        return lambda alphas, *rest: state_loop(record(material), *rest)
    loop = state_loop if count < TOGETHER else contact_loop
    return lambda alphas, *rest: loop(Own(alphas), *rest)


def shaped(name: str, row: NDArray, shape: tuple[int, ...]) -> Any:
    """A row of a kernel in the shape of the call; a number where that is ()."""
    values = np.reshape(row, shape)
    if name == "full_slip":
        values = values != 0.0
    return values if shape else values.item()
