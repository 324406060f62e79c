"""Nodes of the law of one scene over speed and creep, and the vector of splines that kernels read
of them.

:mod:`.coupled_splines` describes the splines.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..core.checks import Floats
from ..materials.prony import lock_array

#: creeps that divide the states of a speed, in the order of :attr:`CoupledRows.edges`
EDGES = ("middle", "onset_minus", "onset_plus", "free")
#: fields in the order of :attr:`CoupledRows.fields`
FIELDS = (
    "Q_over_mu",
    "M_half_space",
    "M_cylinder",
    "lam",
    "epsilon",
    "beta",
    "work_half_space",
    "work_cylinder",
)


@dataclass(frozen=True, eq=False)
class CoupledRows:
    """The law of one scene at one coefficient of friction, at nodes; arrays are read only, all is
    dimensionless.

    mu : coefficient of friction.
    u : nodes of kappa |V|, (n,), > 0, ascending.
    t : nodes of the place in creep, (m,), from -1 to 1, with 0 among them where ``graded``.
    edges : 2 kappa times the creepages :data:`EDGES`, (n + 2, 4): first for u = 0, last for u
    infinite.
    fields : :data:`FIELDS`, (n + 2, m, 8): M times kappa; work is 2 kappa times that of shear on
    the strain of a body.
    graded : whether t is graded at 0 and +-1; else it is the place itself, and the splines are not
    clamped there.
    fastest : largest u that is allowed; for a last row that is the limit of u infinite 1e300.
    slips : whether the contact slips fully beyond the onsets; False: nothing is known there.
    limit : largest abs(Q/mu): 1, or infinite where it is not known.
    errors : field -> largest error found beside the nodes, absolute.
    """

    mu: float
    u: Floats
    t: Floats
    edges: Floats
    fields: Floats
    graded: bool = True
    fastest: float = 1e300
    slips: bool = True
    limit: float = 1.0
    errors: dict[str, float] = field(default_factory=dict)

    @cached_property
    def vector(self) -> Floats:
        """Return the splines as the vector that kernels read."""
        from ..kernels.law import coupled_splines as layout

        x = np.log(self.u)
        along = self._slopes_along if self.graded else _free_slopes
        fields = self.fields
        if self.graded:
            fields = np.concatenate([fields, self._friction()[..., np.newaxis]], axis=-1)
        over_t = self._slopes_in_t(fields)
        jets = np.stack([fields, along(x, fields), over_t, along(x, over_t)], axis=-1)
        edges = np.stack([self.edges, along(x, self.edges)], axis=-1)
        head = np.zeros(layout.HEAD)
        head[[layout.ROWS, layout.NODES, layout.GRADED]] = self.u.size + 2, self.t.size, self.graded
        head[[layout.FIRST, layout.LAST, layout.MOST]] = self.u[0], self.u[-1], self.fastest
        head[layout.U_STEP : layout.U_STEP + 2] = _equal_step(x)
        head[layout.T_STEP : layout.T_STEP + 2] = _equal_step(self.t)
        begin = layout.HEAD + np.cumsum([x.size, self.t.size, edges.size])
        head[[layout.T_BEGIN, layout.EDGES, layout.FIELDS]] = begin
        head[[layout.FIELD_COUNT, layout.SLIPS, layout.LIMIT]] = (
            fields.shape[-1],
            self.slips,
            self.limit,
        )
        planes = np.moveaxis(jets, 2, 0)
        return lock_array(np.concatenate([head, x, self.t, edges.ravel(), planes.ravel()]))

    def _slopes_along(self, x: Floats, values: Floats) -> Floats:
        """Return slopes over x = ln u, of ``values`` (n + 2, ...), that join the limits smoothly; 0
        in the limits.
        """
        from scipy.interpolate import CubicSpline

        ends = (1, values[1] - values[0]), (1, values[-1] - values[-2])
        found = np.zeros_like(values)
        found[1:-1] = CubicSpline(x, values[1:-1], bc_type=ends)(x, 1)
        return found

    def _friction(self) -> Floats:
        """Return 2 kappa times the slip loss at the nodes, divided by P V, (n + 2, m), >= 0.

        It is mu (Q/mu) times the reduced creepage, less the work of shear on the strains.
        """
        middle, low, high = (edge[:, np.newaxis] for edge in self.edges[:, :3].T)
        creep = middle + np.where(self.t < 0.0, low - middle, high - middle) * grade(self.t)
        work = self.fields[..., 6] + self.fields[..., 7]
        return np.maximum(self.mu * self.fields[..., 0] * creep - work, 0.0)

    def _slopes_in_t(self, fields: Floats) -> Floats:
        """Return derivatives of fields with respect to t at the nodes, in the shape of ``fields``.

        fields: values at the nodes, (n + 2, m, fields).
        The derivatives are 0 at t = 0 and +-1 if the nodes are graded.
        """
        from scipy.interpolate import CubicSpline

        if not self.graded:
            slopes = np.moveaxis(_slopes(self.t, np.moveaxis(fields, 1, 0)), 0, 1)
            return np.where(np.ptp(fields, axis=1, keepdims=True) > 0.0, slopes, 0.0)
        middle = int(np.argmin(np.abs(self.t)))
        found = np.zeros_like(fields)
        for side in (slice(0, middle + 1), slice(middle, None)):
            spline = CubicSpline(self.t[side], fields[:, side], axis=1, bc_type="clamped")
            found[:, side] = spline(self.t[side], 1)
        return found


def grade(t: Any) -> Any:
    """Return w = 1 - (1 - t^2)^(3/2), the place at t of a graded table."""
    return 1.0 - (1.0 - np.square(t)) ** 1.5


def _slopes(x: Floats, values: Floats) -> Floats:
    """Return slopes at nodes, (n, ...), of the not-a-knot spline, of lower degree for few nodes."""
    from scipy.interpolate import make_interp_spline

    return np.asarray(make_interp_spline(x, values, k=min(3, x.size - 1))(x, 1))


def _free_slopes(x: Floats, values: Floats) -> Floats:
    """Return slopes over x = ln u of the spline through ``values[1:-1]``, 0 in the rows of both
    limits.
    """
    found = np.zeros_like(values)
    found[1:-1] = _slopes(x, values[1:-1])
    return found


def _equal_step(x: Any) -> tuple[float, float]:
    """Return the step of coordinates in equal steps and its inverse, else two zeros."""
    steps = np.diff(x)
    step = float(steps.mean())
    equal = np.ptp(steps) <= 1e-12 * np.abs(steps).max() * x.size
    return (step, 1.0 / step) if equal else (0.0, 0.0)
