"""Old public names: they work for one release, with a warning that names the new one."""

from __future__ import annotations

import warnings

from .errors import caller_level

#: old public name -> new name, of functions of the package
RENAMED = {"humps": "resistance_extrema"}


def warn_renamed(old: str, new: str) -> None:
    """Warn that the public name ``old`` is called ``new`` now."""
    text = f"{old} is called {new} since 0.3.0; the old name will be removed in 0.4.0"
    warnings.warn(text, DeprecationWarning, stacklevel=caller_level())
