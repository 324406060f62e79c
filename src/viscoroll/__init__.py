"""viscoroll: a viscoelastic cylinder rolling with partial slip on a half-space of its material.

Contact law, tables, motion and ensembles after the paper cited in ``README.md``.  Everything
is dimensionless unless its name says SI.  Names load on first use: importing the package
imports neither numba nor xarray nor matplotlib.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

if sys.version_info < (3, 11):  # noqa: UP036 (a copy that pip did not install)
    raise ImportError("viscoroll needs Python 3.11 or newer, this is " + sys.version.split()[0])

#: the one place of it: the metadata of the package are made from this line
__version__ = "0.1.0"

_HOME = {
    "Scene": "scene",
    "Cylinder": "cylinder",
    "Prony": "materials.prony",
    "Bodies": "materials.bodies",
    "Material": "materials.material",
    "Measured": "materials.measured",
    "WLF": "materials.shift",
    "Arrhenius": "materials.shift",
    "fit_prony": "dma",
    "Fit": "dma",
    "read_dma": "dma",
    "identify": "identification",
    "Resistance": "identification",
    "Traction": "identification",
    "Coastdown": "identification",
    "contact": "rolling_contact",
    "stress": "contact_stress",
    "law": "bound_law",
    "load_law": "materials.law_file",
    "Law": "bound_law",
    "steady": "equilibria",
    "humps": "equilibria",
    "validity": "judged",
    "Feedback": "drive",
    "Schedule": "drive",
    "Motion": "motion.one",
    "Ensemble": "motion.many",
    "Steady": "equilibria",
    "Values": "results",
    "Validity": "assumptions",
    "roll": "motion",
    "ensemble": "motion",
    "ViscorollError": "errors",
    "ParameterError": "errors",
    "FileError": "errors",
    "ConvergenceError": "errors",
    "MissingDependencyError": "errors",
    "ModelWarning": "errors",
    "MotionStatus": "errors",
}
_SUBPACKAGES = ("presets", "sampling", "tables")
__all__ = ["__version__", *_HOME, *_SUBPACKAGES]  # noqa: PLE0604


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(import_module(f".{_HOME[name]}", __name__), name)
    elif name in _SUBPACKAGES:
        value = import_module(f".{name}", __name__)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
