"""Scene.validity and Cylinder.validity: which assumptions a state strains."""

import math
from dataclasses import replace

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.contact_law.validity.assumptions import WAVE_LIMIT

SCENE = vr.presets.PAPER_SECTION_5
V = np.array([0.0, 5e-324, 1e-3, -0.3, 1.0, 1e3, 1e150])


def test_numbers_are_those_of_the_contact():
    """The far end of the contact is delta_star/mu from the axis, by Eqs. (8), (9)."""
    scene = SCENE.replace(alpha=np.array([1.0, 11.0, 81.5])[:, None])
    state, found = vr.contact(scene, V, delta=0.0), scene.validity(V)
    assert close(found.small_contact.value, state.delta_star / scene.mu, tol.CONTACT)
    assert close(found.under_axis.value, state.epsilon, tol.CONTACT, scale=1e-300)  # subnormals keep fewer digits
    assert np.array_equal(found.under_axis.holds, state.epsilon <= 1.0)


def test_wave_speed():
    """Fifth of sqrt(G/density), in SI; unknown without a density."""
    cylinder, density = vr.presets.PAPER_CYLINDER, 1130.0
    assert cylinder.validity(1.0).quasistatic.holds is None
    wave = math.sqrt(cylinder.E / (2.0 * (1.0 + cylinder.nu)) / density)
    share = np.array([0.99, 1.01, -1.01]) * WAVE_LIMIT
    found = cylinder.validity(share * wave, density=density).quasistatic
    assert found.holds.tolist() == [True, False, False]
    fast = cylinder.validity(0.1 * wave, omega=0.5 * wave / cylinder.R, density=density)  # the circumference counts
    assert close((fast.quasistatic.value, fast.creep.value), (0.5, 4.0), tol.PAIR)
    assert not fast.creep.holds


def test_beyond_all_bounds():
    """No NaN, no warning: a ratio that no double can hold is infinite."""
    for V, density in ((3e208, 3e208), (1e300, 1e308), (0.0, 1e308), (1e-300, 5e-324)):
        found = vr.presets.PAPER_CYLINDER.validity(V, density=density)
        assert found.quasistatic.holds == (V < 1.0)
        assert "nan" not in str(found)
    for kappa in (1e-300, 1e300):
        found = vr.Scene(11.0, kappa, 0.2 * kappa).validity([0.0, 1e-300, 1.0, 1e300])
        assert found.small_contact.holds.all() == (kappa > 1.0)
        assert "nan" not in str(found)


# --- pairs ---

RUBBER = vr.Material(2.3e5, 0.49, vr.Prony([2.0, 6.0], [1.0, 1e-4]), density=1100.0)
STEEL = vr.Material.elastic(2e11, 0.3, density=7850.0)


def pair(material, base, plane="strain"):
    return vr.Cylinder(R=0.1, m=35.5, mu=0.2, material=material, base=base, plane=plane)


def test_how_thick_the_layer_is():
    """Half the contact over the thickness of the layer, up to which it sticks in front and slips behind."""
    thick, thin = (replace(RUBBER, thickness=thickness) for thickness in (0.02, 0.004))
    for material, base, holds in ((thick, STEEL, True), (STEEL, thick, True), (vr.Material.rigid(), thin, False)):
        cylinder = pair(material, base)
        found = cylinder.validity([0.0, 1e-3]).thick
        length = cylinder.contact([0.0, 1e-3], delta=0.0, fields="length").length
        assert close(found.value, 0.5 * length / (0.02 if holds else 0.004), tol.CONTACT)
        assert np.array_equal(found.holds, [holds, holds])
