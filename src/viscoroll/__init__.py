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
__version__ = "0.2.0"

_HOME = {
    "Scene": "scene",
    "Cylinder": "cylinder",
    "Prony": "materials.prony",
    "Bodies": "materials.bodies",
    "Material": "materials.material",
    "Measured": "materials.measured",
    "WLF": "materials.shift",
    "Arrhenius": "materials.shift",
    "fit_prony": "app.dma",
    "Fit": "app.dma",
    "read_dma": "app.dma",
    "identify": "app.identification",
    "Resistance": "app.identification",
    "Traction": "app.identification",
    "Coastdown": "app.identification",
    "contact": "contact_law.contact",
    "stress": "contact_law.stress",
    "law": "contact_law.bound",
    "load_law": "materials.law_file",
    "Law": "contact_law.bound",
    "steady": "contact_law.equilibria.rolling",
    "humps": "contact_law.equilibria.resistance",
    "validity": "contact_law.judged",
    "Feedback": "core.drive",
    "Schedule": "core.drive",
    "Motion": "motion.one",
    "Ensemble": "motion.many",
    "Steady": "contact_law.equilibria.result",
    "Values": "core.results",
    "Validity": "contact_law.assumptions",
    "roll": "motion.single",
    "ensemble": "motion.batch",
    "ViscorollError": "core.errors",
    "ParameterError": "core.errors",
    "FileError": "core.errors",
    "ConvergenceError": "core.errors",
    "MissingDependencyError": "core.errors",
    "ModelWarning": "core.errors",
    "MotionStatus": "core.errors",
}
_MODULES = {
    "presets": "presets",
    "sampling": "io.sampling",
    "tables": "io.tables",
    "runs": "io.runs",
    "fmu": "app.fmu",
}
__all__ = ["__version__", *_HOME, *_MODULES]  # noqa: PLE0604


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(import_module(f".{_HOME[name]}", __name__), name)
    elif name in _MODULES:
        value = import_module(f".{_MODULES[name]}", __name__)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
