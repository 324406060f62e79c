"""Steady rolling under force, torque or slope: :func:`steady`, all equilibria with their stability.

The equations are V' = Q - M_half_space + force = 0 and j omega' = -Q - M_cylinder + torque = 0
(over gamma t).  Their sum M(V) = force + torque determines V; Q = torque - M_cylinder then
determines the creepage.  They are Eq. (22) of Zobova and Goryacheva, Acta Mechanica (2020), with a
force and a torque, divided by P and P R, and with the moment M split between the two bodies.

**Feedback on omega** is solved by a scan over V.  With gains f = f0 + fV V + fw omega, q = q0 + qV
V + qw omega the sum of the two equations, M(V) - (fV + qV) V - (fw + qw) omega = f0 + q0,
determines omega for every V.  The other equation has one unknown, V:

    R = Q(V, omega) - M_half_space + f = 0          Q = +-mu in full slip

Of covers M depends on Q too.  qw times the equation of the axis less fw times that of the cylinder
has no omega and gives Q for every V (:meth:`.steady_loads.Shear.traction`); either equation
then gives omega, and R is the same.

R is smooth between the speeds at which omega - V is that of free rolling (0 of half-spaces, V
delta_0 of covers) or at a limit of stick, which are found first.  If fw + qw = 0, the sum
determines V, and R = 0 is an equation for omega.

In this file all is dimensionless, and states are in a frame where V > 0; ``slip`` is omega - V, x
is log2(kappa V) with kappa = R/l0, mu is the coefficient of friction, delta_0 the creepage (omega -
V)/V at which Q = 0, delta_star the distance from it at which full slip begins, and a law is a
:class:`LawTable`, the rows of one material.  Rows of :class:`.steady_states.Field` are V, delta, Q,
M_half_space, M_cylinder, beta and six slopes of the law, dQ_dV at fixed omega, dQ_domega,
dM_half_space_dV and dM_cylinder_dV; :class:`.steady_states.States` have omega and the eigenvalues
in place of the slopes.
"""

import functools
import math
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    Feedback,
    Floats,
    Numbers,
    ParameterError,
    make_dimensionless,
    strip_labels,
)
from ..laws import LawTable
from .contact_table import Contacts, refuse_beyond
from .model_warnings import warn_of_contact
from .parameters import Roller, refuse_arrays, resolve_model, scale_of
from .rolling_resistance import branches, find_zeros, speed_nodes
from .steady_loads import (
    Loads,
    find_speeds,
    is_balanced_at_rest,
    loads_of,
    loads_without_omega,
    moments_of_losses,
    search_nodes,
    shear_at,
)
from .steady_result import Diagnosis, Steady
from .steady_states import (
    Field,
    States,
    find_crossings,
    slopes_at_fixed_omega,
    state_rows,
    states_at,
)

# --- Steady rolling with feedback on omega ---

#: least size of kappa times a load, other than 0, for which the nodes have a crossing
LEAST_LOAD = 1e-120
#: largest size of kappa times a load
MOST_LOAD = 1e80
#: nodes into which an interval of V with partial slip is divided
_STICK_NODES = 16
#: nodes of the slip between its limits
_SLIP_NODES = 129
#: Newton steps in V and slip
_NEWTON_STEPS = 4
#: residual of an equation divided by its terms above which a zero is no state
_RESIDUAL = 1e-6
#: relative difference of V and of delta below which two states are one
_SAME_STATE = 1e-10
#: rounding error of R divided by the sum of its terms; nodes with a smaller R have no sign
_ROUNDING = 2e-15


class _FreeRolling(NamedTuple):
    """The contact at several speeds, in the frame of the motion, each (n,).

    V : speeds, > 0.
    moments : of base and cylinder, without traction, (2, n).
    slips : omega - V at the onset of full slip with Q = -mu, of free rolling, at which Q = 0, and
        at the onset of full slip with Q = mu, (3, n).
    """

    V: Floats
    moments: Floats
    slips: Floats


class _ScanProblem(NamedTuple):
    """One load in the frame of the motion, in which V > 0; all is dimensionless.

    contacts : the law, at one kappa and one mu.
    load_rows : (2, 3): the row of the force and the row of the torque, each (value at rest, gain on
    V, gain on omega); the values at rest are those of the load, with the other sign for a motion
    with V < 0.
    """

    contacts: Contacts
    load_rows: Floats

    def free_rolling(self, x: Floats) -> _FreeRolling:
        """Return the contact at given speeds as :class:`_FreeRolling`.

        x: log2(kappa V), (n,).
        """
        V = np.exp2(x) / self.contacts.kappa
        free = self.contacts.free_creep(V)
        fields = self.contacts.fields(
            V, free, "M_half_space", "M_cylinder", "delta_minus", "delta_0", "delta_plus"
        )
        return _FreeRolling(V, moments=fields[:2], slips=V * fields[2:])

    def loads_at(self, V: Any, omega: Any) -> Floats:
        """Return force and torque at the speeds V and omega, numbers or (n,), as two rows: (2,) or
        (2, n).
        """
        return self.load_rows @ np.array([np.ones_like(V), V, omega])

    def slip(self, free: _FreeRolling) -> Floats:
        """Return omega - V at which a traction balances both equations, (n,).

        free : the contact at some speeds, (n,).  Of half-spaces force + torque equal M there; their
            gains on omega must not add to 0.
        Raises ParameterError of a cover, where the gains leave Q open.
        """
        # loads at omega = V; slip times the gains on omega is added to them
        force, torque = self.loads_at(free.V, free.V)
        of_force, of_torque = self.load_rows[:, 2]
        law = self.contacts.law
        if law.coupled is not None:
            Q, half_space, cylinder = loads_without_omega(
                self.contacts, free.V, force, torque, of_force, of_torque
            )
        elif law.cover is not None:
            shear = shear_at(self.contacts, free.V)
            # r_f and -r_q, the right sides of the balances (:meth:`.steady_loads.Shear.traction`)
            axis_side, minus_spin_side = free.moments - [force, torque]
            Q = shear.traction(
                of_torque * axis_side - of_force * minus_spin_side, of_torque, of_force
            )
            half_space, cylinder = free.moments + shear.moments(Q)
        else:
            return (free.moments.sum(axis=0) - (force + torque)) / (of_force + of_torque)
        # either balance gives the slip; that of the larger gain loses fewer digits
        if abs(of_force) > abs(of_torque):
            return (half_space - force - Q) / of_force
        return (cylinder + Q - torque) / of_torque

    def residual(self, x: Floats, slip: Floats) -> Floats:
        """Return R = Q - M_half_space + force, 0 in equilibrium, at x = log2(kappa V) and slip =
        omega - V, (n,).
        """
        V = np.exp2(x) / self.contacts.kappa
        Q, M_half_space = self.contacts.fields(V, slip / V, "Q", "M_half_space")
        return Q - M_half_space + self.loads_at(V, V + slip)[0]

    def rows(self, V: Floats, slip: Floats) -> tuple[Floats, Floats]:
        """Evaluate the law and the residuals of the equations of equilibrium, full slip included.

        V, slip : speed and omega - V, (n,), dimensionless, in the frame where V > 0.
        Returns (rows of :class:`Field` with the slopes of the law from row 6 on, (12, n);
        residuals, (2, n): M less force and torque, and Q - M_half_space + force), dimensionless; a
        state is one of equilibrium if both residuals are 0.
        """
        rows = state_rows(self.contacts, V, slip / V)
        force, torque = self.loads_at(V, V + slip)
        M_half_space = rows[Field.M_HALF_SPACE]
        sums = M_half_space + rows[Field.M_CYLINDER] - force - torque
        return rows, np.array([sums, rows[Field.Q] - M_half_space + force])


def scan_states(law: LawTable, loads: Loads) -> States:
    """Find all states of rolling under loads with a gain on omega, by a scan over the speed.

    law : table of the material.
    loads : the loads, of which at least one of force and torque has a gain on omega; V is not
    given.
    Returns the :class:`States` of both directions of motion, with the signs of the motion, and
    those that spin at V = 0 and omega other than 0; load by load, else unsorted.  States of full
    slip, with Q = +-mu, are among them; rest, V = omega = 0, is not.  omega of all of them is
    finite.
    Raises ParameterError where the gains on omega add to 0, for a gain on V that
    :func:`.rolling_resistance.branches` refuses.
    """
    at_rest = np.array([loads.force, loads.torque])
    gains = np.reshape(loads.gains, (2, 2))  # of force and of torque, each on V and omega
    parts = [States.none()]
    for n in range(loads.mu.size):
        contacts = loads.contacts(law, n)
        for sign in (1.0, -1.0):
            # a motion towards -x is the mirror image: its loads have the other sign, its gains stay
            load_rows = np.column_stack([sign * at_rest[:, n], gains])
            problem = _ScanProblem(contacts, load_rows)
            # of half-spaces slip follows from the speed unless the gains on omega cancel
            by_speed = not law.moment_of_speed_alone or load_rows[:, 2].sum()
            x, slip = _scan_speed(problem) if by_speed else _scan_slip(problem)
            rows = _polish(problem, np.exp2(x) / contacts.kappa, slip)
            free = None
            if law.coupled is not None:
                free = moments_of_losses(contacts, rows[Field.V], rows[Field.DELTA])
            elif law.cover is not None:
                free = problem.free_rolling(np.log2(contacts.kappa * rows[Field.V])).moments
            parts.append(States.of(loads, np.full(rows.shape[1], n), sign, rows, free))
        parts += _spinning_at_rest(contacts, loads, n)
    return States.joined(*parts)


def _spinning_at_rest(contacts: Contacts, loads: Loads, n: int) -> list[States]:
    """Return the equilibrium with V = 0 and omega other than 0 under the n-th load, if there is
    one.

    At V = 0 and omega other than 0 the whole contact slips: Q is all of the friction, and must
    balance the force to the bit.  As M = 0 there, omega follows from force + torque = 0.

    contacts: the law, at the kappa and the mu of the load.
    loads: the loads with their gains, dimensionless.
    n: index of the load.
    Returns a list of one :class:`States` with one state, whose V is 0, whose creepage is infinite
    with the sign of omega, as in :func:`.contact_states.contact` at V = 0, and whose eigenvalues
    are those of the slowest speed of the nodes; or an empty list: also where the gains on omega add
    to 0, where force + torque are 0 at rest, and of a cover, on which a moment remains.
    """
    gains = loads.gains
    total = loads.force[n] + loads.torque[n]
    gain = gains.force_omega + gains.torque_omega
    if not (contacts.law.moment_of_speed_alone and gain and total):
        return []
    # the sum of both balances without M; then that of the axis must hold with Q = +-mu
    omega = -total / gain
    side = math.copysign(1.0, omega)
    if side * contacts.mu + loads.force[n] + gains.force_omega * omega != 0.0:
        return []
    # the limit V -> 0 of full slip: the slowest node, at a creepage far beyond the onset
    slowest = np.exp2(speed_nodes(contacts.law)[:1]) / contacts.kappa
    rows = state_rows(contacts, slowest, 1.0 / slowest)
    spinning = States.of(loads, np.array([n]), side, rows)
    spinning.rows[[Field.V, Field.DELTA, Field.M_HALF_SPACE, Field.M_CYLINDER, Field.OMEGA], 0] = (
        0.0,
        side * math.inf,
        0.0,
        0.0,
        omega,
    )
    return [spinning]


def _scan_speed(problem: _ScanProblem) -> tuple[Floats, Floats]:
    """Find the states of a load by a scan over V, where the sum of the equations gives omega at
    each V.

    Used where the gains on omega of force and torque have a sum other than 0, and of covers.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    Returns (x = log2(kappa V), ascending; slip = omega - V), (states,) each, dimensionless, in the
    frame where V > 0; empty arrays if there is no state.  The states are approximate;
    :func:`_polish` refines them and drops those that are none.
    """

    def beyond(which: int, x: Floats) -> Floats:
        free = problem.free_rolling(x)
        return problem.slip(free) - free.slips[which]

    nodes = search_nodes(problem.contacts.law)
    zeros = [find_zeros(functools.partial(beyond, n), nodes) for n in range(3)]
    nodes = np.unique(np.concatenate([nodes, *zeros]))
    free = problem.free_rolling(nodes)
    low, _, high = free.slips
    # nodes at an onset count as partial slip in spite of rounding
    half_width = 0.5 * (high - low) * (1.0 + 1e-9)
    stuck = np.abs(problem.slip(free) - 0.5 * (low + high)) <= half_width
    # intervals with an end in partial slip, where the balance changes fast, get further nodes
    within = np.flatnonzero(stuck[1:] | stuck[:-1])
    parts = np.linspace(0.0, 1.0, _STICK_NODES)[1:-1]
    nodes = np.union1d(nodes, nodes[within, None] + parts * np.diff(nodes)[within, None])
    free = problem.free_rolling(nodes)
    # the size of the terms of the balance of the axis, of which its rounding is a fraction
    speeds = [np.ones_like(free.V), free.V, free.V + problem.slip(free)]
    terms = problem.contacts.mu + free.moments[0] + np.abs(problem.load_rows[0]) @ np.abs(speeds)
    found = find_zeros(
        lambda x: problem.residual(x, problem.slip(problem.free_rolling(x))),
        nodes,
        _ROUNDING * terms,
    )
    return found, problem.slip(problem.free_rolling(found))


def _scan_slip(problem: _ScanProblem) -> Floats:
    """Find the states of a load by a scan over the slip, where the sum of the equations gives V
    alone.

    Used where the gains on omega of force and torque have the sum 0, but are not 0.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    Returns the rows x = log2(kappa V) and slip = omega - V, (2, states), dimensionless, in the
    frame where V > 0, unsorted, without columns if there is no state.  States of partial slip are
    zeros over the slip, those of full slip follow from Q = mu or -mu.
    Raises ParameterError for a gain on V out of range.
    """
    at_rest, of_V, _ = problem.load_rows.sum(axis=0)
    law, kappa, mu = problem.contacts
    # crossings of both directions are found; those of V > 0 belong to this frame
    _, sign, u = find_crossings(law, of_V, np.array([kappa * at_rest]))
    found = [np.empty((2, 0))]
    for x in np.log2(u[sign > 0.0]):
        free = problem.free_rolling(np.array([x]))
        limit = free.slips[2, 0]
        # right side of the balance of the axis: Q + gain slip, with the gain of the force on omega
        right_side = free.moments[0] - problem.loads_at(free.V, free.V)[0]

        # defaults keep x and limit of this turn
        def residual(part: Floats, x: float = x, limit: float = limit) -> Floats:
            return problem.residual(np.full_like(part, x), limit * part)

        sides = np.array([1.0, -1.0])
        # the slip at which Q = +-mu balances the axis; it is full slip if beyond the limit
        full = (right_side - sides * mu) / problem.load_rows[0, 2]
        partial_slip = limit * find_zeros(residual, np.linspace(-1.0, 1.0, _SLIP_NODES))
        slip = np.concatenate([partial_slip, full[sides * full > limit]])
        found.append(np.array([np.full_like(slip, x), slip]))
    return np.hstack(found)


def _polish(problem: _ScanProblem, V: Floats, slip: Floats) -> Floats:
    """Refine approximate states, and drop those that are no states or occur twice.

    It makes four Newton steps in V and slip on M = force + torque and R = 0, since the scans find V
    to the rounding of its logarithm alone.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    V, slip : speed and omega - V of the approximate states, (n,), dimensionless, in the frame where
    V > 0; n may be 0.
    Returns rows of :class:`Field` with the slopes of the law from row 6 on at the refined states,
    (12, states), sorted by V and creepage.  A step that does not reduce the sum of the moduli of
    both residuals, or changes V by a thousandth or more, is rejected.  A state of which a residual
    stays above :data:`_RESIDUAL` times (mu +
    |M_half_space| + |M_cylinder|) is dropped, and of neighbours in this order whose V and delta
    agree to :data:`_SAME_STATE`, relative, all but the first.  A jump from full slip to full slip
    of the other sign, within the rounding of V, may be found as two zeros of R: these are refined
    to one state, or dropped.
    """
    state = np.array([V, slip])
    rows, residuals = problem.rows(*state)
    of_force, of_torque = problem.load_rows[:, 1:]
    # slopes of both residuals over V and omega by those of the loads, and by those of Q,
    # M_half_space and M_cylinder
    by_loads = np.array([-of_force - of_torque, of_force])
    by_contact = np.array([[0.0, 1.0, 1.0], [1.0, -1.0, 0.0]])
    for _ in range(_NEWTON_STEPS):
        over_V, over_omega = slopes_at_fixed_omega(rows)
        # with omega = V + slip a slope over the slip is that over omega, one over V at fixed slip
        # is the sum
        over_slip = by_contact @ over_omega + by_loads[:, 1:]
        over_V = by_contact @ over_V + by_loads[:, :1] + over_slip
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.array(
                [
                    residuals[0] * over_slip[1] - residuals[1] * over_slip[0],
                    residuals[1] * over_V[0] - residuals[0] * over_V[1],
                ]
            ) / (over_V[0] * over_slip[1] - over_slip[0] * over_V[1])
        good = np.isfinite(step[1]) & (np.abs(step[0]) < 1e-3 * state[0])
        new = np.where(good, state - step, state)
        new_rows, new_residuals = problem.rows(*new)
        better = good & (np.abs(new_residuals).sum(axis=0) < np.abs(residuals).sum(axis=0))
        state = np.where(better, new, state)
        rows = np.where(better, new_rows, rows)
        residuals = np.where(better, new_residuals, residuals)
    size = problem.contacts.mu + np.abs(rows[Field.M_HALF_SPACE]) + np.abs(rows[Field.M_CYLINDER])
    rows = rows[:, np.abs(residuals).max(axis=0) <= _RESIDUAL * size]
    rows = rows[:, np.lexsort(rows[[Field.DELTA, Field.V]])]
    points = rows[[Field.V, Field.DELTA]]
    same = np.abs(np.diff(points)) <= _SAME_STATE * np.abs(points[:, 1:])
    return np.delete(rows, 1 + np.flatnonzero(same.all(axis=0)), axis=1)


# --- Steady rolling under force, torque or slope ---


def steady(
    roller: Roller,
    *,
    force: Numbers | Feedback | None = None,
    torque: Numbers | Feedback | None = None,
    slope: Numbers | None = None,
    V: Numbers | None = None,
) -> Steady:
    """Find steady rolling of a cylinder on its base: every pair of V and omega at which force and
    torque balance.

    For each equilibrium the result says whether it is stable.  The arguments broadcast against each
    other and against array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa, mu and j are used; or a
        :class:`Cylinder`, in SI units per m of its length: V in m/s, omega in rad/s, force and Q in
        N/m, torque and M in N m/m, ``eigenvalues`` in 1/s, powers of ``loss`` in W/m.
    force : along V, of a Scene divided by P; default 0.  It may be a :class:`Feedback` that is
        constant in time, with numbers for its gains.
    torque : along omega, of a Scene divided by P R; default 0.  It may be such a :class:`Feedback`
        too.
    slope : theta, rad, in (-pi/2, pi/2), > 0 pushes along +V.  The load is then P cos(theta), and P
        sin(theta) adds to ``force``.  Of a Scene kappa becomes kappa/sqrt(cos(theta)), and the
        divisors of forces and torques have P cos(theta) in place of P.
    V : the speed, any sign, in place of one of force and torque, which is found (a slope alone
        counts as the force given, and the torque is found); of a Scene divided by R/T_ref, where
        T_ref is its unit of time.

    Returns
    -------
    Steady
        Of one load ``V``, ``omega``, ``delta``, ``Q``, ``M``, ``stable`` and the other fields as
        arrays of exactly its equilibria by rising |V|, none to many.  Arrays of loads have that
        axis after their own, padded with NaN (``stable``: False), and the ``count`` of equilibria
        for each load; arrays of xarray and series of pandas give their labels (series: data frames,
        a column an equilibrium).  ``reason`` says why there is none.

    Raises
    ------
    ParameterError
        NaN or infinite input, a slope out of range, V together with both or neither of force and
        torque (a slope alone counts as the force) or with a feedback, an array of alphas or
        materials, a layer too thin for its law, times of a material beyond 1e-100 to 1e100 T_ref,
        shapes that do not broadcast, labelled arrays beside plain ones or with other coordinates, a
        unit of another dimension, kappa |V| above 1e100 or beyond a grid; without a gain on omega
        also kappa |force + torque| in (0, 1e-120) or above 1e80; a gain on V, divided by the
        longest retardation time, of a size outside 1e-40 to 1e8; a feedback that changes with time
        or has arrays of gains; what is no scene and no cylinder.

    Warns
    -----
    ModelWarning
        Of a Cylinder: its contact at rest is longer than its radius, or the transit frequency at an
        equilibrium is outside the band in which its material was measured.

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.steady(vr.presets.RUBBER_CYLINDER, force=1.0)  # N/m
    >>> found.stable.tolist()
    [True, False]

    Notes
    -----
    For |force + torque| below the largest M(V) there are two equilibria for each maximum of M(V),
    on its rising and its falling branch; they need |Q| < mu.  For force + torque = 0 without
    feedback there is V = 0 alone, where ``delta`` and ``eigenvalues`` are those of V -> 0 (that of
    slip is -inf).  Where equilibria are a continuum (elastic bodies without a drive; Q = mu
    exactly) none is listed and ``reason`` says so.  A feedback on omega is solved by a scan of V,
    some 0.02 s a load.

    Stability is that of (V, omega) under force and torque as named, also where V was given.
    Without feedback det = (dQ/domega) M'(V)/j, so that equilibria on a falling branch of M(V) are
    saddles.

    The relative error of speeds is below 1e-12/sqrt(1 - |force + torque|/M_top), where M_top is the
    extremum of M nearby; that of fields which follow from Q is this bound divided by ``grip``
    (``tests/test_steady.py``).
    """
    given, labels = strip_labels(
        {"force": force, "torque": torque, "slope": slope, "V": V}, scale_of(roller)
    )
    slope = given["slope"]
    on_slope, scene, scale = resolve_model(roller, "steady", slope=slope)
    if type(scene.alpha) is not float:  # a float, the common case, is no array
        refuse_arrays(roller, scene, ("alpha",), slope=slope)
    loads = loads_of(
        scene,
        make_dimensionless("force", given["force"], scale),
        torque=make_dimensionless("torque", given["torque"], scale),
        slope=slope,
        V=make_dimensionless("V", given["V"], scale),
    )
    law = scene.rolling_law
    assert law is not None  # arrays of materials are refused
    gained_by_omega = loads.gains.omega
    gained = loads.gains.V or gained_by_omega
    # without a load every speed of elastic bodies is steady
    neutral = law.elastic and loads.V is None and not gained
    if loads.V is not None:  # one of force and torque is found; V = 0 is at rest
        refuse_beyond(law, loads.kappa * np.abs(loads.V))
        moving = np.flatnonzero(loads.V)
        speed = loads.V[moving]
        rolling = states_at(law, loads, moving, sign=np.sign(speed), V=np.abs(speed))
        rests = loads.V == 0.0
    else:
        rolling = scan_states(law, loads) if gained_by_omega else _states_under_load(law, loads)
        rests = is_balanced_at_rest(law, loads)
        if neutral:  # only where the friction does not suffice, which the result has to say
            rests &= np.abs(loads.torque) > loads.mu
    resting = rests.nonzero()[0]  # in fewer calls than by flatnonzero
    if resting.size:
        rolling = States.joined(rolling, States.at_rest(loads, resting, law))
    existing = rolling.existing()
    count = np.bincount(existing.load, minlength=loads.mu.size)
    # only a reason states it, and the extrema of M take as long as the states
    unstated = count.all() or gained or law.elastic or law.coupled is not None
    maximum = None if unstated else branches(law, 0.0).maximum
    reasons = Diagnosis(
        loads=loads, scale=scale, states=rolling, number=count, maximum=maximum, elastic=neutral
    )
    found = Steady(existing, reasons, labels)
    warn_of_contact(on_slope, np.asarray(found.V) if labels else found.V)
    return found


def _states_under_load(law: LawTable, loads: Loads) -> States:
    """Find all states of rolling under loads without a gain on omega; rest is not among them.

    law : table of the material.
    loads : the loads, dimensionless; V is not given.
    Returns the :class:`States`, unsorted, whether or not the friction suffices; none for elastic
    bodies without a gain on V, and none where force + torque equal M at no speed.
    Raises ParameterError for kappa |force + torque| other than 0 that is below :data:`LEAST_LOAD`
    or above :data:`MOST_LOAD`, and for a gain out of range.
    """
    with np.errstate(over="ignore"):  # what is infinite is refused
        total = loads.kappa * (loads.force + loads.torque)
    size = np.abs(total)
    wrong = (size > MOST_LOAD) | ((size > 0.0) & (size < LEAST_LOAD))
    if wrong.any():
        raise ParameterError(
            "(force + torque/R)/load * R/l0",
            f"{total[wrong][0]:g}",
            f"0, or {LEAST_LOAD:g} to {MOST_LOAD:g} in magnitude (l0 is the contact length at "
            "rest; in a scene R = load = 1, R/l0 = kappa)",
        )
    gain = loads.gains.V
    if not gain and law.elastic:
        return States.none()
    if law.moment_of_speed_alone:
        load, sign, u = find_crossings(law, gain, total)
        V = u / loads.kappa[load]
    else:
        load, sign, V = find_speeds(law, loads)
    return states_at(law, loads, load, sign, V)
