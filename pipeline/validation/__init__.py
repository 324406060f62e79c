"""Is what the package computes what the paper's equations say?  :func:`validate` ->
:class:`Report`.

Read in this order: :mod:`states` and :mod:`stresses` (contact law), :mod:`direct_motion` (an
integrator of its own) and :mod:`motions` (what it is for); rows of files are those of ``viscoroll
tables validate``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from viscoroll.tables.law_dataset import Check, Report, check_table

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Check", "Report", "validate"]


def validate(
    tables: tuple[xr.Dataset, ...] = (),
    *,
    states: int = 200_000,
    stress_states: int = 50,
    table_points: int = 100_000,
    times: int = 400,
    seed: int = 0,
    progress: bool = False,
) -> Report:
    """Compare the table method, the stresses, table files and motions with the printed equations.

    Parameters
    ----------
    tables : of :func:`viscoroll.tables.load` or ``build``; each is checked at its nodes and off
    them.
    states : random states at which method "table" meets method "direct".
    stress_states : random states at which the stresses are integrated.
    table_points : random nodes, and as many points between nodes, of each table.
    times : compared times a motion.
    seed : of everything random.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Report
        ``ok``, ``checks``, a printed table by ``str``.

    Raises
    ------
    FileError
        A table that does not state its errors.
    ConvergenceError
        If a direct solve or the comparison's own integrator gives up.

    Notes
    -----
    Each check states the error that it allows; that none passes where the stresses or a table
    are wrong is tested in ``tests/validation/test_validation.py`` and
    ``tests/tables/test_grids.py``.
    """
    from tqdm import tqdm

    from .motions import motion_checks
    from .states import along_motion_checks, random_state_checks
    from .stresses import stress_checks

    parts: list[Callable[[], list[Check]]] = [
        lambda: random_state_checks(states, seed),
        lambda: along_motion_checks(times),
        lambda: stress_checks(stress_states, seed),
        *(lambda table=table: check_table(table, table_points, seed) for table in tables),
        lambda: motion_checks(times),
    ]
    checks = []
    for part in tqdm(parts, desc="validate", delay=1.0, leave=False, disable=not progress):
        checks += part()
    settings = {
        "states": states,
        "stress_states": stress_states,
        "table_points": table_points,
        "times": times,
    }
    return Report(tuple(checks), settings | {"seed": seed})
