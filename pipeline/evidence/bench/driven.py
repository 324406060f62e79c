"""Driven motions beside LSODA on the saturated law: constant drives, ramps from rest."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr

from ..peers import lsoda_driven as peer
from ..timing import seconds_of

#: this many copies of a motion are rolled at once, and so many times, the least of which counts
_COPIES, _TIMES = 40, 3


class Motion(NamedTuple):
    """A scene, a start, and force and torque with their slopes over t."""

    scene: vr.Scene
    start: NDArray
    force: tuple[float, float]
    torque: tuple[float, float]
    t: NDArray

    def drive(self) -> dict[str, Any]:
        """As the package takes it."""
        end = self.t[-1]
        pairs = {"force": self.force, "torque": self.torque}
        return {name: vr.Schedule([0.0, end], [value, value + slope * end]) for name, (value, slope) in pairs.items()}

    def par(self) -> NDArray:
        """As the peer takes it."""
        s = self.scene
        return np.array([s.alpha, s.kappa, s.mu, s.j, *self.force, *self.torque])


def motions(random: np.random.Generator, kind: str, count: int, times: int) -> list[Motion]:
    """Random scenes; "constant": any start and a drive that stays; "rest": from rest; "ramp": from rest and 0."""
    found = []
    for _ in range(count):
        scene = vr.Scene(
            1.0 + 10.0 ** random.uniform(0.0, 1.5), 10.0 ** random.uniform(0.4, 1.7), 10.0 ** random.uniform(-1.5, 0.0),
            1.0, random.uniform(0.3, 1.0),
        )  # fmt: skip
        end, drive = 10.0 ** random.uniform(0.0, 2.0), random.normal(size=2) * scene.mu * 0.5
        start = random.normal(size=2) if kind == "constant" else np.zeros(2)
        slopes, first = (drive / end, np.zeros(2)) if kind == "ramp" else (np.zeros(2), drive)
        pairs = list(zip(first.tolist(), slopes.tolist(), strict=True))
        found.append(Motion(scene, start, pairs[0], pairs[1], np.linspace(0.0, end, times)))
    return found


def driven(sizes: dict[str, Any]) -> dict[str, Any]:
    """Kind -> method -> microseconds a motion (median, 95th percentile, mean) and errors, a row each."""
    random, rows = np.random.default_rng(sizes["seed"]), []
    for kind in ("constant", "rest", "ramp"):
        some = motions(random, kind, sizes["motions"], sizes["times"])
        # from rest the peer takes seconds a motion and more: its steps shrink with V
        tolerances = sizes["peer_rtol"] if kind == "constant" else sizes["peer_rtol"][:1]
        methods = {"viscoroll": [sizes["rtol"]], "LSODA, saturated law": tolerances if peer.INSTALLED else []}
        exact = [_exact(each) for each in tqdm(some, desc=kind, leave=False)]
        for method, asked in methods.items():
            for rtol in asked:
                ours = method == "viscoroll"
                few = some if ours else some[: sizes["peer_motions"]]  # it takes seconds for a ramp from rest
                taken = [(_ours if ours else _peers)(each, rtol) for each in few]
                row = {"kind": kind, "method": method, "rtol": rtol, "motions": len(few)}
                rows.append(row | _summary(taken, exact[: len(few)]))
    return {"rows": rows}


def _summary(taken: list[tuple[float, NDArray]], exact: list[NDArray]) -> dict[str, float]:
    """Of the times, and of the largest error of each motion over the largest speed so far."""
    us = 1e6 * np.array([seconds for seconds, _ in taken])
    off = np.array([_error(found, best) for (_, found), best in zip(taken, exact, strict=True)])
    good = off[np.isfinite(off)] if np.isfinite(off).any() else np.array([np.inf])
    return {
        "median_us": float(np.median(us)), "p95_us": float(np.quantile(us, 0.95)), "mean_us": float(us.mean()),
        "median_error": float(np.median(good)), "max_error": float(good.max()),
        "failed": int((~np.isfinite(off)).sum()),
    }  # fmt: skip


def _error(found: NDArray, best: NDArray) -> float:
    scale = np.maximum.accumulate(np.abs(best).max(axis=1))
    return float((np.abs(found - best).max(axis=1)[1:] / scale[1:]).max())


def _exact(motion: Motion) -> NDArray:
    """V and omega at a tight tolerance."""
    m = vr.roll(motion.scene, *motion.start, motion.t, rtol=1e-11, **motion.drive())
    return np.stack([m.V, m.omega], axis=1)


def _ours(motion: Motion, rtol: float) -> tuple[float, NDArray]:
    """(Seconds, V and omega at the times) by the package, a motion's share of many copies at once."""

    def roll() -> vr.Ensemble:
        return vr.ensemble(
            motion.scene, np.full(_COPIES, motion.start[0]), motion.start[1], motion.t, rtol=rtol, threads=1,
            fields=("V", "omega"), **motion.drive(),
        )  # fmt: skip

    found = [seconds_of(roll, collect=False) for _ in range(_TIMES)]
    e = found[0][1]
    return min(seconds for seconds, _ in found) / _COPIES, np.stack([e.V[0], e.omega[0]], axis=1)


def _peers(motion: Motion, rtol: float) -> tuple[float, NDArray]:
    """(Seconds, V and omega at the times) by the peer."""
    best = np.inf
    for _ in range(_TIMES):
        seconds, (found, _) = seconds_of(lambda: peer.roll(motion.par(), motion.start, motion.t, rtol), collect=False)
        best = min(best, seconds)
        if seconds > 0.01:  # nothing that a second run would change
            break
    return best, found
