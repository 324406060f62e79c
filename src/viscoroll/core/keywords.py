"""Misspelt arguments: the TypeError of a public call names the argument that was meant, as Python
does from 3.13 on.
"""

from __future__ import annotations

import inspect
import sys
from functools import cache, wraps
from typing import Any


@cache
def _suggesting(function: Any) -> Any:
    """Return a function that does the same, and whose TypeError of an unknown argument names the
    most similar one.
    """

    @wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return function(*arguments, **named)
        except TypeError as error:
            from .toml_sections import suggestion

            for name in named:
                if str(error).endswith(f"unexpected keyword argument '{name}'"):
                    error.args = (
                        f"{error}{suggestion(name, inspect.signature(function).parameters)}",
                    )
            raise

    return call


def suggest_arguments(owner: Any, names: tuple[str, ...] | None = None) -> None:
    """Replace public functions of a module or a class of this package by such that suggest
    arguments, once.

    owner: module or class; changed, as is the module that defines a function, by whose name it is
    pickled.
    names: names of the functions, of the classes whose methods are replaced, and of the modules
        whose names in ``__all__`` are; None: all.
    """
    for name in names or [name for name in vars(owner) if name == "__init__" or name[0] != "_"]:
        value = vars(owner).get(name)
        function = value.__func__ if isinstance(value, classmethod | staticmethod) else value
        if inspect.ismodule(value):
            suggest_arguments(value, tuple(value.__all__))
        for base in value.__mro__ if inspect.isclass(value) else ():
            if base.__module__.startswith("viscoroll"):
                suggest_arguments(base)
        if inspect.isfunction(function):
            replaced = _suggesting(inspect.unwrap(function))
            setattr(owner, name, replaced if function is value else type(value)(replaced))
            if inspect.ismodule(owner):
                setattr(sys.modules[function.__module__], name, replaced)
