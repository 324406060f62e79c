"""Arrays and numbers: their types, checks of those that callers give, and work on them by blocks.

A number or an array that a caller gives becomes float64 in the unit of the argument, or raises
ParameterError: it must be finite and in range, and the shapes of arrays must broadcast.  A number
that has a unit is converted (:mod:`.quantities`).

Blocks follow from the size of the work alone, so that results do not depend on the number of
threads.  The kernels release the GIL, so that plain threads use all cores without a parallel region
of numba: no second compilation, no threading layer that could clash with that of a host program,
safe in forked processes and from several threads.
"""

import contextlib
import math
import os
import threading
from collections import deque
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ParameterError, describe_value
from .quantities import Units, has_no_unit, is_real, to_unit

# --- Types of arrays, and of the numbers that callers may give, for type checkers ---

#: Array of doubles, as results hold them.
Floats = NDArray[np.float64]
#: Array of 64-bit integers, such as indices.
Integers = NDArray[np.int64]
#: Array of truth values.
Booleans = NDArray[np.bool_]
#: Shape of an array.
Shape = tuple[int, ...]
#: Names of axes, quantities or inputs, in their order.
Names = tuple[str, ...]
#: Values by name, as arguments, attributes, or the keys of a file.
Named = dict[str, Any]

if TYPE_CHECKING:

    class SupportsArray(Protocol):
        """Arrays and scalars of numpy, arrays of xarray and pandas."""

        def __array__(self) -> NDArray[np.floating[Any] | np.integer[Any]]: ...

    #: One number, or an array of numpy, xarray or pandas, or nested lists; no text.
    Numbers = (
        float
        | SupportsArray
        | Sequence[float]
        | Sequence[SupportsArray]
        | Sequence[Sequence[float]]
    )
else:
    Numbers = Any


# --- Checks of numbers that callers give ---


def check_array(name: str, value: ArrayLike, **bounds: Any) -> Floats:
    """Check an argument, and return its numbers as a float64 array in the unit of the argument.

    Parameters
    ----------
    name : name of the argument, for errors.
    value : a number, an array or a list, perhaps with a unit.
    **bounds : unit and range, as in :func:`check_array_extent`: ``unit`` of the argument, to which
        a value with a unit is converted (default "1"), and in that unit ``low`` and ``high``,
        smallest and largest allowed value, and ``above``, a number that all values must exceed.
        Without the last three all finite values are allowed.

    Returns
    -------
    array
        float64, of the shape of ``value``, () of a number, in ``unit``; all elements are finite.
        It may be empty, and it may be ``value`` itself.

    Raises
    ------
    ParameterError
        If it is not numeric (None, texts, truth values, complex numbers, masked arrays), not
        finite, beyond a bound, or its unit is of another dimension or what
        :func:`.quantities.to_unit` refuses.
    """
    return check_array_extent(name, value, **bounds)[0]


def check_array_extent(
    name: str,
    value: ArrayLike,
    *,
    unit: Units = "1",
    low: float = -math.inf,
    above: float = -math.inf,
    high: float = math.inf,
) -> tuple[Floats, tuple[float, float]]:
    """Check an argument as :func:`check_array`, and return its smallest and largest element too.

    Parameters
    ----------
    name : name of the argument, for errors.
    value : a number, an array or a list, perhaps with a unit.
    unit : unit of the argument, to which a value with a unit is converted: an SI unit as "m s-1",
        "1" of a dimensionless number, or an object that has units by name, as a
        :class:`.scale.Scale`.
    low : smallest allowed value, in ``unit``; -infinite by default, as ``above``.
    above : number that all values must exceed.
    high : largest allowed value, in ``unit``; infinite by default.

    Returns
    -------
    array : float64, of the shape of ``value``, () of a number, finite, in ``unit``; it may be
    ``value`` itself.
    extent : (smallest, largest element), in ``unit``; (0.0, 0.0) if the array is empty.

    Raises
    ------
    ParameterError
        As :func:`check_array`.  For numbers that are not finite or beyond a bound the message
        states the first wrong element, and of several elements its index and the number of further
        wrong ones.
    """
    # the common case, in a fraction of the time; inf < inf is false, so that infinity is refused
    if type(value) is float and above < value < high and low <= value:
        return np.asarray(value), (value, value)
    array = _as_doubles(name, value, unit, (low, above, high))
    smallest, largest = extent(array) if array.size else (0.0, 0.0)
    # A NaN makes all comparisons false.  An array without errors needs no mask of its size.
    if array.size and not (
        above < smallest and low <= smallest and largest < math.inf and largest <= high
    ):
        wrong = ~(np.isfinite(array) & (array > above) & (array >= low) & (array <= high))
        raise ParameterError(
            name, _first_wrong(array, wrong), _range_words(low, above, high) or "a finite number"
        )
    return array, (smallest, largest)


def _range_words(low: float, above: float, high: float) -> str:
    """Return a range in words that follow "must be", as "finite and > 0".

    low, above, high: bounds, as in :func:`check_array_extent`.
    Returns "" where all finite numbers are allowed.
    """
    if high < math.inf:
        return f"in [{low:g}, {high:g}]" if low > -math.inf else f"in ({above:g}, {high:g}]"
    if low > -math.inf:
        return f"finite and >= {low:g}"
    return f"finite and > {above:g}" if above > -math.inf else ""


def _as_doubles(name: str, value: Any, unit: Units, bounds: tuple[float, float, float]) -> Floats:
    """Return numbers as float64 in the unit of the argument; they may be out of range, infinite or
    NaN still.

    name: name of the argument.
    value: what a caller gave.
    unit: unit of the argument, a text or an object that has units by name; not used for a value
    without a unit.
    bounds: low, above and high of the range, for the words of the error alone.
    Returns a float64 array of the shape of ``value``, which is ``value`` itself if that is such an
    array; floats wider than doubles may become infinite.
    Raises ParameterError for a value that is not numeric (None, texts, truth values, complex
    numbers, ragged lists, integers that no double holds), a masked array, and what
    :func:`.quantities.to_unit` refuses, as a unit of another dimension.
    """
    plain = value
    if not has_no_unit(value):
        plain = to_unit(name, value, unit if isinstance(unit, str) else unit.unit(name))
        if isinstance(plain, np.ma.MaskedArray):
            sentence = (
                f"{name} is a masked array: give {name}.compressed(), which leaves masked numbers "
                f"out, or {name}.filled(0.0), which has 0 in their places"
            )
            raise ParameterError(name, "a masked array", "plain", sentence)
    try:
        array = np.asarray(plain)
        if array.dtype.kind == "O" and all(map(is_real, array.flat)):
            array = array.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.asarray(None)  # of a ragged list, or an integer that no double holds
    if array.dtype.kind not in "iuf":
        words = _range_words(*bounds)
        allowed = f"a number, {words}" if words else "a finite number"
        raise ParameterError(name, describe_value(value), allowed)
    if array.dtype.itemsize <= 8:
        return array.astype(np.float64, copy=False)
    # long doubles beyond the doubles become infinite, which is refused
    with np.errstate(over="ignore"):
        return array.astype(np.float64)


def _first_wrong(array: Floats, wrong: Booleans) -> str:
    """Return the first wrong element of an array, its index, and the number of further ones, in
    words for an error.

    array: numbers, of any shape, at least one.
    wrong: mask of the same shape, true for at least one element.
    Returns a text as "nan at row 3, and 2 more", of several axes as "nan at (0, 3)", all indices
    from 0; if the array has a single element, that number alone.
    """
    if array.size == 1:
        return str(array.item())
    first = tuple(map(int, np.argwhere(wrong)[0]))
    found = f"{array[first]} at index {first[0] if array.ndim == 1 else first}"
    more = np.count_nonzero(wrong) - 1
    return f"{found}, and {more} more" if more else found


def extent(array: Floats) -> tuple[float, float]:
    """Return the smallest and the largest element, floats; both are NaN if the array has a NaN.

    array: float64, of any shape; an empty one raises ValueError.
    """
    if array.ndim == 0:
        return float(array), float(array)
    return float(array.min()), float(array.max())


def check_number(name: str, value: ArrayLike, **bounds: Any) -> float:
    """Check an argument that is a single number, and return it as a float in the unit of the
    argument.

    Parameters
    ----------
    name : name of the argument, for errors.
    value : a number, perhaps with a unit.
    **bounds : ``unit``, ``low``, ``above`` and ``high`` as in :func:`check_array_extent`.

    Returns
    -------
    float
        The finite number, in the unit of the argument.

    Raises
    ------
    ParameterError
        If it is not one finite number (an array with axes is refused, even of one element), if it
        is outside these limits, or if its unit has another dimension.
    """
    array, (number, _) = check_array_extent(name, value, **bounds)
    if array.ndim:
        raise ParameterError(name, describe_value(value), "a single number")
    return number


def broadcast_shape(**arrays: Any) -> Shape:
    """Return the common shape of arrays, by numpy's rule of broadcasting.

    arrays: arrays of numpy and numbers by the name that an error states; what has no axes fits
        every shape.
    Returns the shape, a tuple of ints; () if no array has axes, or none is given.
    Raises ParameterError if they do not broadcast; the message lists the shapes.
    """
    # a set of the different shapes: mostly one, which needs no call of numpy
    shapes = {getattr(array, "shape", ()) for array in arrays.values()} - {()}
    try:
        return np.broadcast_shapes(*shapes) if len(shapes) > 1 else shapes.pop() if shapes else ()
    except ValueError:
        each = {name: getattr(array, "shape", ()) for name, array in arrays.items()}
        found = ", ".join(f"{name} {shape}" for name, shape in each.items() if shape)
        allowed = "equal, or broadcast as in numpy, for example (3, 1) with (4,)"
        raise ParameterError(
            "shapes", found, allowed, f"shapes {found} do not fit together: must be {allowed}"
        ) from None


def divide_by_unit(name: str, values: NDArray, unit: Any) -> Any:
    """Return a quantity divided by its unit, with an error that names both where numpy's division
    would not.

    name: name of the quantity, for errors.
    values: the quantity in SI units, an array.
    unit: SI value of one dimensionless unit, a number, or (n,) of n cylinders; not checked, 0
    divides as in numpy.
    Returns the quotient, of the common shape by numpy's rule; a number of numpy if that is ().
    Raises ParameterError if the shapes do not broadcast; the message lists both.
    """
    try:
        return values / unit
    except ValueError:
        # raises the error that names both
        broadcast_shape(**{name: values, "cylinders": unit})
        raise


def read_only(array: Floats) -> float | Floats:
    """Return a float of an ``array`` without axes, else a read-only copy of it."""
    if array.ndim == 0:
        return float(array)
    array = array.copy()
    array.flags.writeable = False
    return array


def check_integer(name: str, value: Any, low: int, high: float = math.inf) -> int:
    """Check an argument that is a whole number, and return it as an int.

    Parameters
    ----------
    name : name of the argument, for errors.
    value : what a caller gave; an int or an integer of numpy is accepted, a truth value, a float or
        a duration is not.
    low, high : smallest and largest allowed value, whole numbers; ``high`` is infinite by default,
        no limit.

    Returns
    -------
    int
        The number, as an int of Python.

    Raises
    ------
    ParameterError
        If it is not a whole number, or out of range.
    """
    # a bool is an int of Python, and a duration an integer of numpy
    if isinstance(value, bool | np.timedelta64) or not (
        isinstance(value, int | np.integer) and low <= value <= high
    ):
        allowed = (
            f"a whole number >= {low}" if high == math.inf else f"a whole number in [{low}, {high}]"
        )
        # 1e6 is whole, but no int
        found = describe_value(value) + " (a float)" * isinstance(value, float)
        raise ParameterError(name, found, allowed)
    return int(value)


def check_text(name: str, value: Any) -> None:
    """Check an argument that must be a text which files can hold.

    name: name of the argument, for the error.
    value: what a caller gave.
    Raises ParameterError for what is no text, and for one with NUL or surrogates.
    """
    # UTF-8 has no code for surrogates, so that they are missing after the encoding
    if not (
        isinstance(value, str) and value == value.replace("\0", "").encode(errors="ignore").decode()
    ):
        raise ParameterError(name, describe_value(value), "a text in UTF-8 without null characters")


def check_choice(name: str, value: Any, *allowed: str) -> None:
    """Raise ParameterError if the argument ``name`` has a ``value`` that is none of the ``allowed``
    texts.
    """
    if not (isinstance(value, str) and value in allowed):
        *others, last = map(repr, allowed)
        raise ParameterError(name, describe_value(value), f"{', '.join(others)} or {last}")


def check_bool(name: str, value: Any) -> bool:
    """Check an argument that is a truth value of Python or numpy, and return it as a bool.

    Parameters
    ----------
    name : name of the argument, for the error.
    value : what a caller gave.

    Returns
    -------
    bool
        The truth value, as a bool of Python.

    Raises
    ------
    ParameterError
        For anything else: the truth of a text or a number is seldom what the caller means.
    """
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise ParameterError(name, describe_value(value), "True or False")


# --- Work on arrays by blocks ---


def block_reader(array: Floats, shape: Shape) -> Callable[[int, int], Floats]:
    """Return a function that reads blocks of a broadcast array, so that the whole of it is never in
    memory.

    array: numbers that broadcast to ``shape``.
    shape: shape to which all arrays of the work broadcast.
    Returns a function (start, stop) -> the elements ``start`` to ``stop`` - 1 of the broadcast and
    flattened array, in C order, a vector (stop - start,), for 0 <= start < stop <= its size.  If
    ``array`` has a single element the vector is always (1,), that element.  Vectors are views if
    ``array`` is contiguous and of that shape, else copies.  All are contiguous and read-only,
    because numba compiles a kernel again for each kind of array.
    Raises ValueError where ``array`` has more than one element and does not broadcast to ``shape``.
    """
    # a single element stays one, which kernels read for every state
    if array.size == 1 or (array.shape == shape and array.flags.c_contiguous):
        vector = broadcast_vector(array, array.shape)
        if array.size == 1:
            return lambda start, stop: vector
        return lambda start, stop: vector[start:stop]
    whole = np.broadcast_to(array, shape)

    def read_block(start: int, stop: int) -> Floats:
        """Return a read-only copy of elements of the flattened array, a contiguous vector (stop -
        start,).

        start, stop: index of the first element, and of the one after the last, 0 <= start < stop <=
        its size.
        """
        # chunks of one axis, copied to a buffer where memory is not in order, within a range that
        # is set below
        iterator: Any = np.nditer  # the stubs of numpy lack the flag "contig"
        flags = ["external_loop", "buffered", "ranged"]
        chunks = iterator(
            whole, flags, [["readonly", "contig"]], order="C", buffersize=stop - start
        )
        chunks.iterrange = start, stop
        # The iterator overwrites each chunk by the next one.
        vector = np.concatenate([chunk.copy() for chunk in chunks])
        vector.flags.writeable = False
        return vector

    return read_block


def broadcast_rows(arrays: Collection[Any], shape: Shape) -> Floats:
    """Return arrays and numbers as the rows of one array, each broadcast to a shape and flattened.

    arrays: doubles, each a number or an array that broadcasts to ``shape``.
    shape: shape of the states; () of a single state.
    Returns a new array (rows, states), in the order of ``arrays``.
    """
    rows = np.empty((len(arrays), *(shape or (1,))))
    for row, array in zip(rows, arrays):
        row[...] = array
    return rows.reshape(len(arrays), -1)


def broadcast_vector(array: NDArray, shape: Shape) -> NDArray:
    """Return an array, broadcast to a shape and flattened, as a contiguous read-only vector.

    array: numbers that broadcast to ``shape``.
    shape: shape of the result before it is flattened.
    Returns a vector with as many elements as ``shape`` has, in C order, a view where possible, else
    a copy; if ``array`` has a single element it is (1,), for any shape.
    Raises ValueError where ``array`` has more than one element and does not broadcast.
    """
    whole = array if array.size == 1 else np.ascontiguousarray(np.broadcast_to(array, shape))
    # a view of its own, so that the caller's array stays writable
    vector = whole.reshape(-1).view()
    vector.flags.writeable = False
    return vector


def thread_count(threads: int | None = None) -> int:
    """Return the number of threads: ``threads``, else ``$VISCOROLL_THREADS``, else that of the
    available cores.

    threads: a whole number >= 1; None: the environment variable, if it is set and not empty, else
        all cores that this process may use.
    Returns an int >= 1.

    Raises
    ------
    ParameterError
        If the one that is used, ``threads`` or the variable, is not a whole number >= 1.
    """
    return (
        check_integer("threads", threads, 1)
        if threads is not None
        else _environment_threads() or available_cores()
    )


def _environment_threads() -> int | None:
    """Return ``$VISCOROLL_THREADS`` as an int >= 1; None where it is not set, or empty.

    :func:`run_blocks` also calls it for work of a single block, to check the variable alone.
    Raises ParameterError for any other text, as "0".
    """
    if not (given := os.environ.get("VISCOROLL_THREADS")):
        return None
    with contextlib.suppress(ValueError):
        if (count := int(given)) >= 1:
            return count
    raise ParameterError(
        "VISCOROLL_THREADS",
        repr(given),
        "a whole number >= 1, or this environment variable must not be set",
    )


def available_cores() -> int:
    """Return the number of cores that this process may use, or of the machine where the system does
    not tell; >= 1.
    """
    if hasattr(os, "process_cpu_count"):  # Python 3.13
        return os.process_cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


_cancellation = threading.local()


def cancel_with(event: threading.Event) -> None:
    """Let :func:`run_blocks` of this thread raise CancelledError before its next block once
    ``event`` is set.

    It has no effect on calls with several workers or a progress bar.
    """
    _cancellation.event = event


def run_blocks(
    work: Callable[[int, int], None],
    count: int,
    block: int,
    *,
    threads: int | None = None,
    progress: str | None = None,
) -> None:
    """Call a function for consecutive blocks of ``range(count)``, on several threads, and return
    when all are done.

    Parameters
    ----------
    work : function (start, stop) -> None, which computes the elements ``start`` to ``stop`` - 1 of
        a block and writes them where they belong.  Several threads call it at the same time.  Its
        exceptions are raised here, of several that of the first block; then some of the blocks
        after it have not been computed.
    count : number of elements, >= 0; ``work`` is not called for 0.
    block : number of elements of a block, >= 1, not checked; the last block may have fewer.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, else that of the available cores.  No
        more are used than there are blocks; one worker without a progress bar is the calling thread
        itself.
    progress : title of a progress bar on standard error, which appears after one second; None: no
        bar.

    Raises
    ------
    CancelledError
        If the event of :func:`cancel_with` is set and the blocks run one after another on this
        thread.
    ParameterError
        If ``threads`` is not a whole number >= 1; without it, and for two elements and more, if
        ``$VISCOROLL_THREADS`` is not.
    """
    edges = ((start, min(start + block, count)) for start in range(0, count, block))
    workers = blocks = -(-count // block)  # rounded up
    if blocks > 1 or threads is not None:
        workers = min(thread_count(threads), blocks)
    elif count > 1:
        _environment_threads()  # a wrong value is an error of small work too
    if workers <= 1 and progress is None:
        event = getattr(_cancellation, "event", None)
        for start, stop in edges:
            if event is not None and event.is_set():
                raise CancelledError
            work(start, stop)
        return
    if progress is not None:
        from tqdm import tqdm

        edges = tqdm(edges, desc=progress, total=blocks, delay=1.0, leave=False)
    waiting: deque[Future[None]] = deque()
    # with a bar and no blocks the pool still needs one worker
    with ThreadPoolExecutor(max(workers, 1)) as pool:
        try:
            for edge in edges:
                waiting.append(pool.submit(work, *edge))
                # a future takes a kilobyte, so that not all are submitted
                if len(waiting) > 8 * workers:
                    waiting.popleft().result()
            while waiting:
                waiting.popleft().result()
        finally:
            # after an exception blocks that have not begun are cancelled
            for future in waiting:
                future.cancel()
