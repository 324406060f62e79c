"""Driven motions beside LSODA on the saturated law: constant drives, ramps from rest."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr

from ..peers import lsoda
from ..timing import seconds_of

#: this many copies of a motion are rolled at once, and so many times, the least of which counts
_COPIES, _TIMES = 40, 3


class Motion(NamedTuple):
    """A scene, a start, and the first values of force and torque and their slopes over t."""

    scene: vr.Scene
    start: NDArray
    drive: NDArray
    t: NDArray

    def rolled(self, rtol: float, copies: int = 1) -> NDArray:
        """V and omega by the package."""
        end = self.t[-1]
        drive = {name: vr.Schedule([0.0, end], [value, value + slope * end])
                 for name, (value, slope) in zip(("force", "torque"), self.drive.T)}  # fmt: skip
        V0 = np.full(copies, self.start[0])
        e = vr.ensemble(self.scene, V0, self.start[1], self.t, rtol=rtol, threads=1, fields=("V", "omega"), **drive)
        return np.stack([e.V[0], e.omega[0]], axis=1)


def motions(random: np.random.Generator, kind: str, count: int, times: int) -> list[Motion]:
    """Random scenes; "constant": any start and a drive that stays; "rest": from rest; "ramp": from rest and 0."""
    found = []
    for _ in range(count):
        alpha, kappa, mu = (10.0 ** random.uniform([0.0, 0.4, -1.5], [1.5, 1.7, 0.0])).tolist()
        scene, end = vr.Scene(1.0 + alpha, kappa, mu, 1.0, random.uniform(0.3, 1.0)), 10.0 ** random.uniform(0.0, 2.0)
        drive, start = random.normal(size=2) * mu * 0.5, random.normal(size=2) * (kind == "constant")
        pairs = np.array([0.0 * drive, drive / end] if kind == "ramp" else [drive, 0.0 * drive])
        found.append(Motion(scene, start, pairs, np.linspace(0.0, end, times)))
    return found


def driven(sizes: dict[str, Any]) -> dict[str, Any]:
    """Kind -> method -> microseconds a motion (median, 95th percentile, mean) and errors, a row each."""
    random, rows = np.random.default_rng(sizes["seed"]), []
    for kind in ("constant", "rest", "ramp"):
        some = motions(random, kind, sizes["motions"], sizes["times"])
        exact, few = [each.rolled(1e-11) for each in some], some[: sizes["peer_motions"]]
        ours = [_least(partial(each.rolled, sizes["rtol"], _COPIES), _COPIES) for each in some]
        rows.append({"kind": kind, "method": "viscoroll", "rtol": sizes["rtol"]} | _summary(ours, exact))
        # from rest the peer takes seconds a motion and more: its steps shrink with V
        for rtol in sizes["peer_rtol"][: (2 if kind == "constant" else 1) if not lsoda.missing() else 0]:
            theirs = [_least(partial(_by_lsoda, each, rtol)) for each in few]
            rows.append({"kind": kind, "method": "LSODA on the law", "rtol": rtol} | _summary(theirs, exact))
    return {"rows": rows}


def _by_lsoda(motion: Motion, rtol: float) -> NDArray:
    return lsoda.roll(lsoda.given(motion.scene, motion.drive)[None], motion.start[None], motion.t, rtol)[0]


def _least(call: Any, copies: int = 1) -> tuple[float, NDArray]:
    """(Seconds of a motion, V and omega at the times), of several runs where they are quick."""
    found = [seconds_of(call)]
    while len(found) < _TIMES and found[-1][0] < 0.01:
        found.append(seconds_of(call))
    return min(seconds for seconds, _ in found) / copies, found[0][1]


def _summary(taken: list[tuple[float, NDArray]], exact: list[NDArray]) -> dict[str, Any]:
    """Of the times, and of the largest error of each motion over the largest speed so far."""
    us, off = 1e6 * np.array([seconds for seconds, _ in taken]), np.empty(len(taken))
    for n, ((_, found), best) in enumerate(zip(taken, exact)):
        scale = np.maximum.accumulate(np.abs(best).max(axis=1))
        off[n] = (np.abs(found - best).max(axis=1)[1:] / scale[1:]).max()
    good = off[np.isfinite(off)] if np.isfinite(off).any() else np.array([np.inf])
    return {
        "motions": len(taken), "median_us": float(np.median(us)), "p95_us": float(np.quantile(us, 0.95)),
        "mean_us": float(us.mean()), "median_error": float(np.median(good)), "max_error": float(good.max()),
        "failed": int((~np.isfinite(off)).sum()),
    }  # fmt: skip
