"""Whether the law of steady rolling may drive a motion, and down to which speed: :class:`Steadiness`."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from .assumptions import Assumption
from .free_rolling import FreeRolling, Reach, Start

#: Largest unsteadiness, dimensionless, at which the error of V is below some 10 %: measured with a transient solver of
#: many modes (docs/validity.md).
STEADY_LIMIT = 0.1
#: Largest part of its speed that a start from rest may lose, dimensionless (seven tenths of its energy): a cylinder
#: that loses more stays in its indentation.
LARGEST_LOSS = 0.45
#: Speed in units of u that stands for rest where a motion ended, dimensionless: the lower end of the start speeds.
_REST = 1e-300


class Steadiness(Assumption):
    """Whether the law of steady rolling may drive a motion, and how far; all quantities in the units of the call.

    ``value`` is the unsteadiness gamma |N(V)|/(1 + j), dimensionless, for a motion the largest so far; up to 0.1 is
    allowed, where the error of V is below some 10 %.  The attributes describe free rolling from each V by the law of
    steady rolling, of motions from the fastest speed of each; they have the shape of V, or one value for each motion.
    Without a gamma, at rest and for a layer of finite thickness the entry ``steady`` of a report is a plain
    :class:`Assumption` without them.

    Attributes
    ----------
    one_percent, ten_percent : the :class:`Reach` within which the error of V is below about 1 % and 10 %.
    start : the losses of a :class:`Start` after a long standstill.
    whole : the distance to rest, infinite for elastic bodies.
    share : part of that distance, or of the distance of a motion, at which the error of V exceeds 10 %, 0 to 1; NaN for
        a motion whose x is not known.

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
        free : the states, a :class:`.free_rolling.FreeRolling`, in the units of the call; gamma must be known.

        Returns
        -------
        Assumption
            A :class:`Steadiness` whose value is the unsteadiness of each state; a plain :class:`Assumption`, which is
            undecided, if all states (one at least) are at rest.

        Examples
        --------
        >>> import viscoroll as vr
        >>> from viscoroll.contact_law.validity.steadiness import Steadiness
        >>> states = vr.presets.RUBBER_CYLINDER.validity([1.0, 2.0]).steady.free
        >>> Steadiness.of(states).holds
        array([ True,  True])
        """
        if free.u.size and not free.u.any():
            return Assumption(None, None, "the assumption is not checked at rest: give a speed")
        return cls._create(free.unsteadiness, free)

    @classmethod
    def along(cls, free: FreeRolling, rolls: Any, x: Any, *, ends: bool) -> Steadiness:
        """Return the assumption ``steady`` of one motion, or of several.

        Parameters
        ----------
        free : states at the output times, (times,) or (times, motions), with gamma; each gives the distance and the
            speeds of free rolling from there.  A state at rest after a motion has begun counts as the limit V -> 0.
        rolls : mask of the times at which motions are not in full slip, in the shape of u.  In full slip friction rules
            the motion, and the unsteadiness counts as 0.
        x : distances travelled in the unit of the caller, in the shape of u; NaN where they are not known.
        ends : whether ``value`` is that of each motion as a whole, () or (motions,); else, for one motion only, it is
            the largest so far at each time, (times,).

        Returns
        -------
        Steadiness
            The assumption, whose value is dimensionless; its ``share``, () or (motions,), is the part of each
            motion's distance with an error of V above 10 %, 0 for a motion that stays where it is, NaN where x is not
            known.

        Examples
        --------
        >>> import viscoroll as vr
        >>> from viscoroll.contact_law.validity.steadiness import Steadiness
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0])
        >>> states = motion.roller.validity(motion.V).steady.free
        >>> float(Steadiness.along(states, motion.regime > 0, motion.x, ends=True).share)
        0.0
        """
        free = replace(free, u=np.where(np.maximum.accumulate(free.u > 0.0, axis=0), np.maximum(free.u, _REST), 0.0))
        value = np.maximum.accumulate(np.where(rolls, free.unsteadiness, 0.0), axis=0)
        fastest = free.take((np.argmax(free.u, axis=0), *np.indices(free.u.shape[1:])))
        to_rest, steps = free.distance(), np.abs(np.diff(x, axis=0))
        slow = np.where(fastest.unsteadiness > STEADY_LIMIT, np.inf, fastest.reach(STEADY_LIMIT).left)
        # the part of each step that lies below that speed, as in free rolling
        with np.errstate(invalid="ignore"):
            below, whole = (np.abs(np.diff(left, axis=0)) for left in (np.minimum(to_rest, slow), to_rest))
        part = np.divide(below, whole, out=1.0 * (to_rest[1:] < slow), where=(0.0 < whole) & (whole < np.inf))
        share = (steps * rolls[1:] * part).sum(axis=0) / np.maximum(steps.sum(axis=0), _REST)
        return cls._create(value[-1] if ends else value, fastest, share)

    @classmethod
    def _create(cls, value: Any, free: FreeRolling, motion_share: Any = None) -> Steadiness:
        """Return the assumption with its sentence, which describes the state of the largest unsteadiness.

        value: unsteadiness, dimensionless, any shape; of several motions (motions,), of one () or (times,).
        free: the states in the shape of ``value``; of motions the fastest one of each, (motions,) or ().
        motion_share: the share of motions, (motions,) or (), maybe NaN; None for single states.
        Returns the assumption, which holds, in the shape of ``value``, where that is at most 0.1; of an empty value the
        sentence says that there is no motion.
        """
        sentence = "there is no motion"
        if np.size(value):
            most = float(np.max(value))
            worst = free.take(np.unravel_index(np.argmax(value), free.u.shape)) if free.u.ndim else free
            described = motion_share is not None
            sentence = (
                _describe_motion(worst, most, float(np.mean(motion_share))) if described else _describe_free(worst)
            )
        created = cls(value <= STEADY_LIMIT, value, sentence)
        created.free, created.motion_share = free, motion_share
        return created

    def worst_of_parts(self, last: Any) -> Steadiness:
        """Return the assumption of a motion with one value for each part of it: the largest up to the end of the part.

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
        >>> steady = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, [1.0, 2.0, 3.0]).validity().steady
        >>> steady.worst_of_parts(np.array([1, 2])).value.shape
        (2,)
        """
        chosen: Any = self._replace(holds=self.holds[last], value=self.value[last])
        chosen.free, chosen.motion_share = self.free, self.motion_share
        return chosen

    @cached_property
    def one_percent(self) -> Reach:
        """Part of free rolling with an error of V below 1 %, a :class:`Reach` (unsteadiness up to 0.01)."""
        return self.free.reach(0.1 * STEADY_LIMIT)

    @cached_property
    def ten_percent(self) -> Reach:
        """Part of free rolling with an error of V below 10 %, a :class:`Reach` (unsteadiness up to 0.1)."""
        return self.free.reach(STEADY_LIMIT)

    @cached_property
    def start(self) -> Start:
        """Losses of a start after a long standstill, a :class:`Start`."""
        return self.free.start()

    @cached_property
    def whole(self) -> Any:
        """Distance to rest by the law of steady rolling; infinite for elastic bodies, also at V = 0."""
        return self.free.distance()

    @cached_property
    def share(self) -> Any:
        """Part of a distance on which the error of V exceeds 10 %, dimensionless, 0 to 1.

        Of motions it is the part of the distance of each motion, one value for each, NaN where x is not known.  Else it
        is the part of the distance to rest in free rolling, in the shape of the states: 1 where V is too slow at the
        start already, 0 at rest and for elastic bodies.
        """
        if self.motion_share is not None:
            return self.motion_share
        left, whole = np.asarray(self.ten_percent.left), np.asarray(self.whole)
        return np.divide(left, whole, out=np.asarray(self.value > STEADY_LIMIT, np.float64), where=left < whole)[()]


def _describe_free(free: FreeRolling) -> str:
    """Return sentences on free rolling from one state: distance, speeds at which errors are reached, loss of a start.

    free: a single state (u without axes), whose units the sentences use; dimensionless without names of units.
    Returns a str without a full stop.  Where the unsteadiness is above 0.1 it states alone from which speed on it is
    not; for an elastic cylinder alone that it never stops.
    """
    speed, time, length = (f" {unit}".rstrip() for unit in free.units)
    value, most, whole = float(free.unsteadiness), free.reach(STEADY_LIMIT), free.distance()
    text = f"unsteadiness {value:.2g} (up to {STEADY_LIMIT} is allowed): "
    if value > STEADY_LIMIT:
        return text + (
            "too slow for the quasi-steady assumption of a motion (contact states and constant speeds are valid, their "
            "stability is not); "
            f"the error of V is below 10 % above {most.speed:.2g}{speed}"
        )
    if not np.isfinite(whole):
        return text + "an elastic cylinder never stops"
    fine, start = free.reach(0.1 * STEADY_LIMIT), free.start()
    text += f"the coasting distance is {whole:.4g}{length}; the error of V is below "
    if fine.time:
        text += f"1 % down to {fine.speed:.2g}{speed}, below " if fine.speed else "1 % to the end"
    if fine.speed:
        reached = f"which is reached after {most.time:.3g}{time}, {most.left:.2g}{length} before the end"
        end = f"down to {most.speed:.2g}{speed}, {reached}"
        text += f"10 % {end if most.speed else 'to the end'}"
    if start.speed > LARGEST_LOSS * float(free.u * free.speed):
        return text + "; after a long standstill the cylinder would not leave its indentation"
    loss = f"{start.speed:.2g}{speed} of speed and {start.distance:.2g}{length} of distance"
    return f"{text}; a start after a long standstill costs {loss}"


def _describe_motion(free: FreeRolling, most: float, share: float) -> str:
    """Return sentences on the error of a motion, or of the worst of several.

    free: fastest state of the motion, u without axes.
    most: largest unsteadiness of the motion, dimensionless; up to 0.1 the speed and the share are not stated.
    share: fraction of its distance with an error above 10 %, of several motions the mean; NaN where it is not known,
        which the sentence then leaves out.
    Returns a str without a full stop.
    """
    text = f"unsteadiness up to {most:.2g} (up to {STEADY_LIMIT} is allowed): "
    text += "the error of V is below 10 % "
    if most <= STEADY_LIMIT:
        return text + "throughout"
    speed = f"{free.reach(STEADY_LIMIT).speed:.2g} {free.units[0]}".rstrip()
    below = "" if np.isnan(share) else f"; {100.0 * share:.2g} % of the distance is below that speed"
    return f"{text}down to {speed}{below}"
