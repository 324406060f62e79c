"""Unknowns by the names that run files give their inputs: what each is of a cylinder, and a
cylinder of their values.

A material's modes count from its longest time; names of the half-space begin with ``base_``, those
of a record end with its name, as V0:run.
"""

import dataclasses
import functools
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..core import ParameterError, check_array, check_names, check_number, describe_value, si_unit
from ..materials import Material, Prony
from ..rollers import Cylinder
from .measurement_records import OF_RECORDS, Record

#: degrees Celsius -> a_T
Shift = Callable[[float], float]
#: unknowns that are inputs of a cylinder
_OF_CYLINDER = ("R", "m", "mu", "j", "g", "load")
#: unknowns that are inputs of a material, beside its modes
_OF_MATERIAL = ("E", "nu", "T_ref")
#: body -> prefix of the names of its unknowns
_PREFIX = {"material": "", "base": "base_"}
#: unknowns of the bearing and their start, 0
_BEARING = {"brake": 0.0, "drag": 0.0}
#: unknowns with a linear coordinate and their least value; others, above 0, have a logarithmic one
_LINEAR = _BEARING | dict.fromkeys(("nu", "base_nu", *OF_RECORDS), -math.inf)
#: unknowns on which the law of a cylinder does not depend
WITHOUT_LAW = ("j", *_BEARING, *OF_RECORDS)
#: least unit of a linear coordinate, in units of the range
_UNIT = 0.1


class Unknown(NamedTuple):
    """An unknown, which the search varies by a coordinate u: the logarithm of its value, or its
    value in a unit.

    name : name of the unknown, as "mu", "E_1" or "V0:run".
    start : value from which the search starts, SI.
    low, high : range of its value, SI.
    unit : unit of a linear coordinate, u = value/unit; None: the coordinate is the natural
    logarithm of the SI value.
    mean, sd : mean and standard deviation of the coordinate as known before; sd is infinite without
    such knowledge.
    """

    name: str
    start: float
    low: float
    high: float
    unit: float | None
    mean: float = 0.0
    sd: float = math.inf

    @property
    def kind(self) -> str:
        """Name without that of a record, as "V0"."""
        return self.name.split(":")[0]

    @staticmethod
    def bounds(name: str) -> dict[str, Any]:
        """Return what values an unknown may have, as arguments of :func:`.arrays.check_array`.

        name : name of the unknown, perhaps with that of its record, as "V0:run".
        Returns {"unit": SI unit} and "low": least value (-inf: any) of a linear unknown, or
        "above": 0.0 of all others.
        """
        kind = name.split(":")[0]
        bound = {"low": _LINEAR[kind]} if kind in _LINEAR else {"above": 0.0}
        return {"unit": si_unit(kind.removeprefix(_PREFIX["base"]))} | bound

    def to_u(self, value: Any) -> Any:
        """Return the coordinate of a value, SI, a number or an array: its logarithm, or value/unit
        if linear.
        """
        return np.log(value) if self.unit is None else value / self.unit

    def to_value(self, u: Any) -> Any:
        """Return the value, SI, at a coordinate u, a number or an array."""
        return np.exp(u) if self.unit is None else u * self.unit

    def slope(self, value: float) -> float:
        """Return the derivative of the value by the coordinate, SI, at a value: the value itself,
        or the unit if linear.
        """
        return value if self.unit is None else self.unit


def unknowns_of(
    cylinder: Cylinder,
    requested: Mapping[str, Any],
    records: Mapping[str, Record],
    priors: Mapping[str, Any],
) -> list[Unknown]:
    """Return the unknowns that the caller requests, and those that records leave open, as a list of
    :class:`Unknown`.

    cylinder : :class:`Cylinder`, from whose inputs the search starts; brake and drag start at 0.
    requested : name -> range (low, high), in SI units or with units.
    records : name -> :class:`Record`; V0, omega0 and t0 that a record leaves open become unknowns
        "V0:NAME" and so on, with the range of the record unless requested.
    priors : name -> (value, standard deviation); the latter in the SI unit of linear unknowns, of
        others that of the natural logarithm of the value.
    Returns them in the order of ``requested``, then of the records; [] where nothing is requested
    or left open.

    Raises
    ------
    ParameterError
        An unknown name; a range that does not ascend or does not contain the start; a cylinder with
        arrays; an open V0 or omega0 of which the record has no data; a prior of what is no unknown,
        or that is none.
    """
    starts = {name: getattr(cylinder, name) for name in _OF_CYLINDER} | _BEARING
    for section, body in _bodies(cylinder).items():
        starts |= {_PREFIX[section] + name: value for name, value in _inputs(body).items()}
    starts = {name: check_number(name, value) for name, value in starts.items()}
    ranges = dict(requested)
    for record_name, record in records.items():
        for name, (start, span) in record.initial_values(cylinder.R).items():
            starts[f"{name}:{record_name}"] = start
            if span is not None:
                ranges.setdefault(f"{name}:{record_name}", span)
    check_names("unknown", ranges, starts, "an input that can be unknown")
    check_names("prior", priors, ranges, "an unknown")
    return [
        _make_unknown(name, starts[name], span, priors.get(name)) for name, span in ranges.items()
    ]


def _make_unknown(name: str, start: float, span: Any, prior: Any) -> Unknown:
    """Check range and prior of an unknown, and return it as :class:`Unknown`.

    name : name of the unknown.
    start : start value, SI; it may be at an end of the range.
    span : range of the unknown, (low, high), in SI units or with units.
    prior : (value, standard deviation) known beforehand, each in SI units or with a unit of its
        own, or None.  The latter is of the natural logarithm of the value, dimensionless, of linear
        unknowns (brake, drag, nu, those of records) in their SI unit.
    Returns an :class:`Unknown`, whose ``mean`` and ``sd`` are those of its coordinate; without a
    prior they are 0 and infinite.  Its ``unit`` is None, of linear unknowns the larger of |start|
    and a tenth of the width of the range.
    Raises ParameterError for a range that does not ascend or does not contain the start, and for a
    prior that is none.
    """
    bounds = Unknown.bounds(name)
    pair = check_array(f"unknown {name}", span, **bounds)
    if pair.shape != (2,) or not pair[0] < pair[1]:
        raise ParameterError(f"unknown {name}", describe_value(span), "(low, high) with low < high")
    low, high = pair.tolist()
    if not low <= start <= high:
        source = " of the record" if ":" in name else " of the cylinder" * (name not in _BEARING)
        raise ParameterError(
            f"unknown {name}",
            f"({low:g}, {high:g})",
            f"a range that contains {start:.6g}, the value{source} with which the search starts",
        )
    linear = name.split(":")[0] in _LINEAR
    unit = max(abs(start), _UNIT * (high - low)) if linear else None
    unknown = Unknown(name=name, start=start, low=low, high=high, unit=unit)
    if prior is None:
        return unknown
    try:
        value, sd = prior
    except (TypeError, ValueError):
        allowed = f"(value, {'' if linear else 'relative '}standard deviation)"
        raise ParameterError(f"prior {name}", describe_value(prior), allowed) from None
    mean = unknown.to_u(check_number(f"prior {name}", value, **bounds))
    # of a logarithmic coordinate the standard deviation of the logarithm is given
    dimension = bounds["unit"] if linear else "1"
    sd = check_number(f"standard deviation of prior {name}", sd, unit=dimension, above=0.0)
    return unknown._replace(mean=float(mean), sd=sd / (unit or 1.0))


def cylinder_of(
    cylinder: Cylinder,
    values: Mapping[str, float],
    record: Record | None = None,
    shifts: Mapping[str, Shift] = {},
) -> Cylinder:
    """Return the cylinder with other values, at the load and the temperature of a record.

    cylinder : :class:`Cylinder` with the values that are fixed.
    values : name -> value of unknowns, SI; those of bearing and records are not used, and what is
        missing stays as it is.
    record : :class:`Record`, whose load and mass replace those of the cylinder (and of ``values``)
        if it has them, and to whose temperature, if it has one, the materials are shifted; None: no
        record.
    shifts : "material" or "base" -> function of the temperature in degrees Celsius that returns
        a_T, in place of the shift of the body itself; one of both is needed of each viscoelastic
        body where the record has a temperature, not of elastic ones (alpha = 1) and rigid ones.
    Returns the :class:`Cylinder`; ``cylinder`` itself where nothing changes.

    Raises
    ------
    ParameterError
        Values that make no cylinder; a temperature without a shift of a body, or that the shift
        does not allow.
    """
    changes: dict[str, Any] = {name: values[name] for name in _OF_CYLINDER if name in values}
    changes |= record.overrides if record else {}
    for section, body in _bodies(cylinder).items():
        changed = _replace_values(body, _PREFIX[section], values)
        if record and record.temperature is not None and body.prony.alpha > 1.0:
            if not (shift := shifts.get(section, body.shift)):
                raise ParameterError(
                    record.label("temperature"),
                    record.temperature,
                    f"left out, unless {section} has a shift: give one as shift={{{section!r}: "
                    f"vr.WLF(T0=20.0)}} or, in a file, wlf = {{ T0 = 20.0 }} in [{section}]",
                )
            changed = changed.at(record.temperature, shift)
        if changed is not body:
            changes[section] = changed
    return cylinder.replace(**changes) if changes else cylinder


def _bodies(cylinder: Cylinder) -> dict[str, Material]:
    """Return the bodies that deform; a rigid one has no unknowns.

    cylinder : :class:`Cylinder`.
    Returns a dict, "material" (the cylinder) or "base" (the half-space, if it has a material of its
    own) -> :class:`Material`.
    """
    bodies = zip(_PREFIX, (cylinder.pair.cylinder, cylinder.pair.base))
    return {section: body for section, body in bodies if body and not body.is_rigid}


def _inputs(body: Material) -> dict[str, float]:
    """Return all inputs of a body that may be unknown, by name: E (Pa), nu, T_ref (s), and E_1,
    tau_1, ... of its modes.

    Strengths and times of modes are dimensionless, divided by E and T_ref; mode 1 is that of the
    longest time.  An elastic body has no modes.

    body : :class:`Material` without arrays, of which E, nu, T_ref and the E and tau of ``prony``
    are read.
    Returns a dict, name -> float, in this order, strengths before times.
    """
    modes = {
        f"{name}_{n}": value
        for name in ("E", "tau")
        for n, value in enumerate(getattr(body.prony, name).tolist(), 1)
    }
    return {name: getattr(body, name) for name in _OF_MATERIAL} | modes


def _replace_values(body: Material, prefix: str, values: Mapping[str, float]) -> Material:
    """Return a material in which unknowns have other values.

    With other modes the material is no longer the one that was measured: ``measured`` becomes None.
    With another T_ref alone its measured band, if it has one, is shifted; with another E or nu
    alone it stays.

    body : :class:`Material`.
    prefix : prefix of the names of its unknowns, "" or "base_".
    values : name -> value of unknowns, of other bodies too, which are not used; SI, modes divided
    by E and T_ref.
    Returns the :class:`Material`; ``body`` itself where no value differs.
    Raises ParameterError for values that make no material.
    """
    old = _inputs(body)
    new = {name: values.get(prefix + name, value) for name, value in old.items()}
    if new == old:
        return body
    changes: dict[str, Any] = {name: new.pop(name) for name in _OF_MATERIAL}
    # new has the modes alone now
    if not new.items() <= old.items():
        modes = tuple(new.values())
        count = body.prony.E.size
        # it is no longer what was measured
        changes |= {"prony": _series(modes[:count], modes[count:]), "measured": None}
    elif body.measured is not None:
        changes["measured"] = body.measured.shifted(changes["T_ref"] / body.T_ref)
    return dataclasses.replace(body, **changes)


@functools.lru_cache(maxsize=256)
def _series(strengths: tuple[float, ...], times: tuple[float, ...]) -> Prony:
    """Return a series, the same object for the same values, so that its table of the law is made
    once.

    strengths, times : of each mode, divided by E and T_ref, as tuples that the cache can look up;
    equally many.
    Returns the :class:`Prony`; the last 256 are kept.
    Raises ParameterError for numbers that make no series.
    """
    return Prony(strengths, times)
