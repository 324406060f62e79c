"""
How steady is steady?
=====================

The law of steady rolling knows the speed, not its past.  Where the speed changes slowly,
the next term is known too: M = M(V) + N(V) V'.  N acts like an added mass, and its size
against (1 + j)/gamma says whether steady rolling may drive a motion.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import cumulative_trapezoid

import viscoroll as vr

rubber = vr.RUBBER_CYLINDER
V = np.geomspace(1e-3, 20.0, 4000)  # m/s
figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
for slower in (1.0, 3.0, 6.0):
    scene = rubber.scene()
    scene = scene.replace(material=scene.material.slower(slower))
    c = vr.contact(scene, rubber.V_from_si(V), delta=0.0, fields=("M", "N"))
    left.semilogx(V, scene.gamma * c.N / (1.0 + scene.j), label=f"times {slower:g}")
    # time to slow down from 2 m/s, without N and with it: gamma M dt = -(1 + j + gamma N) dV
    start = np.searchsorted(V, 2.0)
    for inertia, style in ((0.0, "-"), (1.0, ":")):
        rate = (1.0 + scene.j + inertia * scene.gamma * c.N) / (scene.gamma * c.M)
        t = cumulative_trapezoid(rate[:start], rubber.V_from_si(V[:start]), initial=0.0)
        right.plot(
            rubber.t_to_si(t[-1] - t), V[:start], style, color=left.lines[-1].get_color()
        )
    print(
        f"relaxation times x {slower:g}: {scene.validity(rubber.V_from_si(2.0)).steady.sentence}"
    )
left.set(xlabel="speed, m/s", ylabel="gamma N/(1 + j)")
left.legend(title="relaxation times", frameon=False)
right.set(
    xlabel="t, s",
    ylabel="speed, m/s",
    xlim=(0.0, 60.0),
    ylim=(0.0, None),
    title="rolling; dotted: with N",
)

# %%
# ``validity().steady`` is this number, taken at its largest from rest to the given speed.
# Up to 0.4 the motion is within some 10 % of the first speed.  What lies beyond:
# :doc:`/may_i`.
