"""Unknowns by the names that run files give their inputs: what they are of a cylinder, and a cylinder of such values.

A material's modes count from its longest time; names of the half-space begin with ``base_``, those of a record end
with its name, as V0:run.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ..checks import checked, number
from ..cylinder import Cylinder
from ..errors import ParameterError, unknown
from ..materials.material import Material
from ..materials.prony import Prony
from .records import Record

#: degrees Celsius -> a_T
Shift = Callable[[float], float]
_OWN = ("R", "m", "mu", "j", "g", "load")
_OF_BODY = ("E", "nu", "T_ref")
OF_RECORDS = ("V0", "omega0", "t0")
#: what goes linearly, others go by their logarithm
_LINEAR = ("brake", "drag", "nu", "base_nu", *OF_RECORDS)
_MODE = re.compile(r"(E|tau)_(\d+)$")
#: of its range, the least unit of what is counted from 0
_UNIT = 0.1


class Unknown(NamedTuple):
    """Where it starts, and its range; ``unit`` is what a linear one is counted in, None of logarithms."""

    name: str
    start: float
    low: float
    high: float
    unit: float | None

    def to_u(self, value: Any) -> Any:
        """The coordinate of a value."""
        return np.log(value) if self.unit is None else value / self.unit

    def to_value(self, u: Any) -> Any:
        """The value at a coordinate."""
        return np.exp(u) if self.unit is None else u * self.unit

    def spread(self, value: float) -> float:
        """How much the value changes with its coordinate."""
        return value if self.unit is None else self.unit


def _bodies(cylinder: Cylinder) -> dict[str, Material]:
    """By section; names of the half-space have a prefix."""
    pair = cylinder.pair
    return {"material": pair.cylinder} | ({} if pair.base is None else {"base": pair.base})


def _prefix(section: str) -> str:
    return "base_" if section == "base" else ""


def _starts(cylinder: Cylinder) -> dict[str, float]:
    """All that may be unknown of a cylinder and its bearing, by name."""
    values = {name: getattr(cylinder, name) for name in _OWN} | {"brake": 0.0, "drag": 0.0}
    for section, body in _bodies(cylinder).items():
        modes = {
            f"{name}_{n}": value
            for name, column in (("E", body.prony.E), ("tau", body.prony.tau))
            for n, value in enumerate(column.tolist(), 1)
        }
        own = {name: getattr(body, name) for name in _OF_BODY} | modes
        values |= {_prefix(section) + name: value for name, value in own.items()}
    return {name: number(name, value) for name, value in values.items()}


def refuse_unshifted(cylinder: Cylinder, called: str, temperature: float, shifts: Mapping[str, Shift]) -> None:
    """Raise ParameterError for a temperature at which the times of a body are not known."""
    for section, body in _bodies(cylinder).items():
        if body.prony.alpha > 1.0 and section not in shifts:
            sentence = f"{called}: temperature = {temperature:g} needs a shift of the {section}, as vr.WLF(T0=20.0)"
            raise ParameterError("temperature", temperature, "given with shift", sentence)


def unknowns_of(cylinder: Cylinder, given: Mapping[str, Any], records: Mapping[str, Record]) -> list[Unknown]:
    """The unknowns that are asked for, and those that records bring along.

    Raises
    ------
    ParameterError
        A name that is none, a range that does not hold the start, a cylinder with arrays.
    """
    starts, ranges = _starts(cylinder), dict(given)
    for called, record in records.items():
        for name, (start, span) in record.starts(cylinder).items():
            starts[f"{name}:{called}"] = start
            if span is not None:
                ranges.setdefault(f"{name}:{called}", span)
    for name in ranges:
        if name not in starts:
            raise unknown("unknown", name, starts, "an input")
    return [_unknown(name, starts[name], span) for name, span in ranges.items()]


def _unknown(name: str, start: float, span: Any) -> Unknown:
    called, ends = f"unknown {name}", checked(f"unknown {name}", span)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ParameterError(called, f"{span!r:.60}", "(low, high), low < high")
    low, high = ends.tolist()
    if not low <= start <= high:
        sentence = f"{called}: its range ({low:g}, {high:g}) must hold the start, here {start:.6g}"
        raise ParameterError(called, f"({low:g}, {high:g})", f"around {start:g}", sentence)
    if name.split(":")[0] in _LINEAR:
        return Unknown(name, start, low, high, max(abs(start), _UNIT * (high - low)))
    if not low > 0.0:
        raise ParameterError(called, f"({low:g}, {high:g})", "above 0: it goes by its logarithm")
    return Unknown(name, start, low, high, None)


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
        Values that make no cylinder; a temperature that the shift does not allow.
    """
    changes: dict[str, Any] = {name: values[name] for name in _OWN if name in values}
    bodies = _bodies(cylinder)
    made = {section: _changed(body, _prefix(section), values) for section, body in bodies.items()}
    if record is not None:
        changes |= record.own
        if record.temperature is not None:
            made |= {section: made[section].at(record.temperature, shifts[section]) for section in shifts & made.keys()}
    if any(made[section] is not bodies[section] for section in bodies):
        changes |= made
    return cylinder.replace(**changes) if changes else cylinder


def _changed(body: Material, prefix: str, values: Mapping[str, float]) -> Material:
    own = {name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)}
    changes: dict[str, Any] = {name: own[name] for name in _OF_BODY if name in own}
    if any(map(_MODE.match, own)):
        strengths, times = (
            tuple(own.get(f"{name}_{n}", value) for n, value in enumerate(column.tolist(), 1))
            for name, column in (("E", body.prony.E), ("tau", body.prony.tau))
        )
        # it is no longer what was measured
        changes |= {"prony": _series(strengths, times), "measured": None}
    elif body.measured is not None and "T_ref" in changes:
        changes["measured"] = body.measured.shifted(changes["T_ref"] / body.T_ref)
    return replace(body, **changes) if changes else body


@lru_cache(maxsize=256)
def _series(strengths: tuple[float, ...], times: tuple[float, ...]) -> Prony:
    """A series once: what does not change it pays no table of it."""
    return Prony(strengths, times)


def of_record(values: Mapping[str, float], called: str) -> dict[str, float]:
    """``values`` with those of the record ``called`` by their bare names."""
    return {name.removesuffix(f":{called}"): value for name, value in values.items()}
