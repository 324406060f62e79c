"""Ensembles from a run file: uncertain inputs, blocks of motions, and a results store.

A repeated call completes the store.

A TOML file enters :func:`read_run` (:mod:`.runfile`, :mod:`.uncertain_inputs`,
:mod:`.run_rollers`).  :mod:`.run_engine` evaluates its blocks (:mod:`.run_store`) and writes them
to a store (:mod:`.run_store`, :mod:`.run_records`).  Results leave through :func:`open_run`,
:func:`export_netcdf` and Sobol indices (:mod:`.sensitivity`).
"""

from .run_engine import estimate, run_ensemble
from .run_results import RunResults, export_netcdf, open_run, verify
from .run_store import roll_inputs
from .runfile import Run, read_run

__all__ = [
    "Run",
    "RunResults",
    "estimate",
    "export_netcdf",
    "open_run",
    "read_run",
    "roll_inputs",
    "run_ensemble",
    "verify",
]
