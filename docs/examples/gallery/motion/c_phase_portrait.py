"""
Phase portrait
==============

V is the speed of the axis and omega the angular velocity, both dimensionless.  Each line is a
motion. In full slip (grey) friction brings omega towards V, and V + j omega hardly changes (j is
the moment of inertia divided by m R^2).  In partial slip (white) all motions approach one common
curve, the slow manifold (black), on which omega is nearly equal to V, and follow it towards rest.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene, radius = vr.presets.PAPER_SECTION_5, 2.0
angles = (np.arange(24) + 0.5) * np.pi / 12.0
starts = [(radius * np.cos(a), radius * np.sin(a)) for a in angles]
motions = [
    vr.roll(scene, *start, 60.0 / scene.gamma).course for start in starts
]
rest = vr.roll(scene, 2.5, 2.5, 1e6 / scene.gamma, rest=1e-3).rest_time
rolling = vr.roll(scene, 2.5, 2.5, rest).course
# the first step approaches the manifold
late = rolling.t > 0.05 / scene.gamma

V = np.linspace(-2.5, 2.5, 801)
band = vr.contact(scene, V, delta=0.0).delta_star * np.abs(V)
figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.7), layout="constrained"
)
for axes, tilt, unit in ((left, 1.0, 1.0), (right, 0.0, 1e3)):
    axes.set_facecolor("0.87")
    axes.fill_between(
        V, tilt * V - unit * band, tilt * V + unit * band, color="white"
    )
    for m in motions:
        fine = m.at(np.unique(np.linspace(m.t[:-1], m.t[1:], 6)))
        height = tilt * fine.V + unit * (fine.omega - fine.V)
        axes.plot(
            fine.V,
            height,
            "C0",
            lw=0.9,
            label="motions" if m is motions[0] else None,
        )
    slow = rolling.at(rolling.t[late])
    for sign in (1.0, -1.0):
        height = tilt * slow.V + unit * (slow.omega - slow.V)
        axes.plot(
            sign * slow.V,
            sign * height,
            "k",
            lw=2.0,
            zorder=3,
            label="slow manifold" if sign > 0.0 else None,
        )
    axes.set(xlabel=r"$V T_\varepsilon/R$", box_aspect=1.0)
left.plot(*np.transpose(starts), "C0.", label="initial speeds")
figure.legend(
    *left.get_legend_handles_labels(), loc="outside lower center", ncols=3
)
figure.suptitle("White: partial slip; grey: full slip")
left.set(
    xlim=(-2.3, 2.3), ylim=(-2.3, 2.3), ylabel=r"$\omega T_\varepsilon$"
)
room = 1.15e3 * band[np.abs(V) <= radius].max()
right.set(xlim=(-2.0, 2.0), ylim=(-room, room))
right.set_ylabel(r"$(\omega T_\varepsilon - V T_\varepsilon/R)\times 10^3$")

# %%
# In the white area the contact slips partially.  This area is only some thousandths of V wide, so
# the right panel shows the difference omega - V, enlarged a thousand times.
