"""Export of a cylinder and its law as an FMU, for Modelica tools, Simulink and others.

An FMU (Functional Mock-up Unit) is a model for simulation programs.

    from viscoroll import fmu
    fmu.build(vr.presets.RUBBER_CYLINDER, "roller.fmu")  # or `viscoroll fmu`

There are two models.  ``ContactElement`` gives the forces of a contact, with exact slopes, to a
multibody model that knows the motion of the cylinder.  ``Roller`` is the cylinder itself; in
co-simulation it has its own step-size control.  :func:`build` packs into one archive the sources,
fmu.c with the functions of the standard, their compiled library, and the description: of FMI 2.0 or
3.0 modelDescription.xml, of 3.0 also buildDescription.xml.  The variables of both models are read
from variables.csv, in the order of their value references, which start with 1.
"""

import csv
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
import uuid
import zipfile
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import msgspec
import numpy as np

from .. import __version__, tables
from ..core import (
    FileError,
    MissingDependencyError,
    ParameterError,
    check_choice,
    check_integer,
    dimension_powers,
    import_extra,
    replace_file,
    shape_error,
    warn_of_model,
)
from ..laws import LawTable, parse_law
from ..materials import dataset_content
from ..rollers import Cylinder

__all__ = ["build"]

# --- The variables of both models ---


class Variable(NamedTuple):
    """A variable of an FMU, a row of variables.csv.

    Attributes
    ----------
    model : name of the model that has it, or "both".
    name : as the tool shows it.
    causality : "input", "output", "parameter" or "local", as in the standard.
    unit : unit of its values, in base units or one of :data:`_NAMED_UNITS`.
    start : default start value of what can be set, where no Cylinder gives one: R is that of the
        examples of the documentation; None, in the file null, of what is computed.
    positive : whether values that are not above 0 are refused.
    text : description.
    """

    model: str
    name: str
    causality: str
    unit: str
    start: float | None
    positive: bool
    text: str


class Model(NamedTuple):
    """A model of an FMU.

    Attributes
    ----------
    text : description.
    variables : all variables but time.
    states : names of the continuous states; the rate of each is the variable der_NAME.
    """

    text: str
    variables: tuple[Variable, ...]
    states: tuple[str, ...]


def _read_model(name: str, text: str, *states: str) -> Model:
    """Return a model with its variables, which are read from variables.csv.

    name: "Roller" or "ContactElement".
    text, states: as fields of :class:`Model`; without states the model is one for model exchange
    alone.
    Returns the :class:`Model`, with the rows of its name and those of "both", in the order of the
    file.
    """
    with (files(__package__) / "variables.csv").open(encoding="utf-8") as file:
        # without the head; not strict: texts become numbers, truth values and None
        variables = msgspec.convert([*csv.reader(file)][1:], list[Variable], strict=False)
    return Model(
        text, tuple(variable for variable in variables if variable.model in ("both", name)), states
    )


#: Name of a model -> the model.
MODELS = {
    "Roller": _read_model(
        "Roller",
        "A cylinder that rolls on a flat base, one or both of them viscoelastic",
        "v",
        "slip",
        "x",
    ),
    "ContactElement": _read_model(
        "ContactElement",
        "Force element: a cylinder on a flat base, one or both of them viscoelastic",
    ),
}
#: Unit with a name of its own -> the same in base units, for :func:`.scale.dimension_powers`.
_NAMED_UNITS = {"N": "kg m s-2", "N.m": "kg m2 s-2", "Pa": "kg m-1 s-2"}


# --- modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml of 3.0 ---

#: Capabilities of both models by version of the standard: attributes of ModelExchange and of
#: CoSimulation whose value is "true".
_CAPABILITIES = {
    2: "providesDirectionalDerivative canGetAndSetFMUstate canSerializeFMUstate",
    3: "providesDirectionalDerivatives providesAdjointDerivatives canGetAndSetFMUState"
    " canSerializeFMUState",
}
#: Version of the standard -> attribute of ModelExchange: the end of a step is not told.
_STEPS = {
    2: {"completedIntegratorStepNotNeeded": "true"},
    3: {"needsCompletedIntegratorStep": "false"},
}
#: Relative tolerance of a tool's solver if its user gives none.  The tests pass through rest with
#: it.
_TOLERANCE = "1e-5"
#: First line of both files.
_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'


def model_description(
    version: int, name: str, starts: dict[str, float], token: str, title: str
) -> str:
    """Return the text of modelDescription.xml, in which a tool finds the variables and capabilities
    of an FMU.

    version: version of the FMI standard, the int 2 or 3.
    name: name of the model, a key of MODELS: "Roller" or "ContactElement".
    starts: name -> start value of the variables that can be set, in their units; others get no
    start.
    token: GUID (FMI 2) or instantiation token (FMI 3), which the library compares.
    title: title of the law, which the description of the model ends with.
    Returns the text of the XML file, with its declaration.
    """
    model = MODELS[name]
    identity = {
        2: {"guid": token, "numberOfEventIndicators": "0"},
        3: {"instantiationToken": token},
    }
    about = {
        "fmiVersion": f"{version}.0",
        "modelName": f"viscoroll.{name}",
        "description": f"{model.text}: {title}",
        "generationTool": f"viscoroll {__version__}",
        "license": "BSD-3-Clause",
    }
    root = Element("fmiModelDescription", about | identity[version])
    _add_interfaces(root, version, name, model)
    units = SubElement(root, "UnitDefinitions")
    for unit in dict.fromkeys(["s", *(variable.unit for variable in model.variables)]):
        powers = dimension_powers(_NAMED_UNITS.get(unit, unit))
        SubElement(
            SubElement(units, "Unit", name=unit),
            "BaseUnit",
            {base: str(power) for base, power in powers.items()},
        )
    SubElement(
        root,
        "DefaultExperiment",
        {"startTime": "0", "stopTime": "1", "tolerance": _TOLERANCE, "stepSize": "0.01"},
    )
    variables = SubElement(root, "ModelVariables")
    # 0 is time, as in the library
    references = {variable.name: str(n) for n, variable in enumerate(model.variables, start=1)}
    if version == 3:
        SubElement(
            variables,
            "Float64",
            {
                "name": "time",
                "valueReference": "0",
                "causality": "independent",
                "variability": "continuous",
                "unit": "s",
            },
        )
    for variable in model.variables:
        _add_variable(variables, version, variable, references, starts)
    _add_structure(SubElement(root, "ModelStructure"), version, model, references)
    indent(root)
    return _DECLARATION + tostring(root, encoding="unicode") + "\n"


def _add_interfaces(root: Element, version: int, name: str, model: Model) -> None:
    """Add the interfaces that the FMU has: ModelExchange and, of a model with states, CoSimulation.

    root: :class:`Element`, element fmiModelDescription, to which they are added.
    version: version of the standard, 2 or 3; of 2 the source file is added too.
    name: name of the model and of its library.
    model: :class:`Model`, the model, of which only ``states`` is used.
    """
    about = {"modelIdentifier": name} | dict.fromkeys(_CAPABILITIES[version].split(), "true")
    interfaces = {"ModelExchange": _STEPS[version]}
    if model.states:
        interfaces["CoSimulation"] = {"canHandleVariableCommunicationStepSize": "true"}
    for interface, more in interfaces.items():
        element = SubElement(root, interface, about | more)
        if version == 2:
            SubElement(SubElement(element, "SourceFiles"), "File", name="fmu.c")


def _add_variable(
    parent: Element,
    version: int,
    variable: Variable,
    references: dict[str, str],
    starts: dict[str, float],
) -> None:
    """Add a variable to modelDescription.xml.

    A parameter is "tunable", if it must be above 0, else "fixed" (the speeds at the start); all
    others are continuous.

    parent: :class:`Element`, element ModelVariables, to which a Float64 (FMI 3) or a ScalarVariable
        with a Real (FMI 2) is added.
    version: version of the FMI standard, the int 2 or 3.
    variable: :class:`Variable` to add, of which name, causality, unit, positive and text
        are read; a name der_NAME makes it the rate of the variable NAME.
    references: name -> value reference, a number as text, of all variables of the model.
    starts: name -> start value, in the unit of the variable, of those that can be set; others get
    no start.
    """
    varies = (
        "continuous"
        if variable.causality != "parameter"
        else "tunable"
        if variable.positive
        else "fixed"
    )
    about = {
        "name": variable.name,
        "valueReference": references[variable.name],
        "causality": variable.causality,
        "variability": varies,
        "description": variable.text,
    }
    value = {"unit": variable.unit}
    if variable.name in starts:
        value["start"] = repr(starts[variable.name])
    if variable.name.startswith("der_"):
        value["derivative"] = references[variable.name.removeprefix("der_")]
    if version == 3:
        SubElement(parent, "Float64", about | value)
    else:
        SubElement(SubElement(parent, "ScalarVariable", about), "Real", value)


def _add_structure(parent: Element, version: int, model: Model, references: dict[str, str]) -> None:
    """Add the lists of outputs, of rates of the states, and of initial unknowns, which are the two
    together.

    A model without states has no list of rates.  In FMI 2 a list is an element with an Unknown for
    each member; in FMI 3 the members stand in ModelStructure themselves.  Outputs are in the order
    of the variables, rates in that of the states, initial unknowns in ascending order of their
    references.

    parent: :class:`Element`, element ModelStructure, to which they are added.
    version: version of the FMI standard, the int 2 or 3.
    model: :class:`Model`, of which the states and the name and causality of the variables are read.
    references: name -> value reference, a number as text, of all variables.
    """
    outputs = [
        references[variable.name] for variable in model.variables if variable.causality == "output"
    ]
    rates = [references[f"der_{state}"] for state in model.states]
    kinds = {
        "Output": outputs,
        "Derivative" if version == 2 else "ContinuousStateDerivative": rates,
        "InitialUnknown": sorted((*outputs, *rates), key=int),  # as numbers: 10 after 9
    }
    for kind, members in kinds.items():
        group = SubElement(parent, f"{kind}s") if version == 2 and members else parent
        tag, attribute = ("Unknown", "index") if version == 2 else (kind, "valueReference")
        for reference in members:
            SubElement(group, tag, {attribute: reference})


def build_description(name: str) -> str:
    """Return the text of sources/buildDescription.xml of FMI 3.0, by which a tool compiles the
    sources itself.

    name: name of the model and of its library, "Roller" or "ContactElement".
    Returns the text of the XML file, with its declaration.
    """
    return f"""{_DECLARATION}<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{name}">
    <SourceFileSet language="C99">
      <SourceFile name="fmu.c" />
    </SourceFileSet>
  </BuildConfiguration>
</fmiBuildDescription>
"""


# --- Sources, description and compiled library of an FMU, packed into one archive ---

#: Options of the C compiler.  -ffp-contract=off keeps the bits independent of the machine's fused
#: multiply-add.
_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC")


def build(
    given: Any, path: str | os.PathLike[str], model: str = "Roller", version: int = 2
) -> None:
    """Write an FMU of a cylinder, with its sources and a library for this machine, whole or not at
    all.

    Parameters
    ----------
    given : a :class:`viscoroll.Cylinder`, whose numbers become the start values; or a material,
        pair, cover, law of :func:`viscoroll.load_law` or alpha (a number >= 1), for which radius,
        load, mass and friction are set in the tool.
    path : file to write, with the suffix .fmu by custom; a file of that name is replaced.
    model : "Roller", from drive force and torque to v, omega and x: co-simulation with its own
        step-size control, and model exchange; or "ContactElement", from v, omega and load to force,
        torque and moments: model exchange.
    version : version of the FMI standard, the int 2 or 3.

    Raises
    ------
    ParameterError
        Another model or version, a material without a law, arrays in the cylinder.
    MissingDependencyError
        No fmpy, which brings the headers of the standard, or no C compiler ``cc``.
    FileError
        If the file cannot be written, the compiler fails, or a law that is given is incomplete or
        that of every alpha.

    Warns
    -----
    ModelWarning
        Of a cover, and of a Cylinder on a half-space with Dundurs' constant above 0.05, unless the
        Cylinder has ``coupled=False``: the FMU has the law without a table.

    Examples
    --------
    >>> import viscoroll as vr
    >>> from viscoroll import fmu
    >>> fmu.build(vr.presets.RUBBER_CYLINDER, "roller.fmu")  # doctest: +SKIP

    Notes
    -----
    Both models give exact slopes as directional derivatives, and in FMI 3 as adjoint derivatives.
    As co-simulation a roller that starts with slip follows :func:`viscoroll.roll` to 1e-9 of its
    speed (``tests/fmu/test_fmu.py``).  The law of a cover holds at one contact length at rest: the
    FMU refuses values of R, load, width and E_prime that make another one; the slopes of a
    ContactElement over the load are those at that length.
    """
    check_choice("model", model, *MODELS)
    version = check_integer("version", version, 2, 3)
    if isinstance(given, LawTable) and given.coupled is not None:
        found = "that of the coupled solution of pressure and shear, which an FMU cannot contain"
        allowed = (
            "give the roller (its FMU has the fast law), or export the law as C code with "
            "vr.tables.export"
        )
        sentence = f"the contact law that is given is {found}: {allowed}"
        raise ParameterError("given", found, allowed, sentence)
    law = tables.law(given)  # which warns of a Cylinder
    table = parse_law(dataset_content(law), path)
    # contact length at rest in m, for which the law of a cover holds, so that the FMU refuses any
    # other; 0.0 of half-spaces, and of a dimensionless cover, whose thickness in m is free
    l0 = 0.0
    if table.cover is not None and table.pair is not None:
        cover: Any = table.material
        l0 = float(table.pair.cover(1.0).thickness / cover.thickness)
    about = MODELS[model]
    starts = _start_values(about.variables, given, table, l0)
    if table.cover and not isinstance(given, Cylinder):
        warn_of_model(
            "the FMU has the fast law (coupled=False) in place of the coupled solution of pressure "
            "and shear.  validity(V).traction of a Cylinder of these materials states the error"
        )
    fmpy = import_extra("fmpy", "fmu")
    compiler = shutil.which("cc")
    if compiler is None:
        raise MissingDependencyError("the command cc, a C compiler such as gcc or clang,", None)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tables.export(law, folder / "law.h")
        texts = {
            "law.h": (folder / "law.h").read_text(encoding="utf-8"),
            "model.h": _model_header(about, starts)
            + f"#define FMI_VERSION {version}\n#define L0 {l0!r}\n",
        } | _sources(Path(fmpy.__file__).parent / "c-code", version)
        # sorted: a folder has no order of its own
        digest = hashlib.sha256("".join([model, *(texts[name] for name in sorted(texts))]).encode())
        token = f"{{{uuid.UUID(digest.hexdigest()[:32])}}}"
        # after the digest, which cannot contain itself
        texts["model.h"] += f'#define TOKEN "{token}"\n'
        for file, text in texts.items():
            (folder / file).write_text(text, encoding="utf-8")
        library = folder / f"{model}{fmpy.sharedLibraryExtension}"
        _compile(compiler, folder / "fmu.c", library)
        description = model_description(version, model, starts, token, law.attrs["title"])
        content: dict[str, str | bytes] = {"modelDescription.xml": description}
        if version == 3:
            content["sources/buildDescription.xml"] = build_description(model)
        content |= {f"sources/{name}": text for name, text in sorted(texts.items())}
        machine = fmpy.platform if version == 2 else fmpy.platform_tuple
        content[f"binaries/{machine}/{library.name}"] = library.read_bytes()
    with (
        replace_file(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for name, data in content.items():
            # ZipInfo has a fixed time, so that equal content gives equal bytes
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)


def _start_values(
    variables: tuple[Variable, ...], given: Any, table: LawTable, l0: float
) -> dict[str, float]:
    """Return the start value of each variable that can be set, for the description and the library
    of the FMU.

    A value comes from the Cylinder if there is one, else from the law (T_ref, E_prime), else from
    variables.csv.

    variables: variables of the model.
    given: argument ``given`` of :func:`build`; the numbers of a Cylinder become start values,
    for 1 m of its width.
    table: :class:`LawTable`, law of ``given``, which has T_ref (s) and, of SI materials, a ``pair``
    with E_prime (Pa).
    l0: contact length at rest of a cover in m, or 0.0; without a Cylinder the load at the start is
        the one that makes it, at the default radius.
    Returns name -> value in the unit of the variable, of all variables whose ``start`` is not None,
    in their order.
    Raises ParameterError for a Cylinder with arrays, whose message has the first such name.
    """
    starts = {variable.name: variable.start for variable in variables if variable.start is not None}
    values = {"T_ref": table.T_ref}
    if table.pair is not None:
        values["E_prime"] = table.pair.E_prime
        if l0:
            # of l0 = 4 sqrt(2 R P/E'), where the contact has this length at rest
            values["load"] = l0**2 * table.pair.E_prime / (32.0 * starts["R"])
    if isinstance(given, Cylinder):
        values |= {
            "R": given.R,
            "E_prime": given.E_prime,
            "mu": given.mu,
            "load": given.load,
            "mass": given.m,
            "inertia": given.j,
        }
        for name, value in given.numbers.items():
            if np.ndim(value):
                raise shape_error(
                    name, np.shape(value), "one number, as an FMU contains one cylinder"
                )
    return {name: float(values.get(name, start)) for name, start in starts.items()}


def _sources(headers: Path, version: int) -> dict[str, str]:
    """Return the sources that do not depend on the model: name of a file -> its text.

    headers: folder with the headers of the standard, of both versions, as fmpy brings them.
    version: version of the FMI standard, the int 2 or 3.
    They are fmu.c, vr_roll.h, the headers of this version, and stubs.h.
    """
    package: Any = files("viscoroll")
    own = package / "fmu/fmu.c", package / "tables/c/vr_roll.h"
    texts = {
        path.name: path.read_text(encoding="utf-8")
        for path in (*own, *headers.glob(f"fmi{version}*.h"))
    }
    texts["stubs.h"] = _stubs(texts["fmu.c"], texts[f"fmi{version}FunctionTypes.h"], version)
    return texts


def _model_header(model: Model, starts: dict[str, float]) -> str:
    """Return the C text of the variables: their references, names, kinds and start values;
    reference 0 is time.

    A kind is 0 (the variable cannot be set) of time and where ``start`` is None; else 1 of an
    input, 2 of a parameter above 0, which is tunable, and 3 of another parameter, which is fixed.

    model: :class:`Model`, whose variables are in the order of their references, which start with 1.
    starts: name -> start value in the unit of the variable; 0.0 stands for those that it does not
    have.
    Returns an enum of n_NAME, the references, and COUNT, their number with time; the arrays NAMES,
    KINDS and START, of COUNT elements each, in the order of the references, the first for time; and
    ROLLER, 1 of a model with states, else 0.
    """
    names = ["time", *(variable.name for variable in model.variables)]
    kinds = [
        # 3 - True = 2: tunable
        0 if v.start is None else 1 if v.causality == "input" else 3 - v.positive
        for v in model.variables
    ]
    values = [starts.get(name, 0.0) for name in names]
    quoted = ", ".join(f'"{name}"' for name in names)
    return (
        f"enum {{ {', '.join(f'n_{name}' for name in names)}, COUNT }};\n"
        f"static const char *const NAMES[COUNT] = {{{quoted}}};\n"
        f"static const char KINDS[COUNT] = {{{', '.join(map(str, [0, *kinds]))}}};\n"
        f"static const double START[COUNT] = {{{', '.join(map(repr, values))}}};\n"
        f"#define ROLLER {int(bool(model.states))}\n"
    )


def _stubs(source: str, header: str, version: int) -> str:
    """Return C definitions of the functions of the standard that fmu.c leaves out, which an FMU
    must have all the same.

    A function that gets or sets values returns OK for none and an error for some; every
    other one returns an error, or NULL where it returns no status; void functions do nothing.

    source: text of fmu.c.
    header: text of the standard's header of function types.
    version: version of the FMI standard, the int 2 or 3.
    Returns the C text, a line a function.
    """
    lines = []
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for kind, name, arguments in re.findall(
        rf"typedef\s+([\w\s*]+?)\s*\b(fmi{version}\w+)TYPE\s*\(([^)]*)\)", plain
    ):
        # fmu.c has a definition, which begins in the first column; a call is indented
        if re.search(rf"^[\w *]+\b{name}\(", source, flags=re.MULTILINE):
            continue
        # a parameter of a definition needs a name, which one of the header of FMI 2 lacks
        parameters = " ".join(arguments.replace("Byte[]", "Byte bytes[]").split())
        status = f"fmi{version}Error"
        if count := re.search(r"size_t (n\w+)", parameters):
            status = f"{count[1]} ? {status} : fmi{version}OK"
        body = (
            "" if kind == "void" else f" return {status if kind.endswith('Status') else 'NULL'}; "
        )
        lines.append(f"{kind} {name}({parameters}) {{{body}}}\n")
    return "".join(lines)


def _compile(compiler: str, source: Path, library: Path) -> None:
    """Compile fmu.c to a shared library.

    compiler: path of the C compiler.
    source: path of fmu.c, beside the headers.
    library: file to write.
    Returns nothing; the library is written, linked with libm (mathematical functions).
    Raises FileError, with the first 200 characters of the compiler's message, if the compiler exits
    with a nonzero code.
    """
    result = subprocess.run(
        [compiler, *_FLAGS, str(source), "-lm", "-o", str(library)],
        capture_output=True,
        text=True,
        check=False,
    )
    if result.returncode:
        raise FileError(
            library.name,
            f"cannot be compiled by {compiler} ({' '.join(result.stderr.split()):.200})",
        )
