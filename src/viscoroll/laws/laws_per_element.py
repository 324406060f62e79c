"""Laws of arrays in which every element has its own alpha, material or cover: rows are made where
kernels read them.

An element is a state or a motion.  A record (:class:`.law_record.Law`) holds the law of
one element at a time, which :func:`.law_record.select_material` selects; the kernel that
reads a part of a row has it made if it is that of another element.  Such a record belongs to one
thread.
"""

import functools
import math
import threading
import types
from typing import Any

import numpy as np

from ..core import Floats, Integers, ParameterError
from ..kernels.numerics.interpolation import chebyshev, to_chebyshev, to_doubles
from ..materials import Bodies, Cover, Prony, lock_array
from .cover_rows import cover_rows
from .law_tables import OCTAVES, make_table, tables_of_octave
from .row_layout import AxisRows, align_vector, allocate_rows, pack_axis, pack_materials

#: laws of an octave of thickness, at Chebyshev nodes; of a rubber with three modes the error then
#: is 1e-12
_THICKNESS_NODES = 14
#: laws over Poisson's ratio in [0, 1/2] at each of them, at Chebyshev nodes of ln(3 - 4 nu), where
#: the kernel of the layer has no singularity nearby; the error then is 1e-10 of covers down to
#: h/l0 = 0.25, and 5e-9 down to 0.13
_NU_NODES = 12

_lock = threading.Lock()
#: rows of every octave of alpha that this process has used; they are kept until it ends
_octaves: dict[int, AxisRows] = {}
#: addresses of the two arrays and number of rows of each of them, which kernels read (OCTAVE_SIZE
#: of ``kernels/law/alpha_axis.py``, which loads numba); 0 rows: not used yet
_octave_table = np.zeros((OCTAVES, 3), np.int64)


def record_of_alphas(alpha: Floats) -> Any:
    """Return the record of the laws of states or motions that have an alpha each, for use by one
    thread.

    The record holds the law of one element at a time
    (:func:`.law_record.select_material`).

    alpha: instantaneous divided by long-time modulus, dimensionless, in [1, 1e12], not checked: one
        value for each element, (n,), n >= 1, or one for all, (1,).
    Returns :class:`.law_record.Law`, with T_epsilon for the unit of time.
    """
    return records_of_alphas(alpha, 1)[0]


def records_of_alphas(alpha: Floats, count: int) -> tuple[Any, ...]:
    """Return several records as in :func:`record_of_alphas`, so that as many elements are evaluated
    together.

    alpha: one value for each element, (n,), n >= 1, or one for all, (1,), dimensionless, in [1,
        1e12]; not checked.
    count: number of records, each of which holds the law of one element at a time.
    Returns a tuple of ``count`` :class:`.law_record.Law`, in which no element is
    selected yet.  Octaves of alpha that this process has not used before are computed and kept
    until it ends.
    """
    from ..kernels.law import alpha_axis

    alpha = np.ascontiguousarray(alpha, dtype=float)
    # numbers n of all octaves that occur, 2^n <= alpha < 2^(n + 1)
    octaves = np.flatnonzero(np.bincount(_exponents(alpha) - 1))
    with _lock:
        for octave in octaves[_octave_table[octaves, -1] == 0].tolist():
            _octaves[octave] = axis = pack_axis(tables_of_octave(octave))
            _octave_table[octave] = axis.numbers.ctypes.data, axis.starts.ctypes.data, axis.rows
    # a record holds one element at a time: it has room for the rows of any of these octaves
    row_count = int(_octave_table[octaves, -1].max())
    return tuple(
        _lazy_record(
            alpha_axis,
            alpha_axis.select_alpha,
            row_count,
            e0=alpha_axis.ALPHA_E0,
            alpha=alpha,
            state_count=alpha.size,
            octaves=_octave_table,
        )
        for _ in range(count)
    )


def sort_by_octave(alpha: Floats, kappa: Floats, V: Floats) -> Integers:
    """Return an order of states in which those of one octave of alpha and one of kappa |V| follow
    each other.

    They then read rows that are close in memory: states in random order take half as long again.
    alpha, kappa, V: instantaneous over long-time modulus, slenderness R/l0, and speed of the
        states, of any sign, dimensionless, finite, (n,), or (1,) for all; contiguous doubles.
        Octaves of kappa |V| below 2^-5 count as one, as do those from 2^99 on.
    Returns indices (n,), int64, by ascending octave of alpha, then of kappa |V|, the states of one
    octave in the order given; an empty array, which stands for the order given, for a single state.
    """
    # one number by which to sort: 256 is more than the 106 exponents of kappa |V| told apart
    octaves = (256 * _exponents(alpha) + np.clip(_exponents(kappa * V), -5, 100)).astype(np.int16)
    return np.argsort(octaves, kind="stable") if octaves.size > 1 else np.empty(0, np.int64)


def _exponents(x: Floats) -> Integers:
    """Return n with 2^(n-1) <= |x| < 2^n for each x, from its bits; -1022 for 0 and for subnormal
    numbers.

    ``np.frexp`` takes four times as long.
    x: contiguous doubles, finite.
    Returns integers in the shape of x.
    """
    # the 11 bits of the exponent, without the sign
    return ((x.view(np.int64) >> 52) & 0x7FF) - 1022


def record_of_materials(materials: Prony | Bodies, which: Integers) -> Any:
    """Return the record of the laws of states or motions that have a material each, for use by one
    thread.

    The record holds the law of one element at a time
    (:func:`.law_record.select_material`).
    materials: :class:`.prony.Prony` of n materials, :class:`.bodies.Bodies` of n pairs, or
        :class:`.bodies.Cover` of n covers; elastic ones may be among them.
    which: index of the material of each element, int, (elements,), at least one, or (1,) for all.
    Returns :class:`.law_record.Law`, in which no element is selected yet.  Of series and
    pairs no row is computed before kernels read it; of covers the laws at the nodes of
    :func:`count_laws` are, and kept for later calls.
    Raises ParameterError for times of half-spaces beyond 1e-100 to 1e100 times T_ref, and for a
    cover that is too thin.
    """
    used, index = np.unique(which, return_inverse=True)
    index = np.ascontiguousarray(index, dtype=np.int64)
    if isinstance(materials, Cover):
        return _record_of_covers(materials[used], index)
    from ..kernels.law import material_series, z_grid

    blocks = list(materials.blocks(used))
    # numbers of modes ascend
    most_modes = blocks[-1].modes.a.shape[-1]
    numbers = np.zeros((used.size, z_grid.SERIES_START + material_series.series_size(most_modes)))
    for block in blocks:
        packed = pack_materials(block)
        numbers[block.rows, : packed.shape[1]] = packed
    # columns of pack_materials: the number of rows follows e0, alpha is the first
    row_count = int(numbers[:, z_grid.FIRST_EXPONENT + 1].max())
    nodes = z_grid.grid_size(row_count, float(numbers[:, 0].max()))
    workspace = np.empty(material_series.workspace_size(most_modes))
    return _lazy_record(
        z_grid,
        z_grid.select_series,
        row_count,
        material_index=index,
        state_count=index.size,
        materials=numbers,
        material_size=numbers.shape[1],
        numbers=np.empty(z_grid.work_size(nodes)),
        node_count=nodes,
        node_versions=np.zeros(nodes // material_series.LANES, np.int64),
        workspace=workspace,
        workspace_size=workspace.size,
        unlike=isinstance(materials, Bodies),
    )


def _lazy_record(
    kernels: Any,
    select: Any,
    row_count: int,
    e0: int = 0,
    kept: Any = None,
    **fields: Any,
) -> Any:
    """Return the record of a law whose rows are made by kernels where they are read.

    kernels: module with the kernel ``make_part`` and the type SOURCE, a record of numbers and
        addresses of arrays that both kernels read.
    select: kernel (index of an element, address of the SOURCE record) that makes the law of that
        element the current one.
    row_count: number of rows of the record (:func:`.row_layout.allocate_rows`), whose numbers and
        marks the kernels write.
    e0: exponent of the end of the first row; 0 where a kernel writes it.
    kept: any objects that own memory whose addresses are among the fields, and that must live as
        long as the record;
        None: there are none.
    fields: the other fields of SOURCE by name, numbers or arrays; of an array the address is
        passed, and the array is kept alive.  ``cover_rows``, of covers alone, is the array for the
        numbers that they have in addition, which the kernels write.
    Returns :class:`.law_record.Law`, without rows of N.  Its arrays are read-only views,
    which the kernels change through their addresses.
    """
    from ..kernels.law.law_record import E0, Law
    from ..kernels.numerics.intrinsics import function_address

    rows, marks = allocate_rows(row_count)
    marks[E0] = e0
    fields |= {"rows": rows, "marks": marks}
    source = np.zeros(1, kernels.SOURCE)
    for name, value in fields.items():
        source[name] = value.ctypes.data if isinstance(value, np.ndarray) else value
    # the marks keep all arrays alive of which the kernels have the addresses
    owner = types.SimpleNamespace(
        __array_interface__=marks.__array_interface__, arrays=(source, fields, kept)
    )
    selector, maker = (
        function_address(kernel, kernels.SOURCE) for kernel in (select, kernels.make_part)
    )
    return Law(
        rows=lock_array(rows.view()),
        marks=lock_array(np.asarray(owner)),
        N_rows=lock_array(np.empty(0)),
        selector=selector,
        maker=maker,
        source=int(source.ctypes.data),
        cover_rows=lock_array(fields["cover_rows"].view()) if "cover_rows" in fields else None,
    )


def count_laws(covers: Cover) -> int:
    """Return the number of laws that :func:`record_of_materials` makes for covers; 1 for a single
    cover.

    Many covers have 14 laws for each octave of thickness in which one lies; 12 times as many if
    ``nu`` is an array.
    covers: :class:`.bodies.Cover`, one cover, or many, whose laws are interpolated between nodes of
        thickness, and of Poisson's ratio where ``nu`` is an array.
    Returns an int, 0 for an array of no covers; laws that the process has made before are counted
    too.
    """
    if not covers.shape:
        return 1
    return (
        np.unique(np.floor(np.log2(covers.thickness))).size
        * _THICKNESS_NODES
        * (_NU_NODES if np.ndim(covers.nu) else 1)
    )


def _record_of_covers(covers: Cover, index: Integers) -> Any:
    """Return the record of the laws of covers that differ in thickness, interpolated within octaves
    of thickness.

    covers: :class:`.bodies.Cover` of n covers, which may differ in Poisson's ratio too.
    index: index of the cover of each element, (elements,), or (1,) for all.
    Returns :class:`.law_record.Law`, which holds the law of one element at a time.
    Raises ParameterError for a cover in an octave of thickness whose thinnest cover, which may be
    thinner than any of ``covers``, is so thin that the half contact at rest is longer than six
    thicknesses.
    """
    from ..kernels.law import thickness_rows
    from ..kernels.law.law_record import E0, ROW_COUNT

    # octaves [2^n, 2^(n + 1)) that contain the thicknesses
    log_thickness = np.log2(covers.thickness)
    octave = np.floor(log_thickness)
    many_nu = np.ndim(covers.nu) > 0
    weights = _node_weights(log_thickness - octave, _THICKNESS_NODES)
    laws = {}
    if many_nu:
        of_nu = _node_weights(np.log(3.0 - 4.0 * covers.nu) / math.log(3.0), _NU_NODES)
        # in the order of the laws of :func:`_laws_of_octave`: all thicknesses of one nu, then of
        # the next
        weights = (of_nu[:, :, None] * weights[:, None]).reshape(len(weights), -1)
    for exponent in np.unique(octave).tolist():
        with _lock:
            try:
                laws[exponent] = _laws_of_octave(
                    covers.of_thickness(2.0**exponent, np.max(covers.nu)), many_nu
                )
            except ParameterError as error:
                thin = float(covers.thickness.min())
                # a cover that is refused alone is refused with that reason
                cover_rows(covers.of_thickness(thin, np.max(covers.nu)))
                reason = (
                    f"at least {2.0 ** (exponent + 1.0)} in a call with several thicknesses or "
                    "loads, as laws are interpolated between them: make one call for each, or take "
                    "a thicker layer or a smaller load (l0: contact length at rest of half-spaces "
                    "of the same materials)"
                )
                raise ParameterError("thickness/l0", f"{thin:.6g}", reason) from error
    # for each cover the address of the laws of its octave and their number of rows
    octaves = [(laws[n][0].ctypes.data, laws[n][1].marks[ROW_COUNT]) for n in octave.tolist()]
    # laws of the thickest octave have the most rows
    _, thickest = laws[octave.max()]
    return _lazy_record(
        thickness_rows,
        thickness_rows.select_cover,
        thickest.marks[ROW_COUNT],
        e0=thickest.marks[E0],
        cover_index=index,
        state_count=index.size,
        cover_rows=align_vector(np.zeros(thickest.cover_rows.size)),
        cover_count=len(weights),
        weights=np.ascontiguousarray(weights),
        law_count=weights.shape[1],
        octaves=np.array(octaves, np.int64),
        kept=laws,
    )


def _node_weights(x: Floats, count: int) -> Floats:
    """Return the weights of values at Chebyshev nodes in the polynomial through them, whose value
    is then a weighted sum.

    x: points, in [0, 1], (points,): the position of a cover in its octave of thickness, or in
        the range of nu.
    count: number of nodes, the Chebyshev points of [0, 1].
    Returns the weights, of either sign, (points, nodes); their sum over the nodes is 1.
    """
    return np.polynomial.chebyshev.chebvander(2.0 * x - 1.0, count - 1) @ to_chebyshev(count)


@functools.lru_cache(maxsize=32)
def _laws_of_octave(thinnest: Cover, many_nu: bool) -> tuple[Floats, Any]:
    """Return the laws at the nodes of an octave of thickness; the last 32 octaves are kept.

    thinnest: :class:`.bodies.Cover` at the lower end of the octave, of which all but the thickness,
        and ``nu`` if ``many_nu``, is that of all laws.
    many_nu: whether laws are made at the 12 nodes of Poisson's ratio in [0, 1/2] too; else at the
        ``nu`` of ``thinnest`` alone.
    Returns two values.  The first is an array (laws, numbers).  Law k n + i belongs to Poisson's
    ratio k and thickness i: n = 14 thicknesses ascend, at the Chebyshev zeros of their logarithm;
    Poisson's ratios fall from near 1/2 to near 0, at the Chebyshev zeros x of nu = 3/4 - 3^((1 +
    x)/2)/4.  Its numbers are ``rows`` and then ``cover_rows`` of the record of that law.  The
    second is the record of the last law, :class:`.law_record.Law`, from which number of
    rows and e0, equal for all, are read.
    Raises ParameterError for a cover at a node that is too thin.
    """
    ratios = [thinnest.nu]
    if many_nu:
        ratios = (0.75 - 0.25 * 3.0 ** (0.5 + 0.5 * to_doubles(chebyshev(_NU_NODES)))).tolist()
    numbers = []
    for nu in ratios:
        for node in to_doubles(chebyshev(_THICKNESS_NODES)).tolist():
            cover = thinnest.of_thickness(thinnest.thickness * 2.0 ** (0.5 + 0.5 * node), nu)
            # the upper end of the octave determines the number of rows, so that all have as many
            record = make_table(cover, cover=cover_rows(cover, 2.0 * thinnest.thickness)).record
            numbers.append(np.concatenate([record.rows, record.cover_rows]))
    return np.array(numbers), record
