"""From measurements to parameters: :func:`identify`, by searches from several starts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from ...core.array_types import Floats
from ...core.checks import check_bool, check_integer
from ...core.errors import ParameterError, check_names
from ...cylinder import Cylinder
from ...materials.material_toml import SECTIONS
from .fit import Identification
from .problem import Found, Problem
from .records import OF_RECORDS, Record
from .unknowns import Shift, cylinder_of, unknowns_of

#: minima so far above the best are not told of: they are no alternatives
_ALTERNATIVE = 15.0
#: tolerance and steps of a search before it is known to be worth more, and the chi2 above the best of one that is not
_ROUGH, _STEPS, _HOPELESS = 1e-4, 60, 60.0
#: of a coordinate, how near its start a minimum is trusted to be the only one, and how far from it others are sought
_NEAR, _LEAP = 0.6, 3.0
#: what chi2 may rise by between two places of one minimum, and how near they are one place
_RIDGE, _SAME = 0.5, 1e-2


def identify(
    cylinder: Cylinder, unknown: Mapping[str, tuple[float, float]], data: Sequence[Record], *,
    prior: Mapping[str, tuple[float, float]] | None = None, shift: Shift | Mapping[str, Shift] | None = None,
    robust: bool = False, starts: int = 8, seed: int = 0, progress: bool = False,
) -> Identification:  # fmt: skip
    """Fit what is unknown of a cylinder and its bearing to measurements, and say what they do not tell.

    Parameters
    ----------
    cylinder : what is known, and where the search starts.
    unknown : range (low, high) of each, SI, by the names of run files: R, m, mu, j, g, load; E, nu, T_ref of the
        material, E_1, tau_1 of its first, longest mode, over T_ref; the same of another half-space as base_E, base_E_1;
        brake, a constant torque of the bearing, N m/m, and drag, N m s/m, one that grows with omega, both >= 0; V0,
        omega0 and t0 of a record "run" as "V0:run".  E multiplies the whole relaxation curve and T_ref all its times:
        with mu they are the whole job for a material of a DMA.
    data : :class:`Resistance`, :class:`Traction` and :class:`Coastdown`, all with values, or none: then what would be
        learnt if the cylinder, without a bearing, were the truth.
    prior : (value, standard deviation) of what is known beforehand; that of the logarithm, but for brake, drag, nu
        and unknowns of records.
    shift : a_T over the temperature of records: :class:`WLF`, :class:`Arrhenius` or a function, 1 at the temperature
        of the cylinder; where its bodies differ {"material": ..., "base": ...}.
    robust : let outliers count less, as |r| in place of r^2, of data and prior.
    starts : searches, the first from the cylinder, the others spread over the ranges.
    seed : of the latter.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Identification

    Raises
    ------
    ParameterError
        A name that is none, a range that does not hold the start, more unknowns than points, records without
        standard deviations where values are missing, records with and without values, two records of one name.
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
    count, seed, records = check_integer("starts", starts, 1), check_integer("seed", seed, 0), _called(data)
    for record in records.values():
        cylinder_of(cylinder, {}, record, shifts)  # refuses a temperature without a shift
    unknowns = unknowns_of(cylinder, unknown, records, prior)
    if not unknowns:
        raise ParameterError("unknown", "nothing", "at least one name and its range")
    problem = Problem(cylinder, unknowns, records, check_bool("robust", robust), shifts)
    most = problem.points - any(one.estimated for one in problem.columns)
    if len(unknowns) > most:
        allowed = f"at most {most} for {problem.points} points: measure more, give sigma, or leave unknowns out"
        raise ParameterError("unknown", f"{len(unknowns)} names", allowed)
    planned = not any(record.measured for record in records.values())
    return Identification(problem, _minima(problem, 1 if planned else count, seed, check_bool("progress", progress)))


def _called(data: Iterable[Record]) -> dict[str, Record]:
    """The records by name; those without one are called by their kind."""
    found: dict[str, Record] = {}
    for record in data:
        if not isinstance(record, Record):
            raise ParameterError("data", f"{record!r:.60}", "a list of Resistance, Traction and Coastdown")
        alike = sum(type(one) is type(record) and not one.name for one in found.values())
        called = record.name or (f"{record.KIND} {alike + 1}" if alike else record.KIND)
        if called in found:
            raise ParameterError("name", repr(called), "another for each record")
        if not record.sigma:
            raise ParameterError(f"{called}: sigma", None, "given where there are no values")
        found[called] = record
    if len({bool(record.measured) for record in found.values()}) != 1:
        allowed = "some with values, or some without: fit the former first, then plan with its cylinder"
        raise ParameterError("data", f"{len(found)} records", allowed)
    return found


def _minima(problem: Problem, count: int, seed: int, progress: bool) -> list[Found]:
    """All that the starts lead to and that are parted by a ridge, the best first."""
    from tqdm import tqdm

    first = problem.settled(problem.least(problem.start))
    starts = [*_spread(problem, count, seed), *_beyond(problem, first.u)]
    others = tqdm(starts, "identify", delay=1.0, leave=False, disable=not progress)
    tries = [first, *(problem.least(u, None, _ROUGH, _STEPS) for u in others)]
    good = min(found.chi2 for found in tries) + _HOPELESS
    near = [problem.least(one.u) for one in tries if one.chi2 < good]
    kept = [problem.settled(min(near, key=lambda found: found.chi2))]
    for one in sorted((Found(one.u, problem.cost(one.u)) for one in near), key=lambda one: one.chi2):
        if one.chi2 - kept[0].chi2 < _ALTERNATIVE and not any(_joined(problem, one, other) for other in kept):
            kept.append(one)
    return kept


def _spread(problem: Problem, count: int, seed: int) -> Iterator[Floats]:
    """A Latin hypercube over the ranges, but one place; what data start, as V0, stays there."""
    from scipy.stats import qmc

    free = [i for i in problem.live if problem.names[i].split(":")[0] not in OF_RECORDS]
    if count > 1 and free:
        for point in qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed)).random(count - 1):
            u = problem.start.copy()
            u[free] = problem.low[free] + point * (problem.high - problem.low)[free]
            yield u


def _beyond(problem: Problem, u: Floats) -> list[Floats]:
    """Places on either side of one far from the start, along what it knows least: ridges of a valley lie across it."""
    if np.abs(u - problem.start).max() < _NEAR:
        return []
    along = np.linalg.svd(problem.weighed(u)[1][:, problem.live])[2][-1]
    far = np.zeros(u.size)
    far[problem.live] = _LEAP * along / np.abs(along).max()
    return [np.clip(u + way, problem.low, problem.high) for way in (far, -far)]


def _joined(problem: Problem, one: Found, other: Found) -> bool:
    """Whether a way leads from one place to the other without a ridge: along what differs most, all else following."""
    apart = other.u - one.u
    which = int(np.argmax(np.abs(apart)))
    if abs(apart[which]) < _SAME:
        return True
    powers, top = np.eye(apart.size)[which], max(one.chi2, other.chi2) + _RIDGE
    ways = (one.u + share * apart for share in (0.5, 0.25, 0.75))
    return all(problem.least(u, powers, _ROUGH, _STEPS).chi2 < top for u in ways)
