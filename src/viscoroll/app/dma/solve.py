"""Storage and loss modulus from any two of storage, loss, tan delta and magnitude; a third is compared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...core.errors import FileError
from ...io.measurements import Numbers, Table

#: pair of names -> storage and loss from them, the pairs that lose the least first
PAIRS: dict[tuple[str, str], Callable[[Any, Any], tuple[Any, Any]]] = {
    ("storage", "loss"): lambda storage, loss: (storage, loss),
    ("storage", "tan delta"): lambda storage, tan: (storage, storage * tan),
    ("loss", "tan delta"): lambda loss, tan: (loss / tan, loss),
    ("modulus", "tan delta"): lambda whole, tan: (whole / np.hypot(1.0, tan), whole / np.hypot(1.0, tan) * tan),
    ("loss", "modulus"): lambda loss, whole: (np.sqrt(whole**2 - loss**2), loss),
    ("storage", "modulus"): lambda storage, whole: (storage, np.sqrt(whole**2 - storage**2)),
}
#: beside rounding, instruments average each quantity over cycles: a mean of ratios is off the ratio of means by parts
#: of a per cent
AVERAGED = 0.01
#: largest relative error of storage and loss that the rounding of the digits may make
_ROUNDED = 0.05


@np.errstate(all="ignore")  # what a pair leaves open is NaN or infinite, and refused
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
    storage, loss = PAIRS[pair](*(columns[name].values for name in pair))
    exact = {"storage": storage, "loss": loss, "tan delta": loss / storage, "modulus": np.hypot(storage, loss)}
    rounding = sum(columns[name].half / np.abs(columns[name].values) for name in pair)
    if pair[1] == "modulus":  # a difference of squares
        other = exact["loss" if pair[0] == "storage" else "storage"]
        rounding = rounding * (exact["modulus"] / other) ** 2
        refuse(table, rounding <= _ROUNDED, f"{' and '.join(pair)} leave the other modulus open: give tan delta too")
    for name in columns.keys() - set(pair):
        values, half = columns[name]
        agrees = np.abs(values - exact[name]) <= (AVERAGED + rounding) * np.abs(exact[name]) + half
        refuse(table, agrees, f"{name} contradicts {' and '.join(pair)}")
    return storage, loss


def refuse(table: Table, holds: Any, problem: str) -> None:
    """Raise FileError with the line of the first row where something does not hold."""
    if not holds.all():
        raise FileError(table.path, f"line {table.lines[int(np.argmin(holds))]}: {problem}")
