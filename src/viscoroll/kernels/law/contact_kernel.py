"""States of the contact from the rows of their law: no root, no iteration, and nothing that is not
requested.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.

Terms of this file, besides those of :mod:`.traction_functions`:

- Request: states, and the quantities of them that are written into rows of ``out``.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from .cover_law import asymmetry_at, length_change, pairs_at, shear_reaction
from .law_functions import (
    body_moments,
    lam_and_epsilon,
    length_and_moment,
    locate_row,
    moment_factor,
)
from .law_record import (
    asks_for_moments,
    asks_for_slopes,
    read_state,
    select_material,
    slip_and_creepage,
    write_field,
)
from .traction_functions import (
    Q_slopes,
    friction_reserve,
    moment_slope,
    moment_slope_over_V,
    signed_creep,
    signed_traction,
    stick_argument,
    stick_fraction,
    traction_on_moments,
)


class Evaluated(NamedTuple):
    """What the law gives at one state, dimensionless.

    state : :class:`.law_record.State` of numbers.
    u : kappa |V|.
    position : :class:`.law_functions.RowPosition` of u.
    functions : :class:`.law_functions.LengthAndMoment` at u.
    pairs : :class:`.cover_law.Pairs` at u, zeros of half-spaces.
    asymmetry : c of a cover (:mod:`.cover_law`), 0 of half-spaces.
    D : with a sign (:func:`.traction_functions.signed_creep`).
    v : argument of the stick zone (:func:`.traction_functions.stick_argument`).
    stick_position : :class:`.law_functions.RowPosition` of v.
    """

    state: Any
    u: float
    position: Any
    functions: Any
    pairs: Any
    asymmetry: float
    D: float
    v: float
    stick_position: Any


@inline_kernel
def evaluate_state(state, u, law):
    """Return what the law gives at a state but for its traction, as :class:`Evaluated`.

    state : :class:`.law_record.State` of numbers.
    u : float, kappa |V| of the state.
    law : :class:`.law_record.Law` with the material of the state selected.
    """
    position = locate_row(u, law)
    functions = length_and_moment(position, u, law)
    L = functions.L
    pairs = pairs_at(position, u, law.cover_rows)
    # 0 for the derivatives of L: the value alone is read, which does not need them
    asymmetry = asymmetry_at(pairs, state.mu, L, 0.0, 0.0, law.cover_rows).value
    D = signed_creep(L, pairs.total.first.value, asymmetry, state, law.cover_rows)
    v = stick_argument(u, L, abs(D))
    return Evaluated(
        state=state,
        u=u,
        position=position,
        functions=functions,
        pairs=pairs,
        asymmetry=asymmetry,
        D=D,
        v=v,
        stick_position=locate_row(v, law),
    )


@inline_kernel
def traction_of(at, law):
    """Return the traction Q of a state, divided by the load P.

    at : :class:`Evaluated`, the state.
    law : :class:`.law_record.Law` with the material of the state selected.
    """
    return signed_traction(at.stick_position, at.v, at.u, at.functions.L, at.D, at.state.mu, law)


@inline_kernel
def _write_lengths(n, at, Q, law, request):
    """Write creepages, lengths and grip of a state, of those that are requested.

    n : int, index of the state, >= 0; not checked.
    at : :class:`Evaluated`, the state.
    Q : float, its traction; of half-spaces not read.
    law : :class:`.law_record.Law` with the material of the state selected.
    request : :class:`.law_record.Request`; ``out`` gets the quantities of :func:`contact_loop` from
        delta_star to epsilon, dimensionless.
    Returns nothing.
    """
    to = request.to
    state = at.state
    L = at.functions.L
    D = abs(at.D)
    delta_star = 0.5 * state.mu / state.kappa * L
    delta_0 = 0.5 * at.pairs.total.first.value / state.kappa
    # The onsets are delta_0 + delta_star (c -+ 1): d = -1 and 1 in d + c d^2 of cover_law.
    write_field(to.delta_star, delta_star, n, request)
    write_field(to.delta, slip_and_creepage(state)[1], n, request)
    write_field(to.delta_0, delta_0, n, request)
    write_field(to.delta_minus, delta_0 + delta_star * (at.asymmetry - 1.0), n, request)
    write_field(to.delta_plus, delta_0 + delta_star * (at.asymmetry + 1.0), n, request)
    write_field(to.full_slip, 1.0 if D == np.inf else 0.0, n, request)
    if to.grip >= 0:
        write_field(to.grip, friction_reserve(at.stick_position, at.v, L, D, law), n, request)
    # ``&`` of rows, here and below, as in law_record.asks_for_moments
    if (to.lam & to.zeta & to.epsilon & to.beta) >= 0:
        lam, epsilon = lam_and_epsilon(at.position, at.u, law)
        # beta is formed with lam of the contact without traction; lam itself is corrected below
        write_field(to.beta, stick_fraction(at.stick_position, at.v, lam, L, D, law), n, request)
        # Q in the direction of V, as length_change takes it
        along = -Q if state.V < 0.0 else Q
        lam_change, epsilon_change = length_change(along, at.position, at.u, law.cover_rows)
        lam = lam + lam_change
        write_field(to.lam, lam, n, request)
        write_field(to.zeta, 0.5 * lam / at.u, n, request)
        write_field(to.epsilon, epsilon + epsilon_change, n, request)


@inline_kernel
def _write_moments(n, at, Q, law, cover_rows, request):
    """Write M, the moments of both bodies and how shear acts back on them, of those that are
    requested.

    n : int, index of the state in the columns of ``request.out``, >= 0; not checked.
    at : :class:`Evaluated`, the state.
    Q : float, its traction; of half-spaces, whose moments do not depend on it, not read.
    law : :class:`.law_record.Law` with the material of the state selected; with rows of the moments
        of the bodies, if these are requested.
    cover_rows : ``law.cover_rows``; None of half-spaces.
    request : :class:`.law_record.Request`; ``out`` gets the moments, in units of P R, and the
        factors and excesses of :class:`.cover_law.Reaction`, dimensionless.
    Returns nothing.
    """
    to = request.to
    # m is M/V and the factor V; in the fast limit, where M/V may underflow, M/(V z) and V z
    factor = moment_factor(at.position, at.u, at.functions.scale, at.state)
    M = factor * at.functions.m
    half_space = 0.0
    cylinder = 0.0
    if (to.M_half_space & to.M_cylinder) >= 0:
        half_space, cylinder, _, _ = body_moments(at.position, at.u, law)
        half_space *= factor
        cylinder *= factor
    if cover_rows is not None:  # M falls by Q (factor + excess |Q|/mu), that of each body likewise
        state = at.state
        by_shear = shear_reaction(at.pairs, state.kappa, state.mu, at.functions.L, 0.0, cover_rows)
        used = abs(Q) / state.mu
        total = by_shear.half_space + by_shear.cylinder
        total += (by_shear.half_space_excess + by_shear.cylinder_excess) * used
        M -= Q * total
        half_space -= Q * (by_shear.half_space + by_shear.half_space_excess * used)
        cylinder -= Q * (by_shear.cylinder + by_shear.cylinder_excess * used)
        write_field(to.reaction_half_space, by_shear.half_space, n, request)
        write_field(to.reaction_cylinder, by_shear.cylinder, n, request)
        write_field(to.excess_half_space, by_shear.half_space_excess, n, request)
        write_field(to.excess_cylinder, by_shear.cylinder_excess, n, request)
    write_field(to.M, M, n, request)
    write_field(to.M_half_space, half_space, n, request)
    write_field(to.M_cylinder, cylinder, n, request)


@inline_kernel
def _write_slopes(n, at, Q, slopes_of_Q, bodies, law, request):
    """Write the slopes of Q and of the moments, of those that are requested.

    n : int, index of the state in the columns of ``request.out``, >= 0; not checked.
    at : :class:`Evaluated`, the state.
    Q : float, its traction; of half-spaces it has no effect.
    slopes_of_Q : bool, whether slopes of Q are needed: of a cover always.
    bodies : bool, whether a slope of the moment of one body is requested.
    law : :class:`.law_record.Law` with the material of the state selected; with ``bodies`` it has
        rows of the moments of the bodies.
    request : :class:`.law_record.Request`; ``out`` gets the slopes, dimensionless.
    Returns nothing.  Of half-spaces M depends on the speed alone: its slopes in delta and omega are
    0.
    """
    to = request.to
    change = traction_on_moments(at.pairs, at.functions, Q, at.state, law.cover_rows)
    half_space_slope = 0.0
    cylinder_slope = 0.0
    if bodies:
        _, _, half_space_slope, cylinder_slope = body_moments(at.position, at.u, law)
    # 0 where no slope of Q is needed: of half-spaces they then multiply derivatives that are 0
    over_V = 0.0
    over_delta = 0.0
    over_omega = 0.0
    if slopes_of_Q:
        over_V, over_delta, over_omega = Q_slopes(at.u, at.functions, at.pairs, at.D, at.state, law)
        write_field(to.dQ_dV, over_V, n, request)
        write_field(to.dQ_ddelta, over_delta, n, request)
        write_field(to.dQ_domega, over_omega, n, request)
    dQ = change.half_space_dQ + change.cylinder_dQ
    du = change.half_space_du + change.cylinder_du
    write_field(to.dM_ddelta, moment_slope(dQ, over_delta), n, request)
    # of each moment: slope over V without traction, what the traction changes, rows of the slopes
    for slope, by_u, by_Q, to_V, to_omega in (
        (at.functions.d_um, du, dQ, to.dM_dV, to.dM_domega),
        (
            half_space_slope,
            change.half_space_du,
            change.half_space_dQ,
            to.dM_half_space_dV,
            to.dM_half_space_domega,
        ),
        (
            cylinder_slope,
            change.cylinder_du,
            change.cylinder_dQ,
            to.dM_cylinder_dV,
            to.dM_cylinder_domega,
        ),
    ):
        # -0.0 of half-spaces, which changes no bit of a sum
        by_shear = -0.0
        if _is_cover(law.cover_rows):
            by_shear = moment_slope_over_V(by_u, by_Q, over_V, at.state)
        write_field(to_V, slope + by_shear, n, request)
        write_field(to_omega, moment_slope(by_Q, over_omega), n, request)


@inline_kernel
def _is_cover(cover_rows):
    """Return whether a law is that of a cover, a bool that numba knows when it compiles.

    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None for
    half-spaces.
    """
    return cover_rows is not None


@kernel
def contact_loop(laws, request, count):
    """Evaluate the law at ``count`` states and write what is requested, in the units of
    docs/symbols.md for a scene.

    laws : tuple of :class:`.law_record.Law`.  States of one material have one law, whose rows are
        complete.  If every state has a material of its own, each law has one material selected at a
        time; the loop selects them, in turn for one state after the other.
    request : :class:`.law_record.Request`: ``states`` (arrays of length 1 or with one number for
        each state), ``order`` of evaluation, ``to`` (for each quantity its row of ``out``, -1 if it
        is not requested), ``out``, (quantities, columns), of which column ``first`` + n is written
        for state n, dimensionless.
    count : int, number of states, >= 0; with an ``order`` its first ``count`` entries are
        evaluated, else the states 0 to ``count`` - 1.

    The kernel returns nothing.  The quantities: delta_star (critical creepage), delta (creepage),
    delta_0 (creepage without creep force), delta_minus and delta_plus (onsets of full slip),
    full_slip (1.0 or 0.0), grip (1 - |Q|/mu), beta (stick zone divided by the contact length), lam
    (contact length divided by l0), zeta (half the transit time divided by T_ref), epsilon (shift of
    the contact ahead of the axis, in half contact lengths), Q, M, M of half-space and cylinder,
    dQ_dV, dQ_ddelta, dQ_domega, dM_dV, dM_ddelta and dM_domega, the slopes of M of half-space and
    cylinder in V and omega, and, of a cover, factors of Q (``reaction_half_space``,
    ``reaction_cylinder``) and of Q |Q|/mu (``excess_...``) that are subtracted from M of a body.

    At V = 0 zeta is infinite, and delta too if omega is given and not 0.  In full slip grip, beta
    and the slopes of Q are 0; grip and beta are 0 too where D of a state of partial slip is rounded
    to L.  ``dQ_dV`` is at fixed delta or omega, whichever the states have (:func:`Q_slopes`).  What
    Q is at V = 0 and in full slip is said at :func:`signed_traction`; M is 0 at V = 0 and has the
    sign of V.
    """
    to = request.to
    # of a cover Q is computed in any case, as M, lam and epsilon depend on it
    needs_Q = to.Q >= 0 or _is_cover(laws[0].cover_rows)
    others = request.out.shape[0] > (to.Q >= 0) + (to.M >= 0)  # whether more than Q and M is asked
    moments = asks_for_moments(to)
    of_Q, of_M, of_bodies = asks_for_slopes(to)
    # M of a cover depends on Q, so that its slopes need those of Q.
    slopes_of_Q = of_Q or _is_cover(laws[0].cover_rows)
    for k in range(count):
        n = request.order[np.uint64(k)] if request.order.size > 0 else k
        law = laws[k % len(laws)]
        select_material(law, n)
        state = read_state(request.states, n)
        at = evaluate_state(state, state.kappa * abs(state.V), law)
        Q = 0.0
        if needs_Q:
            Q = traction_of(at, law)
            write_field(to.Q, Q, n, request)
        if moments:
            _write_moments(n, at, Q, law, law.cover_rows, request)
        if others:
            _write_lengths(n, at, Q, law, request)
            if of_Q or of_M or of_bodies:
                _write_slopes(n, at, Q, slopes_of_Q, of_bodies, law, request)
