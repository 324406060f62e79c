"""Why a load has no equilibrium, in one line: :class:`Reasons`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scale import DIMENSIONLESS, Scale
from .loads import Loads


@dataclass(frozen=True, eq=False)
class Reasons:
    """What is needed to say why; vectors over the loads of a call.

    shape : of the call.  count : equilibria.  total : force + torque at rest.  traction, speed : of the state that asks
    for the least friction, NaN where there is none.  mu : friction.  top : largest M, and its V; NaN with feedback.
    elastic : whether nothing resists.  scale : in which it is said.
    """

    shape: tuple[int, ...]
    count: NDArray[np.int64]
    total: NDArray[np.float64]
    traction: NDArray[np.float64]
    speed: NDArray[np.float64]
    mu: NDArray[np.float64]
    top: tuple[NDArray[np.float64], NDArray[np.float64]]
    elastic: bool
    scale: Scale = DIMENSIONLESS

    def text(self) -> Any:
        """One string, or an array of them; empty where there is an equilibrium."""
        found = [self._of(n) if self.count[n] == 0 else "" for n in range(self.count.size)]
        return np.array(found, dtype=object).reshape(self.shape) if self.shape else found[0]

    def _of(self, n: int) -> str:
        name, moment, of_load, of_speed = "force + torque", "rolling moment", "", ""
        if self.scale.si:
            name, moment, of_load, of_speed = "force + torque/R", "rolling moment over R", " N/m", " m/s"
        load, speed = (np.broadcast_to(self.scale[of], self.shape).ravel()[n] for of in ("force", "V"))
        total, needed, mu = self.total[n] * load, self.traction[n], self.mu[n]
        if not np.isnan(needed):
            at = f"at V = {self.speed[n] * speed:.6g}{of_speed}"
            if abs(needed) == mu:
                beyond = f"{at} any omega beyond the stick limit is steady"
                return f"a continuum: Q = {needed:.6g} is all of the friction, and {beyond}"
            return f"Q = {needed:.6g} is needed {at}, beyond the friction mu = {mu:.6g}"
        if self.elastic:
            if self.total[n] == 0.0:
                return "a continuum: elastic bodies roll without resistance, so that any V is steady"
            return f"{name} = {total:.6g}{of_load} is not 0, and elastic bodies roll without resistance"
        M, V = (values[n] for values in self.top)
        if np.isnan(M):
            return f"{name} with its feedback, {total:.6g}{of_load} at rest, meets the rolling moment at no speed"
        return (
            f"{name} = {total:.6g}{of_load} exceeds the largest {moment} {M * load:.6g}{of_load}"
            f" (at V = {V * speed:.6g}{of_speed})"
        )


def reasons_of(loads: Loads, number: NDArray, states: Any, top: tuple[float, float], elastic: bool) -> Reasons:
    """From the states that were found, friction sufficing or not.

    number : equilibria of each load.  top : kappa M and kappa V at the largest M, NaN with feedback.
    """
    traction, speed = np.full(number.size, np.nan), np.full(number.size, np.nan)
    without = np.flatnonzero(number[states.load] == 0)
    asked = without[np.argsort(-np.abs(states.Q[without]), kind="stable")]  # the least is written last
    traction[states.load[asked]], speed[states.load[asked]] = states.Q[asked], states.V[asked]
    total = loads.force + loads.torque
    return Reasons(
        loads.shape, number, total, traction, speed, loads.mu, (top[0] / loads.kappa, top[1] / loads.kappa), elastic
    )
