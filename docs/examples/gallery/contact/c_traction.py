"""
Creep force over creepage
=========================

The figure shows the creep force Q as a function of the creepage.  At low speed, and for an elastic
material at any speed, the curve is Carter's parabola.  At higher speed the material relaxes less
while it passes through the contact.  The contact is then shorter and stiffer, and full slip begins
at a smaller creepage.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3)
creep = np.linspace(-0.02, 0.02, 401)
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for V, style in zip(
    (1e-4, 0.03, 0.1, 1.0), ("-", "-.", "--", "-"), strict=True
):
    Q = vr.contact(scene, V, delta=creep, fields="Q").Q
    axes.plot(
        100.0 * creep, Q, style, label=rf"$V T_\varepsilon/R = {V:g}$"
    )
axes.plot(
    100.0 * creep,
    vr.contact(scene.replace(alpha=1.0), 1.0, delta=creep).Q,
    "k:",
    label="elastic (Carter)",
)
axes.set(
    xlabel=r"creepage $(\omega R - V)/V$, %", ylabel="creep force $Q/P$"
)
axes.legend(frameon=False)
