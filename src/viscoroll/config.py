"""TOML files: a scene, or the grids of the tables.

Misspelt keys and wrong types are refused by :mod:`sections`, ranges by what a section describes.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import msgspec

from .cylinder import Cylinder
from .errors import ConfigError, ParameterError, TableError, unknown
from .materials.file import SECTIONS, SUFFIX, materials_of, read_materials, series_of
from .presets import PRESETS
from .scene import Scene
from .sections import as_struct, fault, hint, read, refuse_unknown

if TYPE_CHECKING:
    from .tables import AtlasGrid, LiteralGrid, MaterialGrid

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


class Spread(msgspec.Struct):
    """An axis as the arguments of :func:`viscoroll.tables.spread`."""

    low: float
    high: float
    count: int
    spacing: Literal["linear", "log"] = "linear"


Axis = tuple[float, ...] | dict[str, Any]


class PaperSection(msgspec.Struct):
    """[tables.paper]: :class:`viscoroll.tables.LiteralGrid`, an axis as a list or as a :class:`Spread`."""

    kappa: float
    mu: float
    V: Axis
    delta: Axis
    alpha: Axis


class MaterialTable(msgspec.Struct):
    """Any other section of [tables]: :class:`viscoroll.tables.MaterialGrid`.

    material : a TOML file with [material] and perhaps [base], a netCDF file of a material, or the columns of a DMA,
        which are fitted; seen from this file.  base : that of the half-space, a file or {E, nu}.
    nu : Poisson's ratio of what is fitted.
    """

    material: str
    kappa: float
    mu: float
    V: Axis
    delta: Axis
    base: str | dict[str, Any] | None = None
    nu: float = 0.49
    name: str | None = None


#: The paper's Sect. 5.  delta_star is at most 0.0344 there, so |delta| = 0.04 is full slip at
#: every (V, alpha); the alphas are those of its figures, and some between.
_PAPER_DEFAULT = {
    "kappa": 2.91,
    "mu": 0.2,
    "V": {"low": 1e-3, "high": 2.0, "count": 201, "spacing": "log"},
    "delta": {"low": -0.04, "high": 0.04, "count": 401},
    "alpha": [1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 11.0, 21.5, 81.5],
}


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


def read_body(path: str | PathLike[str]) -> Scene | Cylinder:
    """Scene or cylinder of a TOML file that holds one of ``preset``, ``[scene]`` and ``[cylinder]``.

    ``preset`` names a scene of :mod:`presets`, ``[scene]`` gives alpha (or prony, or creep), kappa, mu (gamma, j),
    ``[cylinder]`` R, m, E, nu, T_epsilon, T_sigma, mu (j, g, plane, load) in SI units; E to T_sigma stand in a
    section [material] instead where there is one, and [base] is the half-space where it differs.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, holds none or several of the three, a
        misspelt or missing key, a value of the wrong type or out of its range.
    """
    content = read(path)
    refuse_unknown(path, "", content, (*_SCENES, *SECTIONS))
    given = [name for name in _SCENES if name in content]
    if len(given) != 1:
        found = " and ".join(given) or "none"
        raise ConfigError(path, f"must hold exactly one of preset, [scene] and [cylinder], found {found}")
    if given != ["cylinder"]:
        refuse_unknown(path, "", content, _SCENES)
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


def read_grids(path: str | PathLike[str] | None = None) -> dict[str, AtlasGrid | LiteralGrid | MaterialGrid]:
    """Grids "atlas" and "paper" from the sections of [tables]; what is left out has its default.

    Any other section with a key ``material`` is a table of that name.  Outside [tables] nothing is looked at.
    Without a file: the two.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, without [tables], a misspelt key, a value of
        the wrong type or out of its range, a material that cannot be read or fitted.
    """
    from .tables import AtlasGrid, LiteralGrid

    content = {"tables": {}} if path is None else read(path)
    if "tables" not in content:
        raise ConfigError(path, "section [tables] is missing" + hint("tables", content))
    sections = content["tables"]
    named = sections if isinstance(sections, dict) else {}
    others = [name for name, given in named.items() if isinstance(given, dict) and "material" in given]
    refuse_unknown(path, "tables", sections, ("atlas", "paper", *others))
    atlas = as_struct(path, "tables.atlas", sections.get("atlas", {}), AtlasGrid)
    given = sections.get("paper", {})
    refuse_unknown(path, "tables.paper", given, _PAPER_DEFAULT)
    paper = as_struct(path, "tables.paper", _PAPER_DEFAULT | given, PaperSection)
    made: dict[str, Any] = {"atlas": atlas, "paper": _grid(path, "paper", paper, LiteralGrid, PaperSection)}
    return made | {name: _material_grid(path, name, sections[name]) for name in others}


def _grid(path: Any, name: str, given: Any, kind: Any, section: Any, **materials: Any) -> Any:
    """A grid of [tables.NAME], its axes spread out."""
    from .tables import spread

    values = {key: getattr(given, key) for key in section.__struct_fields__ if key in kind.__dataclass_fields__}
    try:
        for key in ("V", "delta", "alpha"):
            if isinstance(values.get(key), dict):
                axis = as_struct(path, f"tables.{name}.{key}", values[key], Spread)
                values[key] = spread(**msgspec.structs.asdict(axis))
        return kind(**values | materials)
    except ParameterError as error:
        raise ConfigError(path, f"[tables.{name}] {error}") from error


def _material_grid(path: Any, name: str, content: dict[str, Any]) -> Any:
    from .tables import MaterialGrid

    given, folder = as_struct(path, f"tables.{name}", content, MaterialTable), Path(path).parent
    try:
        if isinstance(given.base, dict):
            materials = materials_of(path, {"base": given.base})
        else:
            materials = {} if given.base is None else {"base": read_materials(folder / given.base)["material"]}
        materials = _materials(folder / given.material, given) | materials
    except (ParameterError, TableError) as error:
        raise fault(path, f"tables.{name}", "material", str(error)) from error
    return _grid(path, name, given, MaterialGrid, MaterialTable, **materials)


def _materials(path: Path, given: MaterialTable) -> dict[str, Any]:
    """Those of a TOML or netCDF file, or the fit of a master curve."""
    if path.suffix in (".toml", SUFFIX):
        return read_materials(path)
    from .dma import fit_prony, read_dma

    return {"material": fit_prony(*read_dma(path), source=path.name).material(given.nu, name=given.name or path.stem)}
