"""Energy lost since t = 0 in slip and in rolling, of a motion that is integrated.

With the power lost in slip, (omega - V) Q, and in rolling, (V + omega) M/2, Eq. (22) gives

    (V^2 + j omega^2)/2 + int (omega - V) Q dtau + int (V + omega) M/2 dtau = constant, tau = gamma t.

One of the two integrals is thus enough.  In full slip it is mu times the path slipped; in partial slip it is
no function of the state (``docs/theory.md``), and a Gauss rule over each step of the integrator finds it: a motion
is rolled once more for the points of the rule.  Apart from :mod:`loop`, so that none compiles both.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.state import loads
from ..law.states import State
from ..material.standard import GAUSS_W, GAUSS_X
from ..numerics.arrays import fill
from .integrate import integrate
from .loop import keep, motion_of
from .output import OUTPUTS
from .records import PARTIAL, Batch, Limits, Notes

#: rows that follow those of :mod:`output`, and the number of all
SLIP_LOSS, ROLLING_LOSS, ROWS = OUTPUTS, OUTPUTS + 1, OUTPUTS + 2
_POINTS = GAUSS_X.size
#: room for the ends of steps at first
_ENDS = 1000


@kernel
def kinetic_energy_lost(V0, omega0, V, omega, j):
    """Kinetic energy at the start less that at (V, omega)."""
    return 0.5 * ((V0 - V) * (V0 + V) + j * (omega0 - omega) * (omega0 + omega))


@kernel
def _slip_power(V, omega, delta, regime, scene):
    """(omega - V) Q >= 0; where slip is partial delta keeps the digits that omega - V has lost."""
    if regime != PARTIAL:
        return abs(omega - V) * scene.mu
    Q, _ = loads(scene.material, State(scene.kappa, scene.mu, V, delta, False))
    return delta * V * Q


@kernel(allocates=True)
def _panels(step_ends, t):
    """0, output times and ends of steps up to the last output, ascending; forgets the ends."""
    count = 0
    while count < step_ends.size and (count == 0 or step_ends[count] > 0.0):
        count += 1
    edges, last = np.zeros(1 + t.size + count), t[t.size - 1]
    m = n = 0
    for k in range(1, edges.size):
        if n == count or (m < t.size and t[m] <= step_ends[n]):
            edges[k] = t[m]
            m += 1
        else:
            edges[k] = min(step_ends[n], last)
            n += 1
    fill(0.0, step_ends[:count])
    return edges


@kernel(allocates=True)
def loss_points(step_ends, t):
    """(edges of the panels, points of the rule and the last output time); forgets the ends of steps."""
    edges = _panels(step_ends, t)
    panels = edges.size - 1
    times = np.empty(panels * _POINTS + 1)
    for n in range(panels):
        for k in range(_POINTS):
            times[n * _POINTS + k] = edges[n] + (edges[n + 1] - edges[n]) * GAUSS_X[k]
    times[panels * _POINTS] = t[t.size - 1]
    return edges, times


@kernel
def add_losses(scene, gamma, V0, omega0, t, edges, points, out):
    """Fill the two rows of losses of a motion from its ``points``: rolled once more, in the same steps, with output at
    those of :func:`loss_points`."""
    lost, n = 0.0, 0
    for m in range(t.size):
        while n < edges.size - 1 and edges[n + 1] <= t[m]:
            for k in range(n * _POINTS, (n + 1) * _POINTS):
                power = _slip_power(points[0, k], points[1, k], points[4, k], points[5, k], scene)
                lost += gamma * (edges[n + 1] - edges[n]) * GAUSS_W[k - n * _POINTS] * power
            n += 1
        out[SLIP_LOSS, m] = lost
        out[ROLLING_LOSS, m] = kinetic_energy_lost(V0, omega0, out[0, m], out[1, m], scene.j) - lost


@kernel(allocates=True)
def loss_loop(batch, t, limits, rows, out, info, start, stop):
    """Motions start..stop; as ``motion_loop``, but ``rows`` may name those of :mod:`losses` too."""
    motions, limits = Batch(*batch), Limits(*limits)
    one, switches, step_ends = np.empty((ROWS, t.size)), np.empty((0, 2)), np.zeros(_ENDS)
    for i in range(start, stop):
        scene, gamma, V0, omega0 = motion_of(motions, i)
        while True:
            for row in one:
                fill(np.nan, row)
            result = integrate(scene, gamma, V0, omega0, t, limits, one, Notes(switches, step_ends))
            if step_ends[step_ends.size - 1] == 0.0:
                break
            step_ends = np.zeros(4 * step_ends.size)
        if rows.max() >= SLIP_LOSS:
            edges, times = loss_points(step_ends, t)
            points = np.empty((OUTPUTS, times.size))
            for row in points:
                fill(np.nan, row)
            integrate(scene, gamma, V0, omega0, times, limits, points, Notes(switches, step_ends[:0]))
            add_losses(scene, gamma, V0, omega0, t, edges, points, one)
        keep(i, rows, one, result, out, info)
