"""
Braked through V = 0
====================

A torque against the motion slows the cylinder down and then drives it backwards.  When the speed V
passes through zero, the trailing edge of the contact becomes the leading edge, where the stick zone
forms again.  Therefore the creep force Q jumps, and the curves of V and omega have a kink.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene, V0 = vr.presets.PAPER_SECTION_5, 0.5
torque = -0.85 * (1.0 + scene.j) * scene.mu
end = 3.0 * V0 / (scene.gamma * abs(torque))
turn = vr.roll(scene, V0, V0, end, torque=torque).reversals[0]
apart = turn * np.geomspace(1e-9, 0.5, 200)
t = np.unique(
    np.concatenate([turn - apart, turn + apart, np.linspace(0.0, end, 801)])
)
m = vr.roll(scene, V0, V0, t, torque=torque)
Q = m.contact("Q").Q

figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.6), layout="constrained"
)
left.plot(t, m.V, "k", label="$V$")
left.plot(t, m.omega, "--", label=r"$\omega$")
left.axvline(turn, color="0.7", linewidth=0.6)
left.axhline(0.0, color="0.7", linewidth=0.6)
left.set(
    xlabel=r"$t/T_\varepsilon$",
    ylabel=r"$V T_\varepsilon/R$, $\omega T_\varepsilon$",
    title="a) speeds",
)
left.legend(frameon=False)
inset = right.inset_axes((0.5, 0.5, 0.46, 0.44))
inset.set_xticks([turn], ["$V = 0$"])
near = np.abs(t - turn) < 0.06 * turn
for axes, shown in ((right, t > 0.0), (inset, near)):
    for side in (t < turn, t > turn):
        axes.plot(t[side & shown], Q[side & shown], "k")
right.axhline(-scene.mu, color="0.7", linewidth=0.6)
right.text(0.0, -scene.mu, r"$-\mu$", va="bottom", fontsize="small")
right.set(
    xlabel=r"$t/T_\varepsilon$",
    ylabel="traction $Q/P$",
    title="b) traction; inset: near $V = 0$",
)
right.set(ylim=(-1.05 * scene.mu, 0.02 * scene.mu))
