"""
Motions on a slope
==================

The figure shows motions on a slope of 3 degrees in the plane of V (speed of the axis) and omega
(angular velocity).  Motions that start left of the orange line (separatrix) settle at the stable
steady speed (filled dot).  Motions that start right of it accelerate without limit.  The line ends
at the unstable steady speed (open dot).
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

scene, slope = vr.presets.PAPER_SECTION_5, np.radians(3.0)
s = vr.steady(scene, slope=slope)
node, saddle = s.V
plane = np.array([-0.5, 2.0]) * saddle

# %%
# The separatrix is found by bisection: for each omega the code searches the V that divides motions
# which settle from motions which accelerate.  Each motion is computed for 30 times the slowest time
# constant at the unstable speed; then its V is clearly below or above this speed.
across = np.linspace(*plane, 81)
rate = s.eigenvalues[1].real.max() * scene.gamma * np.cos(slope)
# V + j omega hardly changes while all of the contact slips
guess = saddle + scene.j * (s.omega[1] - across)
low, high = guess - saddle, guess + saddle
for _ in range(40):
    middle = 0.5 * (low + high)
    end = vr.ensemble(
        scene, middle, across, 30.0 / rate, slope=slope, rtol=1e-6
    )
    runs_away = end.V[:, 0] > saddle
    low, high = (
        np.where(runs_away, low, middle),
        np.where(runs_away, middle, high),
    )
separatrix = 0.5 * (low + high)

# %%
# The right panel shows the difference omega - V, enlarged a thousand times.
V = np.linspace(*plane, 801)
band = vr.contact(scene, V, delta=0.0).delta_star * np.abs(V)
end = 150.0 / scene.gamma
starts = [
    (V0, omega0) for V0 in np.linspace(*plane, 11)[1:-1] for omega0 in plane
]
starts += [(share * saddle, share * s.omega[1]) for share in (0.999, 1.001)]
motions = [
    vr.roll(scene, *start, end, rtol=1e-6, slope=slope).course
    for start in starts
]

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
    axes.plot(
        separatrix,
        tilt * separatrix + unit * (across - separatrix),
        "C1",
        lw=2.0,
        label="separatrix",
    )
    for n, face, name in (
        (0, "black", "stable speed"),
        (1, "white", "unstable speed"),
    ):
        height = tilt * s.V[n] + unit * (s.omega[n] - s.V[n])
        axes.plot(
            s.V[n],
            height,
            "o",
            color="black",
            mfc=face,
            zorder=4,
            label=name,
        )
    axes.set(xlabel=r"$V T_\varepsilon/R$", box_aspect=1.0)
left.set(xlim=plane, ylim=plane, ylabel=r"$\omega T_\varepsilon$")
room = 1.2e3 * band[(V > -0.2 * saddle) & (V < 1.6 * saddle)].max()
right.set(xlim=(-0.2 * saddle, 1.6 * saddle), ylim=(-room, room))
right.set_ylabel(r"$(\omega T_\varepsilon - V T_\varepsilon/R)\times 10^3$")
figure.legend(
    *left.get_legend_handles_labels(), loc="outside lower center", ncols=4
)
figure.suptitle("White: partial slip; grey: full slip")
