"""Storage and loss modulus from any two of storage, loss, tan delta and magnitude; a third is compared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...io.measurements import Numbers, Table

#: pair of quantities -> function of both that returns storage and loss, the pairs that lose the fewest digits first
PAIRS: dict[tuple[str, str], Callable[[Any, Any], tuple[Any, Any]]] = {
    ("storage", "loss"): lambda storage, loss: (storage, loss),
    ("storage", "tan delta"): lambda storage, tan: (storage, storage * tan),
    ("loss", "tan delta"): lambda loss, tan: (loss / tan, loss),
    ("modulus", "tan delta"): lambda whole, tan: (whole / np.hypot(1.0, tan), whole / np.hypot(1.0, tan) * tan),
    ("loss", "modulus"): lambda loss, whole: (np.sqrt(whole**2 - loss**2), loss),
    ("storage", "modulus"): lambda storage, whole: (storage, np.sqrt(whole**2 - storage**2)),
}
#: relative difference of quantities that agree, beside rounding: instruments average each quantity over cycles, and a
#: mean of ratios is off the ratio of means by parts of a per cent
AVERAGED = 0.01
#: largest relative error of storage and loss that the rounding of the digits may cause
_ROUNDED = 0.05


@np.errstate(all="ignore")  # where a pair has no solution there is NaN or infinity, which is refused
def storage_and_loss(table: Table, pair: tuple[str, str], columns: dict[str, Numbers]) -> tuple[Floats, Floats]:
    """Return storage and loss from two measured quantities, after a check that all others agree with them.

    table : :class:`Table`, the table that has the columns; its lines are named in the error message.
    pair : the two quantities, a key of :data:`PAIRS`; both are in ``columns``.
    columns : quantity ("storage", "loss", "tan delta", "modulus") -> :class:`Numbers`, values and half a unit of their
        last digits, (n,) each, of those that the file has; all in Pa or all in 1/Pa, tan delta dimensionless.
    Returns (storage, loss), (n,) each, in the unit of the columns: compliances of compliances.  Signs are not checked
    here: a negative or infinite value stays.
    Raises FileError, with the line, where a further column differs by more than 1 % beside the rounding of all three;
    of a pair of a magnitude and storage or loss also where the magnitude is not above the other, or where the digits of
    the file leave the modulus that is computed uncertain by more than 5 %.
    """
    storage, loss = PAIRS[pair](*(columns[name].values for name in pair))
    exact = {"storage": storage, "loss": loss, "tan delta": loss / storage, "modulus": np.hypot(storage, loss)}
    rounding = sum(columns[name].half / np.abs(columns[name].values) for name in pair)
    both = " and ".join(pair)
    if pair[1] == "modulus":  # a difference of squares
        other = exact["loss" if pair[0] == "storage" else "storage"]
        rounding = rounding * (exact["modulus"] / other) ** 2
        table.require(rounding <= _ROUNDED, f"{both} do not determine the other modulus: give tan delta too")
    for name in columns.keys() - set(pair):
        values, half = columns[name]
        agrees = np.abs(values - exact[name]) <= (AVERAGED + rounding) * np.abs(exact[name]) + half
        advice = "give its unit by units=, or remove one of the columns"
        table.require(agrees, f"{name} contradicts {both}: {advice}")
    return storage, loss
