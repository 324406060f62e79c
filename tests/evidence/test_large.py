"""What takes long: memory at full size, and a flow map filled with numba's check of every index."""

import importlib
from pathlib import Path

import pytest
import tolerances as tol
from processes import printed


@pytest.mark.parametrize("name", ["grid", "flow map", "integrated"])
def test_large_arrays_in_bounded_memory(name):
    """Beside input and result a call takes the same few megabytes whatever its size (10^8 elements:
    make prove).
    """
    measured = importlib.import_module("pipeline.evidence.measure.large").measured
    if not Path("/proc/self/status").exists():
        pytest.skip("the system does not tell a process its peak")
    found = measured(name, 200_000 if name == "integrated" else 2_000_000)
    assert found["result_bytes"] >= 8 * found["elements"]
    assert found["extra_bytes"] <= tol.MEMORY_SLACK


def test_a_map_is_filled_within_its_arrays():
    """For any kappa, and any octave that is served."""
    script = """
from viscoroll.motion.flow import build_map
for kappa in (1e250, 1e300, 1e-250, 2.9):
    for octave in (-16, 0, 14):
        made = build_map((11.0, kappa, 0.2, 0.5), octave)
        assert (made.problem == "") == (kappa == 2.9), (kappa, octave, made.problem)
        assert made.problem or 0.0 < made.errors[0] < 1e-8, (octave, made.errors)
"""
    printed(script, NUMBA_BOUNDSCHECK="1")
