"""Control of panels: weights of errors, lengths."""

from __future__ import annotations

from ..compile.jit import kernel
from .collocation import N

#: error per panel is kept at this share of rtol
SHARE = 0.4
_D_SHARE = 0.04
#: growth and shrinkage of panels
_GROW, _SHRINK, _FAILED, _SAFETY = 6.0, 0.1, 0.3, 0.9
#: growth behind a graded panel, and the order of its error
_BEHIND, _BENT = 3.0, 3.0


@kernel
def creep_weight(share):
    """Weight of an error of D over zeta, at this D over zeta.

    D matters through omega - V = mu V^2 d, a small part of omega, and through V', whose error
    y carries, and its errors decay: it is held relative to the contact, as an error of Q/mu, and
    more loosely relative to itself; but not where it decides on the end of stick.
    """
    return max(_D_SHARE, share * share) / (abs(share) + _D_SHARE)


@kernel
def path_error(X, X_off, angle, angle_off, state, early):
    """Relative error of the distance and of the angle over a panel with these rises and mismatches at its start.

    Outputs early in the panel lie where only the share ``early`` of its way is added to what was travelled.
    """
    way = state.way + early * abs(X)
    return max(X_off / way, angle_off / max(way, state.turned + early * abs(angle)))


@kernel
def next_length(length, size, power):
    """Length of the panel that should meet the tolerance, after one with this error over its tolerance."""
    if not size < 1e300:
        return _FAILED * length
    if power == 1:
        return length * max(_SHRINK, min(_GROW, _SAFETY * (size + 1e-30) ** (-1.0 / N)))
    # the bend of the law at eta = 0 sets the error of graded nodes, and is left behind with them
    return length * (_BEHIND if size <= 1.0 else max(_SHRINK, _SAFETY * size ** (-1.0 / _BENT)))
