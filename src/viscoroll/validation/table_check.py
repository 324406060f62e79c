"""The file of a law against the formulas of its modes, or of every alpha against root solves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import FileError, ParameterError
from ..materials.law_axis_file import axis_of
from ..materials.law_file import law_of
from ..materials.law_store import AXIS, KIND, content_of, errors_of
from ..tables import axis
from ..tables.law import measured_errors
from ..tables.store import is_law
from .report import Check

if TYPE_CHECKING:
    import xarray as xr

#: The stated error is the largest of a sample; of 10^5 others it may be a few roundings more.
ALLOWANCE, ROUNDING = 2.0, 2e-15


def check_table(table: xr.Dataset, count: int, seed: int) -> list[Check]:
    """Compare a law with the formulas of its modes, of every alpha with root solves, at ``count`` random places.

    Parameters
    ----------
    table : of :func:`viscoroll.tables.law`, or of :func:`viscoroll.tables.load`.
    count : >= 1.
    seed : of the random places, >= 0.

    Returns
    -------
    list of Check
        One a function: the largest relative error against that which the file states, times :data:`ALLOWANCE`.

    Raises
    ------
    ParameterError
        A count or seed out of range.
    FileError
        A table that is no law: a grid states its errors when it is built.
    """
    if count < 1:
        raise ParameterError("n", count, "a whole number >= 1")
    if seed < 0:
        raise ParameterError("seed", seed, "a whole number >= 0")
    source = table.encoding.get("source", "table")
    if not is_law(table):
        raise FileError(source, "is no law file (viscoroll tables law): grids state their errors when they are built")
    content, against = content_of(table), "the formulas of the modes"
    if content.attributes[KIND] == AXIS:
        found, against = axis.measured_errors(axis_of(content, source), count, seed), "root solves"
    else:
        found = measured_errors(law_of(content, source), count, seed)
    return [
        Check(
            f"{table.attrs['title']}: {name}", found[name],
            ALLOWANCE * stated + ROUNDING,
            f"relative; {count} places, against {against}",
        )
        for name, stated in errors_of(table).items()
    ]  # fmt: skip
