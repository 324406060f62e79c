"""Steady rolling with pressure and shear solved together: :class:`CoupledPair` and its states at one speed.

Everything is dimensionless.  Lengths are divided by l0, the contact length at rest of half-spaces, kappa = R/l0,
u = kappa |V|, forces over the load P and moments over P R.  Creeps are 2 kappa delta, of the sign of omega R - V.

Powers per unit of V, with M_b the part of M by the slope of body b and W_b = int q u'_b dx by its strain along x:

    body b loses M_b + W_b      friction loses delta Q - W_base - W_cylinder      their sum is M + delta Q
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from ..core.array_types import Floats
from ..core.errors import ParameterError
from ..materials.bodies import Bodies
from ..materials.prony import Prony, series_of_alpha
from .coupled_kernels import body_kernels, edge_layer

#: Elements of a state.
ELEMENTS = 72
#: Error of the creep of free rolling, times 2 kappa.
_FREE_CREEP_ERROR = 1e-9
#: Length of an edge layer, over l0, from which on elements are added, as many as gather in it.
_UNLAYERED = 1e-3
#: Coupling over the largest kernel that counts as rounding.
_ROUNDING = 1e-14


class CoupledBody(NamedTuple):
    """One deformable body of a pair.

    side : "base" or "cylinder".
    share : its part of the summed long-time compliance of both as half-spaces, in (0, 1].
    nu : Poisson's ratio in plane strain.
    thickness : of a layer, divided by l0; infinite of a half-space.
    J, T : strengths of its creep modes over its long-time compliance, and their times in units of T_ref.
    """

    side: str
    share: float
    nu: float
    thickness: float
    J: tuple[float, ...]
    T: tuple[float, ...]


class CoupledPair(NamedTuple):
    """Both bodies of a roller, one record for each that deforms; equal pairs have one hash."""

    bodies: tuple[CoupledBody, ...]

    @classmethod
    def of_scene(cls, scene: Any) -> CoupledPair:
        """Return the pair of dimensionless parameters, :class:`.parameters.Parameters`, of one material.

        Raises ParameterError for several materials.
        """
        material = scene.material
        if material is None:
            material = series_of_alpha(float(np.asarray(scene.alpha).item()))
        if material.shape:
            raise ParameterError("material", f"{material!r:.60}", "one material, as material[i], by method 'coupled'")
        if isinstance(material, Bodies):
            shares = {"base": 1.0 - material.share, "cylinder": material.share}
            made = [_body(side, *material.body(side), share) for side, share in shares.items() if share > 0.0]
        else:
            made = [_body(side, material, 0.5, None, 0.5) for side in ("base", "cylinder")]
        return cls(tuple(made))


def _body(side: str, series: Prony, nu: float, thickness: float | None, share: float) -> CoupledBody:
    """Return one body; arguments as the fields of :class:`CoupledBody`, ``series`` for its modes, None for infinite."""
    J, T = (tuple(each.tolist()) for each in (series.J, series.T))
    return CoupledBody(side, float(share), float(nu), math.inf if thickness is None else float(thickness), J, T)


class CoupledStates(NamedTuple):
    """Fields of states of one row, (n,) each, dimensionless.

    lam, epsilon : contact length over l0, shift over half of it.
    Q_over_mu : traction over mu P.
    kM_base, kM_cylinder : kappa times the parts of M by the slope of each body.
    work_base, work_cylinder : 2 kappa int q u'_b dx/P: strain of each body (module).
    beta : length of the stick zone over the contact length.
    status : 0 where solved (:mod:`..kernels.coupled.loop`).
    """

    lam: Floats
    epsilon: Floats
    Q_over_mu: Floats
    kM_base: Floats
    kM_cylinder: Floats
    work_base: Floats
    work_cylinder: Floats
    beta: Floats
    status: Floats

    @property
    def converged(self) -> Any:
        """Whether each state was solved, (n,), bool."""
        return self.status == 0.0


class CoupledProfile(NamedTuple):
    """Tractions of one state, linear between the nodes of the elements.

    nodes : places over l0 from the middle of the contact, ascending, (n,), of a motion along +x.
    shift : place of the middle ahead of the axis, over l0.
    p, q : pressure and shear stress on the cylinder along +x, over E'/(4 pi kappa), (n,).
    status : 0 where solved.
    """

    nodes: Floats
    shift: float
    p: Floats
    q: Floats
    status: int


class CoupledRow:
    """States of a pair at one speed u = kappa |V|, over creep; its kernels are computed here, and hold no GIL."""

    def __init__(self, pair: CoupledPair, u: float, mu: float, n: int = ELEMENTS) -> None:
        """Compute the kernels of the row, and full slip of both signs.

        pair: the bodies.
        u: kappa |V|, >= 0, or infinite.
        mu: coefficient of friction, > 0.
        n: number of elements, to which those of an edge layer are added.
        """
        from ..kernels.coupled import loop

        self.pair = pair
        self.u = u
        self.mu = mu
        layer = edge_layer(pair.bodies, u)
        self.n = n + round(0.5 * loop.WEIGHT_OF_LAYER * math.log(max(_UNLAYERED / layer, 1.0)))
        kernels = {body.side: body_kernels(body, u) for body in pair.bodies}
        table = np.ascontiguousarray(sum(each.table for each in kernels.values()))
        instant = math.fsum(each.instant for each in kernels.values())
        local = np.concatenate([each.local for each in kernels.values()])
        own = kernels.get("cylinder", next(iter(kernels.values())))
        coupled = bool(np.abs(table[:, :, 2]).max() > _ROUNDING * np.abs(table).max())
        self._row = loop.Row(
            table, np.ascontiguousarray(own.table), instant, own.instant, coupled, len(kernels) == 2,
            "cylinder" in kernels, local, own.local, layer,
        )  # fmt: skip
        self._full = np.zeros((2, loop.COLUMNS))
        length = 0.5 * math.sqrt(max(instant, 1e-3))
        self._ends = [
            loop.full_slip(self._row, mu, sign, self.n, length, out)
            for sign, out in zip((-1.0, 1.0), self._full, strict=True)
        ]

        # a guess that is the same for bodies that are swapped
        self._length = 0.5 * float(self._full[0, 9] + self._full[1, 9])

    @property
    def full_slip_status(self) -> Floats:
        """Status of full slip of the negative and of the positive sign, (2,); 0 where solved."""
        return self._full[:, 8]

    def onsets(self) -> tuple[float, float]:
        """Return the creeps 2 kappa delta at which full slip begins, (of the negative, of the positive sign)."""
        return 2.0 * self._ends[0], 2.0 * self._ends[1]

    def touch(self) -> float:
        """Return the creep 2 kappa delta at which slip of the other sign opens in the rear half of the contact."""
        from ..kernels.coupled import loop

        return 2.0 * float(loop.touch_creep(self._row, self.mu, *self._ends, self.n, self._length))

    def states(self, creeps: Any, apart: bool = False) -> CoupledStates:
        """Return the states at creeps 2 kappa delta, in any order, (n,); beyond the onsets of full slip.

        apart: whether each is solved from nothing; else from its neighbour, in half the time and to some 1e-5.
        """
        from ..kernels.coupled import loop

        given = np.asarray(creeps, dtype=np.float64)
        found = np.empty((given.size, loop.COLUMNS))
        order = np.argsort(given)
        low, high = self.onsets()
        inside = order[(given[order] > low) & (given[order] < high)]
        found[given <= low] = self._full[0]
        found[given >= high] = self._full[1]
        out = np.zeros((inside.size, loop.COLUMNS))
        loop.states_loop(self._row, self.mu, 0.5 * given[inside], self.n, self._length, apart, out)
        found[inside] = out
        lam, epsilon, Q, moment, work, own_moment, own_work, beta, status = found.T[:9].copy()
        np.clip(Q, -1.0, 1.0, out=Q)  # beyond by rounding
        return CoupledStates(
            lam, epsilon, Q, moment - own_moment, own_moment, work - own_work, own_work, beta, status
        )  # fmt: skip

    def free_creep(self) -> float:
        """Return the creep 2 kappa delta of free rolling, at which there is no traction."""
        return float(brentq(lambda creep: self.states([creep]).Q_over_mu[0], *self.onsets(), xtol=_FREE_CREEP_ERROR))

    def profile(self, creep: float) -> CoupledProfile:
        """Return the tractions at a creep 2 kappa delta of any size."""
        from ..kernels.coupled import loop

        low, high = self.onsets()
        slips = not low < creep < high
        out = np.zeros(loop.COLUMNS)
        sign = 1.0 if creep >= high else -1.0
        d = np.inf if slips else 0.5 * creep
        found = loop.solve_one(self._row, self.mu, d, self.n, self._length, sign, out)
        p, q = (np.concatenate([[0.0], each, [0.0]]) for each in (found.p, found.q))
        load = np.trapezoid(p, found.nodes)
        shift = 0.5 * out[0] * out[1]
        return CoupledProfile(found.nodes, shift, p * (loop.LOAD / load), q * (loop.LOAD / load), int(out[8]))
