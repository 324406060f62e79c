"""What is not there everywhere: packages of an extra, what only POSIX has, a newer Python."""

import subprocess
import sys
from functools import partial

import pytest
from processes import python
from run_files import run_of

import viscoroll as vr
from viscoroll.runs import export_netcdf, open_run, run_ensemble

RUN = """
preset = "paper-section-5"
[start]
V0 = { distribution = "uniform", loc = 0.5, scale = 1.0 }
omega0 = 0.5
[run]
n = 20
t = [1e-4]
rtol = 1e-6
"""
MISSING = "zarr", "distributed", "pyarrow"


@pytest.fixture
def bare(monkeypatch):
    """As after `pip install viscoroll`: no extra."""
    before = set(sys.modules)
    for name in MISSING:
        for loaded in [each for each in sys.modules if each.partition(".")[0] == name]:
            monkeypatch.delitem(sys.modules, loaded)
        monkeypatch.setitem(sys.modules, name, None)
    yield
    for name in (
        set(sys.modules) - before
    ):  # parts without their package would serve its next import
        if name.partition(".")[0] in MISSING:
            del sys.modules[name]


# --- extras ---


def test_a_missing_extra_is_named(bare, here):
    run = run_of(RUN)
    store = here / "store.zarr"
    for call in (
        partial(run_ensemble, run, store),
        partial(open_run, store),
        partial(export_netcdf, store, "x"),
    ):
        with pytest.raises(
            vr.MissingDependencyError, match=r"zarr is not .*pip install 'viscoroll\[runs\]'"
        ):
            call()
    assert not store.exists()


def test_cluster_and_parquet_are_extras_too(bare, here, monkeypatch):
    monkeypatch.delitem(sys.modules, "zarr")
    with pytest.raises(vr.MissingDependencyError, match=r"viscoroll\[cluster\]"):
        run_ensemble(run_of(RUN), "store.zarr", cluster="local")
    (here / "a.parquet").touch()
    text = RUN.replace("omega0 = 0.5", 'omega0 = { file = "a.parquet", column = "a" }')
    with pytest.raises(vr.MissingDependencyError, match=r"viscoroll\[parquet\]"):
        run_of(text)


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
    command = [sys.executable, "-c", NOT_POSIX, POSIX_ONLY]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.stdout == "True\n", done.stderr
    assert (tmp_path / "store.nc").exists()


# --- Pythons ---


def test_an_older_python_is_told_in_one_line():
    code = "import sys; sys.version_info = (3, 10, 13); import viscoroll"
    assert (
        python("-c", code)
        .stderr.splitlines()[-1]
        .startswith("ImportError: viscoroll needs Python 3.11 or newer, this is 3.")
    )
