"""Unknowns by the names that run files give their inputs: what they are of a cylinder, and a cylinder of such values.

A material's modes count from its longest time; names of the half-space begin with ``base_``, those of a record end
with its name, as V0:run.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cylinder import Cylinder
from ..errors import ParameterError, unknown
from ..materials.material import Material
from ..materials.prony import Prony
from .records import Record

#: degrees Celsius -> a_T
Shift = Callable[[float], float]
_OWN = ("R", "m", "mu", "j", "g", "load")
BEARING = ("brake", "drag")
OF_RECORDS = ("V0", "omega0", "t0")
#: section -> what its names begin with
PREFIXES = {"material": "", "base": "base_"}
_MODE = re.compile(r"(E|tau)_(\d+)$")
#: of its range, the least unit of what is counted from 0
_UNIT = 0.1


class Unknown(NamedTuple):
    """Where it starts, and its range; ``unit`` is what a linear one is counted in, others go by their logarithm."""

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


def known(cylinder: Cylinder) -> dict[str, float]:
    """All that may be unknown of a cylinder and its bearing, by name.

    Raises
    ------
    ParameterError
        A cylinder with arrays.
    """
    values = {name: getattr(cylinder, name) for name in _OWN} | dict.fromkeys(BEARING, 0.0)
    for name, value in values.items():
        if np.ndim(value):
            raise ParameterError(
                name, f"array of shape {np.shape(value)}", "a single number: identify takes one cylinder"
            )
    for section, body in _bodies(cylinder).items():
        prefix = PREFIXES[section]
        values |= {prefix + name: getattr(body, name) for name in ("E", "nu", "T_ref")}
        modes = zip(body.prony.E.tolist(), body.prony.tau.tolist(), strict=True)
        for n, (E, tau) in enumerate(modes, 1):
            values |= {f"{prefix}E_{n}": E, f"{prefix}tau_{n}": tau}
    return values


def _bodies(cylinder: Cylinder) -> dict[str, Material]:
    pair = cylinder.pair
    return {"material": pair.cylinder} | ({} if pair.base is None else {"base": pair.base})


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
        A name that is none, a range that does not hold the start.
    """
    values = known(cylinder)
    brought = {
        f"{name}:{called}": spec for called, record in records.items() for name, spec in record.starts(cylinder).items()
    }
    for called, record in records.items():
        values |= {f"{name}:{called}": getattr(record, name) for name in OF_RECORDS if _is_number(record, name)}
    ranges = {}
    for name, span in given.items():
        if name not in values and name not in brought:
            raise unknown("unknown", name, (*values, *brought), "an input")
        ranges[name] = _range(name, span, brought[name][0] if name in brought else values[name])
    return [
        _made(name, *spec) for name, spec in (ranges | {n: s for n, s in brought.items() if n not in ranges}).items()
    ]


def _is_number(record: Record, name: str) -> bool:
    return isinstance(getattr(record, name, None), float)


def _range(name: str, span: Any, start: float) -> tuple[float, float, float]:
    try:
        low, high = (float(end) for end in span)
    except (TypeError, ValueError):
        raise ParameterError(f"unknown {name}", f"{span!r:.60}", "(low, high)") from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ParameterError(f"unknown {name}", f"({low:g}, {high:g})", "(low, high), finite and low < high")
    if not low <= start <= high:
        sentence = f"unknown {name}: its range ({low:g}, {high:g}) must hold the start, here {start:.6g}"
        raise ParameterError(f"unknown {name}", f"({low:g}, {high:g})", f"around {start:g}", sentence)
    return start, low, high


def _made(name: str, start: float, low: float, high: float) -> Unknown:
    if name.split(":")[0] in (*BEARING, *OF_RECORDS) or name.endswith("nu"):
        return Unknown(name, start, low, high, max(abs(start), _UNIT * (high - low)))
    if not low > 0.0:
        raise ParameterError(f"unknown {name}", f"({low:g}, {high:g})", "above 0: it goes by its logarithm")
    return Unknown(name, start, low, high, None)


def cylinder_of(
    cylinder: Cylinder,
    values: Mapping[str, float],
    record: Record | None = None,
    shifts: Mapping[str, Shift] | None = None,
) -> Cylinder:
    """The cylinder with other ``values``, at the load and the temperature of a record.

    Raises
    ------
    ParameterError
        Values that make no cylinder; a temperature that the shift does not allow.
    """
    changes: dict[str, Any] = {name: values[name] for name in _OWN if name in values}
    bodies = _bodies(cylinder)
    made = {section: _changed(body, PREFIXES[section], values) for section, body in bodies.items()}
    if record is not None and record.temperature is not None and shifts:
        at = record.temperature
        made = {name: body.at(at, shifts[name]) if name in shifts else body for name, body in made.items()}
    if any(made[section] is not bodies[section] for section in made):
        changes |= made
    if record is not None:
        changes |= record.own
    return cylinder.replace(**changes) if changes else cylinder


def _changed(body: Material, prefix: str, values: Mapping[str, float]) -> Material:
    own = {name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)}
    changes: dict[str, Any] = {name: own[name] for name in ("E", "nu", "T_ref") if name in own}
    if any(map(_MODE.match, own)):
        modes = range(1, body.prony.E.size + 1)
        strengths = (own.get(f"E_{n}", body.prony.E[n - 1]) for n in modes)
        times = (own.get(f"tau_{n}", body.prony.tau[n - 1]) for n in modes)
        # it is no longer what was measured
        changes |= {"prony": _series(tuple(strengths), tuple(times)), "measured": None}
    elif body.measured is not None and "T_ref" in changes:
        changes["measured"] = body.measured.shifted(changes["T_ref"] / body.T_ref)
    return replace(body, **changes) if changes else body


@lru_cache(maxsize=256)
def _series(strengths: tuple[float, ...], times: tuple[float, ...]) -> Prony:
    """A series once: what does not change it pays no table of it."""
    return Prony(strengths, times)


def named(values: Mapping[str, float], called: str) -> dict[str, float]:
    """Of ``values`` the bearing's and those of the record ``called``, without its name."""
    own = {name.removesuffix(f":{called}"): value for name, value in values.items() if name.endswith(f":{called}")}
    return {name: value for name, value in values.items() if name in BEARING} | own


def coordinates(unknowns: list[Unknown], which: str) -> NDArray[np.float64]:
    """Coordinates of their ``which``: "start", "low" or "high"."""
    return np.array([one.to_u(getattr(one, which)) for one in unknowns], float)
