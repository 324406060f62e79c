"""Results as text, CSV or netCDF, to standard output or whole into a file."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import __version__
from ..symbols import attributes, meaning

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Sheet:
    """A result as a table: ``columns`` of equal length under ``heading`` lines.

    ``constants`` hold for all rows: a line of the text, columns of the CSV.
    """

    heading: tuple[str, ...]
    constants: dict[str, float]
    columns: dict[str, NDArray]

    def text(self) -> str:
        """Aligned columns; a single row stands as lines with what each number means."""
        lines = [*self.heading, ", ".join(f"{name} = {value:.10g}" for name, value in self.constants.items()), ""]
        cells = [[name, *map(_short, values.tolist())] for name, values in self.columns.items()]
        if len(cells[0]) == 2:
            lines += [f"{name:>11} = {value:<18} {meaning(name)}".rstrip() for name, value in cells]
        else:
            widths = [max(map(len, column)) for column in cells]
            lines += ["  ".join(map(str.rjust, row, widths)) for row in zip(*cells, strict=True)]
        return "\n".join(lines) + "\n"

    def csv(self) -> str:
        """A row of names, then numbers that read back to the same bits."""
        rows = len(next(iter(self.columns.values())))
        columns = [[value] * rows for value in self.constants.values()]
        columns += [_numeric(values).tolist() for values in self.columns.values()]
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*self.constants, *self.columns])
        writer.writerows(zip(*columns, strict=True))
        return file.getvalue()


def deliver(path: Path | None, sheet: Callable[[], Sheet], dataset: Callable[[], xr.Dataset]) -> None:
    """Print the sheet as text, or write it or the dataset in the format of the suffix.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    from ..files import write_dataset, write_text

    if path is None:
        print(sheet().text(), end="")
    elif path.suffix == ".nc":
        write_dataset(dataset(), path)
    else:
        write_text(path, sheet().csv() if path.suffix == ".csv" else sheet().text())


def as_dataset(
    title: str, axes: dict[str, NDArray], values: dict[str, NDArray], constants: dict[str, float]
) -> xr.Dataset:
    """``values`` over the tensor product of ``axes``, with names, units and provenance."""
    import xarray as xr

    dims = tuple(axes)
    data = {name: xr.Variable(dims, _numeric(array), attributes(name)) for name, array in values.items()}
    coordinates = {name: xr.Variable((name,), axis, attributes(name)) for name, axis in axes.items()}
    provenance = {"Conventions": "CF-1.11", "title": title, "source": f"viscoroll {__version__}"}
    return xr.Dataset(data, coordinates, provenance | constants)


def _numeric(array: NDArray) -> NDArray:
    return array.astype(np.int8) if array.dtype == bool else array


def _short(value: Any) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(int(value) if isinstance(value, bool) else value)
