"""
Rolling resistance over speed
=============================

At low speed the material relaxes completely while it passes through the contact, at high speed it
hardly relaxes.  In both cases little energy is lost.  Rolling resistance has its maximum at the
speed at which a point passes through the contact in about the relaxation time.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

V = np.geomspace(1e-3, 1e2, 400)  # in units of R/T_epsilon
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for alpha, style in zip(
    (1.5, 3.0, 11.0, 81.5), (":", "-.", "--", "-"), strict=True
):
    scene = vr.Scene(alpha=alpha, kappa=10.0, mu=0.3)
    M = vr.contact(scene, V, delta=0.0, fields="M").M
    axes.semilogx(V, M, style, label=rf"$\alpha = {alpha:g}$")
axes.set(
    xlabel=r"speed $V T_\varepsilon/R$",
    ylabel="rolling resistance $M/(PR)$",
    ylim=(0.0, None),
)
axes.legend(frameon=False)

# %%
# ``alpha`` is the instantaneous modulus divided by the long-time modulus, ``kappa`` the radius R
# divided by the contact length at rest.  V is in units of R/T_epsilon, with the retardation time
# T_epsilon, and the moment M in units of the load times R.  The maximum lies near kappa V = 1.  At
# a given alpha the maximum of M is proportional to 1/kappa: a hard roller with a short contact has
# little rolling resistance.
for alpha in (1.5, 3.0, 11.0, 81.5):
    top = vr.resistance_extrema(vr.Scene(alpha=alpha, kappa=10.0, mu=0.3))
    print(
        f"alpha = {alpha:4g}: maximum at "
        f"kappa V = {10.0 * top.V[0]:.3f}, kappa M = "
        f"{10.0 * top.M[0]:.4f}"
    )
