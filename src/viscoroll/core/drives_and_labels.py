"""Arguments with a meaning of their own: functions of time that act on motions, and arrays with
the labels of xarray and pandas.

Labels are removed from the arguments of a call, with their units, and put on its results.
"""

import inspect
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from .arrays import (
    ArrayLike,
    Named,
    Names,
    Shape,
    broadcast_shape,
    check_array,
    divide_by_unit,
    read_only,
)
from .errors import ParameterError, described_error, shape_error
from .quantities import UNITLESS_TYPES, HasUnits, Scale, convert, has_no_unit, split_unit, to_unit

# --- Functions of time that act on motions ---

#: Load -> the quantities whose units its gains on V and omega have.
_GAINS = {"force": ("dQ_dV", "dQ_domega"), "torque": ("dM_dV", "drag")}


@dataclass(frozen=True, eq=False)
class Schedule:
    """A piecewise linear function of time, constant before its first and after its last corner.

    Parameters
    ----------
    times : times of the corners, (k,), ascending, >= 0; a time that occurs twice is a jump.  For an
        ensemble also (n, k), a row for each motion.
    values : values at the corners, (k,) or (n, k).  Units of times and values are converted by the
        function that takes the schedule.

    Raises
    ------
    ParameterError
        Values that are not numeric or not finite, times that decrease or occur three times, shapes
        that do not agree.

    Examples
    --------
    >>> import viscoroll as vr
    >>> push = vr.Schedule([0.0, 1.0, 1.0], [5.0, 5.0, 0.0])  # 5 N/m for one second, then 0
    >>> push.values
    array([5., 5., 0.])
    """

    times: Any
    values: Any
    #: Name of a field -> unit that it was given in.
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the fields, make them read-only arrays of float64, and keep the units that they
        were given in.

        Both must be (k,) or (n, k), k >= 1, with equal k, and equal n where both have it; in each
        row times are >= 0, do not decrease, and no time occurs more than twice.  Raises
        ParameterError where that does not hold, or a field is not numeric or not finite.
        """
        _check_field(self, "times", 0.0)
        _check_field(self, "values")
        times = self.times
        values = self.values
        fits = {np.ndim(times), np.ndim(values)} <= {1, 2}
        fits = fits and times.size > 0 and values.shape[-1] == times.shape[-1]
        if not fits or len({len(array) for array in (times, values) if array.ndim == 2}) > 1:
            shapes = f"times {np.shape(times)}, values {np.shape(values)}"
            allowed = "(k,) for k >= 1 times, or (n, k) for n motions; both of the same k (and n)"
            raise ParameterError("shapes of a Schedule", shapes, allowed)
        for wrong, found, allowed in (
            (times[..., 1:] < times[..., :-1], "decrease after {:.6g}", "in ascending order"),
            (
                times[..., 2:] == times[..., :-2],
                "contain {:.6g} more than twice",
                "different times, or the same one twice for a jump",
            ),
        ):
            if wrong.any():
                # a difference belongs to the time it begins at: the first k - 1 or k - 2 times
                raise described_error(
                    "times", found.format(times[..., : wrong.shape[-1]][wrong][0]), allowed
                )


@dataclass(frozen=True, eq=False)
class Feedback:
    """A force or torque that depends on the speeds: value + V * speed of the axis + omega * angular
    velocity.

    Parameters
    ----------
    value : force or torque at rest: a number or an array; for motions also a :class:`Schedule` or a
        function of t, see :func:`roll`.
    V, omega : gains on the speed of the axis and on the angular velocity: numbers, for motions of
        an ensemble also (n,).  A gain < 0 brakes, as the torque of an engine falls with its speed.

    Raises
    ------
    ParameterError
        Values that are not numeric or not finite, gains that are neither numbers nor vectors.

    Examples
    --------
    >>> import viscoroll as vr
    >>> engine = vr.Feedback(2.0, omega=-0.5)  # 2 N m/m at rest, 0 at 4 rad/s
    >>> equilibria = vr.presets.RUBBER_CYLINDER.steady(torque=engine)
    """

    value: Any
    V: Any = 0.0
    omega: Any = 0.0
    #: Name of a field -> unit that it was given in.
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the fields, make each a float or a read-only array, and keep the units that they
        were given in.

        A value that is a schedule or a function stays; it is checked with its motion.  Gains may be
        numbers or (n,).
        Raises ParameterError for fields that are not numeric or not finite, and for gains of more
        axes.
        """
        if not (callable(self.value) or isinstance(self.value, Schedule)):
            _check_field(self, "value")
        for name in ("V", "omega"):
            _check_field(self, name)
            if np.ndim(gain := getattr(self, name)) > 1:
                raise shape_error(
                    name, np.shape(gain), "one number, or an array (n,) with a gain for each motion"
                )

    @property
    def shape(self) -> Shape:
        """Common shape of the gains."""
        return np.broadcast_shapes(np.shape(self.V), np.shape(self.omega))


def _check_field(load: Schedule | Feedback, name: str, low: float = -np.inf) -> None:
    """Replace a field by its checked numbers, and keep the unit that it was given in.

    load: :class:`Schedule` or :class:`Feedback`, changed in place although it is frozen: its field
        becomes a float or a read-only array, and a unit is entered into its ``units``.  Numbers
        with a unit stay in that unit.
    name: name of the field.
    low: smallest allowed number, -infinite for none; compared before any conversion.
    Raises ParameterError for numbers that are not numeric, not finite or below ``low``, and for
    what :func:`.quantities.split_unit` refuses, as a list of numbers with and without units.
    """
    numbers, unit = split_unit(name, getattr(load, name))
    object.__setattr__(load, name, read_only(check_array(name, numbers, low=low)))
    if unit is not None:
        load.units[name] = unit


def convert_argument(name: str, value: Any, units: HasUnits) -> Any:
    """Convert an argument that a caller gave with a unit to the unit of the argument.

    name: name of the argument, by which its unit is found.
    value: what a caller gave: a number, an array, a value with a unit, a :class:`Schedule`, a
        :class:`Feedback` or a function of time.
    units: object whose method ``unit`` gives the unit of each argument by name, as "N m-1".
    Returns ``value`` itself if it has no unit, as a function of time; else a value of the same kind
    without unit: plain numbers, with the labels of xarray and pandas, or a new schedule or feedback
    whose fields are in their units, those of a schedule within a feedback too.

    Raises
    ------
    ParameterError
        A unit of another dimension, an unknown one, or another that :func:`.quantities.to_unit`
        refuses; a feedback for an argument that is neither force nor torque.
    """
    if isinstance(value, Schedule):
        return _convert_fields(name, value, units, times="t", values=name)
    if not isinstance(value, Feedback):
        return to_unit(name, value, units.unit(name))
    if name not in _GAINS:
        sentence = f"{name} is a Feedback, which can only be given as force= or torque="
        raise ParameterError(name, "a Feedback", "no Feedback", sentence)
    V, omega = _GAINS[name]
    value = _convert_fields(name, value, units, value=name, V=V, omega=omega)
    # the value of a feedback has its own unit; that of a schedule is stated by the schedule
    if isinstance(value.value, Schedule):
        return replace(value, value=convert_argument(name, value.value, units))
    return value


def _convert_fields(name: str, load: Any, units: HasUnits, **quantities: str) -> Any:
    """Convert those fields of a schedule or a feedback that were given with a unit.

    name: name of the argument, for errors.
    load: :class:`Schedule` or :class:`Feedback`; not changed.
    units: object whose method ``unit`` gives the unit of each quantity by name.
    quantities: name of a field -> its quantity, for each field that may have a unit.
    Returns a new load of the same class without units; ``load`` itself if none of its fields has a
    unit.
    Raises ParameterError for a unit of another dimension or an unknown one, and for numbers that
    the class refuses after the conversion, as infinite ones.
    """
    converted = {
        part: convert(f"{part} of {name}", getattr(load, part), unit, units.unit(quantities[part]))
        for part, unit in load.units.items()
    }
    return replace(load, **converted) if converted else load


def require_time_argument(name: str, function: Callable[..., Any]) -> None:
    """Raise ParameterError for a function of time that cannot be called with a time alone; it is
    not called here.

    name: name of the argument that the function is, for the error.
    function: the function of a caller, a callable.  One whose signature Python cannot find, as of
        some compiled code, is accepted; parameters with defaults are allowed.
    """
    try:
        parameters = inspect.signature(function)
        parameters.bind(0.0)
    except ValueError:  # compiled code may have no signature
        return
    except TypeError:
        raise ParameterError(
            name,
            function,
            "a function of t",
            f"{name} must be a function of t alone, but this function has the parameters "
            f"{parameters}: for a force or torque that is linear in the speeds give vr.Feedback; "
            "with another controller integrate the motion yourself, calling vr.law",
        ) from None


def slope_tan_cos(slope: ArrayLike | None) -> tuple[Any, Any]:
    """Return tangent and cosine of the angle of a slope.

    Parameters
    ----------
    slope : angle, rad, a number or an array, perhaps with a unit; None: level.

    Returns
    -------
    tan, cos : tangent, and cosine > 0, dimensionless, arrays of the shape of ``slope``, numpy
        floats of a number; the floats 0.0 and 1.0 for None.

    Raises
    ------
    ParameterError
        A slope that is not numeric, not finite, not in (-pi/2, pi/2), or has a unit that is no
        angle.
    """
    if slope is None:
        return 0.0, 1.0
    theta = check_array("slope", slope, unit="rad")
    steep = np.abs(theta) >= 0.5 * np.pi
    if steep.any():
        given = theta[steep].flat[0]
        allowed = "in (-pi/2, pi/2), in radians"
        if abs(given) >= 2.0:  # a number that looks like degrees
            allowed += f"; {given:g} degrees are {np.radians(given):.4g}"
        raise ParameterError("slope", f"{given:g}", allowed)
    return np.tan(theta), np.cos(theta)


def make_dimensionless(name: str, value: Any, scale: Scale) -> Any:
    """Return a load divided by its unit: a number, an array, a schedule, a function of time or a
    feedback.

    name: name of the argument, as "force", "torque", "brake", "drag" or "V", by which its unit is
        found.
    value: what a caller gave, in SI units for a cylinder; a number or an array with a unit is
        converted, the fields of schedules and feedbacks are taken to be in SI units
        (:func:`convert_argument`).  None stays None.
    scale: :class:`.scale.Scale` of the roller, a unit for each quantity, numbers or, of many
        cylinders, (n,).  With that of a scene ``value`` is returned itself, unchecked.
    Returns a new value of the same kind: a float for a number (an array (n,) of many cylinders), an
    array, a :class:`Schedule` (with values (n, k) of many cylinders), a :class:`Feedback`, whose
    gains are multiplied by the unit of the speed and divided by that of the load, or a function.
    Such a function takes the dimensionless time and returns dimensionless arrays; the values of the
    caller's function are checked when it is called.

    Raises
    ------
    ParameterError
        A value that is not numeric or not finite, a unit of another dimension, a brake or a drag <
        0, a function for an array of cylinders or one that cannot be called with a time alone, and
        an array or gains that do not broadcast with the cylinders.
    """
    if value is None or not scale.si:
        return value
    unit = scale[name]
    low = 0.0 if name in ("brake", "drag") else -np.inf
    # the common case, without arrays; 0.0 of a brake, NaN and infinite values take the long way
    if type(value) is type(unit) is float and low < value < np.inf:
        return value / unit
    if isinstance(value, Feedback):
        broadcast_shape(
            **{
                "gain on V": value.V,
                "gain on omega": value.omega,
                "cylinders": unit * scale["V"] * scale["omega"],  # for its shape alone
            }
        )
        gains = value.V * scale["V"] / unit, value.omega * scale["omega"] / unit
        return Feedback(make_dimensionless(name, value.value, scale), *gains)
    if callable(value):
        if np.ndim(unit):
            raise ParameterError(
                name,
                "a function",
                "a number",
                f"{name} is a function of t, which is allowed for a single cylinder only: make a "
                f"call for each cylinder, or give {name} as numbers or a Schedule",
            )
        require_time_argument(name, value)
        return lambda t: (
            check_array(f"{name}(t)", value(t * scale["t"]), unit=scale.unit(name), low=low) / unit
        )
    if isinstance(value, Schedule):
        values = check_array(f"values of {name}", value.values, low=low)
        # the last axis of the values is that of the corners, and cylinders are the rows
        units = unit[:, None] if np.ndim(unit) else unit
        return Schedule(value.times / scale["t"], divide_by_unit(name, values, units))
    quotient = divide_by_unit(name, check_array(name, value, unit=scale, low=low), unit)
    return quotient if quotient.ndim else float(quotient)


# --- Labels of xarray and pandas ---


class Labels(NamedTuple):
    """Labels that the arguments of a call have in common.

    shape : shape of the arguments, broadcast.
    like : array of xarray with the axes and coordinates of the arguments, or their index of pandas.
    dims : names of the axes, as many as ``shape`` has.
    coords : name of a coordinate -> (names of its axes, its values), as xarray has them, for pandas
    too.
    """

    shape: Shape
    like: Any
    dims: Names
    coords: Named

    def axes_in_front(self, shape: Shape, after: int = 0) -> int:
        """Return how many axes an array of results has before those of the arguments.

        There are such axes where the parameters of the roller are arrays of more axes.

        shape: shape of the array: axes in front, then those of the arguments, then ``after`` more.
        after: number of its axes after those of the arguments, >= 0.
        Returns their number, >= 0; -1 if the sizes of the axes at that position are not those of
        the arguments.
        """
        front = len(shape) - len(self.shape) - after
        return front if front >= 0 and shape[front : len(shape) - after] == self.shape else -1

    def apply(self, name: str, values: Any, *further: str) -> Any:
        """Return values with the labels of the arguments.

        name: name of the result, which the labelled array gets.
        values: array with the axes of the arguments, perhaps others in front of them, which
        :func:`state_axes` names.
        further: names of its axes after those of the arguments.
        Returns an array of xarray, in which an axis or a coordinate of the arguments with the name
        of another axis is called given_NAME, or a series of pandas, with one further axis a data
        frame, whose columns are 0 to m - 1.  ``values`` itself is returned if its shape is another
        one, and with pandas if there are more axes.
        """
        shape = np.shape(values)
        front = self.axes_in_front(shape, len(further))
        if front < 0:
            return values
        if hasattr(self.like, "dims"):
            import xarray as xr

            before = state_axes(len(shape) - len(further))[:front]
            own = {*self.like.dims, *self.like.coords}
            like = self.like.rename(
                {other: f"given_{other}" for other in (*before, *further) if other in own}
            )
            return xr.DataArray(
                values, dims=(*before, *like.dims, *further), coords=like.coords, name=name
            )
        import pandas as pd

        if front or len(further) > 1:  # no type of pandas has more axes
            return values
        if further:
            return pd.DataFrame(
                values, index=self.like, columns=pd.RangeIndex(shape[1], name=further[0])
            )
        return pd.Series(values, index=self.like, name=name)

    def differ(self, name: str, values: Any) -> bool:
        """Whether a coordinate or an axis has the name of an argument, but other values.

        name: name of the argument.
        values: its values, an array.
        Returns False if no coordinate and no axis has that name.  An axis without a coordinate has
        no values, and counts as different where the argument is a single number.
        """
        import xarray as xr

        if name not in self.coords:
            return name in self.dims and not values.ndim
        dims, label = self.coords[name]
        # a number stands for all, and axes of further arguments have the size 1
        own = xr.DataArray(np.resize(values, self.shape), dims=self.dims)
        return not xr.DataArray(label, dims=dims).broadcast_equals(own)

    def axes_beside(self, names: Iterable[str], *dims: str) -> tuple[Names, Named]:
        """Return axes and coordinates for a dataset; what has the name of a variable there is
        called given_NAME.

        names: names of the variables of the dataset, and of its other axes.
        dims: new names of the axes, which their coordinates get too; without any they keep their
        names.
        Returns (names of the axes; dict from the name of a coordinate to (its axes, its values,
        {"long_name": name in the arguments})), as xarray takes them.  Whether a name given_NAME is
        free is not checked.
        """
        new = {
            name: f"given_{name}" if name in names else name for name in (*self.dims, *self.coords)
        }
        new |= zip(self.dims, dims)  # without new names nothing changes
        coords = {
            new[name]: (tuple(new[dim] for dim in own), values, {"long_name": name})
            for name, (own, values) in self.coords.items()
        }
        return tuple(new[dim] for dim in self.dims), coords


def state_axes(count: int) -> Names:
    """Return names of ``count`` axes without labels: "state" of a single one, else "state_0",
    "state_1" and so on.
    """
    return ("state",) if count == 1 else tuple(f"state_{n}" for n in range(count))


def dataset_axes(labels: Labels | None, shape: Shape, names: Iterable[str]) -> tuple[Names, Named]:
    """Return the axes of a dataset of results, and its coordinates by the labels of the arguments.

    labels: labels of the arguments; None: they had none.
    shape: shape of the results; other axes may be in front of those of the labels.
    names: names of the variables of the dataset.
    Returns (names of the axes, by :func:`state_axes` where they have no labels; coordinates as in
    :meth:`Labels.axes_beside`, {} if the labels have another shape).
    """
    axes = state_axes(len(shape))
    if labels is None or (front := labels.axes_in_front(shape)) < 0:
        return axes, {}
    dims, coords = labels.axes_beside((*names, *axes[:front]))
    return axes[:front] + dims, coords


def strip_labels(given: Named, units: HasUnits) -> tuple[Named, Labels | None]:
    """Return the arguments of a call as plain numbers in their units, and their labels.

    Parameters
    ----------
    given : name -> what a caller gave: numbers, arrays, values with units or labels, functions of
        time, schedules and feedbacks, or None.  Labels of the fields of a schedule or a feedback
        are not examined.
    units : object with a method ``unit``, which gives the unit of each argument by name, as a
        :class:`.scale.Scale`.

    Returns
    -------
    plain : name -> value without labels and unit; labelled arrays are broadcast to their common
        shape, and numbers of other kinds, as an index of pandas, a nested list or a Decimal, are
        float64.  It may be ``given`` itself, if no argument has a label or a unit.
    labels : the :class:`Labels` of the arguments; None where no argument has any.

    Raises
    ------
    ParameterError
        What :func:`convert_argument` refuses, as a unit of another dimension; numbers of other
        kinds that are not finite; labelled arrays beside plain ones (numbers and schedules may
        stand beside them), arrays of xarray whose common axes have different coordinates,
        series of pandas with different indices, or both kinds together.
    """
    if UNITLESS_TYPES.issuperset(map(type, given.values())) or all(
        map(has_no_unit, given.values())
    ):
        return given, None
    given = {name: convert_argument(name, value, units) for name, value in given.items()}
    data_arrays, series = (
        {name: value for name, value in given.items() if isinstance(value, kind)}
        for kind in (_loaded_type("xarray", "DataArray"), _loaded_type("pandas", "Series"))
    )
    labelled = data_arrays | series
    # other kinds, as an index or a nested list, become float64; [()] makes a number of shape ()
    given |= {
        name: check_array(name, value)[()]
        for name, value in given.items()
        if not (
            name in labelled
            or has_no_unit(value)
            or callable(value)
            or isinstance(value, Schedule | Feedback)
        )
    }
    if not labelled:
        return given, None
    unlabelled = [
        name
        for name, value in given.items()
        if name not in labelled and not isinstance(value, Schedule) and np.ndim(value)
    ]
    if unlabelled or (data_arrays and series):
        mixed = (*labelled, *unlabelled)
        kinds = ", ".join(f"{name} ({type(given[name]).__name__})" for name in mixed)
        sentence = f"{kinds} are mixed: give all as DataArray, as Series, or as arrays of numpy"
        raise ParameterError(", ".join(mixed), "mixed", "alike", sentence)
    values, labels = _from_xarray(data_arrays) if data_arrays else _from_pandas(series)
    return given | values, labels


def _loaded_type(module: str, name: str) -> Any:
    """Return the type ``name`` of a ``module`` if the program has imported that module, else (), of
    which nothing is an instance.
    """
    return getattr(sys.modules.get(module), name, ())


def _from_xarray(arrays: Named) -> tuple[Named, Labels]:
    """Broadcast arrays of xarray by the names of their axes, and separate their values from their
    labels.

    arrays: name of an argument -> array of xarray; at least one.
    Returns (name -> values, all of the broadcast shape, perhaps read-only views; :class:`Labels`,
    whose ``coords`` are the coordinates along an axis of every array; of two of one name that of
    the first array).
    Raises ParameterError if arrays differ in coordinates or length of an axis that they share.
    """
    import xarray as xr

    try:
        aligned = xr.broadcast(*xr.align(*arrays.values(), join="exact"))
    except ValueError as error:
        names = " and ".join(arrays)
        raise ParameterError(
            names,
            "unlike coordinates",
            "aligned",
            f"{names} have axes of the same name, but of different coordinates or lengths: give "
            "the same coordinates (xarray.align selects the common ones), or rename an axis",
        ) from error
    like = aligned[0].drop_attrs()
    # from the last array to the first, whose coordinates take the place of later ones
    others = {name: each for array in reversed(aligned) for name, each in array.coords.items()}
    like = like.assign_coords({name: others[name] for name in others if name not in like.coords})
    coords = {
        str(name): (tuple(map(str, each.dims)), each.values)
        for name, each in like.coords.items()
        if each.dims
    }
    labels = Labels(like.shape, like, tuple(map(str, like.dims)), coords)
    return {name: array.values for name, array in zip(arrays, aligned)}, labels


def _from_pandas(series: Named) -> tuple[Named, Labels]:
    """Separate the values of series of pandas from their labels.

    series: name of an argument -> series of pandas; at least one.
    Returns (name -> values, (n,), of the dtype of the series; :class:`Labels`, which make series of
    results, and data frames of results with one more axis; results with several more axes are
    returned without labels).  The axis of these labels has the name of the index, "index" of one
    without a name, "state" of an index of several levels, each of which is a coordinate; levels
    without a name are called level_0, level_1 and so on.
    Raises ParameterError if the indices differ.
    """
    first, *others = series.values()
    index = first.index
    if not all(index.equals(other.index) for other in others):
        names = " and ".join(series)
        raise ParameterError(
            names,
            "unlike indices",
            "of one index",
            f"{names} have different indexes: align them first, by reindex_like of pandas",
        )
    # the levels of the index as columns; the last column has the values, with a name that no
    # level has, since reset_index refuses a second column of one name
    levels = first.rename("").reset_index().iloc[:, :-1]
    dim = str(levels.columns[0]) if index.nlevels == 1 else "state"
    coords = {str(name): ((dim,), values.to_numpy()) for name, values in levels.items()}
    values = {name: each.to_numpy() for name, each in series.items()}
    return values, Labels(first.shape, index, (dim,), coords)
