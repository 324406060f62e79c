"""Build and run ``paper_method.c``, the paper's own method on the GNU Scientific Library."""

from __future__ import annotations

import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SOURCE = Path(__file__).with_name("paper_method.c")


def missing() -> str | None:
    """Why the program cannot be built here, or None."""
    for tool in ("cc", "pkg-config"):
        if shutil.which(tool) is None:
            return f"{tool} is not installed"
    if subprocess.run(["pkg-config", "--exists", "gsl"], check=False).returncode:
        return "the GNU Scientific Library is not installed (Debian: libgsl-dev)"
    return None


@cache
def build(folder: Path) -> Path:
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
    command = [
        "cc",
        "-O2",
        "-march=native",
        str(SOURCE),
        *flags.stdout.split(),
        "-lm",
        "-o",
        str(program),
    ]
    subprocess.run(command, check=True)
    return program


def run(
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
