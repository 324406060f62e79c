"""A roller slows down, computed by Radau of SciPy with the exact derivatives of the law.

The equations of motion are V' = gamma (Q - M_half_space), j omega' = gamma (-Q - M_cylinder).  When
the contact no longer slips fully, friction brings omega to V within 1e-4 s, while the rolling
resistance slows both down over seconds.  So the equations are stiff and need an implicit method.
"""

import numpy as np
from scipy.integrate import solve_ivp

import viscoroll as vr

scene = vr.presets.RUBBER_ROLLER
law, gamma, j = vr.law(scene), scene.gamma, scene.j


def rates(t, y):
    """Rates of V and omega."""
    f = law(*y)
    return gamma * (f.Q - f.M_half_space), gamma / j * (-f.Q - f.M_cylinder)


def jacobian(t, y):
    """Derivatives of the rates.  M depends on V only."""
    f = law(*y, slopes=True)
    return [
        [gamma * (f.dQ_dV - f.dM_half_space_dV), gamma * f.dQ_domega],
        [
            gamma / j * (-f.dQ_dV - f.dM_cylinder_dV),
            -gamma / j * f.dQ_domega,
        ],
    ]


t = np.linspace(0.0, 5.0, 101)
found = solve_ivp(
    rates,
    (0.0, 5.0),
    [0.5, 0.0],
    "Radau",
    t,
    jac=jacobian,
    rtol=1e-8,
    atol=1e-10,
)
V, omega = found.y
print(
    f"V = {V[-1]:.6f}, omega = {omega[-1]:.6f} "
    f"after {found.nfev} calls of the law and "
    f"{found.njev} of its slopes"
)
