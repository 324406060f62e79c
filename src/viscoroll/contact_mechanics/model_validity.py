"""Which assumptions of the model a state violates: :func:`validity`.

:class:`Steadiness` says whether the law of steady rolling may drive a motion, and down to which
speed.  :func:`assess_cover` and :func:`assess_traction` examine the assumptions of the law of a
layer of finite thickness, and state its errors.  l0 is the contact length at rest that the same
bodies would have as half-spaces.
"""

from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import Any

import numpy as np

from ..core import Numbers, ParameterError, broadcast_shape, check_array, divide_by_unit
from .assumptions import (
    UNKNOWN,
    UNKNOWN_OF_COVERS,
    Assumption,
    Validity,
    assess_creep,
    assess_position,
    assess_small_contact,
    largest,
)
from .contact_table import FASTEST, evaluate_contact
from .free_rolling import FreeRolling, Reach, Start
from .parameters import Parameters, Roller, resolve_model

# --- Whether the law of steady rolling may drive a motion, and down to which speed ---

#: Largest unsteadiness, dimensionless, at which the error of V is below some 10 %: measured with a
#: transient solver of many modes (docs/validity.md).
STEADY_LIMIT = 0.1
#: Largest part of its speed that a start from rest may lose, dimensionless (seven tenths of its
#: energy): a cylinder that loses more stays in its indentation.
LARGEST_LOSS = 0.45
#: Speed in units of u that stands for rest where a motion ended, dimensionless: the lower end of
#: the start speeds.
_REST = 1e-300


class Steadiness(Assumption):
    """Whether the law of steady rolling may drive a motion, and how far; all quantities in the
    units of the call.

    ``value`` is the unsteadiness gamma |N(V)|/(1 + j), dimensionless, for a motion the largest so
    far; up to 0.1 is allowed, where the error of V is below some 10 %.  The attributes describe
    free rolling from each V by the law of steady rolling, of motions from the fastest speed of
    each; they have the shape of V, or one value for each motion.  Without a gamma, at rest and for
    a layer of finite thickness the entry ``steady`` of a report is a plain :class:`Assumption`
    without them.

    Attributes
    ----------
    one_percent, ten_percent : the :class:`Reach` within which the error of V is below about 1 % and
        10 %.
    start : the losses of a :class:`Start` after a long standstill.
    whole : the distance to rest, infinite for elastic bodies.
    share : part of that distance, or of the distance of a motion, at which the error of V exceeds
        10 %, 0 to 1; NaN for a motion whose x is not known.

    Examples
    --------
    >>> import viscoroll as vr
    >>> steady = vr.presets.RUBBER_CYLINDER.validity(2.0).steady
    >>> bool(steady.holds), float(steady.whole) > 50.0  # m
    (True, True)
    """

    #: the states, in the units of the call
    free: FreeRolling
    #: ``share`` of a motion; None for single states
    motion_share: Any = None

    @classmethod
    def of(cls, free: FreeRolling) -> Assumption:
        """Return the assumption ``steady`` of states from which the cylinder rolls freely.

        Parameters
        ----------
        free : the states, a :class:`.free_rolling.FreeRolling`, in the units of the call; gamma
            must be known.

        Returns
        -------
        Assumption
            A :class:`Steadiness` whose value is the unsteadiness of each state; a plain
            :class:`Assumption`, which is undecided, if all states (one at least) are at rest.

        Examples
        --------
        >>> import viscoroll as vr
        >>> from viscoroll.contact_mechanics.model_validity import Steadiness
        >>> states = vr.presets.RUBBER_CYLINDER.validity([1.0, 2.0]).steady.free
        >>> Steadiness.of(states).holds
        array([ True,  True])
        """
        if free.u.size and not free.u.any():
            sentence = "the error of motions by the law of steady rolling is not estimated at V = 0"
            return Assumption(None, None, f"{sentence}: give another V")
        return cls._create(free.unsteadiness, free)

    @classmethod
    def along(cls, free: FreeRolling, rolls: Any, x: Any, *, ends: bool) -> Steadiness:
        """Return the assumption ``steady`` of one motion, or of several.

        Parameters
        ----------
        free : states at the output times, (times,) or (times, motions), with gamma; each gives the
            distance and the speeds of free rolling from there.  A state at rest after a motion has
            begun counts as the limit V -> 0.
        rolls : mask of the times at which motions are not in full slip, in the shape of u.  In full
            slip friction rules the motion, and the unsteadiness counts as 0.
        x : distances travelled in the unit of the caller, in the shape of u; NaN where they are not
            known.
        ends : whether ``value`` is that of each motion as a whole, () or (motions,); else, for one
            motion only, it is the largest so far at each time, (times,).

        Returns
        -------
        Steadiness
            The assumption, whose value is dimensionless; its ``share``, () or (motions,), is the
            part of each motion's distance with an error of V above 10 %, 0 for a motion that stays
            where it is, NaN where x is not known.

        Examples
        --------
        >>> import viscoroll as vr
        >>> from viscoroll.contact_mechanics.model_validity import Steadiness
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
        >>> states = motion.roller.validity(motion.V).steady.free
        >>> float(Steadiness.along(states, motion.regime > 0, motion.x, ends=True).share)
        0.0
        """
        # rest after a motion counts as a tiny speed, rest before it stays 0
        free = dataclasses.replace(
            free,
            u=np.where(np.maximum.accumulate(free.u > 0.0, axis=0), np.maximum(free.u, _REST), 0.0),
        )
        value = np.maximum.accumulate(np.where(rolls, free.unsteadiness, 0.0), axis=0)
        # for each motion the time of its largest u
        fastest = free.take((np.argmax(free.u, axis=0), *np.indices(free.u.shape[1:])))
        to_rest = free.distance()
        steps = np.abs(np.diff(x, axis=0))
        # distance to rest below which the error exceeds 10 %; all of it if it does at the fastest
        slow = np.where(
            fastest.unsteadiness > STEADY_LIMIT, np.inf, fastest.reach(STEADY_LIMIT).left
        )
        # the part of each step that lies below that speed, as in free rolling
        with np.errstate(invalid="ignore"):
            below, whole = (
                np.abs(np.diff(left, axis=0)) for left in (np.minimum(to_rest, slow), to_rest)
            )
        part = np.divide(
            below, whole, out=1.0 * (to_rest[1:] < slow), where=(0.0 < whole) & (whole < np.inf)
        )
        share = (steps * rolls[1:] * part).sum(axis=0) / np.maximum(steps.sum(axis=0), _REST)
        return cls._create(value[-1] if ends else value, fastest, share)

    @classmethod
    def _create(cls, value: Any, free: FreeRolling, motion_share: Any = None) -> Steadiness:
        """Return the assumption with its sentence, which describes the state of the largest
        unsteadiness.

        value: unsteadiness, dimensionless, any shape; of several motions (motions,), of one () or
        (times,).
        free: the states in the shape of ``value``; of motions the fastest one of each, (motions,)
        or ().
        motion_share: the share of motions, (motions,) or (), maybe NaN; None for single states.
        Returns the assumption, which holds, in the shape of ``value``, where that is at most 0.1;
        of an empty value the sentence says that there is no motion.
        """
        sentence = "there is no motion"
        if np.size(value):
            worst = (
                free.take(np.unravel_index(np.argmax(value), free.u.shape)) if free.u.ndim else free
            )
            sentence = (
                _describe_free(worst)
                if motion_share is None
                else _describe_motion(worst, np.max(value), np.mean(motion_share))
            )
        created = cls(value <= STEADY_LIMIT, value, sentence)
        created.free = free
        created.motion_share = motion_share
        return created

    def worst_of_parts(self, last: Any) -> Steadiness:
        """Return the assumption of a motion with one value for each part of it: the largest up to
        the end of the part.

        Parameters
        ----------
        last : index of the last state of each part, an array (parts,), ascending.

        Returns
        -------
        Steadiness
            With holds and value of shape (parts,); its attributes are those of the motion.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> steady = (
        ...     vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0, 3.0]).validity().steady
        ... )
        >>> steady.worst_of_parts(np.array([1, 2])).value.shape
        (2,)
        """
        chosen = self._replace(holds=self.holds[last], value=self.value[last])
        vars(chosen).update(vars(self))
        return chosen

    @cached_property
    def one_percent(self) -> Reach:
        """Part of free rolling with an error of V below 1 %, a :class:`Reach` (unsteadiness up to
        0.01).
        """
        return self.free.reach(0.1 * STEADY_LIMIT)

    @cached_property
    def ten_percent(self) -> Reach:
        """Part of free rolling with an error of V below 10 %, a :class:`Reach` (unsteadiness up to
        0.1).
        """
        return self.free.reach(STEADY_LIMIT)

    @cached_property
    def start(self) -> Start:
        """Losses of a start after a long standstill, a :class:`Start`."""
        return self.free.start()

    @cached_property
    def whole(self) -> Any:
        """Distance to rest by the law of steady rolling; infinite for elastic bodies, also at V =
        0.
        """
        return self.free.distance()

    @cached_property
    def share(self) -> Any:
        """Part of a distance on which the error of V exceeds 10 %, dimensionless, 0 to 1.

        Of motions it is the part of the distance of each motion, one value for each, NaN where x is
        not known.  Else it is the part of the distance to rest in free rolling, in the shape of the
        states: 1 where V is too slow at the start already, 0 at rest and for elastic bodies.
        """
        if self.motion_share is not None:
            return self.motion_share
        left = self.ten_percent.left
        slow = np.asarray(self.value > STEADY_LIMIT, float)
        return np.divide(left, self.whole, out=slow, where=left < self.whole)[()]


def _describe_free(free: FreeRolling) -> str:
    """Return sentences on free rolling from one state: distance, speeds at which errors are
    reached, loss of a start.

    free: a single state (u without axes), whose units the sentences use; dimensionless without
    names of units.
    Returns a str without a full stop.  Where the unsteadiness is above 0.1 it states alone from
    which speed on it is not; for an elastic cylinder alone that it never stops.
    """
    speed, time, length = free.units
    value = free.unsteadiness
    most = free.reach(STEADY_LIMIT)
    whole = free.distance()
    text = f"unsteadiness (relative error of a computed V) {value:.2g}, "
    text += f"up to {STEADY_LIMIT} is allowed: "
    if value > STEADY_LIMIT:
        return text + (
            "V is too slow for a motion by the law of steady rolling (contact states and the "
            "speeds of steady are valid, whether these are stable is not); the error of a computed "
            f"V is below 10 % above {most.speed:.2g}{speed}"
        )
    if not np.isfinite(whole):
        return text + "an elastic cylinder never stops"
    fine = free.reach(0.1 * STEADY_LIMIT)
    start = free.start()
    text += f"left to coast the cylinder rolls {whole:.4g}{length}; "
    text += "the error of its computed V is below "
    if fine.time:  # 0 where the error is above 1 % at the start already
        text += f"1 % down to {fine.speed:.2g}{speed}, below " if fine.speed else "1 % until rest"
    if fine.speed:
        end = (
            f"down to {most.speed:.2g}{speed}, which is reached after a time of "
            f"{most.time:.3g}{time}, at a distance of {most.left:.2g}{length} before rest"
        )
        text += f"10 % {end if most.speed else 'until rest'}"
    if start.speed > LARGEST_LOSS * (free.u * free.speed):
        return text + "; after a long standstill the cylinder would not leave its indentation"
    return (
        f"{text}; a start after a long standstill costs {start.speed:.2g}{speed} of speed and "
        f"{start.distance:.2g}{length} of distance"
    )


def _describe_motion(free: FreeRolling, most: float, share: float) -> str:
    """Return sentences on the error of a motion, or of the worst of several.

    free: fastest state of the motion, u without axes.
    most: largest unsteadiness of the motion, dimensionless; up to 0.1 the speed and the share are
    not stated.
    share: fraction of its distance with an error above 10 %, of several motions the mean; NaN where
        it is not known, which the sentence then leaves out.
    Returns a str without a full stop.
    """
    text = (
        f"unsteadiness (relative error of the computed V) up to {most:.2g}, where {STEADY_LIMIT} "
        "is allowed: the error is below 10 % "
    )
    if most <= STEADY_LIMIT:
        return text + "throughout"
    speed = f"{free.reach(STEADY_LIMIT).speed:.2g}{free.units[0]}"
    below = (
        "" if np.isnan(share) else f"; {100.0 * share:.2g} % of the distance is rolled more slowly"
    )
    return f"{text}down to {speed}{below}"


# --- The assumptions of the law of a layer of finite thickness, and its stated errors ---

#: Poisson's ratios at which the largest half contact length is known, dimensionless.
_NU = (0.0, 0.3, 0.45, 0.5)
#: Half contact length divided by the thickness, at those Poisson's ratios, up to which one stick
#: zone in front with slip behind is right at all creepages; beyond it the front slips too near full
#: slip.
_MOST_THETA = (3.0, 2.0, 1.5, 1.25)
#: Thicknesses divided by l0 at which the error of Q is known, dimensionless.
_THICKNESS = (0.2, 0.3, 0.5, 1.0, 2.0, 5.0)
#: Largest error of Q divided by mu P at those thicknesses, compared with the exact solution without
#: coupling, for every nu, material, speed and creepage (held by
#: ``pipeline/evidence/prove/states.py``).
_ERROR = (0.064, 0.058, 0.046, 0.029, 0.018, 0.011)
#: Error of Q divided by mu P, beside those, where shear acts back, however little: no more, with
#: the next, in any scene of ``pipeline/evidence/measure/covers.py``, beside the coupled solution.
_LEAST_SHEAR_ERROR = 0.02
#: Error of Q divided by mu P and by the value of the assumption ``traction``, beside both.
_SHEAR_ERROR = 0.4


def stated_error(thickness: float) -> float:
    """Return the largest error of Q divided by mu P, compared with the exact solution without
    coupling.

    thickness: thickness of the layer divided by l0, > 0.
    Returns the error, dimensionless, interpolated between the thicknesses 0.2 to 5 at which it was
    measured; the value of the nearest end outside of them.
    """
    return np.interp(thickness, _THICKNESS, _ERROR)


def assess_cover(scene: Parameters, lam: Any) -> Assumption:
    """Return the assumption ``thick`` of the contact on a cover.

    scene: dimensionless parameters of a roller with a cover, or with an array of covers.
    lam: contact lengths divided by l0, an array of any shape, which broadcasts with the scene.
    Returns the assumption, whose value is half the contact length divided by the thickness of the
    thinner layer, in the broadcast shape; it holds where the law is a table of the coupled
    solution, and else where that of each layer is at most the limit for its Poisson's ratio, from 3
    at nu = 0 to 1.25 at nu = 1/2, up to which one stick zone in front with slip behind is right at
    every creepage.  The sentence states the thickness of the thinnest cover, and the limit for the
    cover whose limit is lowest.
    """
    cover: Any = scene.cover
    half = 0.5 * lam
    # (half contact length over thickness that is allowed, thickness) of each layer
    layers = [
        (np.interp(nu, _NU, _MOST_THETA), h)
        for _, nu, h in map(cover.body, ("cylinder", "base"))
        if h is not None
    ]
    holds = np.all([half / h <= limit for limit, h in layers], axis=0)
    theta = half / cover.thinnest
    allowed = (
        "any ratio is allowed, as pressure and shear are solved together"
        if scene.tabulated
        else f"up to {min(np.min(limit) for limit, _ in layers):.3g} times is allowed with "
        "coupled=False, whose law has stick in front and slip behind"
    )
    sentence = (
        f"half the contact length is up to {largest(theta):.2g} times the thickness of the layer; "
        f"{allowed} (the thickness is {np.min(cover.thinnest):.3g} l0, l0: contact length at rest "
        "of half-spaces of the same materials)"
    )
    return Assumption(holds | scene.tabulated, theta, sentence)


def assess_traction(scene: Parameters, V: Any) -> Assumption:
    """Return the assumption ``traction`` of a cover: the first-order effect of shear on the
    pressure, which the fast law contains, is small enough.

    With delta_0* the mean strain mirrored about the middle of the contact (docs/theory_covers.md),
    it holds where |delta_0* - delta_0| is at most delta_star/2; beyond, both ends of the contact
    slip.  The sentence states the largest errors of Q and M beside the coupled solution, where it
    holds (docs/validity_covers.md; tested in tests/contact_law/test_fast_law.py).  The error of Q
    is the sum of the error without coupling, of 0.02 mu P, and of 0.4 mu P times the value (at
    most 1).  The error of M follows from it, since M has the terms Q delta_0 and
    Q (delta_0* - delta_0).

    scene: dimensionless parameters of a roller with a cover, or with an array of covers.
    V: speeds, dimensionless, any sign, an array of any shape; broadcasts with the scene.
    Returns the assumption, whose value is 2 |delta_0* - delta_0|/delta_star, in the broadcast
    shape.  It holds for any value where the law is a table of the coupled solution; the sentence
    then states what the errors would be without it.
    Raises ParameterError for kappa |V| above 1e300, shapes that do not broadcast, and a layer too
    thin for its law.
    """
    by_base, by_cylinder, free, star = evaluate_contact(
        scene.uncoupled,
        np.abs(V),
        np.zeros(()),
        creep_is_omega=False,
        names=("excess_half_space", "excess_cylinder", "delta_0", "delta_star"),
    ).values()
    # the law limits the excess x in units of delta_star/2 to x/(1 + x^4)^(1/4)
    limited = np.minimum(2.0 * np.abs(by_base + (1.0 + free) * by_cylinder) / star, 1.0)
    with np.errstate(divide="ignore"):
        value = limited / (1.0 - limited**4) ** 0.25
    effect = np.minimum(value, 1.0)
    cover: Any = scene.cover
    error = stated_error(np.min(cover.thinnest)) + _LEAST_SHEAR_ERROR + _SHEAR_ERROR * effect
    levers = np.abs(free) + 0.5 * star * effect
    error_of_M = 2.0 * scene.kappa * scene.mu * error * levers
    most = largest(value)
    errors = (
        f"the error of Q is up to {100.0 * largest(error):.2g} % of mu P and that of "
        f"M up to {largest(error_of_M):.1g} P l0"
    )
    if most > 1.0:
        errors += (
            f", and more where traction.value is above 1 (here up to {most:.2g}): there the "
            "contact slips at both ends, and this law does not hold"
        )
    sentence = (
        f"the effect of shear on the pressure is approximate (as with coupled=False): {errors}; "
        "contact(method='coupled') solves both together"
    )
    if scene.tabulated:
        sentence = (
            "pressure and shear are solved together, so that the effect of shear on the pressure "
            f"is no error; with coupled=False {errors}"
        )
    return Assumption((value <= 1.0) | scene.tabulated, value, sentence)


# --- Which assumptions of the model a state violates ---


def validity(
    roller: Roller, V: Numbers, *, omega: Numbers | None = None, density: float | None = None
) -> Validity:
    """Report which assumptions of the model the contact of a rolling cylinder at speed V violates.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` with V in m/s and omega in rad/s.
    V : speed of the axis, any sign, a number or an array that broadcasts with array parameters; of
        a Scene divided by R/T_ref, where T_ref is its unit of time.
    omega : angular velocity, any sign, broadcasts with V; of a Scene multiplied by T_ref; None: the
        creepage is not known, and ``creep`` is not decided.
    density : density of a Cylinder, and of the base where they are alike or the cylinder is rigid,
        kg/m^3; default: as the materials have it; without that of the softer body the slowest shear
        wave is not known.

    Returns
    -------
    Validity
        For each assumption a number, whether it holds (both in the broadcast shape, None where
        nothing decides), and a sentence; ``print`` shows them, and ``failed`` names those that
        fail.  A Scene decides ``small_contact`` and ``under_axis``; ``steady`` if it has a gamma, a
        V other than 0 and no layer of finite thickness; ``creep`` with omega; of a layer ``thick``,
        with half the contact length divided by its thickness, and ``traction``.  For a Cylinder
        ``quasistatic`` compares the speed of the axis, and that of the circumference where omega is
        given, with the slowest shear wave, sqrt(G/density), G = E/(2 (1 + nu)) of long times, of
        the bodies whose density is known, and is undecided without that of the softer one;
        ``bodies`` has Dundurs' constant, ``measured`` the transit frequency in 1/s if a material
        has measured data.  ``plane`` is not decided.

    Raises
    ------
    ParameterError
        NaN or infinite speeds, a density that is not one positive number, a density for a Scene,
        shapes that do not broadcast, what is no scene and no cylinder, a layer too thin for its
        law, of a layer also kappa |V| above 1e300; times of a material beyond 1e-100 to 1e100
        T_ref.

    Examples
    --------
    >>> import viscoroll as vr
    >>> report = vr.validity(vr.presets.RUBBER_CYLINDER, 2.0, omega=20.0)
    >>> bool(report.small_contact.holds)
    True
    """
    _, scene, scale = resolve_model(roller, "validity")
    V = check_array("V", V, unit=scale)
    spin = None
    with np.errstate(over="ignore"):
        if omega is not None:
            omega = check_array("omega", omega, unit=scale)
            spin = divide_by_unit("omega", omega, scale["omega"])
        speed = divide_by_unit("V", V, scale["V"])
    broadcast_shape(V=V, omega=omega, **scene.numbers)
    law = scene.uncoupled  # no table is made for a report
    if scene.cover is None:
        free = FreeRolling.of_scene(law, speed)
        report = UNKNOWN
        if scene.gamma is not None:
            report = UNKNOWN._replace(steady=Steadiness.of(free.scaled(scale)))
        # beyond the fastest speed every contact is in its limit of fast rolling
        fastest = 0.5 * FASTEST / scene.kappa
        speed = np.clip(speed, -fastest, fastest)
    lam, epsilon, full_slip = evaluate_contact(
        law,
        speed,
        creep=np.zeros(()) if spin is None else spin,
        creep_is_omega=spin is not None,
        names=("lam", "epsilon", "full_slip"),
    ).values()
    if scene.cover is not None:
        report = UNKNOWN._replace(
            steady=UNKNOWN_OF_COVERS,
            thick=assess_cover(scene, lam),
            traction=assess_traction(scene, speed),
        )
    report = report._replace(
        small_contact=assess_small_contact(lam * (1.0 + epsilon) / (2.0 * scene.kappa)),
        under_axis=assess_position(epsilon),
    )
    if spin is not None:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            delta = np.where(spin == speed, 0.0, (spin - speed) / speed)
        report = report._replace(creep=assess_creep(delta, full_slip))
    if roller.body_data is not None:
        return roller.body_data.extend_validity(report, lam, V, omega=omega, density=density)
    if density is not None:
        raise ParameterError(
            "density",
            density,
            "None",
            "density is given for a Scene: leave it out, or use a Cylinder",
        )
    return report
