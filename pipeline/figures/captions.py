"""The pictures of the summary page in their order: section -> figure -> what it shows, in one or two sentences."""

from __future__ import annotations

SECTIONS: dict[str, dict[str, str]] = {
    "The cylinder and its contact": {
        "geometry": "What the symbols mean.  The contact has the length λ l₀, its middle lies ahead of the axis, and "
        "its front part, the share β, sticks.",
        "figure-2": "The critical creep ratio, beyond which all of the contact slips, over speed.  A fast contact is "
        "stiffer and slips sooner.  (Fig. 2 of the paper.)",
        "figure-3": "Traction over creep, and rolling resistance over speed with its hump.  (Fig. 3 of the paper.)",
    },
    "Three throws": {
        "figure-5": "Speed and spin of the three starts.  Each slides until rim and axis meet, at t*, and then rolls.  "
        "(Fig. 5 of the paper.)",
        "figure-6": "The contact during the first: creep, length, shift and stick zone.  The stick zone opens within a "
        "few ten-thousandths of T_epsilon.  (Fig. 6 of the paper.)",
        "figure-7": "Shear and the limit of friction along the contact at four times.  The narrow peak at the front of "
        "the last is real: material that has just come in is not relaxed yet.  For the first the paper prints "
        "β = 0.45: β climbs by 0.2 in 10⁻⁶ there, and is 0.45 within the last digit of t.  (Fig. 7 of the paper.)",
        "phase-portrait": "The plane of V and ω.  From anywhere friction leads to one common curve, and along "
        "it to rest.",
    },
    "Random throws": {
        "ensemble": "Left: over time, by quantiles.  Right: at the end.",
    },
    "Under load": {
        "rolling-equilibria": "Where the pull of a slope meets rolling resistance.  Behind a hump the balance is "
        "unstable.",
        "slope": "On a slope: what settles (left of the orange line) and what runs away.",
        "wheel-spin": "A motor that gives too much torque: the wheel spins, and grips again.",
        "reversal": "Braked through V = 0: the traction jumps, for the stick zone forms anew at the other end.",
    },
    "Other materials": {
        "rolling-resistance": "Rolling resistance of a rubber at three temperatures.",
        "law-of-modes": "One relaxation time and many, with the same moduli: humps far apart, or a plateau.",
        "law-of-pairs": "Rubber on rubber and on steel under one load; dashed: the part of M in the base.",
        "broad-stresses": "Pressure and shear of a rubber with ten relaxation times at four speeds.",
    },
}  # fmt: skip
