"""viscoroll: a viscoelastic cylinder rolling with partial slip on a half-space of its material.

Contact law, tables, motion and ensembles after the paper cited in ``README.md``.  A
``Scene`` is dimensionless, a ``Cylinder`` in SI units.  Names load on first use: importing the package
imports neither numba nor xarray nor matplotlib.
"""

from __future__ import annotations

import sys
from importlib import import_module
from os.path import splitext
from typing import Any

if sys.version_info < (3, 11):  # noqa: UP036 (a copy that pip did not install)
    raise ImportError("viscoroll needs Python 3.11 or newer, this is " + sys.version.split()[0])

#: the one place of it: the metadata of the package are made from this line
__version__ = "0.2.0"


def _homes() -> dict[str, str]:
    """Where each public name is imported from, as ``__init__.pyi`` tells type checkers and editors."""
    with open(splitext(__file__)[0] + ".pyi", encoding="utf-8") as stub:
        return {name: home for _, home, _, name, *_ in (line.split() for line in stub if line.startswith("from"))}


_HOMES = _homes()
__all__ = ["__version__", *_HOMES]  # noqa: PLE0604


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        from .core.renamed import RENAMED, warn_renamed

        if name in RENAMED:
            warn_renamed(f"viscoroll.{name}", RENAMED[name])
            return getattr(sys.modules[__name__], RENAMED[name])
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if (home := _HOMES[name]) == ".":
        value = import_module(f".{name}", __name__)
    else:
        value = getattr(__import__(home[1:], globals(), fromlist=[name], level=1), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
