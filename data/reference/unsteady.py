"""Make data/reference/unsteady.json: rolling that is not steady, by a transient solver of the
normal contact.

    python -m data.reference.unsteady [-o FILE]        in some ten minutes

Two like bodies in two dimensions, of any Prony series, quasistatic, constant load, rolling without
slip.  Lengths in half the contact length at rest, times in T_ref, the load pi/2, the speed u =
kappa V.  With Phi = G p, G the logarithmic kernel, and the creep form of the series, J(t) = 1 - sum
J_k exp(-t/T_k),

    w = Phi/alpha + sum J_k m_k,   T_k m_k' = Phi - m_k   at every point of the surface
    w = D - (X - Xc)^2/2 and p >= 0 in contact, the gap >= 0 outside, the integral of p is the load
    u' = -g kM,   Xc' = 2 u,   kM = kappa M = (mean X of the pressure - Xc)/2,   g = gamma/(1 + j)

The grid is fixed in the material.  Far ahead, where slow modes remember the load, Phi is that of a
point load and its second moment.  Nothing of viscoroll enters but the conversion of a series, the
contact length that a run-in begins with, and how long a motion is worth following.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg import toeplitz
from scipy.special import exp1

import viscoroll as vr

Array = NDArray[np.float64]

TARGET = Path(__file__).with_suffix(".json")
ALPHA_3, ALPHA_11 = ([2.0], [1.0 / 3.0]), ([10.0], [1.0 / 11.0])
WEAK, STRONG = ([0.2, 3.0], [1.0, 0.01]), ([3.0, 1.0], [1.0, 0.01])
#: The series of src/viscoroll/datasets/dma.csv; with 0.1 m and T_ref 3 s g is 583, and u = 318 is 1
#: m/s.
DMA = ([0.3, 0.5, 0.8, 1.3], [1.0, 0.1, 0.01, 0.001])
#: E and tau of the material, u = kappa V and g = gamma/(1 + j) at the start; the first six are the
#: table over gamma.
MOTIONS = [
    *((ALPHA_11, 4.365, gamma / 1.5) for gamma in (0.32, 1.07, 3.2, 10.7, 32.0, 107.0)),
    (ALPHA_3, 10.0, 4.5),
    (ALPHA_3, 30.0, 45.0),
    (ALPHA_11, 10.0, 12.0),
    (ALPHA_11, 10.0, 120.0),
    (ALPHA_11, 30.0, 120.0),
    (WEAK, 30.0, 30.0),
    (WEAK, 100.0, 1000.0),
    (STRONG, 30.0, 30.0),
    (STRONG, 100.0, 1000.0),
    (DMA, 30.0, 583.0),
    (DMA, 100.0, 583.0),
    (DMA, 318.0, 5000.0),
]
#: Cell of the grid, over half the contact length at rest.
H = 0.02
#: Speed over that at the start down to which the law is followed; time that is added to that, so
#: that the end is seen.
_LAST, _WAIT = 2e-3, 5.0
#: Relative difference of u from the straight line between two times that are kept.
_THINNED = 2e-5
#: Speed over that at the start below which the difference counts as that of this speed.
_SLOW = 1e-3

#: of the grid behind the axis, of what is not far ahead, of the way of a run-in, and of the grid
#: beyond the whole way
BEHIND, AHEAD, RUN_IN, BEYOND = 3.0, 6.0, 18.0, 60.0
#: half width of the contact that there is room for
_WIDEST = 1.2
#: steps of the contact's own swing
_SWING = 0.1


def kernel(h: float, count: int) -> Array:
    """Displacement by hats of pressure of width h, at distances 0, h, ...; a constant is free."""
    x = np.abs(np.arange(-1, count + 1) * h)
    twice = 0.5 * x * x * np.log(np.where(x == 0.0, 1.0, x)) - 0.75 * x * x
    second: Array = np.diff(twice, 2)
    return -second / (h * np.pi)


class Grid(NamedTuple):
    """The kernel at distances 0, h, ...; the inverse of its matrix over 1, 2, ... nodes; sums of
    the rows of these.
    """

    h: float
    g: Array
    inverses: Array
    rows: Array


def grid(h: float) -> Grid:
    """That of cells h."""
    g, most = kernel(h, round((BEHIND + AHEAD) / h)), round(2.0 * _WIDEST / h)
    inverses = np.zeros((most + 1, most, most))
    for n in range(1, most + 1):
        inverses[n, :n, :n] = np.linalg.inv(toeplitz(g[:n]))
    return Grid(h, g, inverses, inverses.sum(axis=2))


@njit(cache=True)
def _pressure(grid, x0, compliance, history, low, high, p):
    """p on the nodes in contact, which are found from those of last time; x0: place of node 0 from
    the axis.
    """
    h, g, load = grid.h, grid.g, 0.5 * np.pi / grid.h
    r = np.empty(grid.rows.shape[1])
    for _ in range(1000):
        n, total = high - low, 0.0
        inverse, rows = grid.inverses[n], grid.rows[n]
        for i in range(n):
            r[i] = 0.0
            for k in range(n):
                x = x0 + (low + k) * h
                r[i] += inverse[i, k] * (0.5 * x * x + history[low + k])
            total += r[i]
        D = (compliance * load + total) / rows[:n].sum()
        for i in range(n):
            p[low + i] = (D * rows[i] - r[i]) / compliance
        if p[low] < 0.0 or p[high - 1] < 0.0:
            while p[low] < 0.0:
                p[low] = 0.0
                low += 1
            while p[high - 1] < 0.0:
                p[high - 1] = 0.0
                high -= 1
            continue
        behind = ahead = 0.0
        for k in range(low, high):
            behind += g[k - low + 1] * p[k]
            ahead += g[high - k] * p[k]
        xb, xa = x0 + (low - 1) * h, x0 + high * h
        behind = 0.5 * xb * xb + history[low - 1] + compliance * behind - D
        ahead = 0.5 * xa * xa + history[high] + compliance * ahead - D
        if behind >= 0.0 and ahead >= 0.0:
            return low, high
        low, high = low - (behind < 0.0), high + (ahead < 0.0)
    return -1, -1


@njit(cache=True)
def _displace(grid, x0, p, low, high, first, phi):
    """Phi from the node ``first`` on; mean place of the pressure from the axis."""
    h, g, total, mean, second = grid.h, grid.g, 0.0, 0.0, 0.0
    for k in range(low, high):
        x = x0 + k * h
        total += p[k]
        mean += p[k] * x
        second += p[k] * x * x
    mean /= total
    variance = second / total - mean * mean
    for i in range(first, phi.size):
        D = x0 + i * h - mean
        if D > AHEAD:
            phi[i] = -0.5 * np.log(D) + 0.25 * variance / (D * D)
            continue
        phi[i] = 0.0
        for k in range(low, high):
            phi[i] += g[abs(i - k)] * p[k]
    return mean


@njit(cache=True)
def _weights(dt, T):
    """Of m, of Phi before and of Phi after a step over which Phi is linear."""
    d = dt / T
    kept, mean = np.exp(-d), -np.expm1(-d) / d
    new = np.where(d > 1e-4, 1.0 - mean, 0.5 * d - d * d / 6.0)
    return kept, 1.0 - kept - new, new


@njit(cache=True)
def _rolled(grid, series, fields, where, g, ends, out):
    """Steps until t or Xc is at its end, or the grid is; (steps, low, high, Xc, u, mean)."""
    J, T, alpha = series
    p, phi, m = fields
    low, high, Xc, u, mean = where
    h, t, history, back = grid.h, 0.0, np.empty(phi.size), round(BEHIND / grid.h)
    for step in range(out.shape[0]):
        out[step, 0], out[step, 1], out[step, 2] = t, Xc, u
        if t >= ends[0] or Xc >= ends[1] or low < 4 or high > phi.size - 4:
            return step + 1, (low, high, Xc, u, mean)
        pull, a = -0.5 * g * mean, 0.5 * (high - low) * h
        dt = min(
            _SWING / np.sqrt(g * max(alpha * a * a - 1.0, 0.05 * (alpha - 1.0)))
            if g > 0.0
            else 1e30,
            ends[0],
        )
        v, faster = abs(u), pull if u >= 0.0 else -pull
        if 2.0 * v * dt + faster * dt * dt > h:
            dt = h / (v + np.sqrt(max(v * v + faster * h, 0.0)))
        Xc += 2.0 * u * dt + pull * dt * dt
        kept, old, new = _weights(dt, T)
        first, x0 = max(low - back, 0), -BEHIND - Xc
        for i in range(first, phi.size):
            history[i] = 0.0
            for k in range(T.size):
                m[i, k] = kept[k] * m[i, k] + old[k] * phi[i]
                history[i] += J[k] * m[i, k]
        p[low:high] = 0.0
        low, high = _pressure(grid, x0, 1.0 / alpha + (J * new).sum(), history, low, high, p)
        mean = _displace(grid, x0, p, low, high, first, phi)
        for i in range(first, phi.size):
            for k in range(T.size):
                m[i, k] += new[k] * phi[i]
        u += 0.5 * dt * (pull - 0.5 * g * mean)
        t += dt
    return out.shape[0], (low, high, Xc, u, mean)


class Contact:
    """A contact and the memory of the surface, relaxed at rest, or (``u``, ``lam``) run in at a
    constant speed.

    series : J, T, alpha.  path : half lengths that it will roll.
    """

    def __init__(
        self,
        series: tuple[Array, Array, float],
        cells: Grid,
        path: float,
        u: float = 0.0,
        lam: float = 1.0,
    ):
        self.series, self.grid, self.u = (
            (np.array(series[0]), np.array(series[1]), float(series[2])),
            cells,
            u,
        )
        J, T, alpha = self.series
        self.x = cells.h * np.arange(round((BEHIND + path + RUN_IN + BEYOND) / cells.h)) - BEHIND
        axis, half = round(BEHIND / cells.h), round(0.6 / cells.h)
        self.p, phi = np.zeros(self.x.size), np.zeros(self.x.size)
        compliance, history = 1.0, phi
        if u:  # near the contact to begin with
            far = self.x > AHEAD
            D, variance = (
                np.where(far, self.x, np.sqrt(self.x**2 + 0.3)),
                np.where(far, 0.25 * lam * lam, 0.0),
            )
            m = np.array([_remembered(D, 2.0 * u * each, variance) for each in T]).T
            compliance, history = 1.0 / alpha, m @ J
        low, high = _pressure(
            cells, -BEHIND, compliance, history, axis - half, axis + half + 1, self.p
        )
        mean = _displace(cells, -BEHIND, self.p, low, high, 0, phi)
        if u:
            phi = -0.5 * np.log(D) + 0.25 * variance / D**2
        self.fields = self.p, phi, np.ascontiguousarray(m) if u else np.tile(phi[:, None], T.size)
        self.where = low, high, 0.0, mean
        if u:
            self.roll(0.0, X_end=RUN_IN)

    @property
    def kM(self) -> float:
        """kappa M."""
        return 0.5 * float(self.where[3])

    def roll(
        self, g: float, *, t_end: float = 1e300, X_end: float = 1e300, steps: int = 2_000_000
    ) -> Array:
        """Rows t, X and u of a motion from now."""
        out = np.empty((steps, 3))
        low, high, Xc, mean = self.where
        where = low, high, Xc, float(self.u), mean
        count, where = _rolled(
            self.grid, self.series, self.fields, where, float(g), (t_end, X_end + Xc), out
        )
        low, high, moved, self.u, mean = where
        self.where = low, high, moved, mean
        rows: Array = out[:count] - [0.0, Xc, 0.0]
        return rows


def _remembered(D: Array, L: float, variance: Array) -> Array:
    """m at distances D ahead of a steady load that fades over the length L."""
    z = D / L
    E = np.where(
        z < 200.0, np.exp(np.minimum(z, 200.0)) * exp1(np.minimum(z, 200.0)), 1.0 / z - 1.0 / z**2
    )
    second = np.where(z < 200.0, (1.0 / D - E / L) / L, 1.0 / D**2)
    found: Array = -0.5 * (np.log(D) + E) + 0.25 * variance * second
    return found


def end_of(scene: vr.Scene, u0: float) -> float:
    """Return the time at which a motion has been followed far enough: the law's, a tenth more and
    ``_WAIT``.

    scene: of the motion, with kappa = 1.
    u0: speed at the start.
    """
    u = np.geomspace(u0, _LAST * u0, 2001)
    rates = scene.gamma / (1.0 + scene.j) * vr.contact(scene, u, delta=0.0, fields="M").M
    return 1.1 * float(np.trapezoid(u / rates, -np.log(u))) + _WAIT


def solve(scene: vr.Scene, u0: float, h: float) -> dict[str, Array]:
    """Return rows of t, Xc and u of a motion, let go "steady", from steady contact, and from a
    contact at "rest".

    scene: kappa = 1, so that speeds are u.
    u0: speed at the start.
    h: cell of the grid.
    """
    series, steady = scene.material, scene.validity(u0).steady
    lam = float(vr.contact(scene, u0, delta=0.0, fields="lam").lam)
    g, path, end = (
        scene.gamma / (1.0 + scene.j),
        2.4 * float(steady.whole) + 20.0,
        end_of(scene, u0),
    )
    rows = {}
    for start, run_in in {"steady": (u0, lam), "rest": ()}.items():
        contact = Contact((series.J, series.T, series.alpha), grid(h), path, *run_in)
        contact.u = u0
        rows[start] = contact.roll(g, t_end=end)
    return rows


def thin(t: Array, u: Array) -> NDArray[np.intp]:
    """Return the places of so few times that u is linear between them to ``_THINNED``.

    t, u: times and speeds, (n,).
    """
    allowed = _THINNED * np.maximum(np.abs(u), _SLOW * u[0])

    def is_straight(first: int, last: int) -> bool:
        line = np.interp(t[first : last + 1], t[[first, last]], u[[first, last]])
        return bool((np.abs(line - u[first : last + 1]) <= allowed[first : last + 1]).all())

    places = [0]
    while (first := places[-1]) < t.size - 1:
        length = 1
        while first + length < t.size - 1 and is_straight(
            first, min(first + 2 * length, t.size - 1)
        ):
            length *= 2
        low, high = min(first + length, t.size - 1), min(first + 2 * length, t.size - 1)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if is_straight(first, middle) else (low, middle)
        places.append(low)
    return np.array(places)


def scene_of(series: tuple[list[float], list[float]], g: float) -> vr.Scene:
    """Return the scene of a motion: kappa is 1, so that lengths over R are contact lengths, and
    speeds are u.

    series: E and tau.
    g: gamma/(1 + j).
    """
    return vr.Scene(material=vr.Prony(*series), kappa=1.0, mu=0.2, gamma=1.5 * g, j=0.5)


def record(motion: tuple[Any, float, float], rows: dict[str, Array]) -> dict[str, Any]:
    """Return what the file holds of a motion: E, tau, u and g, and times and speeds from either
    start.

    motion: an entry of MOTIONS.
    rows: what ``solve`` found.
    """
    (E, tau), u0, g = motion
    kept = {}
    for start, (t, _, u) in ((start, found.T) for start, found in rows.items()):
        at = thin(t, u)
        kept[start] = {
            name: [float(f"{x:.7g}") for x in values[at]] for name, values in (("t", t), ("u", u))
        }
    return {"E": E, "tau": tau, "u": u0, "g": g} | kept


def main() -> None:
    """Solve all motions, and write the file, a line for each motion."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    output = parser.parse_args().output
    records = (
        record(motion, solve(scene_of(motion[0], motion[2]), motion[1], H)) for motion in MOTIONS
    )
    lines = ",\n".join(json.dumps(each) for each in records)
    output.write_text(f'{{"h": {H}, "motions": [\n{lines}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
