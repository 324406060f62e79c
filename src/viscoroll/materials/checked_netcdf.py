"""NetCDF files of laws and materials, and their two checksums.

The seal is the SHA-256 of all bytes of a file, at its end; it shows damage (:mod:`..core.files`).
The checksum of a law is the SHA-256 of its numbers, an attribute of the file; it shows that the
numbers are those that were written, also after another program converted the file.

The file of a law has variables by its kind (:data:`KINDS`).  The file of a material has its Prony
series in relaxation and in creep form; it is written and read by ``to_netcdf`` and
``from_netcdf`` of :class:`viscoroll.Material`.
"""

import hashlib
import io
import pathlib
import shlex
import sys
import tomllib
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib import resources
from typing import Any, NamedTuple

import numpy as np

from .. import __version__
from ..core import (
    PAPER,
    Dataset,
    FileError,
    FilePath,
    ParameterError,
    read_sealed,
    seal_matches,
    warn_of_model,
    write_dataset,
)
from .measured_data import WLF, Arrhenius, Measured
from .prony import Prony

# --- The file of a law ---

#: integer attribute of a file that states its schema
SCHEMA = "law_schema"
#: schema of this version; it changes if a file of this version could not be read by an older one
VERSION = 1
#: attribute with the checksum of the numbers
CHECKSUM = "sha256_of_numbers"
#: what a user can do about a file that is not as it was written
REMEDY = "write the file again by vr.tables.save or `viscoroll tables law`"
#: what a user can do about such a file of a material
_REWRITE = "write the file again by Material.to_netcdf"
#: what a user can do who named another file
_GIVE = "give a file that Material.to_netcdf wrote"
#: largest file that is read, bytes; laws have less than 10 MB
_MOST_BYTES = 1 << 27
#: first bytes of netCDF-4
_HDF5 = b"\x89HDF"
#: attribute that names the kind of a file
KIND = "viscoroll_table"
#: kind: the law of one material or pair
LAW = "law"
#: kind: the law of one relaxation time for all alpha
AXIS = "axis"
#: kind: the law of a layer of finite thickness
COVER = "cover"
#: kind: the coupled solution of one scene at nodes of speed and creep
COUPLED = "coupled"


class Kind(NamedTuple):
    """Contents of the files of a kind, of file_variables.toml.

    summary : beginning of the summary of the file.
    functions : name of each function in the order of its coefficients -> meaning.
    dims : dimensions of the coefficients.
    terms : what the numbers of a function are, in words.
    others : name of each other variable -> (dimensions, attributes: long_name, and units unless it
    is dimensionless or in T_ref).
    comment : how the numbers are evaluated.
    error : attribute of a function with its largest error.
    """

    summary: str
    functions: dict[str, str]
    dims: list[str]
    terms: str
    others: dict[str, Any]
    comment: str
    error: str


_TEXTS = tomllib.loads(
    (resources.files(__package__) / "file_variables.toml").read_text(encoding="utf-8")
)
#: kind of a law file -> its contents
KINDS = {name: Kind(**about) for name, about in _TEXTS["laws"].items()}


class Content(NamedTuple):
    """Content of a file.

    numbers : arrays by the names of variables.
    attributes : values by the names of global attributes.
    """

    numbers: dict[str, Any]
    attributes: dict[str, Any]


def dataset_content(dataset: Any) -> Content:
    """Return the content of a ``dataset``; for another object, empty numbers and attributes."""
    numbers = {
        str(name): variable.values for name, variable in getattr(dataset, "variables", {}).items()
    }
    return Content(numbers, getattr(dataset, "attrs", {}))


def checksum(numbers: dict[str, Any], kind: str = LAW) -> str:
    """Return the SHA-256 over the variables of a file: of each its name in UTF-8, then its numbers
    as little-endian doubles, last dimension fastest.

    numbers: arrays by the names of the variables; names that the kind does not have are left out.
    kind: kind of the file, a key of :data:`KINDS`, which determines the names and their order: its
        functions, then its other variables.
    Returns the 64 hexadecimal digits, in lower case.
    Raises KeyError for another kind and for a variable that is missing, and ValueError for one that
    is not numeric.
    """
    digest = hashlib.sha256()
    for name in (*KINDS[kind].functions, *KINDS[kind].others):
        digest.update(name.encode() + np.ascontiguousarray(numbers[name], "<f8").tobytes())
    return digest.hexdigest()


def make_dataset(
    law: Any, kind: str, title: str, errors: Mapping[str, float], **attributes: str
) -> Dataset:
    """Return the dataset of a file: its numbers, their meaning and origin, and their checksum.

    law: the law, an object with the variables of its kind as attributes, and ``coefficients``,
        whose axes are those of the kind (:attr:`Kind.dims`) and, last, its functions in their
        order.
    kind: kind of the file, a key of :data:`KINDS`, which lists the variables.
    title: bodies whose law it is, in words.
    errors: name of a function, as "lam" -> its largest relative error, dimensionless; for each
        function of the kind, else KeyError, as for another kind.
    attributes: further global attributes of the dataset by name.
    Returns the dataset, with one variable of coefficients for each function, whose error is its
    attribute ``largest_relative_error``; the other variables of the kind, integers as int32; and as
    global attributes ``viscoroll_table`` (the kind), ``law_schema``, ``sha256_of_numbers`` (the
    :func:`checksum`), ``history`` (time of the call, UTC, and command line), title, summary,
    comment, keywords, references, source, license and Conventions.
    """
    import xarray as xr

    about = KINDS[kind]
    data = {}
    for n, (name, meaning) in enumerate(about.functions.items()):
        labels = {"long_name": f"{about.terms}: {meaning}", about.error: errors[name]}
        data[name] = about.dims, law.coefficients[..., n], labels
    for name, (dims, labels) in about.others.items():
        value = np.asarray(getattr(law, name))
        data[name] = dims, value.astype(np.int32) if value.dtype.kind == "i" else value, labels
    dataset = xr.Dataset(
        data,
        attrs={
            **_TEXTS["file"],
            "title": f"Contact law of rolling with partial slip: {title}",
            "summary": about.summary,
            KIND: kind,
            SCHEMA: np.int32(VERSION),
            **attributes,
            "comment": about.comment,
            "references": PAPER,
            "source": f"viscoroll {__version__}",
            "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ} {shlex.join(sys.orig_argv)}",
        },
    )
    return dataset.assign_attrs({CHECKSUM: checksum(dataset_content(dataset).numbers, kind)})


def stated_errors(dataset: Any) -> dict[str, float]:
    """Return the largest error of every function that a ``dataset`` states: relative, of a coupled
    table absolute; NaN where none is stated.
    """
    kind = KINDS[dataset.attrs[KIND]]
    return {name: float(dataset[name].attrs.get(kind.error, np.nan)) for name in kind.functions}


def is_law(path: FilePath) -> bool:
    """Return whether a file is the law of a material, a pair or a cover, by its attribute
    ``viscoroll_table``.

    Neither the schema nor the checksum of the numbers is examined; :func:`read_law` does that.
    path: path of the file.
    Returns True where the attribute is "law" (a material or pair) or "cover"; False where it is
    "axis" (the law of every alpha), and for another HDF5 file.
    Raises FileError as :func:`read_content`.
    """
    content = read_content(
        path,
        "file of a material (of Material.to_netcdf) or of a contact law (of vr.tables.save)",
        f"{_REWRITE}, or a law by vr.tables.save",
    )
    return str(content.attributes.get(KIND)) in (LAW, COVER, COUPLED)


def read_law(path: FilePath) -> Content:
    """Return the content of a law file, verified by its seal, schema and checksum.

    path: path of the file; a file without a seal is verified by its schema and checksum alone.
    Returns :class:`Content`: ``numbers``, with all variables of the kind, a key of :data:`KINDS`,
    and ``attributes``.
    Raises FileError for a file that cannot be read, is larger than 128 MiB, is damaged, is no
    netCDF, is no law, is of another schema, lacks a variable, or has one that is not numeric.
    """
    content = read_content(
        path,
        "contact law (of `viscoroll tables law`) or a grid (of `viscoroll tables build`, or of "
        "another program)",
        REMEDY,
    )
    check_law(content, path)
    return content


def read_content(path: FilePath, expected: str, remedy: str) -> Content:
    """Read a netCDF file by h5py alone, which takes a tenth of the time of xarray.

    path: path of the file.
    expected: kind of file in words, for errors.
    remedy: what to do about a damaged file, for errors.
    Returns the :class:`Content`: arrays of all variables of the root group, of a scalar a numpy
    number; and global attributes as :func:`_to_scalar` returns them.
    Raises FileError for a file that cannot be read, is larger than 128 MiB, is no HDF5, whose seal
    does not match it, or that h5py does not read.  A file without a seal is read as it is.
    """
    import h5py

    content = read_sealed(path, _MOST_BYTES, expected, remedy)
    if not content.startswith(_HDF5):
        raise FileError(path, f"is not a netCDF-4 (HDF5) file: it must be a {expected}")
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            numbers = {
                name: variable[()]
                for name, variable in file.items()
                if isinstance(variable, h5py.Dataset)
            }
            return Content(numbers, {key: _to_scalar(value) for key, value in file.attrs.items()})
    except Exception as error:  # libraries raise many kinds
        raise FileError(path, f"is damaged, cut or incomplete; {remedy}") from error


def _to_scalar(value: Any) -> Any:
    """Return the value of an attribute as text or number: some programs write arrays of one, and
    texts as bytes.

    value: what h5py reads.
    Returns a text for bytes, in UTF-8 with replacements of wrong bytes; of an array of one its
    element, as Python has it; an array of no or more elements, and any other value, as it is.
    """
    if np.size(value) == 1:
        value = np.asarray(value).item()
    return value.decode(errors="replace") if isinstance(value, bytes) else value


def check_law(content: Content, path: Any) -> None:
    """Raise FileError for a file that is no law of this schema, or whose numbers do not match its
    checksum.

    It checks in turn: that the attribute ``viscoroll_table`` is a key of :data:`KINDS`; that
    ``law_schema`` is an integer equal to :data:`VERSION`; that the attributes title, source and,
    except for a table over alpha, material are texts; that all variables of the kind are present
    and numeric, and that their :func:`checksum` is the attribute ``sha256_of_numbers``.
    content: :class:`Content` of the file.
    path: path of the file, for errors.
    Returns None for a file that is as it was written.
    """
    numbers, attributes = content
    kind = str(attributes.get(KIND))  # another writer may have stored an array
    if kind not in KINDS:
        raise FileError(
            path,
            "is neither a contact law (of `viscoroll tables law`) nor a grid of one (of `viscoroll "
            "tables build`, or of another program with the variables V, delta, Q and M); it has "
            f"the variables {', '.join(numbers) or '(none)':.80}",
        )
    schema = attributes.get(SCHEMA)
    if not isinstance(schema, int | np.integer) or schema != VERSION:
        problem = (
            f"has the attribute {SCHEMA} = {schema!s:.20} (version of the file format), but "
            f"viscoroll {__version__} reads only {VERSION}"
        )
        raise FileError(path, f"{problem}; {REMEDY}, or use the version of viscoroll that wrote it")
    for name in ("title", "source", "material")[: 2 if kind == AXIS else 3]:
        if not isinstance(attributes.get(name), str):
            raise FileError(
                path,
                f"is incomplete: its attribute {name!r} is missing or is not a text; {REMEDY}",
            )
    try:
        found = checksum(numbers, kind)
    except KeyError as error:
        raise FileError(
            path, f"is incomplete: its variable {error} is missing; {REMEDY}"
        ) from error
    except ValueError:  # a variable that is not numeric
        found = ""
    if found != attributes.get(CHECKSUM):
        raise FileError(
            path,
            "is damaged or was edited: its numbers do not match the checksum in its attribute "
            f"{CHECKSUM}; {REMEDY}",
        )


# --- A material as netCDF that contains its series ---

#: suffix of netCDF files
SUFFIX = ".nc"
#: attribute ``schema`` of a file; its number changes if an older version could not read the file
_SCHEMA = "viscoroll material 1"
#: variables of each form of the series
_FORMS = {"relaxation": ("E", "tau"), "creep": ("J", "T")}
#: variable -> its attributes long_name and units
_MEANING = _TEXTS["material"]
#: variables that a file may lack
_OPTIONAL = ("density", "thickness", "temperature", "nu_instant")
#: fields of the measured band, which a file may lack
_BAND = ("low", "high", "misfit", "strain")
#: transit frequencies and accuracies of M, which a file may lack
_ERRORS = ("measured_rate", "measured_M_error")


def material_as_dataset(material: Any) -> Dataset:
    """Return the Prony series in relaxation and creep form and the constants of a material as a
    dataset.

    material: a :class:`viscoroll.Material`.
    Returns a dataset with E, tau (relaxation) and J, T (creep) over "mode", slowest first, of
    length 0 if elastic: strengths over the long-time modulus or compliance, times in units of
    T_ref; and the constants in SI units: E_long, nu, T_ref, alpha, and those of density, thickness,
    temperature (degrees Celsius) and the measured band (measured_low, measured_high,
    measured_misfit, measured_strain, and over "rate" measured_rate, 1/s, and measured_M_error) that
    are given.  Each variable has the attributes ``long_name`` and ``units``.  The attribute
    ``shifts`` has the time-temperature shifts as lines of TOML; the attribute ``given`` of the
    dataset names the form from which the material is read, "relaxation" or "creep"; ``name`` and
    ``measured`` are the name and the source of the data, "" without; the others are
    ``Conventions``, ``schema``, ``title``, ``law`` (the formulas of E(t) and J(t)) and ``source``
    (this version).
    """
    import xarray as xr

    series = material.prony
    band = material.measured
    shifts = shifts_as_toml(material.shift, material.vertical_shift)
    held = vars(material) | {"E_long": material.E, "alpha": series.alpha}
    held |= {f"measured_{name}": getattr(band, name, None) for name in _BAND}
    if band is not None and band.M_error:
        held |= dict(zip(_ERRORS, np.transpose(band.M_error)))
    held |= {name: getattr(series, name) for names in _FORMS.values() for name in names}
    data = {
        name: (
            ("rate" if name in _ERRORS else "mode",) * np.ndim(held[name]),  # () of a number
            held[name],
            labels,
        )
        for name, labels in _MEANING.items()
        if held.get(name) is not None
    }
    return xr.Dataset(
        data,
        attrs={
            **_TEXTS["material_file"],
            "schema": _SCHEMA,
            "title": material.name or "linear viscoelastic material",
            "name": material.name,
            "given": "creep" if series.by_creep else "relaxation",
            "source": f"viscoroll {__version__}",
            "measured": getattr(band, "source", ""),
            "shifts": "\n".join(f"{key} = {value}" for key, value in shifts.items()),
        },
    )


def write_material(material: Any, path: FilePath) -> None:
    """Write a material as netCDF-4 with a SHA-256 checksum.

    material: a :class:`viscoroll.Material`.
    path: file to write; a file of that name is replaced once the new one is complete.
    Raises FileError if it cannot be written there.  Warns with ModelWarning of shifts that the file
    does not hold (:func:`shifts_as_toml`).
    """
    data = material_as_dataset(material)
    lost = [
        name
        for name, sign in (("shift", "T0"), ("vertical_shift", "entropic"))
        if getattr(material, name) is not None and sign not in data.attrs["shifts"]
    ]
    if lost:
        warn_of_model(
            f"{path} lacks {' and '.join(lost)} of the material: files hold only vr.WLF and "
            "vr.Arrhenius as shift, 'entropic' as vertical_shift, and no shift beside another "
            "vertical_shift.  After reading, add what is missing by dataclasses.replace(material, "
            "...).  The shift of a fit (vr.ShiftFactors) can be replaced before writing by the law "
            "that its .wlf() or .arrhenius() fits"
        )
    write_dataset(data, path, sealed=True)


def shifts_as_toml(shift: Any, vertical_shift: Any) -> dict[str, str]:
    """Return the shifts of a material that files hold as key -> value in TOML: wlf or arrhenius,
    vertical_shift.

    shift, vertical_shift: as in :class:`.material.Material`.  Left out are a shift other than WLF
        and Arrhenius, and a function as vertical shift; with it any shift, which would give wrong
        moduli without the vertical one.
    """
    found = {} if vertical_shift != "entropic" else {"vertical_shift": '"entropic"'}
    if isinstance(shift, WLF | Arrhenius) and not callable(vertical_shift):
        numbers = ", ".join(f"{name} = {value!r}" for name, value in vars(shift).items())
        found[type(shift).__name__.lower()] = f"{{ {numbers} }}"
    return found


def load_material(path: FilePath, make: Any) -> Any:
    """Read a file of :meth:`viscoroll.Material.to_netcdf`.

    path: path of the file.
    make: constructor of the material, called with the parameters of :class:`viscoroll.Material` by
        name: E, prony, name, nu and T_ref, and those of density, thickness, temperature and
        measured that the file has.
    Returns what ``make`` returns, which may warn of a temperature that looks like kelvin.
    Raises FileError for a file that is missing, damaged, larger than 128 MiB, without a seal, no
    material, lacks a variable or an attribute, or has values out of range; so it does for each
    ParameterError, TypeError and ValueError of ``make``, whose other exceptions pass.
    """
    numbers, about = read_content(path, "material that Material.to_netcdf wrote", _REWRITE)
    if str(about.get(KIND)) in KINDS:
        raise FileError(
            path, f"is a contact law, not a material: read it by vr.load_law, or {_GIVE}"
        )
    if "schema" not in about:
        names = ", ".join(numbers) or "(none)"
        raise FileError(path, f"is not a material; it has the variables {names:.80}: {_GIVE}")
    if about["schema"] != _SCHEMA:
        raise FileError(
            path,
            f"has the attribute schema = {about['schema']!r:.40}, but a material of viscoroll "
            f"{__version__} has {_SCHEMA!r}: {_GIVE} in this version",
        )
    if seal_matches(pathlib.Path(path).read_bytes()) is None:
        raise FileError(
            path,
            f"is cut, or another program changed it (it has no checksum at its end); {_REWRITE}",
        )
    given: Any = about.get("given")
    if given not in _FORMS:
        raise FileError(
            path,
            f"has the attribute given = {given!r:.40}: must be {' or '.join(_FORMS)}; {_REWRITE}",
        )
    try:
        form = tuple(numbers[name] for name in _FORMS[given])
        series = (
            Prony(*form) if given == "relaxation" else Prony.creep(*form, alpha=numbers["alpha"])
        )
        found: dict[str, Any] = {
            name: numbers[name]
            for name in ("nu", "T_ref", *filter(numbers.__contains__, _OPTIONAL))
        }
        if "measured_low" in numbers:
            band: dict[str, Any] = {name: numbers.get(f"measured_{name}") for name in _BAND}
            pairs = zip(
                *(numbers[name].tolist() for name in _ERRORS if name in numbers), strict=True
            )
            found["measured"] = Measured(**band, source=about["measured"], M_error=tuple(pairs))
        found |= tomllib.loads(about.get("shifts", ""))
        for name, kind in (("wlf", WLF), ("arrhenius", Arrhenius)):
            if name in found:
                found["shift"] = kind(**found.pop(name))
        return make(E=numbers["E_long"], prony=series, name=about["name"], **found)
    except ParameterError as error:
        raise FileError(path, f"has a wrong value ({error}); {_REWRITE}") from error
    except KeyError as error:
        raise FileError(
            path, f"is incomplete: the variable or attribute {error} is missing; {_REWRITE}"
        ) from error
    except (TypeError, ValueError) as error:
        raise FileError(path, f"has variables or attributes of a wrong type; {_REWRITE}") from error
