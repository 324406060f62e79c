"""What a scene does not need is not done: no steps at rest, no file of tables at run time."""

import numpy as np
import pytest
from processes import printed

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


def test_no_table_file_is_read_at_run_time():
    """No netCDF file is read: the coefficients of the ratios are all that is
    read.
    """
    printed(
        """
import sys
opened = []
sys.addaudithook(lambda event, given: opened.append(str(given[0])) if event == "open" else None)
import viscoroll as vr
scene = vr.presets.PAPER_SECTION_5
vr.contact(scene, 0.5, delta=0.001)
vr.stress(scene, [0.0, 0.1], 0.5, delta=0.001)
vr.ensemble(scene, [1.0], [1.0], 1e-3, method="flow")
assert any(name.endswith("ratios.npy") for name in opened)
assert not any(name.endswith((".nc", ".h5")) for name in opened)
"""
    )
