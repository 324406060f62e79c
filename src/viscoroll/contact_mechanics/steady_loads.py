"""Loads of steady rolling, checked and flattened (:class:`Loads`), and their balance with the
moments of the law.

All is dimensionless; a law is a :class:`LawTable`, the rows of one material.  P is the load that
presses the cylinder on its base, R its radius, kappa = R/l0 with the contact length at rest l0, mu
the coefficient of friction, and j the moment of inertia divided by m R^2.

**Covers**: shear acts back on the rolling moments (:class:`Shear`).  With the factors a and
excesses e of base (b) and cylinder (c) of :class:`.cover_law.Reaction`, the moments are
M_half_space = M_b - Q (a_b + e_b |Q|/mu) and M_cylinder = M_c - Q (a_c + e_c |Q|/mu), with M_b and
M_c those without traction.  Equilibrium at V > 0 under a force f and a torque q is

    Q (1 + a_b + e_b |Q|/mu) = M_b - f        Q (1 - a_c - e_c |Q|/mu) = q - M_c

**Tables of the coupled solution** (laws with ``coupled`` rows): at V > 0 the axis is in balance
where Q - M_half_space = -f, the cylinder where Q + M_cylinder = q, with force f and torque q.  The
left sides rise with the creepage, so that one of the two gives the creepage at each speed, and the
other one the speeds.  Where friction does not suffice, the part of the load that is not balanced
is returned, and the state does not exist.
"""

import functools
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    ArrayLike,
    Booleans,
    Feedback,
    Floats,
    Integers,
    ParameterError,
    Schedule,
    broadcast_rows,
    broadcast_shape,
    check_array,
    described_error,
    slope_tan_cos,
)
from ..laws import LawTable
from .contact_table import Contacts, refuse_overflow
from .parameters import Parameters
from .rolling_resistance import find_zeros, speed_nodes

# --- Loads of steady rolling, checked and flattened ---

#: largest kappa |V| of a given speed
FASTEST = 1e100


class Gains(NamedTuple):
    """Gains of force and torque on V and omega, dimensionless: force = value + force_V V +
    force_omega omega, and torque likewise.
    """

    force_V: float
    force_omega: float
    torque_V: float
    torque_omega: float

    @property
    def V(self) -> float:
        """Gain of force + torque on V."""
        return self.force_V + self.torque_V

    @property
    def omega(self) -> bool:
        """Whether any gain acts on omega."""
        return bool(self.force_omega or self.torque_omega)


class Loads(NamedTuple):
    """Loads of one material as vectors of one length, dimensionless.

    shape : shape to which the loads and the parameters of the scene broadcast, () for one load;
    vectors are (n,), with n the product of the shape.
    gains : gains of a feedback, one set for all loads; 0 without feedback.
    given : where V is given, the name of the load that is given with it ("force" or "torque"), else
    None.
    force, torque : values at V = omega = 0, divided by P and P R, (n,); a slope is in the force.
    Of the load that is to be found beside a given V the number here has no meaning.
    kappa, mu, j : parameters, (n,), kappa with the load on the slope.
    V : given speeds, (n,), or None.
    """

    shape: tuple[int, ...]
    gains: Gains
    given: str | None
    force: Floats
    torque: Floats
    kappa: Floats
    mu: Floats
    j: Floats
    V: Floats | None = None

    def contacts(self, law: LawTable, load: Any) -> Contacts:
        """Return the contacts of a ``law`` at kappa and mu of some loads, ``load``: their index."""
        return Contacts(law, self.kappa[load], self.mu[load])

    def at_speed(
        self, load: Any, V: Floats, omega: Any = 0.0, sign: Any = 1.0
    ) -> tuple[Floats, Floats]:
        """Return force and torque at given speeds, in the frame of the motion.

        load : index of the load of each speed, a number or (m,).
        V, omega : speeds, dimensionless, (m,); omega may be left out, which means 0, where no gain
            acts on it.
        sign : -1.0 for a motion towards -x that is computed as its mirror image (V > 0): then the
            values of force and torque at V = omega = 0 change sign, the gains do not.  1.0
            (default): no mirror image.  A number or (m,).
        Returns (force, torque), divided by P and P R, (m,) each.
        """
        gains = self.gains
        force = sign * self.force[load] + gains.force_V * V + gains.force_omega * omega
        torque = sign * self.torque[load] + gains.torque_V * V + gains.torque_omega * omega
        return force, torque


def loads_of(
    scene: Parameters,
    force: ArrayLike | Feedback | None,
    torque: ArrayLike | Feedback | None,
    slope: ArrayLike | None,
    V: ArrayLike | None,
) -> Loads:
    """Check the loads of a call of :func:`.steady_rolling.steady`, and broadcast them with the
    parameters of the scene.

    scene : dimensionless parameters of the roller, on the slope, of which alpha, kappa, mu and j
        are read; one alpha or one material, the others numbers or arrays.
    force, torque : numbers, arrays or :class:`Feedback`, divided by P and by P R, where P is the
        load that presses the cylinder on the slope, its weight times cos(slope); None: 0.
    slope : angle, rad, a number or an array; tan(slope), the part of the weight along the slope
        divided by P, is added to the force.  None: level.
    V : given speeds, dimensionless, any sign, a number or an array; None where the speed is to be
    found.
    Returns the :class:`Loads`: the broadcast ``shape``; ``gains``; ``given``, the name of the load
    beside V or None; and force, torque, kappa, mu, j and V (None where it is to be found),
    flattened to (n,), (1,) where all are numbers.
    Raises ParameterError: NaN or infinite input; a slope outside (-pi/2, pi/2); shapes
    that do not broadcast; kappa |V| above :data:`FASTEST`; a feedback that changes with time or has
    arrays of gains; with V both or neither of force and torque (a slope alone counts as the force),
    or a feedback.
    """
    given = None if V is None else _given_load(slope, force=force, torque=torque)

    push, *of_force = _split_feedback("force", force)
    turn, *of_torque = _split_feedback("torque", torque)
    arrays = {
        "force": push,
        "torque": turn,
        "kappa": scene.kappa,
        "mu": scene.mu,
        "j": scene.j,
        "slope": slope_tan_cos(slope)[0],
    }
    if V is not None:
        arrays["V"] = check_array("V", V)
        refuse_overflow(np.asarray(scene.kappa), arrays["V"], FASTEST)
    # the rates of disturbances are proportional to gamma
    shape = broadcast_shape(**arrays, gamma=scene.gamma)
    # the rows are in the order of the fields of Loads; slope counts for the shape alone before
    arrays["force"] = push + arrays.pop("slope")
    gains = Gains(*of_force, *of_torque)
    return Loads(shape, gains, given, *broadcast_rows(arrays.values(), shape))


def _split_feedback(name: str, value: ArrayLike | Feedback | None) -> tuple[Any, float, float]:
    """Split a load into its value at rest and the gains of its feedback.

    name: name of the load, "force" or "torque", for errors.
    value: a number, an array or a :class:`Feedback`, whose value may be an array too; None: no
    load.
    Returns (value at V = omega = 0, a number or an array; gain on V; gain on omega, floats), in the
    unit of ``value``; (0, 0.0, 0.0) for None, gains of 0.0 without feedback.
    Raises ParameterError for NaN or infinite values, a feedback that changes with time, or arrays
    of gains.
    """
    if callable(value) or isinstance(value, Schedule):
        raise described_error(
            name,
            "is a Schedule" if isinstance(value, Schedule) else "is a function",
            "a number, an array or a Feedback",
        )
    if not isinstance(value, Feedback):
        return check_array(name, 0.0 if value is None else value), 0.0, 0.0
    if not isinstance(value.value, float | np.ndarray):
        raise described_error(name, "is a Feedback that varies with time", "constant in time")
    if value.shape:
        raise described_error(
            name, f"is a Feedback with gains of shape {value.shape}", "one whose gains are numbers"
        )
    return value.value, value.V, value.omega


def _given_load(slope: ArrayLike | None, **loads: ArrayLike | Feedback | None) -> str:
    """Return the name of the load that is given beside V, "force" or "torque"; the other one is to
    be found.

    slope: angle, rad, or None; without force and torque a slope counts as the force given, and the
    result is "force".
    loads: ``force`` and ``torque``, each a number or an array, None where it is not given.
    Raises ParameterError for a feedback, where both are given, and where neither of the two and no
    slope is given.
    """
    names = [name for name, value in loads.items() if value is not None]
    for name in names:
        if isinstance(loads[name], Feedback):
            raise described_error(name, "is a Feedback", "a number or an array where V is given")
    if len(names) == 2:
        sentence = "V, force and torque are all given: give two of them, the third is computed"
        raise ParameterError("V, force, torque", "all", "two of them", sentence)
    if not names and slope is None:
        sentence = "V is given without force, torque or slope: give one of them too"
        raise ParameterError("V", "alone", "with one of force, torque, slope", sentence)
    return names[0] if names else "force"


# --- How shear acts back on the rolling moments of a cover, for steady states ---

#: rounding of a balance of force and torque at rest, relative to the sum of both: some units in the
#: last place
_BALANCE_ROUNDING = 4e-15


class Shear(NamedTuple):
    """How shear acts back on the moments at some speeds; all 0 of half-spaces.

    factors : a of base and cylinder in the equations of the module, (2, n), dimensionless.
    excesses : e of base and cylinder there, (2, n), dimensionless.
    mu : coefficient of friction, a number or (n,).
    """

    factors: Floats
    excesses: Floats
    mu: Any

    def moments(self, Q: Floats) -> Floats:
        """Return what a creep force Q, (n,), adds to M_half_space and M_cylinder, (2, n)."""
        return -Q * (self.factors + self.excesses * (np.abs(Q) / self.mu))

    def traction(self, right_side: Floats, of_axis: float = 0.0, of_spin: float = 0.0) -> Floats:
        """Return the creep force Q, (n,), that balances axis or cylinder, or both together where
        feedback acts on omega.

        The balances are Q (1 + a_b + e_b |Q|/mu) = r_f of the axis, and Q (1 - a_c - e_c |Q|/mu) =
        r_q of the cylinder, with r_f = M_b - f and r_q = q - M_c (module).  With gains G_f and G_q
        on omega the right sides are r_f - G_f omega and r_q + G_q omega.  The first balance times
        G_q plus the second times G_f has no omega.

        right_side : of_axis r_f + of_spin r_q, dimensionless, (n,).  With gains on omega r_f and
            r_q are those at one omega, which may be any: the sum does not depend on it.
        of_axis, of_spin : weights with which the balance of the axis and that of the cylinder are
            added: (1, 0) and (0, 1) give one alone, (G_q, G_f) the sum without omega.
        Returns Q divided by P.  It is not limited: where |Q| exceeds mu, friction does not suffice.
        Raises ParameterError where both weights are not 0 and more than one Q up to mu may balance.
        """
        factor = of_axis * (1.0 + self.factors[0]) + of_spin * (1.0 - self.factors[1])
        excess = of_axis * self.excesses[0] - of_spin * self.excesses[1]
        # Q (factor + excess |Q|/mu) has the slope factor + 2 excess |Q|/mu in Q.  For |factor| > 2
        # |excess| it is monotone up to |Q| = mu, so that at most one such Q balances.  One balance
        # alone is not tested: a and e have the size of strains of the surface under the pressure,
        # far below 1, so that factor is near 1 and excess near 0
        if of_axis and of_spin and np.any(np.abs(factor) <= 2.0 * np.abs(excess)):
            raise _cancelling_error(of_spin, of_axis)
        # the root of Q (factor + excess |Q|/mu) = right_side that is continuous with excess = 0, in
        # a form without cancellation
        discriminant = factor**2 + 4.0 * excess * np.sign(factor) / self.mu * np.abs(right_side)
        # below 0 no Q balances; with 0 in its place |Q| becomes larger than mu, which callers
        # understand as friction that does not suffice
        root = np.sqrt(np.maximum(discriminant, 0.0))
        return 2.0 * right_side / (factor + np.copysign(root, factor))


def creep_beyond_free(contacts: Contacts, V: Floats, creep: Floats) -> Floats:
    """Return the creepage of a cover less that of free rolling, delta - delta_0 = delta_star (d + c
    d^2), from that of half-spaces, d delta_star (:mod:`.cover_law`); (n,), dimensionless.

    contacts : the law, at a kappa and a mu; of half-spaces the result is ``creep``.
    V : speeds, >= 0, (n,).
    creep : d delta_star, d in [-1, 1], (n,).
    """
    if contacts.law.cover is None:
        return creep
    low, high, star, free = contacts.fields(
        V, 0.0, "delta_minus", "delta_plus", "delta_star", "delta_0"
    )
    # d = 1 and -1 at the onsets: their mean is delta_0 + c delta_star
    return creep + (0.5 * (low + high) - free) * (creep / star) ** 2


def shear_at(contacts: Contacts, V: Floats) -> Shear:
    """Return how shear acts back on the moments, as :class:`Shear`.

    contacts : the law, at a kappa and a mu; of half-spaces all is 0.
    V : speeds, >= 0, dimensionless, (n,).
    """
    fields = np.zeros((4, V.size))
    if contacts.law.cover is not None:
        fields = contacts.fields(
            V,
            0.0,
            "reaction_half_space",
            "reaction_cylinder",
            "excess_half_space",
            "excess_cylinder",
        )
    return Shear(fields[:2], fields[2:], contacts.mu)


def find_speeds(law: LawTable, loads: Loads) -> tuple[Integers, Floats, Floats]:
    """Find the speeds at which a cover, or a table of the coupled solution, rolls steadily under
    loads without a gain on omega, in both directions.

    At each speed the balance of the axis gives Q, and that of the cylinder is a function of the
    speed alone, of which the zeros are found: of a cover between the nodes of
    :func:`.rolling_resistance.speed_nodes`.

    law : table of the material, of a cover or with ``coupled`` rows.
    loads : the loads, dimensionless, without a gain on omega; V is not given.
    Returns (index of the load; sign of V, 1.0 or -1.0; |V|, > 0), one entry for each crossing,
    (crossings,) each.
    """
    nodes = search_nodes(law)
    rounding = _rounding(law, loads)
    parts = [np.empty((3, 0))]
    for n, kappa in enumerate(loads.kappa):
        contacts = loads.contacts(law, n)
        for sign in (1.0, -1.0):
            left = functools.partial(_torque_left_by_speed, contacts, loads, n, sign)
            zeros = find_zeros(left, nodes, rounding[n])
            # zeros are log2(kappa V)
            parts.append(broadcast_rows((n, sign, np.exp2(zeros) / kappa), zeros.shape))
    load, signs, speeds = np.hstack(parts)
    return load.astype(np.int64), signs, speeds


def _rounding(law: LawTable, loads: Loads) -> Floats:
    """Return the rounding error of the balances of each load, (n,), dimensionless."""
    if law.coupled is not None:
        return np.full(loads.mu.size, _NOISE)
    return _BALANCE_ROUNDING * (np.abs(loads.force) + np.abs(loads.torque))


def _cancelling_error(of_force: float, of_torque: float) -> ParameterError:
    """Return the error of dimensionless gains on omega, of force and torque, that nearly cancel."""
    return described_error(
        "the gains omega= of the Feedback of force and of torque",
        f"are {of_force:g} times load T_ref and {of_torque:g} times load R T_ref (T_ref: unit of "
        "time), which nearly cancel",
        "such that the sum of both numbers is farther from 0, else the creep force is undetermined",
    )


def search_nodes(law: LawTable) -> Floats:
    """Return log2(kappa V) of the speeds between which steady speeds are sought, ascending, (n,):
    of a table 6 an octave, 40 octaves beyond its nodes to both sides, of a grid not beyond its
    fastest speed; else those of :func:`.rolling_resistance.speed_nodes`.
    """
    if law.coupled is None:
        return speed_nodes(law)
    low = np.log2(law.coupled.u[0]) - _FAR_OCTAVES
    high = min(np.log2(law.coupled.u[-1]) + _FAR_OCTAVES, np.log2(law.coupled.fastest))
    return np.linspace(low, high, int(_DENSITY * (high - low)))


def _torque_left_by_speed(
    contacts: Contacts, loads: Loads, load: int, sign: float, x: Floats
) -> Floats:
    """Return torque - M_cylinder - Q, with the Q that balances the force on the axis.

    contacts : the law of a cover, or a table, at one kappa and one mu.
    loads : the loads, dimensionless.
    load : index of the load, to which kappa and mu belong.
    sign : sign of the motion, in whose frame V > 0.
    x : log2(kappa V) of each speed, (n,).
    Returns the torque that is not balanced, divided by P R, (n,), as :func:`torque_left`; 0 where
    the cylinder rolls steadily.
    """
    V = np.exp2(x) / contacts.kappa
    return torque_left(contacts, V, *loads.at_speed(load, V, sign=sign))


def torque_left(contacts: Contacts, V: Floats, force: Floats, torque: Any) -> Floats:
    """Return torque - M_cylinder - Q, with the Q that balances ``force`` on the axis.

    contacts : the law of a cover, or a table, at a kappa and a mu, numbers or (n,).
    V : speeds >= 0, dimensionless, (n,).
    force, torque : loads divided by P and by P R, (n,) each.
    Returns the torque that is not balanced, divided by P R, (n,).  On a table the part of the force
    that the friction cannot balance is subtracted too.  The moments of a cover without traction are
    those of the creepage without creep force, where Q = 0.
    """
    if contacts.law.coupled is not None:
        delta, unbalanced_force = balance(contacts, V, -force)
        Q, cylinder = contacts.fields(V, delta, "Q", "M_cylinder")
        return torque - Q - cylinder - unbalanced_force
    shear = shear_at(contacts, V)
    free = contacts.free_creep(V)
    half_space, cylinder = contacts.fields(V, free, "M_half_space", "M_cylinder")
    Q = shear.traction(half_space - force, of_axis=1.0)
    return torque - cylinder - shear.moments(Q)[1] - Q


def is_balanced_at_rest(law: LawTable, loads: Loads) -> Booleans:
    """Return for each load whether V = omega = 0 is a state of equilibrium.

    Half-spaces rest where force + torque = 0.  A cover rests where the traction that balances the
    force on the axis also balances the torque, to rounding; friction may not suffice for it.  On a
    table the cylinder rests where the torque, in the limit V -> 0 of steady rolling to either side,
    does not exceed friction and rolling moment.

    law : table of the material.
    loads : the loads, dimensionless, of which force and torque are read.
    Returns booleans, (n,).
    """
    if law.moment_of_speed_alone:
        return loads.force + loads.torque == 0.0
    contacts = loads.contacts(law, slice(None))
    still = np.zeros(loads.mu.size)
    left = [
        torque_left(contacts, still, sign * loads.force, sign * loads.torque)
        for sign in (1.0, -1.0)
    ]
    return np.maximum(*left) <= _rounding(law, loads)


# --- Steady states on a table of the coupled solution ---

#: octaves of speed beyond the nodes of a table in which steady speeds are sought: there the law is
#: its limit
_FAR_OCTAVES = 40
#: speeds of an octave at which the balance is evaluated
_DENSITY = 6
#: rounding of the balance
_NOISE = 1e-14
#: sum of the gains on omega over the sum of their moduli, at or below which they nearly cancel: the
#: moments change with the creepage by up to some tenths of the traction
_CANCELLED = 0.3
#: bisections between the onsets of full slip, to rounding
_HALVINGS = 54


def balance(
    contacts: Contacts, V: Floats, load: Floats, spin: bool = False
) -> tuple[Floats, Floats]:
    """Return the creepages at which a table of the coupled solution carries given loads.

    contacts : a table of the coupled solution, at a kappa and a mu, numbers or (n,).
    V : speeds >= 0, dimensionless, (n,).
    load : required value of Q - M_half_space, with ``spin`` of Q + M_cylinder, dimensionless, (n,).
    spin : whether the cylinder is balanced, instead of the axis.
    Returns (creepages delta, dimensionless; the part of each load that the friction cannot balance,
    0 where it suffices), (n,) each.
    """
    from ..kernels.law.coupled_splines import balance_loop

    kappa, mu = broadcast_rows(contacts[1:], V.shape)
    out = np.empty((V.size, 2))
    balance_loop(contacts.law.record.table, kappa, mu, kappa * V, load, spin, out)
    return out[:, 0] / (2.0 * kappa), out[:, 1]


def loads_without_omega(
    contacts: Contacts,
    V: Floats,
    on_axis: Floats,
    on_spin: Floats,
    of_force: float,
    of_torque: float,
) -> tuple[Floats, Floats, Floats]:
    """Return the traction and the moments on a table at which the balances of axis and cylinder
    hold after omega, on which force and torque depend, is eliminated.

    With gains f_w and q_w on omega these are q_w (Q - M_half_space + f) + f_w (Q + M_cylinder - q)
    = 0, where f and q are the loads at any omega: an equation for the creepage, solved by bisection
    between the onsets of full slip.

    contacts : a table of the coupled solution, at a kappa and a mu, numbers.
    V : speeds > 0, dimensionless, (n,).
    on_axis, on_spin : force and torque, divided by P and by P R, at omega = 0 or any other speed,
        (n,) each.
    of_force, of_torque : gains of force and torque on omega.
    Returns (Q, M_half_space, M_cylinder), (n,) each; where friction does not suffice, the moments
    are those of the onset of full slip, and Q is what the equation then requires.
    Raises ParameterError where the gains nearly cancel, so that several creepages may balance.
    """
    total = of_torque + of_force
    if abs(total) <= _CANCELLED * (abs(of_torque) + abs(of_force)):
        raise _cancelling_error(of_force, of_torque)
    # weights of the two balances, divided by their sum: the factor of Q is then 1
    axis = of_torque / total
    spin = of_force / total
    wanted = spin * on_spin - axis * on_axis
    low, high = contacts.fields(V, 0.0, "delta_minus", "delta_plus")
    for _ in range(_HALVINGS):
        delta = 0.5 * (low + high)
        Q, half_space, cylinder = contacts.fields(V, delta, "Q", "M_half_space", "M_cylinder")
        # falls with the creepage, as Q grows
        left = wanted - (Q - axis * half_space + spin * cylinder)
        low = np.where(left > 0.0, delta, low)
        high = np.where(left > 0.0, high, delta)
    # left is rounding, but where no creepage between the onsets balances: what friction lacks
    return Q + left, half_space, cylinder


def moments_of_losses(contacts: Contacts, V: Floats, delta: Floats) -> Floats:
    """Return the loss of each body divided by its speed: loss_half_space/V, loss_cylinder/omega.

    The error of the table may make the losses of the bodies larger than the power that the loads
    supply.  Both are then reduced in proportion, and the slip loss is 0.

    contacts : a table of the coupled solution, at a kappa and a mu, numbers or (n,).
    V, delta : speeds >= 0 and creepages, dimensionless, (n,) each.
    Returns moments divided by P R, of base and cylinder, (2, n).
    """
    from ..kernels.law.spline_law import look_up

    law, kappa, mu = contacts
    # columns in the order of law_rows.FIELDS; moments are times kappa
    columns = look_up(law.record.table, kappa * V, 2.0 * kappa * delta).T
    Q_over_mu, M_half_space, M_cylinder, *_, work_half_space, work_cylinder = columns
    omega_over_V = 1.0 + delta
    half_space = M_half_space + 0.5 * work_half_space
    cylinder = M_cylinder + 0.5 * work_cylinder / omega_over_V
    # powers divided by V, times kappa
    lost = half_space + omega_over_V * cylinder
    supplied = M_half_space + omega_over_V * M_cylinder
    supplied += kappa * mu * delta * Q_over_mu
    reduction = np.divide(supplied, lost, out=np.ones_like(lost), where=lost > 0.0)
    return np.clip(reduction, 0.0, 1.0) * np.stack([half_space, cylinder]) / kappa
