"""Materials as kernels take them: tables that fill where they are met, a few of which every thread keeps."""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import stored
from .bodies import Bodies
from .prony import Prony
from .prony_array import MaterialArray
from .prony_forms import Modes

#: materials that a thread keeps, of each kind
_KEPT = 8
#: octaves beyond the shortest and the longest time of a material from which on it is in its limits
_MARGIN = 28
#: modes from which on a table takes about as long to fill as to write to disk, and several times as long as to read
_WORTH_STORING = 10


class _Kept(threading.local):
    """Tables are written to without the GIL, so threads do not share them."""

    def __init__(self) -> None:
        self.materials: OrderedDict[float | Prony | Bodies, Any] = OrderedDict()


_kept = _Kept()


def record(given: float | Prony | Bodies) -> Any:
    """The record of one material, an alpha or a series, or of two bodies, for this thread alone.

    Bodies that are alike, or both elastic, are one material: only others need the record of a pair.
    """
    if isinstance(given, Bodies) and (given.like or given.alpha == 1.0):
        return record(given.total if given.total.E.size else 1.0)
    return _found(_kept.materials, given, _tabulated)


def _tabulated(given: float | Prony | Bodies) -> Any:
    from ..kernels.material.tabulated import tabulated

    if not isinstance(given, Prony | Bodies):
        return tabulated(given)
    whole = _pair_tables(given) if isinstance(given, Bodies) else _series_table(given)
    return whole._replace(table=whole.table.copy())  # parts are read only


def series(prony: Prony) -> Any:
    """The record of a series by its modes."""
    return series_of(prony.modes)


def series_of(modes: Modes) -> Any:
    from ..kernels.material.series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e, t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
    return Series(modes.a, modes.b, e, t, np.sqrt(strengths) / modes.gap)


def unsteadiness(given: Any, zeta: NDArray[np.float64]) -> NDArray[np.float64]:
    """N of M = M(V) + N V' at every zeta; ``given``: a series, or alphas, one or one each."""
    from ..kernels.law.unsteady import unsteady_loop
    from ..kernels.material.series import Series

    found, zeta, alpha = np.empty(zeta.size), zeta.view(), np.empty(0)
    if isinstance(given, Prony):
        known = series(given)
    else:
        alpha = np.atleast_1d(given).view()
        known = Series(np.ones(1), np.ones(1), np.ones(1), np.ones(1), np.ones((1, 1)))
    zeta.flags.writeable = alpha.flags.writeable = False  # as all that a kernel reads, see ``blocks.elements``
    unsteady_loop(known, alpha, zeta, found, 0, found.size)
    return found


def _bins(fastest: float, slowest: float) -> tuple[int, int]:
    """First bin of a table, and that behind its last, from the highest rate of relaxation and the least of creep."""
    from ..kernels.numerics.bins import bin_number
    from ..kernels.numerics.quartet import BITS

    octaves = math.floor(-math.log2(fastest)) - _MARGIN, math.ceil(-math.log2(slowest)) + _MARGIN
    first, stop = (int(bin_number(2.0**octave, BITS)) for octave in octaves)
    return first, stop


def _table(known: Any, modes: Modes) -> Any:
    """The table of functions of z of a series, between its ends; one of many modes is kept on disk."""
    first, stop = _bins(modes.a[-1], modes.b[0])
    if modes.a.size < _WORTH_STORING:
        return _filled(known, first, stop)
    numbers = np.concatenate([*map(np.ravel, known), [first, stop]])  # all that the kernel is given
    path = stored.folder("series") / stored.file_name(numbers)
    found = stored.load(path, "table of a series", numbers, lambda arrays: arrays["table"])
    if found is None:
        found = _filled(known, first, stop)
        stored.save(path, numbers, table=found)
    return found


def _filled(known: Any, first: int, stop: int) -> Any:
    """A table with these bins made."""
    from ..kernels.material.fill import fill
    from ..kernels.numerics.quartet import empty_table

    table = empty_table(2 ** math.ceil(math.log2(stop - first)))
    table[:] = np.nan  # what lay in memory before shall not reach the disk
    fill(known, first, stop, table)
    return table


def _weights(modes: Modes, share: Any = 1.0) -> tuple[Any, Any, Any]:
    """``rise``, ``weight`` and ``log_weight`` of the ends of a table; the last two for a share of every creep mode."""
    weights = share * modes.J * modes.b
    logs = math.log(2.0) - np.log(modes.b) - np.euler_gamma
    return modes.E.sum(axis=-1), weights.sum(axis=-1), (weights * logs).sum(axis=-1)


def _ends(modes: Modes, share: Any, squares: float) -> Any:
    """The numbers of the ends of a table, for this share of every creep mode."""
    from ..kernels.material.each import Ends

    rise, weight, log_weight = map(float, _weights(modes, share))
    return Ends(True, rise, weight, log_weight, squares)


def records(materials: MaterialArray, which: NDArray[np.int64]) -> tuple[Any, NDArray[np.float64]]:
    """(The record of states or motions that have the materials ``which``, what times of each material are counted in).

    For one thread and one call: it holds the tables of one of them at a time.
    """
    from ..kernels.material.each import COLUMNS, COLUMNS_OF_PAIRS, FIRST, MODES, STOP, Each, EachPair
    from ..kernels.material.series import packed_size, working_size
    from ..kernels.numerics.quartet import empty_table

    some, of = np.unique(which, return_inverse=True)
    blocks = list(materials.blocks(some))
    pairs = any(block.weights is not None for block in blocks)
    count, most = some.size, max((block.modes.a.shape[-1] for block in blocks), default=0)
    numbers, bins = np.zeros((count, COLUMNS_OF_PAIRS if pairs else COLUMNS)), np.zeros((count, 3), np.int64)
    packed, unit = np.zeros((count, packed_size(most))), np.empty(count)
    for block in blocks:
        modes, rows, N = block.modes, block.rows, block.modes.a.shape[-1]
        unit[rows], bins[rows, MODES] = block.unit, N
        columns = modes.alpha, block.T_mean, 1.0 / modes.a[:, -1] if N else 1.0, *_weights(modes), block.squares
        numbers[rows, :COLUMNS] = np.stack(np.broadcast_arrays(*columns), axis=1)
        if N:
            bins[rows, FIRST : STOP + 1] = [_bins(*ends) for ends in zip(modes.a[:, -1], modes.b[:, 0], strict=True)]
        *vectors, Q = series_of(modes)
        weights = np.ones(modes.b.shape) if block.weights is None else block.weights
        packed[rows, : packed_size(N)] = np.concatenate([*vectors, weights, Q.reshape(rows.size, -1)], axis=1)
        if block.weights is not None:
            numbers[rows, COLUMNS:] = _of_bodies(modes, block.weights)
    own = np.ascontiguousarray(of, dtype=np.int64)
    whole = Each(own, numbers, bins, packed, empty_table(), np.full(1, -1), np.empty(working_size(most)))
    return EachPair(*whole, empty_table()) if pairs else whole, unit[own]


def _of_bodies(modes: Modes, weights: NDArray) -> NDArray[np.float64]:
    """(n, 10): numbers of ``Body``, half-space then cylinder, by the half-space's share of every creep mode."""
    a, E = modes.a, modes.E[:, None, :]
    inner = 1.0 / a + (E / (a[:, :, None] + a[:, None, :])).sum(axis=-1)
    # m_j = J_j T_j - c_j/z as z -> infinity
    rises = modes.J * np.array([one @ other for one, other in zip(E / modes.gap, inner, strict=True)])
    found = np.empty((len(weights), 10))
    for n, share in ((0, weights), (5, 1.0 - weights)):
        T_mean, squares = map(_sums_of, (share * modes.J / modes.b, share * rises))
        found[:, n : n + 5] = np.stack([T_mean, *_weights(modes, share), 2.0 * squares], axis=1)
    return found


def _sums_of(terms: NDArray) -> NDArray[np.float64]:
    """The sum of each row, rounded once."""
    return np.array([math.fsum(row) for row in terms.tolist()])


@lru_cache(maxsize=_KEPT)
def _series_table(prony: Prony) -> Any:
    """The table of several modes."""
    from ..kernels.material.tabulated import Tabulated

    modes = prony.modes
    ends = _ends(modes, 1.0, sum(prony.second_moments))
    return Tabulated(prony.alpha, prony.T_mean, float(1.0 / modes.a[-1]), _table(series(prony), modes), ends)


@lru_cache(maxsize=_KEPT)
def _pair_tables(bodies: Bodies) -> Any:
    """The tables of two bodies that deform unlike each other."""
    from ..kernels.material.each import Body, Ends
    from ..kernels.material.pair import Pair
    from ..kernels.material.series import Parts

    whole, modes, weights = bodies.total, bodies.total.modes, bodies.half_space_weights
    each = Modes(modes.alpha, *(part[None] for part in (modes.a, modes.b, modes.E, modes.J, modes.gap)))
    half_space, cylinder = (
        Body(one[0], Ends(True, *one[1:])) for one in _of_bodies(each, weights[None]).reshape(2, 5).tolist()
    )
    parts = _table(Parts(**series(whole)._asdict(), weights=weights), modes)
    return Pair(**_series_table(whole)._asdict(), parts=parts, half_space=half_space, cylinder=cylinder)


def _found(kept: OrderedDict[Any, Any], given: float | Prony | Bodies, make: Callable[[Any], Any]) -> Any:
    """What is kept of this material, or was made now; the last used is the last to go."""
    if given in kept:
        kept.move_to_end(given)
        return kept[given]
    kept[given] = made = make(given)
    if len(kept) > _KEPT:
        kept.popitem(last=False)
    return made
