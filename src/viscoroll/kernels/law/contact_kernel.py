"""States of the contact from the rows of their law: no root, no iteration, and nothing that is not
requested.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.

Terms of this file, besides those of :mod:`.traction_functions`:

- Request: states, and the quantities of them that are written into rows of ``out``.
- Block: up to TOGETHER = 64 states that are evaluated together.  Column c: place of a state in its
  block.
- Scratch: for each number of a state (kappa, mu, V and so on) TOGETHER doubles in a row, of which
  that at c belongs to the state in column c.  Its indices are unsigned, as numba would test signed
  ones for negative numbers.
"""

import numpy as np

from ..numerics.intrinsics import bits_to_float, float_to_bits
from ..numerics.jit import inline_kernel, kernel
from .cover_law import asymmetry_at, length_change, pairs_at, shear_reaction
from .law_functions import (
    RowPosition,
    body_moments,
    lam_and_epsilon,
    length_and_moment,
    locate_row,
    moment_factor,
)
from .law_record import (
    SCRATCH_SIZE,
    TOGETHER,
    State,
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

# Places in the scratch of :func:`contact_loop`, TOGETHER numbers each.
(
    #: kappa of the states.
    _KAPPA,
    #: mu.
    _MU,
    #: V, dimensionless.
    _V,
    #: The creepage or omega, whichever is given.
    _CREEP,
    #: u = kappa |V|.
    _U,
    #: L = 2 kappa delta_star/mu.
    _L,
    #: f = 2 kappa delta_0, from the creepage of free rolling.
    _FREE_CREEP,
    #: D with a sign (:func:`signed_creep`).
    _D,
    #: v (:func:`stick_argument`).
    _STICK,
    #: Rows of the positions of u; t and dt/dx follow.
    _POSITION,
    _,
    _,
    #: Rows of the positions of v; t and dt/dx follow.
    _STICK_POSITION,
    _,
    _,
    #: Q, where it is needed.
    _Q,
    #: The asymmetry c of a cover.
    _ASYMMETRY,
    #: The factor by which M_half_space of a cover falls with Q.
    _FACTOR,
    #: That of M_cylinder.
    _CYLINDER_FACTOR,
    #: The excess of the first in full slip.
    _FACTOR_EXCESS,
    #: That of the second.
    _CYLINDER_FACTOR_EXCESS,
) = np.arange(0, SCRATCH_SIZE, TOGETHER, dtype=np.uint64)
#: Distance of t from the row of a position in the scratch.
_T = np.uint64(TOGETHER)
#: Distance of dt/dx from that row.
_DT_DX = np.uint64(2 * TOGETHER)


@inline_kernel
def _index(k, request):
    """Return the index of the state at a position in the order of evaluation, an int.

    k : int, the position, from 0 to ``count`` - 1 of :func:`contact_loop`; not checked.
    request : :class:`.law_record.Request`, of which ``order`` is read: the index is ``order[k]``,
    or k itself if it is empty.
    """
    return request.order[np.uint64(k)] if request.order.size > 0 else k


@inline_kernel
def _state(c, scratch, request):
    """Return the :class:`.law_record.State` of numbers of a state of the block, from the copy in
    the scratch.

    c : unsigned int, column of the state in the scratch, its place in the block, from 0 to
    TOGETHER - 1.
    scratch : (SCRATCH_SIZE,) doubles, of :func:`contact_loop`, of which kappa, mu, V and the creep
    are read.
    request : :class:`.law_record.Request`, of whose states ``creep_is_omega`` is read.
    """
    return State(
        kappa=scratch[_KAPPA + c],
        mu=scratch[_MU + c],
        V=scratch[_V + c],
        creep=scratch[_CREEP + c],
        creep_is_omega=request.states.creep_is_omega,
    )


@inline_kernel
def _write_positions(arguments, positions, begin, end, laws, scratch):
    """Locate the arguments u or v of some states of a block in the rows of their laws, and write
    the positions into the scratch.

    arguments : unsigned int, index in ``scratch`` of the arguments of column 0: _U or _STICK.
    positions : unsigned int, index in ``scratch`` of the positions: _POSITION for u,
    _STICK_POSITION for v.
    begin, end : int, first column, which is the place of a state in its block, and the one after
        the last; 0 <= begin <= end <= TOGETHER = 64, the states in a block.
    laws : tuple of :class:`.law_record.Law`; the state in column k belongs to law k modulo their
        number, which must have its material selected.
    scratch : (SCRATCH_SIZE,) doubles, of :func:`contact_loop`.  Three numbers a state are written:
        at ``positions`` the number of its row, an int (-1 beyond the last row) whose bits are
        stored as a double; TOGETHER numbers further t; again TOGETHER further dt/dx.  With row -1,
        which an infinite argument has too, t and dt/dx have no meaning; of a NaN t is NaN.
    Returns nothing.
    """
    for k in range(begin, end):
        c = np.uint64(k)
        position = locate_row(scratch[arguments + c], laws[k % len(laws)])
        # the bits of the int, not its value: :func:`_position` reads them as an int again
        scratch[positions + c] = bits_to_float(position.row)
        scratch[positions + _T + c] = position.t
        scratch[positions + _DT_DX + c] = position.dt_dx


@inline_kernel
def _position(place, c, scratch):
    """Return the :class:`.law_functions.RowPosition` of a state of the block, as
    :func:`_write_positions` has written it.

    place : unsigned int, index in ``scratch`` of the positions: _POSITION for u, _STICK_POSITION
    for v.
    c : unsigned int, column of the state in the scratch, its place in the block, from 0 to
    TOGETHER - 1.
    scratch : (SCRATCH_SIZE,) doubles, of :func:`contact_loop`.
    """
    return RowPosition(
        float_to_bits(scratch[place + c]), scratch[place + _T + c], scratch[place + _DT_DX + c]
    )


@inline_kernel
def _write_other_fields(n, c, law, scratch, request):
    """Write the requested quantities of a state, except Q and M, into ``request.out``.

    n : int, index of the state, >= 0; not checked.
    c : unsigned int, its column in ``scratch``, 0 to TOGETHER - 1.
    law : :class:`.law_record.Law` with the material of the state selected; without rows of the
        moments of the bodies (:mod:`.alpha_axis`) none of these four may be requested.
    scratch : (SCRATCH_SIZE,) doubles, of :func:`contact_loop`, after all its stages; not changed.
    request : :class:`.law_record.Request` of states and quantities; of ``out`` the numbers of state
        n in the rows of the requested quantities are written, dimensionless.

    Returns nothing.  The quantities: delta_star (critical creepage), delta (creepage), delta_0
    (creepage without creep force), delta_minus and delta_plus (onsets of full slip),
    full_slip (1.0 or 0.0), grip (1 - |Q|/mu), lam (contact length divided by l0), zeta (half the
    transit time divided by T_ref), epsilon (shift of the contact ahead of the axis, in half contact
    lengths), beta (stick zone divided by the contact length), dQ_dV, dQ_ddelta, dQ_domega, dM_dV,
    dM_ddelta and dM_domega, M of half-space and cylinder with their slopes in V and omega, and
    factors of Q (``reaction_half_space``, ``reaction_cylinder``) and of Q |Q|/mu (``excess_...``)
    that are subtracted from M of a body on a cover, of either sign.

    At V = 0 zeta is infinite, and delta too if omega is given and not 0.  In full slip grip, beta
    and the slopes of Q are 0; grip and beta are 0 too where D of a state of partial slip is rounded
    to L.  ``dQ_dV`` is at fixed delta or omega, whichever the states have (:func:`Q_slopes`).
    """
    to = request.to
    state = _state(c, scratch, request)
    u = scratch[_U + c]
    L = scratch[_L + c]
    D = scratch[_D + c]
    v = scratch[_STICK + c]
    position = _position(_POSITION, c, scratch)
    stick_position = _position(_STICK_POSITION, c, scratch)
    delta_star = 0.5 * state.mu / state.kappa * L
    delta_0 = 0.5 * scratch[_FREE_CREEP + c] / state.kappa
    # The onsets are delta_0 + delta_star (c -+ 1): d = -1 and 1 in d + c d^2 of cover_law.
    shift = scratch[_ASYMMETRY + c] if _is_cover(law.cover_rows) else 0.0
    write_field(to.delta_star, delta_star, n, request)
    write_field(to.delta, slip_and_creepage(state)[1], n, request)
    write_field(to.delta_0, delta_0, n, request)
    write_field(to.delta_minus, delta_0 + delta_star * (shift - 1.0), n, request)
    write_field(to.delta_plus, delta_0 + delta_star * (shift + 1.0), n, request)
    write_field(to.full_slip, 1.0 if abs(D) == np.inf else 0.0, n, request)
    if to.grip >= 0:
        write_field(to.grip, friction_reserve(stick_position, v, L, abs(D), law), n, request)
    # ``&`` of rows, here and below, as in law_record.asks_for_moments
    if (to.lam & to.zeta & to.epsilon & to.beta) >= 0:
        lam, epsilon = lam_and_epsilon(position, u, law)
        # beta is formed with lam of the contact without traction; lam itself is corrected below
        write_field(to.beta, stick_fraction(stick_position, v, lam, L, abs(D), law), n, request)
        # Q in the direction of V, as length_change takes it; of half-spaces it is not read, and the
        # scratch has none
        Q = -scratch[_Q + c] if scratch[_V + c] < 0.0 else scratch[_Q + c]
        lam_change, epsilon_change = length_change(Q, position, u, law.cover_rows)
        lam = lam + lam_change
        write_field(to.lam, lam, n, request)
        write_field(to.zeta, 0.5 * lam / u, n, request)
        write_field(to.epsilon, epsilon + epsilon_change, n, request)
    if _is_cover(law.cover_rows):  # of half-spaces nobody asks for these fields
        write_field(to.reaction_half_space, scratch[_FACTOR + c], n, request)
        write_field(to.reaction_cylinder, scratch[_CYLINDER_FACTOR + c], n, request)
        write_field(to.excess_half_space, scratch[_FACTOR_EXCESS + c], n, request)
        write_field(to.excess_cylinder, scratch[_CYLINDER_FACTOR_EXCESS + c], n, request)
    if (to.M_half_space & to.M_cylinder) >= 0:
        _write_body_moments(n, c, law, law.cover_rows, scratch, request)
    of_Q, of_M, of_bodies = asks_for_slopes(to)
    if of_Q or of_M or of_bodies:
        # M of a cover depends on Q, so that its slopes need those of Q.
        slopes_of_Q = of_Q or _is_cover(law.cover_rows)
        _write_slopes(n, c, of_bodies, slopes_of_Q, law, scratch, request)


@inline_kernel
def _write_body_moments(n, c, law, cover_rows, scratch, request):
    """Write the moments of both bodies, of those that are requested.

    n : int, index of the state in the columns of ``request.out``, >= 0; not checked.
    c : unsigned int, its column in ``scratch``, 0 to TOGETHER - 1.
    law : :class:`.law_record.Law` with the material of the state selected, with rows of the moments
        of the bodies.
    cover_rows : ``law.cover_rows``; None of half-spaces, whose moments do not depend on Q.
    scratch : of it u, the position of u, kappa and V are read; of a cover Q, mu, and the factors
        and excesses of :func:`_write_cover` too.
    request : :class:`.law_record.Request`; ``out`` gets both moments, in units of P R.
    Returns nothing.
    """
    u = scratch[_U + c]
    position = _position(_POSITION, c, scratch)
    scale = length_and_moment(position, u, law).scale
    factor = moment_factor(position, u, scale, _state(c, scratch, request))
    half_space, cylinder, _, _ = body_moments(position, u, law)
    half_space *= factor
    cylinder *= factor
    if cover_rows is not None:  # M of a body falls by Q (factor + excess |Q|/mu)
        Q = scratch[_Q + c]
        used = abs(Q) / scratch[_MU + c]
        half_space -= Q * (scratch[_FACTOR + c] + scratch[_FACTOR_EXCESS + c] * used)
        cylinder -= Q * (
            scratch[_CYLINDER_FACTOR + c] + scratch[_CYLINDER_FACTOR_EXCESS + c] * used
        )
    write_field(request.to.M_half_space, half_space, n, request)
    write_field(request.to.M_cylinder, cylinder, n, request)


@inline_kernel
def _write_slopes(n, c, bodies, slopes_of_Q, law, scratch, request):
    """Write the slopes of Q and of the moments, of those that are requested.

    n : int, index of the state in the columns of ``request.out``, >= 0; not checked.
    c : unsigned int, its column in ``scratch``, 0 to TOGETHER - 1.
    bodies : bool, whether a slope of the moment of one body is requested.
    slopes_of_Q : bool, whether slopes of Q are needed: of a cover always.
    law : :class:`.law_record.Law` with the material of the state selected; with ``bodies`` it has
        rows of the moments of the bodies.
    scratch : of it the state (kappa, mu, V, creep), u, the position of u, D and, of a cover, Q are
        read; of half-spaces Q may be absent, as it has no effect.
    request : :class:`.law_record.Request`; ``out`` gets the slopes, dimensionless.
    Returns nothing.  Of half-spaces M depends on the speed alone: its slopes in delta and omega are
    0.
    """
    to = request.to
    state = _state(c, scratch, request)
    u = scratch[_U + c]
    position = _position(_POSITION, c, scratch)
    functions = length_and_moment(position, u, law)
    pairs = pairs_at(position, u, law.cover_rows)
    change = traction_on_moments(pairs, functions, scratch[_Q + c], state, law.cover_rows)
    half_space_slope = 0.0
    cylinder_slope = 0.0
    if bodies:
        _, _, half_space_slope, cylinder_slope = body_moments(position, u, law)
    # 0 where no slope of Q is needed: of half-spaces they then multiply derivatives that are 0
    over_V = 0.0
    over_delta = 0.0
    over_omega = 0.0
    if slopes_of_Q:
        over_V, over_delta, over_omega = Q_slopes(u, functions, pairs, scratch[_D + c], state, law)
        write_field(to.dQ_dV, over_V, n, request)
        write_field(to.dQ_ddelta, over_delta, n, request)
        write_field(to.dQ_domega, over_omega, n, request)
    dQ = change.half_space_dQ + change.cylinder_dQ
    du = change.half_space_du + change.cylinder_du
    write_field(to.dM_ddelta, moment_slope(dQ, over_delta), n, request)
    # of each moment: slope over V without traction, what the traction changes, rows of the slopes
    for slope, by_u, by_Q, to_V, to_omega in (
        (functions.d_um, du, dQ, to.dM_dV, to.dM_domega),
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
            by_shear = moment_slope_over_V(by_u, by_Q, over_V, state)
        write_field(to_V, slope + by_shear, n, request)
        write_field(to_omega, moment_slope(by_Q, over_omega), n, request)


@inline_kernel
def _is_cover(cover_rows):
    """Return whether a law is that of a cover, a bool that numba knows when it compiles.

    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None for
    half-spaces.
    """
    return cover_rows is not None


@inline_kernel
def _write_cover(c, position, L, cover_rows, scratch, request):
    """Store in the scratch what the rows of a cover give besides at the speed of a state.

    c : unsigned int, column of the state in ``scratch``, 0 to TOGETHER - 1.
    position : :class:`.law_functions.RowPosition` of u.
    L : float, 2 kappa delta_star/mu of the state.
    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None for
    half-spaces, of which 2 kappa delta_0 = 0 alone is written.
    scratch : (SCRATCH_SIZE,) doubles: u, kappa and mu of the state are read.  2 kappa delta_0 and
        the asymmetry c are written, and where a moment is requested the factors and excesses of
        :class:`.cover_law.Reaction` of both bodies.
    request : :class:`.law_record.Request`, of which ``to`` is read.
    Returns nothing.
    """
    if cover_rows is None:
        scratch[_FREE_CREEP + c] = 0.0
    else:
        pairs = pairs_at(position, scratch[_U + c], cover_rows)
        mu = scratch[_MU + c]
        scratch[_FREE_CREEP + c] = pairs.total.first.value
        # 0 for the derivatives of L, here and below: values alone are read, which do not need them
        scratch[_ASYMMETRY + c] = asymmetry_at(pairs, mu, L, 0.0, 0.0, cover_rows).value
        if asks_for_moments(request.to):
            reaction = shear_reaction(pairs, scratch[_KAPPA + c], mu, L, 0.0, cover_rows)
            scratch[_FACTOR + c] = reaction.half_space
            scratch[_CYLINDER_FACTOR + c] = reaction.cylinder
            scratch[_FACTOR_EXCESS + c] = reaction.half_space_excess
            scratch[_CYLINDER_FACTOR_EXCESS + c] = reaction.cylinder_excess


@inline_kernel
def _write_traction_on_cover(Q, n, c, cover_rows, scratch, request):
    """Store Q of a state on a cover in the scratch, and subtract what it changes from M, if that is
    requested.

    Q : float, traction, dimensionless.
    n : int, index of the state in the columns of ``request.out``, >= 0; not checked.
    c : unsigned int, its column in ``scratch``, 0 to TOGETHER - 1.
    cover_rows : of any cover among those of the block: it is only asked whether it is None, of
        half-spaces, of which nothing is written.
    scratch : (SCRATCH_SIZE,) doubles: mu, and the factors and excesses of Q (:func:`_write_cover`)
        are read, and Q is written.
    request : :class:`.law_record.Request`; M in ``out``, in units of P R, is that without traction
        before.
    Returns nothing.
    """
    # M = M without traction - Q (factor + excess |Q|/mu), summed over both bodies
    if cover_rows is not None:
        scratch[_Q + c] = Q
        row = request.to.M
        if row >= 0:
            used = abs(Q) / scratch[_MU + c]
            factor = scratch[_FACTOR + c] + scratch[_CYLINDER_FACTOR + c]
            factor += (scratch[_FACTOR_EXCESS + c] + scratch[_CYLINDER_FACTOR_EXCESS + c]) * used
            request.out[np.uint64(row), np.uint64(n + request.first)] -= Q * factor


@kernel
def contact_loop(laws, request, scratch, count):
    """Evaluate the law at ``count`` states and write what is requested, in the units of
    docs/symbols.md for a scene.

    laws : tuple of :class:`.law_record.Law`.  States of one material have one law, whose rows are
        complete.  If every state has a material of its own, these are as many laws as states are
        evaluated together, each with one material selected at a time; the loop selects them.
    request : :class:`.law_record.Request`: ``states`` (arrays of length 1 or with one number for
        each state), ``order`` of evaluation, ``to`` (for each quantity its row of ``out``, -1 if it
        is not requested), ``out``, (quantities, columns), of which column ``first`` + n is written
        for state n.  The quantities are lam, zeta, epsilon, delta_star, delta, full_slip, beta,
        grip, Q, M, dQ_dV, dQ_ddelta, dQ_domega, dM_dV, M_half_space, M_cylinder, dM_half_space_dV,
        dM_cylinder_dV, delta_0 and the others of :data:`.law_record.Fields`.
    scratch : (SCRATCH_SIZE,) doubles, overwritten.
    count : int, number of states, >= 0; with an ``order`` its first ``count`` entries are
        evaluated, else the states 0 to ``count`` - 1.

    The kernel returns nothing.  What each quantity is at V = 0 and in full slip is said at
    :func:`signed_traction` and :func:`_write_other_fields`; M is 0 at V = 0 and has the sign of V.

    The states pass through the stages in blocks of TOGETHER: their numbers are copied; then come
    the positions in the rows, the polynomials of the speed, creepage and position of v, and the
    polynomials of the traction.  Each stage is a short loop over the states of a block.  So the
    processor works on several states at once, stages without polynomials are compiled to vector
    instructions, and what is requested is tested once for a block.
    """
    to = request.to
    others = request.out.shape[0] > (to.Q >= 0) + (to.M >= 0)  # whether more than Q and M is asked
    for first in range(0, count, TOGETHER):
        size = count - first if count - first < TOGETHER else TOGETHER
        for k in range(size):
            c = np.uint64(k)
            state = read_state(request.states, _index(first + k, request))
            scratch[_KAPPA + c] = state.kappa
            scratch[_MU + c] = state.mu
            scratch[_V + c] = state.V
            scratch[_CREEP + c] = state.creep
            scratch[_U + c] = state.kappa * abs(state.V)
        # One law serves all states of a block; of many materials as many states as there are laws
        # are evaluated together.
        together = size if laws[0].selector == 0 else len(laws)
        for begin in range(0, size, together):
            end = begin + together if begin + together < size else size
            for k in range(begin, end):
                select_material(laws[k % len(laws)], _index(first + k, request))
            _write_positions(_U, _POSITION, begin, end, laws, scratch)
            for k in range(begin, end):
                law = laws[k % len(laws)]
                c = np.uint64(k)
                u = scratch[_U + c]
                position = _position(_POSITION, c, scratch)
                functions = length_and_moment(position, u, law)
                scratch[_L + c] = functions.L
                _write_cover(c, position, functions.L, law.cover_rows, scratch, request)
                # M without traction: m is M/V and the factor V; in the fast limit, where M/V may
                # underflow, M/(V z) and V z
                factor = moment_factor(position, u, functions.scale, _state(c, scratch, request))
                write_field(to.M, factor * functions.m, _index(first + k, request), request)
            # ``laws[0]`` for all states in this loop: of the law it is only asked whether it is a
            # cover, and all are or none is
            for k in range(begin, end):
                c = np.uint64(k)
                L = scratch[_L + c]
                D = signed_creep(
                    L,
                    scratch[_FREE_CREEP + c],
                    scratch[_ASYMMETRY + c],
                    _state(c, scratch, request),
                    laws[0].cover_rows,
                )
                scratch[_D + c] = D
                scratch[_STICK + c] = stick_argument(scratch[_U + c], L, abs(D))
            _write_positions(_STICK, _STICK_POSITION, begin, end, laws, scratch)
            # of a cover Q is computed in any case, as M, lam and epsilon depend on it
            if to.Q >= 0 or _is_cover(laws[0].cover_rows):
                for k in range(begin, end):
                    c = np.uint64(k)
                    Q = signed_traction(
                        _position(_STICK_POSITION, c, scratch),
                        scratch[_STICK + c],
                        scratch[_U + c],
                        scratch[_L + c],
                        scratch[_D + c],
                        scratch[_MU + c],
                        laws[k % len(laws)],
                    )
                    n = _index(first + k, request)
                    write_field(to.Q, Q, n, request)
                    _write_traction_on_cover(Q, n, c, laws[0].cover_rows, scratch, request)
            if others:
                for k in range(begin, end):
                    n = _index(first + k, request)
                    _write_other_fields(n, np.uint64(k), laws[k % len(laws)], scratch, request)
