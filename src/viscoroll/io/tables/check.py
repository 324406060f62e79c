"""Checks of tables: the file of a law against the formulas of its modes, a grid against the rows of the law.

The rows of a law are its polynomials, one for each octave of speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ... import __version__
from ...core.checks import check_integer
from ...core.errors import FileError
from ...materials.law.netcdf import parse_axis, parse_law
from ...materials.law_file import AXIS, COUPLED, COVER, KIND, LAW, dataset_content, stated_errors
from ...scene import Scene
from . import schema
from .build import RELATIVE_FIELDS, differences, errors_at, random_points
from .law import COUPLED_POINTS, measured_errors
from .store import is_law

if TYPE_CHECKING:
    import xarray as xr

#: Largest allowed difference of a node of a grid from the rows, relative or divided by the largest value of its field:
#: M as printed has an error of 9e-14 at kappa V = 100 (kernels/printed/law.py).
NODES_ALLOWED = 1e-12
#: Ratio by which the error in a random sample may exceed the stated error, which is the largest of another sample.
SAMPLE_RATIO = 2.0
#: Largest allowed error of the splines of a grid, divided by the largest value of the field, whatever the grid states:
#: a bound beyond the range of the field would allow anything.
_MOST_ALLOWED = 0.5
#: The same of a table of the coupled solution, whose stated errors are those of some tens of points.
_COUPLED_RATIO = 8.0
#: Kind of the file of a law -> points at which it is checked, and the reference.
_REFERENCES = {
    LAW: "points, against the formulas of the modes",
    AXIS: "points shared by the alphas, against the formulas of the modes",
    COVER: "speeds, against solves with more terms",
    COUPLED: "points, against states of the coupled solution",
}
#: Rounding error of a value, added to the stated error.
ROUNDING = 2e-15


class Check(NamedTuple):
    """A largest difference and its bound.

    name : name of the check.
    measured, allowed : largest difference and its bound, in the unit that ``meaning`` states.
    meaning : words: relative or absolute, at which points, against which reference.
    """

    name: str
    measured: float
    allowed: float
    meaning: str

    @property
    def passed(self) -> bool:
        """Whether the difference is within the bound; a NaN is not."""
        return bool(self.measured <= self.allowed)


@dataclass(frozen=True)
class Report:
    """All checks of a validation, and the settings it ran with.

    checks : the checks, :class:`Check` each, at least one.
    settings : name of a setting, as "seed" -> number; only printed.
    """

    checks: tuple[Check, ...]
    settings: dict[str, int]

    @property
    def ok(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    def __str__(self) -> str:
        """Return a table in words: a heading, a line for each check, a blank line, the verdict, version and settings.

        The line of a check has its name, the measured and the allowed difference, "ok" or "EXCEEDED", and the meaning.
        The verdict is the number of checks whose difference is beyond what is allowed or NaN, or that there is none.
        Raises ValueError without checks.
        """
        width = max(len(check.name) for check in self.checks)
        lines = [
            f"{c.name:<{width}} {c.measured:9.2e} {c.allowed:9.2e}  {'ok' if c.passed else 'EXCEEDED':<8}  {c.meaning}"
            for c in self.checks
        ]
        failed = sum(not check.passed for check in self.checks)
        verdict = f"{failed} beyond what is allowed" if failed else "every difference is within what is allowed"
        settings = ", ".join(f"{name} {value}" for name, value in self.settings.items())
        return "\n".join([
            f"{'check':<{width}}  measured   allowed            of what", *lines, "",
            f"{len(self.checks)} checks: {verdict}.", f"viscoroll {__version__}; {settings}",
        ])  # fmt: skip


def check_table(table: xr.Dataset, count: int, seed: int) -> list[Check]:
    """Check a table by numbers that were not used to make it, and return a :class:`Check` for each difference.

    The law of half-spaces, or the laws of random alphas, are compared with the formulas of the modes at random speeds;
    the law of a layer with solves of the contact (:func:`.law.measured_errors`).  Of a grid every node is compared with
    the rows of the law, and the splines at random points in random cells.

    Parameters
    ----------
    table : dataset of :func:`viscoroll.io.tables.law`, of :func:`viscoroll.io.tables.build` for a scene of one
        relaxation time, or of :func:`viscoroll.io.tables.load`.
    count : number of random points, >= 1; of a layer that of the speeds, of every alpha as of
        :func:`.law.measured_errors`.
    seed : seed of the random points, >= 0.

    Returns
    -------
    list of Check
        Of a law one for each function: the largest error, dimensionless, of the kind that :func:`.law.measured_errors`
        states; allowed are the error that the file states times :data:`SAMPLE_RATIO` plus :data:`ROUNDING`.  Of a grid
        two for each field: its nodes, then its splines (:func:`_check_grid`).

    Raises
    ------
    ParameterError
        A count or seed out of range or no whole number; the law of a layer whose solve finds no contact length.
    FileError
        A grid of a material or a cylinder, a dataset that is no table, or a law that is incomplete.
    KeyError
        A law without a title or a stated error, or a field of a grid without the attribute ``spline_error``.
    """
    count, seed = check_integer("n", count, 1), check_integer("seed", seed, 0)
    source = table.encoding.get("source", "table")
    if not is_law(table):
        return _check_grid(table, count, seed, source)
    content = dataset_content(table)
    kind = content.attributes[KIND]
    read = parse_axis if kind == AXIS else parse_law
    count = min(count, COUPLED_POINTS) if kind == COUPLED else count
    ratio = _COUPLED_RATIO if kind == COUPLED else SAMPLE_RATIO
    errors = measured_errors(read(content, source), count, seed)
    meaning = f"{'absolute' if kind == COUPLED else 'relative'}; {count} {_REFERENCES[kind]}"
    return [
        Check(f"{table.attrs['title']}: {name}", errors[name], ratio * stated + ROUNDING, meaning)
        for name, stated in stated_errors(table).items()
    ]


def _check_grid(table: xr.Dataset, count: int, seed: int, source: str) -> list[Check]:
    """Compare a grid with the rows of the law: two checks for each field, of its nodes and of the splines between them.

    table: dataset of a grid; attributes kappa and mu, and alpha unless it is an axis.
    count: number of random points, >= 1.
    seed: seed of these points, >= 0.
    source: path of the grid, for messages.
    Returns a flat list of 2 times as many :class:`Check` as the grid has fields: nodes and splines of the first field
    ("beta"), nodes and splines of the second, and so on.

    - "grid: NAME, nodes": the largest difference over all nodes (:func:`.build.differences`), dimensionless: of lam,
      zeta and delta_star relative at each node, of the other fields divided by their largest magnitude.  Allowed are
      1e-12.
    - "grid: NAME, splines": the largest error at ``count`` random points, absolute, in the unit of the field.  Allowed
      are 2 times the ``spline_error`` that the grid states, plus 2e-15, and at most half of the largest magnitude of
      the field at the nodes, unless that is 0.

    Raises FileError for what is no grid, and for a grid that is not of a scene with an alpha (of a cylinder, a
    material, or of version 0.1.0); KeyError for a field without ``spline_error``.
    """
    schema.check(table, source)
    if table.attrs[schema.KIND] != "grid" or not {"kappa", "mu"} <= table.attrs.keys() or "material" in table.attrs:
        raise FileError(source, "is not a grid of a scene with an alpha: only such grids can be compared with the law")
    scene = Scene(alpha=table.attrs.get("alpha", 1.0), kappa=table.attrs["kappa"], mu=table.attrs["mu"])
    nodes = differences(table, scene)
    splines = errors_at(table, scene, random_points(table, count, seed))
    checks = []
    for name in schema.fields_of(table):
        kind = "relative" if name in RELATIVE_FIELDS else "divided by the largest"
        checks.append(Check(f"grid: {name}, nodes", nodes[name], NODES_ALLOWED, f"{kind}; all, against rows"))
        most = _MOST_ALLOWED * float(np.abs(table[name]).max()) or np.inf
        allowed = min(SAMPLE_RATIO * float(table[name].attrs["spline_error"]) + ROUNDING, most)
        meaning = f"absolute; {count} points, against rows"
        checks.append(Check(f"grid: {name}, splines", float(np.max(splines[name])), allowed, meaning))
    return checks
