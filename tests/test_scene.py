"""Scene and Cylinder as values; their numbers are in materials/test_values_of_materials.py."""

import dataclasses

import numpy as np
import pytest

import viscoroll as vr


def test_a_scene_is_a_value():
    alpha = np.array([2.0, 3.0])
    scene = vr.Scene(alpha, 2.0, 0.2)
    alpha[0] = 99.0  # what is given is copied
    assert scene == vr.Scene([2.0, 3.0], 2.0, 0.2)
    for frozen in (scene, vr.presets.PAPER_CYLINDER):
        with pytest.raises(dataclasses.FrozenInstanceError):
            frozen.mu = 0.3
    with pytest.raises(ValueError, match="read-only"):
        scene.alpha[0] = 5.0
