"""Rows of a validation and what they add up to: text, dataset, verdict."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import __version__

if TYPE_CHECKING:
    import xarray as xr


class Check(NamedTuple):
    """A largest difference, and what is allowed; ``meaning`` says of what, in which unit, and where."""

    name: str
    measured: float
    allowed: float
    meaning: str

    @property
    def passed(self) -> bool:
        """Whether the difference is within what is allowed; a NaN is not."""
        return bool(self.measured <= self.allowed)


@dataclass(frozen=True)
class Report:
    """All checks of a :func:`viscoroll.validation.validate`, and the settings it ran with."""

    checks: tuple[Check, ...]
    settings: dict[str, int]

    @property
    def ok(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    def __str__(self) -> str:
        width = max(len(check.name) for check in self.checks)
        head = f"{'check':<{width}}  measured   allowed            of what"
        lines = [
            f"{c.name:<{width}} {c.measured:9.2e} {c.allowed:9.2e}  {'ok' if c.passed else 'EXCEEDED':<8}  {c.meaning}"
            for c in self.checks
        ]
        failed = sum(not check.passed for check in self.checks)
        verdict = "every difference is within what is allowed" if self.ok else f"{failed} beyond what is allowed"
        settings = ", ".join(f"{name} {value}" for name, value in self.settings.items())
        foot = ["", f"{len(self.checks)} checks: {verdict}.", f"viscoroll {__version__}; {settings}"]
        return "\n".join([head, *lines, *foot])


def report_dataset(report: Report) -> xr.Dataset:
    """One row a check: measured, allowed, passed and meaning over the check's name."""
    import xarray as xr

    columns = {
        "measured": (np.array([c.measured for c in report.checks]), "largest difference found"),
        "allowed": (np.array([c.allowed for c in report.checks]), "largest difference allowed"),
        "passed": (np.array([c.passed for c in report.checks], dtype=np.int8), "1: within what is allowed, 0: beyond"),
        "meaning": (np.array([c.meaning for c in report.checks], dtype=object), "what differs, in which unit, where"),
    }
    data = {
        name: ("check", values, {"long_name": text} | ({"units": "1"} if name in ("measured", "allowed") else {}))
        for name, (values, text) in columns.items()
    }
    names = np.array([c.name for c in report.checks], dtype=object)
    return xr.Dataset(
        data,
        coords={"check": ("check", names, {"long_name": "name of the check"})},
        attrs={
            "Conventions": "CF-1.11",
            "title": "Validation of tables and motions against direct solves of the printed equations",
            "source": f"viscoroll {__version__}",
            "ok": int(report.ok),
        }
        | report.settings,
    )
