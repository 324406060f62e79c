"""Sources, description and library of an FMU, and the file of them all."""

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

from ...core.errors import FileError, MissingDependencyError, ParameterError
from ...core.extras import import_extra
from ...core.files import replace_file
from ...cylinder import Cylinder
from ...io import tables
from ...materials.cover import Cover
from ...materials.law_file import table_of
from .description import described, sources_described
from .variables import MODELS, Variable

#: Versions of FMI.
VERSIONS = (2, 3)
_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC")
#: functions of the standard that have nothing to do here, and succeed
_NOTHING_TO_DO = re.compile(r"(Enter|Exit)\w*Mode|Terminate|SetDebugLogging|EvaluateDiscreteStates")


def build(given: Any, path: str | PathLike[str], model: str = "Roller", version: int = 2) -> None:
    """Write an FMU of a cylinder, with its sources and a library for this machine, whole or not at all.

    Parameters
    ----------
    given : a :class:`viscoroll.Cylinder`, whose numbers become those at the start; or a material, pair, law of
        :func:`viscoroll.load_law` or alpha, of which radius, load and the like are set in the tool.
    path : file to write; a file of that name is replaced.
    model : "Roller", from drive force and torque to v, omega and x: co-simulation that takes its own steps, and model
        exchange; or "ContactElement", from v, omega and load to force, torque and moments: model exchange.
    version : 2 or 3, of FMI.

    Raises
    ------
    ParameterError
        Another model or version, a material without a law, arrays in the cylinder.
    MissingDependencyError
        No fmpy, which brings the headers of the standard, or no C compiler ``cc``.
    FileError
        If it cannot be written there.

    Notes
    -----
    Both models have exact slopes as directional derivatives, and in FMI 3 as adjoint ones.  A thrown roller as
    co-simulation follows :func:`viscoroll.roll` to 1e-9 of its speed (``tests/fmu/test_fmu.py``).
    """
    if model not in MODELS:
        raise ParameterError("model", repr(model), f"one of {', '.join(MODELS)}")
    if version not in VERSIONS:
        raise ParameterError("version", version, "2 or 3, of FMI")
    if (isinstance(given, Cylinder) and given.pair.covered) or getattr(given, "cover", None) or type(given) is Cover:
        raise ParameterError("thickness", "of a body", "left out: FMUs do not hold the law of a layer")
    table = table_of(given.pair if isinstance(given, Cylinder) else given)
    known = {"T_ref": table.T_ref} | ({} if table.pair is None else {"E_prime": table.pair.E_prime})
    if isinstance(given, Cylinder):
        known |= _of_cylinder(given)
    fmpy = import_extra("fmpy", "fmpy", "fmu")
    compiler = shutil.which("cc")
    if compiler is None:
        raise MissingDependencyError("cc, a compiler of C,", None)
    variables = MODELS[model].variables
    starts = {v.name: float(known.get(v.name, v.start)) for v in variables if v.start is not None}
    law = tables.law(table)
    with TemporaryDirectory() as name:
        folder = Path(name)
        tables.export(law, folder / "law.h")
        token = _write_sources(folder, Path(fmpy.__file__).parent / "c-code", model, version, starts)
        library = folder / f"{model}{fmpy.sharedLibraryExtension}"
        _compile(compiler, folder / "fmu.c", library)
        content = {"modelDescription.xml": described(version, model, starts, token, law.attrs["title"]).encode()}
        if version == 3:
            content["sources/buildDescription.xml"] = sources_described(model).encode()
        sources = sorted(each for each in folder.iterdir() if each.suffix in (".c", ".h"))
        content |= {f"sources/{each.name}": each.read_bytes() for each in sources}
        machine = fmpy.platform if version == 2 else fmpy.platform_tuple
        content[f"binaries/{machine}/{library.name}"] = library.read_bytes()
    with replace_file(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)


def _of_cylinder(cylinder: Cylinder) -> dict[str, float]:
    """Its numbers under the names of the models' variables, of one metre of it."""
    found = {
        "R": cylinder.R, "E_prime": cylinder.E_prime, "mu": cylinder.mu, "load": cylinder.load, "mass": cylinder.m,
        "inertia": cylinder.j,
    }  # fmt: skip
    for name, value in found.items():
        if np.ndim(value):
            raise ParameterError(name, f"an array of shape {np.shape(value)}", "one number: an FMU is of one cylinder")
    return found


def _write_sources(folder: Path, headers: Path, model: str, version: int, starts: dict[str, float]) -> str:
    """All that ``cc fmu.c`` needs beside law.h; gives the token by which description and library know one another."""
    ours = files("viscoroll")
    source = (ours / "app/fmu/fmu.c").read_text(encoding="utf-8")
    texts = {"fmu.c": source, "vr_roll.h": (ours / "io/tables/c/vr_roll.h").read_text(encoding="utf-8")}
    texts |= {path.name: path.read_text(encoding="utf-8") for path in headers.glob(f"fmi{version}*.h")}
    texts["stubs.h"] = _stubs(source, texts[f"fmi{version}FunctionTypes.h"], version)
    texts["model.h"] = _model_header(MODELS[model].variables, starts) + (
        f"#define FMI_VERSION {version}\n#define ROLLER {int(bool(MODELS[model].states))}\n"
    )
    law = (folder / "law.h").read_text(encoding="utf-8")
    token = hashlib.sha256("".join((model, law, *(texts[name] for name in sorted(texts)))).encode()).hexdigest()
    token = f"{{{token[:8]}-{token[8:12]}-{token[12:16]}-{token[16:20]}-{token[20:32]}}}"
    texts["model.h"] += f'#define TOKEN "{token}"\n'
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return token


def _model_header(variables: tuple[Variable, ...], starts: dict[str, float]) -> str:
    """Names, kinds (0: not to be set, 1: any number, 2: above 0) and starts of the variables, of which 0 is time."""
    rows = [("time", 0, 0.0)]
    rows += [(v.name, 0 if v.start is None else 1 + v.above_0, starts.get(v.name, 0.0)) for v in variables]
    names, kinds, values = zip(*rows, strict=True)
    quoted = ", ".join(f'"{name}"' for name in names)
    return (
        f"enum {{ {', '.join(f'n_{name}' for name in names)}, COUNT }};\n"
        f"static const char *const NAMES[COUNT] = {{{quoted}}};\n"
        f"static const char KINDS[COUNT] = {{{', '.join(map(str, kinds))}}};\n"
        f"static const double START[COUNT] = {{{', '.join(map(repr, values))}}};\n"
    )


def _stubs(source: str, header: str, version: int) -> str:
    """The functions of the standard that ``source`` does not define: changes of mode, and refusals."""
    lines = []
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for kind, name, arguments in re.findall(rf"typedef\s+([\w\s*]+?)\s*\b(fmi{version}\w+)TYPE\s*\(([^)]*)\)", plain):
        if re.search(rf"^[\w *]+\b{name}\(", source, flags=re.MULTILINE):
            continue
        given = " ".join(arguments.replace("Byte[]", "Byte bytes[]").split())
        ok, error, count = f"fmi{version}OK", f"fmi{version}Error", re.search(r"size_t (n\w+)", given)
        answer = ok if _NOTHING_TO_DO.search(name) else f"{count[1]} ? {error} : {ok}" if count else error
        does = "" if kind == "void" else f" return {answer if kind.endswith('Status') else 'NULL'}; "
        lines.append(f"{kind} {name}({given}) {{{does}}}\n")
    return "".join(lines)


def _compile(compiler: str, source: Path, library: Path) -> None:
    done = subprocess.run(
        [compiler, *_FLAGS, str(source), "-lm", "-o", str(library)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise FileError(library.name, f"cannot be compiled by {compiler} ({' '.join(done.stderr.split()):.200})")
