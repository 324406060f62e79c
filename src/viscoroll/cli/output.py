"""Results as text, CSV or netCDF, to standard output or whole into a file."""

from __future__ import annotations

import csv
import io
import json
import math
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..results import column, unit_of
from ..symbols import meaning

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
        columns += [values.tolist() for values in self.columns.values()]
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


def deliver(arguments: Namespace, result: Any, heading: Sequence[str] = ()) -> None:
    """A result of the package by its own dataset: as :func:`put`, below its title, or ``heading`` where it has one."""
    data = result.to_xarray()
    put(arguments, lambda: sheet_of(data, heading), lambda: data)


def put(arguments: Namespace, sheet: Callable[[], Sheet], dataset: Callable[[], xr.Dataset]) -> None:
    """Print the sheet in the format asked for, or write it or the dataset in the format of the suffix.

    Raises
    ------
    FileError
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


def sheet_of(data: xr.Dataset, heading: Sequence[str] = ()) -> Sheet:
    """A row for each place of the axes that most quantities lie over, but where V is NaN; the single ones above."""
    import xarray as xr

    over = max((each.dims for each in data.values()), key=len)
    data = data.assign_coords({dim: np.arange(data.sizes[dim]) + 1 for dim in over if dim not in data.coords})
    names = [*over, *(name for name in data.variables if name not in over and set(data[name].dims) <= set(over))]
    single = [name for name in names if over and not data[name].dims]
    listed = [name for name in names if name not in single]
    full = xr.broadcast(*(data[name] for name in listed))
    columns = {str(name): _words(each.transpose(*over)).ravel() for name, each in zip(listed, full, strict=True)}
    if "equilibrium" in over:
        held = np.isfinite(columns["V"])
        columns = {name: values[held] for name, values in columns.items()}
    constants = {str(name): data[name].item() for name in single}
    units = {str(name): unit for name in names if (unit := unit_of(data[name].attrs))}
    return Sheet(tuple(heading) or (data.attrs["title"],), constants, columns, units)


def _words(values: xr.DataArray) -> NDArray:
    """What codes mean, by the conventions of CF; other values as they are."""
    about = values.attrs
    if "flag_meanings" not in about:
        return np.asarray(values.values)
    meanings = dict(zip(np.ravel(about["flag_values"]).tolist(), about["flag_meanings"].split(), strict=True))
    return np.array([meanings[code] for code in values.values.ravel().tolist()]).reshape(values.shape)


def _short(value: Any) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(int(value) if isinstance(value, bool) else value)


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
