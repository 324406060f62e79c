"""Scene.validity and Cylinder.validity: which assumptions a state strains."""

from dataclasses import replace

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr

SCENE = vr.presets.PAPER_SECTION_5
V = np.array([0.0, 5e-324, 1e-3, -0.3, 1.0, 1e3, 1e150])


def test_numbers_are_those_of_the_contact():
    """The far end of the contact is delta_star/mu from the axis, by Eqs. (8), (9)."""
    scene = SCENE.replace(alpha=np.array([1.0, 11.0, 81.5])[:, None])
    state, found = vr.contact(scene, V, delta=0.0), scene.validity(V)
    assert close(found.small_contact.value, state.delta_star / scene.mu, tol.CONTACT)
    assert close(found.under_axis.value, state.epsilon, tol.CONTACT, scale=1e-300)  # subnormals keep fewer digits
    assert np.array_equal(found.under_axis.holds, state.epsilon <= 1.0)


# --- pairs ---

RUBBER = vr.Material(2.3e5, 0.49, vr.Prony([2.0, 6.0], [1.0, 1e-4]), density=1100.0)
STEEL = vr.Material.elastic(2e11, 0.3, density=7850.0)


def pair(material, base, plane="strain"):
    return vr.Cylinder(R=0.1, m=35.5, mu=0.2, material=material, base=base, plane=plane, coupled=False)


def test_how_thick_the_layer_is():
    """Half the contact over the thickness of the layer, up to which it sticks in front and slips behind."""
    thick, thin = (replace(RUBBER, thickness=thickness) for thickness in (0.02, 0.004))
    for material, base, holds in ((thick, STEEL, True), (STEEL, thick, True), (vr.Material.rigid(), thin, False)):
        cylinder = pair(material, base)
        found = cylinder.validity([0.0, 1e-3]).thick
        length = cylinder.contact([0.0, 1e-3], delta=0.0, fields="length").length
        assert close(found.value, 0.5 * length / (0.02 if holds else 0.004), tol.CONTACT)
        assert np.array_equal(found.holds, [holds, holds])
