"""The laws of states that have an alpha or a material each, as kernels take them: rows made where they are met."""

from __future__ import annotations

import math
import threading
from functools import lru_cache
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Floats, Integers
from .bodies import Bodies
from .cover import Cover
from .law_axis import OCTAVES, tables_of, to_chebyshev
from .law_build import octaves
from .law_modes import refuse_far, series_of
from .law_table import made
from .prony import Block, Prony, read_only

_lock = threading.Lock()
#: the axis: what was met of each octave of alpha in this process (:mod:`..kernels.rows.alpha_axis`), never dropped
#: again, and its address and how many rows it has, 0: not met
_octaves: dict[int, Floats] = {}
_known = np.zeros((OCTAVES, 2), np.int64)


def law_of_alphas(alpha: Floats) -> Any:
    """The record of states or motions that have these alphas, one or one each, for one thread.

    It holds the law of one of them at a time (:func:`..kernels.rows.record.select_material`).
    """
    from ..kernels.rows.alpha_axis import ALPHA_E0, SOURCE, make_part, select_alpha
    from ..kernels.rows.record import E0

    alpha = np.ascontiguousarray(alpha, dtype=np.float64)
    met = np.flatnonzero(np.bincount(np.frexp(alpha)[1] - 1))
    for octave in met[_known[met, 1] == 0].tolist():
        with _lock:
            if not _known[octave, 1]:  # else another thread just has
                _octaves[octave], count = _octave(octave)
                _known[octave] = _octaves[octave].ctypes.data, count
    rows, marks = _room(int(_known[met, 1].max()))
    marks[E0] = ALPHA_E0
    return _record(
        select_alpha, make_part, SOURCE, rows=rows, marks=marks, alpha=alpha, state_count=alpha.size, octaves=_known
    )


def order_of_alphas(alpha: Floats, kappa: Floats, V: Floats) -> Integers:
    """An order in which states of one octave of alpha and one of kappa |V| follow each other.

    What they read is then near: scattered states take half as long again.
    """
    octaves = 256 * np.frexp(alpha)[1].astype(np.int16) + np.clip(np.frexp(kappa * V)[1], -5, 100).astype(np.int16)
    return np.argsort(octaves, kind="stable") if octaves.size > 1 else np.empty(0, np.int64)


def _room(count: int) -> tuple[Floats, Integers]:
    """Of so many rows, numbers and marks, with those in front."""
    from ..kernels.rows.record import PARTS_PER_ROW, ROW_SIZE, SELECTED

    marks = np.zeros((count + 1) * PARTS_PER_ROW, np.int64)
    marks[SELECTED] = -1
    return np.zeros((count + 1) * ROW_SIZE), marks


def _record(select: Any, make: Any, kind: Any, free: Any = None, **known: Any) -> Any:
    """The record of a law by its kernels and what these know: numbers, and arrays by their addresses.

    ``free``: room for what a cover has beside its rows, which its kernels know too.
    """
    known |= {} if free is None else {"cover_rows": free}
    from ..kernels.compile.intrinsics import function_address
    from ..kernels.rows.record import Law

    source = np.zeros(1, kind)
    for name, value in known.items():
        source[name] = value.ctypes.data if isinstance(value, np.ndarray) else value
    # the marks keep alive all that the kernels have the addresses of
    held = SimpleNamespace(__array_interface__=known["marks"].__array_interface__, arrays=(source, known))
    addresses = function_address(select, kind), function_address(make, kind), int(source.ctypes.data)
    rows, marks, added = map(read_only, (known["rows"].view(), np.asarray(held), np.empty(0)))
    return Law(rows, marks, added, *addresses, None if free is None else read_only(free.view()))


def _octave(octave: int) -> tuple[Floats, int]:
    """(numbers, rows) of an octave of alpha."""
    from ..kernels.rows.alpha_axis import ALPHA_PARTS
    from ..kernels.rows.record import BODY_MOMENTS, H_OVER_F2, PART_SIZE, ROW_SIZE

    tables = tables_of(octave)
    rows, c = len(tables[0].given_coefficients), np.array([table.T_mean for table in tables])
    values = np.array([table.record.rows[ROW_SIZE:].reshape(rows, ROW_SIZE) for table in tables])
    # two powers of one function, then of the other
    pairs = values[..., :BODY_MOMENTS].reshape(len(tables), rows, -1, 2, 2)
    pairs[..., 1, :] /= c[:, None, None, None]  # M/V and epsilon
    values = np.concatenate([values[..., :BODY_MOMENTS], values[..., H_OVER_F2:]], axis=-1)
    found = to_chebyshev(values.reshape(len(tables), rows, ALPHA_PARTS, PART_SIZE))
    return read_only(np.moveaxis(found, 0, 2)), rows


def law_of_materials(materials: Prony | Bodies, which: Integers) -> Any:
    """The record of states or motions that have the materials ``which``.

    For one thread; it holds the law of one of them at a time (:func:`..kernels.rows.record.select_material`).
    """
    if isinstance(materials, Cover):
        return _law_of_covers(materials, which)
    from ..kernels.rows.series import LANES, series_size, workspace_size
    from ..kernels.rows.z_grid import (
        FIRST_EXPONENT,
        SERIES_START,
        SOURCE,
        grid_size,
        make_part,
        select_series,
        work_size,
    )

    some, of = np.unique(which, return_inverse=True)
    blocks = list(materials.blocks(some))
    most = max((block.modes.a.shape[-1] for block in blocks), default=0)
    numbers = np.zeros((some.size, SERIES_START + series_size(most)))
    for block in blocks:
        if block.modes.a.shape[-1]:
            refuse_far(block.modes.b.min(), block.modes.a.max())
        found = _numbers(block)
        numbers[block.rows, : found.shape[1]] = found
    count = int(numbers[:, FIRST_EXPONENT + 1].max(initial=1.0))
    nodes, working = grid_size(count, float(numbers[:, 0].max(initial=1.0))), workspace_size(most)
    rows, marks = _room(count)
    return _record(
        select_series, make_part, SOURCE, rows=rows, marks=marks,
        material_index=np.ascontiguousarray(of, dtype=np.int64), state_count=of.size, materials=numbers,
        material_size=numbers.shape[1], numbers=np.empty(work_size(nodes)), node_count=nodes,
        node_versions=np.zeros(nodes // LANES, np.int64), workspace=np.empty(working), workspace_size=working,
        unlike=any(block.weights is not None for block in blocks),
    )  # fmt: skip


def _numbers(block: Block) -> Floats:
    """What the kernels take of materials, a row each (:mod:`..kernels.rows.z_grid`)."""
    modes, count = block.modes, block.rows.size
    weights = np.full(modes.J.shape, 0.5) if block.weights is None else block.weights
    alpha, fast = np.broadcast_to(modes.alpha, count), modes.J * modes.b
    logs = fast * (math.log(2.0) - np.log(modes.b) - np.euler_gamma)
    sums = [(share * term).sum(axis=-1) for share in (1.0, weights, 1.0 - weights) for term in (fast, logs)]
    means = [(share * modes.J / modes.b).sum(axis=-1) for share in (weights, 1.0 - weights)]
    first, rows, N = np.zeros(count), np.ones(count), np.full(count, modes.a.shape[-1])
    if modes.a.shape[-1]:
        first, rows = octaves(modes.b[:, 0], modes.a[:, -1])
    *vectors, Q = series_of(modes, weights)
    front = [alpha, 1.0 / np.sqrt(alpha), *sums, *means, first, rows, N]
    return np.concatenate([np.stack(front, axis=1), *vectors, Q.reshape(count, -1)], axis=1)


def _law_of_covers(covers: Cover, which: Integers) -> Any:
    """The record of states or motions that have the covers ``which``, for one thread."""
    from ..kernels.numerics.interpolation import to_chebyshev as to_terms
    from ..kernels.rows.record import E0
    from ..kernels.rows.thickness_axis import NODES, SOURCE, make_part, select_cover

    some, of = np.unique(which, return_inverse=True)
    octave, place = np.floor(np.log2(covers.thickness[some])), np.log2(covers.thickness[some])
    laws = {each: _octave_of_covers(covers.of_thickness(2.0**each)) for each in np.unique(octave).tolist()}
    weights = np.polynomial.chebyshev.chebvander(2.0 * (place - octave) - 1.0, NODES - 1) @ to_terms(NODES)
    octaves = np.array([(laws[each].numbers.ctypes.data, laws[each].rows) for each in octave.tolist()], np.int64)
    most = max(law.rows for law in laws.values())
    rows, marks = _room(most)
    marks[E0] = next(iter(laws.values())).e0
    free = np.zeros(max(law.beside for law in laws.values()))
    return _record(
        select_cover, make_part, SOURCE, free, rows=rows, marks=marks,
        cover_index=np.ascontiguousarray(of, dtype=np.int64), state_count=of.size,
        weights=np.ascontiguousarray(weights), octaves=octaves, cover_count=some.size,
    )  # fmt: skip


class _CoverLaws(NamedTuple):
    """Laws of covers at the nodes of an octave of thickness.

    numbers : (nodes, numbers) of a law: those in front, its rows, and what a cover has beside them.
    rows, e0 : how many rows each has, and the exponent of the first.  beside : how many of the numbers are beside them.
    """

    numbers: Floats
    rows: int
    e0: int
    beside: int


def _octave_of_covers(thinnest: Cover) -> _CoverLaws:
    """Those of an octave of thickness, made once a process; ``thinnest``: its lower end."""
    with _lock:
        return _made_octave_of_covers(thinnest)


@lru_cache(maxsize=32)
def _made_octave_of_covers(thinnest: Cover) -> _CoverLaws:
    from ..kernels.numerics.interpolation import chebyshev, to_doubles
    from ..kernels.rows.record import E0, ROW_SIZE
    from ..kernels.rows.thickness_axis import NODES

    numbers = []
    for place in to_doubles(chebyshev(NODES)).tolist():
        cover = thinnest.of_thickness(thinnest.thickness * 2.0 ** (0.5 + 0.5 * place))
        law = made(cover, cover=cover.rows(2.0 * thinnest.thickness)).record
        numbers.append(np.concatenate([law.rows, law.cover_rows]))
    return _CoverLaws(np.array(numbers), law.rows.size // ROW_SIZE - 1, int(law.marks[E0]), law.cover_rows.size)
