"""Why a load has no equilibrium, in one line: :class:`Reasons`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.scale import Scale
from ...core.typed import Integers
from .loads import Loads


class Reasons(NamedTuple):
    """What is needed to say why.

    states : load, V and Q of all that were found, friction sufficing or not.  number : equilibria of each load.
    top : largest kappa M, and its kappa V; NaN with feedback.  elastic : whether nothing resists.  scale : in which it
    is said.
    """

    loads: Loads
    states: tuple[NDArray, NDArray, NDArray]
    number: Integers
    top: tuple[float, float]
    elastic: bool
    scale: Scale

    def text(self) -> Any:
        """One string, or an array of them; empty where there is an equilibrium."""
        shape = self.loads.shape
        found = [self._of(n) if self.number[n] == 0 else "" for n in range(self.number.size)]
        return np.array(found, dtype=object).reshape(shape) if shape else found[0]

    def _of(self, n: int) -> str:
        name, moment, of_load, of_speed = "force + torque", "rolling moment", "", ""
        if self.scale.si:
            name, moment, of_load, of_speed = "force + torque/R", "rolling moment over R", " N/m", " m/s"
        loads = self.loads
        load, speed = (np.broadcast_to(self.scale[of], loads.shape).ravel()[n] for of in ("force", "V"))
        at_rest, mu, kappa = loads.force[n] + loads.torque[n], loads.mu[n], loads.kappa[n]
        total, (of_state, asked) = at_rest * load, self._least(n)
        if asked is not None:
            at = f"at V = {of_state * speed:.6g}{of_speed}"
            if abs(asked) == mu:
                beyond = f"{at} any omega beyond the stick limit is steady"
                return f"a continuum: Q = {asked:.6g} is all of the friction, and {beyond}"
            return f"Q = {asked:.6g} is needed {at}, beyond the friction mu = {mu:.6g}"
        if self.elastic:
            if at_rest == 0.0:
                return "a continuum: elastic bodies roll without resistance, so that any V is steady"
            return f"{name} = {total:.6g}{of_load} is not 0, and elastic bodies roll without resistance"
        M, V = (value / kappa for value in self.top)
        if np.isnan(M):
            return f"{name} with its feedback, {total:.6g}{of_load} at rest, meets the rolling moment at no speed"
        return (
            f"{name} = {total:.6g}{of_load} exceeds the largest {moment} {M * load:.6g}{of_load}"
            f" (at V = {V * speed:.6g}{of_speed})"
        )

    def _least(self, n: int) -> tuple[float, float | None]:
        """V and Q of the state that asks for the least friction; None without."""
        own = self.states[0] == n
        if not own.any():
            return 0.0, None
        V, Q = (each[own] for each in self.states[1:])
        least = int(np.argmin(np.abs(Q)))
        return float(V[least]), float(Q[least])
