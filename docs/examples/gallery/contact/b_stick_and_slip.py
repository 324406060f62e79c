"""
Stick and slip in the contact
=============================

A driven or braked cylinder creeps: its rim is a little faster or slower than its axis.
The front of the contact sticks, the rear slips.  With more creep the stick zone shrinks,
and at the critical creep ``delta_star`` it is gone.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3)
limit = vr.contact(scene, V=0.05, delta=0.0).delta_star
figure, panels = plt.subplots(
    1, 3, figsize=(9.6, 3.4), sharex=True, sharey=True, layout="constrained"
)
for axes, share in zip(panels, (0.2, 0.6, 1.0), strict=True):
    c = vr.contact(scene, V=0.05, delta=share * limit)
    rear, front = (
        0.5 * c.lam * (c.epsilon - 1.0),
        0.5 * c.lam * (c.epsilon + 1.0),
    )  # over l0, from below the axis
    x = np.linspace(rear, front, 501)
    s = vr.stress(scene, x, V=0.05, delta=share * limit)
    axes.plot(x, 1e3 * scene.mu * s.p, "--", color="0.4", label="mu p")
    axes.plot(x, 1e3 * s.tau, label="shear")
    axes.axvspan(front - c.beta * c.lam, front, color="0.92", label="stick")
    axes.set(
        title=f"creep {share:g} delta_star, Q = {c.Q / scene.mu:.2f} mu", xlabel="x / l0"
    )
panels[0].set_ylabel("stress / E', times 1000")
panels[0].legend(frameon=False, loc="upper left")

# %%
# The cylinder moves to the right.  Pressure leans forward, because the material in front
# has not yet relaxed: that is where rolling resistance comes from.
