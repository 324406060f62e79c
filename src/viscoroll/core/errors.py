"""Exceptions and warnings of the package, and what the status code of a motion means.

- :class:`ParameterError`: a value out of its range, NaN or infinite where it must not be, an
  unknown name, inputs that do not fit together.  It is also a ``ValueError``.
- :class:`OutOfTableError`: a point outside the grid of a table.
- :class:`FileError`: a file that is missing, damaged or of another kind, that has an unknown key or
  a value of the wrong type, or that cannot be written.
- :class:`MissingDependencyError`: an optional package, or a program, is not installed.
- :class:`ConvergenceError`: an iteration reached its limit.

Kernels do not raise exceptions, they return a status.  Each motion has a status with a sentence
(:class:`MotionStatus`); a contact that cannot be solved becomes a ConvergenceError.

The module also imports packages that only some functions need and that an extra of the
installation brings (:func:`import_extra`), and finds the name that was meant where one is misspelt:
a key of a file, a heading of a column, or an argument of a public call (:func:`suggestion`,
:func:`suggest_arguments`).
"""

import copyreg
import datetime
import enum
import functools
import importlib
import inspect
import sys
import warnings
from collections.abc import Collection, Iterable
from typing import Any

# --- The exceptions of this package, and the meaning of a kernel's status code ---


class ViscorollError(Exception):
    """Base class of all exceptions of this package.

    Examples
    --------
    >>> import viscoroll as vr
    >>> try:
    ...     vr.load_law("absent.nc")
    ... except vr.ViscorollError as error:
    ...     print(type(error).__name__)
    FileError
    """

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the attributes, because the arguments of the subclasses are not those of
        Exception.
        """
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]


class ParameterError(ViscorollError, ValueError):
    """A parameter has a value that is not allowed.  The message is one line: the name, the value,
    what is allowed.

    Parameters
    ----------
    name : name of the parameter.
    value : value that was found.
    allowed : words that follow "must be".
    sentence : the whole message, where name, value and allowed values do not make one.

    Examples
    --------
    >>> import viscoroll as vr
    >>> try:
    ...     vr.Scene(alpha=0.5, kappa=10.0, mu=0.3)
    ... except vr.ParameterError as error:
    ...     print(error.name, error.value)
    alpha 0.5
    """

    #: Function of ``scale`` that returns this error with its dimensionless numbers in SI units, for
    #: a call with a cylinder; None without such numbers.
    dimensionless: Any = None

    def __init__(self, name: str, value: Any, allowed: str, sentence: str | None = None) -> None:
        self.name = name
        self.value = value
        self.allowed = allowed
        super().__init__(
            " ".join((sentence or f"{name} = {value!s}: must be {allowed}").split("\n"))
        )


#: Types that callers give in place of numbers, and their names in messages; the first that fits is
#: taken.
_TYPE_NAMES: tuple[tuple[Any, str], ...] = (
    (str, "a text"),
    (bytes, "bytes"),
    (bool, "a truth value"),
    (complex, "a complex number"),
    (datetime.date, "a date"),
    (datetime.timedelta, "a duration"),
    (dict, "a dictionary"),
    ((list, tuple), "a list"),
)


def describe_value(value: Any) -> str:
    """Return a value for a message: its text in one line of at most 60 characters, the last three
    "..." where it is longer, and its type in parentheses.

    value: what a caller gave, of any type.
    Returns a text as "'abc' (a text)", "[1, 2] (a list)", "<function ...> (a function)", or of an
    array "... (of type int64, shape (3,))"; of None, an int or a float the text alone; of other
    objects "... (of type NAME)".
    """
    text = " ".join(repr(value).split())
    text = text if len(text) <= 60 else f"{text:.57}..."
    if value is None or (isinstance(value, int | float) and not isinstance(value, bool)):
        return text
    kind = next((words for types, words in _TYPE_NAMES if isinstance(value, types)), "")
    if not kind and hasattr(value, "dtype"):
        kind = f"of type {value.dtype}" + (f", shape {value.shape}" if value.shape else "")
    return f"{text} ({kind or ('a function' if callable(value) else f'of type {type(value).__name__}')})"  # noqa: E501


def digits_beside(value: Any, *others: Any) -> str:
    """Return a number for a message in six digits, or in all that it has where another one has the
    same six.

    A refused number would else be printed as one that is allowed.

    value: the number.
    others: numbers beside it in the message, as the ends of a range.
    """
    text = f"{value:g}"
    return (
        repr(float(value)).removesuffix(".0")
        if any(value != other and text == f"{other:g}" for other in others)
        else text
    )


def unit_error(name: str, found: str, target: str) -> ParameterError:
    """Return the ParameterError, not raised, of an argument in a unit that cannot be converted.

    name: name of the argument.
    found: verb and unit that was found, as "is in km".
    target: unit of the argument, "1" of a dimensionless number.
    """
    allowed = (
        "a number without dimension"
        if target == "1"
        else f"in {target}, or in another unit of that dimension"
    )
    return described_error(name, found, allowed)


def described_error(name: str, found: str, allowed: str) -> ParameterError:
    """Return the error, not raised, of a parameter that a property describes better than its value.

    name: name of the parameter.
    found: verb and property, as "is empty".
    allowed: words that follow "must be".
    """
    return ParameterError(name, found, allowed, f"{name} {found}: must be {allowed}")


def shape_error(name: str, shape: tuple[int, ...], allowed: str) -> ParameterError:
    """Return the error, not raised, of an array of a wrong shape.

    name: name of the parameter.
    shape: shape that was found.
    allowed: words that follow "must be".
    """
    return described_error(name, f"has shape {shape}", allowed)


def exactly_one_error(first: str, second: str, both: bool) -> ParameterError:
    """Return the ParameterError, not raised, of a call that must give exactly one of two
    parameters.

    first, second: names of the parameters.
    both: whether both were given; else neither was.
    """
    sentence = (
        f"{first} and {second} are both given: give only one of the two"
        if both
        else f"neither {first} nor {second} is given: give one of the two"
    )
    return ParameterError(
        f"{first}, {second}", "both" if both else "neither", "exactly one of the two", sentence
    )


def check_one_given(**values: Any) -> str:
    """Check that exactly one of two parameters is given, and return its name.

    values: exactly two parameters by name, None where one is not given.
    Returns the name of the one that is given.
    Raises ParameterError if none or both are given.
    """
    (first, one), (second, other) = values.items()
    if (one is None) is (other is None):
        raise exactly_one_error(first, second, both=one is not None)
    return second if one is None else first


def unknown_name_error(name: str, value: Any, known: Iterable[str], kind: str) -> ParameterError:
    """Return the ParameterError, not raised, of a parameter whose value is not a known name; it
    lists all of these.

    name: name of the parameter.
    value: what was found, of any type.
    known: the names that are allowed.
    kind: noun for these names, with its article, as "a field".
    """
    names = ", ".join(known)
    return ParameterError(
        name, value, f"one of {names}", f"{name}: {value!r} is not {kind}; choose from {names}"
    )


def check_names(name: str, values: Any, known: Collection[str], kind: str) -> tuple[str, ...]:
    """Check one name, or several, and return them as a tuple, in the order given; names given twice
    stay.

    name: name of the parameter, for the error.
    values: what a caller gave: a name or an iterable of names.
    known: the names that are allowed.
    kind: noun for these names, with its article, as "a field", for the error.
    Returns a tuple of texts, () of an empty iterable.
    Raises ParameterError for the first value that is not known, and for ``values`` that are neither
    text nor iterable.
    """
    try:
        names = (values,) if isinstance(values, str) else tuple(values)
    except (TypeError, KeyError):  # not iterable; a result is by names alone
        names = (values,)
    for value in names:
        if not (isinstance(value, str) and value in known):
            raise unknown_name_error(name, value, known, kind)
    return names


class OutOfTableError(ParameterError):
    """A point lies outside the grid of a table; tables do not extrapolate.

    Parameters
    ----------
    name : name of the coordinate.
    value : value that was found.
    low, high : ends of the axis.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> try:
    ...     vr.tables.interpolate(grid, ["M"], V=0.5)
    ... except vr.ParameterError as error:
    ...     print(error)
    V = 0.5: must be within the table's range [0.1, 0.4]
    """

    def __init__(self, name: str, value: float, low: float, high: float) -> None:
        self.low = low
        self.high = high
        ends = f"[{digits_beside(low, value)}, {digits_beside(high, value)}]"
        super().__init__(name, digits_beside(value, low, high), f"within the table's range {ends}")


class FileError(ViscorollError):
    """A file cannot be read or written.

    Parameters
    ----------
    path : path of the file.
    problem : the reason, in words that follow the path.

    Examples
    --------
    >>> import viscoroll as vr
    >>> try:
    ...     vr.read_dma("absent.csv")
    ... except vr.FileError as error:
    ...     print(error)
    absent.csv: cannot be read (No such file or directory)
    """

    def __init__(self, path: Any, problem: str) -> None:
        self.path = path
        self.problem = problem
        super().__init__(f"{path}: {problem}")


class Interrupted(KeyboardInterrupt):
    """The user stopped a run of blocks.  Finished blocks are kept; the message names the command
    that resumes.
    """


class MissingDependencyError(ViscorollError):
    """A package or a program is not installed.

    Parameters
    ----------
    package : its name.
    extra : extra of viscoroll, which installs it; None where no extra does.

    Examples
    --------
    >>> import viscoroll as vr
    >>> print(vr.MissingDependencyError("zarr", "runs"))
    zarr is not installed: pip install 'viscoroll[runs]'
    """

    def __init__(self, package: str, extra: str | None) -> None:
        self.package = package
        self.extra = extra
        super().__init__(
            f"{package} is not installed" + (f": pip install 'viscoroll[{extra}]'" if extra else "")
        )


class ConvergenceError(ViscorollError):
    """An iteration reached its limit.  This is a defect of the package: please report the input.

    Examples
    --------
    >>> import viscoroll as vr
    >>> issubclass(vr.ConvergenceError, vr.ViscorollError)
    True
    """


class ModelWarning(UserWarning):
    """An assumption of the model is grossly violated, or data do not cover the input.

    It is raised for a motion or a contact outside the validity of the model, for a contact whose
    transit frequency lies outside the band in which the material was measured, and for a file of
    measurements without units.  Every call is checked; Python shows a text once per line of the
    program.  Texts on a material or a file appear once for each.

    Examples
    --------
    >>> import warnings
    >>> import viscoroll as vr
    >>> with warnings.catch_warnings(record=True) as found:
    ...     warnings.simplefilter("always")
    ...     factor = vr.WLF(T0=20.0)(293.0)  # kelvins in place of degrees Celsius
    >>> found[0].category.__name__
    'ModelWarning'
    """


class MotionStatus(enum.IntEnum):
    """How a motion ended.

    A motion is complete if it is DONE (it reached the last output time) or RESTED (its speeds fell
    below the rest threshold).  Others stop before that: STEP_LIMIT and STEP_TOO_SMALL of the
    integrator; UNDECIDED at V = omega = 0, where the motion is not unique; UNSTEADY, too slow for
    the unsteady correction; CAUGHT, too slow to leave the indentation of a standstill.  The
    property ``message`` states each in a sentence.

    Examples
    --------
    >>> import viscoroll as vr
    >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, 1.0)
    >>> motion.status.name, motion.status.message
    ('DONE', 'reached the last output time')
    """

    DONE = 0
    RESTED = 1
    STEP_LIMIT = 2
    STEP_TOO_SMALL = 3
    UNDECIDED = 4
    UNSTEADY = 5
    CAUGHT = 6

    @property
    def message(self) -> str:
        """The status in words."""
        return _MESSAGES[self]


_MESSAGES = (
    "reached the last output time",
    "came to rest: |V| and R |omega| fell below the given speed rest",
    "max_steps steps did not suffice up to the last output time: raise max_steps, shorten the "
    "motion, or give a larger rtol (if a speed grows without bound, only shorten the motion)",
    "the time steps became too short for double precision, since the motion changes too fast: make "
    "an extreme gain, drag, speed or friction smaller, or rtol larger",
    "V and omega are both 0, and the cylinder can start in either direction from there, as mu is "
    "above 2 kappa = 2 R/l0 (l0: contact length at rest): the motion is not unique; lower mu",
    "the cylinder became too slow for unsteady=True: the added mass N, by which changes of speed "
    "act on the rolling moment, became about as large as the inertia; end the motion earlier, or "
    "leave unsteady=True out",
    "the cylinder is too slow at the start to leave the indentation of the standstill (rested): "
    "this would take more than 70 % of the kinetic energy; raise V0, or leave rested out",
)


def warn_of_model(text: str) -> None:
    """Give a :class:`ModelWarning` at the line of the user's program.

    That is the line of the first frame outside this package.  Frames of the module dataclasses,
    whose ``replace`` calls back, are passed over too.  If all frames are those of this package, the
    outermost one counts.
    """
    # frame 0 is this function, whose own line is stacklevel 1; 1 is what called it
    level = 2
    frame = sys._getframe(1)
    while frame.f_back is not None:
        name = frame.f_globals.get("__name__", "")
        # with the point "viscoroll" itself and its modules fit, but not "viscoroll_tools"
        if name != "dataclasses" and f"{name}."[:10] != "viscoroll.":
            break
        level += 1
        frame = frame.f_back
    warnings.warn(text, ModelWarning, stacklevel=level)


# --- Imports of packages that only some functions need ---


def import_extra(package: str, extra: str) -> Any:
    """Import a module of an optional package, and return it.

    package: name of the module and of the distribution that has it, as "fmpy".
    extra: extra of viscoroll that installs it, as in ``pip install 'viscoroll[EXTRA]'``, for the
    error.
    Returns the module.

    Raises
    ------
    MissingDependencyError
        If the package is not installed.
    ModuleNotFoundError
        If it is installed, but one of its own dependencies is not.  Other errors of its import pass
        too.
    """
    try:
        return importlib.import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise  # the package is installed, and one of its own dependencies is not
        raise MissingDependencyError(package, extra) from None


# --- Misspelt names: the one that was meant ---


def suggestion(name: str, candidates: Iterable[str]) -> str:
    """Return the question "; did you mean 'NAME'?", to be appended to a message.

    name: name that is not known.
    candidates: known names.  The one that differs from ``name`` by capitals alone is suggested,
        else the most similar one.
    Returns "" if none is similar.
    """
    import difflib

    known = list(candidates)
    # by its letters "v0" is as near to "t0" as to "V0"
    similar = [each for each in known if each.lower() == name.lower()]
    similar += difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return f"; did you mean {similar[0]!r}?" if similar else ""


@functools.cache
def _suggesting(function: Any) -> Any:
    """Return a function that calls another one, and adds to its TypeError of an unknown argument
    the name of the most similar argument.

    function: function or method of the package; the result is kept for the next call.
    """

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        """Call the function with ``arguments`` and ``named``, and return its result; to its
        TypeError of an unknown argument name a suggestion is added.
        """
        try:
            return function(*arguments, **named)
        except TypeError as error:
            for name in named:
                # the end of Python's own message, which from 3.13 on goes on with a suggestion
                if str(error).endswith(f"unexpected keyword argument '{name}'"):
                    error.args = (
                        f"{error}{suggestion(name, inspect.signature(function).parameters)}",
                    )
            raise

    return call


def suggest_arguments(owner: Any, names: tuple[str, ...] | None = None) -> None:
    """Replace the public functions of a module or class of this package, so that their TypeError of
    an unknown argument names the argument that was meant, as Python does itself from 3.13 on.

    A second call changes nothing.

    owner: module or class, which is changed.  The module that defines a function is changed too,
        since a function is pickled by its name there.
    names: what to replace in ``owner``: functions by their names, the methods of classes, and of
        modules the functions and classes in their ``__all__``.  None: all public ones.
    """
    for name in names or [name for name in vars(owner) if name == "__init__" or name[0] != "_"]:
        value = vars(owner).get(name)
        function = value.__func__ if isinstance(value, classmethod | staticmethod) else value
        if inspect.ismodule(value):
            suggest_arguments(value, tuple(value.__all__))
        for base in value.__mro__ if inspect.isclass(value) else ():
            if base.__module__.startswith("viscoroll"):
                suggest_arguments(base)
        if inspect.isfunction(function):
            # of a function that was replaced before: the cache then gives the same replacement
            plain = inspect.unwrap(function)
            code = plain.__code__
            # a plain method of a class has self, which counts as one
            if code.co_argcount + code.co_kwonlyargcount <= (
                function is value and inspect.isclass(owner)
            ):
                continue  # a method without arguments has none to suggest
            replaced = _suggesting(plain)
            setattr(owner, name, replaced if function is value else type(value)(replaced))
            if inspect.ismodule(owner):
                # owner may be a package that imports the function from its module
                setattr(sys.modules[function.__module__], name, replaced)
