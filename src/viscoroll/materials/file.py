"""Materials in files: sections [material] and [base] of TOML, or a netCDF file -> :class:`Material`."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from ..core.errors import FileError, ParameterError
from ..core.sections import as_struct, read_toml, section_error
from .law_store import is_law, read_law
from .material import Material
from .measured import Measured
from .prony import Prony
from .shift import WLF, Arrhenius, relative
from .store import SUFFIX

SECTIONS = ("material", "base")


class PronySection(msgspec.Struct):
    """prony = { E = [...], tau = [...] }."""

    E: list[float]
    tau: list[float]


class CreepSection(msgspec.Struct):
    """creep = { J = [...], T = [...] }, perhaps with alpha."""

    J: list[float]
    T: list[float]
    alpha: float | None = None


class FileSection(msgspec.Struct, kw_only=True):
    """[material] or [base] of a netCDF or TOML file, a thickness, and a temperature."""

    file: str
    thickness: float | None = None
    wlf: WLF | None = None
    arrhenius: Arrhenius | None = None
    temperature: float | None = None


class MaterialSection(FileSection, kw_only=True):
    """[material] or [base]: the parameters of :class:`Material`, or of :meth:`Material.sls`, and a temperature.

    T_epsilon, T_sigma : retardation and relaxation time of one mode, s, in place of a series.
    creep : in place of ``prony``: compliances over that at once, and times; perhaps alpha.
    wlf, arrhenius : how times shift with temperature.
    temperature : which they are wanted at, degrees Celsius.
    reference : at which moduli and times are as they stand here, degrees Celsius; default: where the shift is 1.
    """

    file: None = None  # type: ignore[assignment]
    E: float
    nu: float
    T_epsilon: float | None = None
    T_sigma: float | None = None
    prony: PronySection | None = None
    creep: CreepSection | None = None
    T_ref: float | None = None
    name: str = ""
    density: float | None = None
    measured: Measured | None = None
    reference: float | None = None


def read_materials(path: str | PathLike[str]) -> dict[str, Material]:
    """The materials of a TOML file by section, "material" and "base"; of a netCDF file its one, "material".

    Parameters
    ----------
    path : a file with [material], [base] or both: a scene file, a run file, or one of its own; other sections are not
        looked at.  Or one that :meth:`Material.to_netcdf` wrote.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, has neither section, or a misspelt or missing key, a value of
        the wrong type or out of its range, a temperature without a shift.
        A netCDF file that is missing, damaged, or no material.
    """
    if Path(path).suffix == SUFFIX:
        return {"material": Material.from_netcdf(path)}
    found = materials_of(path, read_toml(path))
    if not found:
        raise section_error(path, "", "material", "section [material] is missing: it needs E and nu")
    return found


def materials_of(path: Any, content: Mapping[str, Any]) -> dict[str, Material]:
    """The materials of a file that was read; arguments and errors as :func:`read_materials`."""
    return {name: _material(path, name, content[name]) for name in SECTIONS if name in content}


def shifts_of(path: Any, content: Mapping[str, Any]) -> dict[str, Callable[[float], float]]:
    """a_T of the materials of a file that was read, over temperature, 1 at that of the file, where it has a shift."""
    given = {name: _section(path, name, content[name]) for name in SECTIONS if name in content}
    found = {name: _shift(path, name, each) for name, each in given.items()}
    return {name: partial(relative, shift[0], reference=shift[1]) for name, shift in found.items() if shift}


def as_toml(material: Material, section: str = "material") -> str:
    """The section of a TOML file that reads back as this material, to the bit."""
    measured = material.measured and (
        f"{{ low = {material.measured.low}, high = {material.measured.high}, misfit = {material.measured.misfit}, "
        f"source = {_text(material.measured.source)} }}"
    )
    held = {name: getattr(material, name) for name in ("E", "nu", "T_ref", "density", "thickness")}
    held = {"name": _text(material.name)} | held | {"reference": material.temperature, "measured": measured}
    lines = [f"{name} = {value}" for name, value in held.items() if value is not None]
    return "\n".join([f"[{section}]", *lines, series_as_toml(material.prony), ""])


def series_as_toml(series: Prony) -> str:
    """The key ``prony`` or ``creep`` that reads back as this series, to the bit."""
    if series.by_creep:
        return f"creep = {{ J = {series.J.tolist()}, T = {series.T.tolist()}, alpha = {series.alpha!r} }}"
    return f"prony = {{ E = {series.E.tolist()}, tau = {series.tau.tolist()} }}"


def _text(given: str) -> str:
    # TOML knows no surrogates, and DEL only escaped
    return json.dumps(given, ensure_ascii=False).replace("\x7f", r"\u007f")


def _section(path: Any, name: str, content: Any) -> Any:
    """A section by its schema, that of a file or its own."""
    kind = FileSection if isinstance(content, dict) and "file" in content else MaterialSection
    return as_struct(path, name, content, kind)


def _material(path: Any, name: str, content: Any) -> Material:
    given = _section(path, name, content)
    try:
        found = _unshifted(path, name, given) if given.file is None else _stored(path, name, given)
        shift, own = _shift(path, name, given) or (None, given.temperature)
        if own is None:
            return found
        if shift is None:
            raise section_error(path, name, "temperature", f"temperature = {own:g}: needs wlf or arrhenius beside it")
        return found.at(own, shift)
    except ParameterError as error:
        raise section_error(path, name, error.name, str(error)) from error


def _stored(path: Any, name: str, given: FileSection) -> Material:
    """The material of a file beside ``path``: netCDF, its own or its law's, or TOML with this section or [material]."""
    found = _beside(path, name, Path(path).parent / given.file)
    return found if given.thickness is None else replace(found, thickness=given.thickness)


def _beside(path: Any, name: str, beside: Path) -> Material:
    try:
        if beside.suffix == SUFFIX:
            return _of_law(beside) if is_law(beside) else Material.from_netcdf(beside)
        content = read_toml(beside)
        section = name if name in content else "material"
        if section not in content:
            raise section_error(beside, "", "material", "section [material] is missing: it needs E and nu")
        if isinstance(content[section], dict) and "file" in content[section]:
            raise section_error(beside, section, "file", "file: must not name a file again")
        return _material(beside, section, content[section])
    except FileError as error:
        raise section_error(path, name, "file", str(error)) from error


def _of_law(path: Path) -> Material:
    """The one material that the file of a law names; raises FileError of a pair, or of a law without units."""
    found = tomllib.loads(read_law(path).attributes["material"])
    if not found.keys() & set(SECTIONS):
        raise FileError(path, "is the law of a material without units: it must be of one with [material]")
    if "base" in found:
        raise FileError(path, "is the law of a pair: give one material here, or load it by vr.load_law")
    return materials_of(path, found)["material"]


def _unshifted(path: Any, name: str, given: MaterialSection) -> Material:
    more = {key: getattr(given, key) for key in ("name", "density", "thickness", "measured")}
    more["temperature"] = given.reference
    series = series_of(path, name, msgspec.to_builtins({"prony": given.prony, "creep": given.creep}))
    if given.T_epsilon is not None or given.T_sigma is not None:
        if given.T_epsilon is None or given.T_sigma is None or given.T_ref is not None or series:
            raise section_error(
                path, name, "", "T_epsilon and T_sigma, in s, go together and without T_ref, prony and creep"
            )
        return Material.sls(given.E, given.nu, given.T_epsilon, given.T_sigma, **more)
    return Material(given.E, given.nu, series or Prony.elastic(), 1.0 if given.T_ref is None else given.T_ref, **more)


def series_of(path: Any, name: str, given: Mapping[str, Any]) -> Any:
    """The series of a section by its keys prony and creep, of arrays one each; None without.  Raises FileError."""
    found = {key: given[key] for key in ("prony", "creep") if given.get(key) is not None}
    if len(found) > 1:
        raise section_error(path, name, "creep", "prony and creep: must be one of the two")
    for key, lists in found.items():
        columns = {
            each: np.stack(np.broadcast_arrays(*value), axis=-1) if isinstance(value, list) and value else value
            for each, value in lists.items()
        }
        try:
            return Prony(**columns) if key == "prony" else Prony.creep(**columns)
        except ParameterError as error:  # at its own line: E is a key of the material too
            raise section_error(path, f"{name}.{key}", error.name, str(error)) from error
    return None


def _shift(path: Any, name: str, given: FileSection) -> tuple[WLF | Arrhenius, float | None] | None:
    """(a_T over temperature, the temperature that is asked for), where a section has one."""
    if given.wlf is not None and given.arrhenius is not None:
        raise section_error(path, name, "arrhenius", "wlf and arrhenius: must be one of the two")
    shift = given.wlf or given.arrhenius
    return None if shift is None else (shift, given.temperature)
