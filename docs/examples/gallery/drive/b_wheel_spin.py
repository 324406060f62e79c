"""
A start with wheel spin
=======================

The torque of a motor rises linearly.  If it exceeds (1 + j) mu P R, with the load P, the radius R,
the friction mu and the moment of inertia j m R^2, the whole contact slips and the wheel spins.
When the torque is reduced, the stick zone forms again.  The times of full slip are grey.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene = vr.presets.PAPER_SECTION_5
grip = (1.0 + scene.j) * scene.mu
times = np.array([0.0, 5.0, 8.0, 8.0]) / scene.gamma
torque = np.array([0.0, 2.0, 2.0, 0.25]) * grip
t = np.unique(
    np.concatenate([np.linspace(0.0, 16.0 / scene.gamma, 801), times])
)
m = vr.roll(scene, 0.0, 0.0, t, torque=vr.Schedule(times, torque))

figure, (top, bottom) = plt.subplots(
    2, 1, figsize=(6.4, 4.8), sharex=True, layout="constrained"
)
top.plot(t, m.V, "k", label="$V$")
top.plot(t, m.omega, "--", label=r"$\omega$")
bottom.plot(t, m.contact("Q").Q, "k", label="traction $Q/P$")
bottom.plot(t, m.torque, "--", label="torque$/(PR)$")
for limit, name in ((scene.mu, r"$\mu$"), (grip, r"$(1 + j)\,\mu$")):
    bottom.axhline(limit, color="0.7", linewidth=0.6)
    bottom.text(0.99 * t[-1], limit, name, ha="right", va="bottom")
ends = [*(switch.t for switch in m.switches[1:]), t[-1]]
for switch, end in zip(m.switches, ends, strict=True):
    if switch.regime == "full slip":
        for axes in (top, bottom):
            axes.axvspan(switch.t, end, color="0.87", linewidth=0.0)
top.set(
    ylabel=r"$V T_\varepsilon/R$, $\omega T_\varepsilon$", xlim=(0.0, t[-1])
)
bottom.set(
    xlabel=r"$t/T_\varepsilon$",
    ylabel="$Q/P$, torque$/(PR)$",
    ylim=(None, 2.15 * grip),
)
for axes in (top, bottom):
    axes.legend(loc="upper left")
