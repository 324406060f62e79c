"""Certified enclosures; that check values are theirs: ``evidence/test_prove.py``."""

import flint
import numpy as np

from pipeline.evidence.truth import contact_enclosure, ratio_k, ratio_r

# --- enclosures ---

STATES = [
    (11.0, 2.91, 0.2, 0.5, -0.01),
    (1e4, 29.1, 0.3, -1e3, 1e-6),
    (81.5, 29.1, 0.2, 1e-7, -0.0034),
    (1.0, 2.91, 0.2, 1.0, 0.01),
    (11.0, 2.91, 0.2, -0.5, -0.5),
    (1e6, 1.0, 1.0, 1e-3, 0.1),
]


def printed(state, alpha, kappa, mu, V, delta):
    """Both sides of the equations as printed, so arranged that neither is 0."""
    lam, zeta, epsilon, delta_star, M, _, _, full_slip, beta, Q = state.values()
    square = lam**2
    relaxing = (1 - 1 / alpha) / zeta
    r = ratio_r(alpha * zeta)
    k = ratio_k(zeta)
    found = {
        "(7)": (zeta, lam / (2 * kappa * V)),
        "(6)": (1 + k * r, square * (1 + k * r + 2 * relaxing * r)),
        "(8)": (1 + 2 * epsilon / k, 1 / square),
        "(9)": (delta_star, mu * lam * (1 + epsilon) / (2 * kappa)),
        "(16)": (
            2 * M * kappa / lam + epsilon * square + 1 / (alpha * zeta),
            epsilon + square / zeta,
        ),
    }
    if full_slip:
        return found | {"(15)": (Q, mu)}
    r = ratio_r(alpha * beta * zeta)
    k = ratio_k(beta * zeta)
    bracket = relaxing * r * k / (1 + r * k)
    return found | {
        "(10)": (1 + epsilon, beta + 2 * delta * kappa / (mu * lam) + bracket),
        "(15)": (Q + mu * beta * square * (beta + 2 * bracket / k), mu),
    }


def test_enclosures_hold_the_printed_law():
    """What is found from the reduced form solves the equations as printed: both sides meet, to 30
    digits.
    """
    for given in STATES:
        with flint.ctx.workprec(400):
            exact = [flint.arb(abs(value)) for value in given]
            state = contact_enclosure(*map(abs, given), bits=300)
            for name, (left, right) in printed(state, *exact).items():
                off = left / right - 1
                assert off.contains(0), (name, given)
                assert off.abs_upper() < 1e-50, (name, given)


def test_creep_of_exactly_delta_star():
    """alpha = 1: delta_star is a double, and a creep of that is full slip, one ULP below it is
    not.
    """
    for delta, slip in ((0.25, True), (np.nextafter(0.25, 0.0), False)):
        assert contact_enclosure(1.0, 2.0, 1.0, 0.7, float(delta))["full_slip"] is slip
