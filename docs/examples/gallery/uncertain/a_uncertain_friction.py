"""
Ten thousand motions with uncertain friction
============================================

The coefficient of friction has a standard deviation of ten per cent.  How long does a roller slide
that is launched without rotation?  Ten thousand motions are computed, each with a friction and an
initial speed drawn at random.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy import stats

import viscoroll as vr

roller = vr.presets.RUBBER_CYLINDER
draw = vr.sampling.sample(
    10_000,
    seed=1,
    design="sobol",
    mu=stats.norm(0.3, 0.03),
    V0=stats.uniform(1.8, 0.4),
)  # V0 in m/s, from 1.8 to 2.2
rollers = roller.replace(mu=draw["mu"])  # one for each draw
e = rollers.ensemble(draw["V0"], 0.0, [0.1, 10.0], rtol=1e-6, fields="V")

figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
left.hist(e.onset_time, bins=60, color="0.6")
left.set(xlabel="time of the onset of stick, s", ylabel="motions")
right.plot(draw["mu"][:2000], e.V[:2000, -1], ".", markersize=2)
right.set(xlabel="coefficient of friction", ylabel="speed after 10 s, m/s")
print(np.quantile(e.onset_time, [0.05, 0.5, 0.95]))

# %%
# Friction determines how long the roller slides, but hardly its speed afterwards.  The reason is
# that V + j omega hardly changes while the roller slides, whatever the friction (j is the moment of
# inertia divided by m R^2).
