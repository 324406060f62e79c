"""Tables of series and of pairs on disk: the bits that were made, or made anew."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from memory import forget

import viscoroll as vr
from viscoroll import stored
from viscoroll.materials import tables as material_tables
from viscoroll.materials.tables import record


def rubber(modes: int, strength: float = 10.0) -> vr.Prony:
    return vr.Prony(np.full(modes, strength / modes), 3.0 ** -np.arange(float(modes)))


TEN = rubber(10)
CREEP = vr.Prony.creep(np.full(12, 0.08), 2.0 ** -np.arange(12.0))
PAIR = vr.Bodies(TEN, rubber(2, 3.0), 0.3)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Tables of a test are its own."""
    monkeypatch.setattr(stored, "folder", lambda kind: tmp_path / kind)
    forget()
    yield tmp_path / "series"
    forget()


def bits(given: Any) -> bytes:
    """The tables of a material or a pair as a new process has them."""
    forget()
    found = record(given)
    return found.table.tobytes() + (found.parts.tobytes() if given is PAIR else b"")


def age(path: Path) -> None:
    """Last used long ago."""
    os.utime(path, (0.0, 0.0))


@pytest.mark.parametrize("given", [TEN, rubber(30), CREEP, PAIR], ids=["10", "30", "creep", "pair"])
def test_the_same_bits_and_made_once(folder, monkeypatch, given):
    made = bits(given)
    files = sorted(folder.iterdir())
    assert len(files) == (2 if given is PAIR else 1)
    assert all(path.stat().st_size < 1_000_000 for path in files)
    monkeypatch.setattr(material_tables, "_filled", None)
    assert bits(given) == made
    assert record(given).table.flags.writeable  # a copy of this thread


def test_few_modes_are_not_worth_a_file(folder):
    record(rubber(9))
    assert not folder.exists()


def test_another_material_has_another_file(folder):
    """However near: an ULP of a strength, or the same series given by its creep compliance."""
    near = vr.Prony(np.append(TEN.E[:-1], np.nextafter(TEN.E[-1], 2.0)), TEN.tau)
    creep = vr.Prony.creep(TEN.J, TEN.T, alpha=TEN.alpha)
    made = [bits(given) for given in (TEN, near, creep)]
    assert len(list(folder.iterdir())) == 3
    assert [bits(given) for given in (TEN, near, creep)] == made


@pytest.mark.parametrize("damage", ["bit", "truncated", "empty", "other"])
def test_damage_is_noticed(folder, damage):
    made = bits(TEN)
    (path,) = folder.iterdir()
    content = bytearray(path.read_bytes())
    if damage == "bit":
        content[len(content) // 2] ^= 4
    elif damage == "other":
        record(rubber(11))
        content = bytearray(next(p for p in folder.iterdir() if p != path).read_bytes())
    else:
        content = content[: len(content) // 2 if damage == "truncated" else 0]
    path.write_bytes(content)
    with pytest.warns(RuntimeWarning, match=r"table of a series is damaged \(.+\); it is built anew"):
        assert bits(TEN) == made
    assert bits(TEN) == made  # and replaced


def test_a_folder_that_cannot_be_written(folder, monkeypatch):
    """What is there is used though the time of use cannot be noted; what is not is made each time."""
    made = bits(TEN)

    def refuse(*_: Any, **__: Any) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "touch", refuse)
    monkeypatch.setattr(Path, "write_bytes", refuse)
    with monkeypatch.context() as patch:
        patch.setattr(material_tables, "_filled", None)
        assert bits(TEN) == made
    assert bits(PAIR) == bits(PAIR)
    assert len(list(folder.iterdir())) == 1


def test_no_folder(folder):
    """A file stands in its place."""
    made = bits(TEN)
    (path,) = folder.iterdir()
    path.unlink()
    folder.rmdir()
    folder.write_text("")
    assert bits(TEN) == made


def test_what_others_may_have_written_is_not_read(folder):
    made = bits(TEN)
    (path,) = folder.iterdir()
    folder.chmod(0o777)
    path.write_bytes(b"others' work, which is damaged if it is looked at")
    assert bits(TEN) == made
    assert path.read_bytes().startswith(b"others")
    folder.chmod(0o755)
    with pytest.warns(RuntimeWarning, match="is damaged"):
        assert bits(TEN) == made


def test_those_used_last_are_kept(folder, monkeypatch):
    monkeypatch.setattr(stored, "KEPT", 2)
    record(TEN)
    (first,) = folder.iterdir()
    age(first)
    record(rubber(11))
    (second,) = set(folder.iterdir()) - {first}
    age(second)
    bits(TEN)  # used again
    record(rubber(12))
    left = set(folder.iterdir())
    assert len(left) == 2
    assert first in left
    assert second not in left
