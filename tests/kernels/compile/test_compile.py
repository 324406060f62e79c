"""Compiling: deferred to the call from Python, cached on disk, plain where numba's inner names
fail.
"""

import gc
import grp
import hashlib
import os
import pickle
import pwd
import re
import shutil
import sys
import threading
import zlib
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import numba
import numpy as np
import pytest
from filelock import FileLock
from ordinary_user import NOBODY, as_ordinary_user, let_in

from viscoroll.kernels.numerics import cache_folder, deferred_compilation
from viscoroll.kernels.numerics import jit as cache_module
from viscoroll.kernels.numerics.jit import kernel

FACTOR = 3.0


@pytest.fixture(autouse=True)
def _anew(tmp_path, monkeypatch):
    """A cache folder of each test; whatever is told once is told again; what fell back is
    forgotten.
    """
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", str(tmp_path))
    cache_module.warn_once.cache_clear()
    monkeypatch.setattr(deferred_compilation, "_deferring", True)
    yield
    cache_module.warn_once.cache_clear()


# --- deferred compiling ---


def cubed(x):
    return square(x) * x


def square(x):
    return power(x, 2)


def power(x, n):
    y = 1.0
    for _ in range(n):
        y *= x
    return y


@pytest.fixture
def kernels(tmp_path, monkeypatch):
    """The three functions above as kernels, compiled afresh."""
    for function in (power, square, cubed):
        monkeypatch.setitem(globals(), function.__name__, kernel(function))
    return tmp_path


def test_only_what_python_calls_is_compiled_to_machine_code(kernels):
    assert cubed(2.0) == 8.0
    assert [path.name.split("-")[0] for path in kernels.rglob("*.nbc")] == [
        f"{__name__.partition('kernels.')[2]}.cubed"
    ]
    assert square(3.0) == 9.0
    assert len([*kernels.rglob("*.nbc")]) == 2


def test_a_process_waits_for_what_another_one_compiles(kernels, monkeypatch):
    """And compiles by itself where that takes too long."""
    assert cubed(2.0) == 8.0
    (stored,) = kernels.rglob("*.nbc")
    content = stored.read_bytes()
    lock = FileLock(f"{stored}.lock", thread_local=False)
    stored.unlink()
    lock.acquire()
    with monkeypatch.context() as hasty:
        hasty.setattr(cache_module, "PATIENCE", 0.0)
        assert kernel(cubed.py_func)(2.0) == 8.0
    monkeypatch.delattr(deferred_compilation.EntryPipeline, "compile_extra")
    stored.unlink()

    def store():
        stored.write_bytes(content)
        lock.release()

    other = threading.Timer(0.2, store)
    other.start()
    assert kernel(cubed.py_func)(2.0) == 8.0
    other.join()
    assert not [*kernels.rglob("*.lock")]


@pytest.mark.parametrize(
    "name",
    [
        "numba.core.codegen.JITCodeLibrary",
        "numba.core.compiler_machinery.register_pass",
        "numba.core.typed_passes.NativeLowering",
    ],
)
def test_without_an_inner_name_of_numba_kernels_still_compile(kernels, monkeypatch, name):
    # asked anew for these kernels alone: parts that others compiled before belong to the pipelines
    # that are kept
    monkeypatch.setattr(
        deferred_compilation, "_pipelines", deferred_compilation._pipelines.__wrapped__
    )
    monkeypatch.delattr(name)
    with pytest.warns(
        RuntimeWarning, match=r"does not compile cubed with what it calls \(.*one by one"
    ):
        assert cubed(2.0) == 8.0
    assert square(2.0) == 4.0  # told once, and warnings are errors here


def test_what_the_user_froze_stays_frozen(kernels):
    """Compiling moves its own objects to the oldest generation of the garbage collector."""
    gc.freeze()
    try:
        before = gc.get_freeze_count()
        assert cubed(2.0) == 8.0
        assert gc.get_freeze_count() > before // 2  # some of the frozen objects end
    finally:
        gc.unfreeze()
    assert square(3.0) == 9.0
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


# --- the cache ---


def scaled(x):
    return FACTOR * x


@pytest.fixture
def cache(tmp_path):
    """A cache folder that holds ``scaled`` for one signature."""
    assert fresh() == 0
    return tmp_path / f"kernels-{cache_module.sources_digest()}"


def fresh():
    """Use the kernel as a new process would: the value is right; returns the number of cache
    hits.
    """
    function = kernel(scaled)
    assert function(2.0) == 6.0
    return sum(function.stats.cache_hits.values())


def assert_compiled(words):
    """A use that warns in these words, and takes nothing from the cache."""
    with pytest.warns(RuntimeWarning, match=words):
        assert fresh() == 0


#: without a figure: the first kernel does not know how many follow it
NOTICE = (
    r"viscoroll: compiling kernels, [^\d\n]*, once for this machine; "
    r"`viscoroll warmup` does it ahead\n"
)


def third(array):
    return array[2]


def test_settings_that_machine_code_follows_have_code_of_their_own(monkeypatch, capsys):
    """What was compiled without checks is not what a process that asks for them is given.  A
    process that compiles says so once."""
    monkeypatch.setenv("VISCOROLL_QUIET", "")
    monkeypatch.setattr(cache_folder, "announced", False)
    two = np.arange(4.0)[:2]
    assert kernel(third)(two) == 2.0
    monkeypatch.setattr(numba.config, "BOUNDSCHECK", 1)
    with pytest.raises(IndexError):
        kernel(third)(two)
    assert re.fullmatch(NOTICE, capsys.readouterr().err)


def sealed(content):
    return hashlib.sha256(content).digest() + content


DAMAGE = {
    "flipped": lambda content: content[:99] + bytes([content[99] ^ 16]) + content[100:],
    "empty": lambda content: b"",
    "of another numba": lambda content: sealed(pickle.dumps(("another", "numba"))),
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_file_is_replaced(cache, damage):
    """The value is right, and the time after that it comes from the cache again."""
    (path,) = cache.iterdir()
    path.write_bytes(damage(path.read_bytes()))
    assert_compiled("cache of compiled kernels is damaged")
    assert fresh() == 1


class Planted:
    """Does something where it is unpickled."""

    def __init__(self, trace):
        self.trace = trace

    def __reduce__(self):
        return Path.touch, (self.trace,)


def plant(path):
    """A file that is whole by its own checksum; where it leaves a trace if it is run."""
    trace = path.parents[1] / "trace"
    path.write_bytes(sealed(zlib.compress(pickle.dumps(Planted(trace)))))
    return trace


SHARED = (
    r"compiled kernels are not cached \(.*: others may write to it; `chmod go-w .*, or name "
    r"a folder of your own"
)


@pytest.mark.parametrize("place", ["folder", "root", "above"])
def test_what_others_may_have_written_is_not_run(cache, place):
    """Nor added to, and there is a word; with rights that are one's own alone it is used again."""
    (path,) = cache.iterdir()
    stored = path.read_bytes()
    shared = {"folder": cache, "root": cache.parent, "above": cache.parents[1]}[place]
    before = shared.stat().st_mode
    trace = plant(path)
    shared.chmod(0o777)
    assert_compiled(SHARED)
    assert not trace.exists()
    # sticky as /tmp: nobody there replaces what is another's
    shared.chmod(before if place != "above" else 0o1777)
    path.write_bytes(stored)
    assert fresh() == 1


@pytest.mark.skipif(os.geteuid() != 0, reason="the superuser alone gives files away")
def test_what_belongs_to_another_is_not_run(cache):
    (path,) = cache.iterdir()
    trace = plant(path)
    os.chown(cache, NOBODY, -1)
    assert_compiled(r"compiled kernels are not cached \(.*: it belongs to another user; name")
    assert not trace.exists()


@pytest.mark.filterwarnings("ignore:compiled kernels are not cached")
def test_a_group_of_one_is_no_others(cache, monkeypatch):
    """As where every user has a group that bears their name, and a umask of 002."""
    cache.chmod(0o775)
    user = pwd.getpwuid(os.geteuid()).pw_name
    for name, members, hits in (
        (user, [], 1),
        (user, [user], 1),
        (user, ["another"], 0),
        ("staff", [], 0),
    ):
        found = SimpleNamespace(gr_name=name, gr_mem=members)
        monkeypatch.setattr(grp, "getgrgid", lambda group, found=found: found)
        monkeypatch.setattr(cache_folder, "_SUPERUSERS", -1)
        cache_module.warn_once.cache_clear()
        assert fresh() == hits


def test_folders_are_made_for_oneself(tmp_path, monkeypatch):
    """Whatever the umask."""
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", str(tmp_path / "deep" / "cache"))
    before = os.umask(0)
    try:
        assert fresh() == 0
    finally:
        os.umask(before)
    assert all(path.stat().st_mode & 0o022 == 0 for path in tmp_path.rglob("*"))
    assert fresh() == 1


def used_from_the_cache():
    assert fresh() == 1


def test_a_read_only_cache_is_used(cache):
    let_in(cache.parent)
    for path in (*cache.iterdir(), cache):
        path.chmod(0o555)
    assert as_ordinary_user(used_from_the_cache) == ""
    cache.chmod(0o755)


def test_an_unwritable_folder_only_warns(tmp_path, monkeypatch):
    """A file where the folder should be: stops even the superuser."""
    obstacle = tmp_path / "file"
    obstacle.write_text("in the way")
    monkeypatch.setenv("VISCOROLL_CACHE_DIR", str(obstacle))
    assert_compiled("compiled kernels are not cached")
    assert fresh() == 0  # once is enough


@pytest.mark.parametrize("name", ["law/law_record.py", "law/ratios.npy", "numerics/jit.py"])
def test_any_change_of_a_source_renames_the_cache_folder(tmp_path, monkeypatch, name):
    """numba's own cache would not notice a change in a function called from another module."""
    copy = tmp_path / "kernels"
    shutil.copytree(cache_module.KERNELS, copy, ignore=shutil.ignore_patterns("__pycache__"))
    digest = cache_module.sources_digest.__wrapped__
    before = digest()
    monkeypatch.setattr(cache_module, "KERNELS", copy)
    assert digest() == before
    with (copy / name).open("ab") as file:
        file.write(b" ")
    assert digest() != before


def test_cache_folder_follows_the_environment(monkeypatch):
    monkeypatch.delenv("VISCOROLL_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", "/xdg")
    assert cache_folder.cache_root() == Path("/xdg/viscoroll")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert cache_folder.cache_root() == Path.home() / ".cache" / "viscoroll"


def test_who_has_no_home_has_a_folder_for_temporary_files(tmp_path, monkeypatch):
    """Import of the first kernel ended with the error of pathlib."""

    def nowhere():
        raise RuntimeError("Could not determine home directory.")

    for name in ("VISCOROLL_CACHE_DIR", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", nowhere)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    cache_folder._without_home.cache_clear()
    assert_compiled(rf"caches are in {tmp_path}/\S+ \(set VISCOROLL_CACHE_DIR to name another ")
    assert fresh() == 1
    assert [path.name for path in tmp_path.iterdir()] == [f"viscoroll-{os.geteuid()}"]
    cache_folder._without_home.cache_clear()


# --- what is said ---


def test_numba_switched_off_is_refused(monkeypatch):
    """Vectors of four are machine code alone."""
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    monkeypatch.delitem(sys.modules, cache_module.__name__)
    with pytest.raises(ImportError, match="NUMBA_DISABLE_JIT = 1: must be 0"):
        import_module(cache_module.__name__)
