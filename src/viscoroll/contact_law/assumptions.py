"""Which assumptions of the model a state strains: the result of ``Scene.validity`` and ``Cylinder.validity``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core.results import SummaryRow, as_html, as_text
from ..materials.law.evaluate import evaluate_by_modes
from ..materials.measured import Measured
from ..materials.prony import Prony

#: at this half-width over R the parabola of the theory lies 1 % below the circle: (x/R)^2/4
REACH_LIMIT = 0.2
#: the paper's ref. [31], Table 1: below this share of the wave speeds the load is within 10 % of the static one
WAVE_LIMIT = 0.2
#: the normal slope of the surface takes beta_D times the shear in beside the pressure's own, and shear is mu p at most
DUNDURS_LIMIT = 0.05
#: in full slip cylinder and half-space pass the contact at speeds that differ by this share; M takes one speed for both
CREEP_LIMIT = 0.3
#: contact length over the thickness of a layer, up to which the length is within 5 % of that on a half-space of any
#: Poisson's ratio (pipeline/evidence/prove/layer.py)
THICK_LIMIT = 2.0 / 3.0
#: kappa = R/l0 at which the contact at rest reaches half a radius from the axis: below, contacts and motions warn
LEAST_KAPPA = 1.0
NOT_SMALL = (
    "kappa = R/l0 is below 1: the contact at rest is longer than the radius, where no half-space stands for a cylinder "
    "(are moduli in Pa, the load in N/m?)"
)
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


class Validity(NamedTuple):
    """What the model assumes, and how far a state is from it.

    Attributes
    ----------
    small_contact : value: distance from the axis to the far end of the contact over R,
        lam (1 + epsilon)/(2 kappa).
    under_axis : value: epsilon; where it exceeds 1 the contact lies wholly ahead of the
        axis, which is no fault of the model but worth knowing.
    quasistatic : value: speed over that of shear waves; needs a density.
    steady : a :class:`.steadiness.Steadiness`; value: the unsteadiness gamma |N(V)|/(1 + j), where M = M(V) + N V' for
        slow changes.  It rules whether the law of steady rolling may drive a motion, and down to which speed; contact
        states and rolling at constant speed are not concerned.
    creep : value: |delta|; where the contact slips fully the two bodies pass it at different speeds, and the rolling
        moment is that of the axis' speed for both.  Needs omega.
    bodies : value: Dundurs' constant of the pair, of long times or at once, whichever is larger; needs the materials.
    measured : value: 1/s at which the contact is passed, :func:`passage`, against the frequencies that the data of each
        body hold; needs a material's ``measured``.
    thick : of a layer of known thickness; value: half the length of the contact over the thickness, up to which one
        stick zone in front and slip behind are right.
    plane : not to be seen from V.

    Examples
    --------
    Printed, each line says yes, no or, where no number can tell, "?".

    >>> import viscoroll as vr
    >>> vr.presets.RUBBER_CYLINDER.validity(2.0).failed
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

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        rows = [SummaryRow(name, f"{each.word:<4} {each.sentence}") for name, each in self._asdict().items()]
        return "What the model assumes, and whether it holds", rows

    def __repr__(self) -> str:
        return as_text(*self._summary())

    def _repr_html_(self) -> str:
        return as_html(*self._summary())


#: where no number can tell
UNKNOWN = Validity(*(Assumption(None, None, sentence) for sentence in (
    "", "",
    "inertia of the deformed bodies is neglected; give a density to see whether it may",
    "whether the law of steady rolling may drive a motion needs gamma",
    "both bodies pass the contact at about one speed; give omega to see whether",
    "of the bodies' elastic constants Dundurs' constant must be 0, as of like bodies",
    "nothing is known of the frequencies that the material was measured at",
    "thickness not known: the law is that of a half-space, whose contact length is within 5 % of that on a layer where "
    f"it is up to {THICK_LIMIT:.2g} times as long as that is thick",
    "the cylinder is long or held between walls (plane strain), or a thin disc",
)))  # fmt: skip

#: whether the law of steady rolling may drive a motion, of covers
UNKNOWN_OF_COVERS = Assumption(
    None, None, "whether the law of steady rolling may drive a motion is not known of a layer of finite thickness"
)


def passage(V: Any, length: Any) -> Any:
    """What a contact asks of its material: the rate at which a point passes it, 1/s, of a speed and a length.

    The law holds where the material is known at angular frequencies of this size.  At its front edge every contact has
    a layer that is passed in less: modes faster than the passage act there as far as they go.
    """
    return np.abs(V) / length


def held_speeds(series: Prony, low: float, high: float) -> tuple[float, float]:
    """kappa V at which the contact is passed at two rates; all over T_ref."""
    rates = np.array([low, high])
    rise = evaluate_by_modes(series, 0.5 / rates).values[1]
    low, high = (rates / np.sqrt(1.0 + 2.0 * rise)).tolist()  # 1/lam^2 = 1 + 2 h/zeta, Eq. (6)
    return low, high


def smallness(reach: Any) -> Assumption:
    """Whether the far end of the contact is near the axis."""
    far = float(np.max(reach, initial=0.0))
    return Assumption(
        reach <= REACH_LIMIT, reach,
        f"the contact reaches {far:.2g} R from the axis, where the parabola that stands for the circle is off by "
        f"{25.0 * far * far:.2g} %; up to {REACH_LIMIT} R (1 %) counts as small",
    )  # fmt: skip


def place(epsilon: Any) -> Assumption:
    """Whether the axis stands above the contact."""
    ahead = float(np.max(epsilon, initial=0.0))
    where = "lies wholly ahead of the axis, which the theory allows" if ahead > 1.0 else "has the axis above it"
    return Assumption(epsilon <= 1.0, epsilon, f"epsilon = {ahead:.2g}: the contact {where}")


def unlike_speeds(delta: Any, full_slip: Any) -> Assumption:
    """Whether both bodies pass the contact at about one speed."""
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
        return UNKNOWN.quasistatic
    return Assumption(
        wave_ratio <= WAVE_LIMIT, wave_ratio,
        f"the speed is {100.0 * float(np.max(wave_ratio, initial=0.0)):.2g} % of that of shear waves; up to "
        f"{100.0 * WAVE_LIMIT:g} % the load is within 10 % of the static one"
        + "".join(f"; the density of {body} is not known" for body in unknown),
    )  # fmt: skip


def coupling(long: float, instant: float, *, like: bool) -> Assumption:
    """Dundurs' constant of long times and at once; ``like``: it is 0 at all times."""
    worst = max(long, instant, key=abs)
    if like or worst == 0.0:
        words = "cylinder and half-space are alike: " if like else ""
        end = "" if like else ": shear does not move the pressure"
        return Assumption(True, 0.0, f"{words}Dundurs' constant is 0{end}")
    return Assumption(
        abs(worst) <= DUNDURS_LIMIT, worst,
        f"Dundurs' constant is {long:.2g} for long times, {instant:.2g} at once, where the theory asks for 0: shear "
        "bends the surface by up to mu times as much as the pressure does; "
        f"up to {DUNDURS_LIMIT} counts as small",
    )  # fmt: skip


def measurement(seen: Any, records: Mapping[str, Measured]) -> Assumption:
    """Whether the data of each body hold the rate at which its contact is passed; None where there are none."""
    if not records:
        return UNKNOWN.measured
    ends = dict.fromkeys(f"{end:.2g}" for end in (np.min(seen, initial=np.inf), np.max(seen, initial=0.0)))
    sentence = f"the contact is passed at {' to '.join(ends)} 1/s, the layer at its front edge faster"
    holds = np.full(np.shape(seen), True)[()]
    for body, data in records.items():
        holds = holds & (data.low <= seen) & (seen <= data.high) & (data.misfit <= MISFIT_LIMIT)
        sentence += f"; {body} was measured from {data}"
    return Assumption(holds, seen, sentence)
