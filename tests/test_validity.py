"""Scene.validity and Cylinder.validity: which assumptions a state strains; of layers in
test_covers.py.
"""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import tolerances as tol
from closeness import close

import viscoroll as vr

SCENE = vr.presets.PAPER_SECTION_5
V = np.array([0.0, 5e-324, 1e-3, -0.3, 1.0, 1e3, 1e150])


def test_numbers_are_those_of_the_contact():
    """The far end of the contact is delta_star/mu from the axis, by Eqs. (8), (9)."""
    scene = SCENE.replace(alpha=np.array([1.0, 11.0, 81.5])[:, None])
    state = vr.contact(scene, V, delta=0.0)
    found = scene.validity(V)
    assert close(found.small_contact.value, state.delta_star / scene.mu, tol.CONTACT)
    assert close(
        found.under_axis.value, state.epsilon, tol.CONTACT, scale=1e-300
    )  # subnormals keep fewer digits
    assert np.array_equal(found.under_axis.holds, state.epsilon <= 1.0)


def test_lengths_in_mm_give_one_warning():
    """A radius of 79.5 m is one of 79.5 mm, whose contact would look small."""
    tread = vr.Material(E=2e6, nu=0.49, prony=vr.Prony([2.0, 6.0], [1e-2, 1e-4]), thickness=8.0)
    wheel = vr.Cylinder(R=79.5, m=200.0, material=tread, base=vr.Material.rigid(), mu=0.5, load=2e3)
    for call in (lambda: wheel.contact(1.0, delta=0.0), lambda: wheel.roll(1.0, 1.0 / 79.5, 0.1)):
        with pytest.warns(vr.ModelWarning, match="if they are in mm, divide them by 1000") as said:
            call()
        assert len(said) == 1
    drum = vr.Cylinder(R=6.0, m=2e4, material=replace(tread, thickness=None), mu=0.5, load=1e6)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drum.contact(1.0, delta=0.0)  # large, and so is the contact of its load
