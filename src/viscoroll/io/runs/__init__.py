"""Ensembles from a run file: uncertain inputs, blocks of motions, and a results store that a repeated call completes.

Read in this order: :mod:`runfile` (with :mod:`uncertain`, :mod:`inputs` and :mod:`rollers`), :mod:`evaluate`,
:mod:`columns`, :mod:`store` (with :mod:`records` and :mod:`zarr_files`), :mod:`engine`, then
:mod:`estimate`, :mod:`verify`, :mod:`results` and :mod:`export`.
"""

from .engine import run_ensemble
from .estimate import estimate
from .evaluate import roll_inputs
from .export import export_netcdf
from .results import RunResults, open_run
from .runfile import Run, read_run
from .verify import verify

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
