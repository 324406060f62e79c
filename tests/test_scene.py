"""Scene and Cylinder as values; their numbers are in values.txt."""

import dataclasses

import numpy as np
import pytest

import viscoroll as vr


def test_a_scene_is_a_value():
    alpha = np.array([2.0, 3.0])
    scene, rounded = vr.Scene(alpha, 2.0, 0.2), vr.Scene(11, 2.91, 0.2, 1.1e4)
    alpha[0] = 99.0  # what is given is copied
    assert scene == vr.Scene([2.0, 3.0], 2.0, 0.2) != rounded
    assert rounded == vr.presets.PAPER_SECTION_5_ROUNDED
    assert rounded.replace(mu=0.3).mu == 0.3 != rounded.mu
    assert scene != "scene"
    assert eval(repr(rounded), {"Scene": vr.Scene}) == rounded
    assert len(repr(scene.replace(mu=np.linspace(0.1, 0.3, 1000)[:, None]))) < 120
    assert type(rounded.alpha) is float
    for frozen in (scene, vr.presets.PAPER_CYLINDER):
        with pytest.raises(dataclasses.FrozenInstanceError):
            frozen.mu = 0.3
    with pytest.raises(ValueError, match="read-only"):
        scene.alpha[0] = 5.0
    assert vr.Scene([1.0, 2.0, 3.0], [[1.0], [2.0]], 0.2).shape == (2, 3)
