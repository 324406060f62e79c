"""Parameters of a cylinder from measurements: :func:`identify`, by searches from several starts.

:func:`read_measurements` reads its arguments from a TOML file with [cylinder], [unknown], [prior]
and [[data]].
"""

import dataclasses
import operator
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from ..core import (
    FileError,
    Floats,
    ParameterError,
    as_struct,
    check_bool,
    check_integer,
    check_keys,
    check_names,
    describe_value,
    described_error,
    read_toml,
    section_error,
    suggestion,
    warn_of_model,
)
from ..materials import SECTIONS
from ..presets import read_roller
from ..rollers import Cylinder
from .dma_columns import column_in_unit, meanings
from .identification_result import Identification
from .least_squares import Minimum, Problem
from .measurement_records import OF_RECORDS, Coastdown, Record, Resistance, Traction
from .text_table import Table, find_column, missing_column, named_table
from .unknowns import WITHOUT_LAW, Shift, cylinder_of, unknowns_of

# --- Parameters of a cylinder from measurements ---

#: chi2 above the best below which another minimum is reported: beyond, its likelihood is below 1e-3
#: of the best
_ALTERNATIVE = 15.0
#: relative tolerance of a first search, which finds the valley
_ROUGH = 1e-4
#: evaluations of a first search
_STEPS = 60
#: chi2 above the best of first searches up to which a search goes on to the minimum
_PROMISING = 60.0
#: distance of a coordinate from its start up to which a minimum is taken to be the only one: a
#: factor of 1.8
_NEAR = 0.6
#: distance of further starts from a minimum, in the coordinate that changes most: a factor of 20
_LEAP = 3.0
#: rise of chi2 between two points of one minimum that is still rounding of the searches
_RIDGE = 0.5
#: distance of coordinates up to which two points are one
_SAME = 1e-2


def identify(
    cylinder: Cylinder,
    unknown: Mapping[str, tuple[float, float]],
    data: Sequence[Record],
    *,
    prior: Mapping[str, tuple[float, float]] | None = None,
    shift: Shift | Mapping[str, Shift] | None = None,
    robust: bool = False,
    starts: int = 8,
    seed: int = 0,
    progress: bool = False,
) -> Identification:
    """Fit unknown parameters of a cylinder and its bearing to measurements, with intervals.

    Parameters
    ----------
    cylinder : the :class:`Cylinder`, without arrays, with all known parameters, and with the start
        values of the unknown ones.
    unknown : name -> range (low, high) of each unknown parameter, SI, by the names of run files: R,
        m, mu, j, g, load; E, nu, T_ref of the material; E_1, tau_1 of its first, longest mode,
        divided by E and T_ref; the same of another half-space as base_E, base_E_1; brake, a
        constant torque of the bearing, N m/m, and drag, a torque for each unit of omega, N m s/m,
        both >= 0; V0, omega0 and t0 of a record "run" as "V0:run".  E multiplies the whole
        relaxation curve and T_ref all its times: with mu they are all unknowns of a material that a
        DMA has measured.
    data : list of records, :class:`measurement_records.Resistance`,
        :class:`measurement_records.Traction` and :class:`measurement_records.Coastdown`, or one
        record.  All have values, or none has (a plan): then the result states the standard
        deviations to expect if the cylinder, without a bearing, is the truth.
    prior : name -> (value, standard deviation) of unknowns that are known roughly beforehand, SI or
        with units, None without; the standard deviation is that of the natural logarithm,
        dimensionless, but for brake, drag, nu and unknowns of records, of which it is that of the
        value, SI.
    shift : a_T over the temperature of records: :class:`WLF`, :class:`Arrhenius` or a function that
        takes degrees Celsius and returns a_T, relative to any temperature, as for
        :meth:`Material.at`: a material without a temperature is taken to be where a_T is 1; where
        its bodies differ {"material": ..., "base": ...}; None: the shifts of the materials
        themselves.
    robust : let outliers count less, as |r| in place of r^2, of data and prior.
    starts : number of searches, >= 1, the first from the cylinder, the others from points spread
        over the ranges; of a plan only the first.  Two more are made where the first one ends far
        from the cylinder.
    seed : seed of these points, >= 0.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Identification
        Values, standard deviations and intervals of the unknowns; ``print`` shows a report.

    Raises
    ------
    ParameterError
        Arguments of other types; a cylinder with arrays; an unknown name; a range that does not
        ascend or does not contain the start value; no unknowns, or more of them than points and
        priors together (less one, where a standard deviation is estimated); no records, a plan
        without standard deviations, records with and without values, two records of one name; an
        open V0 or omega0 of which the record has no data; a temperature of a record without a
        shift; a prior of what is no unknown; ``starts`` or ``seed`` out of range; ``progress``
        that is no truth value; a plan at whose start values there is no contact or no motion.

    Examples
    --------
    The friction of a roller, from its traction at two creep ratios:

    >>> import viscoroll as vr
    >>> roller = vr.presets.RUBBER_CYLINDER
    >>> delta = [-0.05, 0.05]
    >>> measured = vr.Traction(
    ...     V=1.0, delta=delta, Q=roller.contact(1.0, delta=delta).Q, sigma=0.1
    ... )
    >>> result = vr.identify(roller.replace(mu=0.5), {"mu": (0.1, 1.0)}, [measured])
    >>> round(result.values["mu"], 6)
    0.3
    """
    shifts = dict.fromkeys(SECTIONS, shift) if callable(shift) else {} if shift is None else shift
    data = [data] if isinstance(data, Record) else data
    prior = {} if prior is None else prior
    for name, value, kind, allowed in (
        ("cylinder", cylinder, Cylinder, "a Cylinder"),
        ("unknown", unknown, Mapping, "a dict with a range for each name, as {'mu': (0.1, 1.0)}"),
        ("data", data, Iterable, "a list of records: vr.Resistance, vr.Traction or vr.Coastdown"),
        (
            "shift",
            shifts,
            Mapping,
            "a vr.WLF, a vr.Arrhenius or a function that returns a_T of a temperature in degrees "
            "Celsius, or {'material': ..., 'base': ...} with one for each body",
        ),
        ("prior", prior, Mapping, "a dict {name: (value, standard deviation)}"),
    ):
        if not isinstance(value, kind):
            raise ParameterError(name, describe_value(value), allowed)
    check_names("shift", shifts, SECTIONS, "a body")
    count = check_integer("starts", starts, 1)
    seed = check_integer("seed", seed, 0)
    records = _records_by_name(data)
    for record in records.values():
        cylinder_of(cylinder, {}, record, shifts)  # refuses a temperature without a shift
    unknowns = unknowns_of(cylinder, unknown, records, prior)
    if not unknowns:
        raise described_error(
            "unknown",
            "names no parameter to be determined",
            "at least one with its range, as unknown={'mu': (0.1, 1.0)} (in a file mu = [0.1, 1.0] "
            "in [unknown])",
        )
    changing = [each.name for each in unknowns if each.kind not in WITHOUT_LAW]
    if changing and cylinder.scene().tabulated:
        raise described_error(
            "coupled",
            "of the cylinder is not False, and the coupled solution would need a table for each "
            f"trial value of {changing[0]}",
            "False in the Cylinder (in a file: coupled = false in [cylinder]); then the fast law "
            "is used, whose error cylinder.validity(V) states",
        )
    problem = Problem(
        cylinder=cylinder,
        unknowns=unknowns,
        records=records,
        robust=check_bool("robust", robust),
        shifts=shifts,
    )
    # a standard deviation that is estimated needs one degree of freedom
    most = problem.points - any(column.estimated for column in problem.columns)
    if len(unknowns) > most:
        raise ParameterError(
            "number of unknowns",
            f"{len(unknowns)} ({', '.join(each.name for each in unknowns)})",
            f"at most {most}, the number of values in the records and of priors"
            f"{', less one as sigma is not given' * (most < problem.points)}: give more points"
            f"{' or sigma' * (most < problem.points)}, or fewer unknowns",
        )
    return Identification(
        problem,
        _find_minima(
            problem, 1 if problem.planned else count, seed, check_bool("progress", progress)
        ),
    )


def _records_by_name(data: Iterable[Record]) -> dict[str, Record]:
    """Return the records by name; those without a name get that of their kind, as "resistance",
    then "resistance 2".

    data : what the caller gave, which should be records, all with values or all without.
    Returns a dict, name -> :class:`Record`, in the order of ``data``, at least one.
    Raises ParameterError for what is no record, no records, two records of one name, a plan without
    sigma, and a mixture of data and plans.
    """
    found: dict[str, Record] = {}
    for record in data:
        if not isinstance(record, Record):
            raise described_error(
                "data",
                f"contains {describe_value(record)}",
                "a list of vr.Resistance, vr.Traction and vr.Coastdown",
            )
        # records of the same kind before that were given no name either
        alike = sum(type(other) is type(record) and not other.name for other in found.values())
        name = record.name or (f"{record.LABEL} {alike + 1}" if alike else record.LABEL)
        if name in found:
            raise ParameterError("name", repr(name), "different for each record: give name=")
        if not record.sigma:
            raise described_error(
                f"{name}: sigma",
                "is not given",
                f"given for a record without values of {' or '.join(record.QUANTITIES)} (a plan); "
                "if there are measured values, give these",
            )
        found[name] = record
    if not found:
        raise described_error("data", "is empty", "at least one record")
    planned = [name for name, record in found.items() if not record.measured]
    if 0 < len(planned) < len(found):
        raise described_error(
            "data",
            f"has measured values in some records, but none in {', '.join(planned)}",
            "records that all have measured values, or that all have none (plans).  Give the "
            "missing values; or call identify with the measured records, and then with the others "
            "and the attribute cylinder of the result",
        )
    return found


def _find_minima(problem: Problem, count: int, seed: int, progress: bool) -> list[Minimum]:
    """Return the best minimum of chi2, and other minima nearly as good, in other valleys of chi2.

    All searches but the first are rough at first; those that come within 60 of the least chi2 go on
    to the minimum.  The standard deviations of ``problem`` that were not given are estimated on the
    way, in place: those of the first minimum weigh the searches, and those of the best minimum, at
    the end, weigh the chi2 that is returned.

    problem : :class:`Problem`, the least squares; its ``sigma`` is changed.
    count : number of searches, >= 1, the first from the start of the problem; if that goes more
        than 0.6 in any coordinate, two more are added (:func:`_starts_across_valley`).
    seed : seed of the other starts, >= 0.
    progress : whether a progress bar is drawn on standard error, after one second.
    Returns a list of :class:`.least_squares.Minimum`, at least one: first the best one before the
    last estimate of standard deviations, minimised again after it; then in ascending order of chi2
    those whose chi2 is less than 15 above it, one for each valley.  The others keep their
    coordinates,
    with the chi2 that the last standard deviations give there.
    """
    from tqdm import tqdm

    first = problem.estimate_sigma(problem.minimize(problem.start))
    starts = [*_latin_hypercube(problem, count, seed), *_starts_across_valley(problem, first.u)]
    others = tqdm(starts, "identify", delay=1.0, leave=False, disable=not progress)
    rough = [first, *(problem.minimize(u, None, _ROUGH, _STEPS) for u in others)]
    limit = min(found.chi2 for found in rough) + _PROMISING
    exact = [problem.minimize(found.u) for found in rough if found.chi2 < limit]
    minima = [problem.estimate_sigma(min(exact, key=_chi2))]
    # of sigma as estimated at the best one
    for found in sorted((Minimum(found.u, problem.cost(found.u)) for found in exact), key=_chi2):
        near = found.chi2 - minima[0].chi2 < _ALTERNATIVE
        if near and not any(_in_same_valley(problem, found, other) for other in minima):
            minima.append(found)
    return minima


_chi2 = operator.attrgetter("chi2")


def _latin_hypercube(problem: Problem, count: int, seed: int) -> Iterator[Floats]:
    """Yield starts in a Latin hypercube over the ranges of the coordinates.

    Unknowns of records, as V0, and those that do not act stay at their start.

    problem : :class:`Problem`, the least squares.
    count : number of starts plus 1, as the first search began from the start of the problem; 1:
        nothing is yielded.
    seed : seed of the hypercube, >= 0.
    Yields coordinates of a start, (unknowns,), ``count`` - 1 times, if another unknown acts.
    """
    from scipy import stats

    free = [i for i in problem.active if problem.unknowns[i].kind not in OF_RECORDS]
    if count > 1 and free:
        cube = stats.qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed))
        for point in cube.random(count - 1):
            u = problem.start.copy()
            u[free] = problem.low[free] + point * (problem.high - problem.low)[free]
            yield u


def _starts_across_valley(problem: Problem, u: Floats) -> list[Floats]:
    """Return two starts of a search, on both sides of a minimum in its least determined direction.

    Other valleys of chi2 lie beyond ridges across that direction.  It is the right singular vector
    of the weighted slopes with the least singular value.

    problem : :class:`Problem`, the least squares.
    u : coordinates of the minimum, (unknowns,).
    Returns two vectors of coordinates, (unknowns,) each, 3 from the minimum in the coordinate that
    changes most, or at the ends of the ranges; [] where the minimum is within 0.6 of the start in
    every coordinate, and is then taken to be the only one.
    """
    if np.abs(u - problem.start).max() < _NEAR:
        return []
    along = np.linalg.svd(problem.weighted(u)[1][:, problem.active])[2][-1]
    far = np.zeros(u.size)
    far[problem.active] = _LEAP * along / np.abs(along).max()
    return [np.clip(u + step, problem.low, problem.high) for step in (far, -far)]


def _in_same_valley(problem: Problem, first: Minimum, other: Minimum) -> bool:
    """Return whether chi2 has no ridge between two minima, so that they count as one.

    At a half, a quarter and three quarters of the way chi2 is minimised with the coordinate that
    differs most fixed and all others free; a minimum that is 0.5 or more above the higher of the
    two shows a ridge.

    problem : :class:`Problem`, the least squares.
    first, other : :class:`Minimum`, the two minima.
    Returns True also if all coordinates are the same to 0.01, without a search.
    """
    difference = other.u - first.u
    largest = np.argmax(np.abs(difference))
    if abs(difference[largest]) < _SAME:
        return True
    powers = np.eye(difference.size)[largest]
    top = max(first.chi2, other.chi2) + _RIDGE
    between = (first.u + part * difference for part in (0.5, 0.25, 0.75))
    return all(problem.minimize(u, powers, _ROUGH, _STEPS).chi2 < top for u in between)


# --- A TOML file of measurements, a cylinder, [unknown], [prior] and [[data]] ---

#: section of the file -> its type
_SECTIONS = {"unknown": dict, "prior": dict, "data": list}
#: kind of [[data]] -> record
_KINDS: dict[str, type[Record]] = {
    "resistance": Resistance,
    "traction": Traction,
    "coastdown": Coastdown,
}
#: quantity that a heading says -> names that a record may have for it
_SAID = {
    "speed": ("V",),
    "time": ("t",),
    "angular velocity": ("omega",),
    "angular frequency": ("omega",),
    "rotational speed": ("omega",),
    "moment": ("M",),
    "force": ("F", "Q"),
    "creepage": ("delta",),
    "path": ("x",),
}
#: word for an initial speed that is unknown, None in Python
_UNKNOWN = "unknown"


class _Section(msgspec.Struct):
    """Keys of [[data]] that all kinds of record have, as :func:`_record` describes them."""

    kind: str
    file: str
    decimal: str = ""
    encoding: str = ""
    columns: dict[str, str] = {}
    units: dict[str, str] = {}


def read_measurements(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read the arguments of :func:`identify` from a TOML file and the files of data that it names.

    Parameters
    ----------
    path : path of the TOML file.  It has the sections [cylinder] (the known parameters and the
        initial guess), [unknown] (NAME = [LOW, HIGH]), [[data]] (a record each) and perhaps
        [prior] (NAME = [VALUE, STANDARD DEVIATION]), [material] and [base]; numbers are in SI
        units.

    Returns
    -------
    dict
        Arguments of :func:`identify` by name:

        - "cylinder": the :class:`Cylinder`;
        - "unknown", "prior": dicts, name -> list of two numbers as the file has them, not checked
          here; without [prior] that dict is empty;
        - "data": list of the records, as :class:`Resistance`, in the order of the file.

    Raises
    ------
    FileError
        A file that cannot be read, a misspelt key, a value of the wrong type or out of range, with
        its line; a [scene]; no [unknown] or [[data]]; data that cannot be read, or lack a column.

    Warns
    -----
    ModelWarning
        Columns of a file of data that are left out.

    Examples
    --------
    >>> from viscoroll.measurements.identify import read_measurements
    >>> vr.identify(**read_measurements(vr.datasets.path("measured.toml")))  # doctest: +SKIP
    """
    cylinder = read_roller(path, tuple(_SECTIONS))
    content = {"prior": {}} | read_toml(path)  # the one section that may be missing
    if not isinstance(cylinder, Cylinder):
        key = "scene" if "scene" in content else "preset"
        found = "[scene]" if key == "scene" else f"preset = {content[key]!r:.40}"
        problem = (
            f"{found} is dimensionless, but measurements are in SI units: replace it by [cylinder]"
        )
        raise section_error(path, "", key, problem)
    for section, kind in _SECTIONS.items():
        if not isinstance(given := content.get(section), kind):
            header = "[[data]]" if kind is list else f"[{section}]"
            found = f"{section} = {given!r:.40}: must be a section with the header {header}"
            raise section_error(
                path, "", section, found if section in content else f"section {header} is missing"
            )
    data = [
        _record(Path(path), section, number) for number, section in enumerate(content["data"], 1)
    ]
    return {
        "cylinder": cylinder,
        "data": data,
        "unknown": content["unknown"],
        "prior": content["prior"],
    }


def _record(path: Path, content: Any, number: int) -> Record:
    """Return the record of one [[data]].

    path : path of the TOML file, from whose folder files of data are found.
    content : the section as the TOML reader gives it, a dict:
        kind, "resistance", "traction" or "coastdown";
        file, path of the data, relative to the folder of the TOML file;
        decimal, "." or ",", and encoding, both optional, "" for what the file shows;
        columns, name -> heading, and units, name -> unit, both optional;
        fields of the record but coordinates and quantities, as sigma, load or V0, in SI units, all
        optional; "unknown" stands for None, but for a name.
    number : which of the sections [[data]] it is, from 1.
    Returns a :class:`measurement_records.Resistance`, :class:`measurement_records.Traction` or
    :class:`measurement_records.Coastdown`, a plan where the file has no quantity.
    Raises FileError for unknown keys, wrong types, values that make no record, and as
    :func:`_columns` does, whose ParameterError becomes a FileError too.
    """
    header = f"data {number}" if number > 1 else "data"
    given = content.get("kind") if isinstance(content, dict) else None
    kind = _KINDS.get(str(given))
    if kind is None:
        found = "kind is missing" if given is None else f"kind = {given!r:.40}"
        raise section_error(
            path,
            header,
            "kind",
            f"{found}: must be one of {', '.join(_KINDS)}{suggestion(str(given), _KINDS)}",
        )
    columns = (*kind.COORDINATES, *kind.QUANTITIES)
    # fields of any type: the record checks their values
    own = [
        (field.name, Any, field.default)
        for field in dataclasses.fields(kind)
        if field.init and field.name not in columns
    ]
    keys = msgspec.defstruct("Data", own, bases=(_Section,))
    section: Any = as_struct(path, header, content, keys)
    for name in ("columns", "units"):
        check_keys(path, f"{header}.{name}", getattr(section, name), columns)
    more: Any = {name: getattr(section, name) for name, *_ in own}
    more |= {name: None for name in more if more[name] == _UNKNOWN and name != "name"}
    try:
        return kind(**more, **_columns(path.parent / section.file, kind, section))
    except ParameterError as error:
        raise FileError(path, f"in [[data]] of {section.file}, {error}") from error


def _columns(path: Path, kind: type[Record], section: Any) -> dict[str, Any]:
    """Read coordinates and quantities from a file of data, in SI units.

    path : path of the file of data.
    kind : class of the record, whose names of coordinates and quantities the columns have, or words
    for them (:func:`_said`), where the section names none.
    section : the [[data]] with its attributes ``columns``, name -> heading; ``units``, name -> unit
        in place of that of the file; ``decimal`` and ``encoding``, "" for what the file shows.
    Returns a dict, name of each coordinate, and of each quantity that the file has -> values, SI,
    (n,); columns without a unit are taken in SI units.

    Raises
    ------
    FileError
        A file that cannot be read; a coordinate, or a column that the section names or gives a unit
        of, that is missing; other columns where none is a quantity, since one of them may be; a
        cell that is no number.
    ParameterError
        A column whose unit has another dimension, or may be of turns or of radians.

    Warns
    -----
    ModelWarning
        Columns that are left out.
    """
    names = (*kind.COORDINATES, *kind.QUANTITIES)
    headings = dict(zip(names, names)) | section.columns
    table = named_table(path, headings.values(), section.decimal or None, section.encoding or None)
    headings |= _said(table, headings.keys() - section.columns)
    present = {
        name: index
        for name, heading in headings.items()
        if (index := find_column(table, heading)) is not None
    }
    for name in (*kind.COORDINATES, *section.columns, *section.units):
        if name not in present:
            raise missing_column(
                table,
                headings[name],
                f"; state the heading of {name} in [[data]], as columns = {{ {name} = 'HEADING' }}",
            )
    others = [
        repr(heading)
        for n, heading in enumerate(table.headings)
        if heading and n not in present.values()
    ]
    if others and present.keys().isdisjoint(kind.QUANTITIES):
        name = kind.QUANTITIES[0]
        raise FileError(
            path,
            f"has no column {' or '.join(kind.QUANTITIES)}, but {', '.join(others)}, whose meaning "
            f"is not known: if one is {name}, for example, write columns = {{ {name} = 'HEADING' "
            "} in [[data]]; if nothing was measured (a plan), remove the column",
        )
    if others:
        warn_of_model(f"{path.name}: unused columns: {', '.join(others)}")
    found = {}
    for name in present:
        unit = kind.unit(name)
        try:
            found[name] = column_in_unit(table, headings[name], unit, section.units.get(name, ""))
        except ParameterError as error:
            per = (
                " (per metre of length of the cylinder: divide numbers for the whole cylinder by "
                "its length)" * unit.endswith(" m-1")
            )
            raise described_error(
                name,
                f"has the unit {error.value}",
                f"in a unit of the dimension of {unit}{per}; if the heading has a wrong unit, "
                f"write units = {{ {name} = 'UNIT' }} in [[data]]",
            ) from error
    return found


def _said(table: Table, names: set[str]) -> dict[str, str]:
    """Return the headings that say a quantity in words, as "Speed [km/h]" and "Zeit (s)".

    table : :class:`.text_table.Table` of a file of data.
    names : names of coordinates and quantities that the user has not named a column of.
    Returns a dict, name -> heading, of those of ``names`` that are no heading themselves.
    Raises FileError where two headings say one.
    """
    found: dict[str, str] = {}
    for n, heading in enumerate(table.headings):
        said = {
            name for each in meanings(heading, table.units[n]) for name in _SAID.get(each.name, ())
        }
        for name in said & names:
            if table.has_numbers(n) and find_column(table, name) is None:
                if name in found:
                    raise FileError(
                        table.path,
                        f"{found[name]!r} and {heading!r} may both be {name}: name one in "
                        f"[[data]], as columns = {{ {name} = {found[name]!r} }}",
                    )
                found[name] = heading
    return found
