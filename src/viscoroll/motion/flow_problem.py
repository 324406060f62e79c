"""A scene for which a flow map is built: its contact states, and integrated motions in partial slip.

A flow map is a set of tables from which any free motion of a scene follows without integration.  All is dimensionless.
"""

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

    parameters : (material, kappa, mu, j), numbers; the material is alpha, or a :class:`Prony` series in its own unit of
    time.
    law : the kernels' record of the contact law of the material.
    slow_rate : rate at which ln V falls at low speeds, in units of gamma, > 0.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores available.
    """

    parameters: tuple[Any, ...]
    law: Any
    slow_rate: float
    threads: int | None

    def contact_states(self, V: Floats, delta: Floats) -> Floats:
        """Return critical creepage, moment, traction and its slope at speeds and creepages inside the stick zone.

        V, delta : speeds, > 0, and creepages, |delta| < delta_star, dimensionless, of one shape.
        Returns (4, ...), dimensionless, in this order, each in the shape of V: delta_star, M, Q with the sign of delta
        (0 at delta = 0), dQ/d delta at fixed V; :mod:`..kernels.flow.states` names the indices.
        """
        _, kappa, mu, _ = self.parameters
        out = np.empty((4, V.size))
        states(np.ascontiguousarray(V).ravel(), np.ascontiguousarray(delta).ravel(), kappa, mu, self.law, out)
        return out.reshape(4, *V.shape)

    def integrate(self, V: Floats, delta: Floats, gamma: Floats, t: Floats, reason: str) -> tuple[Floats, Floats]:
        """Integrate motions that start and stay in partial slip, or start just before its onset.

        V, delta : start speeds, > 0 (not checked), and creepages, (n,), n >= 1, dimensionless.
        gamma : ratio of the load to inertia, which sets the time scale, of each motion, > 0, (n,) or (1,).
        t : output times since the start, >= 0, ascending, (times,), common to all, dimensionless; the tables count the
        time gamma t, so that t is the time of the tables divided by the gamma of each motion.
        reason : message of :class:`NoFlowMap` if a motion is not in partial slip with V > 0 at an output time.
        Raises :class:`NoFlowMap` for this reason, which includes motions that could not be integrated to the end; and
        for OUT_OF_RANGE if V, delta, gamma, their product or t is not finite, or gamma is not positive.
        Returns (V, delta), each (n, times), dimensionless.
        """
        if not (np.isfinite(V * delta * gamma).all() and (gamma > 0.0).all() and np.isfinite(t).all()):
            raise NoFlowMap(OUT_OF_RANGE)
        starts = V, V * (1.0 + delta)
        (V, _, _, _, delta, regime, *_), _ = integrate_motions(self.parameters, starts, gamma, t, threads=self.threads)
        if not ((regime == PARTIAL_SLIP) & (V > 0.0)).all():
            raise NoFlowMap(reason)
        return V, delta
