"""The folder of every cache, with files in it that nobody else can have written, and the line that
tells the user of a compilation; without numba.

Files of a cache are run (:mod:`.jit`) or trusted (``motion/flow.py``), and a checksum that a file
carries itself does not say who wrote it.  So a file is used only if it and every folder above it
belong to this user or to the system, and nobody else may write to them.

The folder is ``$VISCOROLL_CACHE_DIR``, else ``$XDG_CACHE_HOME/viscoroll``, else
``~/.cache/viscoroll``, else, of a user without a home directory, a folder of this user in
``$TMPDIR`` or ``/tmp``.

The line is one on standard error, for the user who waits while kernels are compiled.
"""

import errno
import multiprocessing
import os
import secrets
import stat
import sys
import warnings
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

# --- The folder of every cache, and files in it that nobody else can have written ---

#: Number of the superuser's group.
_SUPERUSERS = 0


def cache_root() -> Path:
    """Return the folder that holds every cache of the package, chosen by the environment as the
    module says.

    An environment variable that is empty counts as one that is not set.
    Returns its path, as the variable has it, absolute or relative; the folder may not exist yet.
    If neither variable is set and the user has no home directory, a RuntimeWarning names the
    folder, once in a process.
    """
    if chosen := os.environ.get("VISCOROLL_CACHE_DIR"):
        return Path(chosen)
    if base := os.environ.get("XDG_CACHE_HOME"):
        return Path(base) / "viscoroll"
    try:
        return Path.home() / ".cache" / "viscoroll"
    except RuntimeError:
        return _without_home()


@lru_cache(maxsize=1)
def _without_home() -> Path:
    """Return the path of the cache folder of a user without a home directory, and warn of it once
    in a process.

    Returns viscoroll-UID in $TMPDIR, or in /tmp if that is not set or empty, with the number of the
    user for UID; viscoroll-cache on systems without such numbers (Windows).
    """
    user = os.geteuid() if hasattr(os, "geteuid") else "cache"
    folder = Path(os.environ.get("TMPDIR") or "/tmp") / f"viscoroll-{user}"
    warnings.warn(
        f"there is no home directory: caches are in {folder} (set VISCOROLL_CACHE_DIR to name "
        "another folder)",
        RuntimeWarning,
        stacklevel=2,
    )
    return folder


def read_private(path: Path) -> bytes:
    """Return the content of a file of the cache, if nobody else can have written it.

    path : the file.
    Returns its bytes.  Raises OSError if the file does not exist or cannot be read, and
    PermissionError, which is an OSError too, if others may write to it or to a folder above it, or
    if one belongs to another user (:func:`refuse_writable_by_others`).
    """
    refuse_writable_by_others(path)
    return path.read_bytes()


def write_private(path: Path, content: bytes) -> None:
    """Write a file of the cache, whole or not at all, which others may only read; folders above it
    are made.

    path : the file; an existing one is replaced.
    content : its bytes.
    Returns None.  Raises OSError if it cannot be written, PermissionError if others may write to a
    folder above it or one belongs to another user (:func:`refuse_writable_by_others`); an existing
    file then keeps its content, and no temporary file is left.
    """
    make_private_folder(path.parent)
    # in the same folder, so that os.replace is one step that nobody sees half done
    temporary = path.with_name(f".{os.getpid()}-{secrets.token_hex(4)}.tmp-{path.name}")
    try:
        # made with its rights before anything is in it, and never one that others have put there
        temporary.touch(mode=0o644, exist_ok=False)
        temporary.write_bytes(content)
        os.replace(temporary, path)
    finally:
        with suppress(OSError):  # it does not exist any more, unless a step before failed
            temporary.unlink()


def make_private_folder(folder: Path) -> None:
    """Make a folder of the cache and the folders above it, as far as they do not exist, writable by
    this user alone.

    folder : path of the folder; one that exists keeps its rights, and a file at this path is not
    noticed.
    Returns None.  Raises PermissionError if others may write to an existing one of these folders or
    one belongs to another user (:func:`refuse_writable_by_others`), else OSError if one cannot be
    made.
    """
    refuse_writable_by_others(folder)
    # from the top down, each with this mode, which ``parents=True`` would not give to all
    for parent in reversed((folder, *folder.parents)):
        if not parent.exists():
            parent.mkdir(mode=0o755, exist_ok=True)  # another process may have made it meanwhile


def refuse_writable_by_others(path: Path) -> None:
    """Raise PermissionError if others may write to ``path`` or to a folder above it, or if one
    belongs to another user.

    The owners that are allowed are this user, the superuser and the owner of "/".  Rights of a
    group count as rights of others unless the group is private (:func:`_is_private`).  A sticky
    folder to which others may write is allowed, because nobody can replace the files of another
    user there.  Where ``path`` is a link, its target and the folders above that are tested too.

    path : file or folder; it and folders above it that do not exist, or whose status cannot be
    read, are passed over.
    Returns None; on Windows, where the profile of a user is theirs alone, nothing is tested.  The
    error says how to change the rights, where rights are the reason, and how to choose another
    folder.
    """
    if not hasattr(os, "geteuid"):
        return
    # the owner of "/" may do anything; in a container that is not always 0
    trusted = {os.geteuid(), 0, Path("/").stat().st_uid}
    # the path as written, whose links others might replace, and the one it leads to, each part once
    plain = path.absolute()
    real = Path(os.path.realpath(path))
    for part in dict.fromkeys((plain, *plain.parents, real, *real.parents)):
        try:
            status = part.stat()
        except OSError:  # it does not exist yet
            continue
        group = status.st_mode & stat.S_IWGRP and not _is_private(status.st_gid)
        # S_ISVTX: a sticky folder, such as /tmp
        shared = (group or status.st_mode & stat.S_IWOTH) and not status.st_mode & stat.S_ISVTX
        if shared or status.st_uid not in trusted:
            problem = "others may write to it" if shared else "it belongs to another user"
            remedy = f"`chmod go-w {part}`, or " if shared else ""
            text = f"{part}: {problem}; {remedy}name a folder of your own by VISCOROLL_CACHE_DIR"
            raise PermissionError(errno.EPERM, text)


def _is_private(group: int) -> bool:
    """Return whether nobody but this user and the superuser can use the rights of a group.

    Many systems give each user a group of their own, whose right to write harms nobody.

    group : int, number of the group.
    Returns True for group 0, the superuser's, whoever its members are; True for a group that has
    the name of this user and lists no member but this user; else False, also if the group or this
    user has no entry in the system's lists.
    """
    # modules that Windows does not have, where nobody calls this
    import grp
    import pwd

    if group == _SUPERUSERS:
        return True
    try:
        user = pwd.getpwuid(os.geteuid()).pw_name
        entry = grp.getgrgid(group)
    except KeyError:
        return False
    return entry.gr_name == user and set(entry.gr_mem) <= {user}


# --- One line on standard error for the user who waits while kernels are compiled ---

#: Whether this process has printed the line.
announced = False


def announce_compiling() -> None:
    """Print a line on standard error that kernels are being compiled, at most once in a process.

    The number of kernels is not known at that time, so that the line names none.
    Returns None.  Nothing is printed where :func:`is_quiet` is True; a later call may then still
    print the line.
    """
    global announced
    if announced or is_quiet():
        return
    announced = True
    print(
        "viscoroll: compiling kernels, up to half a minute for each new kind of call, once for "
        "this machine; "
        "`viscoroll warmup` does it ahead",
        file=sys.stderr,
        flush=True,
    )


def is_quiet() -> bool:
    """Return whether nobody waits who could read the line.

    Returns True if the environment variable VISCOROLL_QUIET is "1" (no other value counts), if
    there is no standard error, or if the process is a worker (:func:`is_worker`).
    """
    return os.environ.get("VISCOROLL_QUIET") == "1" or sys.stderr is None or is_worker()


def is_worker() -> bool:
    """Return whether this process works for another one, which prints and warns instead.

    Returns True in a process that multiprocessing has started, and within a task of
    dask.distributed; else False.
    """
    if multiprocessing.parent_process() is not None:
        return True
    distributed = sys.modules.get("distributed")
    try:
        return distributed is not None and distributed.get_worker() is not None
    except ValueError:  # not within a task
        return False
