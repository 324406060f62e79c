"""The folder of every cache, and files in it that nobody else can have written.

Its files are run (:mod:`cache`) or trusted (``motion/flow_store.py``), and a checksum that a file carries itself does
not say who wrote it.  So a file is used only if it and every folder above it belong to this user or to the system, and
nobody else may write to them.

The folder is ``$VISCOROLL_CACHE_DIR``, else ``$XDG_CACHE_HOME/viscoroll``, else ``~/.cache/viscoroll``, else, of a user
without a home directory, a folder of this user in ``$TMPDIR`` or ``/tmp``.
"""

import errno
import os
import secrets
import stat
import warnings
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

#: Number of the superuser's group.
_SUPERUSERS = 0


def cache_root() -> Path:
    """Return the folder that holds every cache of the package.

    It is $VISCOROLL_CACHE_DIR; if that is not set or empty, $XDG_CACHE_HOME/viscoroll; if that is neither,
    ~/.cache/viscoroll.  A user without a home directory has a folder of temporary files, and is warned of it once in a
    process.

    Returns its path, absolute or relative as the variable is; the folder may not exist yet.
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
    """Return the cache folder of a user without a home directory, and warn of it once in a process.

    Returns the path of viscoroll-UID (viscoroll-cache where users have no number) in $TMPDIR, or in /tmp if that is not
    set or empty; it may not exist yet.
    """
    user = os.geteuid() if hasattr(os, "geteuid") else "cache"
    folder = Path(os.environ.get("TMPDIR") or "/tmp") / f"viscoroll-{user}"
    warnings.warn(
        f"there is no home directory: caches are in {folder} ($VISCOROLL_CACHE_DIR names another folder)",
        RuntimeWarning,
        stacklevel=2,
    )
    return folder


def read_private(path: Path) -> bytes:
    """Return the content of a file of the cache, bytes.

    path : the file; nothing of it is read before the test of :func:`refuse_writable_by_others`.
    Raises OSError if the file does not exist or cannot be read, and PermissionError, which is one, if others may have
    written it.
    """
    refuse_writable_by_others(path)
    return path.read_bytes()


def write_private(path: Path, content: bytes) -> None:
    """Write a file of the cache, whole or not at all, which others may only read; missing folders above it are made.

    The content is written to a temporary file beside it, which then replaces it; after an error the temporary file is
    removed and an existing file stays as it was.

    path : the file; an existing one is replaced.
    content : its bytes.
    Returns None.  Raises OSError if it cannot be written, PermissionError if others may write to a folder above it.
    """
    make_private_folder(path.parent)
    temporary = path.with_name(f".{os.getpid()}-{secrets.token_hex(4)}.tmp-{path.name}")
    try:
        temporary.touch(mode=0o644, exist_ok=False)
        temporary.write_bytes(content)
        os.replace(temporary, path)
    finally:
        with suppress(OSError):
            temporary.unlink()


def make_private_folder(folder: Path) -> None:
    """Make a folder of the cache, and those above it that do not exist; others may then only read them.

    folder : the folder; nothing is made if it exists.
    Returns None.  Raises PermissionError if others may write to it or to a folder above it, OSError if one cannot be
    made.
    """
    refuse_writable_by_others(folder)
    for parent in reversed((folder, *folder.parents)):
        if not parent.exists():
            parent.mkdir(mode=0o755, exist_ok=True)


def refuse_writable_by_others(path: Path) -> None:
    """Raise PermissionError if others may write to a path, or to a folder above it, as far as they exist.

    Others may write where the rights of all allow it, or those of a group that has other members (:func:`_is_private`).
    Sticky folders are allowed: nobody can replace the files of another user there.  Nor may the path or a folder above
    it belong to another user than this one, the superuser or the owner of "/".  If ``path`` is a link, the folders
    above its target are tested too.

    On Windows, where the profile of a user is theirs alone, nothing is tested.  What cannot be looked at counts as not
    existing.

    path : file or folder, relative or absolute, which may not exist.
    Returns None.  The error says how to change the rights or to choose another folder.
    """
    if not hasattr(os, "geteuid"):
        return
    # the owner of "/" may do anything; in a container that is not always 0
    trusted = {os.geteuid(), 0, Path("/").stat().st_uid}
    plain, real = path.absolute(), Path(os.path.realpath(path))
    for part in dict.fromkeys((plain, *plain.parents, real, *real.parents)):
        try:
            status = part.stat()
        except OSError:  # it does not exist yet
            continue
        group = status.st_mode & stat.S_IWGRP and not _is_private(status.st_gid)
        shared = (group or status.st_mode & stat.S_IWOTH) and not status.st_mode & stat.S_ISVTX
        if shared or status.st_uid not in trusted:
            problem = "others may write to it" if shared else "it belongs to another user"
            remedy = f"`chmod go-w {part}`, or " if shared else ""
            text = f"{part}: {problem}; {remedy}name a folder of your own by VISCOROLL_CACHE_DIR"
            raise PermissionError(errno.EPERM, text)


def _is_private(group: int) -> bool:
    """Return whether nobody but this user and the superuser can use the rights of a group.

    group : int, number of the group.

    Returns True for the superuser's group, number 0; for another one True if it has the name of this user and lists no
    other member.  False too if the group or the user has no entry in the system's lists.
    """
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
