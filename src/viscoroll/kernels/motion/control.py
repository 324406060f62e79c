"""Step control: weights of errors, lengths of steps."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .dop853 import E3, STAGES
from .events import EXPLICIT, STIFF
from .partial_slip import partial_rates, signed_D

#: local error per step is kept at this share of rtol
SHARE = 0.4
_D_SHARE = 0.04
#: share of the estimate of order 3 that the error of a step into the bend of the law at eta = 0 can reach
_BENT = 0.05
#: a crossing of delta = 0 is let pass where its distance from the end of the step, times the rise, is this share of a
#: tolerance
_KINK = 4.0
#: growth and shrinkage of steps
_GROW, _SHRINK, _SAFETY = 6.0, 0.1, 0.9
_TREND = (0.5, 1.5)


@kernel
def slip_share(u, scene):
    """D/zeta: 1 less the stick share, with the sign of delta."""
    return signed_D(u[0], u[1], scene) * np.exp(-u[0])


@kernel
def creep_weight(share):
    """Weight of an error of D over zeta, at this D over zeta.

    D matters through omega - V = mu V^2 d, a small part of omega, and through V', whose error
    y carries, and its errors decay: it is held relative to the contact, as an error of Q/mu, and
    more loosely relative to itself; but not where it decides on the end of stick.
    """
    return max(_D_SHARE, share * share) / (abs(share) + _D_SHARE)


@kernel
def crossing(u, slope, share, new, slope_new, share_new, rtol):
    """Fraction of a step in partial slip at which delta passes through 0, where Q is C1 only; 1 if it does not.

    By the cubic through values and slopes at both ends.  The slope of D' in D jumps there, by 2 D' F''/F': a stage on
    the far side at the distance e spoils the step, which rises by D' h, by a tenth of the product of the two at most.
    """
    rise = share_new - share
    if not share * share_new < 0.0 or abs(share_new) > 1.0:  # beyond 1: a step far too long
        return 1.0
    if min(abs(share), abs(share_new)) * abs(rise) < _KINK * SHARE * rtol:
        return 1.0
    # slopes of D/zeta over those of the offset: as the rises
    change = new[1] - u[1]
    first, last = slope / change, slope_new / change
    theta = -share / rise
    for _ in range(4):
        rest = 1.0 - theta
        value = theta * theta * (3.0 - 2.0 * theta) + theta * rest * (rest * first - theta * last)
        grade = 6.0 * theta * rest + rest * (1.0 - 3.0 * theta) * first + theta * (3.0 * theta - 2.0) * last
        theta -= (value + share / rise) / grade
    return theta if 0.0 < theta < 1.0 else -share / rise


@kernel
def halving(share, share_new, length, new, K, rtol):
    """Share to try of an explicit step in partial slip that halves the stick zone, where that is too much; else 1.

    The law bends at eta ~ 1/alpha, on which the end of stick depends: of a step that comes there from afar most stages
    see nothing, and the estimate of order 8 may be small by chance.  That of order 3 is the one to go by.
    """
    left, ahead = 1.0 - abs(share), 1.0 - abs(share_new)
    if not ahead < 0.5 * left:
        return 1.0
    third = 0.0
    for n in range(STAGES):
        third += E3[n] * K[n, 1]
    if _BENT * creep_weight(share_new) * abs(length * third) * np.exp(-new[0]) <= SHARE * rtol:
        return 1.0
    return max(0.4 * left / (left - ahead), 0.1)


@kernel
def error_norm(u, new, share, error, travelled, rtol):
    """Largest local error of a step over its weight; <= 1 is acceptable.  ``share``: D/zeta at ``new``."""
    worst = max(abs(error[0]), creep_weight(share) * abs(error[1]) * np.exp(-new[0]))
    X = travelled[0] + abs(new[2] - u[2])
    angle = travelled[1] + abs(new[3] - u[3])
    if error[2] != 0.0:
        worst = max(worst, abs(error[2]) / X)
    if error[3] != 0.0:  # where omega starts from 0 it is a small difference of V and the slip
        worst = max(worst, abs(error[3]) / max(X, angle))
    return worst / (SHARE * rtol)


@kernel
def path_error(X, X_off, angle, angle_off, travelled, early):
    """Relative error of the distance and of the angle over an interval with these rises and mismatches at its start.

    Outputs early in the interval lie where only the share ``early`` of its way is added to what was travelled.
    """
    way = travelled[0] + early * abs(X)
    return max(X_off / way, angle_off / max(way, travelled[1] + early * abs(angle)))


@kernel
def first_length(u, rtol, scene):
    """Length of the first step in partial slip."""
    # where the stick zone is small the law bends on the scale eta ~ 1/alpha, however large zeta
    _, drift, _, _, _, _, relaxation, _, D = partial_rates(u[0], u[1], scene)
    eta = np.exp(u[0]) - abs(D)
    scale = max(eta, 0.0) + max(1.0 / scene.material.alpha, 1e-9 * np.exp(u[0]))
    bend = abs(drift) / scale if scene.material.c > 0.0 else 0.0
    return rtol ** (1.0 / 3.0) / (abs(relaxation) + bend + 1e-300)


@kernel
def shorter(length, error, method):
    """Step length after one that was rejected with this error."""
    if not error < 1e300:
        return length * _SHRINK
    if error <= 1.0:
        return length
    # with the explicit method most often a step into the bend of the law at eta = 0
    order = 5.0 if method == STIFF else 3.0
    return length * max(_SHRINK, _SAFETY * error ** (-1.0 / order))


@kernel
def next_length(length, error, length_before, error_before, method):
    """Step length after one that was accepted, with the trend of the last two (Gustafsson's predictive control)."""
    order = 5.0 if method == STIFF else 8.0
    error = max(error, 1e-20)
    factor = _SAFETY * error ** (-1.0 / order)
    if method == EXPLICIT and length_before > 0.0:
        trend = length / length_before * (error_before / error) ** (1.0 / order)
        factor *= min(max(trend, _TREND[0]), _TREND[1])
    return length * max(_SHRINK, min(_GROW, factor))
