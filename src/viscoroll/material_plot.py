"""The figure of one material: its master curve and its relaxation."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import OutputError, ParameterError
from .files import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: decades shown beyond the shortest and the longest time
_MARGIN = 2.0
_POINTS = 400


def master_curve(material: Any) -> Figure:
    """E', E'' and tan delta of a :class:`Material` over angular frequency on the left, E(t) on the right.

    Raises
    ------
    ParameterError
        A rigid body: it has no curves.
    """
    if material.is_rigid:
        raise ParameterError("material", "rigid", "one of a finite modulus")
    from matplotlib.figure import Figure

    times = material.T_ref * np.concatenate([material.prony.T, material.prony.tau, [1.0][: not material.prony.E.size]])
    ends = np.log10(times.min()) - _MARGIN, np.log10(times.max()) + _MARGIN
    t = np.logspace(*ends, _POINTS)
    omega = 1.0 / t[::-1]
    figure = Figure(figsize=(9.0, 4.0), dpi=150, layout="constrained")
    figure.suptitle(material.name or "Material", fontsize="medium")
    left, right = figure.subplots(1, 2)
    lines = left.loglog(omega, material.storage(omega), color="black", label="E'")
    if material.prony.E.size:  # an elastic material has none, and no logarithm of it
        lines += left.loglog(omega, material.loss(omega), color="#1f5fa8", linestyle="--", label="E''")
        factor = left.twinx()
        lines += factor.semilogx(omega, material.tan_delta(omega), color="#c8642a", linestyle="-.", label="tan delta")
        factor.set(ylabel="loss factor tan delta", ylim=(0.0, None))
    left.set(xlabel="angular frequency, rad/s", ylabel="storage and loss modulus, Pa")
    left.legend(handles=lines, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize="small")
    right.loglog(t, material.relaxation(t), color="black")
    right.set(xlabel="time, s", ylabel="relaxation modulus E(t), Pa")
    return figure


def save(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure, whole or not at all; the suffix of ``path`` chooses the format.

    Raises
    ------
    OutputError
        If it cannot be written there, or the suffix names no format.
    """
    formats = sorted(figure.canvas.get_supported_filetypes())
    suffix = Path(path).suffix
    if suffix.removeprefix(".").lower() not in formats:
        raise OutputError(path, f"suffix {suffix!r} names no format: must be one of .{', .'.join(formats)}")
    with replacing(path) as temporary:
        figure.savefig(temporary)
