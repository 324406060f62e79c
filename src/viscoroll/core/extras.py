"""Packages that only a part of the work needs: an extra of the installation names them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import MissingDependencyError


def import_extra(module: str, package: str, extra: str) -> Any:
    """A module of ``package``, which ``pip install 'viscoroll[EXTRA]'`` brings along.

    Raises
    ------
    MissingDependencyError
        If it is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if str(error.name).partition(".")[0] != module.partition(".")[0]:
            raise  # it is there, and misses something itself
        raise MissingDependencyError(package, extra) from None
