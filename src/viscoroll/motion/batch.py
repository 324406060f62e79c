"""Many motions at once: :func:`ensemble` and its result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..blocks import run_blocks
from ..errors import MOTION_STATUS, MotionStatus, ParameterError
from ..rolling_contact import flattened
from ..scene import Scene, broadcast_shape
from .checks import controls, output_times, start_speed

if TYPE_CHECKING:
    import xarray as xr

FIELDS = ("V", "omega", "x", "angle", "delta", "regime")
_PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
_BLOCK = 64


@dataclass(frozen=True)
class Ensemble:
    """Motions 0 ... n - 1 at common output times; everything dimensionless.

    Attributes
    ----------
    t : output times.
    V, omega, x, angle, delta, regime : shape (n, len(t)); those not asked for are None.
    onset_time : (n,), first change from full to partial slip; NaN if there is none.
    rest_time : (n,), when max(|V|, |omega|) fell below ``rest``; NaN if it did not.
    status : (n,), a :class:`MotionStatus` each; outputs a motion did not reach are NaN.
    switches, steps : (n,), changes of regime, and integration steps taken.
    """

    scene: Scene
    V0: NDArray[np.float64]
    omega0: NDArray[np.float64]
    t: NDArray[np.float64]
    V: NDArray[np.float64] | None
    omega: NDArray[np.float64] | None
    x: NDArray[np.float64] | None
    angle: NDArray[np.float64] | None
    delta: NDArray[np.float64] | None
    regime: NDArray[np.float64] | None
    onset_time: NDArray[np.float64]
    rest_time: NDArray[np.float64]
    status: NDArray[np.int8]
    switches: NDArray[np.int64]
    steps: NDArray[np.int64]

    def __len__(self) -> int:
        return self.status.size

    def messages(self) -> dict[str, int]:
        """How many motions ended in which way, in words."""
        codes, counts = np.unique(self.status, return_counts=True)
        return {MOTION_STATUS[MotionStatus(code)]: int(n) for code, n in zip(codes, counts, strict=True)}

    def summary(self, quantiles: Iterable[float] = (0.05, 0.25, 0.5, 0.75, 0.95)) -> xr.Dataset:
        """Mean, standard deviation and quantiles over the motions, per output time."""
        from .export import summary_dataset

        return summary_dataset(self, tuple(quantiles))

    def to_xarray(self) -> xr.Dataset:
        """Dataset over (motion, t) with starts, outputs, onset and status."""
        from .export import ensemble_dataset

        return ensemble_dataset(self)


def ensemble(
    scene: Scene,
    V0: ArrayLike,
    omega0: ArrayLike,
    t: ArrayLike,
    *,
    rtol: float = 1e-8,
    rest: float | None = None,
    fields: Iterable[str] = ("V", "omega", "x"),
    max_steps: int = 100_000,
    threads: int | None = None,
    progress: bool = False,
) -> Ensemble:
    """Roll n motions; each as :func:`roll` would, bit for bit, for any number of threads.

    Parameters
    ----------
    scene : its fields may be arrays of n too: every motion can have a scene of its own.
    V0, omega0 : start speeds, scalars or arrays (n,).
    t : output times, ascending, common to all; one number: the final state only.
    rtol, rest, max_steps : as for :func:`roll`.
    fields : out of ``V omega x angle delta regime``; only these are kept in memory.
    threads : threads to use; default ``$VISCOROLL_THREADS`` or the cores available.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Ensemble

    Raises
    ------
    ParameterError
        NaN or infinite input, unsorted times, shapes that do not broadcast to (n,),
        unknown fields.
    """
    times = output_times(t)
    names = (fields,) if isinstance(fields, str) else tuple(fields)
    for name in names:
        if name not in FIELDS:
            raise ParameterError("fields", repr(name), "out of " + ", ".join(FIELDS))
    rtol, threshold, max_steps = controls(rtol, rest, max_steps)
    arrays: dict[str, NDArray] = {name: np.asarray(getattr(scene, name)) for name in _PARAMETERS}
    arrays |= {"V0": start_speed("V0", V0), "omega0": start_speed("omega0", omega0)}
    shape = broadcast_shape(**arrays)
    if len(shape) > 1:
        raise ParameterError("V0, omega0", f"arrays of shape {shape}", "scalars or vectors (n,)")
    count = shape[0] if shape else 1
    flat = [flattened(array, (count,)) for array in arrays.values()]
    rows = np.array([FIELDS.index(name) for name in names], dtype=np.int64)
    out = np.empty((len(names), count, times.size))
    info = np.empty((count, 5))

    def work(start: int, stop: int) -> None:
        from ..kernels.motion_loop import motion_loop

        motion_loop(*flat, times, rtol, threshold, max_steps, rows, out, info, start, stop)

    run_blocks(work, count, _BLOCK, threads=threads, progress="motions" if progress else None)
    kept: dict[str, Any] = dict.fromkeys(FIELDS) | dict(zip(names, out, strict=True))
    return Ensemble(
        scene, np.broadcast_to(arrays["V0"], (count,)), np.broadcast_to(arrays["omega0"], (count,)), times, **kept,
        onset_time=info[:, 3].copy(), rest_time=info[:, 4].copy(), status=info[:, 0].astype(np.int8),
        switches=info[:, 2].astype(np.int64), steps=info[:, 1].astype(np.int64),
    )  # fmt: skip
