"""A word, once a process, where an assumption of the model fails grossly for what is rolled."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..errors import ModelWarning
from ..kernels.compile.notice import is_worker
from ..scene import Scene
from ..validity import NOT_THIS_MOTION, WAVE_LIMIT

#: kappa at which the contact at rest reaches half a radius from the axis
_LEAST_KAPPA = 1.0
#: in full slip: of the axis' speed, and of mu, the share of M that is in doubt then
_CREEP, _SHARE = 1.0, 0.1
#: of kappa M over 1 - 1/alpha at any speed, to a fifth, for one relaxation time (docs/theory.md)
_LARGEST_M = 0.25
#: calls that are looked at: a look takes some 30 microseconds, and the first call of a process a second
_CALLS = 32

_looked = 0


def look(scene: Scene, V0: Any, omega0: Any, *, waves: float = 0.0) -> None:
    """Warn of the first motions that are rolled where the model is grossly at fault; in workers never.

    All of it is estimated from the scene and the start without a kernel; ``validity`` tells more.

    waves : the largest speed over that of shear waves, where it is known.
    """
    global _looked
    if not is_looking():
        return
    _looked += 1
    faults = [*_of_scene(scene), *_of_start(scene, V0, omega0)]
    if waves > 1.0:
        faults.append(f"speeds are {waves:.2g} times those of shear waves (up to {WAVE_LIMIT:g} counts as slow)")
    if faults:
        _looked = _CALLS
        text = "the model is not good for this motion: " + "; ".join(faults) + ".  See validity() of scene or result"
        warnings.warn(text, ModelWarning, stacklevel=outside())


def is_looking() -> bool:
    """Whether the next motion is looked at."""
    return _looked < _CALLS and not is_worker()


def _of_scene(scene: Scene) -> list[str]:
    """nu and kappa."""
    least = np.min(scene.kappa, initial=np.inf)
    faults = []
    # max|N| over all speeds is at least that of slow rolling, sum E tau^2
    nu = float(np.max(scene.gamma * _slow_N(scene) / (1.0 + np.asarray(scene.j)), initial=0.0))
    if nu > NOT_THIS_MOTION:
        faults.append(
            f"nu = gamma max|N|/(1 + j) is {nu:.2g} or more, and beyond {NOT_THIS_MOTION:g} the law of steady rolling "
            "does not give the motion of a cylinder, which rocks in its own imprint"
        )
    if least < _LEAST_KAPPA:
        faults.append(f"kappa = R/l0 = {least:.2g}: the contact at rest is longer than the radius")
    return faults


def _slow_N(scene: Scene) -> Any:
    """|N| of slow rolling, sum E_i tau_i^2 over T_ref^2; of one relaxation time (alpha - 1)/alpha^2."""
    if scene.series is not None:
        return scene.series.second_moments[0]
    alpha = np.asarray(scene.alpha)
    return (alpha - 1.0) / alpha**2 if scene.material is None else np.zeros(alpha.shape)


def _of_start(scene: Scene, V0: Any, omega0: Any) -> list[str]:
    """A creep of order 1 in full slip, where M, which takes one speed for both bodies, is no small part of mu."""
    if V0 is None or omega0 is None:
        return []
    V, omega = np.broadcast_arrays(np.asarray(V0, np.float64), np.asarray(omega0, np.float64))
    fastest = np.maximum(np.abs(V), np.abs(omega))
    slips = np.abs(omega - V) >= _CREEP * np.abs(V)
    part = 1.0 - 1.0 / np.asarray(scene.alpha)
    with np.errstate(over="ignore", invalid="ignore"):
        M = (
            np.minimum(part * fastest, _LARGEST_M * part / scene.kappa)
            if scene.material is None
            else _LARGEST_M * (part / scene.kappa)
        )
        doubtful = slips & (fastest > 0.0) & (M > _SHARE * np.asarray(scene.mu))
    if not np.any(doubtful):
        return []
    return [
        "it starts in full slip at a creep of order 1, where cylinder and half-space pass the contact at speeds of "
        "their own and the rolling moment takes one for both"
    ]


def outside() -> int:
    """Frames up to the first one that is not of this package."""
    import sys

    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "viscoroll":
        depth, frame = depth + 1, frame.f_back
    return depth
