"""Sources, description and compiled library of an FMU, packed into one archive: :func:`build`."""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import zipfile
from importlib.resources import files
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...core.checks import check_choice, check_integer
from ...core.errors import FileError, MissingDependencyError, shape_error
from ...core.extras import import_extra
from ...core.files import replace_file
from ...cylinder import Cylinder
from ...io import tables
from ...materials.law.netcdf import parse_law
from ...materials.law.table import LawTable
from ...materials.law_file import dataset_content
from .description import build_description, model_description
from .variables import MODELS, Variable

#: Options of the C compiler.  -ffp-contract=off keeps the bits independent of the machine's fused multiply-add.
_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC")


def build(given: Any, path: str | PathLike[str], model: str = "Roller", version: int = 2) -> None:
    """Write an FMU of a cylinder, with its sources and a library for this machine, whole or not at all.

    Parameters
    ----------
    given : a :class:`viscoroll.Cylinder`, whose numbers become the start values; or a material, pair, cover, law of
        :func:`viscoroll.load_law` or alpha (a number >= 1), for which radius, load, mass and friction are set in the
        tool.
    path : file to write, with the suffix .fmu by custom; a file of that name is replaced.
    model : "Roller", from drive force and torque to v, omega and x: co-simulation with its own step-size control, and
        model exchange; or "ContactElement", from v, omega and load to force, torque and moments: model exchange.
    version : version of the FMI standard, the int 2 or 3.

    Raises
    ------
    ParameterError
        Another model or version, a material without a law, arrays in the cylinder.
    MissingDependencyError
        No fmpy, which brings the headers of the standard, or no C compiler ``cc``.
    FileError
        If the file cannot be written, the compiler fails, or a law that is given is incomplete or that of every alpha.

    Examples
    --------
    >>> import viscoroll as vr
    >>> from viscoroll import fmu
    >>> fmu.build(vr.presets.RUBBER_CYLINDER, "roller.fmu")  # doctest: +SKIP

    Notes
    -----
    Both models give exact slopes as directional derivatives, and in FMI 3 as adjoint derivatives.  As co-simulation a
    roller that starts with slip follows :func:`viscoroll.roll` to 1e-9 of its speed (``tests/fmu/test_fmu.py``).  The
    law of a cover holds at one contact length at rest: the FMU refuses values of R, load, width and E_prime that
    make another one; the slopes of a ContactElement over the load are those at that length.
    """
    check_choice("model", model, *MODELS)
    version = check_integer("version", version, 2, 3)
    law = tables.law(given)
    table = parse_law(dataset_content(law), path)
    l0 = _contact_length_of_cover(table)
    starts = _start_values(MODELS[model].variables, given, table, l0)
    fmpy = import_extra("fmpy", "fmu")
    compiler = shutil.which("cc")
    if compiler is None:
        raise MissingDependencyError("cc, a compiler of C,", None)
    with TemporaryDirectory() as name:
        folder = Path(name)
        tables.export(law, folder / "law.h")
        constants = _model_header(MODELS[model].variables, starts) + (
            f"#define FMI_VERSION {version}\n#define ROLLER {int(bool(MODELS[model].states))}\n#define L0 {l0!r}\n"
        )
        token = _write_sources(folder, Path(fmpy.__file__).parent / "c-code", model, version, constants)
        library = folder / f"{model}{fmpy.sharedLibraryExtension}"
        _compile(compiler, folder / "fmu.c", library)
        content = {
            "modelDescription.xml": model_description(version, model, starts, token, law.attrs["title"]).encode()
        }
        if version == 3:
            content["sources/buildDescription.xml"] = build_description(model).encode()
        sources = sorted(source for source in folder.iterdir() if source.suffix in (".c", ".h"))
        content |= {f"sources/{source.name}": source.read_bytes() for source in sources}
        machine = fmpy.platform if version == 2 else fmpy.platform_tuple
        content[f"binaries/{machine}/{library.name}"] = library.read_bytes()
    with replace_file(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)


def _contact_length_of_cover(table: LawTable) -> float:
    """Return the contact length at rest for which the law of a cover holds, so that the FMU can refuse any other.

    It need not be checked for half-spaces, nor for a dimensionless cover, whose thickness in m is free.  The length is
    the thickness of the cover in m, divided by that in units of the contact length at rest.

    table: :class:`LawTable`, a law, with ``cover`` and ``pair`` (in SI units), each None where it has none, and
        ``material``, which of a cover has the ``thickness`` in units of the contact length at rest.
    Returns the length in m; 0.0 if the FMU need not check it.
    """
    if table.cover is None or table.pair is None:
        return 0.0
    cover: Any = table.material
    return float(table.pair.cover(1.0).thickness / cover.thickness)


def _start_values(variables: tuple[Variable, ...], given: Any, table: LawTable, l0: float) -> dict[str, float]:
    """Return the start value of each variable that can be set, for the description and the library of the FMU.

    A value comes from the Cylinder if there is one, else from the law (T_ref, E_prime), else from variables.csv.

    variables: variables of the model.
    given: argument ``given`` of :func:`build`; the numbers of a Cylinder become start values, for 1 m of its width.
    table: :class:`LawTable`, law of ``given``, which has T_ref (s) and, of SI materials, a ``pair`` with E_prime (Pa).
    l0: contact length at rest of a cover in m, or 0.0; without a Cylinder the load at the start is the one that makes
        it, at the default radius.
    Returns name -> value in the unit of the variable, of all variables whose ``start`` is not None, in their order.
    Raises ParameterError for a Cylinder with arrays, whose message has the first such name.
    """
    starts = {variable.name: variable.start for variable in variables if variable.start is not None}
    values: dict[str, Any] = {"T_ref": table.T_ref}
    if table.pair is not None:
        values["E_prime"] = table.pair.E_prime
        if l0:
            values["load"] = l0**2 * table.pair.E_prime / (32.0 * starts["R"])
    if isinstance(given, Cylinder):
        values |= {name: getattr(given, name) for name in ("R", "E_prime", "mu", "load")}
        values |= {"mass": given.m, "inertia": given.j}
    for name, value in values.items():
        if np.ndim(value):
            raise shape_error(name, np.shape(value), "one number: an FMU contains one cylinder")
    return {name: float(values.get(name, start)) for name, start in starts.items()}


def _write_sources(folder: Path, headers: Path, model: str, version: int, constants: str) -> str:
    """Write all that ``cc fmu.c`` needs beside law.h, and return the token.

    folder: where law.h is, and fmu.c, vr_roll.h, the headers of the standard, stubs.h and model.h are written.
    headers: folder with the headers of the standard, of both versions, as fmpy brings them.
    model: "Roller" or "ContactElement".
    version: version of the FMI standard, the int 2 or 3.
    constants: C text of model.h, to which the token is added.
    Returns the GUID or instantiation token that the description and the library share: a digest of all sources, as
    "{8-4-4-4-12}" hexadecimal digits.
    """
    package = files("viscoroll")
    source = (package / "app/fmu/fmu.c").read_text(encoding="utf-8")
    texts = {"fmu.c": source, "vr_roll.h": (package / "io/tables/c/vr_roll.h").read_text(encoding="utf-8")}
    texts |= {path.name: path.read_text(encoding="utf-8") for path in headers.glob(f"fmi{version}*.h")}
    texts["stubs.h"] = _stubs(source, texts[f"fmi{version}FunctionTypes.h"], version)
    texts["model.h"] = constants
    law = (folder / "law.h").read_text(encoding="utf-8")
    token = hashlib.sha256("".join((model, law, *(texts[name] for name in sorted(texts)))).encode()).hexdigest()
    token = f"{{{token[:8]}-{token[8:12]}-{token[12:16]}-{token[16:20]}-{token[20:32]}}}"
    texts["model.h"] += f'#define TOKEN "{token}"\n'
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return token


def _model_header(variables: tuple[Variable, ...], starts: dict[str, float]) -> str:
    """Return the C text of the variables: their references, names, kinds and start values; reference 0 is time.

    A kind is 0 (the variable cannot be set) of time and where ``start`` is None; else 1 of an input, 2 of a parameter
    above 0, which is tunable, and 3 of another parameter, which is fixed.

    variables: :class:`.variables.Variable` of the model, in the order of their references, which start with 1; only
        name, start and positive are read.
    starts: name -> start value in the unit of the variable; 0.0 stands for those that it does not have.
    Returns an enum of n_NAME, the references, and COUNT, their number with time; and the arrays NAMES, KINDS and START,
    of COUNT elements each, in the order of the references, the first for time.
    """
    rows = [("time", 0, 0.0)]
    rows += [
        (v.name, 0 if v.start is None else 1 if v.causality == "input" else 3 - v.positive, starts.get(v.name, 0.0))
        for v in variables
    ]
    names, kinds, values = zip(*rows, strict=True)
    quoted = ", ".join(f'"{name}"' for name in names)
    return (
        f"enum {{ {', '.join(f'n_{name}' for name in names)}, COUNT }};\n"
        f"static const char *const NAMES[COUNT] = {{{quoted}}};\n"
        f"static const char KINDS[COUNT] = {{{', '.join(map(str, kinds))}}};\n"
        f"static const double START[COUNT] = {{{', '.join(map(repr, values))}}};\n"
    )


def _stubs(source: str, header: str, version: int) -> str:
    """Return C definitions of the functions of the standard that fmu.c leaves out, which an FMU must have all the same.

    A function that gets or sets values returns OK for none and an error for some; every
    other one returns an error, or NULL where it returns no status; void functions do nothing.

    source: text of fmu.c.
    header: text of the standard's header of function types.
    version: version of the FMI standard, the int 2 or 3.
    Returns the C text, a line a function.
    """
    lines = []
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for kind, name, arguments in re.findall(rf"typedef\s+([\w\s*]+?)\s*\b(fmi{version}\w+)TYPE\s*\(([^)]*)\)", plain):
        if re.search(rf"^[\w *]+\b{name}\(", source, flags=re.MULTILINE):
            continue
        parameters = " ".join(arguments.replace("Byte[]", "Byte bytes[]").split())
        ok, error, count = f"fmi{version}OK", f"fmi{version}Error", re.search(r"size_t (n\w+)", parameters)
        status = f"{count[1]} ? {error} : {ok}" if count else error
        body = "" if kind == "void" else f" return {status if kind.endswith('Status') else 'NULL'}; "
        lines.append(f"{kind} {name}({parameters}) {{{body}}}\n")
    return "".join(lines)


def _compile(compiler: str, source: Path, library: Path) -> None:
    """Compile fmu.c to a shared library.

    compiler: path of cc.
    source: path of fmu.c, beside the headers.
    library: file to write.
    Returns nothing; the library is written, linked with the mathematical library.
    Raises FileError, with the first 200 characters of the compiler's message, if the compiler ends with another code
    than 0.
    """
    result = subprocess.run(
        [compiler, *_FLAGS, str(source), "-lm", "-o", str(library)], capture_output=True, text=True, check=False
    )
    if result.returncode:
        raise FileError(library.name, f"cannot be compiled by {compiler} ({' '.join(result.stderr.split()):.200})")
