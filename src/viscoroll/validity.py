"""Which assumptions of the model a state strains: the result of ``Scene.validity`` and ``Cylinder.validity``."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from .materials.measured import Measured
from .materials.prony import Prony
from .materials.tables import record
from .results import Row, as_html, as_text
from .steadiness import Free, Reach, Start, Strained

#: at this half-width over R the parabola of the theory lies 1 % below the circle: (x/R)^2/4
REACH_LIMIT = 0.2
#: the paper's ref. [31], Table 1: below this share of the wave speeds the load is within 10 % of the static one
WAVE_LIMIT = 0.2
#: unsteadiness up to which V is right to some 10 %: measured with a transient solver of many modes (docs/may_i.md)
STEADY_LIMIT = 0.1
#: share of its speed, seven tenths of its energy, that a start from rest may lose: beyond, the cylinder was caught
_CAUGHT = 0.45
#: a speed that is as good as rest, where a motion ended
_REST = 1e-300
#: the normal slope of the surface takes beta_D times the shear in beside the pressure's own, and shear is mu p at most
DUNDURS_LIMIT = 0.05
#: in full slip cylinder and half-space pass the contact at speeds that differ by this share; M takes one speed for both
CREEP_LIMIT = 0.3
#: contact length over the thickness of a layer, up to which the length is within 5 % of that on a half-space of any
#: Poisson's ratio (pipeline/prove/layer.py)
THICK_LIMIT = 2.0 / 3.0
#: root mean square of relative errors up to which a fit counts as the material that was measured
MISFIT_LIMIT = 0.05


class Assumption(NamedTuple):
    """One assumption: whether it holds, the number that decides, and a sentence.

    ``holds`` is None where no number here can tell; it and ``value`` have the shape of V.
    """

    holds: Any
    value: Any
    sentence: str

    @property
    def word(self) -> str:
        """Whether it holds, everywhere: yes, no, or "?" where nothing tells."""
        return "?" if self.holds is None else "yes" if np.all(self.holds) else "no"

    def __repr__(self) -> str:
        return f"{self.word}: {self.sentence}"


class Steadiness(Assumption):
    """Whether the law of steady rolling may drive a motion, and how far; everything below is in the units of the call.

    ``value`` is the unsteadiness gamma |N(V)|/(1 + j), of a motion the largest so far; it counts as small up to 0.1,
    where V is right to some 10 %.  The attributes are of free rolling from each V, by the law.

    Attributes
    ----------
    one_percent, ten_percent : the :class:`Reach` within which V is right to about 1 % and 10 %.
    start : what a :class:`Start` from a contact that rested long costs.
    whole : the way to rest.
    share : of that way, or of the way of a motion, what lies where V is not right to 10 %; None where it is not known.
    """

    free: Free
    #: of a motion, ``share``
    rolled: Any = None

    @classmethod
    def of(cls, free: Free) -> Assumption:
        """That of states that are let go."""
        if free.u.size and not free.u.any():
            return Assumption(None, None, "at rest there is nothing to say: it is the speed that decides")
        return cls._made(free.unsteadiness, free)

    @classmethod
    def along(cls, free: Free, rolls: Any, x: Any, *, ends: bool) -> Steadiness:
        """That of motions over times, the first axis; ``ends``: of each as a whole.

        rolls : where they do not slip fully, which friction rules.  x : places; NaN where they are not known.
        """
        free = replace(free, u=np.where(np.maximum.accumulate(free.u > 0.0, axis=0), np.maximum(free.u, _REST), 0.0))
        value = np.maximum.accumulate(np.where(rolls, free.unsteadiness, 0.0), axis=0)
        fastest = free.at((np.argmax(free.u, axis=0), *np.indices(free.u.shape[1:])))
        way, steps = free.whole(), np.abs(np.diff(x, axis=0)) * rolls[1:]
        slow = np.where(fastest.unsteadiness > STEADY_LIMIT, np.inf, fastest.reach(STEADY_LIMIT).left)
        # of each step, as in free rolling
        with np.errstate(invalid="ignore"):
            below, whole = (np.abs(np.diff(each, axis=0)) for each in (np.minimum(way, slow), way))
        part = np.divide(below, whole, out=1.0 * (way[1:] < slow), where=(0.0 < whole) & (whole < np.inf))
        share = (steps * part).sum(axis=0) / np.maximum(np.abs(np.diff(x, axis=0)).sum(axis=0), _REST)
        return cls._made(value[-1] if ends else value, fastest, share)

    @classmethod
    def _made(cls, value: Any, free: Free, rolled: Any = None) -> Steadiness:
        sentence = "no motion"
        if np.size(value):
            most = float(np.max(value))
            worst = free.at(np.unravel_index(np.argmax(value), free.u.shape)) if free.u.ndim else free
            sentence = _let_go(worst) if rolled is None else _rolled(worst, most, float(np.mean(rolled)))
        made = cls(value <= STEADY_LIMIT, value, sentence)
        made.free, made.rolled = free, rolled
        return made

    def scaled(self, speed: Any, time: Any, length: Any, words: tuple[str, str, str]) -> Steadiness:
        """The same in other units."""
        return self._made(self.value, self.free.scaled(speed, time, length, words), self.rolled)

    @cached_property
    def one_percent(self) -> Reach:
        return self.free.reach(0.1 * STEADY_LIMIT)

    @cached_property
    def ten_percent(self) -> Reach:
        return self.free.reach(STEADY_LIMIT)

    @cached_property
    def start(self) -> Start:
        return self.free.start()

    @cached_property
    def whole(self) -> Any:
        return self.free.whole()

    @cached_property
    def share(self) -> Any:
        if self.rolled is not None:
            return self.rolled
        left, whole = np.asarray(self.ten_percent.left), np.asarray(self.whole)
        return np.divide(left, whole, out=np.asarray(self.value > STEADY_LIMIT, np.float64), where=left < whole)[()]


class Validity(NamedTuple):
    """What the model assumes, and how far a state is from it.

    Attributes
    ----------
    small_contact : value: distance from the axis to the far end of the contact over R,
        lam (1 + epsilon)/(2 kappa).
    under_axis : value: epsilon; where it exceeds 1 the contact lies wholly ahead of the
        axis, which is no fault of the model but worth knowing.
    quasistatic : value: speed over that of shear waves; needs a density.
    steady : :class:`Steadiness`; value: the unsteadiness gamma |N(V)|/(1 + j), where M = M(V) + N V' for slow changes.
        It rules whether the law of steady rolling may drive a motion, and down to which speed; contact states and
        rolling at constant speed are not concerned.
    creep : value: |delta|; where the contact slips fully the two bodies pass it at different speeds, and the rolling
        moment is that of the axis' speed for both.  Needs omega.
    bodies : value: Dundurs' constant of the pair, of long times or at once, whichever is larger; needs the materials.
    measured : value: 1/s at which the contact is passed, :func:`passage`, against the frequencies that the data of each
        body hold; needs a material's ``measured``.
    thick : value: contact length over the thickness of the thinnest layer; needs a material's ``thickness``.
    plane : not to be seen from V.

    Examples
    --------
    Printed, each line says yes, no or, where no number can tell, "?".

    >>> import viscoroll as vr
    >>> vr.RUBBER_CYLINDER.validity(2.0).failed
    ()
    """

    small_contact: Assumption
    under_axis: Assumption
    quasistatic: Assumption
    steady: Assumption
    creep: Assumption
    bodies: Assumption
    measured: Assumption
    thick: Assumption
    plane: Assumption

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the assumptions that do not hold, of arrays somewhere; empty where none is known to fail."""
        return tuple(name for name, each in self._asdict().items() if each.word == "no")

    def _card(self) -> tuple[str, list[Row]]:
        rows = [Row(name, f"{each.word:<4} {each.sentence}") for name, each in self._asdict().items()]
        return "What the model assumes, and whether it holds", rows

    def __repr__(self) -> str:
        return as_text(*self._card())

    def _repr_html_(self) -> str:
        return as_html(*self._card())


def passage(V: Any, length: Any) -> Any:
    """What a contact asks of its material: the rate at which a point passes it, 1/s, of a speed and a length.

    The law holds where the material is known at angular frequencies of this size.  At its front edge every contact has
    a layer that is passed in less: modes faster than the passage act there as far as they go.
    """
    return np.abs(V) / length


def held_speeds(series: Prony, low: float, high: float) -> tuple[float, float]:
    """kappa V at which the contact is passed at two rates; all over T_ref."""
    from .kernels.material.functions import generators

    if not series.E.size:
        return low, high
    own, unit = series.in_own_time()

    def speed(rate: float) -> float:
        zeta = 0.5 / (rate * unit)
        return rate / math.sqrt(1.0 + 2.0 * generators(zeta, record(own))[1] / zeta)  # 1/lam^2 = 1 + 2 h/zeta, Eq. (6)

    return speed(low), speed(high)


def _let_go(free: Free) -> str:
    """One state that is let go, in words that one can act on."""
    speed, time, length = (f" {word}".rstrip() for word in free.words)
    nu, most, whole = float(free.unsteadiness), free.reach(STEADY_LIMIT), free.whole()
    said = f"unsteadiness {nu:.2g}: "
    if nu > STEADY_LIMIT:
        return said + (
            "too slow for the law of steady rolling to drive a motion (contact states and constant speed are not "
            f"concerned); faster than {most.speed:.2g}{speed} V is right to 10 %"
        )
    if not np.isfinite(whole):
        return said + "let go here it rolls for ever"
    fine, start = free.reach(0.1 * STEADY_LIMIT), free.start()
    said += f"let go here it rolls {whole:.4g}{length} by the law of steady rolling; V is right to "
    said += ("1 % to the end" if not fine.speed else f"1 % down to {fine.speed:.2g}{speed}, to ") if fine.time else ""
    if fine.speed:
        end = f"down to {most.speed:.2g}{speed}, after {most.time:.3g}{time} and {most.left:.2g}{length} before the end"
        said += f"10 % {end if most.speed else 'to the end'}"
    if start.speed > _CAUGHT * float(free.u * free.speed):
        return said + "; a contact that rested long would hold it in its imprint"
    return said + f"; a contact that rested long would cost {start.speed:.2g}{speed} and {start.way:.2g}{length} of way"


def _rolled(free: Free, most: float, share: float) -> str:
    """A motion, or the worst of several, from its fastest speed."""
    if most <= STEADY_LIMIT:
        return f"unsteadiness up to {most:.2g}: by the law of steady rolling V is right to 10 % all along"
    speed = f"{free.reach(STEADY_LIMIT).speed:.2g} {free.words[0]}".rstrip()
    below = "" if np.isnan(share) else f"; {100.0 * share:.2g} % of the way lies below"
    return f"unsteadiness up to {most:.2g}: by the law of steady rolling V is right to 10 % down to {speed}{below}"


def unlike_speeds(delta: Any, full_slip: Any) -> Assumption:
    """Whether both bodies pass the contact at about one speed; None where the creep is not known."""
    if delta is None:
        return Assumption(None, None, "both bodies pass the contact at about one speed; give omega to see whether")
    size, full_slip = np.broadcast_arrays(np.abs(delta), full_slip)
    most = float(np.max(size, initial=0.0, where=full_slip))
    return Assumption(
        ~full_slip | (size <= CREEP_LIMIT), size,
        f"the speeds of the two bodies in the contact differ by {100.0 * most:.2g} % in full slip, where the rolling "
        f"moment takes that of the axis for both; up to {100.0 * CREEP_LIMIT:g} % counts as small"
        if most > 0.0
        else "both bodies pass the contact at about one speed: it does not slip fully",
    )  # fmt: skip


def inertia(wave_ratio: Any, unknown: Sequence[str] = ()) -> Assumption:
    """Speed over that of shear waves, None where it is not known; ``unknown``: bodies without a density."""
    if wave_ratio is None:
        return Assumption(
            None, None, "inertia of the deformed bodies is neglected; give a density to see whether it may"
        )
    return Assumption(
        wave_ratio <= WAVE_LIMIT, wave_ratio,
        f"the speed is {100.0 * float(np.max(wave_ratio, initial=0.0)):.2g} % of that of shear waves; up to "
        f"{100.0 * WAVE_LIMIT:g} % the load is within 10 % of the static one"
        + "".join(f"; the density of {body} is not known" for body in unknown),
    )  # fmt: skip


def coupling(long: float | None = None, instant: float | None = None, *, like: bool = False) -> Assumption:
    """Dundurs' constant of long times and at once, None where it is not known; ``like``: it is 0 at all times."""
    if long is None or instant is None:
        return Assumption(None, None, "of the bodies' elastic constants Dundurs' constant must be 0, as of like bodies")
    if like:
        return Assumption(True, 0.0, "cylinder and half-space are alike: Dundurs' constant is 0")
    worst = max(long, instant, key=abs)
    sizes = f"{long:.2g} for long times, {instant:.2g} at once"
    if worst == 0.0:
        return Assumption(True, 0.0, "Dundurs' constant is 0: shear does not move the pressure")
    within = abs(worst) <= DUNDURS_LIMIT
    return Assumption(
        within, worst,
        f"Dundurs' constant is {sizes}, where the theory asks for 0: shear bends the surface by up to mu times as much "
        f"as the pressure does; up to {DUNDURS_LIMIT} counts as small",
    )  # fmt: skip


def measurement(seen: Any, records: Mapping[str, Measured]) -> Assumption:
    """Whether the data of each body hold the rate at which its contact is passed; None where there are none."""
    if not records:
        return Assumption(None, None, "nothing is known of the frequencies that the material was measured at")
    ends = dict.fromkeys(f"{end:.2g}" for end in (np.min(seen, initial=np.inf), np.max(seen, initial=0.0)))
    sentence = f"the contact is passed at {' to '.join(ends)} 1/s, the layer at its front edge faster"
    holds = np.full(np.shape(seen), True)[()]
    for body, data in records.items():
        holds = holds & (data.low <= seen) & (seen <= data.high) & (data.misfit <= MISFIT_LIMIT)
        sentence += f"; {body} was measured from {data}"
    return Assumption(holds, seen, sentence)


def thickness(length: Any, layers: Mapping[str, float | None]) -> Assumption:
    """Contact length over the thickness of the thinnest of the layers; None where none is known."""
    thin = min((given for given in layers.values() if given is not None), default=None)
    if thin is None:
        return Assumption(None, None, "thickness not known: the law is that of a half-space")
    unknown = [f"the thickness of {body} is not known" for body, given in layers.items() if given is None]
    ratio = length / thin
    return Assumption(
        ratio <= THICK_LIMIT, ratio,
        f"the contact is {np.max(ratio, initial=0.0):.2g} times as long as the layer is thick; up to {THICK_LIMIT:.2g} "
        "its length is within 5 % of that on a half-space" + "".join(f"; {text}" for text in unknown),
    )  # fmt: skip


def judge(found: Strained, steady: Assumption, creep: Assumption) -> Validity:
    """Numbers put into words; what only a cylinder in SI units knows is not known."""
    reach, epsilon = found.reach, found.epsilon
    far, ahead = float(np.max(reach, initial=0.0)), float(np.max(epsilon, initial=0.0))
    small = Assumption(
        reach <= REACH_LIMIT, reach,
        f"the contact reaches {far:.2g} R from the axis, where the parabola that stands for the circle is off by "
        f"{25.0 * far * far:.2g} %; up to {REACH_LIMIT} R (1 %) counts as small",
    )  # fmt: skip
    under = Assumption(
        epsilon <= 1.0, epsilon,
        f"epsilon = {ahead:.2g}: the contact "
        + ("lies wholly ahead of the axis, which the theory allows" if ahead > 1.0 else "has the axis above it"),
    )  # fmt: skip
    plane = Assumption(None, None, "the cylinder is long or held between walls (plane strain), or a thin disc")
    return Validity(
        small, under, inertia(None), steady, creep, coupling(), measurement(None, {}), thickness(None, {}), plane
    )
