"""Parameters of a cylinder from measurements: :func:`identify`, by searches from several starts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from operator import attrgetter

import numpy as np

from ...core.array_types import Floats
from ...core.checks import check_bool, check_integer
from ...core.errors import ParameterError, check_names, described_error
from ...cylinder import Cylinder
from ...materials.material_toml import SECTIONS
from .fit import Identification
from .problem import Minimum, Problem
from .records import OF_RECORDS, Record
from .unknowns import Shift, cylinder_of, unknowns_of

#: chi2 above the best below which another minimum is reported: beyond, its likelihood is below 1e-3 of the best
_ALTERNATIVE = 15.0
#: relative tolerance of a first search, which finds the valley
_ROUGH = 1e-4
#: evaluations of a first search
_STEPS = 60
#: chi2 above the best of first searches up to which a search goes on to the minimum
_PROMISING = 60.0
#: distance of a coordinate from its start up to which a minimum is taken to be the only one: a factor of 1.8
_NEAR = 0.6
#: distance of further starts from a minimum, in the coordinate that changes most: a factor of 20
_LEAP = 3.0
#: rise of chi2 between two points of one minimum that is still rounding of the searches
_RIDGE = 0.5
#: distance of coordinates up to which two points are one
_SAME = 1e-2


def identify(
    cylinder: Cylinder, unknown: Mapping[str, tuple[float, float]], data: Sequence[Record], *,
    prior: Mapping[str, tuple[float, float]] | None = None, shift: Shift | Mapping[str, Shift] | None = None,
    robust: bool = False, starts: int = 8, seed: int = 0, progress: bool = False,
) -> Identification:  # fmt: skip
    """Fit unknown parameters of a cylinder and its bearing to measurements, with intervals and limits of the data.

    Parameters
    ----------
    cylinder : the :class:`Cylinder`, without arrays, with all known parameters, and with the start values of the
        unknown ones.
    unknown : name -> range (low, high) of each unknown parameter, SI, by the names of run files: R, m, mu, j, g, load;
        E, nu, T_ref of the material; E_1, tau_1 of its first, longest mode, divided by E and T_ref; the same of another
        half-space as base_E, base_E_1; brake, a constant torque of the bearing, N m/m, and drag, a torque for each unit
        of omega, N m s/m, both >= 0; V0, omega0 and t0 of a record "run" as "V0:run".  E multiplies the whole
        relaxation curve and T_ref all its times: with mu they are all unknowns of a material that a DMA has measured.
    data : list of records, :class:`Resistance`, :class:`Traction` and :class:`Coastdown`, or one record.  All have
        values, or none has (a plan): then the result states the standard deviations to expect if the cylinder, without
        a bearing, is the truth.
    prior : name -> (value, standard deviation) of unknowns that are known roughly beforehand, SI, None without; the
        standard deviation is that of the natural logarithm, dimensionless, but for brake, drag, nu and unknowns of
        records, of which it is that of the value, SI.
    shift : a_T over the temperature of records: :class:`WLF`, :class:`Arrhenius` or a function that takes degrees
        Celsius and returns a_T, 1 at the temperature of the cylinder; None without temperatures of records; where its
        bodies differ {"material": ..., "base": ...}.
    robust : let outliers count less, as |r| in place of r^2, of data and prior.
    starts : number of searches, >= 1, the first from the cylinder, the others from points spread over the ranges; of a
        plan only the first.  Two more are made where the first one ends far from the cylinder.
    seed : seed of these points, >= 0.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Identification
        Values, standard deviations and intervals of the unknowns; ``print`` shows a report.

    Raises
    ------
    ParameterError
        Arguments of other types; a cylinder with arrays; an unknown name; a range that does not ascend or does not
        contain the start value; no unknowns, or more of them than points and priors together (less one, where a
        standard deviation is estimated); no records, a plan without standard deviations, records with and without
        values, two records of one name; an open V0 or omega0 of which the record has no data; a temperature of a record
        without ``shift``; a prior of what is no unknown; ``starts`` or ``seed`` out of range; ``progress`` that is no
        truth value; a plan at whose start values there is no contact or no motion.

    Examples
    --------
    The friction of a roller, from its traction at two creep ratios:

    >>> import viscoroll as vr
    >>> roller = vr.presets.RUBBER_CYLINDER
    >>> delta = [-0.05, 0.05]
    >>> measured = vr.Traction(V=1.0, delta=delta, Q=roller.contact(1.0, delta=delta).Q, sigma=0.1)
    >>> result = vr.identify(roller.replace(mu=0.5), {"mu": (0.1, 1.0)}, [measured])
    >>> round(result.values["mu"], 6)
    0.3
    """
    shifts = dict.fromkeys(SECTIONS, shift) if callable(shift) else shift or {}
    data, prior = [data] if isinstance(data, Record) else data, prior or {}
    for name, value, kind, allowed in (
        ("cylinder", cylinder, Cylinder, "a Cylinder"), ("unknown", unknown, Mapping, "{name: (low, high)}"),
        ("data", data, Iterable, "a list of records"), ("shift", shifts, Mapping, "a function, or one for each body"),
        ("prior", prior, Mapping, "{name: (value, standard deviation)}"),
    ):  # fmt: skip
        if not isinstance(value, kind):
            raise ParameterError(name, f"{value!r:.60}", allowed)
    check_names("shift", shifts, SECTIONS, "a body")
    count, seed, records = check_integer("starts", starts, 1), check_integer("seed", seed, 0), _records_by_name(data)
    for record in records.values():
        cylinder_of(cylinder, {}, record, shifts)  # refuses a temperature without a shift
    unknowns = unknowns_of(cylinder, unknown, records, prior)
    if not unknowns:
        raise described_error("unknown", "is empty", "at least one name and its range")
    problem = Problem(cylinder, unknowns, records, check_bool("robust", robust), shifts)
    most = problem.points - any(column.estimated for column in problem.columns)
    if len(unknowns) > most:
        allowed = f"at most {most}, since the number of points is {problem.points}: give more points, or sigma"
        raise ParameterError("number of unknowns", len(unknowns), allowed)
    return Identification(
        problem, _find_minima(problem, 1 if problem.planned else count, seed, check_bool("progress", progress))
    )


def _records_by_name(data: Iterable[Record]) -> dict[str, Record]:
    """Return the records by name; those without a name get that of their kind, as "resistance", then "resistance 2".

    data : what the caller gave, which should be records, all with values or all without.
    Returns a dict, name -> :class:`Record`, in the order of ``data``, at least one.
    Raises ParameterError for what is no record, no records, two records of one name, a plan without sigma, and a
    mixture of data and plans.
    """
    found: dict[str, Record] = {}
    for record in data:
        if not isinstance(record, Record):
            raise ParameterError("data", f"{record!r:.60}", "a list of Resistance, Traction and Coastdown")
        alike = sum(type(other) is type(record) and not other.name for other in found.values())
        name = record.name or (f"{record.LABEL} {alike + 1}" if alike else record.LABEL)
        if name in found:
            raise ParameterError("name", repr(name), "different for each record")
        if not record.sigma:
            raise ParameterError(f"{name}: sigma", None, "given for a record without values")
        found[name] = record
    if not found:
        raise described_error("data", "is empty", "at least one record")
    if len({bool(record.measured) for record in found.values()}) != 1:
        allowed = "one kind: fit the records with values first, then plan with the fitted cylinder"
        raise described_error("data", "has records with values and records without", allowed)
    return found


def _find_minima(problem: Problem, count: int, seed: int, progress: bool) -> list[Minimum]:
    """Return the best minimum of chi2, and other minima that are nearly as good and lie in other valleys of chi2.

    All searches but the first are rough at first; those that come within 60 of the least chi2 go on to the minimum.
    The standard deviations of ``problem`` that were not given are estimated on the way, in place: those of the first
    minimum weigh the searches, and those of the best minimum, at the end, weigh the chi2 that is returned.

    problem : :class:`Problem`, the least squares; its ``sigma`` is changed.
    count : number of searches, >= 1, the first from the start of the problem; if that goes more than 0.6 in any
        coordinate, two more are added (:func:`_starts_across_valley`).
    seed : seed of the other starts, >= 0.
    progress : whether a progress bar is drawn on standard error, after one second.
    Returns a list of :class:`.problem.Minimum`, at least one: first the best one before the last estimate of standard
    deviations, minimised again after it; then in ascending order of chi2 those whose chi2 is less than 15 above it, one
    for each valley.  The others keep their coordinates, with the chi2 that the last standard deviations give there.
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
        if found.chi2 - minima[0].chi2 < _ALTERNATIVE:
            if not any(_in_same_valley(problem, found, other) for other in minima):
                minima.append(found)
    return minima


_chi2 = attrgetter("chi2")


def _latin_hypercube(problem: Problem, count: int, seed: int) -> Iterator[Floats]:
    """Yield starts in a Latin hypercube over the ranges of the coordinates.

    Unknowns of records, as V0, and those that do not act stay at their start.

    problem : :class:`Problem`, the least squares.
    count : number of starts plus 1, as the first search began from the start of the problem; 1: nothing is yielded.
    seed : seed of the hypercube, >= 0.
    Yields coordinates of a start, (unknowns,), ``count`` - 1 times; nothing where no other unknown acts.
    """
    from scipy.stats import qmc

    free = [i for i in problem.active if problem.names[i].split(":")[0] not in OF_RECORDS]
    if count > 1 and free:
        for point in qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed)).random(count - 1):
            u = problem.start.copy()
            u[free] = problem.low[free] + point * (problem.high - problem.low)[free]
            yield u


def _starts_across_valley(problem: Problem, u: Floats) -> list[Floats]:
    """Return two starts of a search, on either side of a minimum along the direction that the data determine least.

    Other valleys of chi2 lie beyond ridges across that direction.  It is the right singular vector of the weighted
    slopes with the least singular value.

    problem : :class:`Problem`, the least squares.
    u : coordinates of the minimum, (unknowns,).
    Returns two vectors of coordinates, (unknowns,) each, 3 from the minimum in the coordinate that changes most, or at
    the ends of the ranges; [] where the minimum is within 0.6 of the start in every coordinate, and is then taken to be
    the only one.
    """
    if np.abs(u - problem.start).max() < _NEAR:
        return []
    along = np.linalg.svd(problem.weighted(u)[1][:, problem.active])[2][-1]
    far = np.zeros(u.size)
    far[problem.active] = _LEAP * along / np.abs(along).max()
    return [np.clip(u + step, problem.low, problem.high) for step in (far, -far)]


def _in_same_valley(problem: Problem, first: Minimum, other: Minimum) -> bool:
    """Return whether chi2 has no ridge between two minima, so that they count as one.

    At a half, a quarter and three quarters of the way chi2 is minimised with the coordinate that differs most fixed and
    all others free; a minimum that is 0.5 or more above the higher of the two shows a ridge.

    problem : :class:`Problem`, the least squares.
    first, other : :class:`Minimum`, the two minima.
    Returns True also if all coordinates are the same to 0.01, without a search.
    """
    difference = other.u - first.u
    largest = int(np.argmax(np.abs(difference)))
    if abs(difference[largest]) < _SAME:
        return True
    powers, top = np.eye(difference.size)[largest], max(first.chi2, other.chi2) + _RIDGE
    between = (first.u + part * difference for part in (0.5, 0.25, 0.75))
    return all(problem.minimize(u, powers, _ROUGH, _STEPS).chi2 < top for u in between)
