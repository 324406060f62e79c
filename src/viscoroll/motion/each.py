"""Outputs of a flow map, which counts time in the material's own unit."""

from __future__ import annotations

from numpy.typing import NDArray

#: how often the unit of time divides a field
_PER_TIME = {"V": 1, "omega": 1} | dict.fromkeys(
    ("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"), 2
)


def to_unit(out: NDArray, fields: tuple[str, ...], unit: float) -> None:
    """Divide each of the fields by what its unit of time asks for, in place."""
    for n, name in enumerate(fields):
        out[n] /= unit ** _PER_TIME.get(name, 0)
