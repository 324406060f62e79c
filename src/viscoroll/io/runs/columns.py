"""Long names and units of the columns of a store: uncertain inputs, and fields of the motions."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.symbols import SYMBOLS
from ...cylinder import UNITS
from ...motion.export import column_attributes
from ..config import CylinderSection
from .uncertain import PREFIXES

#: Letter of a Prony series in the name of an input, as in tau_2 -> meaning of the number, with its index.
_SERIES = {
    "E": "strength {} of relaxation, divided by the long-time modulus", "tau": "relaxation time {} divided by T_ref",
    "J": "strength {} of creep, divided by the long-time compliance", "T": "retardation time {} divided by T_ref",
}  # fmt: skip


def attributes(name: str, si: bool) -> dict[str, Any]:
    """Return the attributes of a column of a store, of types that JSON has.

    name: name of an input (as base_E, tau_2, drive_torque_time_1), of a field or an end of a motion (as V, rest_time,
        status), or "t".
    si: whether the run is in SI units, else dimensionless.
    Returns a dict with long_name and units ("1" of a dimensionless quantity); of a quantity in the table of symbols
    also symbol and equation, unless it has a dimension and the run is in SI units; of the codes regime, status and flow
    no units, but the list flag_values and the text flag_meanings, a word for each code.  The long_name is "" of a name
    that is none of these.
    """
    if name.startswith(PREFIXES["drive"]):
        load, _, corner = name.removeprefix(PREFIXES["drive"]).partition("_")
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {load}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        about = attributes(load, si)
        return about | {"long_name": f"given: {about['long_name']}" + f", value {corner}" * bool(corner)}
    if name.startswith(PREFIXES["base"]):
        about = attributes(name.removeprefix(PREFIXES["base"]), si)
        return about | {"long_name": f"base: {about['long_name'].removesuffix(' of the cylinder')}"}
    letter, _, index = name.partition("_")
    if letter in _SERIES and index.isdecimal():
        return {"long_name": _SERIES[letter].format(index), "units": "1"}
    if name in CylinderSection.__struct_fields__ and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": UNITS.get(name, "1")}
    about = column_attributes(name, si)
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in about.items()}
