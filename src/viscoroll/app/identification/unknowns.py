"""Unknowns by the names that run files give their inputs: what they are of a cylinder, and a cylinder of such values.

A material's modes count from its longest time; names of the half-space begin with ``base_``, those of a record end
with its name, as V0:run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...core.checks import check_array, check_number
from ...core.errors import ParameterError, check_names
from ...core.scale import si_unit
from ...cylinder import Cylinder
from ...materials.material import Material
from ...materials.prony import Prony
from .records import OF_RECORDS, Record

#: degrees Celsius -> a_T
Shift = Callable[[float], float]
_OWN = ("R", "m", "mu", "j", "g", "load")
_OF_BODY = ("E", "nu", "T_ref")
_PREFIX = {"material": "", "base": "base_"}
#: of the bearing
_BEARING = {"brake": 0.0, "drag": 0.0}
#: what goes linearly, and its least value; others, above 0, go by their logarithm
_LINEAR = _BEARING | dict.fromkeys(("nu", "base_nu", *OF_RECORDS), -math.inf)
#: of its range, the least unit of what is counted from 0
_UNIT = 0.1


class Unknown(NamedTuple):
    """Where it starts, and its range; ``unit`` is what a linear one is counted in, None of logarithms.

    mean, sd : of its coordinate, as known beforehand.
    """

    name: str
    start: float
    low: float
    high: float
    unit: float | None
    mean: float = 0.0
    sd: float = math.inf

    @staticmethod
    def bounds(name: str) -> dict[str, Any]:
        """What its values have to be, as of :func:`check_array`."""
        kind = name.split(":")[0]
        return {
            "unit": si_unit(kind.removeprefix(_PREFIX["base"])),
            "low": _LINEAR.get(kind, 0.0),
            "strict": kind not in _LINEAR,
        }

    def to_u(self, value: Any) -> Any:
        """The coordinate of a value."""
        return np.log(value) if self.unit is None else value / self.unit

    def to_value(self, u: Any) -> Any:
        """The value at a coordinate."""
        return np.exp(u) if self.unit is None else u * self.unit

    def spread(self, value: float) -> float:
        """How much the value changes with its coordinate."""
        return value if self.unit is None else self.unit


def unknowns_of(
    cylinder: Cylinder, given: Mapping[str, Any], records: Mapping[str, Record], priors: Mapping[str, Any]
) -> list[Unknown]:
    """The unknowns that are asked for, and those that records bring along.

    Raises
    ------
    ParameterError
        A name that is none, a range that does not hold the start, a cylinder with arrays; a prior of what is known.
    """
    starts = {name: getattr(cylinder, name) for name in _OWN} | _BEARING
    for section, body in _bodies(cylinder).items():
        starts |= {_PREFIX[section] + name: value for name, value in _inputs(body).items()}
    starts, ranges = {name: check_number(name, value) for name, value in starts.items()}, dict(given)
    for called, record in records.items():
        for name, (start, span) in record.starts(cylinder.R).items():
            starts[f"{name}:{called}"] = start
            if span is not None:
                ranges.setdefault(f"{name}:{called}", span)
    check_names("unknown", ranges, starts, "an input")
    check_names("prior", priors, ranges, "an unknown")
    return [_unknown(name, starts[name], span, priors.get(name)) for name, span in ranges.items()]


def _unknown(name: str, start: float, span: Any, prior: Any) -> Unknown:
    low, high = _pair("unknown", name, span, "(low, high), low < high")
    if not low < high:
        raise ParameterError(f"unknown {name}", f"{span!r:.60}", "(low, high), low < high")
    if not low <= start <= high:
        raise ParameterError(f"unknown {name}", f"({low:g}, {high:g})", f"a range that holds the start, {start:.6g}")
    linear = name.split(":")[0] in _LINEAR
    one = Unknown(name, start, low, high, max(abs(start), _UNIT * (high - low)) if linear else None)
    if prior is None:
        return one
    mean, sd = _pair("prior", name, prior, "(value, standard deviation)")
    sd = check_number(f"standard deviation of prior {name}", sd, low=0.0, strict=True)
    return one._replace(mean=float(one.to_u(mean)), sd=sd / (one.unit or 1.0))


def _pair(what: str, name: str, given: Any, allowed: str) -> list[float]:
    """Two numbers, each a value that the unknown may have."""
    bounds = Unknown.bounds(name)
    if what == "prior":  # the standard deviation is of a logarithm: one unit is none of both
        del bounds["unit"]
    pair = check_array(f"{what} {name}", given, **bounds)
    if pair.shape != (2,):
        raise ParameterError(f"{what} {name}", f"{given!r:.60}", allowed)
    return pair.tolist()


def cylinder_of(
    cylinder: Cylinder, values: Mapping[str, float], record: Record | None = None, shifts: Mapping[str, Shift] = {}
) -> Cylinder:
    """The cylinder with other ``values``, at the load and the temperature of a record.

    Raises
    ------
    ParameterError
        Values that make no cylinder; a temperature without a shift of a body, or that the shift does not allow.
    """
    changes: dict[str, Any] = {name: values[name] for name in _OWN if name in values}
    changes |= {} if record is None else record.own
    for section, body in _bodies(cylinder).items():
        made = _changed(body, _PREFIX[section], values)
        if record is not None and record.temperature is not None and body.prony.alpha > 1.0:
            if section not in shifts:
                allowed = f"given with a shift of the {section}, as vr.WLF(T0=20.0)"
                raise ParameterError(record.of("temperature"), record.temperature, allowed)
            made = made.at(record.temperature, shifts[section])
        if made is not body:
            changes[section] = made
    return cylinder.replace(**changes) if changes else cylinder


def _bodies(cylinder: Cylinder) -> dict[str, Material]:
    """Those that deform: nothing of a rigid one may be unknown."""
    bodies = zip(_PREFIX, (cylinder.pair.cylinder, cylinder.pair.base), strict=True)
    return {section: body for section, body in bodies if not (body is None or body.is_rigid)}


def _inputs(body: Material) -> dict[str, float]:
    """All that may be unknown of a body, by name."""
    series = {"E": body.prony.E.tolist(), "tau": body.prony.tau.tolist()}
    modes = {f"{name}_{n}": value for name, column in series.items() for n, value in enumerate(column, 1)}
    return {name: getattr(body, name) for name in _OF_BODY} | modes


def _changed(body: Material, prefix: str, values: Mapping[str, float]) -> Material:
    old = _inputs(body)
    new = {name: values.get(prefix + name, value) for name, value in old.items()}
    if new == old:
        return body
    changes: dict[str, Any] = {name: new.pop(name) for name in _OF_BODY}
    if any(new[name] != old[name] for name in new):  # of the modes: it is no longer what was measured
        modes, count = tuple(new.values()), body.prony.E.size
        changes |= {"prony": _series(modes[:count], modes[count:]), "measured": None}
    elif body.measured is not None:
        changes["measured"] = body.measured.shifted(changes["T_ref"] / body.T_ref)
    return replace(body, **changes)


@lru_cache(maxsize=256)
def _series(strengths: tuple[float, ...], times: tuple[float, ...]) -> Prony:
    """A series once: what does not change it pays no table of it."""
    return Prony(strengths, times)
