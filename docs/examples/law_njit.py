"""A roller in gusts of wind, by a loop of the user's own in numba.

A linearly implicit step needs the law and its slopes once: (1 - h J) dy = h rates.  Friction makes
V and omega go together, so the gusts move the roller as a whole, and its rolling resistance holds
it back.
"""

import numba
import numpy as np

import viscoroll as vr


@numba.njit
def rolled(law, gamma, j, V, omega, force, h):
    """Speeds after every step of length h.

    The force on the axis in each step is divided by P.
    """
    found = np.empty((force.size, 2))
    for n in range(force.size):
        f = law(V, omega)
        a, b = gamma * h, gamma * h / j
        rise_V = a * (f.Q - f.M_half_space + force[n])
        rise_omega = b * (-f.Q - f.M_cylinder)
        # 1 - h J, solved by Cramer's rule
        p, q = 1.0 - a * (f.dQ_dV - f.dM_half_space_dV), -a * f.dQ_domega
        r, s = b * (f.dQ_dV + f.dM_cylinder_dV), 1.0 + b * f.dQ_domega
        whole = p * s - q * r
        V, omega = (
            V + (rise_V * s - q * rise_omega) / whole,
            omega + (p * rise_omega - r * rise_V) / whole,
        )
        found[n] = V, omega
    return found


scene = vr.presets.RUBBER_ROLLER
law = vr.law(scene).jitted  # any other law takes the same machine code
gusts = np.repeat(np.random.default_rng(1).uniform(0.0, 0.01, 20), 5000)
speeds = rolled(law, scene.gamma, scene.j, 0.5, 0.5, gusts, 1e-5)
print(
    f"V = {speeds[-1, 0]:.6f}, omega = {speeds[-1, 1]:.6f} "
    f"after {gusts.size} steps"
)
