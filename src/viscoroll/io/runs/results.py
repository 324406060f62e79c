"""A finished store as a result: :func:`open_run`, which says itself, and gives datasets, tables and figures."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import FileError, MotionStatus
from ...core.extras import import_extra
from ...core.results import Result, SummaryRow, column_name, unit_of
from .store import MOTIONS, problems
from .verify import start_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_PARTS = ("mean", "std", "min", "max")


class RunResults(Result):
    """Results of a run in a folder; what :func:`open_run` gives back.

    Attributes
    ----------
    path : the folder.
    summaries : dataset over t, quantile and the bins of each quantity, as ``xarray.open_zarr(path)``.
    """

    def __init__(self, path: Path, summaries: xr.Dataset) -> None:
        self.path, self.summaries = path, summaries

    def __len__(self) -> int:
        """Number of motions."""
        return int(self.summaries.attrs["motions"])

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that were summed up."""
        return tuple(str(name).removesuffix("_mean") for name in self.summaries if str(name).endswith("_mean"))

    @property
    def run_file(self) -> str:
        """The text of the run file."""
        return str(self.summaries.attrs["run_file"])

    def motions(self) -> xr.Dataset:
        """Every motion with its inputs, over (motion, t), read as it is needed.

        Raises
        ------
        FileError
            Where the run kept summaries alone.
        """
        import xarray as xr

        if not (self.path / MOTIONS).is_dir():
            raise FileError(self.path, 'holds no motions, summaries alone: run it with keep = "all"')
        return xr.open_zarr(self.path, group=MOTIONS, chunks=None)

    def to_xarray(self) -> xr.Dataset:
        """The summaries: moments, quantiles, histograms, and how the motions ended."""
        return self.summaries

    def to_pandas(self) -> pd.DataFrame:
        """A row for each quantity and time: mean, std, min, max, and a column for each quantile.

        What has a unit bears it in its name, as "V [m s-1]", the first level of the index.
        """
        import pandas as pd

        data, tables = self.summaries, []
        time = column_name("t", unit_of(data["t"].attrs))
        for name in self.names:
            columns: dict[Any, Any] = {part: np.atleast_1d(data[f"{name}_{part}"].values) for part in _PARTS}
            quantiles = zip(data["quantile"].values, data[f"{name}_quantiles"].values, strict=True)
            columns |= {float(level): np.atleast_1d(values) for level, values in quantiles}
            t = data["t"].values if data[f"{name}_mean"].ndim else [np.nan]
            named = column_name(name, unit_of(data[f"{name}_mean"].attrs))
            tables.append(pd.DataFrame(columns, pd.MultiIndex.from_product([[named], t], names=["quantity", time])))
        return pd.concat(tables)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        data = self.summaries
        t, about = data["t"], data.attrs
        rows = [
            SummaryRow("path", str(self.path)),
            SummaryRow("drawn by", f"{about['design']}, seed {about['seed']}"),
            SummaryRow("t", f"{t.size} times to {float(t[-1]):.6g}", unit_of(t.attrs)),
        ]
        for name in self.names:
            mean, std = (np.atleast_1d(data[f"{name}_{part}"].values)[-1] for part in ("mean", "std"))
            at = "at the end: " if data[f"{name}_mean"].ndim else ""
            rows.append(SummaryRow(name, f"{at}mean {mean:.6g}, std {std:.3g}", unit_of(data[f"{name}_mean"].attrs)))
        ended = zip(data["status"].values, data["ended"].values, strict=True)
        rows += [SummaryRow("ended", f"{count}: {MotionStatus(code).message}") for code, count in ended if count]
        kept = "every motion" if (self.path / MOTIONS).is_dir() else "summaries"
        return f"Results of a run of {len(self)} motions", [*rows, SummaryRow("kept", kept)]


def open_run(path: str | PathLike[str]) -> RunResults:
    """The results of a finished run.

    Parameters
    ----------
    path : folder of the results, of :func:`run_ensemble` or ``viscoroll ensemble``.

    Returns
    -------
    RunResults
        It prints itself, and has ``to_xarray``, ``to_pandas``, ``plot`` and ``motions``.

    Raises
    ------
    FileError
        If there is no results store, it is not finished, or its summaries are damaged.
    MissingDependencyError
        If zarr is not installed.
    """
    import xarray as xr

    import_extra("zarr", "zarr", "runs")
    root = Path(path)
    start = start_of(root)
    if found := problems(root, "end", start.run, start.motions):
        raise FileError(path, f"{found[0]} is missing or damaged: the same `viscoroll ensemble` command puts it right")
    return RunResults(root, xr.open_zarr(root, chunks=None))
