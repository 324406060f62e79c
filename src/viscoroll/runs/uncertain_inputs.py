"""Uncertain inputs of a run file: distributions, columns, and their values.

:func:`inputs_of` collects the uncertain numbers of a run file as :class:`Inputs`.  An input is a
:class:`Distribution`, or a column of a file, a joint sample.  Motions are drawn as points of a unit
cube: each distribution is one dimension of the cube, and so is each file, whose columns share the
row that is drawn.  :class:`Inputs` gives the values of all inputs at such points, and the sections
of the run file with these values.
"""

import contextlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..core import (
    FileError,
    Floats,
    Named,
    Names,
    ParameterError,
    check_keys,
    import_extra,
    is_real,
    section_error,
    si_unit,
    suggestion,
)
from ..materials import SECTIONS
from ..presets import SCHEMA
from ..sampling import LARGEST, SMALLEST
from .run_rollers import RUN_SECTIONS

# --- Uncertain inputs ---

#: Name of an input -> its values, one for each motion, or its column in a file.
Columns = dict[str, Floats]
#: Word in place of a time of a drive: the same time again, so that the value jumps.
SAME = "same"
#: Share of the draws at either end that a flow map of the start speeds does not reach: those few
#: are integrated.
_TAIL = 1e-6


@dataclass(frozen=True)
class Input:
    """An uncertain number of a run file.

    Attributes
    ----------
    name : name of the input, as in the columns of the results ("mu", "base_E", "tau_2",
        "drive_torque_time_1").
    section, key : where it stands in the file; of a number within a table the section is
        "section.key".
    """

    name: str
    section: str
    key: str


@dataclass(frozen=True)
class Distribution:
    """A distribution of scipy.stats, truncated to an interval.

    Attributes
    ----------
    law : frozen distribution.
    low, high : ends of the interval, which may be infinite.
    """

    law: Any
    low: float
    high: float

    @np.errstate(all="ignore")  # an overflow is infinite, which a motion refuses
    def ppf(self, u: Floats) -> Floats:
        """Return the quantiles of the truncated distribution, in the unit of the input.

        If more than half of the whole distribution lies below the interval, it is inverted from
        above, by the survival function, so that the upper tail keeps its digits.

        u: probabilities in (0, 1), not checked, of any shape.
        Returns an array of that shape, within [low, high]; where the interval is the support of the
        law, the quantiles of the law as scipy computes them, which may overflow to an infinity.  A
        NaN of scipy is passed on.
        """
        law = self.law
        ends = self.low, self.high
        if ends == law.support():
            return law.ppf(u)
        if law.cdf(self.low) > 0.5:
            # from above: survival at the upper end is the smaller one, and 1 - u counts from there
            last, first = map(law.sf, ends)
            quantiles = law.isf(first + (1.0 - u) * (last - first))
        else:
            first, last = map(law.cdf, ends)
            quantiles = law.ppf(first + u * (last - first))
        return np.clip(quantiles, *ends)  # ppf and cdf are inverse to rounding only


@dataclass(frozen=True)
class Inputs:
    """The inputs of a run.

    Attributes
    ----------
    content : name of a section of the file -> its content, with an :class:`Input` in place of each
        uncertain number.
    random : name -> distribution; one dimension of the unit cube each.
    joint : file -> name -> its column, (rows,); one dimension for each file: rows are drawn with
        replacement.
    correlated : names of the distributions under the Gaussian copula.
    mixing : Cholesky factor of their correlation matrix, lower triangular, (correlated,
        correlated); None without correlation.
    """

    content: Named
    random: dict[str, Distribution] = field(default_factory=dict)
    joint: dict[str, Columns] = field(default_factory=dict)
    correlated: Names = ()
    mixing: Floats | None = None

    @property
    def dimensions(self) -> Names:
        """Names of the dimensions of the cube: distributions, then files."""
        return (*self.random, *self.joint)

    @property
    def columns(self) -> Columns:
        """Columns of all files."""
        return {name: columns[name] for columns in self.joint.values() for name in columns}

    @property
    def uncertain(self) -> Names:
        """Names of the inputs."""
        return (*self.random, *self.columns)

    @property
    def medians(self) -> Named:
        """Median of each input, name -> float in the unit of the file; of N rows of a file the row
        floor(N/2).
        """
        middle = self.values(np.full((len(self.dimensions), 1), 0.5))
        return {name: values.item() for name, values in middle.items()}

    def values(self, points: Floats) -> Columns:
        """Map points of the unit cube to the values of all inputs.

        Under the copula the coordinates of correlated inputs are first replaced by those of normal
        variables with the stated correlations.  A distribution takes its quantile at its coordinate
        u, a file of N rows the row floor(u N) for all its columns.

        points: (dimensions, n), in (0, 1), not checked, a row for each of :attr:`dimensions` in
            their order; another number of rows raises ValueError.
        Returns name -> values, (n,), float64, in the units of the file: distributions, then
        columns.  A quantile that overflows is infinite.
        """
        rows = dict(zip(self.dimensions, points, strict=True))
        if self.mixing is not None:
            from scipy import special

            normal = [special.ndtri(rows[name]) for name in self.correlated]
            # a sum in a fixed order, so that bits do not depend on the number of points
            mixed = sum(part[:, None] * row for part, row in zip(self.mixing.T, normal))
            # 0 or 1, which ndtr may round to, would be infinite quantiles
            rows |= zip(self.correlated, np.clip(special.ndtr(mixed), SMALLEST, LARGEST))
        values = {name: law.ppf(rows[name]) for name, law in self.random.items()}
        for file, columns in self.joint.items():
            size = next(iter(columns.values())).size
            # the product of a u near 1 may round to the number of rows
            row = np.minimum((rows[file] * size).astype(np.int64), size - 1)
            values |= {name: column[row] for name, column in columns.items()}
        return values

    def ends(self, name: str, low: float = SMALLEST, high: float = LARGEST) -> Floats:
        """Return the ends of the draws of an input.

        name: name of the input; another name raises KeyError.
        low, high: probabilities in (0, 1) of the ends of a distribution, by default the smallest
            and the largest coordinate that a point has, 2^-54 and 1 - 2^-53; ignored for a column
            of a file.
        Returns [lower, upper], (2,), in the unit of the file: quantiles of a distribution, which
        may be infinite; the smallest and the largest number of a column.
        """
        if name in self.random:
            return self.random[name].ppf(np.array([low, high]))
        column = self.columns[name]
        return np.array([column.min(), column.max()])

    def corners(self) -> Columns:
        """Return combinations of extreme inputs, for which the checks of a run file make motions.

        With k inputs that are distributions or the only column of their file there are n = 2
        (k + 1) combinations: each of the k inputs at its upper end with all others at their lower
        ends; all at their lower ends; then the same with the ends exchanged.
        Returns name -> values, (n,), in the units of the file.  The columns of a file with several
        are at their medians, a number each, as their ends need not occur together; if all inputs
        are such, no value is an array.
        """
        names = [
            *self.random,
            *(name for columns in self.joint.values() if len(columns) == 1 for name in columns),
        ]
        # a row for each input: in combination n the input n at 1, the upper of its ends, in the
        # last one none; then all of them exchanged
        at_low = np.eye(len(names), len(names) + 1, dtype=bool)
        ends = {
            name: self.ends(name)[np.r_[row, ~row].astype(int)] for name, row in zip(names, at_low)
        }
        return self.medians | ends

    def largest(self, name: str) -> float:
        """Return the largest magnitude of a start speed up to which a flow map, tables of the
        motions, is made.

        name: "V0" or "omega0"; KeyError if the section [start] does not give it.
        Returns a float >= 0 in the unit of the file.  A distribution may be unbounded: its
        quantiles at 1e-6 and 1 - 1e-6 are taken, which two in a million draws exceed.  Of a column
        of a data file all rows count; of a fixed number its magnitude is returned.  A larger start
        speed is allowed: its motion is integrated.
        """
        start = self.content["start"][name]
        return float(
            np.abs(self.ends(name, _TAIL, 1.0 - _TAIL) if isinstance(start, Input) else start).max()
        )

    def filled(self, values: Mapping[str, Any]) -> Named:
        """Return the sections of the run file with values in place of the inputs, and omega0 in
        that of "rolling".

        values: name of an input -> number or (n,), for every input, else KeyError; other names have
        no effect.
        Returns name of a section -> content, all of it new but for parts that are neither tables
        nor lists.  An omega0 "rolling" is V0/R, in a dimensionless file V0; it stays where V0 or R
        is no number, which checks refuse later.
        """
        content = _fill_in(self.content, values)
        if self.rolls:
            with (
                contextlib.suppress(TypeError, KeyError, AttributeError),
                np.errstate(all="ignore"),
            ):
                R = content["cylinder"]["R"] if "cylinder" in content else 1.0
                omega0 = np.divide(content["start"]["V0"], R)
                content["start"]["omega0"] = omega0 if omega0.ndim else omega0.item()
        return content

    @property
    def rolls(self) -> bool:
        """Whether the motions start in pure rolling, by omega0 = "rolling" in the file."""
        start = self.content.get("start")
        return isinstance(start, dict) and start.get("omega0") == "rolling"


def _fill_in(part: Any, values: Mapping[str, Any]) -> Any:
    """Return a part of the content with values in place of its inputs; in a list "same" repeats the
    number before.

    part: an :class:`Input`, or a section, list, number, text or material of the file; it is not
    changed.
    values: name of an input -> number or (n,); KeyError for an input that it does not have.
    Returns the value of an input; a new dict of a section; a new list of a list, in which a first
    "same" stays as it is; any other part itself.
    """
    if isinstance(part, Input):
        return values[part.name]
    if isinstance(part, dict):
        return {key: _fill_in(member, values) for key, member in part.items()}
    if not isinstance(part, list):
        return part
    numbers: list = []
    for member in part:
        # the number before, itself perhaps that of an input
        numbers.append(numbers[-1] if numbers and member == SAME else _fill_in(member, values))
    return numbers


def inputs_in(part: Any) -> list[Input]:
    """Return the inputs within a part of the content of a run file, a list of :class:`Input` in the
    order of the file.

    part: a section, table, list, number or any other value; what is neither table, list nor input
    gives an empty list.
    """
    if isinstance(part, Input):
        return [part]
    members = [*part.values()] if isinstance(part, dict) else part
    if not isinstance(members, list):
        return []
    return [found for member in members for found in inputs_in(member)]


# --- Sections of a run file -> Inputs ---


#: Sections that may have uncertain numbers.
_SECTIONS = (*SCHEMA, *SECTIONS, *RUN_SECTIONS)
#: Key -> the word for it in the name of an input, if that is another; "" is left out.
_WORDS = {"prony": "", "creep": "", "values": "", "times": "time"}
#: Keys of a material that may be uncertain.
_UNCERTAIN_IN_MATERIAL = ("E", "nu", "prony", "creep", "temperature", "thickness")
#: Keys by which a table of TOML is an uncertain number.
_KEYS_OF_INPUT = {"distribution", "file", "column"}


def inputs_of(path: Path, content: Named) -> Inputs:
    """Collect the uncertain numbers of a run file; files of samples are read.

    path: path of the run file, to which the paths of samples are relative.
    content: name of a section, or key outside of sections -> content, as tomllib reads it; not
    changed.
    Returns the :class:`Inputs`, without correlations: all of ``content``, with an :class:`Input` in
    place of each uncertain number of the sections of the roller, [start] and [drive].
    Raises FileError, with its line, for an uncertain number that is wrong; MissingDependencyError
    for a .parquet file without pyarrow.
    """
    reader = _Reader(path, "cylinder" in content)
    sections = {name: reader.section(name, content[name]) for name in _SECTIONS if name in content}
    return Inputs(content=content | sections, random=reader.random, joint=reader.joint)


@dataclass
class _Reader:
    """Collects the uncertain numbers of a run file, and replaces each by an :class:`Input`.

    path, si: path of the run file, and whether it is in SI units.
    random, joint: as in :class:`Inputs`; they grow while the sections are read.
    files: path of a sample -> its first spelling: 'rows.csv' and './rows.csv' share their rows.
    """

    path: Path
    si: bool
    random: dict[str, Distribution] = field(default_factory=dict)
    joint: dict[str, Columns] = field(default_factory=dict)
    files: dict[Path, str] = field(default_factory=dict)

    def section(self, name: str, section: Any) -> Any:
        """Return a section with inputs in place of its uncertain numbers, which are collected.

        name: name of the section.
        section: content of the section.  What is no table is returned as it is; checks of the file
        refuse it later.
        Returns a new dict.  Of a material only the numbers of :data:`_UNCERTAIN_IN_MATERIAL` may be
        uncertain (E, nu, prony, creep, temperature, thickness); the values of its other keys stay
        as they are.
        Raises FileError for an uncertain number that is wrong, or at another key of a material;
        MissingDependencyError as :meth:`add_column`.
        """
        if not isinstance(section, dict):
            return section
        keys = _UNCERTAIN_IN_MATERIAL if name in SECTIONS else section
        for key, value in section.items():
            if key not in keys and isinstance(value, dict) and "distribution" in value:
                raise section_error(
                    self.path, name, key, f"{key} cannot be uncertain; {', '.join(keys)} can"
                )
        return {
            key: self.part(value, name, key, (key,)) if key in keys else value
            for key, value in section.items()
        }

    def part(self, value: Any, section: str, key: str, words: Names) -> Any:
        """Return a value of the file with an :class:`Input` in place of each uncertain number.

        A table with a key distribution, file or column is an uncertain number; it is collected in
        ``random`` or ``joint``.  Lists and other tables are searched at any depth.

        value: value at a key of the file.
        section, key: section and key of the value; of a member of a table "section.key" and its
        key.
        words: keys from the section down to it, and positions in lists from "1"; joined by "_",
            without prony, creep and values and with time for times, they make the name of the
            input, as "tau_2" of ("prony", "tau", "2"); of sections base and drive it begins with
            "base_" and "drive_".
        Returns an Input of an uncertain number, a new list or dict of a list or another table, else
        ``value``.
        Raises FileError for an uncertain number that is wrong, or a table whose key is like one of
        an uncertain number, as a misspelt one is; MissingDependencyError as :meth:`add_column`.
        """
        if isinstance(value, list):
            return [
                self.part(member, section, key, (*words, str(n)))
                for n, member in enumerate(value, 1)
            ]
        if not isinstance(value, dict):
            return value
        if not value.keys() & _KEYS_OF_INPUT:
            for name in value:
                if near := suggestion(name, _KEYS_OF_INPUT):
                    raise section_error(
                        self.path, section, key, f"{key}: unknown key {name!r}{near}"
                    )
            return {
                name: self.part(member, f"{section}.{key}", name, (*words, name))
                for name, member in value.items()
            }
        # the section of a number within a table is "drive.torque"
        owner = section.partition(".")[0]
        if owner in ("base", "drive"):  # whose inputs are called by it
            words = (owner, *words)
        name = "_".join(filter(None, (_WORDS.get(word, word) for word in words)))
        number = Input(name, section, key)
        if "distribution" in value:
            self.random[number.name] = self.distribution(number, value)
        else:
            self.add_column(number, value)
        return number

    def fault(self, number: Input, problem: str) -> FileError:
        """Return the error of an uncertain number, with the number of its line.

        number: the uncertain number.
        problem: words on what is wrong, which end the message.
        """
        return section_error(self.path, number.section, number.key, f"{number.name}: {problem}")

    @np.errstate(all="ignore")  # scipy may overflow for parameters that are refused here
    def distribution(self, number: Input, table: Named) -> Distribution:
        """Return the distribution of an uncertain number, truncated if the file says so.

        number: the uncertain number, for errors.
        table: its table of TOML: distribution, parameters of scipy.stats by name, and perhaps
            truncate = [low, high], either of which may be infinite.
        Returns the :class:`Distribution`, whose interval is the part of ``truncate`` within the
        support of the law; without ``truncate`` it is the support.
        Raises FileError as :meth:`frozen_law`, for a ``truncate`` that is not two numbers or has a
        NaN, and for an interval that is empty, a point, or of zero probability.
        """
        law = self.frozen_law(number, table)
        low, high = law.support()
        cut = table.get("truncate", [-math.inf, math.inf])
        numbers = isinstance(cut, list) and all(is_real(end) and end == end for end in cut)
        if not numbers or len(cut) != 2:
            allowed = "[low, high]; inf or -inf for an end without limit"
            raise self.fault(number, f"truncate = {cut!r:.40}: must be {allowed}")
        low = max(float(low), float(cut[0]))
        high = min(float(high), float(cut[1]))
        # both differences are the probability; in the upper tail that of cdf rounds to 0, in the
        # lower one that of sf
        if not (low < high and law.cdf(high) - law.cdf(low) + (law.sf(low) - law.sf(high)) > 0.0):
            interval = (
                f"truncate = {cut!r:.40}" if "truncate" in table else f"support [{low:g}, {high:g}]"
            )
            allowed = "[low, high] with low < high"
            if cut[0] < cut[1]:
                allowed = f"where the distribution has draws (its median is {law.median():g})"
            raise self.fault(number, f"{interval}: must be {allowed}")
        return Distribution(law, low, high)

    def frozen_law(self, number: Input, table: Named) -> Any:
        """Return the frozen distribution of scipy.stats that a table names, with its parameters,
        not truncated.

        number: the uncertain number, for errors.
        table: its table of TOML: distribution, the name of a continuous distribution of
            scipy.stats; all of its shape parameters by name; loc and scale, which may be left out
            (0 and 1); truncate is ignored.
        Raises FileError for a name that is no continuous distribution, for unknown, missing,
        non-numeric or infinite parameters, and for some that it does not allow, as those without a
        finite median.
        """
        from scipy import stats

        name = table["distribution"]
        laws = {
            key: law for key, law in vars(stats).items() if isinstance(law, stats.rv_continuous)
        }
        if not isinstance(name, str) or name not in laws:
            known = "a continuous distribution of scipy.stats, as 'norm' or 'uniform'"
            near = suggestion(str(name), laws)
            raise self.fault(number, f"distribution = {name!r:.40}: must be {known}{near}")
        law = laws[name]
        shapes = law.shapes.split(", ") if law.shapes else []
        allowed = ("distribution", *shapes, "loc", "scale", "truncate")
        check_keys(self.path, f"{number.section}.{number.key}", table, allowed)
        parameters = {key: table[key] for key in allowed[1:-1] if key in table}
        for key, value in parameters.items():
            if not is_real(value) or not math.isfinite(value):
                raise self.fault(
                    number, f"{key} = {value!r:.40}: must be a finite number without a unit"
                )
        if missing := [shape for shape in shapes if shape not in parameters]:
            raise self.fault(number, f"{name} lacks these parameters: {', '.join(missing)}")
        frozen = law(**{key: float(value) for key, value in parameters.items()})
        # scipy returns NaN for parameters out of range, and raises nothing
        if not np.isfinite(frozen.ppf(0.5)):
            raise self.fault(number, f"{name} does not allow {parameters} (scale must be > 0)")
        return frozen

    def add_column(self, number: Input, table: Named) -> None:
        """Read the column of a file that is the sample of an uncertain number, and collect it in
        ``joint``.

        In SI units numbers are converted to the unit of the key.  Strengths and times of a series
        and corners of a load, which stand in tables within a section, must be dimensionless there,
        as must all columns where the run is not in SI units.  A column without a unit is taken in
        that of the key, with a warning.  ``joint[FILE][number.name]`` becomes the column, float64,
        (rows,), with FILE the first spelling of the file.

        number: the uncertain number, whose name the column gets in ``joint``.
        table: its table of TOML: file, a .csv, .nc or .parquet, relative to the run file, and
        column.
        Raises FileError for a table without a text at either key or with an unknown key, for a file
        or column that cannot be read, for a column that is empty, has several axes, numbers that
        are not finite or a unit that is unknown or of another dimension, and where its length
        differs from that of the other columns of the file; MissingDependencyError for .parquet
        without pyarrow.
        """
        check_keys(
            self.path, f"{number.section}.{number.key}", table, ("file", "column", "distribution")
        )
        file = table.get("file")
        column = table.get("column")
        if not isinstance(file, str) or not isinstance(column, str):
            found = f"{'column' if isinstance(file, str) else 'file'} is missing or no text"
            raise self.fault(number, f"{found}: give file and column, or distribution")
        where = f"column {column!r} of {file}"
        path = self.path.parent / file
        try:
            # strengths and times of a series, and corners of drives, have no unit of their own
            values = read_column(
                path, column, si_unit(number.key) if self.si and "." not in number.section else "1"
            )
        except (OSError, ValueError, KeyError, FileError) as error:
            if not path.exists():
                problem: Any = "the file does not exist"
            elif isinstance(error, KeyError):
                problem = "the file has no column of this name"
            elif type(error) in (FileError, ParameterError, ValueError):
                problem = getattr(error, "problem", error)
            else:
                problem = f"the file is damaged, or is not a {path.suffix} file"
            raise self.fault(number, f"{where}: {problem}") from error
        # one entry for each file, however it is spelt
        columns = self.joint.setdefault(self.files.setdefault(path.resolve(), file), {})
        for name, other in columns.items():
            if other.size != values.size:
                found = f"{where} has {values.size} numbers, but {name} has {other.size}"
                raise self.fault(number, f"{found} from this file: give it a file of its own")
        columns[number.name] = values


def read_column(path: Path, column: str, unit: str) -> Floats:
    """Read a column of finite numbers from a file.

    path: path of a .csv, .nc (netCDF-4) or .parquet file.
    column: name of the column or variable.
    unit: unit in pint's spelling, "1" of a ratio; numbers in another unit, which the heading or the
        attribute ``units`` of a .nc states, are converted; without one it is taken, with a warning.
    Returns float64, (n,), n >= 1, contiguous.
    Raises FileError for a CSV that cannot be read, has no such column or several, or cells in it
    that are no numbers; ParameterError for its unit, if that is unknown or has another dimension;
    ValueError, OSError or KeyError for other files and suffixes, and for a column that is empty,
    has several axes or has values that are no finite numbers; MissingDependencyError for .parquet
    without pyarrow.
    """
    from ..measurements.dma_columns import column_in_unit, conversion_of_column
    from ..measurements.text_cells import MULTIPLIED, readings
    from ..measurements.text_table import named_table

    if path.suffix == ".csv":
        values = column_in_unit(named_table(path, (column,)), column, unit)
    elif path.suffix == ".parquet":
        import pandas as pd

        import_extra("pyarrow", "parquet")
        values = pd.read_parquet(path)[column].to_numpy()
        ways = readings(column)
        given = next((each.unit for each in ways if each.unit), "")
        if ways[0].log or MULTIPLIED.search(column):
            given = column  # in which nothing is converted
        advice = f"name the column '{column} [{unit}]', or with the unit that it has"
    elif path.suffix == ".nc":
        import xarray as xr

        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            values = dataset[column].values
            given = str(dataset[column].attrs.get("units", ""))
        advice = f"give the variable the attribute units, as '{unit}'"
    else:
        raise ValueError("the name of the file must end in .csv, .nc or .parquet")
    if values.ndim != 1 or values.size == 0 or values.dtype.kind not in "iuf":
        raise ValueError(
            f"has shape {values.shape} and type {values.dtype}: must be one column of numbers"
        )
    if path.suffix != ".csv":
        factor, offset = conversion_of_column(path, column, unit=given, wanted=unit, advice=advice)
        values = factor * values + offset
    wrong = ~np.isfinite(values)
    if wrong.any():
        row = int(wrong.argmax())
        raise ValueError(f"has {values[row]} as number {row + 1}: must contain finite numbers")
    return np.ascontiguousarray(values, np.float64)
