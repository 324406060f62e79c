"""A roller in gusts of wind, computed by a loop of the user in numba.

The loop makes linearly implicit Euler steps: (1 - h J) dy = h rates, with the step h, the state y =
(V, omega) and the matrix J of the derivatives of the rates.  Each step needs the law and its
derivatives once.  The friction in the contact keeps omega near V, and the rolling resistance acts
against the gusts.  All quantities are dimensionless.
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
# the compiled loop can be called with any other law too
law = vr.law(scene).jitted
gusts = np.repeat(np.random.default_rng(1).uniform(0.0, 0.01, 20), 5000)
speeds = rolled(law, scene.gamma, scene.j, 0.5, 0.5, gusts, 1e-5)
print(
    f"V = {speeds[-1, 0]:.6f}, omega = {speeds[-1, 1]:.6f} "
    f"after {gusts.size} steps"
)
