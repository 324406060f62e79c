"""What drove a motion, or many, for a dataset."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..drive import Feedback
from ..symbols import SYMBOLS
from .driven import Drive

_LINEAR = "linear between its times, constant outside; a time given twice is a jump"


def drive_variables(drive: Drive) -> tuple[dict[str, xr.Variable], dict[str, str]]:
    """(variables ``drive_force`` and the like, with their times where they have some; attributes for callables).

    Numbers stand over () or (motion), (times, values) over (drive_force_time) or (motion, drive_force_time); gains of a
    feedback are attributes.
    """
    variables: dict[str, xr.Variable] = {}
    texts: dict[str, str] = {}
    for name, whole in drive._asdict().items():
        if whole is None or (isinstance(whole, float | int) and whole == 0.0 and name in ("force", "torque")):
            continue
        key, feeds_back = f"drive_{name}", isinstance(whole, Feedback)
        given = whole.value if feeds_back else whole
        gains = {"gain_V": whole.V, "gain_omega": whole.omega} if feeds_back else {}
        if callable(given):
            texts[key] = "a function of t" + "".join(f", {what} = {gain:.15g}" for what, gain in gains.items())
            continue
        symbol = SYMBOLS[name]
        described = {"long_name": f"given: {symbol.long_name}", "units": symbol.units, "symbol": symbol.latex} | gains
        if isinstance(given, tuple):
            times, values = (np.asarray(part, np.float64) for part in given)
            along = {"long_name": f"times of the given {name} over T_epsilon", "units": SYMBOLS["t"].units}
            variables[f"{key}_time"] = xr.Variable((f"{key}_time",), times, along)
            dims = ("motion", f"{key}_time")[-values.ndim :]
            variables[key] = xr.Variable(dims, values, described | {"comment": _LINEAR})
        else:
            number = np.asarray(given, np.float64)
            variables[key] = xr.Variable(("motion",)[: number.ndim], number, described)
    return variables, texts
