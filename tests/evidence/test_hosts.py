"""Other processes and a host that flushes subnormals change no bit."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
from memory import forget
from processes import printed
from test_invariance import assert_same, everything

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")

#: control and status register of SSE: denormals are zero in bit 6, flush to zero in 15
MODES = {
    "denormals are zero": 0x0040,
    "flush to zero": 0x8000,
}
REGISTER = """
#include <xmmintrin.h>
unsigned get(void) { return _mm_getcsr(); }
void set(unsigned value) { _mm_setcsr(value); }
"""


def work(_):
    forget()
    return everything()


#: A program that takes a folder and computes ``everything``: in each mode of a host library,
#: "usual" without one; and in a fork of itself, which has used threads and kernels by then.
ELSEWHERE = """
import ctypes, multiprocessing, sys
from pathlib import Path
folder = Path(sys.argv[1])
sys.path.insert(0, sys.argv[2])
import numpy as np
import test_hosts as test
from viscoroll.motion import flow
library = folder / "register.so"
register = ctypes.CDLL(str(library)) if library.exists() else None
usual = register.get() if register else 0
for name, bits in ({"usual": 0} | (test.MODES if register else {})).items():
    test.forget()
    flow.folder = lambda: folder / name
    if register:
        register.set(usual | bits)
    try:
        found = test.everything()
        register_after = register.get() & 0xE040 if register else 0
    finally:
        if register:
            register.set(usual)
    np.savez(folder / f"{name}.npz", register_after=register_after, **found)
if "fork" in multiprocessing.get_all_start_methods():
    flow.folder = lambda: folder / "fork"
    with multiprocessing.get_context("fork").Pool(1) as pool:
        (found,) = pool.map_async(test.work, range(1)).get(timeout=200)
    np.savez(folder / "fork.npz", **found)
"""


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory):
    """``everything`` of the program above, in each mode and in a fork."""
    folder = tmp_path_factory.mktemp("modes")
    compiler = shutil.which("cc") if platform.machine() in ("x86_64", "AMD64") else None
    if compiler:
        (folder / "register.c").write_text(REGISTER)
        subprocess.run(
            [compiler, "-shared", "-fPIC", "-o", folder / "register.so", folder / "register.c"],
            check=True,
        )
    environment = {"VISCOROLL_THREADS": "2", "PYTHONPATH": os.pathsep.join(sys.path)}
    printed(ELSEWHERE, folder, Path(__file__).parent, **environment)
    return {path.stem: dict(np.load(path)) for path in folder.glob("*.npz")}


@pytest.fixture(scope="module")
def expected(maps_of_this_file):
    return everything()


def test_other_processes(elsewhere, expected):
    """A process of its own and the child of one that has used threads and kernels compute the same
    bits, and end.
    """
    for way in {"usual", "fork"} & elsewhere.keys():
        assert_same(
            {name: values for name, values in elsewhere[way].items() if name != "register_after"},
            expected,
        )


def test_flushed_subnormals_change_nothing_else(elsewhere):
    """What is a normal number in the usual mode has the same bits in one that a host library has
    set.
    """
    if not elsewhere.keys() >= MODES.keys():
        pytest.skip("the register is that of x86, and a C compiler reaches it")
    for mode in MODES:
        assert elsewhere[mode].pop("register_after") == MODES[mode]
        for name, found in elsewhere[mode].items():
            usual = elsewhere["usual"][name]
            normal = (
                np.isfinite(usual)
                & (np.abs(usual) > tol.SUBNORMAL)
                & (np.abs(usual) < 1.0 / tol.SUBNORMAL)
            )
            assert np.array_equal(found[normal], usual[normal]), (mode, name)
            assert np.array_equal(np.isnan(found), np.isnan(usual)), (mode, name)
