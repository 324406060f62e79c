"""Points of the unit cube, block by block: each block is a function of (seed, block) alone.

Whichever process draws a block, in whatever order, gets the same bits, and nothing outside the
block is held in memory.

- random: numpy's Philox, a counter-based generator (J. Salmon et al., SC11, 2011), keyed by
  (seed, block).
- latin: stratum i of n holds motion p(i), p a permutation that is computed point by point: a
  Feistel network over the next power of 4, walked until it falls inside n (J. Black and
  P. Rogaway, CT-RSA 2002), a key a dimension.  Within the stratum as random.
- sobol: one scrambled sequence of scipy.stats.qmc by the seed; a block starts at the point that
  the Gray code of its index gives (I. A. Antonov and V. M. Saleev, 1979), without drawing those before.
"""

from __future__ import annotations

import copy
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .inputs.record import LARGEST, SMALLEST

Design = Literal["random", "latin", "sobol"]
_ROUNDS = 6
#: bits of a Sobol coordinate: as many as a double holds
_BITS = 52


def points(
    design: Design, seed: int, n: int, dimensions: int, start: int, stop: int, block: int
) -> NDArray[np.float64]:
    """Points start..stop of n, which are block number ``block``: (dimensions, stop - start), inside (0, 1)."""
    if dimensions == 0:
        return np.empty((0, stop - start))
    if design == "sobol":
        drawn = _sobol(seed, dimensions, start, stop)
    else:
        drawn = _stream(seed, block).random((dimensions, stop - start))
        if design == "latin":
            index = np.arange(start, stop, dtype=np.uint64)
            strata = [permuted(index, n, key) for key in _keys(seed, dimensions)]
            drawn = (np.array(strata) + drawn) / n
    return np.clip(drawn, SMALLEST, LARGEST)


def _stream(seed: int, number: int) -> np.random.Generator:
    return np.random.Generator(np.random.Philox(key=np.array([seed, number], np.uint64)))


def _keys(seed: int, dimensions: int) -> NDArray[np.uint64]:
    """A key for each round of each dimension; of a stream that no block has."""
    return _stream(seed, 2**64 - 1).integers(0, 2**64, (dimensions, _ROUNDS), dtype=np.uint64)


def permuted(index: NDArray[np.uint64], n: int, key: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Where a permutation of 0 ... n - 1 takes each of ``index``."""
    half = max((int(n - 1).bit_length() + 1) // 2, 1)
    result = _feistel(index, half, key)
    outside = np.flatnonzero(result >= n)
    while outside.size:
        result[outside] = _feistel(result[outside], half, key)
        outside = outside[result[outside] >= n]
    return result


def _feistel(index: NDArray[np.uint64], half: int, key: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """A permutation of the numbers of 2 half bits."""
    width, mask = np.uint64(half), np.uint64(2**half - 1)
    left, right = index >> width, index & mask
    for round_key in key:
        left, right = right, left ^ (_scrambled(right + round_key) & mask)
    return (left << width) | right


def _scrambled(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finaliser of splitmix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@lru_cache(maxsize=2)
def _sequence(seed: int, dimensions: int) -> Any:
    from scipy.stats import qmc

    return qmc.Sobol(dimensions, bits=_BITS, rng=np.random.default_rng(seed))


def _sobol(seed: int, dimensions: int, start: int, stop: int) -> NDArray[np.float64]:
    """Points start..stop of the sequence.

    ``fast_forward`` of scipy passes over all points before, which at 10^11 would take minutes a
    block (and refuses more than 32 bits); its state is set instead, and tested against all points.
    """
    sequence = copy.copy(_sequence(seed, dimensions))
    drawn = np.empty((stop - start, dimensions))
    state, begun = sequence._shift.copy(), max(start - 1, 0)
    gray = begun ^ (begun >> 1)
    for bit in range(gray.bit_length()):
        if gray >> bit & 1:
            state ^= sequence._sv[:, bit]
    sequence._quasi, sequence.num_generated = state, start
    first = start == 0
    if first:  # alone: the first call would warn about a number of points that is no power of 2
        drawn[:1] = sequence.random(1)
    drawn[first:] = sequence.random(stop - start - first)
    return np.ascontiguousarray(drawn.T)
