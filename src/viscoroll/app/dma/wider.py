"""What a wider grid of times would change: modulus, alpha and rolling resistance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...contact_law.assumptions import passage
from ...contact_law.contact import contact
from ...core.array_types import Floats
from ...materials.prony import Prony
from ...scene import Scene
from .choose import grid_of_times
from .spectrum import Data, on_times

#: times and speeds, a decade
_TIMES, _SPEEDS = 2.0, 4


@dataclass(frozen=True, eq=False)
class Wider:
    """Non-negative least squares on the times of a fit and on two a decade that reach further beyond the data.

    decades : by which the grid is wider on either side.
    E, alpha, prony : its long-time modulus, ratio of moduli and series, the latter over the T_ref of the fit.
    V : speeds in R/T_ref times kappa of the fit; the contact there is passed in times that the data hold.
    M, M_fit : kappa M of the wider fit and of the fit, at the same load; kappa is that of the fit.
    """

    decades: float
    E: float
    alpha: float
    prony: Prony
    V: Floats
    M: Floats
    M_fit: Floats

    @property
    def M_change(self) -> float:
        """Largest relative change of M at these speeds; NaN where there are none."""
        return float(np.abs(self.M / self.M_fit - 1.0).max()) if self.V.size else float("nan")


def wider(data: Data, prony: Prony, E: float, T_ref: float, grid: tuple[float, float], decades: float) -> Wider:
    """Strengths on the times of the fit and on a grid that many decades wider on either side, none left out.

    With as few modes as possible those outside the data would be the first to go, though the data allow them.
    """
    reach = 10.0**decades
    times = grid_of_times((max(grid[0] / reach, data.shortest), grid[1] * reach), _TIMES)
    found = on_times(data, np.concatenate([times, prony.tau * T_ref]))
    other = Prony(found.strength / found.E, found.tau / T_ref)
    V, M_fit = _seen(prony, *(rate * T_ref for rate in data.band))
    M = _state(other, float(np.sqrt(found.E / E)), V).M
    return Wider(decades, found.E, other.alpha, other, V, M, M_fit)


def _seen(prony: Prony, slow: float, fast: float) -> tuple[Floats, Floats]:
    """kappa V and kappa M where the contact is passed, V/(lam l0), at a rate between two, over T_ref."""
    low, high = np.log10(slow / np.sqrt(prony.alpha)), np.log10(fast)
    V = np.logspace(low, high, 2 + int(_SPEEDS * (high - low)))
    state = _state(prony, 1.0, V)
    passed = passage(V, state.lam)
    held = (passed >= slow) & (passed <= fast)
    return V[held], state.M[held]


def _state(prony: Prony, kappa: float, V: Floats) -> Any:
    return contact(Scene(material=prony, kappa=kappa, mu=1.0), V, delta=0.0, fields=("lam", "M"))
