"""Sections of run files -> :class:`Inputs`: distributions, columns of tables of numbers, correlations."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...core.errors import FileError
from ...core.extras import import_extra
from ...core.scale import si_unit
from ...core.sections import check_keys, section_error, suggestion
from ...materials.file import SECTIONS
from ..config import SCHEMA
from ..measurements import column_in_unit, named_table
from .inputs import Distribution, Input, Inputs

#: what the names of inputs of a section begin with
PREFIXES = {"base": "base_", "drive": "drive_"}
_SECTIONS = (*SCHEMA, *SECTIONS, "start", "drive")
#: keys that a name leaves out, or has in another form
_WORDS = {"prony": "", "creep": "", "values": "", "times": "time"}
#: of a material, what may be uncertain
_SOLID = ("E", "nu", "prony", "creep", "temperature", "thickness")
_ONE = {"distribution", "file", "column"}


def inputs_of(path: Path, content: dict[str, Any]) -> Inputs:
    """The inputs of a file that was read, independent; raises FileError."""
    reader = _Reader(path, "cylinder" in content)
    sections = {name: reader.section(name, content[name]) for name in _SECTIONS if name in content}
    return Inputs(content | sections, reader.random, reader.joint)


class _Reader:
    """Files what is uncertain, and puts an :class:`Input` in its place."""

    def __init__(self, path: Path, si: bool) -> None:
        self.path, self.si = path, si
        self.random: dict[str, Distribution] = {}
        self.joint: dict[str, dict[str, Floats]] = {}
        #: file -> how it was first written: 'rows.csv' and './rows.csv' share their rows
        self.files: dict[Path, str] = {}

    def section(self, name: str, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        may = _SOLID if name in SECTIONS else tuple(given)
        return {key: self.part(each, name, key, (key,)) if key in may else each for key, each in given.items()}

    def part(self, given: Any, section: str, key: str, words: tuple[str, ...]) -> Any:
        """What stands at a key; ``words``: the keys down to it, and places in lists."""
        if isinstance(given, list):
            return [self.part(each, section, key, (*words, str(n))) for n, each in enumerate(given, 1)]
        if not isinstance(given, dict):
            return given
        if not given.keys() & _ONE:
            for name in given:
                if near := suggestion(name, _ONE):
                    raise section_error(self.path, section, key, f"{key}: unknown key {name!r}{near}")
            return {name: self.part(each, f"{section}.{key}", name, (*words, name)) for name, each in given.items()}
        own = "_".join(filter(None, (_WORDS.get(word, word) for word in words)))
        found = Input(PREFIXES.get(section.partition(".")[0], "") + own, section, key)
        if "distribution" in given:
            self.random[found.name] = self.distribution(found, given)
        else:
            self.column(found, given)
        return found

    def fault(self, at: Input, problem: str) -> FileError:
        return section_error(self.path, at.section, at.key, f"{at.name}: {problem}")

    @np.errstate(all="ignore")  # scipy may overflow on what is refused here
    def distribution(self, at: Input, given: dict[str, Any]) -> Distribution:
        """A scipy.stats distribution, perhaps truncated."""
        law = self.law(at, given)
        low, high = (float(end) for end in law.support())
        cut = given.get("truncate", [-math.inf, math.inf])
        if not (isinstance(cut, list) and len(cut) == 2 and all(_is_number(end) and end == end for end in cut)):
            raise self.fault(at, f"truncate = {cut!r:.40}: must be [low, high]; inf and -inf leave an end")
        low, high = max(low, float(cut[0])), min(high, float(cut[1]))
        if not (low < high and law.cdf(high) - law.cdf(low) + (law.sf(low) - law.sf(high)) > 0.0):
            raise self.fault(at, f"truncate = {cut!r:.40}: nothing of the distribution is left")
        return Distribution(law, low, high)

    def law(self, at: Input, given: dict[str, Any]) -> Any:
        """The frozen distribution."""
        from scipy import stats

        which = given["distribution"]
        found = getattr(stats, which, None) if isinstance(which, str) else None
        if not isinstance(found, stats.rv_continuous):
            known = [key for key, value in vars(stats).items() if isinstance(value, stats.rv_continuous)]
            near = suggestion(str(which), known)
            raise self.fault(at, f"distribution {which!r:.40} is no continuous one of scipy.stats{near}")
        shapes = [shape.strip() for shape in (found.shapes or "").split(",") if shape.strip()]
        check_keys(self.path, f"{at.section}.{at.key}", given, ("distribution", *shapes, "loc", "scale", "truncate"))
        values = {key: value for key, value in given.items() if key not in ("distribution", "truncate")}
        for key, value in values.items():
            if not _is_number(value) or not math.isfinite(value):
                raise self.fault(at, f"{key} = {value!r:.40}: must be a finite number without a unit")
        missing = [shape for shape in shapes if shape not in values]
        if missing:
            raise self.fault(at, f"{which} also needs {', '.join(missing)}")
        frozen = found(**{key: float(value) for key, value in values.items()})
        if not np.isfinite(frozen.ppf(0.5)):
            raise self.fault(at, f"scipy.stats.{which} does not allow these parameters")
        return frozen

    def column(self, at: Input, given: dict[str, Any]) -> None:
        """File a column of a CSV, netCDF or Parquet file."""
        check_keys(self.path, f"{at.section}.{at.key}", given, ("file", "column", "distribution"))
        file, column = given.get("file"), given.get("column")
        if not isinstance(file, str) or not isinstance(column, str):
            raise self.fault(at, "must name a distribution, or a file and a column")
        where = f"column {column!r} of {file}"
        try:
            # strengths and times of a series, and corners of drives, have no unit of their own
            unit = si_unit(at.key) if self.si and "." not in at.section else "1"
            values = read_column(self.path.parent / file, column, unit)
        except (OSError, ValueError, KeyError, FileError) as error:
            text = " ".join(str(error.problem if isinstance(error, FileError) else error).split())
            raise self.fault(at, f"{where} cannot be read ({text:.200})") from error
        first = self.files.setdefault((self.path.parent / file).resolve(), file)
        others = self.joint.setdefault(first, {})
        if others and next(iter(others.values())).size != values.size:
            raise self.fault(at, f"{where}: other columns have another length")
        others[at.name] = values


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def read_column(path: Path, column: str, unit: str) -> Floats:
    """One column of numbers; of a CSV in this unit, if the file gives one."""
    if path.suffix == ".csv":
        values = column_in_unit(named_table(path, (column,)), column, unit)
    elif path.suffix == ".parquet":
        import pandas as pd

        import_extra("pyarrow", "pyarrow", "parquet")
        values = pd.read_parquet(path, columns=[column])[column].to_numpy()
    elif path.suffix == ".nc":
        import xarray as xr

        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            values = dataset[column].values
    else:
        raise ValueError("a sample must be .csv, .nc or .parquet")
    if values.ndim != 1 or values.size == 0 or values.dtype.kind not in "iuf" or not np.isfinite(values).all():
        raise ValueError("it must hold finite numbers, one a row")
    return np.ascontiguousarray(values, np.float64)


def correlated(path: Path, inputs: Inputs) -> Inputs:
    """The same under the Gaussian copula of [correlation]; raises FileError."""
    given, random = inputs.content.get("correlation", {}), inputs.random
    if not isinstance(given, dict):
        raise section_error(
            path, "", "correlation", "correlation: must be a section [correlation] with lines like V0.mu = 0.5"
        )
    for a, row in given.items():
        if not isinstance(row, dict):
            raise section_error(path, "correlation", a, f"{a} = {row!r:.40}: must be a line like V0.mu = 0.5")
    pairs = {(a, b): value for a, row in given.items() for b, value in row.items()}
    names = tuple(name for name in random if any(name in pair for pair in pairs))
    matrix = np.eye(len(names))
    for (a, b), value in pairs.items():
        for name in (a, b):
            if name not in random:
                problem = f"{name!r} has no distribution: must be one of {', '.join(random)}{suggestion(name, random)}"
                raise section_error(path, "correlation", a, problem)
        if a == b or not _is_number(value) or not -1.0 < value < 1.0:
            raise section_error(
                path, "correlation", a, f"{a}.{b} = {value!r:.40}: must be two names and a number in (-1, 1)"
            )
        if pairs.get((b, a), value) != value:
            problem = f"{a}.{b} = {value!r}: must be that of {b}.{a} = {pairs[b, a]!r:.40}"
            raise section_error(path, "correlation", a, problem)
        n, m = names.index(a), names.index(b)
        matrix[n, m] = matrix[m, n] = value
    try:
        mixing: Any = np.linalg.cholesky(matrix) if names else None
    except np.linalg.LinAlgError:
        raise section_error(
            path, "", "correlation", "[correlation] no joint distribution has these correlations"
        ) from None
    return replace(inputs, correlated=names, mixing=mixing)
