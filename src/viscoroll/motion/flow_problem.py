"""A scene for which a flow map is built: its contact states, and integrated motions in partial slip."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Floats
from ..kernels.flow import layout
from ..kernels.flow.states import states
from ..kernels.motion.records import PARTIAL_SLIP
from .flow_rows import octaves
from .problem import integrate_motions

#: Reason: the rolling resistance exceeds the friction.
STOPS = "the sliding cylinder can reach a steady speed"
#: Reason: a motion of the slow manifold leaves partial slip.
FULL_SLIP_RETURNS = "full slip returns"
#: Reason: a motion of a boundary layer leaves partial slip.
STICK_ENDS = "the cylinder can return from partial slip to full slip"
#: Reason: numbers that are not finite.
OUT_OF_RANGE = "its speeds or times exceed the range of double precision"

#: Octaves of the tables over kappa V.
SPEEDS = octaves(layout.LOW, layout.HIGH)


class NoFlowMap(Exception):
    """The scene has no flow map; the message is the reason."""


class FlowProblem(NamedTuple):
    """A scene for which a map is made.

    parameters : (material, kappa, mu, j).
    law : record of the law's rows.
    slow_rate : rate at which the slow logarithm falls, in units of gamma.
    threads : number of threads.
    """

    parameters: tuple[Any, ...]
    law: Any
    slow_rate: float
    threads: int | None

    def contact_states(self, V: Floats, delta: Floats) -> Floats:
        """Return delta_star, moment, traction and stiffness of the contact at speeds and creepages.

        V, delta : speeds and creepages, dimensionless, of one shape.
        Returns the rows of :mod:`..kernels.flow.states`, each in the shape of V, shape (4, ...).
        """
        _, kappa, mu, _ = self.parameters
        out = np.empty((4, V.size))
        states(np.ascontiguousarray(V).ravel(), np.ascontiguousarray(delta).ravel(), kappa, mu, self.law, out)
        return out.reshape(4, *V.shape)

    def integrate(self, V: Floats, delta: Floats, gamma: Floats, t: Floats, reason: str) -> tuple[Floats, Floats]:
        """Integrate motions in partial slip.

        V, delta : start speeds and creepages, (n,).
        gamma : time scale of each motion, (n,).
        t : output times, common to all.
        reason : message of :class:`NoFlowMap` if a motion leaves partial slip.
        Returns (V, delta), each (n, times).
        """
        if not (np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()):
            raise NoFlowMap(OUT_OF_RANGE)
        starts = V, V * (1.0 + delta)
        (V, _, _, _, delta, regime, *_), _ = integrate_motions(self.parameters, starts, gamma, t, threads=self.threads)
        if not ((regime == PARTIAL_SLIP) & (V > 0.0)).all():
            raise NoFlowMap(reason)
        return V, delta
