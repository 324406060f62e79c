"""modelDescription.xml of FMI 2.0 and 3.0, and what a source FMU of 3.0 adds to it."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ... import __version__
from ...core.scale import dimension_powers
from .variables import MODELS, UNITS, Model, Variable

#: what both models can do, in either version: attributes of ModelExchange and CoSimulation
_ABILITIES = {
    2: {
        "providesDirectionalDerivative": "true", "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true",
    },
    3: {
        "providesDirectionalDerivatives": "true", "providesAdjointDerivatives": "true",
        "canGetAndSetFMUState": "true", "canSerializeFMUState": "true",
    },
}  # fmt: skip
#: relative tolerance that a tool's solver takes where its user gives none
_TOLERANCE = "1e-5"


def described(version: int, name: str, starts: dict[str, float], token: str, title: str) -> str:
    """modelDescription.xml of a model; ``starts``: values of what may be set."""
    model = MODELS[name]
    root = Element(
        "fmiModelDescription",
        {
            "fmiVersion": f"{version}.0", "modelName": f"viscoroll.{name}", "description": f"{model.text}: {title}",
            "generationTool": f"viscoroll {__version__}", "license": "BSD-3-Clause",
            **({"guid": token, "numberOfEventIndicators": "0"} if version == 2 else {"instantiationToken": token}),
        },
    )  # fmt: skip
    _add_kinds(root, version, name, model)
    units = SubElement(root, "UnitDefinitions")
    for unit, base in UNITS.items():
        one = SubElement(units, "Unit", name=unit)
        SubElement(one, "BaseUnit", {each: str(power) for each, power in dimension_powers(base).items()})
    SubElement(root, "DefaultExperiment", startTime="0", stopTime="1", tolerance=_TOLERANCE, stepSize="0.01")
    variables = SubElement(root, "ModelVariables")
    references = {each.name: str(n) for n, each in enumerate(model.variables, start=1)}
    if version == 3:
        time = {"causality": "independent", "variability": "continuous", "unit": "s"}
        SubElement(variables, "Float64", {"name": "time", "valueReference": "0"} | time)
    for each in model.variables:
        _add_variable(variables, version, each, references, starts)
    _add_structure(SubElement(root, "ModelStructure"), version, model, references)
    return _text(root)


def _text(root: Element) -> str:
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add_kinds(root: Element, version: int, name: str, model: Model) -> None:
    steps = {2: {"completedIntegratorStepNotNeeded": "true"}, 3: {"needsCompletedIntegratorStep": "false"}}
    kinds = {"ModelExchange": steps[version]}
    if model.states:
        kinds["CoSimulation"] = {"canHandleVariableCommunicationStepSize": "true"}
    for kind, can in kinds.items():
        one = SubElement(root, kind, {"modelIdentifier": name} | _ABILITIES[version] | can)
        if version == 2:
            SubElement(SubElement(one, "SourceFiles"), "File", name="fmu.c")


def _add_variable(
    parent: Element, version: int, each: Variable, references: dict[str, str], starts: dict[str, float]
) -> None:
    varies = "continuous" if each.causality != "parameter" else "tunable" if each.above_0 else "fixed"
    about = {
        "name": each.name, "valueReference": references[each.name], "causality": each.causality, "variability": varies,
        "description": each.text,
    }  # fmt: skip
    value = {"unit": each.unit}
    if each.name in starts:
        value["start"] = repr(starts[each.name])
    if each.name.startswith("der_"):
        value["derivative"] = references[each.name.removeprefix("der_")]
    if version == 3:
        SubElement(parent, "Float64", about | value)
    else:
        SubElement(SubElement(parent, "ScalarVariable", about), "Real", value)


def _add_structure(parent: Element, version: int, model: Model, references: dict[str, str]) -> None:
    outputs = [references[each.name] for each in model.variables if each.causality == "output"]
    rates = [references[f"der_{state}"] for state in model.states]
    unknowns = sorted((*outputs, *rates), key=int)
    kinds = {"Outputs": outputs, "Derivatives": rates, "InitialUnknowns": unknowns}
    if version == 3:
        kinds = {"Output": outputs, "ContinuousStateDerivative": rates, "InitialUnknown": unknowns}
    for kind, found in kinds.items():
        group = SubElement(parent, kind) if version == 2 and found else parent
        for reference in found:
            if version == 2:
                SubElement(group, "Unknown", index=reference)
            else:
                SubElement(group, kind, valueReference=reference)


def sources_described(name: str) -> str:
    """sources/buildDescription.xml of FMI 3.0."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    how = SubElement(root, "BuildConfiguration", modelIdentifier=name)
    SubElement(SubElement(how, "SourceFileSet", language="C99"), "SourceFile", name="fmu.c")
    return _text(root)
