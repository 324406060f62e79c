"""Results as text, CSV or netCDF, to standard output or whole into a file."""

from __future__ import annotations

import csv
import io
import json
import math
from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..results import column
from ..si.units import attributes as si_attributes
from ..symbols import attributes, meaning

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Sheet:
    """A result as a table: ``columns`` of equal length under ``heading`` lines.

    ``constants`` hold for all rows: a line of the text, columns of the CSV.  ``units``: of names that have one.
    """

    heading: tuple[str, ...]
    constants: dict[str, float]
    columns: dict[str, NDArray]
    units: dict[str, str] = field(default_factory=dict)

    def text(self) -> str:
        """Aligned columns with their units; a single row stands as lines with what each number means."""
        lines = [*self.heading]
        if self.constants:
            lines.append(
                ", ".join(f"{name} = {value:.10g}{self._unit(name)}" for name, value in self.constants.items())
            )
        lines.append("")
        cells = [[name, *map(_short, values.tolist())] for name, values in self.columns.items()]
        if len(cells[0]) == 2:
            lines += [f"{name:>11} = {value + self._unit(name):<18} {meaning(name)}".rstrip() for name, value in cells]
        else:
            units = [self.units.get(name, "") for name in self.columns]
            if any(units):
                cells = [[name, unit, *rest] for (name, *rest), unit in zip(cells, units, strict=True)]
            widths = [max(map(len, column)) for column in cells]
            lines += ["  ".join(map(str.rjust, row, widths)).rstrip() for row in zip(*cells, strict=True)]
        return "\n".join(lines) + "\n"

    def csv(self) -> str:
        """A row of names, with units in brackets, then numbers that read back to the same bits."""
        rows = len(next(iter(self.columns.values())))
        columns = [[value] * rows for value in self.constants.values()]
        columns += [_numeric(values).tolist() for values in self.columns.values()]
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        names = (*self.constants, *self.columns)
        writer.writerow([column(name, self.units.get(name, "")) for name in names])
        writer.writerows(zip(*columns, strict=True))
        return file.getvalue()

    def json(self) -> str:
        """Heading, constants, units and columns; numbers that read back to the same bits, null for NaN."""
        columns = {name: [_finite(value) for value in values.tolist()] for name, values in self.columns.items()}
        known = {name: unit for name, unit in self.units.items() if name in self.columns or name in self.constants}
        content = {"heading": self.heading, "constants": self.constants, "units": known, "columns": columns}
        return json.dumps(content, indent=1, allow_nan=False) + "\n"

    def _unit(self, name: str) -> str:
        return f" {self.units[name]}" if name in self.units else ""


def deliver(arguments: Namespace, sheet: Callable[[], Sheet], dataset: Callable[[], xr.Dataset]) -> None:
    """Print the sheet in the format asked for, or write it or the dataset in the format of the suffix.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    from ..files import write_dataset, write_text

    path: Path | None = arguments.output
    if path is None:
        made = sheet()
        print({"text": made.text, "csv": made.csv, "json": made.json}[arguments.format](), end="")
    elif path.suffix.lower() == ".nc":
        write_dataset(dataset(), path)
    else:
        write_text(path, sheet().csv() if is_csv(path) else sheet().text())


def is_csv(path: Path) -> bool:
    """Whether a file of this name holds CSV."""
    return path.suffix.lower() == ".csv"


def as_dataset(
    title: str,
    axes: dict[str, NDArray],
    values: dict[str, NDArray],
    constants: dict[str, float],
    units: dict[str, str],
) -> xr.Dataset:
    """``values`` over the tensor product of ``axes``, with names, units and provenance."""
    import xarray as xr

    def about(name: str) -> dict[str, Any]:
        return si_attributes(name) if name in units else attributes(name)

    dims = tuple(axes)
    data = {name: xr.Variable(dims, _numeric(array), about(name)) for name, array in values.items()}
    coordinates = {name: xr.Variable((name,), axis, about(name)) for name, axis in axes.items()}
    provenance = {"Conventions": "CF-1.11", "title": title, "source": f"viscoroll {__version__}"}
    return xr.Dataset(data, coordinates, provenance | constants)


def _numeric(array: NDArray) -> NDArray:
    return array.astype(np.int8) if array.dtype == bool else array


def _short(value: Any) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(int(value) if isinstance(value, bool) else value)


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
