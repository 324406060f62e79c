"""The file of a law against the formulas of its modes: rows of a report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from ... import __version__
from ...core.checks import whole
from ...core.errors import FileError
from ...materials.law_file import axis_of, law_of
from ...materials.law_store import AXIS, KIND, content_of, errors_of
from .law import measured_errors
from .store import is_law

if TYPE_CHECKING:
    import xarray as xr

#: The stated error is the largest of a sample; of 10^5 others it may be a few roundings more.
ALLOWANCE, ROUNDING = 2.0, 2e-15


class Check(NamedTuple):
    """A largest difference, and what is allowed; ``meaning`` says of what, in which unit, and where."""

    name: str
    measured: float
    allowed: float
    meaning: str

    @property
    def passed(self) -> bool:
        """Whether the difference is within what is allowed; a NaN is not."""
        return bool(self.measured <= self.allowed)


@dataclass(frozen=True)
class Report:
    """All checks of a a validation, and the settings it ran with."""

    checks: tuple[Check, ...]
    settings: dict[str, int]

    @property
    def ok(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    def __str__(self) -> str:
        width = max(len(check.name) for check in self.checks)
        lines = [
            f"{c.name:<{width}} {c.measured:9.2e} {c.allowed:9.2e}  {'ok' if c.passed else 'EXCEEDED':<8}  {c.meaning}"
            for c in self.checks
        ]
        failed = sum(not check.passed for check in self.checks)
        verdict = f"{failed} beyond what is allowed" if failed else "every difference is within what is allowed"
        settings = ", ".join(f"{name} {value}" for name, value in self.settings.items())
        foot = ["", f"{len(self.checks)} checks: {verdict}.", f"viscoroll {__version__}; {settings}"]
        return "\n".join([f"{'check':<{width}}  measured   allowed            of what", *lines, *foot])


def check_table(table: xr.Dataset, count: int, seed: int) -> list[Check]:
    """Compare a law, or those of random alphas, with the formulas of its modes at ``count`` random places.

    Parameters
    ----------
    table : of :func:`viscoroll.io.tables.law`, or of :func:`viscoroll.io.tables.load`.
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
    count, seed = whole("n", count, 1), whole("seed", seed, 0)
    source = table.encoding.get("source", "table")
    if not is_law(table):
        raise FileError(source, "is no law file (viscoroll tables law): grids state their errors when they are built")
    content = content_of(table)
    read = axis_of if content.attributes[KIND] == AXIS else law_of
    found = measured_errors(read(content, source), count, seed)
    return [
        Check(
            f"{table.attrs['title']}: {name}", found[name],
            ALLOWANCE * stated + ROUNDING,
            f"relative; {count} places, against the formulas of the modes",
        )
        for name, stated in errors_of(table).items()
    ]  # fmt: skip
