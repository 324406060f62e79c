"""Materials in files: sections [material] and [base] of TOML, or a netCDF file ->
:class:`Material`.
"""

import json
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ..core import (
    FileError,
    FilePath,
    as_section_error,
    as_struct,
    check_number,
    read_toml,
    section_error,
)
from .checked_netcdf import REMEDY, SUFFIX, is_law, read_law, shifts_as_toml
from .material import Material
from .measured_data import ABSOLUTE_ZERO, WLF, Arrhenius, Measured
from .prony import Prony

#: sections of a file that describe a body
SECTIONS = ("material", "base")
#: what is missing from a file without them
_NO_MATERIAL = "section [material] is missing: add it, with at least E and nu"


@dataclass
class PronySection:
    """Key prony = { E = [...], tau = [...] }: the parameters of :class:`Prony`."""

    E: list[float]
    tau: list[float]


@dataclass
class CreepSection:
    """Key creep = { J = [...], T = [...] }: the parameters of :meth:`Prony.creep`."""

    J: list[float]
    T: list[float]
    alpha: float | None = None


@dataclass(kw_only=True)
class FileSection:
    """Section [material] or [base] that names a netCDF or TOML file.

    thickness, density : as in :class:`MaterialSection`; they replace those of the file.
    wlf, arrhenius, temperature, vertical_shift : as in :class:`MaterialSection`; they shift the
    material of the file.
    """

    file: str
    thickness: float | None = None
    density: float | None = None
    wlf: WLF | None = None
    arrhenius: Arrhenius | None = None
    vertical_shift: Literal["entropic"] | None = None
    temperature: float | None = None


@dataclass(kw_only=True)
class MaterialSection(FileSection):
    """Section [material] or [base]: the parameters of :class:`Material` or :meth:`Material.sls`,
    and a temperature.

    E : long-time Young's modulus, Pa, > 0; inf for a rigid body.
    nu : Poisson's ratio, in (-1, 0.5].  A rigid body (E = inf) needs none.
    T_epsilon : retardation time of a standard linear solid, s, in place of a series.
    T_sigma : relaxation time of a standard linear solid, s, in place of a series.
    prony : Prony series: strengths divided by E, and relaxation times in units of T_ref; default:
        elastic.
    creep : creep series in place of ``prony``: strengths divided by the long-time compliance,
        retardation times in units of T_ref, and optionally alpha.
    T_ref : unit of the times of ``prony`` and ``creep``, s; default: 1.
    thickness : thickness of a layer, m, that is bonded to a rigid core (covered roller) or to a
        rigid bed (belt, lining); default: a half-space.  Both bodies may be layers.
    density : density, kg/m^3, with which ``validity`` compares the speed with that of shear waves.
    wlf : time-temperature shift log10 a_T = -C1 (T - T0)/(C2 + T - T0), with T0 in degrees Celsius;
        C1 and C2 (in K) may be left out, they are then 17.44 and 51.6.
    arrhenius : time-temperature shift ln a_T = energy/(8.314 J/(mol K)) (1/T - 1/T0), with absolute
        temperatures in the formula; in the file T0 is in degrees Celsius, energy in J/mol.
    vertical_shift : "entropic": the moduli are multiplied by the absolute temperature of the
        material, divided by the absolute temperature of ``reference``.
    temperature : temperature of the material, degrees Celsius; it needs ``wlf`` or ``arrhenius``.
    reference : temperature at which moduli and times are as given, degrees Celsius; default: the
        temperature at which the shift is 1.
    nu_instant : Poisson's ratio at t = 0, if it differs from nu.
    name : name in tables and figures.
    measured : the DMA data to which the material was fitted, as ``viscoroll material fit`` writes
        them: low and high, the first and last angular frequency, rad/s; misfit, the relative rms
        error of the fit; source, a text; M_error, pairs of a transit frequency in 1/s and the
        relative error of M there; strain, the strain amplitude.  Functions warn of speeds for which
        these frequencies do not suffice.
    """

    file: None = None  # type: ignore[assignment]
    E: float
    nu: float | None = None
    T_epsilon: float | None = None
    T_sigma: float | None = None
    prony: PronySection | None = None
    creep: CreepSection | None = None
    T_ref: float | None = None
    name: str = ""
    measured: Measured | None = None
    reference: float | None = None
    nu_instant: float | None = None


def read_materials(path: FilePath) -> dict[str, Material]:
    """Read the materials of a file.

    Parameters
    ----------
    path : a TOML file with [material], [base] or both: a scene file, a run file, or one of its own;
        other sections are ignored.  Or a netCDF file (suffix .nc) that :meth:`Material.to_netcdf`
        wrote.

    Returns
    -------
    dict of str to Material
        By the names of the sections, "material" and "base", those that exist; of a netCDF file
        "material" alone.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, has neither section, or a misspelt or missing key,
        a value of the wrong type or out of its range, a temperature without a shift.
        A netCDF file that is missing, damaged, or no material (also the law of one).

    Warns
    -----
    ModelWarning
        A temperature outside -150 to 200: it looks like one in kelvin.
    """
    if Path(path).suffix.lower() == SUFFIX:
        return {"material": Material.from_netcdf(path)}
    materials = parse_materials(path, read_toml(path))
    if not materials:
        raise section_error(path, "", "material", _NO_MATERIAL)
    return materials


def parse_materials(path: Any, content: Mapping[str, Any]) -> dict[str, Material]:
    """Return the materials of a file that was read.

    path: path of the file, for errors; paths in its sections are relative to its folder.
    content: sections of the file by name, as tomllib reads them.
    Returns a dict from "material" and "base", those that exist, to :class:`Material`; empty without
    either.
    Raises FileError and warns as :func:`read_materials` does, but not for missing sections.
    """
    return {
        name: _parse_material(path, name, content[name]) for name in SECTIONS if name in content
    }


def material_as_toml(material: Material, section: str = "material") -> str:
    """Return the TOML section that reads back as a material, to the bit.

    material: the :class:`Material`.
    section: name of the section, "material" or "base".
    Returns the text, which ends with a line feed: a header; a line each for name, E, nu and T_ref,
    and for those of nu_instant, density, thickness, temperature (as ``reference``), shifts and
    measured that are given; the series.  A shift that is a function other than WLF and Arrhenius is
    left out.
    """
    band = material.measured
    names = ("E", "nu", "nu_instant", "T_ref", "density", "thickness")
    values = {"name": _quote(material.name), **{name: getattr(material, name) for name in names}}
    values["reference"] = material.temperature
    strain = "" if band is None or band.strain is None else f", strain = {band.strain}"
    values["measured"] = band and (
        f"{{ low = {band.low}, high = {band.high}, misfit = {band.misfit}, source = "
        f"{_quote(band.source)}{strain}"
        f"{f', M_error = {[list(pair) for pair in band.M_error]}' * bool(band.M_error)} }}"
        "  # low, high: rad/s; M_error: pairs of transit frequency, 1/s, and relative error of M"
    )
    values |= shifts_as_toml(material.shift, material.vertical_shift)
    lines = [f"{name} = {value}" for name, value in values.items() if value is not None]
    return "\n".join([f"[{section}]", *lines, series_as_toml(material.prony), ""])


def series_as_toml(series: Prony) -> str:
    """Return the key ``prony`` or ``creep``, in the form in which the series was given, that reads
    back to the bit.

    series: :class:`Prony` of one material; an elastic one has empty lists.
    Returns one line of TOML without a line feed, as "prony = { E = [2.0], tau = [1.0] }"; of creep
    with alpha too.
    """
    if series.by_creep:
        return (
            f"creep = {{ J = {series.J.tolist()}, T = {series.T.tolist()}, alpha = "
            f"{series.alpha!r} }}"
        )
    return f"prony = {{ E = {series.E.tolist()}, tau = {series.tau.tolist()} }}"


def _quote(text: str) -> str:
    """Return ``text`` as a TOML string: TOML allows no surrogates, and the character DEL only
    escaped.
    """
    return json.dumps(text, ensure_ascii=False).replace("\x7f", r"\u007f")


def _parse_section(path: Any, name: str, content: Any) -> Any:
    """Return a section as a :class:`FileSection`, if it has the key file, or as a
    :class:`MaterialSection`.

    path, name: path of the file and name of the section, for errors.
    content: keys and values of the section, as tomllib reads them.
    Raises FileError, with the line of the key, for a key that is unknown, missing or of the wrong
    type, and for a property of the material beside the key file.
    """
    if not (isinstance(content, dict) and "file" in content):
        return as_struct(path, name, content, MaterialSection)
    for key in content.keys() & MaterialSection.__annotations__.keys() - {"file"}:
        raise section_error(
            path,
            name,
            key,
            f"{key} must be left out, since the key file gives the whole material: to change "
            f"{key}, remove file, and write all keys of the material (E, nu, ...) here",
        )
    return as_struct(path, name, content, FileSection)


def _parse_material(path: Any, name: str, content: Any) -> Material:
    """Return the material of a section at its temperature.

    path, name: path of the file, relative to whose folder a path in the section is, and name of the
    section.
    content: keys and values of the section, as tomllib reads them.
    Returns the :class:`Material`: of the section itself, or of the file that it names, with the
    thickness and the density of the section where these are given; shifted if the section has a
    ``temperature``, else as at its reference.
    Raises FileError, with the line of the key, for a key or value that is wrong, a temperature
    without a shift, and a file that the section names and that is wrong.
    """
    section = _parse_section(path, name, content)
    given = {key: value for key, value in vars(section).items() if value is not None}
    temperature = given.pop("temperature", None)
    with as_section_error(path, name):
        if section.wlf and section.arrhenius:
            raise section_error(
                path, name, "arrhenius", "wlf and arrhenius are both given: give one of the two"
            )
        if shift := section.wlf or section.arrhenius:
            given["shift"] = given.pop(type(shift).__name__.lower())
        if section.file is None:
            material = _make_material(path, name, given)
        else:
            other = _read_other_file(path, name, Path(path).parent / given.pop("file"))
            material = replace(other, **given)
        if material.vertical_shift and material.shift and material.temperature is None:
            # given as at the temperature where the shift is 1
            material = replace(material, temperature=material.shift.T0)  # type: ignore[attr-defined]
        if temperature is None:
            return material
        if material.shift is None:
            raise section_error(
                path,
                name,
                "temperature",
                f"temperature = {temperature:g} needs wlf or arrhenius too, which shift the times",
            )
        return material.at(temperature)


def _read_other_file(path: Any, name: str, other: Path) -> Material:
    """Return the material of a file that a section names.

    path, name: path of the file with that section, and name of the section, for errors.
    other: netCDF file (suffix .nc) of a material or of its law, or TOML file with a section of this
        name or, without one, [material].
    Returns the :class:`Material`, at the temperature of that file.
    Raises FileError for the key ``file`` of the section if that file is missing or wrong, or names
    a file again.
    """
    try:
        if other.suffix.lower() == SUFFIX:
            return _material_of_law(other) if is_law(other) else Material.from_netcdf(other)
        content = read_toml(other)
        section = name if name in content else "material"
        if section not in content:
            raise section_error(other, "", "material", _NO_MATERIAL)
        if isinstance(content[section], dict) and "file" in content[section]:
            raise section_error(
                other,
                section,
                "file",
                "must not have the key file too: write E, nu, ... of the material in its place",
            )
        return _parse_material(other, section, content[section])
    except FileError as error:
        advice = (
            ""
            if other.suffix.lower() in (SUFFIX, ".toml")
            else "; it must be a .toml with [material], or the .nc of a material or contact law"
        )
        raise section_error(
            path, name, "file", f"the key file names a file that cannot be used ({error}){advice}"
        ) from error


def _material_of_law(path: Path) -> Material:
    """Return the :class:`Material` of the law in the file ``path``.

    The attribute ``material`` of the file states it as TOML.
    Raises FileError for a pair, for a law without units, and for a file that is damaged or no law.
    """
    try:
        content = tomllib.loads(read_law(path).attributes["material"])
    except tomllib.TOMLDecodeError as error:
        raise FileError(
            path, f"is damaged or was edited: its attribute material is not TOML; {REMEDY}"
        ) from error
    if not content.keys() & set(SECTIONS):
        raise FileError(
            path,
            "is a dimensionless contact law: it must be that of a material in SI units, which "
            "`viscoroll tables law` makes from a file with [material]",
        )
    if "base" in content:
        raise FileError(
            path,
            "is the contact law of two materials: it must be that of one material (in Python, "
            "vr.load_law reads this file, for material= of a Cylinder)",
        )
    return parse_materials(path, content)["material"]


def _make_material(path: Any, name: str, given: dict[str, Any]) -> Material:
    """Return the material of a section at its reference temperature, by its standard linear solid
    or its series.

    path, name: path of the file and name of the section, for errors.
    given: what the section states, by its keys, checked; ``shift`` in place of wlf and arrhenius.
        It is changed.
    Returns the :class:`Material`, at the temperature ``reference``: with T_epsilon and T_sigma the
    standard linear solid, else with the series and T_ref (1 s if it is not given); elastic if the
    section has neither times nor a series.
    Raises FileError for a finite E without nu, one of T_epsilon and T_sigma without the other,
    either beside T_ref or a series, both series, and a series that is wrong; ParameterError for
    another value out of range.
    """
    if "nu" not in given:
        if not math.isinf(given["E"]):
            raise section_error(path, name, "", "needs nu, Poisson's ratio")
        given["nu"] = Material.rigid().nu
    if "reference" in given:
        reference = given.pop("reference")
        given["temperature"] = check_number("reference", reference, above=ABSOLUTE_ZERO)
    forms: Any = {key: vars(given.pop(key)) for key in ("prony", "creep") if key in given}
    if series := parse_series(path, name, forms):
        given["prony"] = series
    if times := given.keys() & {"T_epsilon", "T_sigma"}:
        others = given.keys() & {"T_ref"} | forms.keys()
        if len(times) == 1 or others:
            raise section_error(
                path,
                name,
                "",
                f"has {', '.join(sorted(times | others))}: T_epsilon and T_sigma (in s; a standard "
                "linear solid) must both be given, and T_ref, prony and creep left out",
            )
        return Material.sls(**given)
    return Material(**given)


def parse_series(path: Any, name: str, given: Mapping[str, Any]) -> Any:
    """Return the series of a section by its key prony or creep.

    path, name: path of the file and name of the section, for errors.
    given: keys and values of the section; prony is a dict of E and tau, creep of J, T and perhaps
        alpha: strengths E and J divided by the long-time modulus and compliance, times tau and T
        divided by T_ref, alpha the glassy modulus divided by the long-time one.  Each but alpha is
        a list by mode, whose elements may be arrays (n,) of n materials; other keys are ignored, as
        is a key that is None.
    Returns a :class:`Prony`, of shape () or (n,), also for empty lists (elastic); None if neither
    key is given.
    Raises FileError for both keys, values out of range, and lists of different lengths; TypeError
    for another key in such a dict, ValueError for arrays of different lengths in a list.
    """
    forms = {key: given[key] for key in ("prony", "creep") if key in given}
    if len(forms) > 1:
        raise section_error(
            path, name, "creep", "prony and creep are both given: give one of the two"
        )
    for key, lists in forms.items():
        columns = {
            # numbers of one mode may be arrays (n,), of n materials: modes become the last axis
            column: np.stack(np.broadcast_arrays(*value), axis=-1)
            if isinstance(value, list) and value
            else value
            for column, value in lists.items()
        }
        with as_section_error(
            path, f"{name}.{key}"
        ):  # E is a key of the material too: name the line of the series
            return Prony(**columns) if key == "prony" else Prony.creep(**columns)
    return None
