"""TOML files: what rolls, or what has the law of a material.

One schema for all of them: a run file is a scene file in which any number may be uncertain, with a start and [run].
Types and misspelt keys are refused by :mod:`sections`, ranges by what a section describes.
"""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import msgspec

from ..core.errors import FileError, ParameterError, unknown_name_error
from ..core.sections import as_struct, check_keys, read_toml, section_error
from ..cylinder import Cylinder
from ..materials.material_toml import (
    SECTIONS,
    SUFFIX,
    CreepSection,
    PronySection,
    parse_materials,
    parse_series,
    read_materials,
)
from ..materials.pair import Pair
from ..presets import PRESETS
from ..scene import Scene


class SceneSection(msgspec.Struct):
    """[scene]: the parameters of :class:`Scene`; a preset has them all.

    prony : in place of alpha: strengths over the long-time modulus, and times.
    creep : in place of alpha: compliances over that at once, and times; perhaps alpha.
    """

    alpha: float | None = None
    kappa: float | None = None
    mu: float | None = None
    gamma: float | None = None
    j: float | None = None
    prony: PronySection | None = None
    creep: CreepSection | None = None


class CylinderSection(msgspec.Struct, kw_only=True):
    """[cylinder]: the parameters of :class:`Cylinder`, but for the materials."""

    R: float
    m: float
    E: float | None = None
    nu: float | None = None
    T_epsilon: float | None = None
    T_sigma: float | None = None
    mu: float
    j: float | None = None
    g: float | None = None
    plane: Literal["strain", "stress"] = "strain"
    load: float | None = None


SCHEMA: dict[str, type] = {"scene": SceneSection, "cylinder": CylinderSection}
SCENES = ("preset", *SCHEMA)


def preset(name: str) -> Scene:
    """The scene of that name: the paper's, or the rubber roller.

    Raises
    ------
    ParameterError
        An unknown name.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise unknown_name_error("preset", name, PRESETS, "a preset")
    return PRESETS[name]


def read_roller(path: str | PathLike[str], beside: tuple[str, ...] = ()) -> Scene | Cylinder:
    """Scene or cylinder of a TOML file: of its ``preset``, its [scene], which may change a preset, or its [cylinder].

    ``preset`` names a scene of :mod:`presets`, ``[scene]`` gives alpha (or prony, or creep), kappa, mu (gamma, j),
    ``[cylinder]`` R, m, E, nu, T_epsilon, T_sigma, mu (j, g, plane, load) in SI units; E to T_sigma stand in a
    section [material] instead where there is one, and [base] is the half-space where it differs.
    ``beside`` : other sections that the file may have.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, holds none of the three or a cylinder beside a scene, a
        misspelt or missing key, a value of the wrong type or out of its range.
    """
    content = read_toml(path)
    check_sections(path, content, dict.fromkeys(beside))
    try:
        body = make_roller(path, content, parse_materials(path, content))
        body.scene()  # refuses what leaves the range of doubles
    except ParameterError as error:
        raise locate_error(path, content, error) from error
    return body


def check_sections(path: Any, content: dict[str, Any], more: Mapping[str, type | None]) -> None:
    """Raise FileError where sections do not go together, or hold keys and types that they do not have.

    ``more`` : other sections that the file may have, by their schema, or None where they are checked elsewhere.
    """
    check_keys(path, "", content, (*SCENES, *SECTIONS, *more))
    if not content.keys() & set(SCENES):
        raise section_error(path, "", "", "one of preset, [scene] and [cylinder] is needed")
    scenes = [name for name in ("preset", "scene") if name in content]
    if "cylinder" in content and scenes:
        raise section_error(path, "", "cylinder", f"[cylinder] stands alone: without {' and '.join(scenes)}")
    for name in SECTIONS:
        if name in content and "cylinder" not in content:
            raise section_error(path, "", name, f"[{name}] goes with [cylinder]")
    for name, kind in {**SCHEMA, **more}.items():
        if name in content and kind is not None:
            as_struct(path, name, content[name], kind)


def make_roller(path: Any, content: Mapping[str, Any], materials: Mapping[str, Any]) -> Scene | Cylinder:
    """What rolls by checked sections, whose numbers may be arrays; raises ParameterError, of a series FileError."""
    if "cylinder" in content:
        return Cylinder(**content["cylinder"], **materials)
    given = dict(content.get("scene", {}))
    if (series := parse_series(path, "scene", given)) is not None:
        given["material"] = series
    given = {name: value for name, value in given.items() if name not in ("prony", "creep")}
    if "preset" in content:
        return preset(content["preset"]).replace(**given)
    for name in ("kappa", "mu"):
        if name not in given:
            raise ParameterError(name, None, "given", f"needs {name}")
    return Scene(**given)


def locate_error(path: Any, content: Mapping[str, Any], error: ParameterError) -> FileError:
    """A refusal with the section and the line of what it names."""
    own = (name for name, given in content.items() if isinstance(given, dict) and error.name in given)
    section = "" if error.name in content else next(own, next((name for name in SCHEMA if name in content), ""))
    return section_error(path, section, error.name, str(error))


def read_law_source(path: str | PathLike[str]) -> Any:
    """The pair, the series or bodies, or the alpha of a file: what has a contact law; of a layer the cylinder.

    ``path`` : TOML with [material], perhaps [base], or a scene file; or the netCDF of a material.

    Raises
    ------
    FileError
        As :func:`read_materials` and :func:`read_roller`.
    """
    content = {} if Path(path).suffix == SUFFIX else read_toml(path)
    if content.keys() & set(SCENES) and not content.keys() & set(SECTIONS):
        body = read_roller(path)
        if isinstance(body, Cylinder):
            return body.pair if body.pair.covered is None else body
        return body.alpha if body.material is None else body.material
    found = read_materials(path)
    if "material" not in found:
        raise FileError(path, "section [material] is missing")
    try:
        pair = Pair(found["material"], found.get("base"))
    except ParameterError as error:
        raise section_error(path, "base", error.name, str(error)) from error
    return read_roller(path) if pair.covered is not None and "cylinder" in content else pair
