"""modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml of 3.0."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ... import __version__
from ...core.scale import dimension_powers
from .variables import MODELS, UNITS, Model, Variable

#: Capabilities of both models by version of the standard: attributes of ModelExchange and of CoSimulation.
_CAPABILITIES = {
    2: {
        "providesDirectionalDerivative": "true", "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true",
    },
    3: {
        "providesDirectionalDerivatives": "true", "providesAdjointDerivatives": "true",
        "canGetAndSetFMUState": "true", "canSerializeFMUState": "true",
    },
}  # fmt: skip
#: Relative tolerance of a tool's solver if its user gives none.  The tests pass through rest with it.
_TOLERANCE = "1e-5"


def model_description(version: int, name: str, starts: dict[str, float], token: str, title: str) -> str:
    """Return the text of modelDescription.xml, in which a tool finds the variables and capabilities of an FMU.

    version: version of the FMI standard, the int 2 or 3.
    name: name of the model, a key of MODELS: "Roller" or "ContactElement".
    starts: name -> start value of the variables that can be set, in their units; others get no start.
    token: GUID (FMI 2) or instantiation token (FMI 3), which the library compares.
    title: title of the law, which the description of the model ends with.
    Returns the text of the XML file, with its declaration.
    """
    model = MODELS[name]
    root = Element(
        "fmiModelDescription",
        {
            "fmiVersion": f"{version}.0", "modelName": f"viscoroll.{name}", "description": f"{model.text}: {title}",
            "generationTool": f"viscoroll {__version__}", "license": "BSD-3-Clause",
            **({"guid": token, "numberOfEventIndicators": "0"} if version == 2 else {"instantiationToken": token}),
        },
    )  # fmt: skip
    _add_interfaces(root, version, name, model)
    units = SubElement(root, "UnitDefinitions")
    for unit, base in UNITS.items():
        element = SubElement(units, "Unit", name=unit)
        SubElement(element, "BaseUnit", {base_unit: str(power) for base_unit, power in dimension_powers(base).items()})
    SubElement(root, "DefaultExperiment", startTime="0", stopTime="1", tolerance=_TOLERANCE, stepSize="0.01")
    variables = SubElement(root, "ModelVariables")
    references = {variable.name: str(n) for n, variable in enumerate(model.variables, start=1)}
    if version == 3:
        time = {"causality": "independent", "variability": "continuous", "unit": "s"}
        SubElement(variables, "Float64", {"name": "time", "valueReference": "0"} | time)
    for variable in model.variables:
        _add_variable(variables, version, variable, references, starts)
    _add_structure(SubElement(root, "ModelStructure"), version, model, references)
    return _as_text(root)


def _as_text(root: Element) -> str:
    """Return an element and its children as indented XML with a declaration."""
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add_interfaces(root: Element, version: int, name: str, model: Model) -> None:
    """Add the interfaces that the FMU has: ModelExchange and, of a model with states, CoSimulation.

    root: :class:`Element`, element fmiModelDescription, to which they are added.
    version: version of the standard, 2 or 3; of 2 the source file is added too.
    name: name of the model and of its library.
    model: :class:`Model`, the model, of which only ``states`` is used.
    """
    steps = {2: {"completedIntegratorStepNotNeeded": "true"}, 3: {"needsCompletedIntegratorStep": "false"}}
    interfaces = {"ModelExchange": steps[version]}
    if model.states:
        interfaces["CoSimulation"] = {"canHandleVariableCommunicationStepSize": "true"}
    for interface, more in interfaces.items():
        element = SubElement(root, interface, {"modelIdentifier": name} | _CAPABILITIES[version] | more)
        if version == 2:
            SubElement(SubElement(element, "SourceFiles"), "File", name="fmu.c")


def _add_variable(
    parent: Element, version: int, variable: Variable, references: dict[str, str], starts: dict[str, float]
) -> None:
    """Add a variable to modelDescription.xml.

    A parameter is "tunable", if it must be above 0, else "fixed" (the speeds at the start); all others are continuous.

    parent: :class:`Element`, element ModelVariables, to which a Float64 (FMI 3) or a ScalarVariable with a Real (FMI 2)
        is added.
    version: version of the FMI standard, the int 2 or 3.
    variable: :class:`.variables.Variable` to add, of which name, causality, unit, positive and text are read; a name
        der_NAME makes it the rate of the variable NAME.
    references: name -> value reference, a number as text, of all variables of the model.
    starts: name -> start value, in the unit of the variable, of those that can be set; others get no start.
    """
    varies = "continuous" if variable.causality != "parameter" else "tunable" if variable.positive else "fixed"
    about = {
        "name": variable.name, "valueReference": references[variable.name], "causality": variable.causality,
        "variability": varies, "description": variable.text,
    }  # fmt: skip
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
    """Add the lists of outputs, of rates of the states, and of initial unknowns, which are the two together.

    A model without states has no list of rates.  In FMI 2 a list is an element with an Unknown for each member; in FMI
    3 the members stand in ModelStructure themselves.  Outputs are in the order of the variables, rates in that of the
    states, initial unknowns in ascending order of their references.

    parent: :class:`Element`, element ModelStructure, to which they are added.
    version: version of the FMI standard, the int 2 or 3.
    model: :class:`Model`, of which the states and the name and causality of the variables are read.
    references: name -> value reference, a number as text, of all variables.
    """
    outputs = [references[variable.name] for variable in model.variables if variable.causality == "output"]
    rates = [references[f"der_{state}"] for state in model.states]
    unknowns = sorted((*outputs, *rates), key=int)
    kinds = {"Outputs": outputs, "Derivatives": rates, "InitialUnknowns": unknowns}
    if version == 3:
        kinds = {"Output": outputs, "ContinuousStateDerivative": rates, "InitialUnknown": unknowns}
    for kind, members in kinds.items():
        group = SubElement(parent, kind) if version == 2 and members else parent
        for reference in members:
            if version == 2:
                SubElement(group, "Unknown", index=reference)
            else:
                SubElement(group, kind, valueReference=reference)


def build_description(name: str) -> str:
    """Return the text of sources/buildDescription.xml of FMI 3.0, by which a tool compiles the sources itself.

    name: name of the model and of its library, "Roller" or "ContactElement".
    Returns the text of the XML file, with its declaration.
    """
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=name)
    SubElement(SubElement(configuration, "SourceFileSet", language="C99"), "SourceFile", name="fmu.c")
    return _as_text(root)
