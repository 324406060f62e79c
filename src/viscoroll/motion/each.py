"""Outputs of a flow map, which counts time in the material's own unit."""

from __future__ import annotations

from numpy.typing import NDArray

from ..scale import OF_TIME


def to_unit(out: NDArray, fields: tuple[str, ...], unit: float) -> None:
    """Divide each of the fields by what its unit of time asks for, in place."""
    for n, name in enumerate(fields):
        out[n] *= unit ** OF_TIME.get(name, 0)
