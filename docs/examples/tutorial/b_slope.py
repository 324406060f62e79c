"""
2. A roller on a slope
======================

The steel roller of step 1 rolls down a slope of half a degree.  The slope is covered with the
rubber, at 60 °C.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
measured = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
cool = measured.material(nu=0.49, name="rubber", density=1100.0)  # at 20 °C
rubber = cool.at(60.0, shift=shift)
steel = vr.Material.elastic(E=2.1e11, nu=0.3, density=7850.0)
roller = vr.Cylinder(R=0.1, m=247.0, material=steel, base=rubber, mu=0.5)
slope = np.radians(0.5)

# %%
# First check the assumptions of the model.  ``validity`` lists all of them.  A motion needs one
# assumption that a contact at constant speed does not need: the speed must change little in the time
# in which a point passes through the contact (``steady`` in the list).
print(roller.validity(2.0))

# %%
# No assumption is violated, and the error of the speed V stays below 1 % at every speed.  At 20 °C
# the relaxation times are 300 times longer.  Then the error exceeds 1 %, but at low speeds only
# (:doc:`/validity`):
print(roller.replace(base=cool).validity(2.0).steady.sentence)

# %%
# ``steady`` finds every speed at which the rolling resistance balances the pull of the slope.
s = roller.steady(slope=slope)
for V, stable in zip(s.V, s.stable, strict=True):
    print(f"{V:.3g} m/s: {'stable' if stable else 'unstable'}")

# %%
# The first, lower speed is the terminal speed.  The second one is unstable, and so high that it has
# no practical meaning.
#
# Now the roller is launched at 2 m/s without rotation.  It slides until friction has accelerated
# its rotation.  Then it rolls, and slowly approaches its terminal speed.
t = np.unique(
    np.concatenate(
        [np.linspace(0.0, 0.3, 151), np.linspace(0.3, 120.0, 240)]
    )
)
m = roller.roll(V0=2.0, omega0=0.0, t=t, slope=slope)
figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
for axes, end in ((left, 0.3), (right, 120.0)):
    axes.plot(m.t, m.V, label="$V$")
    axes.plot(m.t, roller.R * m.omega, "--", label=r"$\omega R$")
    axes.set(
        xlabel="$t$, s",
        ylabel="speed, m/s",
        xlim=(0.0, end),
        ylim=(0.0, None),
    )
right.axhline(s.V[0], color="0.6", linewidth=0.8)
right.annotate(
    "terminal speed", (60.0, s.V[0]), (0, -14), textcoords="offset points"
)
left.legend(frameon=False)
print(f"it slides for {m.onset_time:.3f} s")

# %%
# The energies, in J per metre of length: lost by slip, lost by rolling resistance, and gained from
# gravity on the slope.
print(
    f"slip {m.slip_loss[-1]:.0f}, rolling {m.rolling_loss[-1]:.0f}, "
    "from the slope "
    f"{m.work_force[-1]:.0f}"
)
