"""
Rolling resistance over speed
=============================

Roll slowly, and the material has time to follow.  Roll fast, and it stays stiff.  In
neither case is much energy lost. Between the two, where material passes the contact in
about a relaxation time, rolling resistance has its hump.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

V = np.geomspace(1e-3, 1e2, 400)  # in units of R/T_epsilon
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for alpha in (1.5, 3.0, 11.0, 81.5):
    scene = vr.Scene(alpha=alpha, kappa=10.0, mu=0.3)
    axes.semilogx(
        V, vr.contact(scene, V, delta=0.0, fields="M").M, label=f"alpha = {alpha:g}"
    )
axes.set(
    xlabel="speed V",
    ylabel="rolling resistance M, over load times radius",
    ylim=(0.0, None),
)
axes.legend(frameon=False)

# %%
# ``alpha`` is the modulus at once over that after a long time.  ``kappa`` is the radius
# over the contact length at rest. The hump of one relaxation time stands where kappa V is
# of order 1; M itself goes with 1/kappa, so a hard roller with a narrow contact rolls
# easily.
for alpha in (1.5, 3.0, 11.0, 81.5):
    top = vr.humps(vr.Scene(alpha=alpha, kappa=10.0, mu=0.3))
    print(
        f"alpha = {alpha:4g}: hump at kappa V = {10.0 * top.V[0]:.3f}, kappa M = {10.0 * top.M[0]:.4f}"
    )
