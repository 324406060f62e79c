"""
Terminal speeds on a slope
==========================

Gravity pulls a roller down the slope with the force sin(slope) times the weight.  The roller
settles at a speed at which the rolling resistance is equal to this force and rises with the speed.
Where the rolling resistance is equal to the force but falls as the speed grows, the steady speed is
unstable.  A slightly slower roller slows down to the next lower stable speed, and a slightly faster
one accelerates.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullFormatter

import viscoroll as vr

# relaxation times two decades apart: one maximum of M for each
times = 100.0 ** -np.arange(5.0)
rubber = vr.Scene(
    material=vr.Prony(2.0 ** np.arange(5), times), kappa=10.0, mu=0.2
)

figure, panels = plt.subplots(
    1, 2, figsize=(6.4, 3.6), layout="constrained"
)
for axes, scene, title, unit in zip(
    panels,
    (vr.presets.PAPER_SECTION_5, rubber),
    ("a) one relaxation time", "b) five relaxation times"),
    (r"T_\varepsilon", r"T_\mathrm{ref}"),
    strict=True,
):
    extrema = vr.resistance_extrema(scene)
    V = np.geomspace(extrema.V[0] / 20.0, 20.0 * extrema.V[-1], 801)
    axes.semilogx(
        V, vr.contact(scene, V, delta=0.0, fields="M").M, "k", label="M"
    )
    for pull in (0.35, 0.7, 0.95):  # of the largest M
        slope = np.arctan(pull * extrema.M.max())
        s = vr.steady(scene, slope=slope)
        axes.axhline(np.tan(slope), color="0.7", linewidth=0.6)
        axes.text(
            0.99,
            np.tan(slope),
            f"{np.degrees(slope):.2g}°",
            transform=axes.get_yaxis_transform(),
            ha="right",
            va="bottom",
            fontsize="small",
        )
        axes.plot(s.V[s.stable], s.M[s.stable], "o", color="C0")
        axes.plot(
            s.V[~s.stable], s.M[~s.stable], "o", color="C0", mfc="white"
        )
    axes.set(
        xlabel=rf"speed $V {unit}/R$",
        title=title,
        xlim=(V[0], 6.0 * V[-1]),
        ylim=(0.0, None),
    )
    axes.xaxis.set_minor_formatter(NullFormatter())
panels[0].set_ylabel("rolling resistance $M/(PR)$; tan(slope)")
figure.suptitle(
    "Steady speeds on three slopes: stable (filled) and unstable (open)",
    fontsize="medium",
)

# %%
# The same for one roller in SI units.  The theory neglects the inertia of the rubber, and holds up
# to 20 % of the shear wave speed of the rubber, sqrt(G/density), with the shear modulus G.  The last
# two steady speeds exceed the shear wave speed, so the theory does not apply to them.
roller = vr.presets.RUBBER_CYLINDER
s = roller.steady(slope=np.radians(0.3))
share = roller.validity(s.V).quasistatic.value
for V, stable, part in zip(s.V, s.stable, share, strict=True):
    word = "stable" if stable else "unstable"
    print(
        f"{V:10.3g} m/s, {word}, "
        f"{100.0 * part:.0f} % of the shear wave speed"
    )
