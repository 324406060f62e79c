"""Public functions and methods have docstrings in sections, whose examples run."""

import dis
import doctest
import inspect
import pkgutil
import re
from importlib import import_module
from itertools import pairwise

import pytest
from places import ROOT

import viscoroll as vr

MODULES = [each.name for each in pkgutil.walk_packages(vr.__path__, "viscoroll.")]


def callables(name, thing):
    """Yield name and function: the methods of a class, or a function itself."""
    if inspect.isclass(thing):
        for part, method in inspect.getmembers(
            thing, lambda each: inspect.isfunction(each) or inspect.ismethod(each)
        ):
            if not part.startswith("_") and method.__module__.startswith("viscoroll"):
                yield f"{name}.{part}", inspect.unwrap(method)
    elif inspect.isfunction(thing):
        yield name, inspect.unwrap(thing)


def shown_on_the_site():
    """Yield the functions and methods that the reference lists, with a name of each.

    All that are public are among them: evidence/test_site.py.
    """
    for line in (ROOT / "docs/api.rst").read_text(encoding="utf-8").splitlines():
        if line.startswith(".. currentmodule:: "):
            module = line.removeprefix(".. currentmodule:: ")
        elif re.fullmatch(r"   [\w.]+", line):
            owner, _, name = f"{module}.{line.strip()}".rpartition(".")
            yield from callables(name, getattr(pkgutil.resolve_name(owner), name))


#: function -> a name of it
SHOWN = {function: name for name, function in shown_on_the_site()}


@pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model
@pytest.mark.parametrize("name", MODULES)
@pytest.mark.long
def test_examples_of_docstrings(name, here):
    """Every line of every Examples section, with its output; files go to a temporary folder."""
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    tried = doctest.testmod(import_module(name), extraglobs={"vr": vr}, optionflags=options)
    assert not tried.failed


@pytest.mark.parametrize("function", SHOWN, ids=SHOWN.get)
def test_sections_of_docstrings(function):
    """Parameters, Returns or Yields, and Raises where there are any, and Examples; lines are as
    long as titles.
    """
    signature = inspect.signature(function)
    result = "Yields" if inspect.isgeneratorfunction(function) else "Returns"
    needed = {
        "Parameters": signature.parameters.keys() - {"self", "cls"},
        result: signature.return_annotation not in (None, "None"),
        "Raises": any(step.opname == "RAISE_VARARGS" for step in dis.get_instructions(function)),
        "Examples": True,
    }
    lines = (inspect.getdoc(function) or "").splitlines()
    titles = {title for title, line in pairwise(lines) if line and line == len(title) * "-"}
    missing = [title for title, applies in needed.items() if applies and title not in titles]
    assert not missing, missing
