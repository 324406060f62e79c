"""What rolls in a block of a run, and what drives it: sections whose numbers are those of its motions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np

from ...contact_law.parameters import Parameters, Roller
from ...core.checks import check_array
from ...core.drive import Schedule
from ...core.errors import ParameterError
from ...core.scale import Scale
from ...cylinder import Cylinder, contact_length, scene_of
from ...materials.file import SECTIONS, materials_of, series_of, shifts_of
from ...materials.material import Material
from ...materials.measured import Measured
from ...materials.pair import Pair, Solid
from ..config import make_roller


@dataclass(frozen=True, eq=False)
class Rollers(Roller):
    """Cylinders each of a material of its own, in SI units.

    like : their numbers, with one of their materials.
    law, E_prime, T : what they deform by, or bodies of which one has a thickness; times over T.  Where each has a T of
        its own times are counted in s: gamma does nothing but scale time (Eq. (22)), so that gamma/T in its place makes
        it seconds, the same for all.
    """

    like: Cylinder
    law: Any
    E_prime: Any
    T: Any

    @property
    def seconds(self) -> bool:
        """Whether times are counted in s."""
        return np.ndim(self.T) > 0

    @cached_property
    def _scene(self) -> Parameters:
        one = self.like
        law = self.law
        if isinstance(law, Pair):
            law = law.cover(contact_length(one.R, one.load, self.E_prime))
        found = scene_of(one.R, one.m, one.load, self.E_prime, self.T, law, one.mu, one.j)
        return found.replace(gamma=found.gamma / self.T) if self.seconds else found

    def scene(self) -> Parameters:
        return self._scene

    def on_slope(self, slope: Any) -> Self:
        return replace(self, like=self.like.on_slope(slope))

    @cached_property
    def scale(self) -> Scale:  # type: ignore[override]
        found = Scale(self.like.R, self.T, self.like.load, self.like.m)
        if self.seconds:
            found |= dict.fromkeys(("t", "onset_time", "rest_time"), 1.0) | {"x": found["V"], "angle": found["omega"]}
        return found


def roller_of(path: Path, content: Mapping[str, Any]) -> Roller:
    """What rolls, one or one a motion; raises ParameterError, of a material FileError."""
    bodies = {name: _body(path, name, content[name]) for name in SECTIONS if name in content}
    one = make_roller(path, content, {name: typical for name, (typical, _) in bodies.items()})
    if not isinstance(one, Cylinder):
        return one
    each = {name: body for name, (_, body) in bodies.items()}
    if any(isinstance(body, Solid) for body in each.values()):
        pair = Pair(each.get("material") or one.pair.cylinder, each.get("base"), one.plane)
        return Rollers(one, pair.law if pair.covered is None else pair, pair.E_prime, pair.T_ref)
    if np.ndim(one.T_epsilon):
        return Rollers(one, one.T_epsilon / one.T_sigma, one.E_prime, one.T_epsilon)
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


def _body(path: Path, name: str, given: Any) -> tuple[Material, Material | Solid]:
    """One of its draws, and it."""
    if isinstance(given, Material):
        return given, given
    first = _first(given)
    typical = materials_of(path, {name: first})[name]
    series = series_of(path, name, given)
    series = typical.prony if series is None else series
    if np.ndim(given.get("temperature")):
        shift = shifts_of(path, {name: first})[name]
        series = series.slower([shift(each) for each in given["temperature"]])
    E, nu = given.get("E", typical.E), given.get("nu", typical.nu)
    thickness = given.get("thickness", typical.thickness)
    if not (series.shape or np.ndim(E) or np.ndim(nu) or np.ndim(thickness)):
        return typical, typical
    if thickness is not None:
        thickness = check_array("thickness", thickness, low=0.0, strict=True)
    E = check_array("E", E, low=0.0, strict=True) if np.ndim(E) else typical.E
    return typical, Solid(E, check_array("nu", nu, low=-1.0, strict=True, high=0.5), series, typical.T_ref, thickness)


def measured_bands(path: Path, content: Mapping[str, Any]) -> dict[Measured, tuple[Any, Any]]:
    """Angular frequencies between which the data of each body hold, at the temperature of each motion.

    Parameters
    ----------
    path : of the run file.
    content : its sections with the inputs of some motions.

    Returns
    -------
    dict
        What was measured of a body -> lowest and highest frequency, rad/s, numbers or one a motion; of bodies that
        tell.
    """
    found = {}
    for name in SECTIONS:
        given = content.get(name)
        if given is None or (record := _body(path, name, given)[0].measured) is None:
            continue
        factor: Any = 1.0
        if isinstance(given, dict) and np.ndim(given.get("temperature", 0.0)):  # the record is at the first of them
            shift = shifts_of(path, {name: _first(given)})[name]
            factor = np.array([shift(each) for each in given["temperature"]])
        found[record] = record.low / factor, record.high / factor
    return found


def _first(part: Any) -> Any:
    """A section with the first of each of its arrays."""
    if isinstance(part, dict):
        return {key: _first(each) for key, each in part.items()}
    if isinstance(part, list):
        return [_first(each) for each in part]
    return float(part[0]) if isinstance(part, np.ndarray) else part
