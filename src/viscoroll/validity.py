"""Which assumptions of the model a state strains: the result of ``Scene.validity`` and ``Cylinder.validity``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .material_tables import record
from .prony import Prony

#: at this half-width over R the parabola of the theory lies 1 % below the circle: (x/R)^2/4
REACH_LIMIT = 0.2
#: the paper's ref. [31], Table 1: below this share of the wave speeds the load is within 10 % of the static one
WAVE_LIMIT = 0.2
#: nu up to which a motion is within 10 % of its first speed, and beyond which it is another motion altogether: measured
#: with a transient solver at alpha 3 and 11, kappa V from 0.29 to 4.4 (gamma 7 and 30 at alpha 11)
STEADY_LIMIT, NOT_THIS_MOTION = 0.4, 1.6
#: the highest N over the sum of J_j T_j^2
_HIGHEST_N = 0.084
#: the normal slope of the surface takes beta_D times the shear in beside the pressure's own, and shear is mu p at most
DUNDURS_LIMIT = 0.05


class Assumption(NamedTuple):
    """One assumption: whether it holds, the number that decides, and a sentence.

    ``holds`` is None where no number here can tell; it and ``value`` have the shape of V.
    """

    holds: Any
    value: Any
    sentence: str


class Validity(NamedTuple):
    """What the model assumes, and how far a state is from it.

    Attributes
    ----------
    small_contact : value: distance from the axis to the far end of the contact over R,
        lam (1 + epsilon)/(2 kappa).
    under_axis : value: epsilon; where it exceeds 1 the contact lies wholly ahead of the
        axis, which is no fault of the model but worth knowing.
    quasistatic : value: speed over that of shear waves; needs a density.
    steady : value: nu = gamma max|N|/(1 + j), M = M(V) + N V' for slow changes; an upper bound of it, from the
        strengths of the material.  It rules whether the law of steady rolling may drive a motion; contact states and
        rolling at constant speed are not concerned.
    bodies : value: Dundurs' constant of the pair, of long times or at once, whichever is larger; needs the materials.
    plane : not to be seen from V.
    """

    small_contact: Assumption
    under_axis: Assumption
    quasistatic: Assumption
    steady: Assumption
    bodies: Assumption
    plane: Assumption

    def __str__(self) -> str:
        return "\n".join(f"{name}: {assumption.sentence}" for name, assumption in self._asdict().items())


def contact_reach(material: Any, kappa: Any, V: NDArray[np.float64]) -> tuple[Any, Any]:
    """(lam (1 + epsilon)/(2 kappa), epsilon), broadcast over the arguments; ``material``: alphas, or a series."""
    from .kernels.law.length import contact_length
    from .kernels.law.material import generators, standard

    def state(given: Any, kappa: float, V: float) -> tuple[float, float]:
        material, u = record(given) if isinstance(given, Prony) else standard(given), kappa * abs(V)
        lam, epsilon = 1.0, 0.0
        if u > 0.0:
            lam, _ = contact_length(u, material)
            zeta = 0.5 * lam / u
            # it underflows beyond all speeds, where the contact is that of the instantaneous modulus
            epsilon = generators(zeta, material)[0] / zeta if zeta > 0.0 else 0.0
        return lam * (1.0 + epsilon) / (2.0 * kappa), epsilon

    points = np.broadcast(material, kappa, V)
    values = np.array([state(given, float(kappa), float(V)) for given, kappa, V in points]).reshape(*points.shape, 2)
    return values[..., 0], values[..., 1]


def unsteadiness(relaxation: Any, creep: Any) -> Any:
    """The largest |N| of a material with these sums of E_i tau_i^2 and J_j T_j^2, found on 35 series, not proven."""
    return np.maximum(relaxation, _HIGHEST_N * np.asarray(creep))


def steadiness(nu: Any) -> Assumption:
    """Whether motions may be driven by the law of steady rolling."""
    most = float(np.max(nu, initial=0.0))
    return Assumption(
        nu <= STEADY_LIMIT, nu,
        f"nu = {most:.2g}: a motion by the law of steady rolling "
        + (
            f"is off by up to some {30.0 * most:.2g} % of the first speed"
            if most <= NOT_THIS_MOTION
            else "is not that of this cylinder, which rocks in its own imprint; contact states are not concerned"
        ),
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


def judge(reach: Any, epsilon: Any, slow: Assumption, steady: Assumption, bodies: Assumption, plane: str) -> Validity:
    """Numbers put into words."""
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
    return Validity(small, under, slow, steady, bodies, Assumption(None, None, plane))
