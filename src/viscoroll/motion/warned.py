"""A word where an assumption of the model fails grossly for what is rolled; Python's registry decides on repeats."""

from __future__ import annotations

import math
from bisect import bisect
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from ..contact_law.assumptions import LEAST_KAPPA, NOT_SMALL
from ..contact_law.free_rolling import curve
from ..contact_law.known import say
from ..contact_law.parameters import PARAMETERS, Parameters
from ..contact_law.steadiness import STEADY_LIMIT
from ..materials.bodies import Bodies
from ..materials.cover import Cover
from ..materials.prony import Prony
from .rolling import Begun

#: in full slip: of the axis' speed, and of mu, the share of M that is in doubt then
_CREEP, _SHARE = 1.0, 0.1
#: of kappa M over 1 - 1/alpha at any speed, to a fifth, for one relaxation time (docs/theory.md)
_LARGEST_M = 0.25
#: of a motion that is let go, the share of its way where V is not right to 10 %: all of it where it starts beyond
_SLOW_PART = 0.1
#: (kappa V)^2 over gamma (1 - 1/alpha)/(1 + j) from which on it cannot be more, of any material: (kappa V)^2 |N| is at
#: most 1.35/16 of 1 - 1/alpha (docs/validity.md), and the way grows at least as V
_PLAIN = 1.35 / 16.0 / STEADY_LIMIT / _SLOW_PART**2
#: motions of an ensemble that are looked at
_LOOKED_AT = 256


def look(begun: Begun) -> None:
    """Warn where the model is grossly at fault for motions; in workers never.

    Of one motion from two floats it takes a microsecond or two; of many it looks at some, evenly picked.
    """
    scene, start, driven = begun.scene, (begun.ready.V0, begun.ready.omega0), begun.drive.acts or begun.unsteady
    if type(start[0]) is type(start[1]) is float and not scene.shape:
        material = scene.alpha if scene.material is None else scene.material
        faults = _faults(material, scene.kappa, scene.mu, scene.gamma, scene.j, *start, driven)
    else:
        faults = _faults_of_many(scene, *start, driven)
    say(faults, "motion", "validity() of scene or result")


def _faults(
    material: Any, kappa: float, mu: float, gamma: float, j: float, V0: float, omega0: float, driven: bool
) -> list[str]:
    """Of one motion; ``material``: its alpha, series or bodies."""
    found: list[str] = []
    paper = type(material) is float
    part = 1.0 - 1.0 / (material if paper else material.alpha)
    if kappa < LEAST_KAPPA:
        found.append(NOT_SMALL)
    if abs(omega0 - V0) >= _CREEP * abs(V0) and _LARGEST_M * part > _SHARE * mu * kappa:
        fastest = max(abs(V0), abs(omega0))
        if fastest > 0.0 and (not paper or part * fastest > _SHARE * mu):
            found.append(
                "it starts in full slip at a creep of order 1, where cylinder and half-space pass the contact at "
                "speeds of their own and the rolling moment takes one for both"
            )
    # the speed at the start, or that at which it comes to roll
    u = kappa * max(abs(V0), abs(V0 + j * omega0) / (1.0 + j))
    if not driven and type(material) is not Cover and u > 0.0 and u * u * (1.0 + j) < _PLAIN * gamma * part:
        places, slow = _slow_starts(material, gamma, j)
        if slow[max(bisect(places, u) - 1, 0)]:
            found.append(
                "it is too slow for the law of steady rolling, whose V is off by more than 10 % over a good part of "
                "the way"
            )
    return found


def _faults_of_many(scene: Parameters, V0: Any, omega0: Any, driven: bool) -> list[str]:
    """Of the motions that are worst by bounds, among some."""
    arrays = [np.asarray(value) for value in (*(getattr(scene, name) for name in PARAMETERS), V0, omega0)]
    count = math.prod(np.broadcast_shapes(*(array.shape for array in arrays)))
    some = np.linspace(0, count - 1, min(count, _LOOKED_AT)).astype(np.int64)
    picked = np.array([np.broadcast_to(array, (count,))[some] for array in arrays])
    if not some.size:
        return []
    alpha, kappa, mu, gamma, j, V0, omega0 = picked
    part = 1.0 - 1.0 / alpha
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        u = kappa * np.maximum(np.abs(V0), np.abs(V0 + j * omega0) / (1.0 + j))
        unsteady = np.where(u > 0.0, gamma * part / (1.0 + j) / u**2, 0.0)
        slips = np.where(np.abs(omega0 - V0) >= _CREEP * np.abs(V0), part / (mu * kappa), 0.0)
    found: list[str] = []
    for worst in {int(np.argmax(strain)) for strain in (-kappa, slips, unsteady)}:
        material: Any = scene.material if scene.each is None else scene.each[some[worst]]
        alpha, *own = picked[:, worst].tolist()
        given: list[Any] = [alpha if material is None else material, *own, driven]
        found += _faults(*given)
    return list(dict.fromkeys(found))


@lru_cache(maxsize=64)
def _slow_starts(material: float | Prony | Bodies, gamma: float, j: float) -> tuple[list[float], list[bool]]:
    """kappa V, upward, and whether a good part of the way of what is let go there is too slow for the law."""
    given = {"alpha": material} if isinstance(material, float) else {"material": material}
    free = Parameters(kappa=1.0, mu=1.0, gamma=gamma, j=j, **given).freely(0.0)
    known = curve(free.materials[0])
    assert known is not None  # an elastic one is never slow
    free = replace(free, u=np.exp(known.s))
    slow = free.reach(STEADY_LIMIT).left > _SLOW_PART * free.whole()
    return (free.u * free.speed).tolist(), slow.tolist()
