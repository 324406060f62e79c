"""The variables of both models, read from variables.csv in the order of their value references, which start with 1."""

from __future__ import annotations

import csv
from importlib.resources import files
from typing import NamedTuple

import msgspec


class Variable(NamedTuple):
    """A variable of an FMU, a row of variables.csv.

    Attributes
    ----------
    model : name of the model that has it, or "both".
    name : as the tool shows it.
    causality : "input", "output", "parameter" or "local", as in the standard.
    unit : unit of its values, one of :data:`UNITS`.
    start : default start value of what can be set, where no Cylinder gives one: R is that of the examples of the
        documentation; None, in the file null, of what is computed.
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
    text, states: as fields of :class:`Model`; without states the model is one for model exchange alone.
    Returns the :class:`Model`, with the rows of its name and those of "both", in the order of the file.
    """
    with (files(__package__) / "variables.csv").open(encoding="utf-8") as file:
        variables = msgspec.convert([*csv.reader(file)][1:], list[Variable], strict=False)
    return Model(text, tuple(variable for variable in variables if variable.model in ("both", name)), states)


#: Name of a model -> the model.
MODELS = {
    "Roller": _read_model("Roller", "A viscoelastic cylinder that rolls on a half-space", "v", "slip", "x"),
    "ContactElement": _read_model("ContactElement", "Force element: a viscoelastic cylinder on a half-space"),
}
#: Unit -> the same in base units, as :func:`..core.scale.dimension_powers` reads it.
UNITS = {
    "m": "m", "s": "s", "kg": "kg", "m/s": "m s-1", "m/s2": "m s-2", "rad/s": "rad s-1", "N": "kg m s-2",
    "N.m": "kg m2 s-2", "Pa": "kg m-1 s-2", "1": "",
}  # fmt: skip
