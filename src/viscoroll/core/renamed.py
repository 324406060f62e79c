"""Old public names, which work for one release and warn with the new name."""

from __future__ import annotations

import warnings

from .errors import caller_level

#: Old public name of a function of the package -> new name.
RENAMED = {"humps": "resistance_extrema"}


def warn_renamed(old: str, new: str) -> None:
    """Warn that the public name ``old`` is replaced by ``new``."""
    text = f"{old} is called {new} since 0.3.0; the old name will be removed in 0.4.0"
    warnings.warn(text, DeprecationWarning, stacklevel=caller_level())
