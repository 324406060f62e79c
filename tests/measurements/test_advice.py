"""The advice of every refusal of a file, followed, leads to a right result or to another
refusal.
"""

import ast
import re

import pytest
import rubbers
import tolerances as tol
from calls import file
from closeness import close
from refusals import refused

import viscoroll as vr

RIGHT = "f [Hz];E' [MPa];E'' [MPa]\n<f; S/1e6; L/1e6>\n"


def change(old, new):
    """The advice is to change the file: a function of its text."""
    return lambda text, _, options: (text.replace(old, new), options)


def without(pattern):
    """The advice is to remove what a pattern finds in the lines."""
    return lambda text, _, options: (re.sub(f"(?m){pattern}", "", text), options)


def give(**more):
    """The advice is to give an option whose value the message leaves to the user."""
    return lambda text, _, options: (text, options | more)


def quoted(which):
    """The advice is one of the options that the message writes out, as columns={...}."""

    def follow(text, message, options):
        name, value = re.findall(r"(columns|units)=(\{.*?\})", message)[which]
        return text, options | {name: options.get(name, {}) | ast.literal_eval(value)}

    return follow


in_MPa = give(units={"storage": "MPa", "loss": "MPa"})
#: title -> the file, words of its refusal, and what its advice is; a refusal follows where words of
#: it are given
CASES = {
    "a spreadsheet": (
        "PK\u0003\u0004",
        "save the sheet as CSV",
        lambda text, *_: (rubbers.filled(RIGHT, {"sep": ";"}), {}),
    ),
    "a gap": (RIGHT + "200;nan;2\n", "remove this line", without(r"^200;nan.*\n")),
    "a frequency of 0": (RIGHT + "0;3;2\n", "remove this line", without(r"^0;3.*\n")),
    "words among the rows": (
        RIGHT + "sample slipped\n<f; S/1e6; L/1e6>\n",
        "remove it",
        without(r"^sample.*\n"),
    ),
    "words above the rows": (
        "f [Hz];E' [MPa];E'' [MPa]\nmade;by;me\n<f; S/1e6; L/1e6>\n",
        "remove it",
        without(r"^made.*\n"),
    ),
    "numbers above the headings": ("1;2;3\n" + RIGHT, "keep one table", without(r"^1;2.*\n")),
    "two rows of headings": (
        "f [Hz];20;;30;\n;E' [MPa];E'' [MPa];E' [MPa];E'' [MPa]\n<f; S/1e6; L/1e6; S/2e6; L/2e6>\n",
        "no column was found for frequency",
        give(columns={"frequency": "column 0"}),
        "rename or remove one of",
    ),
    "different headings": (
        RIGHT + "f [Hz];E' [kPa];E'' [kPa]\n<f; S/1e3; L/1e3>\n",
        "keep one of them",
        without(r"^.*kPa(.*\n)*"),
    ),
    "two tables, with temperatures": (
        RIGHT + RIGHT,
        "above each, as 'Temperature 20 °C'",
        change("f [Hz]", "Temperature 20 °C\nf [Hz]"),
    ),
    "temperatures that are not understood": (
        "Ts [°C];f [Hz];E' [MPa];E'' [MPa]\n<20+n; f; S/1e6; L/1e6>\n",
        "looks like temperatures",
        quoted(0),
    ),
    "temperatures that are not of the sample": (
        "Ts;f [Hz];E' [MPa];E'' [MPa]\n<20+n; f; S/1e6; L/1e6>\n",
        "or remove it",
        without("^[^;]*;"),
    ),
    "a temperature without a unit": (
        "T;f [Hz];E' [MPa];E'' [MPa]\n<293*one; f; S/1e6; L/1e6>\n",
        "units={'temperature'",
        give(units={"temperature": "K"}),
    ),
    "a unit that is not known": (
        "f [Schlag/min];E' [MPa];E'' [MPa]\n<60*f; S/1e6; L/1e6>\n",
        "is not a unit of frequency: give the unit of the column, as units=",
        give(units={"frequency": "rpm"}),
    ),
    "a unit of another dimension, named": (
        "f [Hz];S1 [N/mm];S2 [N/mm]\n<f; S/1e6; L/1e6>\n",
        "'N/mm' is not a unit of storage: give the unit of the column, as units=",
        in_MPa,
        {"storage": "S1 [N/mm]", "loss": "S2 [N/mm]"},
    ),
    **{
        f"a factor, named: {factor}": (
            f"f [Hz];E' {factor};E'' {factor}\n<f; S/1e6; L/1e6>\n",
            "is not a unit of storage: give the unit of the column, as units=",
            in_MPa,
            {"storage": f"E' {factor}", "loss": f"E'' {factor}"},
        )
        for factor in ("x10^6 [Pa]", "x1000 [kPa]", "/1000 [kPa]", "in 1000 kPa", "millions Pa")
    },
    "a modulus without a unit": (
        "f [Hz];E' [MPa];E''\n<f; S/1e6; L/1e6>\n",
        "units={'loss'",
        give(units={"loss": "MPa"}),
    ),
    "an angular frequency in Hz": (
        "Angular frequency [Hz];E' [MPa];E'' [MPa]\n<w; S/1e6; L/1e6>\n",
        "if they are in rad/s, give the unit of the column, as units=",
        give(units={"angular frequency": "rad/s"}),
    ),
    "frequencies that contradict, the second": (
        "Angular frequency [1/s];Frequency [Hz];E' [MPa];E'' [MPa]\n<f; f; S/1e6; L/1e6>\n",
        "choose one by",
        quoted(1),
    ),
    "a phase angle that is wrong": (
        "f [Hz];Phase [rad];E' [MPa];E'' [MPa];tan_delta\n<f; 0.9*tan; S/1e6; L/1e6; tan>\n",
        "choose one by",
        quoted(0),
        "tan delta differs by more than 1% from that of storage and loss",
    ),
    "a tan delta in per cent beside moduli": (
        "f [Hz];E' [MPa];E'' [MPa];tan delta\n<f; S/1e6; L/1e6; 100*tan>\n",
        "units={'tan delta': '%'}",
        give(units={"tan delta": "%"}),
    ),
    "a tan delta that is wrong": (
        "f [Hz];E' [MPa];E'' [MPa];tan delta\n<f; S/1e6; L/1e6; 2*tan>\n",
        "remove one of these columns",
        without(";[^;]*$"),
    ),
    "a magnitude of few digits": (
        "f [Hz];E' [MPa];|E*| [MPa]\n1;3.0;3.0\n10;4.0;4.1\n",
        "add a column of tan delta",
        change("f [Hz]", "f [Hz]"),
        "differ too little",
    ),
    "logarithms": (
        "f,Storage,Loss\n<log(f); log(S); log(L)>\n",
        "if the column has logarithms, write log before its",
        change("f,Storage,Loss", "log f (Hz),log Storage (Pa),log Loss (Pa)"),
    ),
    "four columns without headings": (
        "<n; f; S/1e6; L/1e6>\n",
        "with 'column 0', 'column 1'",
        give(
            columns={"frequency": "column 1", "storage": "column 2", "loss": "column 3"},
            units=("Hz", "MPa"),
        ),
    ),
    "headings that say nothing": (
        "a [Hz];b [MPa];c [MPa]\n<f; S/1e6; L/1e6>\n",
        "name the columns by columns=",
        give(columns={"frequency": "a [Hz]", "storage": "b [MPa]", "loss": "c [MPa]"}),
    ),
    "a sweep of temperature": (
        "T [°C];E' [MPa];E'' [MPa]\n<20+n; S/1e6; L/1e6>\n",
        "if this is a temperature sweep, it cannot be used",
        give(columns={"frequency": "T [°C]"}),
        "is not a unit of frequency",
    ),
    "headings and rows of other separators": (
        "f E' E''\n<f; S; L>\n",
        "cells separated by semicolons",
        change("f E' E''", "f;E';E''"),
    ),
}


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("title", CASES)
def test_advice_helps(title):
    text, words, follow, *rest = CASES[title]
    options = {"columns": rest[0]} if rest and isinstance(rest[0], dict) else {}
    case = {"sep": "," if text.startswith((",", "f,")) else ";", "format": "%.9g"}
    text = rubbers.filled(text, case)
    path = file(text, "dma.csv")
    message = refused(lambda: vr.read_dma(path, **options), words, error=vr.ViscorollError)
    changed, options = follow(text, message, options)
    file(rubbers.filled(changed, case), "dma.csv")
    if rest and isinstance(rest[0], str):
        refused(lambda: vr.read_dma(path, **options), rest[0], error=vr.ViscorollError)
        return
    found = vr.read_dma(path, **options)
    assert close([found.storage, found.loss], rubbers.moduli(found.omega), tol.DMA_DIGITS)
