"""SI units of a run with [cylinder]: all that its file says, and all that its results hold.

Its motions are rolled dimensionless, each with its own R and unit of time T (T_epsilon, or T_ref of the materials), but
for the time: gamma does nothing but scale it (Eq. (22)), so that gamma/T in place of gamma makes it seconds, the same
for every cylinder.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...motion import export
from ...motion.driven import ROWS
from ...scale import DIMENSIONLESS, DIMENSIONS, Scale
from ...symbols import SYMBOLS
from ...symbols import attributes as symbol_attributes
from .ranges import CYLINDER, PREFIXES


def are_si(values: Mapping[str, Any]) -> bool:
    """Whether these inputs are those of a cylinder."""
    return "R" in values


def unit_of_time(values: Mapping[str, Any]) -> Any:
    """What times of a cylinder's scene are counted in, s; a number or one a motion."""
    return values["T_ref"] if "T_ref" in values else values["T_epsilon"]


def load_of(values: Mapping[str, Any]) -> Any:
    """Load of a cylinder, N/m; on a slope P cos(slope)."""
    load = values["load"] if "load" in values else values["m"] * values["g"]
    return load * np.cos(values["drive_slope"]) if "drive_slope" in values else load


def scale_of(values: Mapping[str, Any]) -> Scale:
    """What 1 of each quantity is, from inputs; numbers or one a motion."""
    if not are_si(values):
        return DIMENSIONLESS
    return Scale(values["R"], unit_of_time(values), load_of(values), values["m"])


def scales(values: Mapping[str, Any]) -> dict[str, Any]:
    """Column -> what it is multiplied by to be in SI units; numbers or one a motion; nothing for a scene."""
    scale = scale_of(values)
    # the integrals over time are over seconds already
    rates = {"x": "V", "angle": "omega"}
    return {name: scale[rates.get(name, name)] for name in ROWS if name in DIMENSIONS} if scale.si else {}


def dimensionless(values: Mapping[str, Any], name: str) -> Any:
    """A start speed, or the rest threshold, from inputs in either units."""
    return values[name] / scale_of(values)[name]


_MODES = {
    "E": "strength {} of relaxation over the long-time modulus", "tau": "relaxation time {} over T_ref",
    "J": "strength {} of creep over the long-time compliance", "T": "retardation time {} over T_ref",
}  # fmt: skip


def attributes(name: str, si: bool) -> dict[str, Any]:
    """long_name, units and more of a column, as JSON takes them."""
    if name.startswith("drive_"):
        what, _, corner = name.removeprefix("drive_").partition("_")
        about = attributes(what, si)
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {what}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        return about | {"long_name": f"given: {about['long_name']}" + f", value {corner}" * bool(corner)}
    if name.startswith(PREFIXES["base"]):
        about = attributes(name.removeprefix(PREFIXES["base"]), si)
        return about | {"long_name": f"base: {about['long_name']}"}
    if si and name in DIMENSIONS:
        return dict(symbol_attributes(name, si))
    kind, _, number = name.partition("_")
    if kind in _MODES and number.isdecimal():
        return {"long_name": _MODES[kind].format(number), "units": "1"}
    if name in CYLINDER and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": CYLINDER[name].unit}
    found = export.column_attributes(name)
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in found.items()}
