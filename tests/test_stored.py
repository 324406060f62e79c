"""What takes long to make, on disk: the numbers that were made, or made anew."""

import os
from pathlib import Path

import numpy as np
import pytest

from viscoroll.core import stored


@pytest.fixture
def folder(tmp_path) -> Path:
    return tmp_path / "made"


def kept(folder: Path, number: float) -> bool:
    """Whether what the number determines is there; else it is made."""
    path = folder / stored.file_name([number])
    found = stored.load(path, "table", [number], lambda arrays: arrays["table"])
    if found is None:
        stored.save(path, [number], table=np.arange(number))
        return False
    assert np.array_equal(found, np.arange(number))
    return True


def test_made_once(folder):
    assert [kept(folder, number) for number in (2.0, 3.0, np.nextafter(3.0, 4.0), 2.0, 3.0)] == [False] * 3 + [True] * 2
    assert len(list(folder.iterdir())) == 3


def test_no_folder(folder):
    """A file stands in its place."""
    folder.write_text("")
    assert not kept(folder, 2.0)
    assert not kept(folder, 2.0)


def test_what_others_may_have_written_is_not_read(folder):
    kept(folder, 2.0)
    (path,) = folder.iterdir()
    folder.chmod(0o777)
    path.write_bytes(b"others' work, which is damaged if it is looked at")
    assert not kept(folder, 2.0)
    assert path.read_bytes().startswith(b"others")
    folder.chmod(0o755)
    with pytest.warns(RuntimeWarning, match="is damaged"):
        assert not kept(folder, 2.0)
    assert kept(folder, 2.0)


DAMAGE = {
    "bit": lambda content, _: content[:200] + bytes([content[200] ^ 4]) + content[201:],
    "truncated": lambda content, _: content[: len(content) // 2],
    "empty": lambda content, _: b"",
    "other": lambda _, other: other,
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_what_is_damaged_is_made_anew(folder, damage):
    for number in (2.0, 3.0):
        kept(folder, number)
    path, other = (folder / stored.file_name([number]) for number in (2.0, 3.0))
    path.write_bytes(DAMAGE[damage](path.read_bytes(), other.read_bytes()))
    with pytest.warns(RuntimeWarning, match=r"table is damaged \(.+\); it is built anew"):
        assert not kept(folder, 2.0)
    assert kept(folder, 2.0)


def test_a_read_only_folder_is_used(folder, monkeypatch):
    """The time of use cannot be noted there; that is no reason to make it again."""

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    kept(folder, 2.0)
    monkeypatch.setattr(Path, "touch", refuse)
    assert kept(folder, 2.0)


def test_those_used_last_are_kept(folder, monkeypatch):
    monkeypatch.setattr(stored, "KEPT", 2)
    for number in (2.0, 3.0):
        kept(folder, number)
        os.utime(folder / stored.file_name([number]), (0.0, number))  # long ago
    assert kept(folder, 2.0)  # used again
    kept(folder, 4.0)
    assert len(list(folder.iterdir())) == 2
    assert kept(folder, 2.0)
    assert not kept(folder, 3.0)
