"""A material of any number of relaxation times in Arb's digits: both of its forms, midpoints
without a radius.

Creep from relaxation and relaxation from creep are zeros between poles, bisected in the distance
from the nearer one.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import flint
from flint import arb

from viscoroll import Bodies, Prony

#: by which conversions carry more than is asked, and a zero is no nearer to a pole, over their
#: distance
_MORE_BITS = 200
_NEAREST = 280


class Material(NamedTuple):
    """Rates of relaxation and of creep, ascending, strengths of creep, and what of these is the
    half-space's.
    """

    a: list[Any]
    b: list[Any]
    J: list[Any]
    weights: list[Any]

    @classmethod
    def of_rates(cls, a: list[Any], b: list[Any], weights: list[Any] | None = None) -> Material:
        """J_j = prod_i (a_i - b_j)/prod_{i != j} (b_i - b_j)/(alpha b_j), signs dropped, alpha =
        prod a/b.
        """
        J = []
        alpha = math.prod((own / at for own, at in zip(a, b, strict=True)), start=arb(1))
        for j, rate in enumerate(b):
            top = math.prod(abs(at - rate) for at in a)
            J.append(
                top
                / math.prod(
                    (abs(at - rate) for i, at in enumerate(b) if i != j), start=rate * alpha
                )
            )
        return cls(a, b, J, weights or [arb(0.5)] * len(b))


def material_of(given: Any) -> Material:
    """Of a stiffness ratio alpha (a float or a ball; times over T_epsilon), a series, or a pair
    that shares no time.

    At the working precision.
    """
    if isinstance(given, (Prony, Bodies)):
        return _converted(given, flint.ctx.prec)
    alpha = arb(given)
    return (
        Material([], [], [], [])
        if alpha == 1
        else Material([alpha], [arb(1)], [(alpha - 1) / alpha], [arb(0.5)])
    )


@lru_cache(maxsize=64)
def _converted(given: Prony | Bodies, bits: int) -> Material:
    with flint.ctx.workprec(bits + _MORE_BITS):
        if isinstance(given, Prony):
            return Material.of_rates(*_of_series(given))
        share = arb(float(given.share))
        bodies = (share, given.cylinder, arb(0)), (1 - share, given.base, arb(1))
        if given.cylinder == given.base:
            like = material_of(given.cylinder)
            return like._replace(weights=[1 - share] * len(like.b))
        modes = []
        rest = arb(0)
        for part, body, which in bodies:
            own = material_of(body)
            rest += part * (1 - sum(own.J))
            modes += [
                (rate, part * J, which) for rate, J in zip(own.b, own.J, strict=True) if part > 0
            ]
        b, J, weights = (
            list(column)
            for column in zip(*sorted(modes, key=lambda mode: float(mode[0])), strict=True)
        )
        return Material(_relaxing(b, J, rest), b, J, weights)


def _of_series(given: Prony) -> tuple[list[Any], list[Any]]:
    """Rates of relaxation and of creep."""

    def numbers(times: Any, strengths: Any) -> tuple[list[Any], list[Any]]:
        modes = sorted(zip(times.tolist(), strengths.tolist(), strict=True), reverse=True)
        return [1 / arb(time) for time, _ in modes], [arb(strength) for _, strength in modes]

    if given.by_creep:
        b, J = numbers(given.T, given.J)
        return _relaxing(b, J, 1 - sum(J)), b
    a, E = numbers(given.tau, given.E)
    return a, _zeros([arb(0), *a], [arb(1), *E], arb(0))


def _relaxing(b: list[Any], J: list[Any], rest: Any) -> list[Any]:
    """Rates of relaxation from creep, ``rest`` 1/alpha."""
    return _zeros(b, [strength * rate for strength, rate in zip(J, b, strict=True)], rest)


def _zeros(poles: list[Any], weights: list[Any], constant: Any) -> list[Any]:
    """Zeros of constant + sum w/(pole - s), right of each pole; of the last one where the constant
    is not 0.
    """

    def rising(s: Any) -> Any:
        return constant + sum(
            weight / (pole - s) for weight, pole in zip(weights, poles, strict=True)
        )

    ends = [*poles, poles[-1] + 2 * sum(weights) / constant] if constant > 0 else poles
    return [_zero(rising, low.mid(), high.mid()) for low, high in pairwise(ends)]


def _zero(rising: Any, low: Any, high: Any) -> Any:
    half = ((high - low) / 2).mid()
    from_low = rising(low + half) >= 0
    near = half * arb(2) ** -_NEAREST
    far = half
    while far - near > far * arb(2) ** (8 - flint.ctx.prec):
        middle = (near * far).sqrt().mid()
        beyond = rising(low + middle) > 0 if from_low else rising(high - middle) < 0
        near, far = (near, middle) if beyond else (middle, far)
    return (low + near if from_low else high - near).mid()
