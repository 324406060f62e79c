"""Results by their own tables and datasets: to standard output, or whole into a file."""

from __future__ import annotations

import json
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from ...core.files import write_dataset, write_text

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def show(arguments: Namespace, result: Any, heading: str = "") -> None:
    """A result by its ``to_xarray`` and ``to_pandas``, below its title or ``heading``; errors of :func:`deliver`."""
    import numpy as np

    data, frame = result.to_xarray(), result.to_pandas().reset_index()
    for name, each in data.items():
        if "flag_meanings" in each.attrs:  # what codes mean, by the conventions of CF
            meanings = each.attrs["flag_meanings"].split()
            frame[name] = frame[name].map(dict(zip(np.ravel(each.attrs["flag_values"]), meanings, strict=True)))
    if "equilibrium" in frame:
        frame = frame[np.isfinite(frame[[name for name in frame if name.partition(" ")[0] == "V"]]).all(axis=1)]
    if len(frame) == 1:
        frame = frame.drop(columns="state", errors="ignore")
    deliver(arguments, data, frame, heading or data.attrs["title"])


def deliver(arguments: Namespace, data: xr.Dataset, frame: pd.DataFrame, heading: str) -> None:
    """Print a table in the format asked for, or write it or the dataset in that of the suffix.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    path = arguments.output
    kind = arguments.format if path is None else path.suffix.lower()[1:]
    if kind == "nc":
        write_dataset(data, path)
        return
    if kind == "csv":
        text = frame.to_csv(index=False, lineterminator="\n")
    elif kind == "json":
        finite = frame.replace([float("inf"), -float("inf")], float("nan")).astype(object)
        text = json.dumps(finite.where(finite.notna(), None).to_dict("list"), indent=1, allow_nan=False) + "\n"
    else:
        text = as_text(frame, heading, {str(name): each.attrs.get("long_name", "") for name, each in data.items()})
    if path is None:
        print(text, end="")
    else:
        write_text(path, text)


def as_text(frame: pd.DataFrame, heading: str, meanings: dict[str, str] | None = None) -> str:
    """Aligned columns; a single row stands as lines, with what each number means; of no row the heading alone."""
    if frame.empty:
        return f"{heading}\n"
    if meanings is None or len(frame) != 1:
        return f"{heading}\n\n{frame.to_string(index=False, float_format='{:.10g}'.format, na_rep='')}\n"
    lines = []
    for name, value in frame.iloc[0].items():
        own, _, unit = str(name).partition(" ")
        shown = f"{value:.10g} {unit.strip('[]')}".rstrip() if isinstance(value, float) else str(value)
        lines.append(f"{own:>11} = {shown:<20} {meanings.get(own, '')}".rstrip())
    return "\n".join([heading, "", *lines, ""])
