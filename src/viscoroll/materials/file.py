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

from ..errors import ConfigError, ParameterError, TableError
from ..sections import as_struct, fault, read
from .law_store import is_law, read_law
from .material import Material
from .measured import Measured
from .prony import Prony
from .shift import WLF, Arrhenius
from .store import SUFFIX

SECTIONS = ("material", "base")


class MaterialSection(msgspec.Struct):
    """[material] or [base]: the parameters of :class:`Material`, or of :meth:`Material.sls`, and a temperature."""

    E: float
    nu: float
    T_epsilon: float | None = None
    T_sigma: float | None = None
    prony: dict[str, Any] | None = None
    creep: dict[str, Any] | None = None
    T_ref: float | None = None
    name: str = ""
    density: float | None = None
    thickness: float | None = None
    measured: dict[str, Any] | None = None
    wlf: dict[str, Any] | None = None
    arrhenius: dict[str, Any] | None = None
    temperature: float | None = None


class FileSection(msgspec.Struct):
    """[material] or [base] of a netCDF or TOML file, a thickness, and a temperature."""

    file: str
    thickness: float | None = None
    wlf: dict[str, Any] | None = None
    arrhenius: dict[str, Any] | None = None
    temperature: float | None = None


class PronySection(msgspec.Struct):
    """prony = { E = [...], tau = [...] }."""

    E: list[float]
    tau: list[float]


class CreepSection(msgspec.Struct):
    """creep = { J = [...], T = [...] }, perhaps with alpha."""

    J: list[float]
    T: list[float]
    alpha: float | None = None


class MeasuredSection(msgspec.Struct):
    """measured = { low = ..., high = ..., misfit = ... }, perhaps with source."""

    low: float
    high: float
    misfit: float
    source: str = ""


class WLFSection(msgspec.Struct):
    """wlf = { T0 = ... }."""

    T0: float
    C1: float = 17.44
    C2: float = 51.6


class ArrheniusSection(msgspec.Struct):
    """arrhenius = { T0 = ..., energy = ... }."""

    T0: float
    energy: float


def read_materials(path: str | PathLike[str], temperature: float | None = None) -> dict[str, Material]:
    """The materials of a TOML file by section, "material" and "base"; of a netCDF file its one, "material".

    Parameters
    ----------
    path : a file with [material], [base] or both: a scene file, a run file, or one of its own; other sections are not
        looked at.  Or one that :meth:`Material.to_netcdf` wrote.
    temperature : degrees Celsius, in place of those in the file, of the sections that have a shift.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, has neither section, or a misspelt or missing key, a value of
        the wrong type or out of its range, a temperature without a shift.
    TableError
        A netCDF file that is missing, damaged, or no material.
    """
    if Path(path).suffix == SUFFIX:
        if temperature is not None:
            raise ConfigError(path, f"temperature = {temperature:g}: needs a TOML file with wlf or arrhenius")
        return {"material": Material.from_netcdf(path)}
    content = read(path)
    found = materials_of(path, content, temperature)
    if not found:
        raise fault(path, "", "material", "section [material] is missing: it needs E and nu")
    if temperature is not None and not any("wlf" in content[name] or "arrhenius" in content[name] for name in found):
        raise fault(path, next(iter(found)), "", f"temperature = {temperature:g}: needs wlf or arrhenius in the file")
    return found


def materials_of(path: Any, content: Mapping[str, Any], temperature: float | None = None) -> dict[str, Material]:
    """The materials of a file that was read; arguments and errors as :func:`read_materials`."""
    return {name: _material(path, name, content[name], temperature) for name in SECTIONS if name in content}


def shifts_of(path: Any, content: Mapping[str, Any]) -> dict[str, Callable[[float], float]]:
    """a_T of the materials of a file that was read, over temperature, 1 at that of the file, where it has a shift."""
    found: dict[str, Callable[[float], float]] = {}
    for name in SECTIONS:
        if name in content:
            stored = "file" in content[name]
            given: Any = as_struct(path, name, content[name], FileSection if stored else MaterialSection)
            if (shift := _shift(path, name, given)) is not None:
                own = 1.0 if given.temperature is None else shift(given.temperature)
                found[name] = partial(_relative, shift, own)
    return found


def _relative(shift: WLF | Arrhenius, own: float, temperature: float) -> float:
    return shift(temperature) / own


def as_toml(material: Material, section: str = "material") -> str:
    """The section of a TOML file that reads back as this material, to the bit."""
    measured = material.measured and (
        f"{{ low = {material.measured.low}, high = {material.measured.high}, misfit = {material.measured.misfit}, "
        f"source = {_text(material.measured.source)} }}"
    )
    first: dict[str, Any] = {"name": _text(material.name), "E": material.E, "nu": material.nu}
    more: dict[str, Any] = {
        "T_ref": material.T_ref, "density": material.density, "thickness": material.thickness, "measured": measured,
    }  # fmt: skip
    lines = [f"{name} = {value}" for name, value in first.items()]
    lines += [series_as_toml(material.prony)]
    lines += [f"{name} = {value}" for name, value in more.items() if value is not None]
    return "\n".join([f"[{section}]", *lines, ""])


def series_as_toml(series: Prony) -> str:
    """The key ``prony`` or ``creep`` that reads back as this series, to the bit."""
    if series.by_creep:
        return f"creep = {{ J = {series.J.tolist()}, T = {series.T.tolist()}, alpha = {series.alpha!r} }}"
    return f"prony = {{ E = {series.E.tolist()}, tau = {series.tau.tolist()} }}"


def _text(given: str) -> str:
    # TOML knows no surrogates, and DEL only escaped
    return json.dumps(given, ensure_ascii=False).replace("\x7f", r"\u007f")


def _material(path: Any, name: str, content: Any, temperature: float | None) -> Material:
    stored = isinstance(content, dict) and "file" in content
    given: Any = as_struct(path, name, content, FileSection if stored else MaterialSection)
    try:
        shift = _shift(path, name, given)
        found = _stored(path, name, given) if stored else _unshifted(path, name, given)
        if stored and given.thickness is not None:
            found = replace(found, thickness=given.thickness)
        at = given.temperature if temperature is None or shift is None else temperature
        if at is None:
            return found
        if shift is None:
            raise fault(path, name, "temperature", f"temperature = {at:g}: needs wlf or arrhenius beside it")
        return found.at(at, shift)
    except ParameterError as error:
        raise fault(path, name, error.name, str(error)) from error


def _stored(path: Any, name: str, given: FileSection) -> Material:
    """The material of a file beside ``path``: netCDF, its own or its law's, or TOML with this section or [material]."""
    beside = Path(path).parent / given.file
    try:
        if beside.suffix == SUFFIX:
            return _of_law(beside) if is_law(beside) else Material.from_netcdf(beside)
        content = read(beside)
        section = name if name in content else "material"
        if section not in content:
            raise fault(beside, "", "material", "section [material] is missing: it needs E and nu")
        if isinstance(content[section], dict) and "file" in content[section]:
            raise fault(beside, section, "file", "file: must not name a file again")
        return _material(beside, section, content[section], None)
    except (ConfigError, TableError) as error:
        raise fault(path, name, "file", str(error)) from error


def _of_law(path: Path) -> Material:
    """The one material that the file of a law names; raises TableError of a pair, or of a law without units."""
    found = tomllib.loads(read_law(path).attributes["material"])
    if not found.keys() & set(SECTIONS):
        raise TableError(path, "is the law of a material without units: it must be of one with [material]")
    if "base" in found:
        raise TableError(path, "is the law of a pair: give one material here, or load it by vr.load_law")
    return materials_of(path, found)["material"]


def _unshifted(path: Any, name: str, given: MaterialSection) -> Material:
    more: dict[str, Any] = {"name": given.name, "density": given.density, "thickness": given.thickness}
    if given.measured is not None:
        band = as_struct(path, f"{name}.measured", given.measured, MeasuredSection)
        more["measured"] = Measured(**msgspec.structs.asdict(band))
    series = series_of(path, name, given.prony, given.creep)
    if given.T_epsilon is not None or given.T_sigma is not None:
        if given.T_epsilon is None or given.T_sigma is None or given.T_ref is not None or series:
            raise fault(path, name, "", "T_epsilon and T_sigma, in s, go together and without T_ref, prony and creep")
        return Material.sls(given.E, given.nu, given.T_epsilon, given.T_sigma, **more)
    return Material(given.E, given.nu, series or Prony.elastic(), 1.0 if given.T_ref is None else given.T_ref, **more)


def series_of(path: Any, name: str, prony: Any, creep: Any) -> Prony | None:
    """The series of section ``name`` by its keys prony and creep, None without; raises ConfigError."""
    if prony is not None and creep is not None:
        raise fault(path, name, "creep", "prony and creep: must be one of the two")
    at = f"{name}.prony" if creep is None else f"{name}.creep"
    try:
        if prony is not None:
            relaxation = as_struct(path, at, prony, PronySection)
            return Prony(relaxation.E, relaxation.tau)
        if creep is not None:
            given = as_struct(path, at, creep, CreepSection)
            return Prony.creep(given.J, given.T, alpha=given.alpha)
    except ParameterError as error:  # at its own line: E is a key of the material too
        raise fault(path, at, error.name, str(error)) from error
    return None


def _shift(path: Any, name: str, given: MaterialSection | FileSection) -> WLF | Arrhenius | None:
    if given.wlf is not None and given.arrhenius is not None:
        raise fault(path, name, "arrhenius", "wlf and arrhenius: must be one of the two")
    if given.wlf is not None:
        return WLF(**msgspec.structs.asdict(as_struct(path, f"{name}.wlf", given.wlf, WLFSection)))
    if given.arrhenius is not None:
        section = as_struct(path, f"{name}.arrhenius", given.arrhenius, ArrheniusSection)
        return Arrhenius(energy=section.energy, T0=section.T0)
    return None
