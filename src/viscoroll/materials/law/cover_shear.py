"""What shear does in the contact of a cover, to first order, and how M is split between the bodies.

Notation as in :mod:`.cover_solve`.  With C the coupling of both bodies, that of the base less that of the cylinder, the
pressure p strains the surfaces by u' = -C p and a traction q changes the slopes by C q (docs/theory_covers.md):

- Stick without slip: T q - C p = delta with the pressure of the contact without shear.  Its creepage less half of Q
  times the limit of full slip is delta_f, the creepage of free rolling.
- Full slip, q = Q p: the contact of half length z carries another load, by the solution for the slopes -C p.
- M of full slip changes by -delta_0* Q, with delta_0* the mean strain mirrored about the middle of the contact.

All of these are linear in C, so that each body has its part.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats
from .cover_pressure import LocalPressure, local_pressure
from .cover_solve import LARGE_ALPHA, CoverModes, CoverState, decays, layer_operator

#: highest order of the local coupling, whose terms fall as 1/n^2: highest of :func:`.cover_solve.decays`
_LOCAL_ORDERS = 100


class Shear(NamedTuple):
    """What shear does to a contact, dimensionless; slopes and creep in units of V T_ref/R; the base comes first.

    moments : M/V of each body, with M divided by P R and V by R/T_ref, (2,).
    free : parts of each body in the creepage of free rolling with stick, (2,).
    mirrored : parts of each body in delta_0*, (2,).
    load : relative change of H with Q at fixed z, in full slip.
    shift : change of the shift g with Q at fixed z.
    """

    moments: Floats
    free: Floats
    mirrored: Floats
    load: float
    shift: float


def shear_of(modes: CoverModes, z: float, state: CoverState) -> Shear:
    """Return what shear does to a contact of half length z that :func:`.cover_solve.solve` has found.

    modes: :class:`CoverModes` of the bodies.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of that length.
    Returns :class:`Shear`.
    """
    work = state.work
    local = local_pressure(modes, z, state) if any(body.local for body in modes.bodies) else None
    s, excess = _sources(modes, z, state, local)
    S, c = layer_operator(work.A, work.memory, (modes.L + modes.shear) * work.own / work.compliance.sum(axis=0))
    Phi = 2.0 * work.exponentials.ratio[1:]
    right = Phi @ (work.Xi @ excess) + s[1:]
    stick = np.linalg.solve(np.eye(state.q.size) + S[1:] + Phi @ (work.Xi @ c), right)
    creep = _shift(modes, state, c @ stick - excess) + S[0] @ stick - s[0]
    # q_1 of the traction over q_1 of the pressure is Q
    free = creep - 0.5 * state.creep_limit * stick[0] / state.q[0]
    # slopes by Q p are those that the pressure of -C p takes back
    change = np.linalg.solve(work.matrix, -right.sum(axis=1))
    S, c = layer_operator(work.A, work.memory, modes.L * work.own / work.compliance.sum(axis=0))
    shift = _shift(modes, state, c @ change + excess.sum(axis=1)) + S[0] @ change + s[0].sum()
    load = float(change[0] / state.q[0])
    return Shear(_moments(modes, z, state), free, _mirrored(modes, state, local), load, float(shift))


def _shift(modes: CoverModes, state: CoverState, excess: Any) -> Any:
    """Return the mean slope, without S, of a solution that has an excess memory and no slope of its own.

    modes: :class:`CoverModes`.
    state: :class:`CoverState`, of which the exponentials are read.
    excess: excess memory of each creep mode, (modes,), or (modes, k) of k solutions.
    Returns a float, or (k,).
    """
    _, root, edge, x, sigma = state.work.exponentials
    source = (sigma * excess.T).T
    within = modes.series.Q @ (root * (x[:, 1:] @ source).T).T
    return modes.series.t @ (source - (edge * within.T).T)


def _sources(modes: CoverModes, z: float, state: CoverState, local: LocalPressure | None) -> tuple[Floats, Floats]:
    """Return C p of each body over the compliance of both, as terms T_n(x) and as excess memory of each creep mode.

    modes: :class:`CoverModes`.
    z: half contact length divided by V T_ref, > 0.
    state: :class:`CoverState`, of N terms.
    local: the pressure at points, for the coupling of short waves; None: there is none.
    Returns (terms from n = 0, (N + 1, 2); excess memory, (modes, 2)).
    """
    work = state.work
    A = work.A
    F = modes.mine * (modes.C * work.own / work.compliance.sum(axis=0) * (work.odd + 1j * work.even))
    s = 2.0 * np.where(np.arange(len(A))[:, None] % 2, -(A @ F.imag.T), A @ F.real.T)
    s[0] *= 0.5
    excess = (work.memory @ F.T).real
    if local is not None:
        terms = local.terms[: _LOCAL_ORDERS + 1]
        D = decays(modes.series.b * z, _LOCAL_ORDERS)
        # ahead of the edge there is no pressure, while the series goes on
        s = s + terms[: len(A)]
        excess = excess - D.T @ terms
    return s, excess


def _mirrored(modes: CoverModes, state: CoverState, local: LocalPressure | None) -> Floats:
    """Return the parts of each body in delta_0*, (2,): minus the mean of its C p, mirrored, with p as weight.

    modes: :class:`CoverModes`.
    state: :class:`CoverState`.
    local: what the coupling of short waves has in it; None: nothing.
    """
    work = state.work
    strain = modes.C * (work.own * (work.odd + 1j * work.even) ** 2).real / work.v
    found = -2.0 / state.q[0] * (modes.mine @ strain)
    return found if local is None else found - local.mirrored


def _moments(modes: CoverModes, z: float, state: CoverState) -> Floats:
    """Return M/V of each body, the power that its compliance dissipates in the pressure, (2,).

    Each creep mode has a part, as for half-spaces (:mod:`...kernels.rows.series`), without cancellation; what the
    layers' smooth kernels change in the slopes is an integral over the wave number.
    modes: :class:`CoverModes`.
    z: half contact length divided by V T_ref, > 0.
    state: :class:`CoverState`.
    """
    work = state.work
    total = modes.L * work.own / work.compliance.sum(axis=0)
    multipliers = modes.mine * (modes.L * work.own) + (modes.shares[:, None] - work.compliance) * total
    smooth = 2.0 / state.q[0] * (multipliers.imag @ ((work.odd**2 + work.even**2) / work.v))
    if not modes.J.size:
        return 0.0 * smooth
    _, _, e, t, _, Q = modes.series
    within = Q @ (state.X * _edge_weights(modes, z, state) / e)
    return modes.weights @ (work.shares + t * within) + smooth


def _edge_weights(modes: CoverModes, z: float, state: CoverState) -> Floats:
    """Return the mean of 1 - exp(alpha_i x)/I_0(alpha_i) over the contact, with the pressure as weight.

    modes: :class:`CoverModes`, with at least one mode.
    z: half contact length divided by V T_ref, > 0.
    state: :class:`CoverState`.
    Returns (modes,), dimensionless.  Sums over all orders are in closed form, with i2 = I_2/I_0.
    """
    ratio = state.work.exponentials.ratio
    alpha = np.minimum(modes.series.a * z, LARGE_ALPHA)
    i2 = ratio[2]
    # i2_i - i2_l, from 1 - i2 = 2 I_1/(alpha I_0) where that is small
    rest_of_1 = 2.0 * ratio[1] / alpha
    near_1 = np.minimum.outer(alpha, alpha) > 1.0
    change = np.where(near_1, np.subtract.outer(-rest_of_1, -rest_of_1), np.subtract.outer(i2, i2))
    sums = change * np.multiply.outer(alpha, alpha) / np.add.outer(alpha, alpha)
    # the rest of the terms, which is smooth
    m = np.arange(1, state.q.size + 1)
    rest = state.q - 2.0 * ratio[1:] @ state.X
    rest[0] -= z
    weights = -2.0 / alpha * (m[:, None] * ratio[1:])
    weights[0] = i2
    return (z * i2 + sums @ state.X + rest @ weights) / state.q[0]
