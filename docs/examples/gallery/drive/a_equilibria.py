"""
Terminal speeds on a slope
==========================

A slope pulls with sin(slope) of the weight.  The roller settles where rolling resistance
is as large.  Behind each hump there is a second speed of balance, which is unstable: from
there the roller either falls back or runs away.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

# relaxation times two decades apart: a hump each
times = 100.0 ** -np.arange(5.0)
rubber = vr.Scene(material=vr.Prony(2.0 ** np.arange(5), times), kappa=10.0, mu=0.2)

figure, panels = plt.subplots(1, 2, figsize=(9.5, 4.2), layout="constrained")
for axes, scene, title in zip(
    panels,
    (vr.presets.PAPER_SECTION_5, rubber),
    ("a) one relaxation time", "b) five relaxation times"),
    strict=True,
):
    hump = vr.resistance_extrema(scene)
    V = np.geomspace(hump.V[0] / 30.0, 30.0 * hump.V[-1], 801)
    axes.semilogx(V, vr.contact(scene, V, delta=0.0, fields="M").M, "k", label="M")
    for pull in (0.35, 0.7, 0.95):  # of the largest M
        slope = np.arctan(pull * hump.M.max())
        s = vr.steady(scene, slope=slope)
        axes.axhline(np.tan(slope), color="0.7", linewidth=0.6)
        axes.text(V[0], np.tan(slope), f"{np.degrees(slope):.2g} degrees", fontsize=8)
        axes.plot(s.V[s.stable], s.M[s.stable], "o", color="C0")
        axes.plot(s.V[~s.stable], s.M[~s.stable], "o", color="C0", mfc="white")
    axes.set(xlabel="V", title=title, xlim=(V[0], V[-1]), ylim=(0.0, None))
panels[0].set_ylabel("M; pull of the slope")
figure.suptitle("Equilibria: stable (filled) and unstable (open)", fontsize="medium")

# %%
# For one roller, in SI units:
s = vr.presets.RUBBER_CYLINDER.steady(slope=np.radians(0.3))
for V, stable in zip(s.V, s.stable, strict=True):
    print(f"{V:10.3g} m/s, {'stable' if stable else 'unstable'}")
