"""A drive as checked functions of time without dimension, and its layout for the kernels:
:class:`DriveFunctions`.

T_ref is the unit of time: T_epsilon of a material that is an alpha, the ``T_ref`` of any other
material.
"""

import dataclasses
from functools import cached_property
from typing import Any

import numpy as np

from ..core import (
    Feedback,
    Floats,
    ParameterError,
    broadcast_shape,
    check_array,
    described_error,
    exactly_one_error,
    slope_tan_cos,
)
from ..kernels.records import (
    COL_COEFFICIENTS,
    COL_SCALE,
    COL_START,
    NOT_PRESCRIBED,
    PRESCRIBED_OMEGA,
    PRESCRIBED_V,
)
from .drive_pieces import Piecewise, ends_of, piecewise
from .motion_arguments import Drive, dimensionless_error, start_speeds

#: Bytes of pieces that are packed at a time where motions have functions of their own: little
#: beside the schedules, and yet many motions at once where these are short.
_BLOCK_BYTES = 1 << 18
#: Largest difference between a given and the prescribed start, divided by the largest prescribed
#: speed.
_START = 1e-9
#: (argument, prescribed speed beside which it must not be given, reason).
_BESIDE = (
    ("torque", "omega", "the torque follows from the prescribed omega"),
    ("force", "V", "the force follows from the prescribed V"),
    ("brake", "omega", "omega is prescribed"),
    ("drag", "omega", "omega is prescribed"),
)
#: The function of time that is 0.
_NOTHING = Piecewise(np.zeros((1, 1)), np.zeros((1, 1, 1)))
#: A load of 0 that follows no speed.
_NO_GAINS = Feedback(0.0)
#: Code in the kernels of the prescribed speed, by its name; "" for none.
_PRESCRIBED_CODES = {"": NOT_PRESCRIBED, "omega": PRESCRIBED_OMEGA, "V": PRESCRIBED_V}

#: (pieces (1 or m, k, columns); gains (4, 1 or m); code of the prescribed speed), as the kernels
#: take a drive.
KernelDrive = tuple[Floats, Floats, int]
#: First value of a piece divided by the size of its terms, dimensionless, that counts as rounding:
#: some 50 roundings.
_ROUNDING = 1e-14
#: The same of the slope of a piece, which the differentiation makes larger.
_ROUNDING_OF_SLOPE = 1e-12
#: Jump of a prescribed speed divided by its largest size, dimensionless, that counts as rounding.
_ROUNDING_OF_JUMP = 1e-12
#: Duration of a piece, in T_ref, that counts as none: 2 divided by it and by gamma is to be finite.
_INSTANT = 1e-280


@dataclasses.dataclass(frozen=True, eq=False)
class DriveFunctions:
    """The functions of time that drive motions, dimensionless, each the same for all motions or one
    for each.

    Attributes
    ----------
    functions : name -> :class:`.drive_pieces.Piecewise` of what is given of "force", "torque",
        "brake" and the prescribed speed, "omega" or "V"; of "slope" its tangent, > 0 downhill along
        +V, which adds to the force.
    prescribed : name of the prescribed speed, "omega", "V" or "".
    gains : gains of force on V, force on omega, torque on V, torque on omega, (4, 1 or m); the last
        less the drag.
    end : last time, in T_ref.
    """

    functions: dict[str, Piecewise]
    prescribed: str
    gains: Floats
    end: float

    @cached_property
    def counts(self) -> tuple[int, int]:
        """(Number of motions with functions of their own, with gains of their own); 1 if all are
        alike.

        By the first :meth:`block` and :meth:`for_kernel` decide whether all motions share their
        pieces.
        Raises ParameterError if two of the functions have values for different numbers of motions,
        both other than 1.  Whether the two numbers agree is not checked here.
        """
        shape = broadcast_shape(
            **{name: f.terms[:, 0, 0] for name, f in self.functions.items() if len(f.terms) != 1}
        )
        return shape[0] if shape else 1, self.gains.shape[1]

    @cached_property
    def corners(self) -> int:
        """Number of corners of a motion's schedules, and of pieces of its callables; 0 for numbers
        alone.
        """
        return sum(f.corners for f in self.functions.values())

    @cached_property
    def error(self) -> float:
        """Largest difference seen between a callable and its fit, dimensionless; 0.0 without
        callables.
        """
        return max((f.error for f in self.functions.values()), default=0.0)

    def block(self, most: int) -> int:
        """Return how many motions to pack at a time, so that their pieces take some
        :data:`_BLOCK_BYTES`.

        most: largest number to return, >= 1; it is returned where all motions have the same
        functions.
        Returns an int in 1 ... ``most``.
        Raises ParameterError as :attr:`counts` does.
        """
        if self.counts[0] == 1:
            return most
        # start and scale, then the terms of five functions (:attr:`pieces`), 8 bytes each
        terms = max((f.terms.shape[-1] for f in self.functions.values()), default=1)
        columns = 2 + 5 * terms
        return min(max(_BLOCK_BYTES // (8 * columns * (self.corners + 1)), 1), most)

    def blocks(self, count: int) -> list[slice]:
        """Return slices that divide ``count`` motions into blocks, ascending, a list."""
        step = self.block(count or 1)
        return [slice(first, first + step) for first in range(0, count, step)]

    @cached_property
    def pieces(self) -> Floats:
        """Return all functions over common pieces of time, dimensionless, in the layout of the
        kernels.

        Columns of the result, (1 or m, k, columns): start of the piece in T_ref; 2 divided by its
        length, 0 where it has no length or no end; then as many coefficients of powers of x in [-1,
        1] for each of force (with the pull of the slope), torque, derivative of the prescribed
        speed, brake, prescribed speed.  The coefficients of what is not given are 0.  Here m is the
        number of motions that have functions or times of their own.
        Raises ParameterError where a prescribed speed jumps.
        """
        name = self.prescribed
        force, slope, torque, brake, speed = (
            self.functions.get(f, _NOTHING) for f in ("force", "slope", "torque", "brake", name)
        )
        # the pull of the slope, over the load P cos(slope), adds to the constant term of the force
        terms = force.terms + np.zeros_like(slope.terms)
        terms[..., :1] += slope.terms
        # without a prescribed speed its name is "", and both are the function that is 0
        rate = differentiate(name, speed) if name else speed
        return pack_pieces((force._replace(terms=terms), torque, rate, brake, speed), self.end)

    def for_kernel(self, index: Any = slice(None)) -> KernelDrive:
        """Return the drive of some motions as the kernels take it, :data:`KernelDrive`.

        index: index of numpy, a slice or a vector of integers, that selects the motions; default:
        all.
        Returns (pieces, (1 or m, k, columns), see :attr:`pieces`, where m is the number of selected
        motions, and 1 if all have the same functions, which are returned for any ``index``; gains,
        (4, 1 or m); code of the prescribed speed, an int: NOT_PRESCRIBED, PRESCRIBED_OMEGA or
        PRESCRIBED_V).
        Raises ParameterError where a prescribed speed jumps.
        """
        some = self
        if self.counts[0] > 1:
            some = dataclasses.replace(
                self, functions={name: f.take(index) for name, f in self.functions.items()}
            )
        gains = self.gains[:, index] if self.gains.shape[1] > 1 else self.gains
        return some.pieces, np.ascontiguousarray(gains), _PRESCRIBED_CODES[self.prescribed]

    @property
    def acts_at_end(self) -> bool:
        """Whether a load, a prescribed speed or a gain still acts on any motion at the end: in the
        last piece of time.

        A prescribed speed counts even where it is 0, and a brake and a drag other than 0 do too.
        """
        if self.prescribed or self.gains.any():
            return True
        # the coefficients of the last piece, without its start and scale
        return any(
            self.for_kernel(part)[0][:, -1, 2:].any() for part in self.blocks(self.counts[0])
        )


#: Drive of free motions: nothing acts.
UNDRIVEN = DriveFunctions({}, prescribed="", gains=np.zeros((4, 1)), end=0.0)


def prepare_drive(
    drive: Drive, V0: Any, omega0: Any, end: float, rtol: float, resolve: float | None
) -> tuple[DriveFunctions, Any, Any]:
    """Check a drive and the start speeds, and fit its callables.

    drive: :class:`Drive`, dimensionless.
    V0, omega0: start speeds, dimensionless, numbers or (n,); None where they are prescribed.
    end: last time, >= 0, in T_ref.
    rtol: relative tolerance of the motion.
    resolve: largest spacing of the samples of a callable, in T_ref; None: a thousandth of ``end``.
    Raises ParameterError for a load or speed that :func:`viscoroll.roll` refuses; for V and omega
    both prescribed, or a load beside the prescribed speed from which it follows; for a start that
    is missing, out of range, or not the prescribed one; for shapes of V0 and omega0 that do not
    broadcast.  Exceptions of a callable pass.
    Returns (functions of time that drive the motions; V0; omega0), dimensionless, speeds as numbers
    or (n,); a prescribed one has its value at t = 0.  The functions are :data:`UNDRIVEN` where the
    drive is empty, in which case ``end``, ``rtol`` and ``resolve`` are ignored.
    """
    if not drive.acts:
        return UNDRIVEN, *start_speeds(V0, omega0)
    tangent = slope_tan_cos(drive.slope)[0]
    if drive.V is not None and drive.omega is not None:
        raise exactly_one_error("V", "omega", both=True)
    for name, speed, why in _BESIDE:
        if getattr(drive, speed) is not None and (value := getattr(drive, name)) is not None:
            raise ParameterError(
                name,
                value,
                "left out",
                f"{name} is given together with {speed}=: leave {name} out, as {why}",
            )
    prescribed = "omega" if drive.omega is not None else "V" if drive.V is not None else ""
    functions = {
        name: piecewise(
            name, given, end, rtol, low=0.0 if name == "brake" else -np.inf, resolve=resolve
        )
        for name, given in (drive.values | {"slope": tangent}).items()
        if name != "drag"
    }
    checked_drive = DriveFunctions(functions, prescribed, _gains(drive), end)
    starts = {"V": V0, "omega": omega0}
    if prescribed:
        starts[prescribed] = _prescribed_start(
            prescribed, starts[prescribed], checked_drive, drive.values[prescribed]
        )
    for name, start in starts.items():
        if start is None:
            raise ParameterError(
                f"{name}0", None, "a number", f"{name}0 is missing: give it, or prescribe {name}="
            )
    return checked_drive, *start_speeds(*starts.values())


def _prescribed_start(name: str, stated: Any, functions: DriveFunctions, speed: Any) -> Any:
    """Return the start of a prescribed speed, its value at t = 0, dimensionless.

    name: "V" or "omega".
    stated: the start that the caller gave, a number or (n,), dimensionless; None without.
    functions: :class:`DriveFunctions` of the drive, with the prescribed speed.
    speed: the prescribed speed as in the drive: a number, an array, a Schedule or a callable.
    Raises ParameterError where ``stated`` differs from it by more than 1e-9 of its largest
    magnitude, is not numeric or not finite, where the speed jumps or is an empty array, and where
    both have values for different numbers of motions.
    Returns (m,) where the speed has values for m > 1 motions.  Where it is the same for all
    motions: a float if ``stated`` is a number or None, else an array in the shape of ``stated``.
    Of a callable it is the value of the callable itself, not of its fit.
    """
    curve = functions.functions[name]
    if not curve.terms.size:
        raise described_error(
            name,
            "is empty",
            "a number, an array with one number for each motion, a Schedule or a function of t",
        )
    # upper bounds of the magnitude over all times, (1,) or (m,)
    sizes = []
    for part in functions.blocks(len(curve.terms)):
        some = curve.take(part)
        differentiate(name, some)
        sizes.append(np.abs(some.terms).sum(axis=-1).max(axis=1, initial=0.0))
    start = values_at_start(curve.terms[:, 0])
    if callable(speed):  # its fit has rounding errors, and may be of the other sign
        start = np.array([float(speed(0.0))])
    if stated is not None:
        given = check_array(f"{name}0", stated)
        broadcast_shape(**{f"{name}0": given, name: start})
        differ = np.abs(given - start) > _START * np.concatenate(sizes)
        if differ.any():
            text = (
                f"{name}0 = {{}}: must be left out (in Python None), or {{}}, the prescribed "
                f"{name} at t = 0"
            )
            n = int(differ.argmax())
            numbers = np.stack(np.broadcast_arrays(given, start))[:, differ][:, 0]
            raise dimensionless_error(f"{name}0", text, name, *numbers, motion=n)
    if start.size > 1:
        return start
    return float(start[0]) if np.ndim(stated) == 0 else np.full(np.shape(stated), start[0])


def _gains(drive: Drive) -> Floats:
    """Return the gains of a drive: of force on V and omega, of torque on V and omega.

    The drag, a torque against omega, is subtracted from the last.

    drive: :class:`Drive`, dimensionless.
    Raises ParameterError for a drag below 0, not numeric or not finite, and for gains whose numbers
    of motions differ.
    Returns (4, 1) where the gains are the same for all motions, else (4, m), dimensionless; 0 where
    nothing is given.
    """
    force, torque = (
        load if isinstance(load, Feedback) else _NO_GAINS for load in (drive.force, drive.torque)
    )
    gains = {
        "gain of force on V": force.V,
        "gain of force on omega": force.omega,
        "gain of torque on V": torque.V,
        "gain of torque on omega": torque.omega,
        "drag": check_array("drag", 0.0 if drive.drag is None else drive.drag, low=0.0),
    }
    broadcast_shape(**gains)
    *rows, drag = np.broadcast_arrays(*gains.values())
    rows[-1] = rows[-1] - drag
    return np.reshape(rows, (4, -1))


# --- Layout of the kernels ---


def differentiate(name: str, speed: Piecewise) -> Piecewise:
    """Return the derivative with respect to time of a prescribed speed.

    name: name of the argument, for the refusal.
    speed: :class:`Piecewise`, prescribed speed, dimensionless, time in T_ref.
    Raises ParameterError where the speed jumps by more than rounding (1e-12 of its largest
    coefficient) and four times the error of its fit.
    Returns :class:`Piecewise` with the same starts, dimensionless.  It has one term less; of a
    speed of one term, which is constant, it has one term that is 0.  It is 0 in pieces without
    length or end, and its value at the left end of a piece is shifted to 0 where it is rounding.
    Its ``error`` is still that of the speed.
    """
    lengths = ends_of(speed.starts) - speed.starts
    first = values_at_start(speed.terms)
    last = speed.terms.sum(axis=-1)
    # for each motion by itself: a slow one must not jump either
    scale = np.abs(speed.terms).max(axis=(1, 2), initial=1e-300)[:, None]
    least = _ROUNDING_OF_JUMP * scale + 4.0 * speed.error
    jumps = (lengths == 0.0) & (np.abs(last - first) > least)  # in pieces without length
    jumps[:, 1:] |= np.abs(last[:, :-1] - first[:, 1:]) > least
    if jumps.any():
        n = int(jumps.any(axis=1).argmax())
        when = np.broadcast_to(speed.starts, jumps.shape)[jumps][0]
        raise dimensionless_error(
            name,
            f"{name} jumps at t = {{}}: must be continuous, as it is a prescribed speed",
            "t",
            when,
            motion=n,
        )
    terms: Any = np.ascontiguousarray(np.polynomial.polynomial.polyder(speed.terms, axis=-1))
    terms *= _dx_dt(lengths)[..., None]
    return speed._replace(terms=_start_at_zero(terms, _ROUNDING_OF_SLOPE))


def _dx_dt(lengths: Floats) -> Floats:
    """Return 2 divided by the lengths of pieces, the rate at which x runs from -1 to 1; 0 for those
    that count as without length.
    """
    return np.divide(2.0, lengths, out=np.zeros_like(lengths), where=lengths > _INSTANT)


def values_at_start(terms: Floats) -> Floats:
    """Return the values at x = -1 of polynomials, (...).

    terms: coefficients of powers of x in [-1, 1], ascending, (..., terms).
    """
    return (terms * (-1.0) ** np.arange(terms.shape[-1])).sum(axis=-1)


def _start_at_zero(terms: Floats, rounding: float = _ROUNDING) -> Floats:
    """Set the value at the left end of pieces to 0 where it is rounding, as it would move a
    cylinder at rest.

    terms: coefficients of powers of x in [-1, 1], ascending, (..., terms); changed in place: a
    value that counts as rounding is subtracted from the constant coefficient.
    rounding: ratio of that value to the sum of the magnitudes of the coefficients below which it
    counts as rounding.
    Returns ``terms``.
    """
    first = values_at_start(terms)
    size = np.abs(terms).sum(axis=-1)
    terms[..., 0] -= np.where(np.abs(first) < rounding * size, first, 0.0)
    return terms


def pack_pieces(functions: tuple[Piecewise, ...], end: float) -> Floats:
    """Return several functions over common pieces, in the layout of the kernels.

    functions: piecewise polynomials, each for the same m motions, or the same for all.
    end: last time, in T_ref.  Pieces that for every motion start at or after it are left out; the
    first piece always stays.
    Returns (1 or m, k, 2 + number of functions * terms): start of each piece in T_ref; 2 divided by
    its length, 0 of one without length or end; then the coefficients of each function in turn,
    padded with 0 to the largest number of terms.  Where motions have times of their own, pieces
    between equal times have no length; the kernels skip them.  Pieces of a motion that start at or
    beyond ``end``, but are kept since other motions have them before it, repeat the coefficients of
    its last piece before ``end``.
    """
    rows = max(len(f.starts) for f in functions)
    starts = np.hstack([np.broadcast_to(f.starts, (rows, f.starts.shape[1])) for f in functions])
    starts.sort(axis=1)
    # of equal starts, as 0 of all functions, the last is kept
    starts = starts[:, (ends_of(starts) > starts + _INSTANT).any(axis=0)]
    kept = max((starts < end).any(axis=0).sum(), 1)
    ends = ends_of(starts)[:, :kept]
    starts = starts[:, :kept]
    count = max(len(f.terms) for f in functions)
    terms = max(f.terms.shape[-1] for f in functions)
    packed = np.zeros((count, kept, COL_COEFFICIENTS + len(functions) * terms))
    packed[..., COL_START] = starts
    packed[..., COL_SCALE] = _dx_dt(ends - starts)
    coefficients = packed[..., COL_COEFFICIENTS:]
    for n, function in enumerate(functions):
        part = _restrict(function, starts, ends)
        coefficients[..., n * terms :][..., : part.shape[-1]] = part
    # index of the last piece of each motion that starts before the end
    at_end = np.maximum((starts < end).sum(axis=1, keepdims=True) - 1, 0)
    late = starts > np.take_along_axis(starts, at_end, axis=1)
    # the last piece before the end acts after it too
    acting = np.take_along_axis(coefficients, at_end[..., None], axis=1)
    np.copyto(coefficients, acting, where=late[..., None])
    return packed


def _restrict(function: Piecewise, starts: Floats, ends: Floats) -> Floats:
    """Return the coefficients of a function over finer pieces, by Horner's scheme with x -> shift +
    scale x in those that are parts of its own.

    function: :class:`Piecewise` of one motion or of m motions.
    starts, ends: when the finer pieces start and end, (1 or m, k), in T_ref; none extends over a
    start of the function's own.  The last may end at infinity.
    Returns coefficients of powers of x in [-1, 1] on the finer pieces, (1 or m, k, terms); their
    value at the left end of a piece is shifted to 0 where it is rounding.
    """
    begins = function.starts
    # Complex numbers are sorted by their real parts first: one search through the pieces of all
    # motions in a row.
    row = np.arange(len(begins))[:, None]
    found = np.searchsorted((row + 1j * begins).ravel(), row + 1j * starts, side="right")
    # the last piece that starts by then
    piece = found - row * begins.shape[1] - 1
    first, last = (np.take_along_axis(t, piece, 1) for t in (begins, ends_of(begins)))
    terms = np.take_along_axis(function.terms, piece[..., None], 1)
    # a piece that is not cut keeps its terms to the bit; the one without end is constant
    cut = np.isfinite(last) & ((first != starts) | (last != ends))
    if not cut.any():
        return _start_at_zero(terms)
    cut = np.broadcast_to(cut, terms.shape[:2])
    first, last, starts, ends = (
        np.broadcast_to(times, cut.shape)[cut] for times in (first, last, starts, ends)
    )
    scale = (ends - starts) / (last - first)
    # the middle of the part in the x of the whole piece
    shift = (starts - first) / (last - first) * 2.0 - 1.0 + scale
    whole = terms[cut]
    part = np.zeros_like(whole)
    for n in reversed(range(whole.shape[-1])):
        raised = np.zeros_like(part)
        raised[..., 1:] = part[..., :-1] * scale[..., None]
        part = part * shift[..., None] + raised
        part[..., 0] += whole[..., n]
    terms[cut] = part
    return _start_at_zero(terms)
