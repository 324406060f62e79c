"""What a scene does not need is not done: calls of kernels are counted, run as plain Python; imports are compared.

That a flow map is built once is in test_flow.py, that fields not asked for are not there in test_contact.py.
"""

from __future__ import annotations

import json

import numpy as np
import pytest
from processes import printed

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
ROLL = "vr.ensemble(scene, [1.5], [0.5], [3e-3], method='flow', fields={!r})"
WORK = {
    "partial slip": "vr.contact(scene, 0.5, delta=0.001)",
    "full slip": "vr.contact(scene, 0.5, delta=1.0)",
    "no stick zone asked for": "vr.contact(scene, 0.5, delta=0.001, fields=('lam', 'epsilon', 'delta_star', 'M'))",
    "no M asked for": "vr.contact(scene, 0.5, delta=0.001, fields=('lam', 'epsilon', 'delta_star'))",
    "elastic, array": "vr.contact(elastic, np.linspace(0.1, 2.0, 9), delta=0.001)",
    "elastic, slopes": "vr.contact(elastic, 0.5, omega=0.501, slopes=True)",
    "elastic, motion": "vr.roll(elastic, 1.5, 0.5, [1e-4, 3e-4], rtol=1e-4)",
    "sliding": "vr.roll(scene, 1.5, 0.5, [1e-6, 2e-6], rtol=1e-4)",
    "sliding and sticking": "vr.roll(scene, 1.5, 0.5, [1e-4, 3e-3])",
    "rest": "vr.ensemble(scene, np.zeros(5), 0.0, [1.0, 2.0], method='integrate')",
    "below rest": "vr.ensemble(scene, np.full(5, 1e-9), 0.0, [1.0], rest=1e-6, method='integrate')",
    **{f"flow map, {field}": ROLL.format(field) for field in ("V", "x", "slip_loss")},
}
COUNT = """
import json, sys
from collections import Counter
import numpy as np
import viscoroll as vr
scene = vr.presets.PAPER_SECTION_5_ROUNDED
elastic = scene.replace(alpha=1.0)

def calls(work):
    found = Counter()
    def note(frame, event, _):
        module = frame.f_globals.get("__name__", "")
        if event == "call" and module.startswith("viscoroll.kernels."):
            found[module.removeprefix("viscoroll.kernels.")] += 1
    eval(work)  # imports
    sys.setprofile(note)
    eval(work)
    sys.setprofile(None)
    return found

print(json.dumps({name: calls(work) for name, work in json.loads(sys.argv[1]).items()}))
"""
RATIOS, LOOK_UPS = "bessel.ratios", "rows.lanes"


@pytest.fixture(scope="module")
def calls() -> dict[str, dict[str, int]]:
    """For each work, how many functions of each kernel module were called."""
    eval(WORK["flow map, V"], {"vr": vr, "scene": SCENE})  # compiled, so that its map is at hand
    text = printed(COUNT, json.dumps(WORK), NUMBA_DISABLE_JIT="1", VISCOROLL_THREADS="1")
    return {name: dict.fromkeys((RATIOS, LOOK_UPS), 0) | found for name, found in json.loads(text).items()}


def test_alpha_1_touches_no_bessel_ratio(calls):
    assert [calls[name][RATIOS] for name in WORK if name.startswith("elastic")] == [0, 0, 0]


def test_what_is_not_asked_for_is_not_read(calls):
    """The stick zone is one look-up more than M, and M one more than lengths; in full slip there is no stick zone."""
    assert calls["full slip"][LOOK_UPS] == calls["no stick zone asked for"][LOOK_UPS]
    assert 0 < calls["no M asked for"][LOOK_UPS] <= calls["full slip"][LOOK_UPS] < calls["partial slip"][LOOK_UPS]


def test_at_rest_nothing_is_integrated(calls):
    """No Bessel ratio is asked for."""
    for name in ("rest", "below rest"):
        assert calls[name][RATIOS] == 0, name
    assert (vr.ensemble(SCENE, np.zeros(5), 0.0, [1.0, 2.0], method="integrate").steps <= 1).all()


def test_outputs_after_rest_are_filled_not_integrated():
    steps = [
        vr.ensemble(SCENE, [1.5], [0.5], np.linspace(0.0, end, 11), rest=1e-3, method="integrate").steps[0]
        for end in (1e-2, 1e3)
    ]
    assert steps[0] == steps[1]


def test_the_flow_map_looks_up_no_path_unless_asked(calls):
    speeds, path, losses = (sum(calls[f"flow map, {field}"].values()) for field in ("V", "x", "slip_loss"))
    assert speeds < path < losses


def test_no_table_file_is_read_at_run_time():
    """Neither the atlas nor any other netCDF file: the coefficients of the ratios are all that is read."""
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
