"""Where inputs come from: numbers, distributions of scipy.stats, columns of files; ranges and units."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ConfigError, ParameterError
from ..extras import imported
from ..materials.file import materials_of
from ..materials.material import Material
from ..materials.pair import Pair, Plane
from ..sections import fault, hint, refuse_unknown
from .drives import prescribed_start, read_drive
from .inputs import Distribution, Inputs, Joint
from .ranges import CYLINDER, DRIVE, DRIVE_SI, OPTIONAL, SCENE, SOLID, START, START_SI, Range
from .solids import SERIES, is_uncertain, read_series, read_solids

_PLANES = ("strain", "stress")


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


def read_inputs(
    path: Path,
    sections: dict[str, dict[str, Any]],
    base: dict[str, Any],
    correlation: dict[str, Any],
    materials: dict[str, Any],
    drive: dict[str, Any],
) -> Inputs:
    """Inputs of sections, materials and drive; ``base`` fills in what sections leave out.  Raises ConfigError."""
    reader = Reader(path)
    cylinder = {name: allowed for name, allowed in CYLINDER.items() if not (materials and name in SOLID)}
    ranges = {"cylinder": cylinder, "start": START_SI} if "cylinder" in sections else {"scene": SCENE, "start": START}
    for section, given in sections.items():
        reader.section = section
        others = {"cylinder": ("plane",), "scene": tuple(SERIES)}.get(section, ())
        refuse_unknown(path, section, given, (*ranges[section], *others))
        series = _series(reader, section, given, base) if section == "scene" else None
        for name, allowed in ranges[section].items():
            if prescribed_start(reader, name, given, drive):
                continue
            value = given.get(name, base.get(name, allowed.default))
            if name == "alpha" and series is not None:
                continue
            if value is not None:
                reader.put(name, value, allowed)
            elif name not in OPTIONAL:
                needed = "alpha, prony or creep" if name == "alpha" else name
                raise fault(path, "", section, f"[{section}] needs {needed}")
    driven = DRIVE_SI if "cylinder" in sections else DRIVE
    refuse_unknown(path, "drive", drive, driven)
    reader.section = "drive"
    read_drive(reader, drive, driven)
    if "cylinder" in sections:
        reader.section = "cylinder"
        plane = sections["cylinder"].get("plane", "strain")
        if plane not in _PLANES:
            raise reader.fault("plane", f"plane = {plane!r}: must be 'strain' or 'stress'")
        reader.fixed["plane"] = plane
        if any(map(is_uncertain, materials.values())):
            read_solids(reader, materials)
        elif materials:
            pair = _pair(path, materials_of(path, materials), plane)
            reader.fixed |= {"pair": pair, "T_ref": pair.T_ref}
    joint = {file: Joint(columns) for file, columns in reader.joint.items()}
    correlated, mixing = _copula(path, correlation, reader.random)
    inputs = Inputs(reader.fixed, reader.random, joint, correlated, mixing)
    if "cylinder" in sections and not materials:
        _refuse_short_retardation(reader, inputs)
    return inputs


def _series(reader: Reader, section: str, given: dict[str, Any], base: dict[str, Any]) -> Any:
    """File the series that stands in place of alpha, of the section or of its preset, if there is one."""
    series, _ = read_series(reader, section, given)
    reader.section = section
    if series is None and "alpha" not in given:
        series = base.get("series")
    if series is not None:
        if "alpha" in given:
            raise fault(reader.path, section, "alpha", "alpha and a series: must be one of the two")
        reader.fixed["series"] = series
    return series


def _pair(path: Path, materials: dict[str, Material], plane: Plane) -> Pair:
    """Both bodies of a run; raises ConfigError."""
    try:
        return Pair(materials["material"], materials.get("base"), plane)
    except ParameterError as error:
        raise fault(path, "", "material", str(error)) from error


def _copula(path: Path, given: dict[str, Any], random: dict[str, Distribution]) -> tuple[tuple[str, ...], Any]:
    """(names, Cholesky factor) of [correlation]."""
    if not isinstance(given, dict):
        raise fault(path, "", "correlation", "correlation: must be a section [correlation] with lines like V0.mu = 0.5")
    pairs = {(a, b): value for a, row in given.items() for b, value in (row.items() if isinstance(row, dict) else [])}
    for a, row in given.items():
        if not isinstance(row, dict):
            raise fault(path, "correlation", a, f"{a} = {row!r:.40}: must be a line like V0.mu = 0.5")
    names = tuple(name for name in random if any(name in pair for pair in pairs))
    matrix = np.eye(len(names))
    for (a, b), value in pairs.items():
        for name in (a, b):
            if name not in random:
                problem = f"{name!r} has no distribution: must be one of {', '.join(random)}{hint(name, random)}"
                raise fault(path, "correlation", a, problem)
        if a == b or isinstance(value, bool) or not isinstance(value, (int, float)) or not -1.0 < value < 1.0:
            raise fault(path, "correlation", a, f"{a}.{b} = {value!r:.40}: must be two names and a number in (-1, 1)")
        if pairs.get((b, a), value) != value:
            problem = f"{a}.{b} = {value!r}: must be that of {b}.{a} = {pairs[b, a]!r:.40}"
            raise fault(path, "correlation", a, problem)
        n, m = names.index(a), names.index(b)
        matrix[n, m] = matrix[m, n] = value
    try:
        return names, np.linalg.cholesky(matrix) if names else None
    except np.linalg.LinAlgError:
        raise fault(path, "", "correlation", "[correlation] no joint distribution has these correlations") from None


def _refuse_short_retardation(reader: Reader, inputs: Inputs) -> None:
    """T_epsilon must not fall below T_sigma in any draw."""
    for sample in inputs.joint.values():
        if {"T_epsilon", "T_sigma"} <= sample.columns.keys():
            if (sample.columns["T_epsilon"] < sample.columns["T_sigma"]).any():
                raise reader.fault("T_epsilon", "T_epsilon: rows with T_epsilon < T_sigma")
            return
    if _end(inputs, "T_epsilon", 0) < _end(inputs, "T_sigma", 1):
        problem = "T_epsilon may fall below T_sigma: truncate both so that it cannot"
        raise reader.fault("T_epsilon", problem)


def _end(inputs: Inputs, name: str, which: int) -> float:
    """Lower (0) or upper (1) end of an input."""
    if name in inputs.fixed:
        return inputs.fixed[name]
    if name in inputs.random:
        law = inputs.random[name]
        return (law.low, law.high)[which]
    values = next(sample.columns[name] for sample in inputs.joint.values() if name in sample.columns)
    return float((values.min(), values.max())[which])
