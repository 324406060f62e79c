"""What rolls in a block of a run, and what drives it: sections whose numbers are those of its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np

from ...contact_law.parameters import Parameters, Rolls
from ...core.checks import checked
from ...core.drive import Schedule, slope_factor
from ...core.errors import ParameterError
from ...core.scale import Scale
from ...cylinder import Cylinder
from ...materials.bodies import Bodies
from ...materials.file import SECTIONS, materials_of, series_of, shifts_of
from ...materials.material import Material
from ...materials.pair import cylinders_share, effective_modulus, joint_modulus
from ...scaling import scene_of
from ..config import body_of


@dataclass(frozen=True, eq=False)
class Rollers(Rolls):
    """Cylinders each of a material of its own, in SI units.

    parameters : dimensionless.
    sizes : R, T, P and m, the units of these, numbers or one a cylinder.
    seconds : whether times are counted in s where T is that of each: gamma does nothing but scale time (Eq. (22)), so
        that gamma/T in its place makes it seconds, the same for every cylinder.
    """

    parameters: Parameters
    sizes: dict[str, Any]
    seconds: bool = False

    def scene(self) -> Parameters:
        return self.parameters

    def tilted(self, slope: Any) -> Self:
        load = self.sizes["P"] * slope_factor(slope)[1]
        return replace(self, parameters=self.parameters.tilted(slope), sizes=self.sizes | {"P": load})

    @cached_property
    def scale(self) -> Scale:  # type: ignore[override]
        found = Scale(**self.sizes)
        if self.seconds:
            found |= dict.fromkeys(("t", "onset_time", "rest_time"), 1.0) | {"x": found["V"], "angle": found["omega"]}
        return found


class _Solid(NamedTuple):
    """A body that is uncertain; ``typical``: one of its draws."""

    E: Any
    nu: Any
    prony: Any
    typical: Material


def roller_of(path: Path, content: Mapping[str, Any]) -> Rolls:
    """What rolls, one or one a motion; raises ParameterError, of a material FileError."""
    bodies = {name: _body(path, name, content[name]) for name in SECTIONS if name in content}
    plain = {name: body.typical if isinstance(body, _Solid) else body for name, body in bodies.items()}
    one = body_of(path, content, plain)
    if not isinstance(one, Cylinder):
        return one
    sizes = {"R": one.R, "P": one.load, "m": one.m}
    if any(isinstance(body, _Solid) for body in bodies.values()):
        law, E_prime, T = _law(bodies["material"], bodies.get("base"), one.plane)
        scene = scene_of(one.R, one.m, one.load, E_prime, T, law, one.mu, one.j)
        return Rollers(scene, sizes | {"T": T})
    if np.ndim(one.T_epsilon):
        alpha = one.T_epsilon / one.T_sigma
        scene = scene_of(one.R, one.m, one.load, one.E_prime, one.T_epsilon, alpha, one.mu, one.j)
        return Rollers(scene.replace(gamma=scene.gamma / one.T_epsilon), sizes | {"T": one.T_epsilon}, seconds=True)
    return one


def drive_of(content: Mapping[str, Any]) -> dict[str, Any]:
    """What drives the motions, as keywords of ``ensemble``."""
    return {
        name: _schedule(name, **given) if isinstance(given, dict) else given
        for name, given in content.get("drive", {}).items()
    }


def _schedule(name: str, times: list[Any], values: list[Any]) -> Schedule:
    try:
        return Schedule(*(np.stack(np.broadcast_arrays(*each), axis=-1) for each in (times, values)))
    except ParameterError as error:
        raise ParameterError(name, error.value, error.allowed, f"{name}: {error}") from error


def _body(path: Path, name: str, given: Any) -> Material | _Solid:
    if isinstance(given, Material):
        return given
    first = _first(given)
    typical = materials_of(path, {name: first})[name]
    series = series_of(path, name, given)
    series = typical.prony if series is None else series
    if np.ndim(given.get("temperature")):
        shift = shifts_of(path, {name: first})[name]
        series = series.slower([shift(each) for each in given["temperature"]])
    E, nu = given.get("E", typical.E), given.get("nu", typical.nu)
    if not (series.shape or np.ndim(E) or np.ndim(nu)):
        return typical
    E = checked("E", E, low=0.0, strict=True) if np.ndim(E) else typical.E
    return _Solid(E, checked("nu", nu, low=-1.0, strict=True, high=0.5), series, typical)


def _first(part: Any) -> Any:
    """A section with the first of each of its arrays."""
    if isinstance(part, dict):
        return {key: _first(each) for key, each in part.items()}
    if isinstance(part, list):
        return [_first(each) for each in part]
    return float(part[0]) if isinstance(part, np.ndarray) else part


def _law(one: Any, other: Any, plane: str) -> tuple[Any, Any, float]:
    """(Series or bodies, one or one for each motion; E' of both; T_ref), as of a pair."""
    times = [getattr(body, "typical", body).T_ref for body in (one, other) if body is not None]
    modulus = effective_modulus(one.E, one.nu, plane)
    if other is None:
        return one.prony, modulus, times[0]
    relaxes = np.ndim(one.prony.alpha) or one.prony.alpha > 1.0
    T, base = times[0 if relaxes else 1], effective_modulus(other.E, other.nu, plane)
    first, second = (body.prony.slower(time / T) for body, time in zip((one, other), times, strict=True))
    return Bodies(first, second, cylinders_share(modulus, base)), joint_modulus(modulus, base), T
