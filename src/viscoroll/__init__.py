"""viscoroll: a viscoelastic cylinder rolling with partial slip on a half-space of its material.

Contact law, tables, motion and ensembles after the paper cited in ``README.md``.  A ``Scene`` is
dimensionless, a ``Cylinder`` in SI units.  Public names are imported at their first use, so that
``import viscoroll`` imports neither numba nor xarray nor matplotlib.
"""

import sys
from collections.abc import Callable
from importlib import import_module
from os.path import splitext
from typing import Any

if sys.version_info < (3, 11):  # noqa: UP036 (a copy that pip did not install)
    raise ImportError("viscoroll needs Python 3.11 or newer, this is " + sys.version.split()[0])

#: Version of the package; its metadata are made from this line.
__version__ = "0.4.0"


def _read_modules(file: str) -> dict[str, str]:
    """Return a dict from each name of a package to the module that defines it, as ".scene"; "." for
    a module.

    file: path of the ``__init__.py`` of the package.

    They are read from ``__init__.pyi``, which type checkers and editors read too, so that they are
    listed once.
    """
    with open(splitext(file)[0] + ".pyi", encoding="utf-8") as stub:
        # lines as "from .scene import Scene as Scene": from, module, import, name
        return {
            name: module
            for _, module, _, name, *_ in (line.split() for line in stub if line.startswith("from"))
        }


def _open_room(room: str, file: str) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a room, a subpackage whose names are imported at their first
    use: Python calls it for a name that it does not find; it imports the name and keeps it there.

    room: full name of the subpackage, as "viscoroll.core", its ``__name__``.
    file: path of its ``__init__.py``, beside which ``__init__.pyi`` lists the names.
    The function raises AttributeError for a name that ``__init__.pyi`` does not list.
    """
    modules = _read_modules(file)

    def find(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        value = getattr(import_module(modules[name], room), name)
        setattr(sys.modules[room], name, value)
        return value

    return find


_MODULES = _read_modules(__file__)
__all__ = ["__version__", *_MODULES]  # noqa: PLE0604


def __getattr__(name: str) -> Any:
    """Import a public name of the package at its first use: Python calls this for a name that it
    does not find.

    name: the name that was looked up in the package.
    Returns the public object, and keeps it under its name.
    Raises AttributeError for a name that is not public, ImportError where a package that its module
    needs is missing.
    """
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .core import suggest_arguments

    path = _MODULES[name]
    home = import_module(f".{name}" if path == "." else path, __name__)
    for each, module in _MODULES.items():  # a result has a class that nobody asked for by name
        if loaded := sys.modules.get(__name__ + module.rstrip(".")):
            suggest_arguments(loaded, (each,))
    value = globals()[name] = home if path == "." else getattr(home, name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
