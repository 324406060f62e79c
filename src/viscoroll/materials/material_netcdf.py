"""A material as netCDF that contains its series: ``to_netcdf`` and ``from_netcdf`` of :class:`viscoroll.Material`."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from .. import __version__
from ..core.errors import FileError, ParameterError
from ..core.files import seal_matches
from .law_file import KIND, KINDS, read_content
from .measured import Measured
from .prony import Prony
from .shift import shifts_as_toml, shifts_of_toml

if TYPE_CHECKING:
    import xarray as xr

_Made = TypeVar("_Made")
#: suffix of netCDF files
SUFFIX = ".nc"
#: attribute ``schema`` of a file; its number changes if an older version could not read the file
_SCHEMA = "viscoroll material 1"
#: variables of each form of the series
_FORMS = {"relaxation": ("E", "tau"), "creep": ("J", "T")}
#: meaning and unit of each variable
_MEANING = {
    "E": ("strengths of relaxation divided by E_long", "1"),
    "tau": ("relaxation times over T_ref", "1"),
    "J": ("strengths of creep divided by the long-time compliance", "1"),
    "T": ("retardation times over T_ref", "1"),
    "E_long": ("long-time Young's modulus; infinite for a rigid body", "Pa"),
    "nu": ("Poisson's ratio, of long times", "1"),
    "nu_instant": ("Poisson's ratio at t = 0, where it differs from nu", "1"),
    "T_ref": ("unit of the times tau and T", "s"),
    "alpha": ("instantaneous modulus divided by long-time modulus", "1"),
    "density": ("density", "kg m-3"),
    "thickness": ("thickness of the layer", "m"),
    "temperature": ("temperature of moduli and times", "degC"),
    "measured_low": ("first angular frequency of the data", "rad s-1"),
    "measured_high": ("last angular frequency of the data", "rad s-1"),
    "measured_rate": ("transit frequencies at which the accuracy of M is known", "s-1"),
    "measured_M_error": ("accuracy of M by the data as +-, relative", "1"),
    "measured_misfit": ("root mean square of the relative errors of the fit", "1"),
    "measured_strain": ("amplitude of engineering strain of the test", "1"),
}
#: variables that a file may lack
_OPTIONAL = ("density", "thickness", "temperature", "nu_instant")
#: fields of the measured band, which a file may lack
_BAND = ("low", "high", "misfit", "strain")
#: transit frequencies and accuracies of M, which a file may lack
_ERRORS = ("measured_rate", "measured_M_error")


def material_as_dataset(material: Any) -> xr.Dataset:
    """Return both forms of the series, relaxation and creep, and the constants of a material as a dataset.

    material: a :class:`viscoroll.Material`.
    Returns a dataset with E, tau (relaxation) and J, T (creep) over "mode", slowest first, of length 0 if elastic:
    strengths over the long-time modulus or compliance, times in units of T_ref; and the constants in SI units: E_long,
    nu, T_ref, alpha, and those of density, thickness, temperature (degrees Celsius) and the measured band
    (measured_low, measured_high, measured_misfit, measured_strain, and over "rate" measured_rate, 1/s, and
    measured_M_error) that are given.  Each variable has the attributes ``long_name`` and ``units``.  The attribute
    ``shifts`` has the time-temperature shifts as lines of TOML; the attribute ``given`` of the dataset names the form
    from which the material is read, "relaxation" or "creep"; ``name`` and ``measured`` are the name and the source of
    the data, "" without; the others are ``Conventions``, ``schema``, ``title``, ``law`` (the formulas of E(t) and J(t))
    and ``source`` (this version).
    """
    import xarray as xr

    series, band = material.prony, material.measured
    shifts = shifts_as_toml(material.shift, material.vertical_shift)
    held = {"E_long": material.E, "nu": material.nu, "T_ref": material.T_ref, "alpha": series.alpha}
    held |= {name: getattr(material, name) for name in _OPTIONAL}
    held |= {f"measured_{name}": getattr(band, name, None) for name in _BAND}
    if band is not None and band.M_error:
        held |= dict(zip(_ERRORS, np.transpose(band.M_error), strict=True))
    held |= {name: getattr(series, name) for names in _FORMS.values() for name in names}
    data = {
        name: (
            ("rate" if name in _ERRORS else "mode",) * np.ndim(value), value,
            dict(zip(("long_name", "units"), _MEANING[name], strict=True)),
        )
        for name, value in held.items() if value is not None
    }  # fmt: skip
    return xr.Dataset(
        data,
        attrs={
            "Conventions": "CF-1.11", "schema": _SCHEMA, "title": material.name or "linear viscoelastic material",
            "name": material.name, "given": "creep" if series.by_creep else "relaxation",
            "law": "E(t) = E_long (1 + sum E exp(-t/(tau T_ref))), J(t) = (1 - sum J exp(-t/(T T_ref)))/E_long",
            "source": f"viscoroll {__version__}", "measured": getattr(band, "source", ""),
            "shifts": "\n".join(f"{key} = {value}" for key, value in shifts.items()),
        },
    )  # fmt: skip


def load_material(path: str | PathLike[str], make: Callable[..., _Made]) -> _Made:
    """Read a file of :meth:`viscoroll.Material.to_netcdf`.

    path: path of the file.
    make: constructor of the material, called with the parameters of :class:`viscoroll.Material` by name: E, prony,
        name, nu and T_ref, and those of density, thickness, temperature and measured that the file has.
    Returns what ``make`` returns, which may warn of a temperature that looks like kelvin.
    Raises FileError for a file that is missing, damaged, larger than 128 MiB, without a seal, no material, lacks a
    variable, or has values out of range; so it does for each ParameterError, KeyError, ValueError and OSError of
    ``make``, whose other exceptions pass.
    """
    try:
        numbers, about = read_content(path, "material of this package", "write it again")
        if str(about.get(KIND)) in KINDS:
            raise FileError(path, "is not a material file: it is a law, for vr.load_law")
        if {"V", "Q"} <= numbers.keys():
            raise FileError(path, "is not a material file: it is a grid, for vr.load_law and vr.tables.interpolate")
        if about.get("schema") != _SCHEMA:
            raise FileError(path, f"is not a material file: its schema is {about.get('schema')!r}, not {_SCHEMA!r}")
        if seal_matches(Path(path).read_bytes()) is None:
            raise FileError(
                path, "is damaged or is not a material file of this package: the SHA-256 at its end is missing"
            )
        form = tuple(numbers[name] for name in _FORMS[about["given"]])
        series = Prony(*form) if about["given"] == "relaxation" else Prony.creep(*form, alpha=numbers["alpha"])
        found: dict[str, Any] = {name: numbers[name] for name in ("nu", "T_ref", *_OPTIONAL) if name in numbers}
        if "measured_low" in numbers:
            band: dict[str, Any] = {name: numbers.get(f"measured_{name}") for name in _BAND}
            pairs = zip(*(numbers[name].tolist() for name in _ERRORS if name in numbers), strict=True)
            found["measured"] = Measured(**band, source=about["measured"], M_error=tuple(pairs))
        found |= shifts_of_toml(about.get("shifts", ""))
        return make(E=numbers["E_long"], prony=series, name=about["name"], **found)
    except (ParameterError, KeyError, ValueError, OSError) as error:
        raise FileError(path, f"is not a material file ({' '.join(str(error).split()):.200})") from error
