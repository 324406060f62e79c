"""Foundations of all layers: errors, checks, units, results and their labels, files, figures.

Arguments enter through :mod:`.checks` and :mod:`.quantities`, which give float64 in the unit of the
argument or raise an exception of :mod:`.errors`.  :mod:`.scale` has the unit and the symbol of
every quantity.  Results leave through :mod:`.results`, :mod:`.labels` and :mod:`.plots`, files
through :mod:`.files`; :mod:`.blocks` divides arrays among threads.

Other rooms import names of its modules, but for :mod:`.toml_sections` and :mod:`.plots`, from the
room, which imports the module of a name at its first use: errors alone import no numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .. import _read_modules

_MODULES = _read_modules(__file__)


def __getattr__(name: str) -> Any:
    """Import a name of the room at its first use: Python calls this for a name that it does not
    find.

    name: the name that was looked up in the room.
    Returns the object, and keeps it under its name.
    Raises AttributeError for a name that ``__init__.pyi`` does not list.
    """
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_MODULES[name], __name__), name)
    return value
