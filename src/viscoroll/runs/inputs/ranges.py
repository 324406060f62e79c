"""What each input of a run may be, and in which unit."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...materials.prony_forms import HIGHEST_ALPHA


class Range(NamedTuple):
    """What an input may be: [low, high], without ``low`` itself where ``strict``; None: no default."""

    low: float = -math.inf
    strict: bool = False
    high: float = math.inf
    unit: str = "1"
    default: float | None = None

    def holds(self, value: float) -> bool:
        """Whether a number is inside; NaN and infinity never are."""
        return math.isfinite(value) and (self.low < value if self.strict else self.low <= value) and value <= self.high

    def __str__(self) -> str:
        if self.low == -math.inf:
            return "a finite number"
        return f"{'>' if self.strict else '>='} {self.low:g}" + ("" if self.high == math.inf else f", <= {self.high:g}")


def positive(unit: str = "1", default: float | None = None) -> Range:
    """Any number above 0."""
    return Range(0.0, True, unit=unit, default=default)


SCENE = {
    "alpha": Range(1.0, high=HIGHEST_ALPHA),
    "kappa": positive(),
    "mu": positive(),
    "gamma": positive(),
    "j": positive(default=0.5),
}
CYLINDER = {
    "R": positive("m"),
    "m": positive("kg/m"),
    "E": positive("Pa"),
    "nu": Range(-1.0, True, 0.5),
    "T_epsilon": positive("s"),
    "T_sigma": positive("s"),
    "mu": positive(),
    "j": positive(default=0.5),
    "g": positive("m/s^2", default=9.81),
    "load": positive("N/m"),
}
#: what a section [material] says in their place, and what a cylinder may go without
SOLID, OPTIONAL = ("E", "nu", "T_epsilon", "T_sigma"), ("load",)
START = {"V0": Range(-1e100, high=1e100), "omega0": Range(-1e100, high=1e100)}
START_SI = {"V0": START["V0"]._replace(unit="m/s"), "omega0": START["omega0"]._replace(unit="rad/s")}
_STEEP = math.nextafter(0.5 * math.pi, 0.0)
DRIVE = {
    "force": Range(), "torque": Range(), "brake": Range(0.0), "slope": Range(-_STEEP, high=_STEEP, unit="rad"),
    "V": START["V0"], "omega": START["omega0"],
}  # fmt: skip
DRIVE_SI = {
    "force": Range(unit="N/m"), "torque": Range(unit="N m/m"), "brake": Range(0.0, unit="N m/m"),
    "slope": DRIVE["slope"], "V": START_SI["V0"], "omega": START_SI["omega0"],
}  # fmt: skip
#: times of a drive
TIME = Range(0.0)
#: strengths and times of a series, by the name of a list of them in a file
MODES = {"E": Range(0.0), "tau": positive(), "J": Range(0.0, high=1.0), "T": positive()}
#: sections of bodies, and what the names of their inputs begin with
PREFIXES = {"material": "", "base": "base_"}
