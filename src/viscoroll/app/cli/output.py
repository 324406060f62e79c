"""Output of results: their tables on standard output, or a complete file of a table or dataset."""

from __future__ import annotations

import json
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from ...core.files import write_dataset, write_text

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def show(arguments: Namespace, result: Any, heading: str = "") -> None:
    """Print or write a result by its ``to_xarray`` and ``to_pandas``.

    In the table codes, as those of regimes, are replaced by their meanings, and rows of equilibria that a load does not
    have (V is NaN) are left out; of a single row the column "state" is left out.  The dataset, for a .nc file, stays as
    it is.

    arguments: parsed command line with output and format, as of :func:`deliver`.
    result: a result of the library that has both methods, as of ``contact``, ``roll`` or ``steady``.
    heading: first lines of the text, which csv and json do not have; "": the title of the data.
    Raises FileError if the file cannot be written.
    """
    import numpy as np

    data, frame = result.to_xarray(), result.to_pandas().reset_index()
    for name, variable in data.items():
        if "flag_meanings" in variable.attrs:  # codes and their meanings, by the CF conventions
            meanings = variable.attrs["flag_meanings"].split()
            frame[name] = frame[name].map(dict(zip(np.ravel(variable.attrs["flag_values"]), meanings, strict=True)))
    if "equilibrium" in frame:  # a load with fewer equilibria than another has NaN in the rest
        frame = frame[np.isfinite(frame.filter(regex=r"^V( |$)")).all(axis=1)]
    if len(frame) == 1:
        frame = frame.drop(columns="state", errors="ignore")
    deliver(arguments, data, frame, heading or data.attrs["title"])


def deliver(arguments: Namespace, data: xr.Dataset, frame: pd.DataFrame, heading: str) -> None:
    """Print a table in the required format, or write it or the dataset in the format of the suffix.

    In json, an object of column -> list, numbers that are not finite are null.

    arguments: parsed command line with
        output, a path that ends in .txt, .csv or .nc and is written, or None: standard output;
        format of standard output, "text", "csv" or "json"; not used with a path.
    data: dataset for netCDF, whose ``long_name`` are the meanings of the variables in the text.
    frame: pandas DataFrame, the same as a table, one row for each state.
    heading: first lines of the text; csv and json have none.
    Raises FileError if the file cannot be written.
    """
    path = arguments.output
    suffix = arguments.format if path is None else path.suffix.lower()[1:]
    if suffix == "nc":
        write_dataset(data, path)
        return
    if suffix == "csv":
        text = frame.to_csv(index=False, lineterminator="\n")
    elif suffix == "json":
        finite = frame.replace([float("inf"), -float("inf")], float("nan")).astype(object)
        text = json.dumps(finite.where(finite.notna(), None).to_dict("list"), indent=1, allow_nan=False) + "\n"
    else:
        meanings = {str(name): variable.attrs.get("long_name", "") for name, variable in data.items()}
        text = as_text(frame, heading, meanings)
    if path is None:
        print(text, end="")
    else:
        write_text(path, text)


def as_text(frame: pd.DataFrame, heading: str, meanings: dict[str, str] | None = None) -> str:
    """Return a table as aligned columns below a heading, or a single row as one line for each number.

    frame: pandas DataFrame, the table, whose columns are called "NAME [UNIT]"; without rows the heading stands alone.
    heading: first lines.
    meanings: name of a column without its unit -> meaning, which stands after its number where the table has a single
        row; None: a single row is written as columns too.
    Returns the text, which ends with a line break; numbers have ten digits, and missing ones of columns are blank.
    """
    if frame.empty:
        return f"{heading}\n"
    if meanings is None or len(frame) != 1:
        return f"{heading}\n\n{frame.to_string(index=False, float_format='{:.10g}'.format, na_rep='')}\n"
    lines = []
    for column, value in frame.iloc[0].items():
        name, _, unit = str(column).partition(" ")
        number = f"{value:.10g} {unit.strip('[]')}".rstrip() if isinstance(value, float) else str(value)
        lines.append(f"{name:>11} = {number:<20} {meanings.get(name, '')}".rstrip())
    return "\n".join([heading, "", *lines, ""])
