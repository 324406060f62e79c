"""Steady rolling under force, torque or slope: :func:`steady`, all equilibria with their stability.

The equations are V' = Q - M_half_space + force = 0 and j omega' = -Q - M_cylinder + torque = 0 (over gamma t).
Their sum M(V) = force + torque determines V; Q = torque - M_cylinder then determines the creepage.  They are Eq. (22)
of Zobova and Goryacheva, Acta Mechanica (2020), with a force and a torque, divided by P and P R, and with the moment M
split between the two bodies.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.array_types import Integers, Numbers
from ...core.drive import Feedback, make_dimensionless
from ...core.errors import ParameterError, described_error
from ...core.labels import strip_labels
from ...materials.law.table import LawTable
from ..parameters import Roller, refuse_arrays, refuse_cover, resolve_model, scale_of
from ..validity.model_warnings import warn_of_contact
from .cover_balance import find_speeds_of_cover, is_balanced_at_rest
from .loads import Loads, loads_of
from .resistance import LEAST_LOAD, MOST_LOAD, branches
from .result import Diagnosis, Steady, pack_result
from .scan import scan_states
from .states import Field, States, find_crossings, states_at
from .table_balance import find_speeds_on_table, rests_on_table


def steady(
    roller: Roller,
    *,
    force: Numbers | Feedback | None = None,
    torque: Numbers | Feedback | None = None,
    slope: Numbers | None = None,
    V: Numbers | None = None,
) -> Steady:
    """Find steady rolling of a cylinder on its base: every pair of V and omega at which force and torque balance.

    For each equilibrium the result says whether it is stable.  The arguments broadcast against each other and against
    array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa, mu and j are used; or a :class:`Cylinder`, in SI units
        per m of its length: V in m/s, omega in rad/s, force and Q in N/m, torque and M in N m/m, ``eigenvalues`` in
        1/s, powers of ``loss`` in W/m.
    force : along V, of a Scene divided by P; default 0.  It may be a :class:`Feedback` that is constant in time, with
        numbers for its gains.
    torque : along omega, of a Scene divided by P R; default 0.  It may be such a :class:`Feedback` too.
    slope : theta, rad, in (-pi/2, pi/2), > 0 pushes along +V.  The load is then P cos(theta), and P sin(theta) adds to
        ``force``.  Of a Scene kappa becomes kappa/sqrt(cos(theta)), and the divisors of forces and torques have
        P cos(theta) in place of P.
    V : the speed, any sign, in place of one of force and torque, which is found (a slope alone counts as the force
        given, and the torque is found); of a Scene divided by R/T_ref, where T_ref is its unit of time.

    Returns
    -------
    Steady
        Of one load ``V``, ``omega``, ``delta``, ``Q``, ``M``, ``stable`` and the other fields as arrays of exactly its
        equilibria by rising |V|, none to many.  Arrays of loads have that axis after their own, padded with NaN
        (``stable``: False), and the ``count`` of equilibria for each load; arrays of xarray and series of pandas give
        their labels (series: data frames, a column an equilibrium).  ``reason`` says why there is none.

    Raises
    ------
    ParameterError
        NaN or infinite input, a slope out of range, V together with both or neither of force and torque (a slope alone
        counts as the force) or with a feedback, an array of alphas or materials, a layer too thin for its law, times of
        a material beyond 1e-100 to 1e100 T_ref, shapes that do not broadcast, labelled arrays beside plain ones or with
        other coordinates, a unit of another dimension, kappa |V| above 1e100; without a gain on omega also kappa |force
        + torque| in (0, 1e-120) or above 1e80; a gain on V, divided by the longest retardation time, of a size outside
        1e-40 to 1e8; a feedback that changes with time or has arrays of gains; what is no scene and no cylinder.

    Warns
    -----
    ModelWarning
        Of a Cylinder: its contact at rest is longer than its radius, or the transit frequency at an equilibrium is
        outside the band in which its material was measured.

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.steady(vr.presets.RUBBER_CYLINDER, force=1.0)  # N/m
    >>> found.stable.tolist()
    [True, False]

    Notes
    -----
    For |force + torque| below the largest M(V) there are two equilibria for each maximum of M(V), on its rising and
    its falling branch; they need |Q| < mu.  For force + torque = 0 without feedback there is V = 0 alone, where
    ``delta`` and ``eigenvalues`` are those of V -> 0 (that of slip is -inf).  Where equilibria are a continuum (elastic
    bodies without a drive; Q = mu exactly) none is listed and ``reason`` says so.  A feedback on omega is solved by a
    scan of V, some 0.02 s a load.

    Stability is that of (V, omega) under force and torque as named, also where V was given.  Without feedback
    det = (dQ/domega) M'(V)/j, so that equilibria on a falling branch of M(V) are saddles.

    The relative error of speeds is below 1e-12/sqrt(1 - |force + torque|/M_top), where M_top is the extremum of M
    nearby; that of fields which follow from Q is this bound divided by ``grip`` (``tests/test_steady.py``).
    """
    units = scale_of(roller)
    plain, labels = strip_labels({"force": force, "torque": torque, "slope": slope, "V": V}, units)
    slope = plain["slope"]
    level, (roller, scene, scale) = roller, resolve_model(roller, "steady", slope=slope)
    if type(scene.alpha) is not float:
        refuse_arrays(level, scene, ("alpha",), slope=slope)
    force = make_dimensionless("force", plain["force"], scale)
    torque = make_dimensionless("torque", plain["torque"], scale)
    V = make_dimensionless("V", plain["V"], scale)
    loads = loads_of(scene, force, torque, slope, V)
    law = scene.rolling_law
    assert law is not None  # arrays of materials are refused
    elastic = law.alpha == 1.0
    gained = bool(loads.gains.V or loads.gains.omega)
    if loads.V is not None:  # one of force and torque is found; V = 0 is at rest
        moving = np.flatnonzero(loads.V)
        speed = loads.V[moving]
        rolling = states_at(law, loads, moving, np.sign(speed), np.abs(speed))
    elif loads.gains.omega:
        if law.coupled is not None:
            raise described_error("a gain on omega", "is given", "left out for a table of the coupled solution")
        refuse_cover(scene, "a feedback on omega is not examined: give one on V alone")
        rolling = scan_states(law, loads)
    else:
        rolling = _states_under_load(law, loads)
    neutral = elastic and loads.given is None and not gained
    resting = _loads_at_rest(law, loads, neutral)
    if resting.size:
        rolling = States.joined(rolling, States.at_rest(loads, resting, law))
    existing = rolling.existing()
    count = np.bincount(existing.load, minlength=loads.mu.size)
    maximum = (math.nan, math.nan) if gained or elastic or law.coupled is not None else branches(law, 0.0).maximum
    states = rolling.load, rolling.rows[Field.V], rolling.rows[Field.Q]
    reasons = Diagnosis(loads, states, count, maximum, neutral)
    found = pack_result(loads, existing, reasons, scale, labels)
    warn_of_contact(roller, found.V if labels is None else np.asarray(found.V))
    return found


def _loads_at_rest(law: LawTable, loads: Loads, neutral: bool) -> Integers:
    """Return the indices of the loads under which the cylinder is examined at rest, V = omega = 0, (m,).

    law : table of the material.
    loads : the loads, dimensionless.  Chosen are those with V = 0 where V was given, else those with force + torque = 0
        at rest, whether or not the friction suffices.
    neutral : whether every speed is steady without a load, as of elastic bodies; without a given V rest is then chosen
        only where |torque| exceeds mu, so that the friction does not suffice, which the result has to say.
    """
    if loads.V is not None:
        return (loads.V == 0.0).nonzero()[0]
    rests = rests_on_table(law, loads) if law.coupled is not None else is_balanced_at_rest(law, loads)
    return (rests & (np.abs(loads.torque) > loads.mu) if neutral else rests).nonzero()[0]


def _states_under_load(law: LawTable, loads: Loads) -> States:
    """Find all states of rolling under loads without a gain on omega; rest is not among them.

    law : table of the material.
    loads : the loads, dimensionless; V is not given.
    Returns the :class:`States`, unsorted, whether or not the friction suffices; none for elastic bodies without a gain
    on V, and none where force + torque equal M at no speed.
    Raises ParameterError for kappa |force + torque| other than 0 that is below :data:`LEAST_LOAD` or above
    :data:`MOST_LOAD`, and for a gain out of range.
    """
    with np.errstate(over="ignore"):  # what is infinite is refused
        gain, total = loads.gains.V, loads.kappa * (loads.force + loads.torque)
    size = np.abs(total)
    wrong = (size > MOST_LOAD) | ((size > 0.0) & (size < LEAST_LOAD))
    if wrong.any():
        allowed = f"0, or {LEAST_LOAD:g} to {MOST_LOAD:g} in magnitude"
        raise ParameterError("kappa (force + torque)", f"{total[wrong][0]:g}", allowed)
    if not gain and law.alpha == 1.0:
        return States.none()
    if law.coupled is not None:
        load, sign, V = find_speeds_on_table(law, loads)
        return states_at(law, loads, load, sign, V)
    if law.cover is not None:
        load, sign, V = find_speeds_of_cover(law, loads)
        return states_at(law, loads, load, sign, V)
    load, sign, u = find_crossings(law, gain, total)
    return states_at(law, loads, load, sign, u / loads.kappa[load])
