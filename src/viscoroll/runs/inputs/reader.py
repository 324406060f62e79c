"""Values of run files: numbers, distributions, columns of tables of numbers."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import ConfigError
from ...extras import imported
from ...sections import fault, hint
from .ranges import START, Range
from .record import Distribution


class Reader:
    """Sorts the values of sections into the parts of :class:`Inputs`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.fixed: dict[str, Any] = {}
        self.random: dict[str, Distribution] = {}
        self.joint: dict[str, dict[str, NDArray[np.float64]]] = {}
        #: file -> how it was first written: 'rows.csv' and './rows.csv' share their rows
        self.files: dict[Path, str] = {}
        self.section = ""
        #: key of the line of an input, where that is not its name
        self.line = ""

    def fault(self, key: str, problem: str) -> ConfigError:
        return fault(self.path, self.section, self.line or key, problem)

    def put(self, name: str, value: Any, allowed: Range, line: str = "") -> None:
        """File ``value`` of input ``name`` under numbers, distributions or columns."""
        self.line = line
        if isinstance(value, str):
            raise self.fault(name, f"{name} = {value!r}: must be a plain number{_in(allowed.unit)}")
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if not allowed.holds(value):
                raise self.fault(name, f"{name} = {value!r}: must be {allowed}")
            self.fixed[name] = float(value)
        elif isinstance(value, dict) and "distribution" in value:
            self.random[name] = self.distribution(name, value, allowed)
        elif isinstance(value, dict):
            refuse_unknown_of(self, name, value, ("file", "column", "distribution"))
            if value.keys() != {"file", "column"}:
                raise self.fault(name, f"{name}: must name a distribution, or a file and a column")
            self.column(name, value["file"], value["column"], allowed)
        else:
            raise self.fault(name, f"{name} = {value!r:.40}: must be a number, a distribution or a column of a file")

    @np.errstate(all="ignore")  # scipy may overflow on what is refused here
    def distribution(self, name: str, given: dict[str, Any], allowed: Range) -> Distribution:
        """A scipy.stats distribution, perhaps truncated, inside the allowed range."""
        law = self.law(name, given)
        low, high = (float(end) for end in law.support())
        cut = given.get("truncate", [-math.inf, math.inf])
        if not (isinstance(cut, list) and len(cut) == 2 and all(map(_is_end, cut))):
            raise self.fault(name, f"{name}: truncate = {cut!r:.40}: must be [low, high]; inf and -inf leave an end")
        low, high = max(low, float(cut[0])), min(high, float(cut[1]))
        if not (low < high and law.cdf(high) - law.cdf(low) + (law.sf(low) - law.sf(high)) > 0.0):
            raise self.fault(name, f"{name}: truncate = {cut!r:.40}: nothing of the distribution is left")
        beyond = [end for end in (low, high) if not allowed.low <= end <= allowed.high]
        # no design draws an infinite end; a block checks what it draws
        if beyond and not (name in START and all(map(math.isinf, beyond))):
            bounds = f"{name}: reaches from {low:g} to {high:g}, must be {allowed}"
            raise self.fault(name, f"{bounds}: add truncate = [low, high]")
        return Distribution(law, low, high)

    def law(self, name: str, given: dict[str, Any]) -> Any:
        """The frozen distribution."""
        from scipy import stats

        which = given["distribution"]
        found = getattr(stats, which, None) if isinstance(which, str) else None
        if not isinstance(found, stats.rv_continuous):
            known = [key for key, value in vars(stats).items() if isinstance(value, stats.rv_continuous)]
            near = hint(str(which), known)
            raise self.fault(name, f"{name}: distribution {which!r:.40} is no continuous one of scipy.stats{near}")
        shapes = [shape.strip() for shape in (found.shapes or "").split(",") if shape.strip()]
        refuse_unknown_of(self, name, given, ("distribution", *shapes, "loc", "scale", "truncate"))
        values = {key: value for key, value in given.items() if key not in ("distribution", "truncate")}
        for key, value in values.items():
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
                raise self.fault(name, f"{name}: {key} = {value!r:.40}: must be a finite number without a unit")
        missing = [shape for shape in shapes if shape not in values]
        if missing:
            raise self.fault(name, f"{name}: {which} also needs {', '.join(missing)}")
        frozen = found(**{key: float(value) for key, value in values.items()})
        if not np.isfinite(frozen.ppf(0.5)):
            raise self.fault(name, f"{name}: scipy.stats.{which} does not allow these parameters")
        return frozen

    def column(self, name: str, file: Any, column: Any, allowed: Range) -> None:
        """A column of a CSV, netCDF or Parquet file."""
        if not isinstance(file, str) or not isinstance(column, str):
            raise self.fault(name, f"{name}: file and column must be texts")
        try:
            values = read_column(self.path.parent / file, column)
        except (OSError, ValueError, KeyError) as error:
            text = " ".join(str(error).split())
            raise self.fault(name, f"{name}: column {column!r} of {file} cannot be read ({text:.200})") from error
        if values.size == 0 or not all(map(allowed.holds, (values.min(), values.max()))):
            raise self.fault(name, f"{name}: column {column!r} of {file}: all its values must be {allowed}")
        first = self.files.setdefault((self.path.parent / file).resolve(), file)
        others = self.joint.setdefault(first, {})
        if others and next(iter(others.values())).size != values.size:
            raise self.fault(name, f"{name}: column {column!r} of {file}: other columns have another length")
        others[name] = values


def _is_end(value: Any) -> bool:
    """Whether it is a number, perhaps an infinite one."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and not math.isnan(value)


def _in(unit: str) -> str:
    return ", dimensionless" if unit == "1" else f", in {unit}"


def refuse_unknown_of(reader: Reader, name: str, given: dict[str, Any], allowed: tuple[str, ...]) -> None:
    """As ``refuse_unknown``, for the keys of one input, at the line of that input."""
    for key in given:
        if key not in allowed:
            known = ", ".join(allowed)
            raise reader.fault(name, f"{name}: unknown key {key!r}: must be one of {known}{hint(key, allowed)}")


def read_column(path: Path, column: str) -> NDArray[np.float64]:
    """One column of numbers."""
    import pandas as pd

    if path.suffix == ".csv":
        values = pd.read_csv(path, usecols=[column])[column].to_numpy()
    elif path.suffix == ".parquet":
        imported("pyarrow", "pyarrow", "parquet")
        values = pd.read_parquet(path, columns=[column])[column].to_numpy()
    elif path.suffix == ".nc":
        import xarray as xr

        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            values = dataset[column].values
    else:
        raise ValueError("a sample must be .csv, .nc or .parquet")
    if values.ndim != 1 or values.dtype.kind not in "iuf" or not np.isfinite(values).all():
        raise ValueError("it must hold finite numbers, one a row")
    return np.ascontiguousarray(values, np.float64)
