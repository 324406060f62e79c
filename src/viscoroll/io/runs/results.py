"""A finished store as a result that prints itself and gives datasets, tables and figures: :func:`open_run`."""

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

#: Moments of a quantity in the summaries, as the ends of their names.
_MOMENTS = ("mean", "std", "min", "max")


class RunResults(Result):
    """Results of a run in a folder, as :func:`open_run` returns them.

    Attributes
    ----------
    path : path of the folder.
    summaries : dataset over t, quantile and the bins of each quantity, as ``xarray.open_zarr(path)`` gives it
        (:func:`.motion.summaries.summary_dataset`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
    >>> results = vr.runs.open_run("results.zarr")
    >>> len(results), results.to_pandas().shape[0]
    (16, 7)
    """

    def __init__(self, path: Path, summaries: xr.Dataset) -> None:
        self.path, self.summaries = path, summaries

    def __len__(self) -> int:
        """Number of motions."""
        return int(self.summaries.attrs["motions"])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the summarised quantities."""
        return tuple(str(name).removesuffix("_mean") for name in self.summaries if str(name).endswith("_mean"))

    @property
    def run_file(self) -> str:
        """Text of the run file."""
        return str(self.summaries.attrs["run_file"])

    @property
    def _motions_folder(self) -> Path:
        """Folder of the motions, which exists if they are kept."""
        return self.path / MOTIONS

    def motions(self) -> xr.Dataset:
        """Open the dataset of every motion with its inputs, over (motion, t); values are read when they are needed.

        Returns
        -------
        xarray.Dataset
            Over (motion, t) the quantities that ``fields`` of the section [run] names, by default V (speed of the
            axis), omega (angular velocity) and x (distance travelled); an output that a motion did not reach is NaN.
            Over (motion,) each uncertain input by its name, onset_time of partial slip and rest_time (NaN of a motion
            without), status (code of :class:`MotionStatus`: 0 DONE, 1 RESTED, 2 to 6 stopped before the last output)
            and flow (1 if the motion was looked up in a flow map, tables of the motions of one scene, 0 if it was
            integrated).  t is a coordinate, motion has none: motion k is the k-th of the run, from 0.  All are in the
            units of the run file.

        Raises
        ------
        FileError
            If the run kept summaries alone.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
        >>> try:
        ...     vr.runs.open_run("results.zarr").motions()
        ... except vr.FileError as error:
        ...     print(error.problem)
        contains summaries but no motions: run it with keep = "all"
        """
        import xarray as xr

        if not self._motions_folder.is_dir():
            raise FileError(self.path, 'contains summaries but no motions: run it with keep = "all"')
        return xr.open_zarr(self.path, group=MOTIONS, chunks=None)

    def to_xarray(self) -> xr.Dataset:
        """Return the summaries: moments, quantiles, histograms, and how the motions ended.

        Returns
        -------
        xarray.Dataset
            The dataset ``summaries`` itself, not a copy, in the units of the run file.  For each quantity NAME it has
            NAME_counted, NAME_mean, NAME_std, NAME_min and NAME_max over t, NAME_quantiles over (quantile, t),
            NAME_histogram, numbers of motions, over (NAME_bin, t), and the edges NAME_bin_low and NAME_bin_high of the
            bins; of a quantity that is one number for each motion all are without the axis t.  ``ended`` over status is
            the number of motions with each :class:`MotionStatus`.  Values that are not finite do not count; at a time
            without values the moments and quantiles are NaN, and counts 0.  Attributes are failed_motions,
            motions_from_the_flow_map, and how the run was made (:func:`.identity.about`): motions, motions_a_block,
            blocks, seed, design, method, quantities, versions, run_file, title, source and Conventions.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
        >>> vr.runs.open_run("results.zarr").to_xarray()["V_mean"].dims
        ('t',)
        """
        return self.summaries

    def to_pandas(self) -> pd.DataFrame:
        """Return a row for each quantity and time: mean, std, min, max, and a column for each quantile.

        All are over the motions of the run; values that are not finite do not count.

        Returns
        -------
        pandas.DataFrame
            A table of float64, the quantities in the order of ``names`` and the times ascending.  The levels of its
            index are "quantity", the name with its unit as in "V [m s-1]", and the time, named "t" or "t [s]" and NaN
            for a quantity that is one number per motion.  Columns are "mean", "std", "min", "max", then the quantiles
            in the order of the run file, each labelled by its level, a float in [0, 1].  std is the root of the mean
            squared difference from the mean (divided by the number of values, not by one less).  Quantiles are known to
            the width of a bin, at most 2^-8 of the value.  At a time at which no motion has a value all entries are
            NaN.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
        >>> list(vr.runs.open_run("results.zarr").to_pandas().index.names)
        ['quantity', 't']
        """
        import pandas as pd

        data, tables = self.summaries, []
        time = column_name("t", unit_of(data["t"].attrs))
        for name in self.names:
            columns: dict[Any, Any] = {moment: np.atleast_1d(data[f"{name}_{moment}"].values) for moment in _MOMENTS}
            quantiles = zip(data["quantile"].values, data[f"{name}_quantiles"].values, strict=True)
            columns |= {float(level): np.atleast_1d(values) for level, values in quantiles}
            mean = data[f"{name}_mean"]
            t = data["t"].values if mean.ndim else [np.nan]
            rows = [[column_name(name, unit_of(mean.attrs))], t]
            tables.append(pd.DataFrame(columns, pd.MultiIndex.from_product(rows, names=["quantity", time])))
        return pd.concat(tables)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return the title, with the number of motions and units of a dimensionless run, and the rows that print it.

        Returns (title; list of :class:`SummaryRow`, in this order: "path", the folder; "drawn by", design and seed of
        the draws; "t", the number of output times and the last one, with its unit; a row for each summarised quantity
        by its name, with mean, standard deviation and unit, of a quantity over time "at the end", that is at the last
        output time, nan where no motion has a value; a row "ended" for each status that some motions have, with their
        number and the status in words; "kept", "every motion" or "summaries").
        """
        data = self.summaries
        t, about = data["t"], data.attrs
        rows = [
            SummaryRow("path", str(self.path)),
            SummaryRow("drawn by", f"{about['design']}, seed {about['seed']}"),
            SummaryRow("t", f"{t.size} time{'s' * (t.size != 1)} to {float(t[-1]):.6g}", unit_of(t.attrs)),
        ]
        for name in self.names:
            mean, std = (data[f"{name}_{moment}"] for moment in ("mean", "std"))
            at = "at the end: " if mean.ndim else ""
            last = f"{at}mean {mean.values.flat[-1]:.6g}, std {std.values.flat[-1]:.3g}"
            rows.append(SummaryRow(name, last, unit_of(mean.attrs)))
        ended = zip(data["status"].values, data["ended"].values, strict=True)
        rows += [SummaryRow("ended", f"{count}: {MotionStatus(code).message}") for code, count in ended if count]
        kept = "every motion" if self._motions_folder.is_dir() else "summaries"
        units = "" if unit_of(t.attrs) else ", dimensionless: speeds in R/T_ref, lengths in R, times in T_ref"
        return f"Results of a run of {len(self)} motions{units}", [*rows, SummaryRow("kept", kept)]


def open_run(path: str | PathLike[str]) -> RunResults:
    """Open the results of a finished run.

    Parameters
    ----------
    path : folder of the results, of :func:`run_ensemble` or ``viscoroll ensemble``.

    Returns
    -------
    RunResults
        The results.  They print themselves, and have ``to_xarray``, ``to_pandas``, ``plot`` and ``motions``; arrays are
        read from the folder when they are needed.

    Raises
    ------
    FileError
        If the folder is no results store, is not finished, or its summaries are damaged; the files of the motions are
        not examined (:func:`verify` does that).
    MissingDependencyError
        If zarr is not installed.

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
    >>> vr.runs.open_run("results.zarr").names
    ('V', 'omega', 'onset_time', 'x')
    """
    import xarray as xr

    import_extra("zarr", "runs")
    root = Path(path)
    start = start_of(root)
    if faults := problems(root, "end", start.run, start.motions):
        raise FileError(path, f"{faults[0]} is missing or damaged: the same `viscoroll ensemble` command repairs it")
    return RunResults(root, xr.open_zarr(root, chunks=None))
