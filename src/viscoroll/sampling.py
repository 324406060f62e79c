"""Random inputs from distributions of scipy.stats and a recorded seed, and points of runs.

:func:`sample` draws inputs from distributions; :func:`points` draws blocks of points for runs.

Each block of points is a function of (seed, block) alone.  Any process that draws a block, in any
order, gets the same bits, and holds no other block in memory.

- random: numpy's Philox, a counter-based generator (J. Salmon et al., SC11, 2011), keyed by
  (seed, block).
- latin: stratum i of n holds motion p(i), where p is a permutation that is computed point by point:
  a Feistel network over the next power of 4, iterated until the result is below n (J. Black and
  P. Rogaway, CT-RSA 2002), with a key for each dimension.  Within the stratum as random.
- sobol: one scrambled sequence of scipy.stats.qmc for the seed; a block starts at the point that
  the Gray code of its index gives (I. A. Antonov and V. M. Saleev, 1979), so that earlier points
  are not drawn.
"""

import copy
import functools
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from .core import (
    Floats,
    NDArray,
    ParameterError,
    check_array,
    check_choice,
    check_integer,
    check_number,
    check_one_given,
    describe_value,
)

__all__ = ["Sample", "sample"]

Words: TypeAlias = NDArray[np.uint64]
Design = Literal["random", "latin", "sobol"]
#: Smallest coordinate of a point: 0 would make the inverse of a distribution infinite.
SMALLEST = 2.0**-54
#: Largest coordinate of a point, the double below 1.
LARGEST = 1.0 - 2.0**-53
#: Rounds of the Feistel network.  Four with ideal round functions make a strong pseudorandom
#: permutation (M. Luby and C. Rackoff, SIAM J. Comput. 17, 1988); two more are a margin for the
#: function used here.
_ROUNDS = 6
#: Bits of a coordinate of the Sobol sequence: as many as a double holds.
_BITS = 52


class Sample(dict[str, Floats]):
    """Draws of each quantity by name, (n,), with the seed and the design that give them again.

    Attributes
    ----------
    seed : seed of the draws, a whole number in [0, 2^63).
    design : design of the draws: "random", "latin" or "sobol".

    Examples
    --------
    >>> import viscoroll as vr
    >>> draws = vr.sampling.sample(4, seed=1, mu=0.3)
    >>> draws.seed, draws.design, draws["mu"].tolist()
    (1, 'random', [0.3, 0.3, 0.3, 0.3])
    """

    seed: int
    design: str


def sample(
    n: int,
    seed: int | None = None,
    design: Design = "random",
    *,
    rng: Any = None,
    **quantities: Any,
) -> Sample:
    """Draw n values of each named quantity, independent of each other.

    Parameters
    ----------
    n : number of draws, 1 to 1e12; powers of two suit "sobol".
    seed : whole number >= 0, below 2^63, kept in the result; None: ``rng`` must be given.
    rng : in place of a seed, which is then drawn from it: a numpy.random.Generator, which is
        advanced, or an argument of default_rng.
    design : "random", "latin" (hypercube) or "sobol" (scrambled); the draws are those of a run file
        of one block.
    **quantities : a number, or a frozen scipy.stats distribution, e.g.
        ``V0=scipy.stats.uniform(-1, 2)``; drawn through its inverse CDF.

    Returns
    -------
    Sample
        A mapping from name to draws, an array (n,) of float64, in the order of ``quantities``; a
        number is repeated n times.  Its attributes ``seed`` and ``design`` give the same draws
        again, also where ``rng`` was given.

    Raises
    ------
    ParameterError
        Bad n, seed or design, both or neither of seed and rng, a quantity that is neither a number
        nor a distribution, a distribution without a median, a draw that overflows, an ``rng``
        that default_rng of numpy does not take.
    ValueError
        Of scipy, for "sobol" of more than 21201 distributions.

    Examples
    --------
    >>> import scipy.stats
    >>> import viscoroll as vr
    >>> draws = vr.sampling.sample(
    ...     100, seed=1, design="latin", V0=scipy.stats.uniform(0.1, 0.2), mu=0.3
    ... )
    >>> draws["V0"].shape, draws["mu"][0]
    ((100,), np.float64(0.3))

    Notes
    -----
    The same n, seed and design give the same bits; "latin" and "sobol" have one draw in each of n
    strata of every quantity, "sobol" if n is a power of two (``tests/runs/test_runs.py``).
    """
    check_one_given(seed=seed, rng=rng)
    if seed is None:
        try:
            seed = int(np.random.default_rng(rng).integers(2**63))
        except (TypeError, ValueError):
            allowed = "a Generator of numpy, or a whole number >= 0, its seed"
            raise ParameterError("rng", describe_value(rng), allowed) from None
    n = check_integer("n", n, 1, 10**12)
    seed = check_integer("seed", seed, 0, 2**63 - 1)
    check_choice("design", design, *get_args(Design))
    random = [name for name, value in quantities.items() if _is_distribution(name, value)]
    rows = points(design, seed, n=n, dimensions=len(random), start=0, stop=n, block=0)
    draws = Sample(quantities)  # in this order
    with np.errstate(all="ignore"):  # a draw that overflows is infinite, which is refused
        for name, column in zip(random, rows, strict=True):
            draws[name] = check_array(f"draws of {name}", quantities[name].ppf(column))
    for name in quantities.keys() - random:
        draws[name] = np.full(n, check_number(name, quantities[name]))
    draws.seed = seed
    draws.design = design
    return draws


@np.errstate(all="ignore")  # scipy may overflow for a distribution that is refused
def _is_distribution(name: str, value: Any) -> bool:
    """Return whether the value of a quantity is a distribution; else it is a number.

    name: name of the quantity, for the message.
    value: what a caller gave; an object with a method ``ppf``, which takes a probability, counts as
    a distribution.
    Returns True for a distribution, False for one finite number.
    Raises ParameterError for anything else, such as an array, and for a distribution whose median
    is not one finite number.
    """
    random = hasattr(value, "ppf")
    try:
        check_number(name, value.ppf(0.5) if random else value)
    except (TypeError, ValueError):
        allowed = "a finite number, or a distribution with finite median, as scipy.stats.norm(0, 1)"
        raise ParameterError(name, describe_value(value), allowed) from None
    return random


def points(
    design: Design, seed: int, n: int, dimensions: int, start: int, stop: int, block: int
) -> Floats:
    """Return a block of points of the unit cube, each coordinate inside (0, 1), (dimensions, stop -
    start).

    The same arguments give the same bits, whatever blocks were drawn before.

    design: "random", "latin" or "sobol", see the head of this file.
    seed: seed of all points, a whole number in [0, 2^63).
    n: number of all points, >= stop, which are the strata of "latin"; the other designs do not
    depend on it.
    dimensions: number of coordinates of a point; 0 gives an array (0, stop - start).
    start, stop: index, from 0 among all points, of the first point of the block and of the first
        one after it; start < stop.
        "latin" chooses the strata by them and "sobol" the points; "random" uses their difference
        alone.
    block: number of the block, >= 0, by which "random" and "latin" choose the random numbers;
        "sobol" does not depend on it.
    Returns a new array (dimensions, stop - start), clipped to [:data:`SMALLEST`, :data:`LARGEST`],
    the doubles next to 0 and 1 for which the inverse of a distribution stays finite.
    """
    if dimensions == 0:
        return np.empty((0, stop - start))
    if design == "sobol":
        drawn = _sobol(seed, dimensions, start, stop)
    else:
        drawn = _stream(seed, block).random((dimensions, stop - start))
        if design == "latin":
            index = np.arange(start, stop, dtype=np.uint64)
            # from a stream that no block has
            keys = _stream(seed, 2**64 - 1).integers(
                0, 2**64, (dimensions, _ROUNDS), dtype=np.uint64
            )
            strata = [permuted(index, n, key) for key in keys]
            # one point in each of n strata of each coordinate, at random within it
            drawn = (np.array(strata) + drawn) / n
    return np.clip(drawn, SMALLEST, LARGEST)


def _stream(seed: int, number: int) -> np.random.Generator:
    """Return a new random generator (Philox), at the start of one stream of a seed.

    seed: the seed, in [0, 2^63).
    number: number of the stream, in [0, 2^64): that of a block, or 2^64 - 1 for the keys of
    permutations.
    """
    return np.random.Generator(np.random.Philox(key=np.array([seed, number], np.uint64)))


def permuted(index: Words, n: int, key: Words) -> Words:
    """Return the images of numbers under a permutation of 0 ... n - 1, computed for each number by
    itself.

    The Feistel network permutes the numbers below the next power of 4; it is applied again to
    images that are not below n, until they are.

    index: the numbers, < n, not checked, (k,), uint64; not changed.
    n: size of the permutation, 1 to 2^63.
    key: keys of the rounds of the Feistel network, (rounds,), uint64; another key is another
    permutation.
    Returns the images, (k,), uint64, < n, a new array.
    """
    # half of the bits of n - 1, rounded up: 4^half >= n
    half = max(((n - 1).bit_length() + 1) // 2, 1)
    result = _feistel(index, half, key)
    while (outside := np.flatnonzero(result >= n)).size:
        result[outside] = _feistel(result[outside], half, key)
    return result


def _feistel(index: Words, half: int, key: Words) -> Words:
    """Return the images of numbers under a permutation of all numbers of 2 * half bits.

    In each round the right half and a key are mixed and added, bit by bit without carry, to the
    left half, and the halves are exchanged; this can be inverted for any mixing.

    index: the numbers, (k,), uint64, < 2^(2 half); not changed.
    half: bits of half a number, 1 to 32.
    key: keys of the rounds, (rounds,), uint64.
    Returns the images, (k,), uint64, < 2^(2 half), a new array.
    """
    width = np.uint64(half)
    mask = np.uint64(2**half - 1)
    left = index >> width
    right = index & mask
    for round_key in key:
        left, right = right, left ^ (_mix_bits(right + round_key) & mask)
    return (left << width) | right


def _mix_bits(x: Words) -> Words:
    """Return words whose bits depend on all bits of the given ones: the finaliser of splitmix64.

    (G. Steele, D. Lea, C. Flood, OOPSLA 2014.)

    x: words, (k,), uint64, not changed; the result, a new array of their shape, is computed modulo
    2^64.
    """
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@functools.lru_cache(maxsize=2)
def _sequence(seed: int, dimensions: int) -> Any:
    """Return the scrambled Sobol sequence of scipy.stats.qmc at its start.

    The sequences of the last two calls are kept and returned again, so a caller must advance a
    copy.

    seed: seed of the scrambling, in [0, 2^63).
    dimensions: number of coordinates of a point, >= 1.
    Returns a :class:`scipy.stats.qmc.Sobol` of 52 bits.
    Raises ParameterError for more than 21201 dimensions, for which scipy has no numbers.
    """
    from scipy import stats

    check_integer("number of random quantities with design 'sobol'", dimensions, 1, 21_201)
    return stats.qmc.Sobol(dimensions, bits=_BITS, rng=np.random.default_rng(seed))


def _sobol(seed: int, dimensions: int, start: int, stop: int) -> Floats:
    """Return points of the scrambled Sobol sequence of a seed, (dimensions, stop - start), in [0,
    1).

    seed: seed of the scrambling, in [0, 2^63).
    dimensions: number of coordinates of a point, >= 1.
    start, stop: index of the first point, and of the one after the last, 0 <= start < stop <= 2^52.
    Returns a new array, whose entries are multiples of 2^-52.

    ``fast_forward`` of scipy visits all points before ``start``, which at 10^11 would take minutes
    a block (and refuses more than 32 bits).  The private state ``_quasi`` of a copy of the sequence
    is set instead, by the Gray code of ``start``; a test compares with a sequence from its start.
    """
    sequence = copy.copy(_sequence(seed, dimensions))
    drawn = np.empty((stop - start, dimensions))
    state = sequence._shift.copy()
    # point k is the shift of the scrambling, to which without carry the direction number of each
    # bit of the Gray code of k is added
    gray = start ^ (start >> 1)
    for bit in range(gray.bit_length()):
        if gray >> bit & 1:
            state ^= sequence._sv[:, bit]
    drawn[0] = state * 2.0**-_BITS
    sequence._quasi = state
    sequence.num_generated = start + 1
    drawn[1:] = sequence.random(stop - start - 1)
    return np.ascontiguousarray(drawn.T)
