"""Truth for the tests: the printed law of pipeline.evidence.truth, and its slopes."""

from __future__ import annotations

from typing import NamedTuple

import mpmath as mp

from pipeline.evidence.truth import precise

DIGITS = 50
#: digits that the printed forms may lose (see pipeline.evidence.truth.precise)
GUARD = 30


class State(NamedTuple):
    """One state of the contact, V > 0, delta >= 0."""

    lam: mp.mpf
    zeta: mp.mpf
    epsilon: mp.mpf
    delta_star: mp.mpf
    beta: mp.mpf
    Q: mp.mpf
    M: mp.mpf


def state(alpha: float, kappa: float, mu: float, V: float, delta: float) -> State:
    """The printed law; every argument is taken as the exact number it is."""
    with mp.workdps(DIGITS + GUARD):
        found = precise.printed_state(mp, *(mp.mpf(value) for value in (alpha, kappa, mu, V, delta)))
        return State(**found)


def slope(alpha: float, kappa: float, mu: float, V: float, delta: float, by: str) -> dict[str, mp.mpf]:
    """Derivatives of Q and M by "V" (fixed delta), "delta" (fixed V): central differences.

    With 50 digits a step of 1e-15 leaves an error near 1e-30.
    """
    with mp.workdps(DIGITS + GUARD):
        base = {"V": mp.mpf(V), "delta": mp.mpf(delta)}
        h = base[by] * mp.mpf(10) ** -15
        up, down = (state(alpha, kappa, mu, **(base | {by: base[by] + sign * h})) for sign in (1, -1))
        return {name: (getattr(up, name) - getattr(down, name)) / (2 * h) for name in ("Q", "M")}
