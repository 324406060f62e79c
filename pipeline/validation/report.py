"""Rows of a validation as a dataset."""

from __future__ import annotations

import numpy as np
import xarray as xr

from viscoroll import __version__
from viscoroll.io.tables.check import Report


def report_dataset(report: Report) -> xr.Dataset:
    """One row a check: measured, allowed, passed and meaning over the check's name."""
    described = {
        "check": "name of the check", "measured": "largest difference found", "allowed": "largest difference allowed",
        "meaning": "what differs, in which unit, where", "passed": "1: within what is allowed, 0: beyond",
    }  # fmt: skip
    columns = zip(*((c.name, c.measured, c.allowed, c.meaning, np.int8(c.passed)) for c in report.checks), strict=True)
    data = {
        name: ("check", np.array(values, object if isinstance(values[0], str) else None), {"long_name": text})
        for (name, text), values in zip(described.items(), columns, strict=True)
    }
    about = {
        "Conventions": "CF-1.11",
        "title": "Validation of tables and motions against direct solves of the printed equations",
        "source": f"viscoroll {__version__}",
        "ok": int(report.ok),
    }
    dataset = xr.Dataset(data, attrs=about | report.settings).set_coords("check")
    for name in ("measured", "allowed"):
        dataset[name].attrs["units"] = "1"
    return dataset
