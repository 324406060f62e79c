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
    """What the equations as printed leave, each with the size of its terms; lengths that are not
    0.
    """
    lam, zeta, epsilon, beta = (state[name] for name in ("lam", "zeta", "epsilon", "beta"))
    r = ratio_r(alpha * zeta)
    k = ratio_k(zeta)
    creep = 2 * delta * kappa / (mu * lam)
    found = {
        "(7)": (zeta - lam / (2 * kappa * V), zeta),
        "(6)": ((1 - lam**2) * (1 + k * r) + 2 / zeta * (1 / alpha - 1) * lam**2 * r, 1 + k * r),
        "(8)": (epsilon - (lam**-2 - 1) / 2 * k, 1),
        "(9)": (state["delta_star"] - mu * lam * (1 + epsilon) / (2 * kappa), state["delta_star"]),
        "(16)": (
            state["M"]
            - lam / kappa * (epsilon / 2 * (1 - lam**2) + (lam**2 - 1 / alpha) / (2 * zeta)),
            lam / kappa,
        ),
    }
    if state["full_slip"]:
        return found | {"(15)": (state["Q"] - mu, mu)}
    r = ratio_r(alpha * beta * zeta)
    k = ratio_k(beta * zeta)
    bracket = 1 + epsilon - beta - creep
    Q = mu * (1 - beta**2 * lam**2 - 2 * beta * lam**2 * bracket / k)
    return found | {
        "(10)": (bracket * (1 + r * k) + (1 / alpha - 1) / zeta * r * k, 1 + epsilon),
        "(15)": (state["Q"] - Q, mu),
    }


def test_enclosures_hold_the_printed_law():
    """What is found from the reduced form solves the equations as printed: zero is in every
    residual, to 30 digits.
    """
    for given in STATES:
        with flint.ctx.workprec(400):
            exact = [flint.arb(abs(value)) for value in given]
            state = contact_enclosure(*map(abs, given), bits=300)
            for name, (left, size) in printed(state, *exact).items():
                assert left.contains(0), (name, given)
                assert left.abs_upper() < 1e-30 * size, (name, given)


def test_creep_of_exactly_delta_star():
    """alpha = 1: delta_star is a double, and a creep of that is full slip, one ULP below it is
    not.
    """
    for delta, slip in ((0.25, True), (np.nextafter(0.25, 0.0), False)):
        assert contact_enclosure(1.0, 2.0, 1.0, 0.7, float(delta))["full_slip"] is slip
