"""Files that are whole or not there, whatever stands in the way; and the seal behind them."""

import os
import stat
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from calls import TREAD, grid, law_file
from ordinary_user import as_ordinary_user, let_in
from refusals import refused

import viscoroll as vr
from viscoroll.core import files

DATA = xr.Dataset({"V": ("t", np.random.default_rng(1).random(20_000))})
WRITERS = {
    "text": lambda path: files.write_text(path, "new"),
    "bytes": lambda path: files.write_bytes(path, b"new"),
    "dataset": lambda path: files.write_dataset(DATA, path),
}


@pytest.fixture(params=WRITERS.values(), ids=WRITERS)
def write(request):
    return request.param


# --- what stands in the way ---


#: what stands at a path, and how it is told
OBSTACLES = {
    "a directory": (Path.mkdir, "cannot be written: it is a directory"),
    "no folder": (lambda path: path.parent.rmdir(), "in a folder that does not exist"),
    "a loop of links": (lambda path: path.symlink_to(path), "it is a loop of symbolic links"),
    "a pipe": (os.mkfifo, "it is not a regular file"),
    "a device": (
        lambda path: path.symlink_to(os.devnull),
        "it is not a regular file",
    ),  # which a rename would replace
}


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_an_obstacle_is_told_and_stays(write, tmp_path, obstacle):
    make, words = OBSTACLES[obstacle]
    path = tmp_path / "folder" / "file"
    path.parent.mkdir()
    make(path)

    def there():
        return [(each.name, each.lstat().st_mode) for each in tmp_path.rglob("*")]

    before = there()
    refused(lambda: write(path), words, error=vr.FileError)
    assert there() == before
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)


def test_a_symbolic_link_stays_and_its_target_is_written(write, tmp_path):
    (tmp_path / "far").mkdir()
    for name, target in (
        ("link", "far/file"),
        ("link to the link", "link"),
        ("to nothing yet", "far/new"),
    ):
        (tmp_path / name).symlink_to(target)
        write(tmp_path / name)
        assert (tmp_path / name).readlink() == Path(target)
    assert sorted(path.name for path in (tmp_path / "far").iterdir()) == ["file", "new"]


@pytest.fixture
def shared(tmp_path, write):
    """A folder that others may enter; what ``write`` imports is loaded, for they may not read where
    it lies.
    """
    write(tmp_path / "before")
    let_in(tmp_path)
    folder = tmp_path / "shared"
    folder.mkdir()
    folder.chmod(0o777)
    return folder


@pytest.mark.parametrize(
    "file, folder, words",
    [(0o444, 0o777, "it is read-only"), (0o666, 0o555, "Permission denied")],
)
def test_what_is_read_only_is_not_replaced(write, shared, file, folder, words):
    """A rename would not ask."""
    path = shared / "file"
    path.write_text("as it was")
    path.chmod(file)
    shared.chmod(folder)
    text = as_ordinary_user(lambda: write(path))
    assert "FileError" in text
    assert words in text
    assert path.read_text() == "as it was"
    path.chmod(0o666)
    shared.chmod(0o777)
    assert as_ordinary_user(lambda: write(path)) == ""


def test_an_error_on_the_way_leaves_all_as_it_was(tmp_path):
    path = tmp_path / "file"
    path.write_text("as it was")
    with pytest.raises(TypeError), files.replace_file(path) as temporary:
        temporary.write_text("half") + "no number"
    assert path.read_text() == "as it was"
    assert list(tmp_path.iterdir()) == [path]


# --- the seal ---


def test_no_change_goes_unnoticed():
    """Every flipped bit breaks the seal or unmakes it; so does what is cut or added."""
    sealed = files.seal(b"some content")
    assert files.seal_matches(sealed)
    whole = int.from_bytes(sealed, "big")
    changed = [(whole ^ 1 << bit).to_bytes(len(sealed), "big") for bit in range(8 * len(sealed))]
    changed += [sealed[:end] for end in range(len(sealed))] + [sealed + b"\n"]
    assert not any(map(files.seal_matches, changed))
    assert files.seal_matches(b"some content") is None


# --- what is read is what was written ---

#: format -> how a file of it is written, and read
FORMATS = {
    "law": (lambda path: vr.tables.save(law_file(), path), vr.load_law),
    "law of every alpha": (
        lambda path: vr.tables.save(vr.tables.law(alpha=(8.0, 16.0)), path),
        lambda path: vr.load_law(path, 11.0),
    ),
    "grid": (lambda path: vr.tables.save(grid(), path), vr.tables.load),
    "material": (TREAD.to_netcdf, vr.Material.from_netcdf),
}


@pytest.mark.parametrize("form", FORMATS)
def test_damage_is_told(form, tmp_path):
    """One flipped bit anywhere, a file that is cut, longer or another, none: an error in one line
    that names it.
    """
    path = tmp_path / "file.nc"
    write, read = FORMATS[form]

    def told(path, *words):
        refused(lambda: read(path), str(path), *words, error=vr.FileError)

    def told_of(content):
        path.write_bytes(content)
        told(path)

    told(path, "cannot be read")
    told(tmp_path, "cannot be read")
    write(path)
    assert [each.name for each in tmp_path.iterdir()] == ["file.nc"]
    whole = path.read_bytes()
    for position in np.random.default_rng(3).integers(0, 8 * (len(whole) - 200), 20):
        damaged = bytearray(whole)
        damaged[position // 8] ^= 1 << position % 8
        told_of(bytes(damaged))
    for share in (0.001, 0.5, 0.99):
        told_of(whole[: int(share * len(whole))])
    for other in (b"", b"V,delta\n1,2\n", files.seal(b"[material]")):
        told_of(other)
    # a table that is loaded may be a law, and load_law reads grids too
    if form != "material":
        TREAD.to_netcdf(path)
        told(path)
