"""
3. Uncertain friction
=====================

The coefficient of friction between steel and rubber lies between 0.3 and 0.7, the slope between
0.45 and 0.55 degrees.  Twenty thousand motions show the influence of each.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy import stats

import viscoroll as vr

shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
rubber = (
    vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
    .material(nu=0.49, name="rubber", density=1100.0)
    .at(60.0, shift=shift)
)
steel = vr.Material.elastic(E=2.1e11, nu=0.3, density=7850.0)
roller = vr.Cylinder(R=0.1, m=247.0, material=steel, base=rubber, mu=0.5)

# %%
# Draw friction and slope.  A Sobol sequence covers both ranges more evenly than random numbers.
# With the same ``seed`` the same values are drawn again.
draw = vr.sampling.sample(
    20_000,
    seed=1,
    design="sobol",
    mu=stats.uniform(0.3, 0.4),
    slope=stats.uniform(0.45, 0.1),
)  # the slope in degrees, from 0.45 to 0.55; friction from 0.3 to 0.7
rollers = roller.replace(mu=draw["mu"])  # one for each draw
e = rollers.ensemble(
    2.0,
    0.0,
    [1.0, 120.0],
    slope=np.radians(draw["slope"]),
    rtol=1e-6,
    fields="V",
)
sliding, late = e.onset_time, e.V[:, -1]  # s, m/s

figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
left.plot(draw["mu"][:3000], sliding[:3000], ".", markersize=2)
left.set(
    xlabel=r"coefficient of friction $\mu$", ylabel="duration of sliding, s"
)
right.plot(draw["slope"][:3000], late[:3000], ".", markersize=2)
right.set(xlabel="slope, degrees", ylabel="speed after 120 s, m/s")
print(
    "duration of sliding, s (5 %, 50 %, 95 %):",
    np.quantile(sliding, [0.05, 0.5, 0.95]).round(3),
)
print(
    "speed after 120 s, m/s (5 %, 50 %, 95 %): ",
    np.quantile(late, [0.05, 0.5, 0.95]).round(3),
)

# %%
# Friction determines the duration of sliding, some tenths of a second, but has no influence on the
# speed after two minutes.  That speed depends on the slope.  So, to predict it better, measure the
# slope.
#
# Next steps: :doc:`/ensembles` shows how to compute a million motions from a run file, and
# :doc:`/sensitivity` how much of the variance is due to each input.
