"""A hostile host: other rounding modes, flushed subnormals, many threads, forks, odd arrays, little memory."""

from __future__ import annotations

import importlib
import json
import os
import platform
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import numba
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from memory import forget
from places import RESULTS
from processes import printed
from refusals import refused

import viscoroll as vr
from viscoroll.motion import flow_store

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

SCENE = vr.PAPER_SECTION_5_ROUNDED
T = np.array([1e-5, 1e-3, 3e-3, 1e-1, 1.0])
GRID = {"what": SCENE, "V": [0.1, 0.3, 2.0], "delta": [-0.01, 0.0, 0.03], "alpha": [1.0, 11.0]}
#: control and status register of SSE: rounding in bits 13-14, denormals are zero in 6, flush to zero in 15
MODES = {
    "denormals are zero": 0x0040,
    "flush to zero": 0x8000,
    "down": 0x2000,
    "up": 0x4000,
    "toward zero, subnormals flushed": 0xE040,
}
FLUSHING = ("denormals are zero", "flush to zero")
REGISTER = """
#include <xmmintrin.h>
unsigned get(void) { return _mm_getcsr(); }
void set(unsigned value) { _mm_setcsr(value); }
"""


def states() -> tuple[np.ndarray, np.ndarray]:
    """(V, delta) from the least to the largest speeds, a third of them in full slip."""
    rng = np.random.default_rng(1)
    V = np.concatenate(
        [rng.uniform(-2.0, 2.0, 2500), rng.choice([-1.0, 1.0], 2000) * 10.0 ** rng.uniform(-300, 50, 2000)]
    )
    delta = rng.uniform(-0.04, 0.04, V.size)
    return np.append(V, 0.0), np.append(delta, 0.01)


def starts() -> tuple[np.ndarray, np.ndarray]:
    V0, omega0 = np.random.default_rng(2).uniform(-2.0, 2.0, (2, 60))
    V0[:4], omega0[:4] = (0.0, 1.0, 0.0, 5e-324), (0.0, 0.0, 1.0, 1.0)
    return V0, omega0


def everything() -> dict[str, np.ndarray]:
    """Every public function once, as named arrays."""
    V, delta = states()
    few = slice(None, None, 30)
    found = {f"slice {k}": v for k, v in vr.contact(SCENE, V, delta=delta).as_dict().items()}
    found |= {f"contact {k}": v for k, v in vr.contact(SCENE, V[few], delta=delta[few], slopes=True).as_dict().items()}
    x = np.linspace(-0.5, 1.0, 61)[:, None]
    found |= {f"stress {k}": v for k, v in vr.stress(SCENE, x, V[:2500:100], delta=delta[:2500:100]).as_dict().items()}
    for method in ("integrate", "flow"):
        many = vr.ensemble(SCENE, *starts(), T, method=method, rtol=1e-6, fields=("V", "omega", "x", "angle"))
        names = ("V", "omega", "x", "angle", "onset_time", "status", "switches", "flow")
        found |= {f"{method} {name}": getattr(many, name) for name in names}
    motion = vr.roll(SCENE, 1.5, 0.5, T)
    found |= {f"roll {name}": getattr(motion, name) for name in ("V", "omega", "x")}
    table = vr.tables.build(**GRID)
    found |= {f"table {name}": values.values for name, values in table.data_vars.items()}
    middle = {str(name): axis.values.mean() for name, axis in table.coords.items()}
    found |= {f"between {k}": v for k, v in vr.tables.interpolate(table, **middle).as_dict().items()}
    found["validity"] = SCENE.validity(V[few]).small_contact.value
    return {name: np.array(values) for name, values in found.items()}


def assert_same(found: dict[str, np.ndarray], expected: dict[str, np.ndarray]) -> None:
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert np.array_equal(found[name], values, equal_nan=values.dtype.kind == "f"), name


# --- floating-point environment ---


@pytest.fixture(scope="module")
def modes(tmp_path_factory) -> dict[str, dict[str, np.ndarray]]:
    """``everything`` in each mode, from one process that a host library has set so."""
    if platform.machine() not in ("x86_64", "AMD64"):
        pytest.skip("the register is that of x86")
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler to reach the register with")
    folder = tmp_path_factory.mktemp("modes")
    (folder / "register.c").write_text(REGISTER)
    subprocess.run([compiler, "-shared", "-fPIC", "-o", folder / "register.so", folder / "register.c"], check=True)
    code = f"""
import ctypes, sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
import numpy as np
import test_hostile as test
register = ctypes.CDLL({str(folder / "register.so")!r})
usual = register.get()
test.everything()
for n, bits in enumerate((0, *test.MODES.values())):
    test.forget()
    test.flow_store.folder = lambda: test.Path({str(folder)!r}) / f"maps{{n}}"
    register.set(usual | bits)
    try:
        found = test.everything()
        register_after = register.get() & 0xE040
    finally:
        register.set(usual)
    np.savez({str(folder)!r} + f"/{{n}}.npz", register_after=register_after, **found)
"""
    printed(code)
    names = ("usual", *MODES)
    return {name: dict(np.load(folder / f"{n}.npz")) for n, name in enumerate(names)}


def test_flushed_subnormals_change_nothing_else(modes):
    """What is a normal number in the usual mode has the same bits in this one."""
    for mode in FLUSHING:
        assert modes[mode].pop("register_after") == MODES[mode]
        for name, found in modes[mode].items():
            usual = modes["usual"][name]
            normal = np.isfinite(usual) & (np.abs(usual) > tol.SUBNORMAL) & (np.abs(usual) < 1.0 / tol.SUBNORMAL)
            assert np.array_equal(found[normal], usual[normal]), (mode, name)
            assert np.array_equal(np.isnan(found), np.isnan(usual)), (mode, name)


def test_rounding_mode(modes):
    """The same numbers to some roundings more, over the largest of each field; the same regimes; no new NaN."""
    for mode in set(MODES) - set(FLUSHING):
        assert modes[mode].pop("register_after") == MODES[mode] & 0xE040
        for name, found in modes[mode].items():
            usual = modes["usual"][name]
            assert np.array_equal(np.isnan(found), np.isnan(usual)), (mode, name)
            finite = np.isfinite(usual) & (np.abs(usual) < 1.0 / tol.SUBNORMAL)
            largest = np.abs(usual[finite]).max(initial=0.0)
            if name == "contact dQ_dV":  # the difference of parts of this size
                largest = SCENE.mu / np.maximum(np.abs(states()[0][::30][finite]), tol.SUBNORMAL)
            rolled = name.startswith(("integrate", "flow", "roll"))
            bound = tol.ROUNDING_MODE_MOTION if rolled else tol.ROUNDING_MODE
            assert close(found[finite], usual[finite], rel=bound, scale=largest, what=(mode, name))


# --- threads and forks ---


def test_called_from_several_threads_at_once(own_maps):
    """The same bits as one call alone, with nothing at hand when they start."""
    expected = everything()
    forget()
    shutil.rmtree(flow_store.folder())
    together = Barrier(4)

    def work(_: int) -> dict[str, np.ndarray]:
        together.wait()
        return everything()

    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(work, range(4)):
            assert_same(found, expected)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_forked_processes():
    """Children of a process that has used threads and kernels compute the same bits, and end."""
    code = f"""
import multiprocessing, sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
import test_hostile as test

def work(_):
    test.forget()
    return test.everything()

expected = test.everything()
with multiprocessing.get_context("fork").Pool(2) as pool:
    for found in pool.map_async(work, range(2)).get(timeout=200):
        test.assert_same(found, expected)
print("same")
"""
    assert printed(code, VISCOROLL_THREADS="2") == "same\n"


# --- numpy ---


def test_numpy_set_to_raise(own_maps):
    expected = everything()
    forget()
    with np.errstate(all="raise"):
        found = everything()
    assert_same(found, expected)


KINDS = {
    "big-endian": lambda a: a.astype(">f8"),
    "every other": lambda a: np.repeat(a, 2)[::2],
    "backward": lambda a: a[::-1].copy()[::-1],
    "column of a matrix": lambda a: np.column_stack([a, a])[:, 1],
    "float32": lambda a: a.astype(np.float32),
    "read-only": lambda a: np.broadcast_to(a, a.shape),
    "int16": lambda a: a.astype(">i2"),
    "list": lambda a: a.tolist(),
}


@pytest.mark.parametrize("kind", KINDS)
def test_arrays_of_any_kind(kind):
    """The bits of the plain float64 array of the same values; whole numbers, so that every kind holds them."""
    make = KINDS[kind]
    V0, omega0, t, x = map(np.array, ([2.0, 0.0, -1.0], [1.0, 1.0, 3.0], [0.0, 1.0, 2.0], [0.0, 1.0]))
    scenes = [vr.Scene(f(np.array([11.0, 2.0, 1.0])), 3, f(np.array([1.0, 2.0, 1.0])), 2, 1) for f in (np.array, make)]
    calls = (
        lambda scene, f: vr.ensemble(scene, f(V0), f(omega0), f(t)).V,
        lambda scene, f: vr.ensemble(SCENE, f(V0), f(omega0), f(t), method="flow").x,
        lambda scene, f: vr.roll(SCENE, f(V0)[0], f(omega0)[0], f(t)).V,
        lambda scene, f: vr.stress(SCENE, f(x), 1, omega=f(omega0[:2])).tau,
        lambda scene, f: vr.contact(scene, f(V0), omega=f(omega0)).Q,
        lambda scene, f: scene.validity(f(V0)).small_contact.value,
    )
    for call in calls:
        assert np.array_equal(call(scenes[0], np.array), call(scenes[1], make))
    table = vr.tables.build(**GRID)
    plain, made = (
        vr.tables.interpolate(table, V=f(np.array([1.0, 2.0])), delta=0, alpha=f(np.array([1.0, 11.0])))
        for f in (np.array, make)
    )
    assert np.array_equal(plain.lam, made.lam)


def test_no_kernel_is_compiled_again_for_another_kind_of_array():
    """Not by any signature of any kernel that is loaded."""
    speeds = np.array([0.5, 1.0, 1.5])

    def call(V0, omega0, t) -> int:
        vr.stress(SCENE, V0, omega0, delta=0.0)
        for method in ("integrate", "flow"):
            vr.ensemble(SCENE, V0, omega0, t, method=method)
        modules = [module for name, module in sys.modules.items() if name.startswith("viscoroll.kernels.")]
        kernels = {
            id(each): each for module in modules for each in vars(module).values() if hasattr(each, "signatures")
        }
        return sum(len(kernel.signatures) for kernel in kernels.values())

    once = call(speeds, speeds, speeds)
    assert once > 0 or numba.config.DISABLE_JIT
    for make in KINDS.values():
        assert call(make(speeds), 1.0, make(speeds)) == call(0.5, make(speeds), 1.0) == once


def test_empty():
    nothing = np.empty((0,))
    assert vr.stress(SCENE, nothing, 1.0, delta=0.0).p.shape == (0,)
    assert vr.stress(SCENE, np.zeros((3, 1)), nothing, delta=0.0).tau.shape == (3, 0)
    for method in ("integrate", "flow", "auto"):
        many = vr.ensemble(SCENE, nothing, nothing, 1.0, method=method)
        assert many.V.shape == (0, 1)
        assert many.messages() == {}
    assert SCENE.validity(nothing).under_axis.holds.shape == (0,)
    table = vr.tables.build(**GRID)
    assert vr.tables.interpolate(table, V=nothing, delta=0.0, alpha=11.0).Q.shape == (0,)
    for shape in ((0,), (0, 3), (2, 0)):
        for method in ("table", "direct"):
            assert vr.contact(SCENE, np.empty(shape), delta=0.1, method=method).Q.shape == shape
    refused(lambda: vr.ensemble(SCENE, 1.0, 1.0, nothing), "t = ")
    refused(lambda: vr.tables.build(SCENE, nothing, [0.0]), "V = ")


@pytest.mark.parametrize("name", ["one by one", "slice", "grid", "slopes", "stress", "flow map", "integrated"])
def test_large_arrays_in_bounded_memory(name):
    """Beside input and result a call takes the same few megabytes whatever its size (10^8 elements: make prove)."""
    measured = importlib.import_module("pipeline.measure.large").measured
    if not Path("/proc/self/status").exists():
        pytest.skip("the system does not tell a process its peak")
    found = measured(name, 200_000 if name == "integrated" else 5_000_000)
    assert found["result_bytes"] >= 8 * found["elements"]
    assert found["extra_bytes"] <= tol.MEMORY_SLACK


def test_committed_memory_is_bounded():
    """As measured at full size."""
    rows = json.loads((RESULTS / "large.json").read_text(encoding="utf-8"))["rows"]
    assert max(row["elements"] for row in rows) == 100_000_000
    assert all(row["extra_bytes"] <= tol.MEMORY_SLACK for row in rows)
