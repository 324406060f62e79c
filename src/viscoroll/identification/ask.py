"""From measurements to parameters: :func:`identify`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..checks import number
from ..cylinder import Cylinder
from ..errors import ParameterError
from ..errors import unknown as not_among
from .fit import Identification
from .problem import Found, Problem
from .records import Record
from .said import flat
from .search import minima
from .unknowns import Shift, Unknown, refuse_unshifted, unknowns_of


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
    """Fit what is unknown of a cylinder and its bearing to measurements, and say what they do not tell.

    Parameters
    ----------
    cylinder : what is known, and where the search starts.
    unknown : range (low, high) of each, SI, by the names of run files: R, m, mu, j, g, load; E, nu, T_ref of the
        material, E_1, tau_1 of its first, longest mode, over T_ref; the same of another half-space as base_E, base_E_1;
        brake, a constant torque of the bearing, N m/m, and drag, N m s/m, one that grows with omega; V0, omega0 and t0
        of a record "run" as "V0:run".  E multiplies the whole relaxation curve and T_ref all its times: with mu they
        are the whole job for a material of a DMA.
    data : :class:`Resistance`, :class:`Traction` and :class:`Coastdown`, all with values, or none: then what would be
        learnt if the cylinder, without a bearing, were the truth.
    prior : (value, standard deviation) of what is known beforehand; that of the logarithm, but for brake, drag, nu
        and unknowns of records.
    shift : a_T over the temperature of records: :class:`WLF`, :class:`Arrhenius` or a function, 1 at the temperature
        of the cylinder; where its bodies differ {"material": ..., "base": ...}.
    robust : let outliers count less, as |r| in place of r^2.
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
    given = {"material": shift, "base": shift} if callable(shift) else shift or {}
    records = _called(cylinder, data, given)
    unknowns = unknowns_of(cylinder, unknown, records)
    if not unknowns:
        raise ParameterError("unknown", "nothing", "at least one name and its range")
    problem = Problem(cylinder, unknowns, records, _priors(prior or {}, unknowns), bool(robust), given)
    points = problem.y.size + len(problem.prior)
    if points < len(unknowns) + any(one.estimated for one in problem.columns):
        sentence = f"{len(unknowns)} unknowns, but {points} points: measure more, give sigma, or leave unknowns out"
        raise ParameterError("unknown", len(unknowns), f"at most {points}", sentence)
    idle = flat(problem)
    problem.live = [i for i, name in enumerate(problem.names) if name not in idle]
    if next(iter(records.values())).planned:
        return Identification(problem, [Found(problem.start, problem.cost(problem.residuals(problem.start)))])
    for name, count, least in (("starts", starts, 1), ("seed", seed, 0)):
        if not (isinstance(count, (int, np.integer)) and count >= least):
            raise ParameterError(name, count, f"a whole number >= {least}")
    return Identification(problem, minima(problem, int(starts), seed, progress))


def _called(cylinder: Cylinder, data: Sequence[Record], shifts: Mapping[str, Shift]) -> dict[str, Record]:
    """The records by name; those without one are called by their kind."""
    found: dict[str, Record] = {}
    for record in [data] if isinstance(data, Record) else data:
        if not isinstance(record, Record):
            raise ParameterError("data", f"{record!r:.60}", "a list of Resistance, Traction and Coastdown")
        called, n = record.name or record.KIND, 1
        while called in found:
            n += 1
            if record.name:
                raise ParameterError("name", repr(record.name), "another for each record")
            called = f"{record.KIND} {n}"
        if record.planned and not record.sigma:
            raise ParameterError(f"{called}: sigma", None, "given where there are no values")
        if record.temperature is not None:
            refuse_unshifted(cylinder, called, record.temperature, shifts)
        found[called] = record
    if not found:
        raise ParameterError("data", "no record", "at least one")
    if len({record.planned for record in found.values()}) > 1:
        sentence = "some records have values and some have none: fit those first, then plan with its cylinder"
        raise ParameterError("data", "mixed", "all with values, or none", sentence)
    return found


def _priors(given: Mapping[str, tuple[float, float]], unknowns: list[Unknown]) -> list[tuple[int, float, float]]:
    """(Which coordinate, its mean, its standard deviation)."""
    found, names = [], [one.name for one in unknowns]
    for name, pair in given.items():
        if name not in names:
            raise not_among("prior", name, names, "an unknown")
        one = unknowns[names.index(name)]
        if np.shape(pair) != (2,):
            raise ParameterError(f"prior {name}", f"{pair!r:.40}", "(value, standard deviation)")
        low = -np.inf if one.unit is not None else 0.0
        mean = number(f"prior {name}", pair[0], low=low, strict=True)
        sd = number(f"standard deviation of prior {name}", pair[1], low=0.0, strict=True)
        found.append((names.index(name), float(one.to_u(mean)), sd if one.unit is None else sd / one.unit))
    return found
