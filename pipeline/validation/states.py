"""Method "table" against method "direct": over random states, and along the paper's motions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from viscoroll.contact_mechanics.contact import Values, contact
from viscoroll.motion.roll import roll
from viscoroll.presets import PAPER_SECTION_5, PAPER_SECTION_5_ROUNDED, PAPER_STARTS
from viscoroll.rollers import Scene
from viscoroll.tables.law_dataset import Check

FIELDS = ("lam", "epsilon", "delta_star", "beta", "Q", "M")
#: Field -> (largest difference allowed, its unit in words).  lam and epsilon: what the rows of the
#: law state of them (docs/accuracy.md).  Else the rows are good to 2e-15, and these are roundings
#: of the printed forms, with kernels/law/printed_law.py's measured figures times three or four.
ALLOWED = {
    "lam": (1.5e-14, "relative"),
    "epsilon": (3e-14, "divided by max(1, epsilon)"),
    "delta_star": (2e-15, "relative"),
    # stated as lam is, whose error in the octave of alpha from 20 to 35 enters it: 1.005e-14
    # against 50 digits
    "beta": (1.5e-14, "absolute"),
    # K1/K0, up to 1e3 at kappa V = 1e3, magnifies the rounding of the bracket of Eq. (15)
    "Q": (4e-13, "over mu"),
    # kappa V up to 1e3 magnifies the rounding of lam^2 - 1/alpha in Eq. (16)
    "M": (6e-13, "times kappa"),
}
_SHARE_ELASTIC = 0.02


def random_states(count: int, seed: int) -> tuple[Scene, NDArray, NDArray]:
    """Scene arrays, V and delta of either sign.

    alpha in [1, 1e4] (some exactly 1), kappa V in [1e-3, 1e3], kappa in [1, 100], mu in
    [0.01, 1], all log-uniform.  s = |delta|/delta_star: logarithmic toward 0 and toward 1
    (from 1e-6), uniform in [0, 1.5], and exactly 0 or 1, a quarter each.
    """
    rng = np.random.default_rng(seed)

    def log_uniform(low: float, high: float) -> NDArray:
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    alpha = np.where(rng.random(count) < _SHARE_ELASTIC, 1.0, log_uniform(1.0, 1e4))
    scene = Scene(alpha, log_uniform(1.0, 100.0), log_uniform(0.01, 1.0))
    V = log_uniform(1e-3, 1e3) / scene.kappa * rng.choice([-1.0, 1.0], count)
    toward_0 = log_uniform(1e-6, 0.5)
    toward_1 = 1.0 - log_uniform(1e-6, 0.5)
    kinds = (toward_0, toward_1, rng.uniform(0.0, 1.5, count), rng.choice([0.0, 1.0], count))
    s = np.choose(rng.integers(len(kinds), size=count), kinds) * rng.choice([-1.0, 1.0], count)
    return scene, V, s * contact(scene, V, delta=0.0, fields="delta_star").delta_star


def differences(table: Values, direct: Values, scene: Scene) -> dict[str, float]:
    """Largest difference of each of :data:`FIELDS` between two methods, in the units of
    :data:`ALLOWED`.
    """
    units: dict[str, Any] = {
        "lam": table.lam,
        "epsilon": np.maximum(table.epsilon, 1.0),
        "delta_star": table.delta_star,
        "beta": 1.0,
        "Q": scene.mu,
        "M": 1.0 / np.asarray(scene.kappa),
    }
    return {
        name: float(np.max(np.abs(getattr(table, name) - getattr(direct, name)) / unit))
        for name, unit in units.items()
    }


def _checks(where: str, worst: dict[str, float], sample: str) -> list[Check]:
    return [
        Check(f"{where}: {name}", worst[name], allowed, f"{unit}; table against direct, {sample}")
        for name, (allowed, unit) in ALLOWED.items()
    ]


def random_state_checks(count: int, seed: int) -> list[Check]:
    """Both methods at ``count`` random states."""
    scene, V, delta = random_states(count, seed)
    table = contact(scene, V, delta=delta, fields=FIELDS)
    direct = contact(scene, V, delta=delta, fields=FIELDS, method="direct")
    return _checks("random states", differences(table, direct, scene), f"{count} states")


def along_motion_checks(times: int) -> list[Check]:
    """Both methods at ``times`` states of each of IC1-IC3, with both sets of the paper's
    parameters.
    """
    worst = dict.fromkeys(FIELDS, 0.0)
    for scene in (PAPER_SECTION_5, PAPER_SECTION_5_ROUNDED):
        for V0, omega0 in PAPER_STARTS.values():
            motion = roll(scene, V0, omega0, np.linspace(0.0, 4e-3, times))
            found = differences(
                motion.contact(FIELDS), motion.contact(FIELDS, method="direct"), scene
            )
            worst = {
                name: float(np.maximum(worst[name], found[name])) for name in FIELDS
            }  # a NaN stays
    return _checks("along IC1-IC3", worst, f"{times} times a motion")
