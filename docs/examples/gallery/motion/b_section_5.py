"""
The example of the paper
========================

Sect. 5 of the paper by Zobova and Goryacheva has three motions of a soft, slow cylinder; its Fig. 5
shows V and omega.  The figure here shows the exact solution of Eq. (22) of the paper for them.  A
real cylinder would move differently: at 9 mm/s the quasi-steady assumption is violated
(:doc:`/validity_measured`).
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene = vr.presets.PAPER_SECTION_5
t = np.linspace(0.0, 4e-3, 2001)  # in units of T_epsilon
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for n, (name, start) in enumerate(vr.presets.PAPER_STARTS.items()):
    m = vr.roll(scene, *start, t)
    axes.plot(1e4 * t, m.V, f"C{n}", label="$V$" if n == 0 else None)
    axes.plot(
        1e4 * t, m.omega, f"C{n}--", label=r"$\omega$" if n == 0 else None
    )
    axes.annotate(
        name,
        (7.0, m.V[350]),
        (0, 9),
        textcoords="offset points",
        color=f"C{n}",
    )
    axes.axvline(
        1e4 * m.onset_time, color=f"C{n}", linewidth=0.9, linestyle=":"
    )
axes.set(
    xlabel=r"$t/T_\varepsilon\times 10^4$",
    ylabel=r"$V T_\varepsilon/R$, $\omega T_\varepsilon$",
    xlim=(0.0, 40.0),
)
axes.set_title(
    "Fig. 5 of the paper; vertical lines: onset of stick", fontsize="medium"
)
axes.legend(frameon=False)

# %%
# The next figure shows the contact during the first motion (Fig. 6 of the paper).  After full slip
# has ended, the stick zone ``beta`` (divided by the contact length) grows within some 1e-4
# T_epsilon, with the retardation time T_epsilon, and the creepage ``delta`` falls to nearly 0.
# Circles mark the times of Fig. 7 of the paper.
onset = vr.roll(scene, 1.5, 0.5, t).onset_time
t = np.unique(np.concatenate([t, onset * np.linspace(0.9, 1.3, 401)]))
m = vr.roll(scene, 1.5, 0.5, t)
marked = vr.roll(scene, 1.5, 0.5, [1.52e-4, 4e-4, 24e-4, 30e-4])
SYMBOLS = {
    "delta": r"$\delta$",
    "lam": r"$\lambda$",
    "epsilon": r"$\varepsilon$",
    "beta": r"$\beta$",
}
contact, (near, whole) = plt.subplots(
    1,
    2,
    figsize=(6.4, 3.6),
    sharey=True,
    width_ratios=(1.0, 1.6),
    layout="constrained",
)
for axes, end in ((near, 1.25 * onset), (whole, t[-1])):
    for n, name in enumerate(SYMBOLS):
        for motion, style in (
            (m, ("-", "--", "-.", ":")[n]),
            (marked, "o"),
        ):
            values = (
                motion.delta
                if name == "delta"
                else getattr(motion.contact(name), name)
            )
            axes.plot(
                1e4 * motion.t,
                values,
                f"C{n}{style}",
                mfc="none",
                label="_" if motion is marked else SYMBOLS[name],
            )
    axes.set(
        xlim=(0.0, 1e4 * end),
        ylim=(-0.75, 1.1),
        xlabel=r"$t/T_\varepsilon\times 10^4$",
    )
near.set_ylabel("contact state")
whole.legend(frameon=False)
contact.suptitle(
    "Fig. 6 of the paper; circles: times of Fig. 7", fontsize="medium"
)
