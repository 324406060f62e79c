"""The contact law cut at one alpha: the octaves that a call needs, the last of which are kept in memory."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .blocks import elements
from .errors import ConvergenceError

#: states from which on a slice is used: over three decades of V it costs as much as so many states without it
WORTHWHILE = 4096
#: log2 of the range of kappa |V| that is served
_LOWEST, _HIGHEST = -30, 24
#: states whose kappa V is held at a time
_BLOCK = 1 << 16


class Slice(NamedTuple):
    """Coefficients[bin, function, power] over kappa |V| and over F(eta), and the numbers of their first bins."""

    speed: NDArray[np.float64]
    first_speed: int
    stick: NDArray[np.float64]
    first_stick: int


def slice_for(alpha: float, kappa: NDArray[np.float64], V: NDArray[np.float64], *, stick: bool) -> Slice | None:
    """The slice for a call with these kappa and V, without its part over F(eta) unless ``stick``.

    None where no state is within its reach.
    """
    from .kernels.law.length import contact_length
    from .kernels.law.material import Material
    from .kernels.law.slice_fit import speed_octave, stick_octave
    from .kernels.law.slice_loop import EDGE

    slow, fast = _speeds_within(kappa, V)
    if slow > fast:
        return None
    speed, first_speed = _octaves(speed_octave, alpha, slow, fast)
    if not stick:
        return Slice(speed, first_speed, speed[:0], 0)
    # zeta <= F(zeta) <= zeta + 1/2, with a margin for rounding
    material = Material(alpha, (alpha - 1.0) / alpha)
    short, long = (contact_length(u, material)[0] / (2.0 * u) for u in (fast, slow))
    return Slice(speed, first_speed, *_octaves(stick_octave, alpha, 0.99 * EDGE * short, 1.01 * long + 0.5))


def _speeds_within(kappa: NDArray[np.float64], V: NDArray[np.float64]) -> tuple[float, float]:
    """Least and largest kappa |V| that are served; least > largest if there is none."""
    from .kernels.law.slice_loop import speed_range

    shape = np.broadcast_shapes(kappa.shape, V.shape)
    kappas, speeds = elements(kappa, shape), elements(V, shape)
    slow, fast = 2.0**_HIGHEST, 0.0
    for start in range(0, math.prod(shape), _BLOCK):
        factor, part = (of(start, min(start + _BLOCK, math.prod(shape))) for of in (kappas, speeds))
        if factor.size > 1:
            factor, part = np.ones(1), factor * part
            part.flags.writeable = False
        least, largest = speed_range(factor[0], part, 2.0**_LOWEST, 2.0**_HIGHEST)
        slow, fast = min(slow, least), max(fast, largest)
    return slow, fast


def _octaves(fit: Callable, alpha: float, low: float, high: float) -> tuple[NDArray[np.float64], int]:
    """The octaves that hold [low, high] in one table, and the number of its first bin."""
    from .kernels.bessel.ratios import bin_number

    first, last = (math.frexp(x)[1] - 1 for x in (low, high))
    # ldexp is exact in any rounding mode that a host program may have set, pow is not
    bottom = math.ldexp(1.0, first)
    return np.concatenate([octave_of(fit, alpha, n) for n in range(first, last + 1)]), bin_number(bottom)


@lru_cache(maxsize=1024)
def octave_of(fit: Callable, alpha: float, octave: int) -> NDArray[np.float64]:
    """One fitted octave.  Safe from several threads: at worst one is fitted twice, to the same bits."""
    coefficients, status = fit(alpha, octave)
    if status:
        raise ConvergenceError(f"contact: no slice at alpha = {alpha!r}: an iteration hit its cap")
    return coefficients
