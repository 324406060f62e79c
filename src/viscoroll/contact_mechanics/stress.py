"""Pressure and shear stress along the contact: :func:`stress`; and contacts by method
"coupled", fields and tractions of states, each from its row (:mod:`.coupled_pair`).

Numbers of equations are those of A. A. Zobova and I. G. Goryacheva, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.  l0 is the contact length at rest of half-spaces, kappa = R/l0, mu
the coefficient of friction; lam is the contact length over l0, epsilon its shift ahead of the axis
over half the length, beta the part of it that sticks, zeta half the transit time in the unit of
time of the material, alpha the instantaneous over the long-time modulus.
"""

import functools
import itertools
import math
from typing import Any, Literal, overload

import numpy as np

from ..core import (
    Floats,
    Numbers,
    ParameterError,
    Values,
    block_reader,
    broadcast_shape,
    check_array,
    check_choice,
    check_one_given,
    divide_by_unit,
    run_blocks,
    strip_labels,
)
from ..laws import CoverModes, half_line_rule, pressure, series_record
from ..materials import Cover, layer_excess, total_series
from .contact_table import complete, computed_fields, evaluate_contact, refuse_overflow
from .coupled_pair import CoupledRow, pair_of_scene, wave_compliance
from .model_warnings import warn_of_contact
from .parameters import Parameters, Roller, resolve_model

# --- Contacts by method "coupled" ---

#: points of Gauss's rule in an element
_GAUSS = 5
#: first, last and step of s, with half length times wave number ln(1 + e^s): the transform of the
#: pressure, squared, falls like the third power
_WAVES = -25.0, 80.0, 0.12


#: States of a pair at one speed, which are kept for later calls.
_coupled_row = functools.lru_cache(maxsize=16)(CoupledRow)


def _broadcast_states(
    scene: Parameters, V: Floats, creep: Floats, creep_is_omega: bool
) -> tuple[tuple[int, ...], Floats]:
    """Broadcast and check the states of a call.

    scene: dimensionless parameters, of which kappa and mu, numbers or arrays, are read.
    V: speeds, dimensionless, any sign.
    creep: omega if ``creep_is_omega``, else the creepage delta.
    Returns (the shape to which they broadcast, of n elements; the states, (8, n), dimensionless:
    u = kappa |V|, mu, kappa, V, the sign of V, 1.0 of 0, the slip omega - V, the creepage delta,
    infinite for omega other than 0 at V = 0, and the reduced creepage 2 kappa delta).
    Raises ParameterError for kappa |V| that is too large, and shapes that do not broadcast.
    """
    arrays = {
        "kappa": scene.kappa,
        "mu": scene.mu,
        "V": V,
        "omega" if creep_is_omega else "delta": creep,
    }
    shape = broadcast_shape(**arrays)
    refuse_overflow(scene.kappa, V)
    kappa, mu, V, given = (np.broadcast_to(each, shape).ravel() for each in arrays.values())
    sign = np.where(V < 0.0, -1.0, 1.0)
    if creep_is_omega:
        slip = given - V
        # at V = 0 infinite, with the sign of the slip, and 0/0 without slip, which is 0
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            delta = np.where(slip == 0.0, 0.0, slip / np.abs(V) * sign)
    else:
        slip = given * V
        delta = given
    with np.errstate(over="ignore"):
        reduced = 2.0 * kappa * delta
    return shape, np.array([kappa * np.abs(V), mu, kappa, V, sign, slip, delta, reduced])


def evaluate_coupled(
    scene: Parameters, V: Floats, creep: Floats, creep_is_omega: bool, names: tuple[str, ...]
) -> dict[str, Any]:
    """Return dimensionless fields of the contact by name, with pressure and shear solved together.

    scene: dimensionless parameters of one material; kappa and mu may be arrays.
    V, creep, creep_is_omega, names: as in :func:`.contact_table.evaluate_contact`.
    Returns a dict as that function does.
    Raises ParameterError for several materials, kappa |V| above 1e300, and the depth of a
    half-space; ConvergenceError where a state has no solution.
    """
    pair = pair_of_scene(scene)
    if "depth" in names and any(math.isinf(body.thickness) for body in pair):
        allowed = (
            "left out: the indentation of a half-space by a line load is infinite (it is finite if "
            "each body is rigid or has a thickness)"
        )
        raise ParameterError("fields", "'depth'", allowed)
    shape, states = _broadcast_states(scene, V, creep, creep_is_omega)
    # states of one kappa |V| and mu share the onsets of full slip, which are solved once
    rows, row_of_state = np.unique(states[:2], axis=1, return_inverse=True)
    computed = computed_fields(names, unlike=True)
    out = np.empty((len(computed), states.shape[1]))

    def work(n: int, _: int) -> None:
        """Compute the states of the n-th row and write them into their columns of ``out``."""
        which = row_of_state.ravel() == n
        row = _coupled_row(pair, *rows[:, n].tolist())
        fields = _fields_of_row(row, states[:, which], computed)
        for values, name in zip(out, computed):
            values[which] = fields[name]

    run_blocks(work, rows.shape[1], 1)
    return complete(names, computed, out, shape)


def _fields_of_row(row: CoupledRow, states: Floats, names: tuple[str, ...]) -> dict[str, Any]:
    """Return the fields of states that have kappa |V| and mu in common.

    row: the :class:`.coupled_pair.CoupledRow` of these.
    states: these states, (8, n), as of :func:`_broadcast_states`.
    names: requested fields; depth and delta_0, which take longer, are computed only if requested.
    Returns name -> values, (n,) or one number for all, dimensionless.
    Raises ConvergenceError where a state has no solution.
    """
    _, mu, kappa, V, sign, slip, delta, creep = states
    found = row.states(creep, apart=True)
    row.refuse_unsolved(found.status, creep)
    # V over 2 kappa, as works are times 2 kappa; moments are times kappa
    half = 0.5 * np.abs(V) / kappa
    strain = found.work_base + found.work_cylinder
    low, high = row.onsets()
    with np.errstate(divide="ignore", over="ignore"):
        zeta = 0.5 * found.lam / row.u
    fields = found._asdict() | {
        "zeta": zeta,
        "delta": delta,
        "delta_minus": 0.5 * low / kappa,
        "delta_plus": 0.5 * high / kappa,
        "delta_star": 0.25 * (high - low) / kappa,
        "full_slip": (creep <= low) | (creep >= high),
        "Q": sign * mu * found.Q_over_mu,
        "grip": 1.0 - np.abs(found.Q_over_mu),
        "M_half_space": sign * found.kM_base / kappa,
        "M_cylinder": sign * found.kM_cylinder / kappa,
        "loss_slip": sign * slip * mu * found.Q_over_mu - half * strain,
        "loss_half_space": half * (2.0 * found.kM_base + found.work_base),
        "loss_cylinder": half * (2.0 * found.kM_cylinder + found.work_cylinder),
    }
    fields["M"] = fields["M_half_space"] + fields["M_cylinder"]
    if "delta_0" in names:
        fields["delta_0"] = 0.5 * row.free_creep() / kappa
    if "depth" in names:
        fields["depth"] = np.array([depth(row, each) for each in creep.tolist()]) / kappa
    return fields


def depth(row: CoupledRow, creep: float) -> float:
    """Return the approach of two bodies in one state, each rigid or a layer on a rigid body.

    It is the mean, weighted by the pressure, of the displacement of both surfaces (by Parseval's
    theorem) plus that of the cylinder's profile x^2/2.

    row: the row of the state, each of whose bodies has a finite thickness.
    creep: its reduced creepage 2 kappa delta.
    Returns the approach divided by l0^2/R, a float, positive where the bodies have come closer than
    at their first touch.
    """
    profile = row.profile(creep)
    half = 0.5 * np.ptp(profile.nodes)
    k, weights = half_line_rule(_WAVES[2], 1.0 / half, _WAVES[:2])
    p, q = (transforms(profile.nodes, each, k) for each in (profile.p, profile.q))
    total = 0.0
    for body in row.pair:
        compliance = wave_compliance(body, row.u, k)
        L, _, C = layer_excess(body.nu, k * body.thickness)
        coupling = 1j * body.sign * (body.local + C) * q * np.conj(p)
        work = compliance / k * ((1.0 + L) * np.abs(p) ** 2 + coupling)
        total += body.share * float(weights @ work.real) / np.pi
    # x is counted from the axis
    x, weights = _element_points(profile.nodes)
    pressure = np.interp(x, profile.nodes, profile.p) * weights
    square = pressure @ (x + profile.shift) ** 2
    return float((total + 0.5 * square) / pressure.sum())


def _element_points(nodes: Floats) -> tuple[Floats, Floats]:
    """Return points and weights of Gauss's rule in each element between ascending nodes, (m,)
    each, in the unit of ``nodes``, (n,).
    """
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    halves = 0.5 * np.diff(nodes)[:, None]
    return (nodes[:-1, None] + halves * (1.0 + points)).ravel(), (halves * weights).ravel()


def transforms(nodes: Floats, values: Floats, k: Floats) -> Any:
    """Return the Fourier transform int f(x) exp(-i k x) dx of a function f that is linear between
    nodes.

    nodes, values: ascending x divided by l0, and f there, (n,) each.
    k: wave numbers times l0, (m,).
    Returns complex numbers, (m,), in the unit of f, by Gauss's rule in each element.
    """
    x, weights = _element_points(nodes)
    return np.exp(-1j * np.multiply.outer(k, x)) @ (np.interp(x, nodes, values) * weights)


def coupled_stress(
    scene: Parameters, x: Floats, V: Floats, creep: Floats, creep_is_omega: bool
) -> Floats:
    """Return pressure and shear stress on the cylinder along +x.

    scene, V, creep, creep_is_omega: as in :func:`evaluate_coupled`.
    x: distance ahead of the axis, divided by l0; broadcasts with the states.
    Returns p and tau divided by E', rows of an array, each of the broadcast shape; 0 outside the
    contact.
    Raises as :func:`evaluate_coupled`.
    """
    pair = pair_of_scene(scene)
    shape_of_states, states = _broadcast_states(scene, V, creep, creep_is_omega)
    number = np.arange(states.shape[1]).reshape(shape_of_states)
    shape = broadcast_shape(x=x, V=number)
    number = np.broadcast_to(number, shape)
    x = np.broadcast_to(x, shape)
    out = np.empty((2, *shape))
    for n, (u, mu, kappa, _, sign, *_, reduced) in enumerate(states.T.tolist()):
        found = _coupled_row(pair, u, mu).profile(reduced)
        of_state = number == n  # mask of the points of the n-th state
        # from the middle of the contact, of a motion along +x; for V < 0 all is mirrored
        y = sign * x[of_state] - found.shift
        # tractions are over E'/(4 pi kappa)
        both = [np.interp(y, found.nodes, each) for each in (found.p, found.q)]
        out[:, of_state] = np.array(both) / (4.0 * np.pi * kappa)
        out[1, of_state] *= sign
    return out


# --- Pressure and shear stress along the contact ---

Method = Literal["table", "coupled"]
#: Points of a block: some milliseconds of work.
_BLOCK = 1 << 15


@overload
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    delta: Numbers,
    method: Method = "table",
) -> Values: ...
@overload
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    omega: Numbers,
    method: Method = "table",
) -> Values: ...
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    method: Method = "table",
) -> Values:
    """Compute pressure and shear stress along the contact of a rolling cylinder and its base, Eqs.
    (11)-(14).

    The equations are those of Zobova and Goryacheva (2020), with the functions of the bodies at
    hand (docs/theory.md).  The contact is that of steady rolling at a given speed and creepage,
    whose lengths and slip :func:`contact` gives.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used; or a
        :class:`Cylinder`, in SI units.
    x : position divided by l0, of a Cylinder in m, from the point below the axis, positive in the
        direction of a positive V; any value: the stresses are 0 outside the contact.
    V : velocity of the axis, any sign; of a Cylinder m/s, of a Scene divided by R/T_ref.  T_ref is
        the unit of time: T_epsilon of a Scene with ``alpha``, else the time in which the material
        counts.
    delta, omega : exactly one: creepage (omega R - V)/V, or angular velocity, any sign; omega of a
        Cylinder in rad/s, of a Scene multiplied by T_ref.  At V = 0 a delta means the limit V ->
        0+, an omega other than 0 full slip.  All arguments broadcast.
    method : "table", or "coupled" (:func:`contact`), with which bodies whose shear acts on the
        pressure have a shear stress too.

    Returns
    -------
    Values
        ``p``: pressure, >= 0.  ``tau``: shear stress on the cylinder in the direction of +x, of the
        sign of omega R - V (at V = 0 of delta), 0 for delta = 0; |tau| <= mu p, with equality in
        the slip zone and, in full slip, in the whole contact.  Both are in Pa of a Cylinder, else
        divided by E', and 0 outside the contact.  By method "table" there is ``p`` alone, without
        the effect of shear, for layers of finite thickness, and for half-spaces with Dundurs'
        constant above 0.05 (unless ``coupled=False``).  Both have the broadcast shape of arguments
        and roller; they are floats if all of these are numbers.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300, both or neither of delta and omega, shapes
        that do not broadcast, labelled arrays beside plain ones or with other coordinates, a unit
        of another dimension; what is no scene and no cylinder; a layer too thin for its law, times
        of a material beyond 1e-100 to 1e100 T_ref.

    Warns
    -----
    ModelWarning
        Of a Cylinder, as :func:`contact`: a contact longer than the radius, or outside of the
        measured band.

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> x = np.linspace(-0.01, 0.01, 201)  # m
    >>> found = vr.stress(vr.presets.RUBBER_CYLINDER, x, 0.1, delta=0.001)
    >>> bool(found.p.max() > 0.0)
    True

    Notes
    -----
    The error relative to the peak is below 1e-11 for alpha zeta from 1e-8 to 1e8
    (``tests/test_stress.py``).  Where V or the creepage are arrays, each contact state (each
    combination of V and creepage) takes 56 bytes, beside the result.
    """
    _, scene, scale = resolve_model(roller, "stress")
    creep_name = check_one_given(delta=delta, omega=omega)
    check_choice("method", method, "table", "coupled")
    given, labels = strip_labels(
        {"x": x, "V": V, creep_name: omega if delta is None else delta}, scale
    )
    given = {name: check_array(name, value) for name, value in given.items()}
    position, speed, creep = given.values()
    if scale.si:
        warn_of_contact(roller, speed)
        # A position that overflows lies outside the contact, a speed that overflows is refused.
        with np.errstate(over="ignore"):
            position = divide_by_unit("x", position, scale["length"])
            speed = divide_by_unit("V", speed, scale["V"])
            creep = divide_by_unit(creep_name, creep, scale[creep_name])
    find = coupled_stress if method == "coupled" else _stress_of_law
    stresses = find(scene, position, speed, creep, delta is None)
    stresses *= scale["p"]  # in place: a copy would double the memory of a large call
    found = {name: part if part.ndim else part.item() for name, part in zip(("p", "tau"), stresses)}
    long_name = "place along the contact, from the point below the axis" + ", divided by l0" * (
        not scale.si
    )
    own = {"x": {"long_name": long_name, "equation": "Eq. (11)"}}
    return Values(found, given, own, "Stresses", si=scale.si, labels=labels)


def _stress_of_law(
    scene: Parameters, x: Floats, V: Floats, creep: Floats, creep_is_omega: bool
) -> Floats:
    """Return pressure and shear stress by the fast law, without a table of the coupled solution.

    scene: dimensionless parameters of one material; kappa and mu may be arrays.
    x: distance ahead of the axis, divided by l0; broadcasts with the states.
    V: speeds, dimensionless, any sign.
    creep: omega if ``creep_is_omega``, else the creepage delta.
    Returns p and tau divided by E', rows of an array, each of the broadcast shape; p alone of a
    cover and of half-spaces whose states are those of the coupled solution.
    """
    from ..kernels.law.modes import Points, new_memory_weights, stress_loop

    rows = 1 if scene.tabulated or scene.cover is not None else 2
    scene = scene.uncoupled
    names = "lam", "epsilon", "beta", "zeta", "delta"
    found = evaluate_contact(scene, V, creep, creep_is_omega, names)
    lam, epsilon, beta, zeta, delta = found.values()
    # For V < 0 positions are mirrored, and tau changes its sign.
    mirror = np.where(V < 0.0, -1.0, 1.0)
    many = scene.material_array
    alpha = scene.alpha if many is None else np.arange(len(many), dtype=float)
    # first the fields of Points in their order; an array of materials has their indices for alpha
    state = (scene.kappa, scene.mu, lam, epsilon, beta, zeta, alpha)
    arrays = [np.asarray(value, float) for value in (x, *state, mirror, np.sign(delta) * mirror)]
    shape = broadcast_shape(x=x, V=arrays[3])  # lam has the shape of the states
    read_x, *readers, read_alpha, read_mirror, read_sign = (
        block_reader(array, shape) for array in arrays
    )
    out = np.empty((2, math.prod(shape)))
    p, tau = out

    def work(start: int, stop: int) -> None:
        """Compute p/E' and the signed tau/E' at points ``start`` to ``stop`` - 1 of the flattened
        broadcast shape, and write them into these elements of ``p`` and ``tau``; of a cover p
        alone.  Consecutive points of one material are computed together.
        """
        mirrored = read_mirror(start, stop) * read_x(start, stop)
        mirrored.flags.writeable = False  # as all arrays that kernels read (block_reader)
        points: Any = Points(mirrored, *(read(start, stop) for read in readers))
        alphas = read_alpha(start, stop)
        material: Any = scene.material
        ends: Any = [] if many is None else 1 + np.flatnonzero(np.diff(alphas))
        for first, last in itertools.pairwise([0, *ends, stop - start]):
            part = points._make(each[first:last] if each.size > 1 else each for each in points)
            here = slice(start + first, start + last)
            if many is not None:
                material = many[int(alphas[min(first, alphas.size - 1)])]
            if isinstance(material, Cover):
                p[here] = _cover_pressure(material, part)
                continue
            series, own = series_record(alphas if material is None else total_series(material))
            stress_loop(
                series,
                own,
                new_memory_weights(series),
                new_memory_weights(series),
                part,
                p[here],
                tau[here],
            )
        if scene.cover is None:  # else tau is not computed
            # + 0: outside the contact 0, not -0
            tau[start:stop] = read_sign(start, stop) * tau[start:stop] + 0.0

    run_blocks(work, p.size, _BLOCK)
    return out.reshape(2, *shape)[:rows]


def _cover_pressure(cover: Cover, points: Any) -> Floats:
    """Return p/E' at points on a cover, by one solve of the contact of the layer for each different
    state.

    cover: one :class:`.bodies.Cover`.
    points: record :class:`.modes.Points`, of which position (divided by l0, in the
        frame where V > 0), kappa, lam, epsilon and zeta (infinite at V = 0) are used, (n,) or (1,).
    Returns p/E', dimensionless, >= 0 to rounding, 0 outside the contact, a new array (n,), where n
    is the common length of these fields.
    """
    modes = CoverModes(cover)
    x, *state = np.broadcast_arrays(points.x, points.kappa, points.lam, points.epsilon, points.zeta)
    states_of_contact, which = np.unique(np.array(state), axis=1, return_inverse=True)
    found = np.empty(x.size)
    for n, (kappa, lam, epsilon, zeta) in enumerate(states_of_contact.T.tolist()):
        of_state = which.ravel() == n  # mask of the points of the n-th state
        # from the middle, in half lengths; 2 P/(pi a) over E' is 1/(8 pi kappa lam), as a = lam
        # l0/2 and l0^2 = 32 P R/E'
        y = 2.0 * x[of_state] / lam - epsilon
        found[of_state] = pressure(modes, zeta, 0.5 * lam, y) / (8.0 * np.pi * kappa * lam)
    return found
