"""States of the contact and stresses along it, at given speeds and creepages.

The public contact law: :func:`contact`, the state of the contact at given speeds and creepages.

Numbers of equations are those of the paper: A. A. Zobova and I. G. Goryacheva, Dynamics of a
viscoelastic cylinder on a viscoelastic half-space, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.

Pressure and shear stress along the contact: :func:`contact`.

Numbers of equations are those of A. A. Zobova and I. G. Goryacheva, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.  l0 is the contact length at rest of half-spaces, kappa = R/l0, mu
the coefficient of friction; lam is the contact length over l0, epsilon its shift ahead of the axis
over half the length, beta the part of it that sticks, zeta half the transit time in the unit of
time of the material, alpha the instantaneous over the long-time modulus.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Any, Literal, overload

import numpy as np

from ..core import (
    DIMENSIONS,
    Floats,
    Numbers,
    Values,
    block_reader,
    broadcast_shape,
    check_array,
    check_array_extent,
    check_bool,
    check_choice,
    check_one_given,
    divide_by_unit,
    run_blocks,
    strip_labels,
)
from ..laws import CoverModes, pressure, series_record
from ..materials import Cover, total_series
from .assumptions import moment_error, transit_frequency
from .contact_table import ACCURACY, NOT_IN_GRIDS, evaluate_contact, field_names
from .model_warnings import warn_of_contact
from .parameters import Parameters, Roller, resolve_model

# --- The public contact law ---


@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct", "coupled"] = "table",
) -> Values: ...
@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    omega: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct", "coupled"] = "table",
) -> Values: ...
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Literal["table", "direct", "coupled"] = "table",
) -> Values:
    """Compute contact length, creep force and rolling moment of a viscoelastic cylinder that rolls
    on a half-space.

    Both bodies are viscoelastic, or one of them is elastic, rigid, or a layer of finite thickness.
    The contact is that of steady rolling with partial or full slip at a given speed and creepage:
    Eqs. (6)-(10) and (15)-(18) of Zobova and Goryacheva (2020).  For bodies that their paper does
    not treat (a Prony series, two materials, a layer) the equations are theirs with the functions
    of these bodies (docs/theory.md).

    V, delta and omega broadcast against each other and against array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, everything
        dimensionless; or a :class:`Cylinder`, in SI units per m of its length.
    V : velocity of the axis, any sign; of a Cylinder in m/s, of a Scene divided by R/T_ref.  T_ref
        is the unit of time: T_epsilon of a Scene with ``alpha``, else the time in which the
        material counts.
    delta, omega : exactly one of the two, any sign: the creepage (omega R - V)/V, dimensionless; or
        the angular velocity, of a Cylinder in rad/s, of a Scene multiplied by T_ref.
        At V = 0 a given ``delta`` means the limit V -> 0+; a given ``omega`` other than 0 means
        full slip, and 0 means delta = 0.
    fields : a name or several names of fields to compute; None: the default fields.  Dimensionless
        ones:
        ``lam``: contact length divided by l0, the contact length at rest of half-spaces;
        ``epsilon``: shift of the contact towards the leading edge in half contact lengths, 0 at V =
        0;
        ``delta_star``: critical creepage, > 0: half the distance of ``delta_minus`` and
        ``delta_plus``;
        ``delta``: creepage; infinite with the sign of omega at V = 0 with omega other than 0, and
        where omega R/V exceeds the doubles;
        ``full_slip``: whether delta is beyond ``delta_minus`` or ``delta_plus``;
        ``beta``: length of the stick zone divided by the contact length, 0 in full slip, 1 where
        Q = 0.  Those with a unit of their own, by which those of a Scene are divided:
        ``zeta``: half the transit time, T_ref or s; infinite at V = 0, and where lam/V exceeds the
        doubles;
        ``Q``: force on the cylinder by friction, positive in the direction of a positive V, of the
        sign of delta V, at V = 0 of delta (of a layer with delta - delta_0 for delta); P or N/m; in
        full slip |Q| = mu P;
        ``M``: rolling resistance moment, of the sign of V, 0 at V = 0 and of elastic bodies; P R or
        N m/m.  Of a layer it has a part by Q too, of either sign, as shear acts back on the
        pressure; so have lam and epsilon.  These nine are the default.  Bodies that differ, and
        every Cylinder, add ``M_half_space`` and ``M_cylinder``, the parts of M by the losses in
        either body; a Cylinder adds ``length``, the contact length in m, and ``C_rr`` = M/(P R),
        the coefficient of rolling resistance; a layer adds ``delta_0``, the creepage at which Q =
        0, caused by the strain under the pressure.
        Fields by name alone: of a Cylinder ``M_error``, the accuracy of M by the data of its
        materials as +-, relative, infinite outside their band, NaN where not known
        (:meth:`viscoroll.Measured.moment_error`); ``grip``, the friction reserve 1 - |Q|/(mu P)
        without loss of digits, 0 in full slip;
        ``N``, the added mass of slow speed changes, in which the moment is M(V) + N dV/dt (P
        T_ref^2 or N s^2/m), not known of layers and of arrays of materials; ``delta_minus`` and
        ``delta_plus``, the creepages at and beyond which the whole contact slips backwards or
        forwards, -delta_star and delta_star but for layers; and each slope below.
    slopes : whether ``dQ_dV``, ``dQ_ddelta``, ``dQ_domega`` and ``dM_dV`` are computed in addition,
        and of bodies that differ ``dM_half_space_dV`` and ``dM_cylinder_dV``; of a layer also
        ``dM_ddelta``, ``dM_domega`` and those over omega of either body.  ``dQ_dV``, and of a layer
        slopes of M over V, are at fixed delta or fixed omega, whichever was given, the others are
        at fixed V.  In full slip the slopes of Q are 0.  Where full slip begins Q has a corner over
        V, and the slopes there are those of full slip.  In partial slip at V = 0 ``dQ_domega`` is
        infinite, and where omega = 0 was given ``dQ_dV`` is -infinite.
    method : "table" (from the rows of the law: no equation is solved) or "direct" (the equations as
        the paper prints them, solved by Brent-Dekker), which has no slopes, N, grip, delta_0
        and onsets, and takes an alpha alone, no material.  Or "coupled": pressure and shear are
        solved together by boundary elements, for any two bodies, layers or half-spaces, each rigid,
        elastic or relaxing, of one material.  Zones of stick and slip are found, not assumed.  Its
        fields are of these bodies at any coupling: ``delta_minus``, ``delta_plus``, and the powers
        lost,
        ``loss_slip``, ``loss_half_space`` and ``loss_cylinder``, whose sum is V (M + delta Q), over
        P R/T_ref or W/m.  ``depth`` by name alone is the approach of the
        bodies where each is a layer or rigid, over l0 or m.  It has no slopes and no N.

    Returns
    -------
    Values
        The fields as attributes and by ``[name]``: those of ``fields`` in their order, then the
        slopes.  Each is an array of the broadcast shape; if all inputs are numbers it is a float,
        ``full_slip`` a bool.  Arguments of xarray or pandas give results with their labels.  Of a
        Cylinder slopes have the unit of Q or M divided by m/s, by rad/s, or by 1.  Force and moment
        on the cylinder, Eqs. (20) and (21), are Q - M_half_space/R and Q R + M_cylinder.
        ``epsilon`` may exceed 1: the contact then lies wholly ahead of the axis.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300 (for Q by method "direct" above 1e12), both or
        neither of delta and omega, an unknown field or method, a field or method that these bodies
        do not have, a ``slopes`` that is no truth value, shapes that do not broadcast, labelled
        arrays beside plain ones or with other coordinates, a unit of another dimension; what is no
        scene and no cylinder; a layer too thin for its law (half the contact at rest longer than
        six thicknesses), times of a material beyond 1e-100 to 1e100 T_ref; ``$VISCOROLL_THREADS``
        that is no whole number >= 1.
    ConvergenceError
        Method "direct": an iteration reached its limit.  Method "coupled": a state has no solution,
        which is named.

    Warns
    -----
    ModelWarning
        Of a Cylinder: its contact at rest is longer than its radius, or the transit frequency is
        outside the band in which its material was measured.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2
    ... )
    >>> state = roller.contact(0.01, omega=0.099)
    >>> traction, moment = state.Q, state.M

    Notes
    -----
    Accuracy of method "table" for one material (one alpha, a series or two bodies): the relative
    error of delta_star, M and Q is below 5e-15, that of the parts of M too, relative to M.  For lam
    and epsilon it is 5e-15, and 1.5e-14 and 3e-14 in one octave of speed at alpha from 20 to 35.
    This holds for any speed and creepage (``tests/materials/test_law_table.py``).  Where each state
    has its own alpha or material it is 1e-13 for alpha in [1, 1e4] and kappa V in [1e-7, 1e5].  The
    error of beta is that of lam times 1/(1 - |delta|/delta_star), its condition number, and the
    error of grip twice that.  The error of N is 2e-14 of its largest value
    (``tests/kernels/rows/test_unsteady.py``).

    The law of one material is evaluated from polynomials of one variable
    (:mod:`.law_table`), which are computed at first use, in some milliseconds for
    half-spaces, and kept.  The result of a state does not depend on other states of the call.

    Method "coupled" is good to 3e-4 mu P in Q, 2e-5 in kappa M and 1e-4 in lam and epsilon, where
    alpha is above 100 and u T/alpha is short beside the contact to 5e-5 and 5e-4
    (``tests/contact_law/test_coupled.py``).  It takes some 2 ms a state, and 50 ms for each
    kappa |V|.

    Beside float64 input and its result a call takes a few megabytes, for any sizes and any
    broadcasting (``tests/test_invariance.py``).
    """
    _, scene, scale = resolve_model(roller, "contact")
    creep_name = check_one_given(delta=delta, omega=omega)
    if slopes is not False:
        slopes = check_bool("slopes", slopes)
    like = scene.like_bodies
    cover = scene.tabulated or isinstance(scene.material, Cover)
    names = field_names(fields, slopes, method, like=like, si=scale.si, cover=cover)
    law = scene._law
    if fields is None and law is not None and law.coupled is not None and not law.coupled.graded:
        names = tuple(name for name in names if name not in NOT_IN_GRIDS)
    given, labels = strip_labels({"V": V, creep_name: omega if delta is None else delta}, scale)
    speed, ends = check_array_extent("V", given["V"])
    creep, _ = check_array_extent(creep_name, given[creep_name])
    given = {"V": speed, creep_name: creep}
    about = None
    if scale.si:
        warn_of_contact(roller, speed, ends)
        about = roller.about
        speed = divide_by_unit("V", speed, scale["V"])
        creep = divide_by_unit(creep_name, creep, scale[creep_name])
    if method == "coupled":
        from .coupled_contact import evaluate_coupled

        found = evaluate_coupled(scene, speed, creep, delta is None, names)
    else:
        found = evaluate_contact(scene, speed, creep, delta is None, names, method)
    if scale.si:
        if ACCURACY in found:
            frequency = transit_frequency(given["V"], found[ACCURACY] * scale["length"])
            found[ACCURACY] = moment_error(frequency, roller.body_data.records)[()]
        found = {
            name: value * scale[name] if name in DIMENSIONS else value
            for name, value in found.items()
        }
    return Values(found, given, si=scale.si, labels=labels, about=about)


# --- Pressure and shear stress along the contact ---

#: Points of a block: some milliseconds of work.
_BLOCK = 1 << 15


@overload
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    delta: Numbers,
    method: Literal["table", "coupled"] = "table",
) -> Values: ...
@overload
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    omega: Numbers,
    method: Literal["table", "coupled"] = "table",
) -> Values: ...
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    method: Literal["table", "coupled"] = "table",
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
    method : "table", or "coupled" (:func:`contact`), with which layers have a shear stress too.

    Returns
    -------
    Values
        ``p``: pressure, >= 0.  ``tau``: shear stress on the cylinder in the direction of +x, of the
        sign of omega R - V (at V = 0 of delta), 0 for delta = 0; |tau| <= mu p, with equality in
        the slip zone and, in full slip, in the whole contact.  Both are in Pa of a Cylinder, else
        divided by E', and 0 outside the contact.  If a body is a layer of finite thickness there is
        ``p`` alone by method "table": its shear stress is not known.  Both have the broadcast shape
        of arguments and roller; they are floats if all of these are numbers.

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
    (``tests/test_stress.py``).  Where V or the creepage are arrays, the state of the contact takes
    56 bytes for each of their elements, beside the result.
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
    if method == "coupled":
        from .coupled_contact import coupled_stress as find
    else:
        find = _stress_of_law
    stresses = find(scene, position, speed, creep, creep_name == "omega")
    stresses *= scale["p"]  # in place: a copy would double the memory of a large call
    found = {name: part if part.ndim else part.item() for name, part in zip(("p", "tau"), stresses)}
    return Values(found, given, si=scale.si, title="Stresses", labels=labels)


def _stress_of_law(
    scene: Parameters, x: Floats, V: Floats, creep: Floats, creep_is_omega: bool
) -> Floats:
    """Return pressure and shear stress by the fast law, without a table of the coupled solution.

    scene: dimensionless parameters of one material; kappa and mu may be arrays.
    x: distance ahead of the axis, divided by l0; broadcasts with the states.
    V: speeds, dimensionless, any sign.
    creep: omega if ``creep_is_omega``, else the creepage delta.
    Returns p and tau divided by E', rows of an array, each of the broadcast shape; of a cover p
    alone.
    """
    from ..kernels.law.modes import Points

    scene = scene.uncoupled
    lam, epsilon, beta, zeta, delta = evaluate_contact(
        scene, V, creep, creep_is_omega, ("lam", "epsilon", "beta", "zeta", "delta")
    ).values()
    # For V < 0 positions are mirrored, and tau changes its sign.
    mirror = np.where(V < 0.0, -1.0, 1.0)
    alpha = (
        scene.alpha
        if scene.material_array is None
        else np.arange(len(scene.material_array), dtype=np.float64)
    )
    arrays = {
        "x": x,
        "kappa": scene.kappa,
        "mu": scene.mu,
        "lam": lam,
        "epsilon": epsilon,
        "beta": beta,
        "zeta": zeta,
        "alpha": alpha,
        "mirror": mirror,
        "sign": np.sign(delta) * mirror,
    }
    arrays = {name: np.asarray(value, dtype=np.float64) for name, value in arrays.items()}
    shape = broadcast_shape(**arrays)
    read_x, *readers, read_alpha, read_mirror, read_sign = (
        block_reader(array, shape) for array in arrays.values()
    )
    out = np.empty((2, math.prod(shape)))
    p, tau = out

    def work(start: int, stop: int) -> None:
        """Compute p/E' and the signed tau/E' at points ``start`` to ``stop`` - 1 of the flattened
        broadcast shape, and write them into these elements of ``p`` and ``tau``; of a cover p
        alone.
        """
        mirrored = read_mirror(start, stop) * read_x(start, stop)
        mirrored.flags.writeable = False  # as all arrays that kernels read (block_reader)
        points = Points(mirrored, *(read(start, stop) for read in readers))
        _compute_stresses(scene, read_alpha(start, stop), points, p[start:stop], tau[start:stop])
        if scene.cover is None:  # else tau is not computed
            tau[start:stop] = read_sign(start, stop) * tau[start:stop] + 0.0

    run_blocks(work, p.size, _BLOCK)
    return out.reshape(2, *shape)[: 2 if scene.cover is None else 1]


def _compute_stresses(
    scene: Parameters, alpha: Floats, points: Any, p: Floats, tau: Floats
) -> None:
    """Compute the stresses at points, material by material, and write them into ``p`` and ``tau``.

    scene: dimensionless parameters of the roller, of which the material alone is read.
    alpha: alphas, or for an array of materials their indices as floats, (n,) or (1,); for one
        material not used.  Consecutive points of one material are computed together.
    points: record :class:`.modes.Points`; its fields (position, kappa, mu, lam,
        epsilon, beta, zeta) are (n,) or (1,), dimensionless, positions in the frame where V > 0,
        divided by l0.
    p, tau: pressure and size of the shear stress divided by E', (n,), written, 0 outside the
        contact; of a cover tau is not written.
    """
    from ..kernels.law.modes import new_memory_weights, stress_loop

    ends: Any = [] if scene.material_array is None else 1 + np.flatnonzero(np.diff(alpha))
    for first, last in pairwise([0, *ends, p.size]):
        part = points._make(each[first:last] if each.size > 1 else each for each in points)
        index = int(alpha[min(first, alpha.size - 1)])  # of one of many materials
        if scene.cover is not None:
            p[first:last] = _cover_pressure(scene, index, part)
            continue
        material: Any = alpha if scene.series is None else scene.series
        if scene.material_array is not None:
            material = total_series(scene.material_array[index])
        series, alphas = series_record(material)
        stress_loop(
            series,
            alphas,
            new_memory_weights(series),
            new_memory_weights(series),
            part,
            p[first:last],
            tau[first:last],
        )


def _cover_pressure(scene: Parameters, index: int, points: Any) -> Floats:
    """Return p/E' at points on a cover, by one solve of the contact of the layer for each different
    state.

    scene: dimensionless parameters of a roller with a cover.
    index: index of the cover, if the scene has an array of covers; else not used.
    points: record :class:`.modes.Points`, of which position (divided by l0, in the
        frame where V > 0), kappa, lam, epsilon and zeta (infinite at V = 0) are used, (n,) or (1,).
    Returns p/E', dimensionless, >= 0 to rounding, 0 outside the contact, a new array (n,), where n
    is the common length of these fields.
    """
    cover: Any = scene.cover if scene.material_array is None else scene.material_array[index]
    modes = CoverModes(cover)
    x, *state = np.broadcast_arrays(points.x, points.kappa, points.lam, points.epsilon, points.zeta)
    states_of_contact, which = np.unique(np.array(state), axis=1, return_inverse=True)
    found = np.empty(x.size)
    for n, (kappa, lam, epsilon, zeta) in enumerate(states_of_contact.T.tolist()):
        place = which.ravel() == n
        y = 2.0 * x[place] / lam - epsilon
        found[place] = pressure(modes, zeta, 0.5 * lam, y) / (8.0 * np.pi * kappa * lam)
    return found
