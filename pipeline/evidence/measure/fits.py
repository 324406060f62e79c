"""Errors of M of fits to random rubbers, beside the accuracy that the fits state ->
data/results/fits.json.

    python -m pipeline.evidence.measure.fits [--config FILE] [--quick] [-o FILE]

A rubber has 1 to 12 modes with times within two decades of the data and strengths over 2.5 decades;
the data have 8 to 40 frequencies over 2 to 5 decades, and relative noise of 0, 0.3 or 1 %.  Where
they show no long-time modulus the fit refuses them, and another rubber is drawn.
pipeline/evidence/document/ puts the result into docs/validity.md.
"""

import sys
import warnings

import numpy as np

import viscoroll as vr

from ...stage import Row
from ..results import run

#: relative noise of the moduli, of which one is drawn
NOISE = (0.0, 0.003, 0.01)
#: noise times this is the misfit that is asked for, at least the default of 1 %
MISFIT = 1.2


def measure(sizes):
    """Errors of all rubbers at the speeds of the estimate: at the ends of the band, and a factor of
    5 inside and more.

    Each row has, over all speeds of this part: how many; median, 95 % quantile and largest error;
    median and largest accuracy that was stated; the share of speeds where the error is above the
    accuracy; and the same three of errors relative to the accuracy.
    """
    rng = np.random.default_rng(sizes["seed"])
    found = []
    refused = 0
    while len(found) < sizes["rubbers"]:
        try:
            found.append(errors_of(rng))
        except vr.ParameterError:
            refused += 1
    errors = np.concatenate(found)
    inside = (errors[:, 0] >= 5.0) & (errors[:, 1] >= 5.0)
    parts = {
        "within a factor of 5 of an end of the band": errors[~inside],
        "farther inside": errors[inside],
    }
    return {
        "sizes": sizes,
        "refused": refused,
        "rows": [row(name, *part.T[2:]) for name, part in parts.items()],
    }


def row(place: str, error: np.ndarray, stated: np.ndarray) -> Row:
    """Statistics of one part of the speeds."""
    return {
        "place": place,
        "speeds": error.size,
        "beyond": np.mean(error > stated * (1.0 + 1e-3) + 1e-6),
        "median": np.median(error),
        "most": np.quantile(error, 0.95),
        "largest": error.max(),
        "stated_median": np.median(stated),
        "stated_most": np.quantile(stated, 0.95),
        "ratio": np.quantile(error / (stated + 1e-6), 0.95),
    }


def errors_of(rng: np.random.Generator) -> np.ndarray:
    """Draw a rubber, fit its moduli, and compare M at the speeds of the estimate.

    Returns rows (transit frequency over the first, last over transit frequency, error of M,
    accuracy as the fit states it).  Raises ParameterError where the data have no long-time modulus.
    """
    low = 10.0 ** rng.uniform(-2.0, 2.0)
    decades = rng.uniform(2.0, 5.0)
    modes = int(rng.integers(1, 13))
    omega = np.geomspace(low, low * 10.0**decades, int(rng.integers(8, 41)))
    tau = 10.0 ** rng.uniform(-2.0, decades + 2.0, modes) / omega[-1]
    rubber = vr.Material(3e6, 0.49, vr.Prony(10.0 ** rng.uniform(-1.5, 1.0, modes), tau))
    noise = float(rng.choice(NOISE))
    moduli = [
        y * (1.0 + noise * rng.standard_normal(y.size))
        for y in (rubber.storage(omega), rubber.loss(omega))
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = vr.fit_prony(omega, *moduli, misfit=max(0.01, MISFIT * noise))
        state = fit.admissible
        rollers = [
            vr.Cylinder(R=0.1, m=35.0, mu=0.5, load=1e2, material=each)
            for each in (fit.material(0.49), rubber)
        ]
        V = state.V * rollers[0].l0 / fit.T_ref
        M, true = (each.contact(V, delta=0.0, fields="M").M for each in rollers)
    rate = state.rate
    return np.transpose(
        [
            rate / fit.measured.low,
            fit.measured.transit_band[1] / rate,
            np.abs(true / M - 1.0),
            state.error,
        ]
    )


if __name__ == "__main__":
    sys.exit(run("fits", measure, __doc__))
