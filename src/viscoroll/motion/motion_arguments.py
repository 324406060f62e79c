"""Arguments that one motion and an ensemble share: their checks; what drives motions, as the caller
gives it (:class:`Drive`); and the names of the loads and speeds of a result.
"""

import functools
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    DIMENSIONLESS,
    UNITLESS_TYPES,
    ArrayLike,
    Feedback,
    Floats,
    HasUnits,
    Labels,
    ParameterError,
    Scale,
    Schedule,
    Units,
    broadcast_shape,
    check_array,
    digits_beside,
    extent,
    shape_error,
    strip_labels,
)

# --- Checks of arguments that one motion and an ensemble share ---

#: Smallest and largest start speed, dimensionless: beyond them intermediate results leave the range
#: of doubles.
SPEED_RANGE = (1e-300, 1e100)


def output_times(t: ArrayLike, units: Units = "1") -> Floats:
    """Check output times.

    t: one time or a vector (n,), in ``units``; numbers that carry a unit are converted.
    units: unit of time as "s", or the units of a roller (a :class:`Scale`), of which that of time
    is taken; "1": dimensionless.
    Returns a new vector (n,), float64, in ``units``; of one time (1,).
    Raises ParameterError unless they are numeric, without a unit of another dimension, finite, >=
    0, ascending (equal times are allowed), at least one, and of one axis at most.
    """
    times = np.array(check_array("t", t, unit=units, low=0.0), ndmin=1)  # contiguous
    if times.ndim != 1 or times.size == 0:
        raise shape_error("t", times.shape, "one end time, or a vector of at least one output time")
    falls = times[1:] < times[:-1]
    if falls.any():
        n = falls.argmax()
        pair = times[n : n + 2]
        found = f"{digits_beside(*pair)}, {digits_beside(*pair[::-1])} at index {n}, {n + 1}"
        raise ParameterError("t", found, "in ascending order")
    return times


def start_speeds(V0: ArrayLike, omega0: ArrayLike) -> tuple[Any, Any]:
    """Return start speeds, checked; they are not broadcast.

    V0, omega0: start speeds, dimensionless, numbers or arrays (n,).
    Returns (V0, omega0): as they are where both are of type float and not both 0; else both as
    float64 arrays in their own shapes, () for a number.
    Raises ParameterError unless both are numeric, finite and at most 1e100 in magnitude, the larger
    of |V0| and |omega0| of each motion is 0 or at least 1e-300, and the shapes broadcast.
    """
    low, high = SPEED_RANGE
    if type(V0) is type(omega0) is float and -high <= V0 <= high and -high <= omega0 <= high:
        if abs(V0) >= low or abs(omega0) >= low:
            return V0, omega0
    V = check_array("V0", V0)
    omega = check_array("omega0", omega0)
    broadcast_shape(V0=V, omega0=omega)
    for name, array in (("V0", V), ("omega0", omega)):
        if array.size and max(map(abs, extent(array))) > high:
            n = int(np.abs(array).argmax())
            raise dimensionless_error(
                name,
                f"{name} = {{}}: must be at most {{}} in magnitude",
                name,
                array.flat[n],
                high,
                motion=n,
            )
    # in parts whose size does not depend on that of the arrays
    for V_part, omega_part in np.nditer(
        (V, omega), ["external_loop", "buffered", "zerosize_ok"], buffersize=1 << 16
    ):
        larger = np.maximum(np.abs(V_part), np.abs(omega_part))
        if ((larger > 0.0) & (larger < low)).any():
            larger = np.maximum(np.abs(V), np.abs(omega))
            n = int(np.where(larger > 0.0, larger, np.inf).argmin())
            raise dimensionless_error(
                "V0, omega0",
                "max(|V0|, R |omega0|) = {}: must be 0, or at least {}",
                "V0",
                larger.flat[n],
                low,
                motion=n,
            )
    return V, omega


def dimensionless_error(
    name: str,
    text: str,
    quantity: str,
    *numbers: float,
    motion: int = 0,
    scale: Scale = DIMENSIONLESS,
) -> ParameterError:
    """Return the error, not raised, of a sentence that states dimensionless numbers.

    name: name of the parameter.
    text: the sentence, with {} for each number.
    quantity: the quantity of these numbers.
    numbers: their values; the first is the one that was found.
    motion: index of the motion of these numbers.
    scale: :class:`Scale` of the roller, in whose unit the numbers are told.  Where it differs
    between motions it is that of ``motion``, which the sentence names.
    """
    values = [np.take(scale[quantity], motion, mode="clip") * x for x in numbers]
    unit = scale.unit(quantity) if scale.si else ""
    of_many = f" of motion {motion}:" if np.ndim(scale[quantity]) else ":"
    told = (f"{digits_beside(x, *values)} {unit}".rstrip() for x in values)
    sentence = text.replace(":", of_many, 1).format(*told)
    error = ParameterError(name, values[0], sentence.partition(": must be ")[2], sentence)
    error.dimensionless = functools.partial(
        dimensionless_error, name, text, quantity, *numbers, motion=motion
    )
    return error


def with_scales(error: ParameterError, scale: Scale) -> ParameterError:
    """Return an error that tells the dimensionless numbers of its message in the units of a roller;
    ``error`` itself for a scene, or where its message states none.

    error: the :class:`ParameterError`.
    scale: :class:`Scale` of the roller.
    """
    return error.dimensionless(scale=scale) if scale.si and error.dimensionless else error


# --- What drives motions, as the caller gives it ---

#: Rows of the kernel's output that describe the state.
STATES = ("V", "omega", "x", "angle", "delta", "regime")
#: Rows of energies lost in the contact.
LOSSES = ("slip_loss", "rolling_loss")
#: Rows that are 0 without a drive.
ACTING = ("force", "torque", "work_force", "work_torque", "brake_loss")
#: Rows of the kernel's output.
ROWS = STATES + ACTING + LOSSES


class Drive(NamedTuple):
    """Loads and prescribed speeds of one motion or many, as the caller gave them; None where
    nothing is given.

    force, torque, brake, omega, V : a number, an array (n,), a Schedule or a callable of t; force
    and torque also a Feedback of one of these.
    slope, drag : numbers or arrays (n,).
    Meaning, signs and units are those of :func:`viscoroll.roll`.
    """

    force: Any = None
    torque: Any = None
    slope: Any = None
    brake: Any = None
    drag: Any = None
    omega: Any = None
    V: Any = None

    @property
    def given(self) -> dict[str, Any]:
        """What is given, name of the field -> value as the caller gave it, a new dict without what
        is None.
        """
        return {name: value for name, value in self._asdict().items() if value is not None}

    @property
    def values(self) -> dict[str, Any]:
        """What is given, as :attr:`given`, without gains: of a feedback its value."""
        return {n: x.value if isinstance(x, Feedback) else x for n, x in self.given.items()}

    @property
    def numbers(self) -> dict[str, Any]:
        """Return name -> array of each load or speed that is given as a number or as one for each
        motion, also in a feedback, unchecked.

        The angle of a slope and the drag are among them.  Schedules and callables are left out.
        """
        return {
            n: np.asarray(x)
            for n, x in self.values.items()
            if not (callable(x) or isinstance(x, Schedule))
        }

    @property
    def acts(self) -> bool:
        """Whether anything is given; every call of roll asks, so no dict is made."""
        return {*map(type, self)} != {type(None)}

    def without_zeros(self) -> "Drive":
        """Return the same without a force, torque, slope, brake or drag that is 0 at all times;
        prescribed speeds of 0 stay.

        Returns a new :class:`Drive`; an empty array and one of zeros are left out, a callable never
        is.
        Raises ParameterError for a load that is no number and no function of time, or not finite.
        """
        return Drive(
            **{
                name: value
                for name, value in self.given.items()
                if name in ("omega", "V") or not _is_zero(name, value)
            }
        )


def _is_zero(name: str, value: Any) -> bool:
    """Return whether a load is 0 at all times; a callable never counts as 0.

    name: name of the argument, for refusals.
    value: what the caller gave: a number, an array, of which all must be 0, a Schedule, of which
    all values must be, a callable or a Feedback, whose gains must be 0 too.  An empty array counts
    as 0.
    Raises ParameterError for what is no number and no function of time, and for numbers that are
    not finite.
    """
    if isinstance(value, Feedback):
        return not (np.any(value.V) or np.any(value.omega)) and _is_zero(name, value.value)
    return not (
        callable(value)
        or np.any(value.values if isinstance(value, Schedule) else check_array(name, value))
    )


def strip_units(
    start: tuple[Any, Any], drive: Drive, units: HasUnits
) -> tuple[tuple[Any, Any], Drive, Labels | None]:
    """Return start speeds and drive in the units of a roller, as plain numbers, and the labels that
    they had.

    start: V0 and omega0, as the caller gave them; None where a speed is prescribed.
    drive: :class:`Drive`, loads and prescribed speeds, as the caller gave them.
    units: units of the roller, an object with a method ``unit`` as :class:`Scale` has it.
    Raises ParameterError for a unit of another dimension, for arrays with labels beside arrays
    without, or with other labels, and, where any argument has a unit or labels, for a Feedback that
    is neither force nor torque.
    Returns (V0 and omega0; loads and prescribed speeds; labels of arrays of xarray and pandas, by
    which results are labelled again, None without), in the units of the roller.  What had neither a
    unit nor labels is unchanged, and callables are.  Numbers are not checked otherwise.
    """
    # the common case, which needs no names
    if UNITLESS_TYPES.issuperset(map(type, (*start, *drive))):
        return start, drive, None
    plain, labels = strip_labels({"V0": start[0], "omega0": start[1], **drive._asdict()}, units)
    return (plain.pop("V0"), plain.pop("omega0")), Drive(**plain), labels
