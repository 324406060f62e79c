"""
Stick and slip in the contact
=============================

A driven or braked cylinder has a creepage: its circumferential speed differs slightly from the
travelling speed.  The front of the contact sticks, the rear slips.  The stick zone shrinks with
increasing creepage and vanishes at the critical creepage ``delta_star``.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3)
limit = vr.contact(scene, V=0.05, delta=0.0).delta_star
figure, panels = plt.subplots(
    1, 3, figsize=(6.4, 3.4), sharex=True, sharey=True, layout="constrained"
)
for axes, share in zip(panels, (0.2, 0.6, 1.0), strict=True):
    c = vr.contact(scene, V=0.05, delta=share * limit)
    rear, front = (
        0.5 * c.lam * (c.epsilon - 1.0),
        0.5 * c.lam * (c.epsilon + 1.0),
    )  # in units of l0, from below the axis
    x = np.linspace(rear, front, 501)
    s = vr.stress(scene, x, V=0.05, delta=share * limit)
    axes.plot(x, 1e3 * scene.mu * s.p, "--", color="0.4", label=r"$\mu p$")
    axes.plot(x, 1e3 * s.tau, label=r"shear stress $\tau$")
    axes.axvspan(
        front - c.beta * c.lam, front, color="0.92", label="stick zone"
    )
    axes.set(
        title=rf"$\delta = {share:g}\,\delta^*$, "
        rf"$Q = {c.Q / scene.mu:.2f}\,\mu P$",
        xlabel="$x/l_0$",
    )
panels[0].set_ylabel(r"stress$/E'\times 10^3$")
figure.legend(
    *panels[0].get_legend_handles_labels(),
    loc="outside lower center",
    ncols=3,
)

# %%
# The cylinder moves to the right.  The material at the leading edge has not relaxed yet, so the
# pressure is higher there, and its centre is ahead of the axis.  The moment of the pressure about
# the axis is the rolling resistance moment.
