"""Unknowns by the names that run files give their inputs: what they are of a cylinder, and a cylinder of such values.

A material's modes count from its longest time; names of the half-space begin with ``base_``, those of a record end
with its name, as V0:run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ...core.checks import checked, number
from ...core.errors import ParameterError, unknown
from ...cylinder import Cylinder
from ...materials.material import Material
from ...materials.prony import Prony
from .records import OF_RECORDS, Record

#: degrees Celsius -> a_T
Shift = Callable[[float], float]
_OWN = ("R", "m", "mu", "j", "g", "load")
_OF_BODY = ("E", "nu", "T_ref")
#: what goes linearly, others go by their logarithm
_LINEAR = ("brake", "drag", "nu", "base_nu", *OF_RECORDS)
#: of its range, the least unit of what is counted from 0
_UNIT = 0.1
_PREFIX = {"material": "", "base": "base_"}


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

    @property
    def least(self) -> float:
        """What it is above."""
        return 0.0 if self.unit is None else -math.inf

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
    starts = {name: getattr(cylinder, name) for name in _OWN} | {"brake": 0.0, "drag": 0.0}
    for section, body in _bodies(cylinder).items():
        starts |= {_PREFIX[section] + name: value for name, value in _inputs(body).items()}
    starts, ranges = {name: number(name, value) for name, value in starts.items()}, dict(given)
    for called, record in records.items():
        for name, (start, span) in record.starts(cylinder.R).items():
            starts[f"{name}:{called}"] = start
            if span is not None:
                ranges.setdefault(f"{name}:{called}", span)
    for asked, among, argument, kind in (
        (ranges, starts, "unknown", "an input"),
        (priors, ranges, "prior", "an unknown"),
    ):
        for name in asked:
            if name not in among:
                raise unknown(argument, name, among, kind)
    found = {name: _unknown(name, starts[name], span) for name, span in ranges.items()}
    return [*(found | {name: _known(found[name], pair) for name, pair in priors.items()}).values()]


def _unknown(name: str, start: float, span: Any) -> Unknown:
    called, ends = f"unknown {name}", checked(f"unknown {name}", span)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ParameterError(called, f"{span!r:.60}", "(low, high), low < high")
    low, high = ends.tolist()
    if not low <= start <= high:
        sentence = f"{called}: its range ({low:g}, {high:g}) must hold the start, here {start:.6g}"
        raise ParameterError(called, f"({low:g}, {high:g})", f"around {start:g}", sentence)
    linear = name.split(":")[0] in _LINEAR
    if not (linear or low > 0.0):
        raise ParameterError(called, f"({low:g}, {high:g})", "above 0: it goes by its logarithm")
    return Unknown(name, start, low, high, max(abs(start), _UNIT * (high - low)) if linear else None)


def _known(one: Unknown, pair: Any) -> Unknown:
    """With what is known beforehand."""
    called = f"prior {one.name}"
    if np.shape(pair) != (2,):
        raise ParameterError(called, f"{pair!r:.40}", "(value, standard deviation)")
    mean = number(called, pair[0], low=one.least, strict=True)
    sd = number(f"standard deviation of {called}", pair[1], low=0.0, strict=True)
    return one._replace(mean=float(one.to_u(mean)), sd=sd / (one.unit or 1.0))


def cylinder_of(
    cylinder: Cylinder,
    values: Mapping[str, float],
    record: Record | None = None,
    shifts: Mapping[str, Shift] = MappingProxyType({}),
) -> Cylinder:
    """The cylinder with other ``values``, at the load and the temperature of a record.

    Raises
    ------
    ParameterError
        Values that make no cylinder; a temperature without a shift of a body, or that the shift does not allow.
    """
    changes: dict[str, Any] = {name: values[name] for name in _OWN if name in values}
    bodies = _bodies(cylinder)
    made = {section: _changed(body, _PREFIX[section], values) for section, body in bodies.items()}
    if record is not None:
        changes |= record.own
        for section, body in made.items() if record.temperature is not None else ():
            made[section] = _warmed(body, section, record, shifts)
    if any(made[section] is not body for section, body in bodies.items()):
        changes |= made
    return cylinder.replace(**changes) if changes else cylinder


def _warmed(body: Material, section: str, record: Record, shifts: Mapping[str, Shift]) -> Material:
    if body.prony.alpha == 1.0:
        return body
    if section not in shifts:
        sentence = (
            f"{record.of('temperature')} = {record.temperature:g} needs a shift of the {section}, as vr.WLF(T0=20.0)"
        )
        raise ParameterError("temperature", record.temperature, "given with shift", sentence)
    return body.at(record.temperature, shifts[section])  # type: ignore[arg-type]


def _bodies(cylinder: Cylinder) -> dict[str, Material]:
    pair = cylinder.pair
    return {"material": pair.cylinder} | ({} if pair.base is None else {"base": pair.base})


def _inputs(body: Material) -> dict[str, float]:
    """All that may be unknown of a body, by name."""
    series = {"E": body.prony.E.tolist(), "tau": body.prony.tau.tolist()}
    modes = {f"{name}_{n}": value for name, column in series.items() for n, value in enumerate(column, 1)}
    return {name: getattr(body, name) for name in _OF_BODY} | modes


def _changed(body: Material, prefix: str, values: Mapping[str, float]) -> Material:
    whole = _inputs(body)
    own = {name: values[prefix + name] for name in whole if prefix + name in values}
    if not own:
        return body
    changes: dict[str, Any] = {name: own.pop(name) for name in _OF_BODY if name in own}
    if own:  # of the modes: it is no longer what was measured
        whole |= own
        strengths, times = (tuple(whole[name] for name in whole if name.startswith(of)) for of in ("E_", "tau_"))
        changes |= {"prony": _series(strengths, times), "measured": None}
    elif body.measured is not None and "T_ref" in changes:
        changes["measured"] = body.measured.shifted(changes["T_ref"] / body.T_ref)
    return replace(body, **changes)


@lru_cache(maxsize=256)
def _series(strengths: tuple[float, ...], times: tuple[float, ...]) -> Prony:
    """A series once: what does not change it pays no table of it."""
    return Prony(strengths, times)
