"""
A rubber with many relaxation times
===================================

Real rubbers relax over many decades of time.  If the relaxation times are decades apart, the
rolling resistance has a maximum for each of them.  If they are close together, it has a plateau.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr


def broad(modes: int, decades: float) -> vr.Prony:
    """Instantaneous modulus eleven times the long-time one; equal modes.

    Their times are evenly spaced.
    """
    return vr.Prony(
        np.full(modes, 10.0 / modes), np.logspace(0.0, -decades, modes)
    )


materials = {
    "1 mode": vr.Prony([10.0], [1.0]),
    "2 modes, 5 decades": broad(2, 5.0),
    "5 modes, 5 decades": broad(5, 5.0),
    "10 modes, 10 decades": broad(10, 10.0),
}
V = np.logspace(-3.0, 9.0, 601)
SYMBOLS = {
    "lam": r"$\lambda$",
    "epsilon": r"$\varepsilon$",
    "delta_star": r"$\kappa\delta^*/\mu$",
    "M": r"$\kappa M$",
}
figure, panels = plt.subplots(
    2, 2, figsize=(6.4, 5.5), sharex=True, layout="constrained"
)
for (name, material), style in zip(
    materials.items(), ("k-", "--", "-.", ":"), strict=True
):
    c = vr.contact(
        vr.Scene(material=material, kappa=1.0, mu=1.0), V, delta=0.0
    )
    for axes, field in zip(panels.flat, SYMBOLS, strict=True):
        axes.semilogx(V, getattr(c, field), style, label=name)
        axes.set(ylabel=SYMBOLS[field], ylim=(0.0, None))
for axes in panels[1]:
    axes.set(xlabel=r"$\kappa V$", xlim=(V[0], V[-1]))
panels[0, 1].legend(frameon=False, fontsize="small")

# %%
# All four materials have the same long-time and the same instantaneous modulus.  lambda is the
# contact length divided by that at rest, epsilon the shift of the contact ahead of the axis, in
# half contact lengths.
#
# The next figure shows the stresses of the material with ten relaxation times over ten decades, at
# four speeds.  The creepage is half of that at which full slip begins.  The stresses are divided by
# the largest pressure at rest:
scene = vr.Scene(
    material=materials["10 modes, 10 decades"], kappa=1.0, mu=1.0
)
stresses, (pressure, shear) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
for speed, style in zip(
    (1e-2, 1.0, 1e3, 1e7), ("k-", "--", "-.", ":"), strict=True
):
    c = vr.contact(scene, speed, delta=0.0)
    x = 0.5 * c.lam * (c.epsilon - np.cos(np.linspace(0.0, np.pi, 801)))
    s = vr.stress(scene, x, speed, delta=0.5 * c.delta_star)
    for axes, values in ((pressure, s.p), (shear, s.tau)):
        axes.plot(
            x,
            8.0 * np.pi * values,
            style,
            label=rf"$\kappa V = {speed:g}$"
            if speed < 1e4
            else r"$\kappa V = 10^7$",
        )
pressure.set(
    xlabel="$x/l_0$",
    ylabel=r"pressure $p/p_{\mathrm{static}}$",
    ylim=(0.0, None),
)
shear.set(
    xlabel="$x/l_0$",
    ylabel=r"shear stress $\tau/(\mu p_{\mathrm{static}})$",
    ylim=(0.0, None),
)
pressure.legend(frameon=False, fontsize="small")
