"""Storage and loss modulus from any two of storage, loss, tan delta and magnitude; a third is compared."""

from __future__ import annotations

import numpy as np

from ...core.errors import FileError
from ...core.typed import Floats
from ...io.measurements import Numbers, Table

#: two of these give the others, the pairs that lose the least first
PAIRS = (
    ("storage", "loss"), ("storage", "tan delta"), ("loss", "tan delta"), ("modulus", "tan delta"),
    ("loss", "modulus"), ("storage", "modulus"),
)  # fmt: skip
#: beside rounding, instruments average each quantity over cycles: a mean of ratios is off the ratio of means by parts
#: of a per cent
AVERAGED = 0.01
#: largest relative error of storage and loss that the rounding of the digits may make
_ROUNDED = 0.05


def solved(a: str, b: str, first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Storage and loss from two of the four, named ``a`` and ``b`` as in :data:`PAIRS`; NaN where there is none."""
    with np.errstate(invalid="ignore", divide="ignore"):
        if (a, b) == ("storage", "loss"):
            return first, second
        if (a, b) == ("storage", "tan delta"):
            return first, first * second
        if (a, b) == ("loss", "tan delta"):
            return first / second, first
        if (a, b) == ("modulus", "tan delta"):
            storage = first / np.hypot(1.0, second)
            return storage, storage * second
        other = np.sqrt(second**2 - first**2)
        return (other, first) if a == "loss" else (first, other)


def spread(a: str, b: str, first: Numbers, second: Numbers) -> tuple[Floats, Floats]:
    """By how much storage and loss may be off for the rounding of the digits of both, shape (n,) each."""
    storage, loss = solved(a, b, first.values, second.values)
    off = np.zeros((2, storage.size))
    for moved in (
        solved(a, b, first.values + first.half, second.values),
        solved(a, b, first.values, second.values + second.half),
    ):
        off += np.abs(np.array(moved) - (storage, loss))
    return off[0], off[1]


def storage_and_loss(table: Table, pair: tuple[str, str], columns: dict[str, Numbers]) -> tuple[Floats, Floats]:
    """Storage and loss from a pair of columns; all others must agree with them.

    Parameters
    ----------
    table : of which the columns are, for what is refused.
    pair : two of them.
    columns : storage, loss, tan delta, modulus -> numbers, those that the file has.

    Raises
    ------
    FileError
        A third column contradicts; the digits of the file leave storage or loss uncertain by more than 5 %.
    """
    a, b = pair
    storage, loss = solved(a, b, columns[a].values, columns[b].values)
    off = spread(a, b, columns[a], columns[b])
    if pair[1] == "modulus":
        bad = ~((off[0] <= _ROUNDED * storage) & (off[1] <= _ROUNDED * loss))
        if bad.any():
            line = table.lines[int(np.argmax(bad))]
            raise FileError(
                table.path, f"line {line}: {a} and {b} leave the other modulus open: give tan delta beside them"
            )
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = loss / storage
        exact = {"storage": (storage, off[0]), "loss": (loss, off[1])}
        exact["tan delta"] = ratio, (off[1] + np.abs(ratio) * off[0]) / np.abs(storage)
        exact["modulus"] = np.hypot(storage, loss), off[0] + off[1]
    for name in columns.keys() - set(pair):
        value, rounding = exact[name]
        differs = ~(np.abs(columns[name].values - value) <= AVERAGED * np.abs(value) + rounding + columns[name].half)
        if differs.any():
            n = int(np.argmax(differs))
            found = f"{name} is {columns[name].values[n]:.4g}, but {value[n]:.4g} by {a} and {b}"
            raise FileError(table.path, f"line {table.lines[n]}: columns contradict each other: {found}")
    return storage, loss
