"""Motions and ensembles as xarray datasets, with names, units and provenance."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from .. import __version__
from ..contact_law.parameters import PARAMETERS, Rolls
from ..core.errors import MotionStatus, ParameterError
from ..core.symbols import attributes
from ..materials.bodies import Bodies
from ..materials.prony import Prony
from .driven import ACTING
from .export_drive import drive_variables

_LOSSES = ("slip_loss", "rolling_loss")
_REGIME = {
    "long_name": "regime of motion",
    "flag_values": np.array([-1, 0, 1, 2, 3, 4], dtype=np.int8),
    "flag_meanings": "not_reached full_slip partial_slip rest locked held",
}
_OWN: dict[str, dict[str, Any]] = {
    "regime": _REGIME,
    "status": {
        "long_name": "how the motion ended",
        "flag_values": np.array([int(s) for s in MotionStatus], dtype=np.int8),
        "flag_meanings": " ".join(s.name.lower() for s in MotionStatus),
    },
    "flow": {
        "long_name": "source of the motion",
        "flag_values": np.array([0, 1], dtype=np.int8),
        "flag_meanings": "integrated flow_map",
    },
}


def column_attributes(name: str, si: bool = False) -> dict[str, Any]:
    """Attributes of a field, a start or another column of an ensemble."""
    return dict(_OWN[name]) if name in _OWN else dict(attributes(name, si))


def _about(roller: Rolls) -> dict[str, Any]:
    """Numbers of a cylinder."""
    return {name: getattr(roller, name) for name in ("R", "m", "j", "g", "load", "T_ref")} if roller.scale.si else {}


def _globals(title: str) -> dict[str, str]:
    return {"Conventions": "CF-1.11", "title": title, "source": f"viscoroll {__version__}"}


def _material(scene: Any) -> dict[str, Any]:
    """The series that a scene counts time by; nothing where it has an alpha."""
    return (
        {} if scene.series is None else {"relaxation_strengths": scene.series.E, "relaxation_times": scene.series.tau}
    )


def _series(materials: Any, count: int) -> dict[str, xr.Variable]:
    """Strengths and times of a material each as they were given, or of both bodies and the cylinder's share."""
    if materials is None or not materials.shape:
        return {}
    if not isinstance(materials, Bodies):
        return _modes(materials, count, "", "")
    share = {"long_name": "the cylinder's part of the long-time compliance", "units": "1"}
    return (
        _modes(materials.cylinder, count, "cylinder_", "cylinder: ")
        | _modes(materials.base, count, "base_", "base: ")
        | {"share": xr.Variable(("motion",), np.broadcast_to(materials.share, (count,)), share)}
    )


def _modes(given: Prony, count: int, body: str, of: str) -> dict[str, xr.Variable]:
    """Strengths and times of one body, over (motion, mode)."""
    form, over = ("creep", "compliance") if given.by_creep else ("relaxation", "modulus")
    strengths, times = (given.J, given.T) if given.by_creep else (given.E, given.tau)
    about = {"strengths": f"strengths of {form} over the long-time {over}", "times": f"times of {form} over T_ref"}
    return {
        f"{body}{form}_{name}": xr.Variable(
            ("motion", f"{body}mode"), np.broadcast_to(values, (count, np.shape(values)[-1])),
            {"long_name": of + about[name], "units": "1"},
        )
        for name, values in (("strengths", strengths), ("times", times))
    }  # fmt: skip


def motion_dataset(motion: Any) -> xr.Dataset:
    """One motion over t; under a drive with what acted, works and losses."""
    described = partial(attributes, si=motion.scale.si)
    names = ("V", "omega", "x", "angle", "delta", *((*ACTING, *_LOSSES) if motion.drive.acts else ()))
    data = {name: xr.Variable(("t",), getattr(motion, name), described(name)) for name in names}
    data["regime"] = xr.Variable(("t",), motion.regime, _REGIME)
    driven: dict[str, Any] = {}
    if motion.drive.acts:
        given, driven = drive_variables(motion.drive, described)
        data |= given
        when = {"long_name": "times at which V changes its sign", "units": described("t")["units"]}
        data["reversals"] = xr.Variable(("reversal",), motion.reversals, when)
        driven["drive_error"] = motion.drive_error
    return xr.Dataset(
        data,
        coords={"t": xr.Variable(("t",), motion.t, described("t"))},
        attrs=_globals("Motion of a viscoelastic cylinder rolling with partial slip")
        | motion.scene.numbers
        | _material(motion.scene)
        | driven
        | {
            "onset_time": motion.onset_time,
            "rest_time": motion.rest_time,
            "switches": "; ".join(f"t = {s.t:.15g}: {s.regime}" for s in motion.switches),
            "status": motion.message,
            "steps": motion.steps,
        }
        | _about(motion.roller),
    )


def ensemble_dataset(result: Any) -> xr.Dataset:
    """All motions over (motion, t)."""
    described = partial(column_attributes, si=result.scale.si)
    dims = ("motion", "t")
    data = {
        name: xr.Variable(dims, getattr(result, name), described(name))
        for name in ("V", "omega", "x", "angle", "delta", *_LOSSES, *ACTING)
        if getattr(result, name) is not None
    }
    if result.regime is not None:
        reached = np.where(np.isnan(result.regime), -1, result.regime)
        data["regime"] = xr.Variable(dims, reached.astype(np.int8), _REGIME)
    for name in PARAMETERS:
        value = np.asarray(getattr(result.scene, name))
        data[name] = xr.Variable(("motion",) if value.ndim else (), value, attributes(name))
    data |= _series(result.scene.material, len(result))
    for name in ("V0", "omega0", "onset_time", "rest_time", "status"):
        data[name] = xr.Variable("motion", getattr(result, name), described(name))
    data["flow"] = xr.Variable("motion", result.flow.astype(np.int8), described("flow"))
    given, texts = drive_variables(result.drive, described)
    data |= given
    attrs = (
        _globals("Ensemble of motions")
        | _material(result.scene)
        | texts
        | {"drive_error": result.drive_error}
        | {"flow_error": result.flow_error, "flow_problem": result.flow_problem}
        | _about(result.roller)
    )
    own = result.labels.along("motion") if result.labels and result.labels.shape == (len(result),) else {}
    coords = {name: values for name, values in own.items() if name not in data}
    return xr.Dataset(data, coords | {"t": xr.Variable(("t",), result.t, described("t"))}, attrs)


def summary_dataset(result: Any, quantiles: tuple[float, ...]) -> xr.Dataset:
    """Mean, standard deviation and quantiles over the motions that reached each time."""
    described = partial(attributes, si=result.scale.si)
    if not len(result):
        raise ParameterError("motions", 0, "at least one: a summary is over motions")
    data: dict[str, xr.Variable] = {}
    for name in ("V", "omega", "x", "angle", *_LOSSES, *ACTING):
        values = getattr(result, name)
        if values is None:
            continue
        data[f"{name}_mean"] = xr.Variable(("t",), np.nanmean(values, axis=0), described(name))
        data[f"{name}_std"] = xr.Variable(("t",), np.nanstd(values, axis=0), described(name))
        data[f"{name}_quantiles"] = xr.Variable(
            ("quantile", "t"), np.nanquantile(values, quantiles, axis=0), described(name)
        )
    onset = result.onset_time[np.isfinite(result.onset_time)]
    if onset.size:
        data["onset_time_quantiles"] = xr.Variable(
            ("quantile",), np.quantile(onset, quantiles), described("onset_time")
        )
    coords = {"t": xr.Variable(("t",), result.t, described("t")), "quantile": ("quantile", np.array(quantiles))}
    attrs = _globals("Summary of an ensemble of motions") | {"motions": len(result)}
    return xr.Dataset(data, coords=coords, attrs=attrs | {f"ended: {text}": n for text, n in result.messages().items()})
