"""Runtime: Eq. (22) from the file of the law that `make tables` wrote -> out/runtime.nc, the contact along with it.

    python -m pipeline.runtime [--config FILE] [-o FOLDER]

No equation of the contact is solved here: the law is what the file holds, the integrator a few lines of numba: RODAS
of Hairer and Wanner, order 4, L-stable, with the law's slopes for its Jacobian, as in ``vr_roll.h``.  Its state is V
and the slip omega - V; sliding and sticking are no events, for the slope of Q is continuous where stick ends.
``vr.roll`` is faster, locates the events, and takes drives.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numba
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.core.files import write_dataset
from viscoroll.core.symbols import attributes

from . import stage

#: (V0, omega0) -> V and omega at the times of a stage
Way = Callable[[float, float], tuple[NDArray, NDArray]]
#: of the contact along a motion
CONTACT = ("lam", "epsilon", "delta_star", "beta", "Q", "M")

_A5 = (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950)
_A = (
    (), (1.544,), (0.9466785280815826, 0.2557011698983284),
    (3.314825187068521, 2.896124015972201, 0.9986419139977817), _A5, (*_A5, 1.0),
)  # fmt: skip
_C = (
    (), (-5.6688,), (-2.430093356833875, -0.2063599157091915),
    (-0.1073529058151375, -9.594562251023355, -20.47028614809616),
    (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160),
    (8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054),
)  # fmt: skip
A, C = (np.array([(*row, *[0.0] * (6 - len(row))) for row in rows]) for rows in (_A, _C))


@numba.njit
def rates(law: Any, gamma: float, j: float, V: float, slip: float) -> Any:
    """Of V and slip, and their slopes."""
    f = law(V, V + slip)
    a, b, grip = 1.0 + 1.0 / j, 1.0 / j, f.dQ_dV + f.dQ_domega
    return (
        gamma * (f.Q - f.M_half_space), gamma * (-a * f.Q - b * f.M_cylinder + f.M_half_space),
        gamma * (grip - f.dM_half_space_dV), gamma * f.dQ_domega,
        gamma * (-a * grip - b * f.dM_cylinder_dV + f.dM_half_space_dV), -gamma * a * f.dQ_domega,
    )  # fmt: skip


@numba.njit
def rolled(
    law: Any, gamma: float, j: float, star: float, start: tuple[float, float], t: NDArray, rtol: float
) -> NDArray:
    """V and omega at the times t, NaN from where it stops; errors of slip count as at the creep ``star`` below that."""
    y, z, k = np.array([start[0], start[1] - start[0]]), np.empty(2), np.zeros((6, 2))
    found, now, h = np.full((2, t.size), np.nan), t[0], 1e-3 * (t[-1] - t[0])
    for n in range(t.size):
        while now < t[n]:
            last = now + h >= t[n]
            step = t[n] - now if last else h
            f0, f1, J00, J01, J10, J11 = rates(law, gamma, j, y[0], y[1])
            d = 4.0 / step
            a, e = d - J00, d - J11
            whole = a * e - J01 * J10
            for i in range(6):
                z[:] = y
                p = q = 0.0
                for m in range(i):
                    z += A[i, m] * k[m]
                    p, q = p + C[i, m] * k[m, 0], q + C[i, m] * k[m, 1]
                if i:
                    f0, f1, _, _, _, _ = rates(law, gamma, j, z[0], z[1])
                p, q = f0 + p / step, f1 + q / step
                k[i] = (e * p + J01 * q) / whole, (a * q + J10 * p) / whole
            z += k[5]
            size = max(abs(y[0]), abs(z[0]))
            error = max(abs(k[5, 0]) / size, abs(k[5, 1]) / max(abs(y[1]), abs(z[1]), star * size)) / rtol
            grown = step * min(max(0.9 * max(error, 1e-9) ** -0.25, 0.2), 5.0)
            if error <= 1.0:
                now, h = (t[n], max(h, grown)) if last else (now + step, grown)
                y[:] = z
            else:
                h = grown
                if not h > 1e-14 * t[-1]:
                    return found
        found[0, n], found[1, n] = y[0], y[0] + y[1]
    return found


class Runtime(msgspec.Struct, forbid_unknown_fields=True):
    """[runtime]: a law of the paper's material, ``times`` even times up to ``end``, the tolerance of the integrator."""

    law: str
    end: float
    times: int
    rtol: float

    @property
    def t(self) -> NDArray:
        return np.linspace(0.0, self.end, self.times)


def timed(way: Way, start: tuple[float, float]) -> float:
    """Seconds of one motion."""
    began = time.perf_counter()
    way(*start)
    return time.perf_counter() - began


def motions(way: Way, t: NDArray, law: str) -> xr.Dataset:
    """The paper's IC1-IC3 with the least seconds of three that each took, one way; ``law``: by what."""
    way(*vr.presets.PAPER_STARTS["IC1"])  # compiles
    found, seconds = [], []
    for start in vr.presets.PAPER_STARTS.values():
        found.append(way(*start))
        seconds.append(min(timed(way, start) for _ in range(3)))
    speeds = {name: (("ic", "t"), [one[n] for one in found], attributes(name)) for n, name in enumerate(("V", "omega"))}
    about = {"title": "Motions of the paper's Sect. 5.1", "law": law, "source": f"viscoroll {vr.__version__}"}
    data = speeds | {"seconds": ("ic", seconds, {"long_name": "time to integrate", "units": "s"})}
    names = np.array(list(vr.presets.PAPER_STARTS), dtype=object)
    return xr.Dataset(data, {"ic": names, "t": ("t", t, attributes("t"))}, about)


def from_file(scene: vr.Scene, t: NDArray, rtol: float) -> Way:
    """Motions of a scene on its law alone."""
    law, star = vr.law(scene).jitted, 0.5 * scene.mu / scene.kappa

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        V, omega = rolled(law, scene.gamma, scene.j, star, (V0, omega0), t, rtol)
        return V, omega

    return way


def work(settings: Runtime, out: Path) -> stage.Outcome:
    scene = vr.presets.PAPER_SECTION_5.replace(material=vr.load_law(stage.ROOT / settings.law))
    t = settings.t
    dataset = motions(from_file(scene, t, settings.rtol), t, f"the file {Path(settings.law).name}")
    along = vr.contact(scene, dataset.V.values, omega=dataset.omega.values, fields=CONTACT)
    for name in CONTACT:
        dataset[name] = (("ic", "t"), getattr(along, name), attributes(name))
    path = out / "runtime.nc"
    write_dataset(dataset, path, stage.plain_encoding(dataset))
    headline: dict[str, float | int | str] = {f"{dataset.law}: seconds, IC1-IC3": float(dataset.seconds.sum())}
    for name, start in vr.presets.PAPER_STARTS.items():
        motion = vr.roll(scene, *start, t)
        if np.isfinite(onset := motion.onset_time):
            headline[f"{name}: stick begins"] = f"t = {onset:.6g}, V = {motion.at(onset).V[0]:.4f}"
    return stage.Outcome([path], headline)


if __name__ == "__main__":
    sys.exit(stage.run("runtime", Runtime, work, __doc__))
