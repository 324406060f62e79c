"""What the columns of a store are, in words: inputs by their names, and what comes out of a motion."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.symbols import SYMBOLS
from ...cylinder import UNITS
from ...motion.export import column_attributes
from ..config import CylinderSection
from .uncertain import PREFIXES

_MODES = {
    "E": "strength {} of relaxation over the long-time modulus", "tau": "relaxation time {} over T_ref",
    "J": "strength {} of creep over the long-time compliance", "T": "retardation time {} over T_ref",
}  # fmt: skip


def attributes(name: str, si: bool) -> dict[str, Any]:
    """long_name, units and more of a column, as JSON takes them."""
    if name.startswith(PREFIXES["drive"]):
        what, _, corner = name.removeprefix(PREFIXES["drive"]).partition("_")
        about = attributes(what, si)
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {what}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        return about | {"long_name": f"given: {about['long_name']}" + f", value {corner}" * bool(corner)}
    if name.startswith(PREFIXES["base"]):
        about = attributes(name.removeprefix(PREFIXES["base"]), si)
        return about | {"long_name": f"base: {about['long_name']}"}
    kind, _, number = name.partition("_")
    if kind in _MODES and number.isdecimal():
        return {"long_name": _MODES[kind].format(number), "units": "1"}
    if name in CylinderSection.__struct_fields__ and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": UNITS.get(name, "1")}
    return {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in column_attributes(name, si).items()
    }
