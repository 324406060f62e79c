"""Imports of packages that only some functions need, and that an extra of the installation brings."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import MissingDependencyError


def import_extra(package: str, extra: str) -> Any:
    """Import a module of an optional package, and return it.

    package: name of the module and of the distribution that has it, as "fmpy".
    extra: extra of viscoroll that installs it, as in ``pip install 'viscoroll[EXTRA]'``, for the error.
    Returns the module.

    Raises
    ------
    MissingDependencyError
        If the package is not installed.
    ModuleNotFoundError
        If it is installed, but one of its own dependencies is not.  Other errors of its import pass too.
    """
    try:
        return import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise  # the package is installed, and one of its own dependencies is not
        raise MissingDependencyError(package, extra) from None
