"""Captions of the figures of the summary page, in order: section -> figure -> caption."""

from __future__ import annotations

SECTIONS: dict[str, dict[str, str]] = {
    "A rubber roller in SI units": {
        "rubber-roller": "A roller of rubber with three relaxation times, R = 0.1 m and 35.5 kg "
        "for each metre of "
        "length, launched at 2 m/s without rotation: it slides until ω R reaches V, and then rolls "
        "on.",
    },
    "The cylinder and its contact": {
        "geometry": "Symbols.  The contact has the length λ l₀.  Its middle lies ahead of the "
        "axis.  Its front part, "
        "of the length β λ l₀, sticks.",
        "figure-2": "Critical creepage as a function of speed; at larger creepage the whole "
        "contact slips.  A fast "
        "contact is stiffer, and slips at a smaller creepage.  κ = 29.1 in this figure and the "
        "next, as in Figs. 2 "
        "and 3 of the paper.",
        "grid": "The grid that make tables wrote: Q as a function of V and δ at three α, for κ = "
        "2.91 and μ = 0.2.  "
        "Beyond the dashed lines, the critical creepage, the whole contact slips, and |Q| = μ P.",
        "figure-3": "Creep force as a function of creepage, and rolling resistance as a function "
        "of speed, with its "
        "maximum (Fig. 3 of the paper).",
    },
    "Free motion from three initial conditions": {
        "figure-5": "V and ω for three starts.  Each cylinder slides until the onset of stick at "
        "t*, and then rolls.  "
        "This is the exact solution of Eq. (22); the speeds are below the range of the "
        "quasi-steady assumption (Fig. "
        "5 of the paper).",
        "figure-6": "The contact during the first motion: creepage, length, shift and stick zone.  "
        "The stick zone "
        "grows within some 10⁻⁴ T_epsilon (Fig. 6 of the paper).",
        "figure-7": "Shear stress and friction limit along the contact at four times.  The narrow "
        "peak at the leading "
        "edge of the last is real: material that has just entered has not relaxed yet.  For the "
        "first time the paper "
        "prints β = 0.45: β rises by 0.2 in 10⁻⁶ there, and equals 0.45 within the last digit of t "
        "(Fig. 7 of the "
        "paper).",
        "phase-portrait": "The plane of V and ω.  Friction leads every motion to one common curve, "
        "the slow manifold, "
        "and along it to rest.",
    },
    "Random initial conditions": {
        "ensemble": "A sample of 10,000 of the 1,000,000 motions.  Left: quantiles over time.  "
        "Right: distribution at "
        "the last time, with a logarithmic axis where nearly all motions are at rest.",
    },
    "Under load": {
        "rolling-equilibria": "Steady speeds, where the force of a slope equals the rolling "
        "resistance.  On a falling "
        "branch of M the equilibrium is unstable.",
        "slope": "Motions on a slope: those that start left of the orange line reach the stable "
        "speed, the others "
        "accelerate without limit.",
        "wheel-spin": (
            "Too large a torque of the motor: the wheel spins, until the torque is reduced."
        ),
        "reversal": "Braked through V = 0: the traction jumps, since the stick zone forms again at "
        "the other end of "
        "the contact.",
    },
    "Other materials": {
        "rolling-resistance": "Rolling resistance of a rubber at three temperatures.",
        "law-of-modes": (
            "One relaxation time and many, with the same moduli: separate maxima, or a plateau."
        ),
        "law-of-pairs": "Rubber on rubber and on steel at the same load; dashed: the part of M in "
        "the base of the "
        "first.",
        "broad-stresses": (
            "Pressure and shear of a rubber with ten relaxation times at four speeds."
        ),
    },
    "Heat": {
        "load-speed": "The load-speed curve of a wheel with a cover of polyurethane, 15 mm thick "
        "and 40 mm wide: the "
        "fastest speed at each load at which it stays below 70 °C.",
    },
}
