"""The exception tree, and what a kernel's status code means.

Which error when:

- :class:`ParameterError`: a value out of its range, NaN or infinite where it must not be,
  an unknown name, inputs that do not fit together.  Also a ``ValueError``.
- :class:`OutOfTableError`: a point outside a table's grid.
- :class:`FileError`: a file that is missing, damaged, not what was asked for, or has a misspelt key or a value of the
  wrong type; one that cannot be written.
- :class:`MissingDependencyError`: a package of an extra, or a program, is not installed.
- :class:`ConvergenceError`: an iteration that hit its cap.

Kernels never raise; they return a status.  Motions carry one each, with a sentence
(:class:`MotionStatus`); only a failed contact solve is turned into an exception.
"""

from __future__ import annotations

import copyreg
from collections.abc import Collection, Iterable
from datetime import date, timedelta
from enum import IntEnum
from typing import Any


class ViscorollError(Exception):
    """Base of every exception that this package raises on purpose."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Travels between processes, though its arguments are not those of Exception."""
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]


class ParameterError(ViscorollError, ValueError):
    """``name`` has a ``value`` outside what is ``allowed``; ``sentence`` says it where "must be" does not.

    The message is one line, whatever the text of the value is.
    """

    def __init__(self, name: str, value: Any, allowed: str, sentence: str | None = None) -> None:
        self.name, self.value, self.allowed = name, value, allowed
        super().__init__(" ".join((sentence or f"{name} = {value!s}: must be {allowed}").split("\n")))


#: kinds of what callers give in place of numbers, the first that fits
_KINDS: tuple[tuple[tuple[type, ...], str], ...] = (
    ((str,), "a text"),
    ((bytes,), "bytes"),
    ((bool,), "a truth value"),
    ((complex,), "a complex number"),
    ((date,), "a date"),
    ((timedelta,), "a duration"),
    ((dict,), "a dictionary"),
    ((list, tuple), "a list"),
)


def describe_value(value: Any) -> str:
    """What a caller gave, for a message: its text in one line, cut at 60 characters, and its kind but of numbers."""
    text = f"{' '.join(repr(value).split()):.60}"
    if value is None or (isinstance(value, int | float) and not isinstance(value, bool)):
        return text
    kind = next((words for types, words in _KINDS if isinstance(value, types)), "")
    if not kind and type(value).__module__.partition(".")[0] == "numpy":
        shape = getattr(value, "shape", ())
        kind = f"of type {value.dtype}" if hasattr(value, "dtype") else "of numpy"
        kind += f", shape {shape}" if shape else ""
    if not kind:
        kind = "a function" if callable(value) else f"of type {type(value).__name__}"
    return f"{text} ({kind})"


def exactly_one_error(first: str, second: str, both: bool) -> ParameterError:
    """The error where both or neither of two names were given."""
    sentence = f"{first} and {second} are both given: give one of the two" if both else f"give {first} or {second}"
    return ParameterError(f"{first}, {second}", "both" if both else "neither", "exactly one of the two", sentence)


def unknown_name_error(name: str, value: Any, known: Iterable[str], kind: str) -> ParameterError:
    """The error where ``value`` is none of the ``known`` names; ``kind``: what they are names of, with its article."""
    names = ", ".join(known)
    return ParameterError(name, value, f"one of {names}", f"{name}: {value!r} is not {kind}; choose from {names}")


def check_names(name: str, values: Any, known: Collection[str], kind: str) -> tuple[str, ...]:
    """The names in ``values``, one or several; raises ParameterError for the first that is none of ``known``."""
    try:
        names = (values,) if isinstance(values, str) else tuple(values)
    except TypeError:  # not several
        names = (values,)
    for value in names:
        if not (isinstance(value, str) and value in known):
            raise unknown_name_error(name, value, known, kind)
    return names


class OutOfTableError(ParameterError):
    """A point lies outside the grid of a table: nothing is extrapolated."""

    def __init__(self, name: str, value: float, low: float, high: float) -> None:
        self.low, self.high = low, high
        super().__init__(name, f"{value:.6g}", f"within the table's range [{low:.6g}, {high:.6g}]")


class FileError(ViscorollError):
    """The file at ``path`` cannot be read as what was asked for, or cannot be written: ``problem`` says why."""

    def __init__(self, path: Any, problem: str) -> None:
        self.path, self.problem = path, problem
        super().__init__(f"{path}: {problem}")


class Interrupted(KeyboardInterrupt):
    """The user ended a run of blocks; what is done is kept, and the message says how to go on."""


class MissingDependencyError(ViscorollError):
    """A ``package`` that belongs to an ``extra`` of the installation is not there, or a program of no extra."""

    def __init__(self, package: str, extra: str | None) -> None:
        self.package, self.extra = package, extra
        super().__init__(f"{package} is not installed" + (f": pip install 'viscoroll[{extra}]'" if extra else ""))


class ConvergenceError(ViscorollError):
    """An iteration reached its cap; a defect of this package, please report the input."""


class ModelWarning(UserWarning):
    """The model is grossly at fault for a motion or a contact, a material was not measured at what a contact asks of
    it, or a file of measurements gives no units.  Every call is looked at; Python says the same words once for each
    line of a program, those on a material or a file are said once for each.
    """


class MotionStatus(IntEnum):
    """How a motion ended."""

    DONE = 0
    RESTED = 1
    STEP_LIMIT = 2
    STEP_TOO_SMALL = 3
    UNDECIDED = 4
    UNSTEADY = 5
    CAUGHT = 6

    @property
    def message(self) -> str:
        """In words."""
        return _MESSAGES[self]


_MESSAGES = (
    "reached the last output time",
    "|V| and R |omega| fell below the rest threshold",
    "the step limit was reached first: raise max_steps, shorten the motion or, unless a speed grows without bound,"
    " loosen rtol",
    "the step size fell to rounding level: the motion changes faster than time can be told there, by a gain, drag,"
    " speed or friction of extreme size, or for a tight rtol",
    "V and omega were both 0, where the law leaves two ways on: with mu > 2 kappa it may",
    "too slow for the added mass, which came to 1 + j or to half of that below 0",
    "caught in the imprint of its rest, which takes seven tenths of its energy",
)


def caller_level() -> int:
    """Frames up to the first one that is not of this package: the ``stacklevel`` of a warning."""
    import sys

    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "viscoroll":
        depth, frame = depth + 1, frame.f_back
    return depth
