"""What a motion does not need is not done: no steps at rest."""

import numpy as np
import pytest

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED


def test_outputs_after_rest_are_filled_not_integrated():
    steps = [
        vr.ensemble(
            SCENE, [1.5], [0.5], np.linspace(0.0, end, 11), rest=1e-3, method="integrate"
        ).steps[0]
        for end in (1e-2, 1e3)
    ]
    assert steps[0] == steps[1]
    assert (vr.ensemble(SCENE, np.zeros(5), 0.0, [1.0, 2.0], method="integrate").steps <= 1).all()
