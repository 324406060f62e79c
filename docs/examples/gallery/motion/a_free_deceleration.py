"""
A rubber roller slows down
==========================

A roller of a measured rubber is launched at 2 m/s without rotation.  It slides first: friction
accelerates its rotation within a seventh of a second.  Then it rolls, and rolling resistance
slows it down for most of a minute.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv"))).material(
    nu=0.49, density=1100.0
)
roller = vr.Cylinder(R=0.1, m=35.5, material=rubber, mu=0.5)
t = np.unique(
    np.concatenate(
        [np.linspace(0.0, 0.5, 201), np.linspace(0.5, 60.0, 201)]
    )
)  # s
m = roller.roll(V0=2.0, omega0=0.0, t=t)
figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
for axes, end in ((left, 0.5), (right, 60.0)):
    axes.plot(m.t, m.V, label="$V$")
    axes.plot(m.t, roller.R * m.omega, "--", label=r"$\omega R$")
    axes.set(
        xlabel="$t$, s",
        ylabel="speed, m/s",
        xlim=(0.0, end),
        ylim=(0.0, None),
    )
left.axvline(m.onset_time, color="0.6", linewidth=0.8)
left.annotate(
    "onset of stick",
    (m.onset_time, 0.3),
    (6, 0),
    textcoords="offset points",
)
right.legend(frameon=False)
print(
    f"onset of stick at {m.onset_time:.3f} s; "
    f"after {m.t[-1]:g} s it has rolled {m.x[-1]:.1f} m"
)

# %%
# ``roll`` uses the contact of steady rolling at each instant (quasi-steady assumption).  Is this
# accurate enough?  Yes, down to some centimetres per second.  From there the roller rolls only a
# short distance:
print(m.validity().steady.sentence)
