"""Steady states (:class:`States`), and their computation from the rows of the law, on threads.

For given V and Q the creepage follows without a root: by Eq. (15) H(eta) = (1 - |Q|/mu) H(zeta),
which is Eq. (6) at the speed V/root with root^2 = 1 - |Q|/mu.  So delta = delta_star(V) - root
delta_star(V/root) and beta = root lam(V/root)/lam(V).

In this file all is dimensionless, and a law is a :class:`LawTable`, the rows of one material.  Here
zeta and eta are half the transit times of the contact and of its stick zone, H a function of the
material, Q the friction force over the load P, M the rolling moment over P R, mu the coefficient of
friction, kappa = R/l0 with the contact length at rest l0, delta = (omega - V)/V the creepage,
delta_star the size of it from which on the contact slips fully (of a cover, where delta - delta_0 =
delta_star (d + c d^2) with delta_0 at which Q = 0, that follows for d delta_star), lam the contact
length over l0, and beta the part of it that sticks.  Rows
of :class:`Field` are V, delta, Q, M_half_space, M_cylinder, beta, and then either six slopes of the
law, dQ_dV at fixed omega, dQ_domega, dM_half_space_dV, dM_cylinder_dV and both slopes of M over
omega, or omega, the eigenvalues and the moments without traction.
"""

import enum
import functools
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats, Integers, run_blocks
from ..laws import LawTable
from .contact_table import Contacts
from .rolling_resistance import branches
from .steady_loads import Gains, Loads, balance, creep_beyond_free, moments_of_losses, shear_at

#: loads of one block of work: some milliseconds
_BLOCK = 1 << 12
#: |Q|/mu below which delta is computed from its slope at Q = 0
_SMALL_TRACTION = 1e-8
#: |Q|/mu below which a Newton step corrects delta, which is a difference there
_CORRECTED_TRACTION = 0.2
#: fields of ``contact`` that make the rows of :class:`Field` from Q on
_ROWS = (
    "Q",
    "M_half_space",
    "M_cylinder",
    "beta",
    "dQ_dV",
    "dQ_domega",
    "dM_half_space_dV",
    "dM_cylinder_dV",
    "dM_half_space_domega",
    "dM_cylinder_domega",
)


class Field(enum.IntEnum):
    """Index of the row of a quantity in an array of states, (12, n).

    From row 6 on the array has the slopes of the law while states are computed, in a frame where V
    > 0: dQ/dV at fixed creepage, dQ/ddelta, dM_half_space/dV, dM_cylinder/dV at fixed creepage,
    dM_half_space/ddelta, dM_cylinder/ddelta, which stay finite for V -> 0.  In :class:`States` the
    same rows have omega, the real parts of the faster and of the slower eigenvalue, the imaginary
    part of the slower one, and the moments that the bodies would have without traction, by which
    their losses are found.
    """

    V = 0
    DELTA = 1
    Q = 2
    M_HALF_SPACE = 3
    M_CYLINDER = 4
    BETA = 5
    DQ_DV = 6
    DQ_DDELTA = 7
    DM_HALF_SPACE = 8
    DM_CYLINDER = 9
    OMEGA = 6
    FAST = 7
    SLOW = 8
    IMAGINARY = 9
    DM_HALF_SPACE_DDELTA = 10
    DM_CYLINDER_DDELTA = 11
    FREE_HALF_SPACE = 10
    FREE_CYLINDER = 11


#: slopes over V at fixed creepage
_OVER_V = [Field.DQ_DV, Field.DM_HALF_SPACE, Field.DM_CYLINDER]
#: slopes over the creepage, in the same order
_OVER_CREEP = [Field.DQ_DDELTA, Field.DM_HALF_SPACE_DDELTA, Field.DM_CYLINDER_DDELTA]
#: speed below which slopes are those at it: slopes over omega, which the kernels give, overflow at
#: 1e-306, and M/V and Q are those of V = 0 to rounding
_LEAST_SPEED = 1e-290


class States(NamedTuple):
    """Steady states one after another, dimensionless; speeds in R/T_ref.

    load : index of the load of each state, (n,).
    rows : quantities of the states, (12, n), in the order of :class:`Field`, with omega, the
    eigenvalues and the moments
        without traction from row 6 on; V, Q, M and omega have the signs of the motion.  delta and
        omega are NaN where the friction does not
        suffice; Q is what the balance needs there, and the other rows mean nothing.
    """

    load: Integers
    rows: Floats

    @classmethod
    def of(
        cls, loads: Loads, load: Integers, sign: Any, answers: Floats, free: Any = None
    ) -> "States":
        """Make the states from values of the law in a frame where V > 0: give V, Q and the moments
        the signs of the motion, and add omega and the eigenvalues.

        loads : :class:`Loads`, the loads, of which the gains and j are used.
        load : index of the load of each state, (n,).
        sign : sign of V, 1.0 or -1.0, a number or (n,).
        answers : rows of :class:`Field` with the slopes of the law from row 6 on, (12, n), in a
            frame where V > 0; not changed.
        free : M_half_space and M_cylinder without traction, (2, n), in that frame; None: those of
            ``answers``, as for half-spaces.
        Returns the :class:`States`, (n,); omega is NaN where delta is.
        """
        rows = answers.copy()
        rows[Field.FREE_HALF_SPACE :] = (
            answers[[Field.M_HALF_SPACE, Field.M_CYLINDER]] if free is None else free
        )
        rows[Field.V] *= sign
        rows[Field.Q : Field.BETA] *= sign  # and both moments
        rows[Field.FREE_HALF_SPACE :] *= sign
        rows[Field.OMEGA] = rows[Field.V] * (1.0 + rows[Field.DELTA])
        # of the frame where V > 0: a mirror image has the same eigenvalues
        rows[Field.FAST : Field.FREE_HALF_SPACE] = _eigenvalues(answers, loads.gains, loads.j[load])
        return cls(load, rows)

    @classmethod
    def at_rest(cls, loads: Loads, load: Integers, law: LawTable) -> "States":
        """Return the states of V = omega = 0, the limit of slow rolling.

        The contact is that of Carter (of two elastic bodies); of a cover its creep limit and its
        creepage without creep force are used.  A disturbance decays as V' = -rate V, with omega in
        proportion to V.

        loads : the loads, dimensionless; all but V and ``shape`` is read.  Q balances the torque,
            or where V and the force were given the force.
        load : index of the load of each state, (n,).
        law : table of the material.
        Returns the :class:`States`, (n,), with V = omega = 0: the eigenvalue of slip is -inf, the
        slow one is that of the less stable direction (on a table of the coupled solution of motion
        with V > 0), 0 for elastic bodies without gains; delta and omega are NaN where the friction
        does not suffice, |Q| >= mu.
        """
        still = np.zeros(load.size)
        contacts = loads.contacts(law, load)
        on_spin = loads.given != "force"
        required = loads.torque[load] if on_spin else -loads.force[load]
        if law.coupled is not None:
            creep, unbalanced = balance(contacts, still, required, on_spin)
            creeps = [creep]
            rows = state_rows(contacts, still, creep)
            exists = unbalanced == 0.0
        else:
            star, free = contacts.fields(still, 0.0, "delta_star", "delta_0")
            shear = shear_at(contacts, still)
            Q = shear.traction(required, of_axis=1.0 - on_spin, of_spin=on_spin)
            part = np.minimum(np.abs(Q) / contacts.mu, 1.0)
            # delta_star (1 - sqrt(1 - |Q|/mu)) without cancellation, the creepage of Carter's
            # contact, of motion to either side
            creep = np.sign(Q) * star * part / (1.0 + np.sqrt(1.0 - part))
            creeps = [free + creep_beyond_free(contacts, still, side) for side in (creep, -creep)]
            rows = state_rows(contacts, still, creeps[0])
            rows[Field.Q] = Q
            exists = part < 1.0
        slow = np.full(load.size, -np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):  # in full slip
            # slopes of the balances over Q, then of the moments over V at fixed Q
            slopes = rows[_OVER_CREEP] / rows[Field.DQ_DDELTA]
            of_axis = 1.0 - slopes[1]
            of_spin = 1.0 + slopes[2]
            over_V = rows[_OVER_V]
            half_space, cylinder = over_V[1:] - slopes[1:] * over_V[0]
            gains = loads.gains
            for creep in creeps:
                omega_over_V = 1.0 + creep
                push = half_space - gains.force_V - gains.force_omega * omega_over_V
                turn = cylinder - gains.torque_V - gains.torque_omega * omega_over_V
                rate = of_spin * push + of_axis * turn
                inertia = of_spin + loads.j[load] * of_axis * omega_over_V
                slow = np.maximum(slow, -rate / inertia)
        rows[Field.OMEGA :] = 0.0
        rows[Field.FAST] = -np.inf
        rows[Field.SLOW] = slow
        rows[[[Field.DELTA], [Field.OMEGA]], ~exists] = np.nan
        return cls(load, rows)

    @classmethod
    def none(cls) -> "States":
        """No state."""
        return cls(np.empty(0, np.int64), np.empty((len(Field), 0)))

    @classmethod
    def joined(cls, *parts: "States") -> "States":
        """States of all parts, one after another."""
        return cls(*map(np.hstack, zip(*parts, strict=True)))

    def existing(self) -> "States":
        """Return the states for which the friction suffices (omega is finite) as new
        :class:`States`, maybe none, sorted by load, then by rising |V|; of equal |V| in their
        order.
        """
        order = np.lexsort((np.abs(self.rows[Field.V]), self.load))
        chosen = order[np.isfinite(self.rows[Field.OMEGA, order])]
        return States(self.load[chosen], self.rows[:, chosen])


def _eigenvalues(answers: Floats, gains: Gains, j: Floats) -> Floats:
    """Return the eigenvalues of small disturbances of (V, omega), per unit of gamma t.

    answers : rows of :class:`Field` with the slopes of the law, (12, n), of which V, delta and the
        slopes are read.
    gains : :class:`Gains`, gains of force and torque on V and omega.
    j : moments of inertia divided by m R^2, (n,).
    Returns rows, (3, n): real part of the faster eigenvalue (the smaller number) and of the slower
    one, imaginary part of the slower (>= 0; the faster has its negative).  Of a complex pair both
    real parts are equal, of real eigenvalues the imaginary part is 0.  The determinant is b
    (M'(V) - gain)/j without a gain on omega, where b = dQ/domega; it is computed without the
    cancellation of the large slopes of Q at fixed omega.  Where M depends on Q too, as for a cover,
    M' is that at fixed Q, and Q acts on the axis and on the cylinder with the factors ``on_axis``
    and ``on_spin``.  The equation is that of min(j, 1) min(V, 1) times an eigenvalue, in units of a
    power of 2, so that no square overflows; an eigenvalue beyond the doubles is infinite.
    """
    V, delta, *_, dQ_dV, dQ_ddelta, d_half_space, d_cylinder, half_space_ddelta, cylinder_ddelta = (
        answers
    )
    unit = np.minimum(j, 1.0)
    slow = np.minimum(V, 1.0)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        # where Q does not depend on omega, neither do the moments: ``slips`` makes 0/0 0/1 there
        slips = dQ_ddelta == 0.0
        on_axis = 1.0 - half_space_ddelta / (dQ_ddelta + slips)
        on_spin = 1.0 + cylinder_ddelta / (dQ_ddelta + slips)
        d_half_space = d_half_space - (1.0 - on_axis) * dQ_dV
        d_cylinder = d_cylinder - (on_spin - 1.0) * dQ_dV
        # slopes of Q over omega, and over V at fixed omega, times ``slow``
        b = dQ_ddelta / np.maximum(V, 1.0)
        a = slow * dQ_dV - np.multiply(b, 1.0 + delta, out=0.0 * b, where=b != 0.0)
        axis = on_axis * a + slow * (gains.force_V - d_half_space)
        det = on_spin * d_half_space + on_axis * d_cylinder
        det = b * (det - (on_spin * gains.force_V + on_axis * gains.torque_V))
        det += gains.torque_omega * axis
        spin = on_spin * a + slow * (d_cylinder - gains.torque_V)
        inertia = j / unit
        det = (det + gains.force_omega * spin) / inertia
        half = 0.5 * (unit * axis + (slow * gains.torque_omega - on_spin * b) / inertia)
        product = np.sqrt(np.abs(det)) * np.sqrt(slow)
        # with y = unit slow times an eigenvalue: y^2 - 2 half y + det unit slow = 0; the larger
        # root has no cancellation, and the other eigenvalue follows from the product of both
        power = np.frexp(np.maximum(np.abs(half), product))[1]
        spread = np.ldexp(half, -power) ** 2
        spread -= np.ldexp(det * unit, -power) * np.ldexp(slow, -power)
        root = np.ldexp(np.sqrt(np.abs(spread)), power)
        larger = half + np.copysign(root, half)
        other = np.divide(det, larger, out=0.0 * det, where=larger != 0.0)
        real = spread >= 0.0
        larger = larger / unit / slow
        half = half / unit / slow
        root = root / unit / slow
        return np.array(
            [
                np.minimum(larger, other, out=1.0 * half, where=real),
                np.maximum(larger, other, out=1.0 * half, where=real),
                np.where(real, 0.0, root),
            ]
        )


def state_rows(contacts: Contacts, V: Floats, delta: Floats) -> Floats:
    """Return the law at V > 0 and a creepage, as the rows from which :meth:`States.of` makes
    states.

    contacts : the law, at a kappa and a mu.
    V, delta : speeds, > 0, which is not checked, and creepages, (n,), dimensionless.
    Returns rows of :class:`Field` with slopes, (12, n).  In full slip Q is mu or -mu, and beta and
    the slopes of Q are 0.  beta is NaN of a grid, which does not contain it.
    """
    rows = np.empty((12, V.size))
    rows[Field.V] = V
    rows[Field.DELTA] = delta
    rows[2:] = contacts.fields(V, delta, *_ROWS)
    if contacts.law.gridded:
        rows[Field.BETA] = np.nan
    speed = V
    if np.minimum.reduce(V, initial=_LEAST_SPEED) < _LEAST_SPEED:
        speed = np.maximum(V, _LEAST_SPEED)
        rows[Field.DQ_DV :] = contacts.fields(speed, delta, *_ROWS[Field.DQ_DV - 2 :])
    # a slope over omega times V is one over the creepage
    rows[_OVER_CREEP] *= speed
    return rows


def slopes_at_fixed_omega(rows: Floats) -> tuple[Floats, Floats]:
    """Return the slopes of Q, M_half_space and M_cylinder over V at fixed omega, and those over
    omega, (3, n) each, from rows of :class:`Field` with slopes.
    """
    over_omega = rows[_OVER_CREEP] / rows[Field.V]
    return rows[_OVER_V] - over_omega * (1.0 + rows[Field.DELTA]), over_omega


def find_crossings(law: LawTable, gain: float, total: Floats) -> tuple[Integers, Floats, Floats]:
    """Find the speeds at which kappa (M - gain V) equals a given total, in both directions of
    motion.

    law : table of the material.
    gain : slope of the load in V, dimensionless; 0 for a load that does not depend on V.
    total : kappa (force + torque), dimensionless, any sign, (n,); not checked: where it is not
        within the values of the curve at the nodes, no crossing is found.
    Returns (index of the load; sign of V, 1.0 or -1.0; kappa |V|, > 0), one entry for each
    crossing, (crossings,) each; first those with V > 0, then those with V < 0, of every branch.  A
    load has none to many; V = 0 is not among them.
    Raises ParameterError for a gain out of range.
    """
    from ..kernels.law.law_functions import LoadCurve, crossing_loop

    found = branches(law, gain)
    # M is odd: motion with V < 0 is that with V > 0 under the opposite load
    signed = np.concatenate([total, -total])
    which, node = found.locate_loads(signed)
    curve = LoadCurve(found.u, found.resistance, found.extremum, gain)
    u = np.empty(which.size)
    run_blocks(
        functools.partial(crossing_loop, law.record, curve, signed[which], node, u),
        which.size,
        _BLOCK,
    )
    return which % total.size, np.where(which < total.size, 1.0, -1.0), u


def states_at(law: LawTable, loads: Loads, load: Integers, sign: Floats, V: Floats) -> States:
    """Return the steady states at given V > 0, whether or not the friction suffices.

    law : table of the material.
    loads : the loads, dimensionless, without a gain on omega, of which gains, given, force, torque,
        kappa, mu and j are read.  Where V was given, that of force and torque which was given too
        determines Q, and M is that of the law; else V must be such that force + torque, with the
        gains on V, equal M.
    load : index of the load of each state, (n,).
    sign : sign of the motion, in whose frame V > 0, 1.0 or -1.0, (n,).
    V : speeds, > 0, dimensionless, (n,).
    Returns the :class:`States`, (n,), with the signs of the motion; delta and omega are NaN and
    beta is 0 where |Q| >= mu, so that the friction does not suffice.
    """
    contacts = loads.contacts(law, load)
    force, torque = loads.at_speed(load, V, sign=sign)
    on_spin = loads.given == "torque"
    if law.coupled is not None:
        delta, unbalanced = balance(contacts, V, torque if on_spin else -force, on_spin)
        rows = state_rows(contacts, V, delta)
        losses = moments_of_losses(contacts, V, delta)
        rows[Field.DELTA, unbalanced != 0.0] = np.nan
        rows[Field.Q] += unbalanced  # Q as the balance needs it
        return States.of(loads, load, sign, rows, free=losses)
    delta_0 = contacts.free_creep(V)
    *free, star, lam, rise = contacts.fields(
        V, delta_0, "M_half_space", "M_cylinder", "delta_star", "lam", "dQ_ddelta"
    )
    Q = torque - free[1] if on_spin else free[0] - force
    moments: Any = free
    if law.cover is not None:
        shear = shear_at(contacts, V)
        Q = shear.traction(Q, of_axis=1.0 - on_spin, of_spin=on_spin)
        moments = moments + shear.moments(Q)
    elif loads.given is None:  # V is such that both loads balance M
        M = free[0] + free[1]
        # part of M by the half-space; one half of elastic bodies, whose M is 0
        share = np.divide(free[0], M, out=0.5 + 0.0 * M, where=M > 0.0)
        Q = share * torque - (1.0 - share) * force
        moments = share * (force + torque), (1.0 - share) * (force + torque)
    part = np.abs(Q) / contacts.mu
    exists = part < 1.0
    root = np.sqrt(np.where(exists, 1.0 - part, 1.0))
    faster = V / root
    less_star, less_lam = contacts.fields(faster, contacts.free_creep(faster), "delta_star", "lam")
    # the formula of the module; for a small Q its difference is rounding, and |Q| over the slope
    # ``rise`` = dQ/ddelta at Q = 0 takes its place
    size = np.where(part > _SMALL_TRACTION, star - root * less_star, contacts.mu * part / rise)
    creep = creep_beyond_free(contacts, V, np.copysign(size, Q))
    rows = state_rows(contacts, V, creep + delta_0)
    # one Newton step for delta alone, which is a difference where |Q|/mu is small: the other rows
    # do not change by it
    rows[Field.DELTA] -= np.divide(
        rows[Field.Q] - Q, rows[Field.DQ_DDELTA], out=0.0 * V, where=part < _CORRECTED_TRACTION
    )
    rows[Field.Q] = Q
    rows[[Field.M_HALF_SPACE, Field.M_CYLINDER]] = moments
    rows[Field.BETA] = root * less_lam / lam
    rows[Field.DELTA, ~exists] = np.nan
    return States.of(loads, load, sign, rows, free=None if law.cover is None else free)
