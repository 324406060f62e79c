"""What a scene does not need is not done: kernels run as plain Python, and what must not be called raises.

That a slice is made once and for the octaves in use only is in test_alpha_slice.py, that a flow map is built once in
test_flow.py, that fields not asked for are not there in test_contact.py.
"""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import viscoroll as vr

SCENE = vr.PAPER_SECTION_5_ROUNDED

_FORBID = """
import sys
from importlib import import_module
def forbid(*names):
    '''Whatever kernel module has imported a function of these names calls this instead.'''
    def forbidden(*arguments):
        raise AssertionError("called")
    modules = [m for name, m in sys.modules.items() if name.startswith("viscoroll.kernels.")]
    for name in names:
        found = [module for module in modules if hasattr(module, name)]
        assert found, name
        for module in found:
            setattr(module, name, forbidden)
for name in ("law.contact_loop", "motion.loop", "flow.loop"):
    import_module("viscoroll.kernels." + name)
import numpy as np
import viscoroll as vr
"""
#: kernel that a scene may do without -> a call that needs it
CALLS = {
    **dict.fromkeys(
        ("ratio_i2", "place_r", "place_k", "place_i2", "piece_of", "i2_from", "stick", "differences"),
        "vr.contact(vr.PAPER_SECTION_5, 0.5, delta=0.001)",
    ),
    **dict.fromkeys(
        (
            "ratio_r", "ratio_k", "contact_length", "sliding", "slide_phase", "layer_phase", "slow_phase", "slow_D",
            "creep_rates",
        ),
        "vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, [1e-4, 3e-3])",
    ),
}  # fmt: skip
RATIOS = ("ratio_r", "ratio_k", "ratio_i2", "place_r", "place_k", "place_i2", "piece_of")


def run(code: str, **environment: str) -> None:
    result = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], check=False, capture_output=True, text=True,
        env=os.environ | environment,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr


def plain(code: str, *forbidden: str) -> None:
    """Run with kernels as plain Python functions; those named must not be called."""
    run(f"{_FORBID}\nforbid{forbidden}\n{textwrap.dedent(code)}", NUMBA_DISABLE_JIT="1")


@pytest.mark.parametrize("name", CALLS)
def test_what_is_forbidden_is_what_is_called(name):
    """Each of the checks below can fail."""
    with pytest.raises(AssertionError, match="AssertionError: called"):
        plain(CALLS[name], name)


@pytest.mark.parametrize(
    "call",
    [
        "vr.contact(scene, np.linspace(0.1, 2.0, 9), delta=0.001)",
        "vr.contact(scene, 0.5, omega=0.501, slopes=True)",
        "vr.roll(scene, 1.5, 0.5, [1e-4, 3e-4], 1e-4)",
    ],
)
def test_alpha_1_touches_no_bessel_ratio(call):
    plain(f"scene = vr.PAPER_SECTION_5.replace(alpha=1.0)\n{call}", *RATIOS)


def test_full_slip_solves_for_no_stick_zone():
    plain("vr.contact(vr.PAPER_SECTION_5, [0.5, -1.0], delta=1.0)", "stick", "differences")


def test_fields_not_asked_for_are_not_computed():
    call = 'vr.contact(vr.PAPER_SECTION_5, 0.5, delta=0.001, fields=("lam", "epsilon", "delta_star"))'
    plain(call, "stick", "ratio_i2", "i2_from", "place_i2")


def test_a_motion_that_only_slides_knows_no_partial_slip():
    partial = ("layer_phase", "slow_phase", "slow_D", "creep_rates")
    plain("vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, [1e-6, 2e-6], 1e-4)", *partial)


def test_at_rest_nothing_is_integrated():
    plain(
        """
        still = vr.ensemble(vr.PAPER_SECTION_5, np.zeros(5), 0.0, [1.0, 2.0], method="integrate")
        below = vr.ensemble(vr.PAPER_SECTION_5, np.full(5, 1e-9), 0.0, [1.0], rest=1e-6, method="integrate")
        assert (still.V == 0.0).all() and (below.regime is None) and (below.steps == 0).all()
        """,
        "contact_length", "sliding", "slide_phase", "layer_phase", "slow_phase",
    )  # fmt: skip


def test_outputs_after_rest_are_filled_not_integrated():
    steps = [
        vr.ensemble(SCENE, [1.5], [0.5], np.linspace(0.0, end, 11), rest=1e-3, method="integrate").steps[0]
        for end in (1e-2, 1e3)
    ]
    assert steps[0] == steps[1]


def test_the_flow_map_looks_up_no_path_unless_asked():
    plain(
        """
        from viscoroll.kernels.flow import layout as flow_layout
        from viscoroll.kernels.flow import loop as flow_loop
        from viscoroll.kernels.flow.records import Flow
        from viscoroll.motion.flow import Answer
        from viscoroll.scene import kernel_scene
        flow_loop.flow_motion = lambda *a: (needed.append(a[3].need), (0, 0.0, 0.0))[1]
        flow, needed = Flow(np.zeros(flow_layout.SIZE), -16, kernel_scene(11.0, 2.9, 0.2, 0.5)), []
        one, answer = np.ones(1), Answer.empty(1, 1, 1)
        for row in (0, 2):
            flow_loop.flow_loop(flow, 1.0, 0.0, one, one, one, np.array([row]), answer, 0, 1)
        assert needed == [False, True]
        """
    )


def test_no_table_file_is_read_at_run_time():
    """Neither the atlas nor any other netCDF file: the coefficients of the ratios are all that is read."""
    run(
        """
        import sys
        opened = []
        sys.addaudithook(lambda event, given: opened.append(str(given[0])) if event == "open" else None)
        import viscoroll as vr
        scene = vr.PAPER_SECTION_5
        vr.contact(scene, 0.5, delta=0.001)
        vr.stress(scene, [0.0, 0.1], 0.5, delta=0.001)
        vr.ensemble(scene, [1.0], [1.0], 1e-3, method="flow")
        assert any(name.endswith("ratios.npy") for name in opened)
        assert not any(name.endswith((".nc", ".h5")) for name in opened)
        """
    )


@pytest.mark.parametrize(
    ("call", "absent"),
    [
        ("contact(scene, 0.5, delta=0.001)", "kernels.motion kernels.flow kernels.law.stress kernels.printed"),
        ("stress(scene, 0.0, 0.5, delta=0.001)", "tables kernels.motion kernels.flow kernels.printed"),
        ("roll(scene, 1.5, 0.5, 1e-4)", "tables kernels.flow kernels.law.stress kernels.law.slice_loop"),
    ],
)
def test_what_is_not_used_is_not_imported_and_so_not_compiled(call, absent):
    run(
        f"""
        import sys
        import viscoroll as vr
        scene = vr.PAPER_SECTION_5
        vr.{call}
        loaded = [name for name in {absent.split()!r} if "viscoroll." + name in sys.modules]
        loaded += [name for name in ("matplotlib", "xarray", "h5py") if name in sys.modules]
        assert not loaded, loaded
        """
    )
