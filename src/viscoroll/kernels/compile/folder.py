"""The folder of every cache, and files in it that nobody else has written.

What lies there is run (:mod:`cache`) or believed (``viscoroll.stored``), and a checksum that a file carries itself
says nothing of who wrote it.  So a file is used only if it and every folder above it belong to this user or to the
system, and nobody else may write to them.

The folder is ``$VISCOROLL_CACHE_DIR``, else ``$XDG_CACHE_HOME/viscoroll``, else ``~/.cache/viscoroll``, else, of a user
without a home directory, one of theirs in ``$TMPDIR`` or ``/tmp``.
"""

from __future__ import annotations

import errno
import os
import secrets
import stat
import warnings
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

_SUPERUSERS = 0


def cache_root() -> Path:
    """Folder that holds every cache of the package."""
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
    user = os.geteuid() if hasattr(os, "geteuid") else "cache"
    place = Path(os.environ.get("TMPDIR") or "/tmp") / f"viscoroll-{user}"
    warnings.warn(
        f"there is no home directory: caches are in {place} ($VISCOROLL_CACHE_DIR names another place)",
        RuntimeWarning,
        stacklevel=2,
    )
    return place


def read_private(path: Path) -> bytes:
    """A file of the cache; raises OSError where it is not there, cannot be read, or others may have written it."""
    refuse_writable_by_others(path)
    return path.read_bytes()


def write_private(path: Path, content: bytes) -> None:
    """Keep a file in the cache, whole or not at all, for others to read alone; raises OSError."""
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
    """Make a folder of the cache and those above it, where they are not there; raises OSError."""
    refuse_writable_by_others(folder)
    for each in reversed((folder, *folder.parents)):
        if not each.exists():
            each.mkdir(mode=0o755, exist_ok=True)


def refuse_writable_by_others(path: Path) -> None:
    """Raise PermissionError where others may write to a file or folder, or to one above it, as far as they are there.

    Sticky folders are as good as one's own: there nobody replaces what is another's.  On Windows, where the user's
    profile is theirs alone, nothing is looked at.
    """
    if not hasattr(os, "geteuid"):
        return
    # whom "/" belongs to may do anything; in a container that is not always 0
    trusted = {os.geteuid(), 0, Path("/").stat().st_uid}
    plain, real = path.absolute(), Path(os.path.realpath(path))
    for place in dict.fromkeys((plain, *plain.parents, real, *real.parents)):
        try:
            found = place.stat()
        except OSError:  # not there yet
            continue
        group = found.st_mode & stat.S_IWGRP and not _is_private(found.st_gid)
        shared = (group or found.st_mode & stat.S_IWOTH) and not found.st_mode & stat.S_ISVTX
        if shared or found.st_uid not in trusted:
            problem = "others may write to it" if shared else "it belongs to another user"
            remedy = f"`chmod go-w {place}`, or " if shared else ""
            text = f"{place}: {problem}; {remedy}name a folder of your own by VISCOROLL_CACHE_DIR"
            raise PermissionError(errno.EPERM, text)


def _is_private(group: int) -> bool:
    """Whether it is the superuser's group, or that which bears this user's name and has nobody else in it."""
    import grp
    import pwd

    if group == _SUPERUSERS:
        return True
    try:
        user, found = pwd.getpwuid(os.geteuid()).pw_name, grp.getgrgid(group)
    except KeyError:
        return False
    return found.gr_name == user and set(found.gr_mem) <= {user}
