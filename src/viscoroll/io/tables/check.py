"""The file of a law against the formulas of its modes, and a grid against the rows of the law: rows of a report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ... import __version__
from ...core.checks import check_integer
from ...core.errors import FileError
from ...materials.law.netcdf import parse_axis, parse_law
from ...materials.law_file import AXIS, KIND, dataset_content, stated_errors
from ...scene import Scene
from . import schema
from .build import RELATIVE, differences, errors_at, random_points
from .law import measured_errors
from .store import is_law

if TYPE_CHECKING:
    import xarray as xr

#: Largest difference of a node of a grid from the rows, relative or over the largest of its field: M as printed is
#: good to 9e-14 at kappa V = 100 (kernels/printed/law.py).
NODES_ALLOWED = 1e-12
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

    Of a grid compare every node with the rows of the law, and splines at ``count`` random points in random cells.

    Parameters
    ----------
    table : of :func:`viscoroll.io.tables.law`, of :func:`viscoroll.io.tables.build` for a scene of one relaxation
        time, or of :func:`viscoroll.io.tables.load`.
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
        A grid that is of a material or a cylinder.
    """
    count, seed = check_integer("n", count, 1), check_integer("seed", seed, 0)
    source = table.encoding.get("source", "table")
    if not is_law(table):
        return _check_grid(table, count, seed, source)
    content = dataset_content(table)
    read = parse_axis if content.attributes[KIND] == AXIS else parse_law
    found = measured_errors(read(content, source), count, seed)
    return [
        Check(
            f"{table.attrs['title']}: {name}", found[name],
            ALLOWANCE * stated + ROUNDING,
            f"relative; {count} places, against the formulas of the modes",
        )
        for name, stated in stated_errors(table).items()
    ]  # fmt: skip


def _check_grid(table: xr.Dataset, count: int, seed: int, source: str) -> list[Check]:
    """Rows for the nodes of a grid and for the splines between them, two a field; raises FileError."""
    schema.check(table, source)
    if table.attrs[schema.KIND] != "grid" or not {"kappa", "mu"} <= table.attrs.keys() or "material" in table.attrs:
        raise FileError(source, "is no grid of a scene with an alpha, and states its errors by itself")
    scene = Scene(alpha=table.attrs.get("alpha", 1.0), kappa=table.attrs["kappa"], mu=table.attrs["mu"])
    nodes = differences(table, scene)
    between = errors_at(table, scene, random_points(table, count, seed))
    checks = []
    for name in schema.fields_of(table):
        kind = "relative" if name in RELATIVE else "over the largest"
        checks.append(Check(f"grid: {name}, nodes", nodes[name], NODES_ALLOWED, f"{kind}; all, against rows"))
        stated = ALLOWANCE * float(table[name].attrs["spline_error"]) + ROUNDING
        found = float(np.max(between[name]))
        checks.append(Check(f"grid: {name}, splines", found, stated, f"absolute; {count} points, against rows"))
    return checks
