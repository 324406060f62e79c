"""Other processes and a host that flushes subnormals change no bit; a system that is not POSIX; a
full disk.
"""

import os
import platform
import shutil
import sys
from pathlib import Path

import c_code
import numpy as np
import pytest
import tolerances as tol
from memory import forget
from processes import printed, python
from test_extras import RUN
from test_invariance import assert_same, everything

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")

#: control and status register of SSE: denormals are zero in bit 6, flush to zero in 15
MODES = {"denormals are zero": 0x0040, "flush to zero": 0x8000}
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
    if shutil.which("cc") and platform.machine() in ("x86_64", "AMD64"):
        c_code.compiled(folder, "register", REGISTER)
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


# --- systems that are not POSIX ---

NOT_POSIX = """
import importlib, os, pkgutil, sys
import filelock, h5netcdf, h5py, matplotlib.pyplot, msgspec, numba, numpy, scipy.stats, tqdm, xarray, zarr
for name in ("fcntl", "resource", "pwd", "grp", "termios", "tty", "pty", "syslog"):
    sys.modules[name] = None
for name in set(dir(os)) & set(sys.argv[1].split()):
    delattr(os, name)
if hasattr(os, "process_cpu_count"):
    os.process_cpu_count = os.cpu_count  # as Python 3.13 has it there
import viscoroll
for module in pkgutil.walk_packages(viscoroll.__path__, "viscoroll."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
from viscoroll.runs import estimate, export_netcdf, read_run, run_ensemble
run = read_run("run.toml")
run_ensemble(run, "store.zarr")
export_netcdf("store.zarr", "store.nc")
print(estimate(run).memory > 1e8)
"""  # noqa: E501
#: of os, on no Windows
POSIX_ONLY = """
O_CLOEXEC O_DIRECTORY O_NOFOLLOW chown fchmod fchown fork forkpty getegid geteuid getgid getgroups getpgid getpgrp
getpriority getresgid getresuid getsid getuid killpg lchown lockf mkfifo mknod nice openpty pipe2 posix_fadvise
posix_fallocate posix_spawn pread pwrite register_at_fork sched_getaffinity sched_setaffinity sendfile setgid setpgid
setsid setuid statvfs sync sysconf uname wait wait3 wait4
"""  # noqa: E501


def test_every_module_loads_and_a_run_ends_without_posix(tmp_path):
    (tmp_path / "run.toml").write_text(RUN)
    assert printed(NOT_POSIX, POSIX_ONLY, cwd=tmp_path) == "True\n"
    assert (tmp_path / "store.nc").exists()


# --- a full disk ---

FULL = """
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import test_files
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
path = Path(sys.argv[2])
for name, write in test_files.WRITERS.items():
    write(path)
    before = path.read_bytes()
    for share in (0.0, 0.5, 0.99):
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(share * len(before)), resource.RLIM_INFINITY))
        try:
            write(path)
        except test_files.vr.FileError as error:
            print(error)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        assert path.read_bytes() == before
        assert list(path.parent.iterdir()) == [path]
"""  # noqa: E501


def test_a_full_disk(tmp_path):
    """In a process of its own, as HDF5 2.0 crashes one that meets a full disk: it must not meet
    it.
    """
    path = tmp_path / "file"
    done = python("-c", FULL, Path(__file__).parents[1], path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"{path}: cannot be written (File too large)\n" * 9
