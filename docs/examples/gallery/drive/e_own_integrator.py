"""
The law in your own integrator
==============================

A tractor tows a roller by a spring.  The roller oscillates behind the tractor until the force of
the spring equals the rolling resistance.  viscoroll does not compute such a system.  But ``vr.law``
gives the creep force and the rolling resistance of the roller, with their derivatives, so that a
general integrator, here Radau of SciPy, can compute it.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import viscoroll as vr

# units: time 1 s, length R = 0.1 m, force the load
scene = vr.presets.RUBBER_ROLLER
law, gamma, j = vr.law(scene), scene.gamma, scene.j
speed = 0.5  # of the tractor, radii a second
stiffness = 0.02  # of the spring, load per radius


def rates(t, y):
    stretch, V, omega = y
    f = law(V, omega)
    pull = stiffness * stretch
    return (
        speed - V,
        gamma * (f.Q - f.M_half_space + pull),
        gamma / j * (-f.Q - f.M_cylinder),
    )


def jacobian(t, y):
    f = law(*y[1:], slopes=True)
    a, b = f.dQ_dV - f.dM_half_space_dV, f.dQ_dV + f.dM_cylinder_dV
    return [
        [0.0, -1.0, 0.0],
        [gamma * stiffness, gamma * a, gamma * f.dQ_domega],
        [0.0, -gamma / j * b, -gamma / j * f.dQ_domega],
    ]


t = np.linspace(0.0, 40.0, 801)
start = [0.0, 0.25, 0.25]
found = solve_ivp(
    rates,
    (0.0, 40.0),
    start,
    "Radau",
    t,
    jac=jacobian,
    rtol=1e-6,
    atol=1e-8,
)
figure, (top, bottom) = plt.subplots(
    2, 1, figsize=(6.4, 4.6), sharex=True, layout="constrained"
)
top.plot(t, 0.1 * found.y[1])
top.set(ylabel="speed, m/s")
bottom.plot(t, 100.0 * stiffness * found.y[0])
resistance = 100.0 * law(speed, speed).M
bottom.axhline(
    resistance, color="0.4", linewidth=0.8, label="rolling resistance"
)
bottom.set(xlabel="$t$, s", ylabel="spring force, % of the load")
bottom.legend(frameon=False)
print(f"{found.nfev} calls of the law, {found.njev} of its slopes")

# %%
# The horizontal line is the rolling resistance at the speed of the tractor.  The law can also be
# called from functions that numba compiles and from C: :doc:`/howto/law`.
