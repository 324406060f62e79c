"""What drove a motion, or many, for a dataset."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ..core.drive import Feedback, Schedule
from ..core.results import short
from .driven import Drive

_LINEAR = "linear between its times, constant outside; a time given twice is a jump"


def drive_variables(
    drive: Drive, described: Callable[[str], dict[str, Any]]
) -> tuple[dict[str, xr.Variable], dict[str, Any]]:
    """(variables ``drive_force`` and the like, with their times where they have some; attributes for callables).

    Numbers stand over () or (motion), schedules over (drive_force_time) or (motion, drive_force_time), or where
    motions have times of their own over (motion, drive_force_corner); gains of a feedback are attributes.
    ``described``: attributes of a quantity.
    """
    variables: dict[str, xr.Variable] = {}
    texts: dict[str, Any] = {}
    for name, whole in drive.given.items():
        key, feeds_back = f"drive_{name}", isinstance(whole, Feedback)
        given = whole.value if feeds_back else whole
        gains = {"gain_V": whole.V, "gain_omega": whole.omega} if feeds_back else {}
        if callable(given):
            told = {what: short(gain) if np.ndim(gain) else f"{gain:.15g}" for what, gain in gains.items()}
            texts[key] = "a function of t" + "".join(f", {what} = {gain}" for what, gain in told.items())
            continue
        about = described(name)
        about = about | {"long_name": f"given: {about['long_name']}"} | gains
        if isinstance(given, Schedule):
            times, values = given.times, given.values
            along = {"long_name": f"times of the given {name}", "units": described("t")["units"]}
            corners = f"{key}_time" if times.ndim == 1 else f"{key}_corner"
            variables[f"{key}_time"] = xr.Variable(("motion", corners)[-times.ndim :], times, along)
            dims = ("motion", corners)[-values.ndim :]
            variables[key] = xr.Variable(dims, values, about | {"comment": _LINEAR})
        else:
            number = np.asarray(given, np.float64)
            variables[key] = xr.Variable(("motion",)[: number.ndim], number, about)
    return variables, texts
