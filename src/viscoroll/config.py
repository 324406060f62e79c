"""TOML files: a scene, or what has the law of a material.

Misspelt keys and wrong types are refused by :mod:`sections`, ranges by what a section describes.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any, Literal

import msgspec

from .cylinder import Cylinder
from .errors import ConfigError, ParameterError, unknown
from .materials.file import SECTIONS, SUFFIX, materials_of, read_materials, series_of
from .materials.pair import Pair
from .presets import PRESETS
from .scene import Scene
from .sections import as_struct, fault, read, refuse_unknown

_SCENES = ("preset", "scene", "cylinder")


class SceneSection(msgspec.Struct, kw_only=True):
    """[scene]: the parameters of :class:`Scene`, one number each; alpha, or the series in its place."""

    alpha: float | None = None
    kappa: float
    mu: float
    gamma: float | None = None
    j: float = 0.5
    prony: dict[str, Any] | None = None
    creep: dict[str, Any] | None = None


class CylinderSection(msgspec.Struct, kw_only=True):
    """[cylinder]: the parameters of :class:`Cylinder`, but for the materials."""

    R: float
    m: float
    E: float | None = None
    nu: float | None = None
    T_epsilon: float | None = None
    T_sigma: float | None = None
    mu: float
    j: float = 0.5
    g: float = 9.81
    plane: Literal["strain", "stress"] = "strain"
    load: float | None = None


def preset(name: str) -> Scene:
    """The scene of that name: the paper's, or the rubber roller.

    Raises
    ------
    ParameterError
        An unknown name.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise unknown("preset", name, PRESETS, "a preset")
    return PRESETS[name]


def read_scene(path: str | PathLike[str]) -> Scene:
    """The dimensionless scene of :func:`read_body`; errors as there."""
    body = read_body(path)
    return body.scene() if isinstance(body, Cylinder) else body


def read_body(path: str | PathLike[str], beside: tuple[str, ...] = ()) -> Scene | Cylinder:
    """Scene or cylinder of a TOML file that holds one of ``preset``, ``[scene]`` and ``[cylinder]``.

    ``preset`` names a scene of :mod:`presets`, ``[scene]`` gives alpha (or prony, or creep), kappa, mu (gamma, j),
    ``[cylinder]`` R, m, E, nu, T_epsilon, T_sigma, mu (j, g, plane, load) in SI units; E to T_sigma stand in a
    section [material] instead where there is one, and [base] is the half-space where it differs.
    ``beside`` : other sections that the file may have.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, holds none or several of the three, a
        misspelt or missing key, a value of the wrong type or out of its range.
    """
    content = read(path)
    refuse_unknown(path, "", content, (*_SCENES, *SECTIONS, *beside))
    given = [name for name in _SCENES if name in content]
    if len(given) != 1:
        found = " and ".join(given) or "none"
        raise ConfigError(path, f"must hold exactly one of preset, [scene] and [cylinder], found {found}")
    if given != ["cylinder"]:
        refuse_unknown(path, "", content, (*_SCENES, *beside))
    try:
        if "preset" in content:
            return preset(content["preset"])
        if "cylinder" in content:
            rolls = msgspec.structs.asdict(as_struct(path, "cylinder", content["cylinder"], CylinderSection))
            body = Cylinder(**(rolls | materials_of(path, content)))
            body.scene()  # refuses what leaves the range of doubles
            return body
        return _scene(path, as_struct(path, "scene", content["scene"], SceneSection))
    except ParameterError as error:
        section = "" if "preset" in content else given[0]
        raise fault(path, section, error.name, str(error)) from error


def _scene(path: Any, given: SceneSection) -> Scene:
    parameters = {name: getattr(given, name) for name in ("alpha", "kappa", "mu", "gamma", "j")}
    return Scene(**parameters, material=series_of(path, "scene", given.prony, given.creep))


def read_bodies(path: str | PathLike[str], temperature: float | None = None) -> Any:
    """The pair, the series or bodies, or the alpha of a file: what has a contact law.

    ``path`` : TOML with [material], perhaps [base], or a scene file; or the netCDF of a material.
    ``temperature`` : as of :func:`read_materials`, of a file with [material].

    Raises
    ------
    ConfigError, TableError
        As :func:`read_materials` and :func:`read_body`.
    """
    content = {} if Path(path).suffix == SUFFIX else read(path)
    if content.keys() & set(_SCENES) and not content.keys() & set(SECTIONS):
        body = read_body(path)
        if temperature is not None:
            raise ConfigError(path, f"temperature = {temperature:g}: needs [material] with wlf or arrhenius")
        if isinstance(body, Cylinder):
            return body.pair
        return body.alpha if body.material is None else body.material
    found = read_materials(path, temperature)
    if "material" not in found:
        raise ConfigError(path, "section [material] is missing")
    try:
        return Pair(found["material"], found.get("base"))
    except ParameterError as error:
        raise fault(path, "base", error.name, str(error)) from error
