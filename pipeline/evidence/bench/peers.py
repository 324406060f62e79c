"""What a user would call instead: LSODA on the law, and the paper's own method on the GNU
Scientific Library (paper_method.c).
"""

import shutil
import subprocess
from functools import cache
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path

import numba
import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.law.law_functions import length_and_moment, locate_row, moment_factor
from viscoroll.kernels.law.law_record import Law, State
from viscoroll.kernels.law.traction_functions import signed_creep, signed_traction, stick_argument
from viscoroll.kernels.numerics.intrinsics import floats_at, integers_at
from viscoroll.laws.law_tables import law_table

# --- LSODA, compiled, on Eq. (22) in (V, omega), free or driven, without events ---

#: share of rtol that the absolute tolerance is
ATOL_SHARE = 1e-3
#: between two outputs
_MOST_STEPS = 20_000


def lsoda_missing() -> str | None:
    """Why it cannot run here, or None."""
    return None if find_spec("numbalsoda") else "numbalsoda is not installed (make peer-tools)"


@cache
def _compiled():
    # the module of ``lsoda`` alone: beside it lies another method, which numba compiles on import,
    # for 5 s
    spec = spec_from_file_location(
        "driver", Path(find_spec("numbalsoda").origin).with_name("driver.py")
    )
    driver = module_from_spec(spec)
    spec.loader.exec_module(driver)
    lsoda = driver.lsoda

    @numba.cfunc(driver.lsoda_sig)
    def rates(_, u, du, p):
        """At the force par[4] and the torque par[5]; addresses and sizes of rows and marks
        behind.
        """
        y = numba.carray(u, 2)
        found = numba.carray(du, 2)
        par = numba.carray(p, 10)
        rows = floats_at(int(par[6]), int(par[7]))
        marks = integers_at(int(par[8]), int(par[9]))
        law = Law(rows, marks, rows[:0], 0, 0, 0, None)
        state = State(par[0], par[1], y[0], y[1], True)
        u = state.kappa * abs(y[0])
        at = locate_row(u, law)
        of = length_and_moment(at, u, law)
        D = signed_creep(of.L, 0.0, 0.0, state, law.cover_rows)
        v = stick_argument(u, of.L, abs(D))
        Q = signed_traction(locate_row(v, law), v, u, of.L, D, state.mu, law)
        M = moment_factor(at, u, of.scale, state) * of.m
        found[0] = par[2] * (Q - 0.5 * M + par[4])
        found[1] = par[2] / par[3] * (par[5] - Q - 0.5 * M)

    @numba.njit(nogil=True)
    def loop(address, given, starts, t, rtol, atol, found):
        for i in range(len(starts)):
            solution, good = lsoda(
                address, starts[i].copy(), t, given[i].copy(), rtol, atol, _MOST_STEPS
            )
            if good:
                for m in range(
                    t.size
                ):  # numba takes seconds to compile the message of slices that do not fit
                    found[i, m, 0] = solution[m, 0]
                    found[i, m, 1] = solution[m, 1]

    return lambda *rest: loop(rates.address, *rest)


@cache
def _law(alpha):
    return law_table(alpha).record


def lsoda_given(scene: vr.Scene, force: float, torque: float) -> NDArray:
    """What the rates ask of a scene and its drive."""
    law = _law(float(scene.alpha))
    rows = [each for part in (law.rows, law.marks) for each in (part.ctypes.data, part.size)]
    return np.array([scene.kappa, scene.mu, scene.gamma, scene.j, force, torque, *rows])


def lsoda_roll(scenes: NDArray, starts: NDArray, t: NDArray, rtol: float) -> NDArray:
    """V and omega at ``t``, which begins with 0, of each motion, or NaN."""
    found = np.full((len(starts), t.size, 2), np.nan)
    _compiled()(scenes, starts, t, rtol, ATOL_SHARE * rtol, found)
    return found


# --- the paper's method ---

SOURCE = Path(__file__).with_name("paper_method.c")


def paper_missing() -> str | None:
    """Why the program cannot be built here, or None."""
    for tool in ("cc", "pkg-config"):
        if shutil.which(tool) is None:
            return f"{tool} is not installed"
    if subprocess.run(["pkg-config", "--exists", "gsl"], check=False).returncode:
        return "the GNU Scientific Library is not installed (Debian: libgsl-dev)"
    return None


@cache
def paper_program(folder: Path) -> Path:
    """The program, compiled into ``folder``.

    Raises
    ------
    subprocess.CalledProcessError
        If it does not compile.
    """
    program = folder / "paper_method"
    flags = subprocess.run(
        ["pkg-config", "--cflags", "--libs", "gsl"], check=True, capture_output=True, text=True
    )
    options = f"{flags.stdout} -lm -o".split()
    subprocess.run(["cc", "-O2", "-march=native", SOURCE, *options, program], check=True)
    return program


def paper_roll(
    program: Path,
    method: str,
    parameters: NDArray,
    starts: NDArray,
    t: NDArray,
    rtol: float,
    most_evaluations: int,
) -> tuple[NDArray, NDArray, float]:
    """Roll motions: (V, omega) of shape (n, times), seconds of all; NaN where it gave up.

    Parameters
    ----------
    method : "adams" or "bdf".
    parameters : alpha, kappa, mu, gamma, j, a row a motion.
    starts : (n, 2), V and omega at t = 0.
    """
    head = f"{method} {rtol!r} {1e-3 * rtol!r} {most_evaluations} {len(starts)} {t.size}"
    rows = np.column_stack([parameters, starts])
    lines = [
        head,
        " ".join(map(repr, t.tolist())),
        *(" ".join(map(repr, row)) for row in rows.tolist()),
    ]
    result = subprocess.run(
        [program], input="\n".join(lines), capture_output=True, text=True, check=True
    )
    table = result.stdout.splitlines()
    motions = [table[i : i + t.size + 1] for i in range(0, len(table), t.size + 1)]
    heads = np.array([motion[0].split() for motion in motions], dtype=float)
    speeds = np.array([[line.split() for line in motion[1:]] for motion in motions], dtype=float)
    return speeds[:, :, 0], speeds[:, :, 1], float(heads[:, 2].sum())
