"""Motions and ensembles as xarray datasets, with names, units and provenance."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from .. import __version__
from ..contact_law.parameters import PARAMETERS
from ..core.drive import Feedback, Schedule
from ..core.errors import MotionStatus
from ..core.results import format_value
from ..core.symbols import attributes
from ..materials.bodies import Bodies
from ..materials.cover import Cover
from ..materials.prony import Prony
from .driven import ROWS, STATES
from .result import Rolled

_LINEAR = "linear between its times, constant outside; a time given twice is a jump"
#: what it is, the first flag, meanings
_FLAGS = {
    "regime": ("regime of motion", -1, "not_reached full_slip partial_slip rest locked held"),
    "status": ("how the motion ended", 0, " ".join(status.name.lower() for status in MotionStatus)),
    "flow": ("source of the motion", 0, "integrated flow_map"),
}


def column_attributes(name: str, si: bool = False) -> dict[str, Any]:
    """Attributes of a field, a start or another column of an ensemble."""
    if name not in _FLAGS:
        return dict(attributes(name, si))
    about, first, meanings = _FLAGS[name]
    values = np.arange(first, first + len(meanings.split()), dtype=np.int8)
    return {"long_name": about, "flag_values": values, "flag_meanings": meanings}


def provenance(title: str) -> dict[str, str]:
    """What every dataset says of itself."""
    return {"Conventions": "CF-1.11", "title": title, "source": f"viscoroll {__version__}"}


def _dataset(
    result: Rolled, title: str, dims: tuple[str, ...], more: dict[str, Any], about: dict[str, Any]
) -> xr.Dataset:
    """Its rows over ``dims``, what drove it and what rolled, beside ``more`` variables and attributes."""
    whole, described = result.drive.acts or "motion" in dims, partial(column_attributes, si=result.scale.si)
    data: dict[str, Any] = {}
    for name in ROWS if whole else STATES:
        if (values := result[name]) is not None:
            if name == "regime":
                values = np.where(np.isnan(values), -1, values).astype(np.int8)
            data[name] = dims, values, described(name)
    drives, texts = _drive(result)
    roller, series = result.roller, result.scene.series
    attrs = provenance(title) | about | texts
    if whole:
        attrs["drive_error"] = result.drive_error
    if series is not None:  # by which it counts time
        attrs |= {"relaxation_strengths": series.E, "relaxation_times": series.tau}
    if (cover := result.scene.cover) is not None:
        attrs |= {} if cover.shape else {"cover_thickness_over_l0": cover.thickness}
        attrs |= {"cover_on": cover.on, "cover_nu": cover.nu}
    if result.scale.si:
        attrs |= {name: getattr(roller, name) for name in ("R", "m", "j", "g", "load", "T_ref")}
    return xr.Dataset(data | more | drives, {"t": ("t", result.t, described("t"))}, attrs)


def _drive(result: Rolled) -> tuple[dict[str, Any], dict[str, Any]]:
    """(Variables ``drive_force`` and the like, with their times where they have some; attributes for callables).

    Numbers stand over () or (motion), schedules over (drive_force_time) or (motion, drive_force_time), or where
    motions have times of their own over (motion, drive_force_corner); gains of a feedback are attributes.
    """
    variables: dict[str, Any] = {}
    texts: dict[str, Any] = {}
    for name, whole in result.drive.given.items():
        key, feeds_back = f"drive_{name}", isinstance(whole, Feedback)
        given = whole.value if feeds_back else whole
        gains = {"gain_V": whole.V, "gain_omega": whole.omega} if feeds_back else {}
        if callable(given):
            told = (
                f", {what} = {format_value(gain) if np.ndim(gain) else f'{gain:.15g}'}" for what, gain in gains.items()
            )
            texts[key] = "a function of t" + "".join(told)
            continue
        about = attributes(name, result.scale.si)
        about = about | {"long_name": f"given: {about['long_name']}"} | gains
        dims: tuple[str, ...] = ("motion",)
        if isinstance(given, Schedule):
            along = {"long_name": f"times of the given {name}", "units": result.scale.unit("t")}
            dims = "motion", f"{key}_time" if given.times.ndim == 1 else f"{key}_corner"
            variables[f"{key}_time"] = dims[-given.times.ndim :], given.times, along
            given, about = given.values, about | {"comment": _LINEAR}
        number = np.asarray(given, np.float64)
        variables[key] = dims[len(dims) - number.ndim :], number, about
    return variables, texts


def _series(materials: Any, count: int) -> dict[str, Any]:
    """Strengths and times of a material each as they were given, or of both bodies and the cylinder's share."""
    if materials is None or not materials.shape:
        return {}
    if not isinstance(materials, Bodies):
        return _modes(materials, count, "", "")
    if isinstance(materials, Cover):
        about = {"long_name": "thickness of the cover over l0", "units": "1"}
        layer = {"relaxation_strengths": materials.layer.E, "relaxation_times": materials.layer.tau}
        return {"cover_thickness": ("motion", np.broadcast_to(materials.thickness, (count,)), about | layer)}
    share = {"long_name": "the cylinder's part of the long-time compliance", "units": "1"}
    return (
        _modes(materials.cylinder, count, "cylinder_", "cylinder: ")
        | _modes(materials.base, count, "base_", "base: ")
        | {"share": ("motion", np.broadcast_to(materials.share, (count,)), share)}
    )


def _modes(given: Prony, count: int, body: str, of: str) -> dict[str, Any]:
    """Strengths and times of one body, over (motion, mode)."""
    form, over = ("creep", "compliance") if given.by_creep else ("relaxation", "modulus")
    parts = {
        "strengths": (given.J if given.by_creep else given.E, f"strengths of {form} over the long-time {over}"),
        "times": (given.T if given.by_creep else given.tau, f"times of {form} over T_ref"),
    }
    return {
        f"{body}{form}_{name}": (
            ("motion", f"{body}mode"), np.broadcast_to(values, (count, np.shape(values)[-1])),
            {"long_name": of + about, "units": "1"},
        )
        for name, (values, about) in parts.items()
    }  # fmt: skip


def motion_dataset(motion: Any) -> xr.Dataset:
    """One motion over t; under a drive with what acted, works and losses."""
    turns = {"long_name": "times at which V changes its sign", "units": motion.scale.unit("t")}
    about = motion.scene.numbers | {
        "onset_time": motion.onset_time,
        "rest_time": motion.rest_time,
        "switches": "; ".join(f"t = {s.t:.15g}: {s.regime}" for s in motion.switches),
        "status": motion.message,
        "steps": motion.steps,
    }
    more = {"reversals": ("reversal", motion.reversals, turns)} if motion.drive.acts else {}
    return _dataset(motion, "Motion of a viscoelastic cylinder rolling with partial slip", ("t",), more, about)


def ensemble_dataset(result: Any) -> xr.Dataset:
    """All motions over (motion, t)."""
    si, more = result.scale.si, _series(result.scene.material, len(result))
    for name in PARAMETERS:
        value = np.asarray(getattr(result.scene, name))
        more[name] = ("motion",)[: value.ndim], value, attributes(name)
    for name in ("V0", "omega0", "onset_time", "rest_time", "status"):
        more[name] = "motion", result[name], column_attributes(name, si)
    more["flow"] = "motion", result.flow.astype(np.int8), column_attributes("flow")
    about = {"flow_error": result.flow_error, "flow_problem": result.flow_problem}
    found = _dataset(result, "Ensemble of motions", ("motion", "t"), more, about)
    own = result.labels.along("motion") if result.labels and result.labels.shape == (len(result),) else {}
    return found.assign_coords({name: values for name, values in own.items() if name not in found})
