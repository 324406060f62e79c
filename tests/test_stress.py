"""Pressure and shear along the contact: closed forms, and nothing outside; integrals are in
``test_claims.py``.
"""

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr

KAPPA = 2.91
MU = 0.2


def test_elastic_cylinder_and_rest_are_carter():
    """Hertz's pressure and Carter's two ellipses, at alpha = 1 or at V = 0."""
    x = np.linspace(-0.4999, 0.4999, 41)[:, None]
    peak = 1.0 / (8 * np.pi * KAPPA)
    p_0 = np.sqrt((1 - 2 * x) * (1 + 2 * x))
    for alpha, kappa_V in ((1.0, 500.0), (1.0, 0.5), (1.0, 0.0), (11.0, 0.0), (1e4, 0.0)):
        scene = vr.Scene(alpha, KAPPA, MU)
        V = kappa_V / KAPPA
        delta = np.array([1.0, 0.7, 0.1]) * scene.contact(V, delta=0.0).delta_star
        beta = scene.contact(V, delta=delta).beta
        found = scene.stress(x, V, delta=delta)
        stuck = np.sqrt(np.maximum(beta**2 - (2 * x - 1 + beta) ** 2, 0.0))
        assert close(found.p, peak * p_0 + 0.0 * delta, tol.STRESS_ELLIPSE, scale=peak)
        assert close(found.tau, MU * peak * (p_0 - stuck), tol.STRESS_CARTER, scale=MU * peak)


def test_nothing_lies_outside_the_contact():
    alpha = np.array([1.0, 1.01, 11.0, 1e4])
    V = np.geomspace(1e-5, 1e4, 7)[:, None] / KAPPA
    scene = vr.Scene(alpha, KAPPA, MU)
    state = scene.contact(V, delta=1e-3)
    for place in (-1.0 - 1e-9, 1.0 + 1e-9):
        beyond = scene.stress(0.5 * state.lam * (state.epsilon + place), V, delta=1e-3)
        assert not np.any([beyond.p, beyond.tau])


def test_x_of_a_dataset_is_the_place_along_the_contact():
    """Not the distance travelled, which is in other units."""
    x = vr.Scene(11.0, KAPPA, MU).stress([-1e-3, 1e-3], 1.0, delta=0.0).to_xarray().x
    words = "place along the contact, from the point below the axis, divided by l0"
    assert x.attrs["long_name"] == words
