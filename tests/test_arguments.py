"""Ranges, truth values, counts and choices: each argument of every public call is given what is
outside of its range, or of another kind.

The calls are those of test_quantities.py, whose odd values and units no argument takes either.
"""

import math
from functools import partial

import numpy as np
import pytest
from refusals import refused
from test_quantities import CALLS, CYLINDER, arguments_of, parameters

from viscoroll.core.quantities import SYMBOLS

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
POSITIVE = """R m T_epsilon T_sigma load g T_ref density thickness other_thickness energy C1 C2 low
high E0 G0 G_inf bulk rtol rest speed storage loss relaxation tau strain sigma factor T"""
#: range of arguments, as symbols.csv has it -> names of those that have no symbol
RANGES = {
    "> 0": POSITIVE,
    ">= 0": "g k K G beta rested J E misfit",
    "(-1, 0.5]": "nu nu_instant",
    "[0, 1]": "share level",
    "> -273.15": "temperature T0 reference",
}
#: range -> what is outside of it
OUTSIDE = {
    "> 0": (0.0, -1.0),
    ">= 0": (-1.0,),
    ">= 1": (0.5, 0.0, -2.0),
    "(-pi/2, pi/2)": (1.6, -2.0),
    "(-1, 0.5]": (-1.0, 0.51),
    "[0, 1]": (-0.1, 1.5),
    "> -273.15": (-300.0,),
}
RANGE_OF = {name: symbol.range for name, symbol in SYMBOLS.items()} | {
    name: bounds for bounds, names in RANGES.items() for name in names.split()
}
#: first word of an annotation -> what is not of that kind
KINDS = {
    "bool": ("no", math.nan, [True], np.array([True])),
    "int": (-5, 1.5, "2", True, np.timedelta64(5)),
    **{
        kind: ("magic", 3, [good], np.array([1.0, 2.0]))
        for kind, good in {"Literal": "table", "Mode": "shear", "Plane": "strain"}.items()
    },
}


@pytest.mark.parametrize("call", CALLS)
def test_what_an_argument_cannot_be(call):
    given = {}
    for argument in arguments_of(call):
        given = {**argument.others, argument.name: argument.value}
        outside = OUTSIDE.get(RANGE_OF.get(argument.name), ())
        if call == "Coastdown" or (call, argument.name) == ("Material.ansys", "alpha"):
            continue  # t of a clock; a share
        for value in outside:
            several = [value, *np.atleast_1d(argument.value)[1:]]
            bad = several if np.ndim(argument.value) else value
            refused(partial(argument, bad), argument.name, "must be")
    function = CALLS[call]()
    for name, parameter in parameters(function).items():
        kind = str(parameter.annotation).partition("[")[0].partition(" |")[0]
        for bad in KINDS.get(kind, ()):
            refused(partial(function, **given | {name: bad}), name, "must be")


@pytest.mark.parametrize("call", [call for call in CALLS if call.endswith("of a Cylinder")])
def test_three_values_do_not_go_with_two_cylinders(call):
    """But times, which are those of all."""
    two = CYLINDER.replace(R=[1.0, 2.0])
    for argument in arguments_of(call):
        if argument.name != "t" and not np.ndim(argument.value):
            many = argument._replace(function=partial(argument.function.func, two))
            refused(partial(many, np.full(3, argument.value)))
