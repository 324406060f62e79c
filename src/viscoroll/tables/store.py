"""Tables on disk: atomic save, and a load that trusts nothing it has not checked."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import TableError
from ..files import seal_holds, write_dataset
from . import schema
from .content import HASH, content_hash, read
from .rehearsal import rehearse
from .survey import EXPECTED, MAX_BYTES, require_whole

if TYPE_CHECKING:
    import xarray as xr

_SIGNATURE = b"\x89HDF\r\n\x1a\n"


def save(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a table as netCDF-4/HDF5: whole and synced, or not at all.

    Every array carries Fletcher-32 checksums, the file a SHA-256 over its content and, behind
    its end, one over its bytes.

    Parameters
    ----------
    table : a Dataset of :func:`build` or :func:`load`.
    path : file to write; a file of that name is replaced.

    Raises
    ------
    OutputError
        If it cannot be written there; a file of that name is left as it was.
    TableError
        If ``table`` is not a table.

    Notes
    -----
    :func:`load` gives back the same values, bit for bit (``tests/tables/test_tables.py``).
    """
    schema.check(table, path)
    stamped = table.copy()
    for variable in stamped.variables.values():
        variable.encoding = {}
    stamped.attrs[HASH] = content_hash(table)
    write_dataset(stamped, path, sealed=True)


def load(path: str | PathLike[str], *, verify: bool = True) -> xr.Dataset:
    """Read a table into memory and close the file.

    A file as :func:`save` left it carries the SHA-256 of its bytes, which is compared before
    anything is parsed.  One without, which another program has written or edited, is first read
    in a process of its own, with bounds on time and memory, which takes about a second.

    Parameters
    ----------
    path : file written by :func:`save`.
    verify : compare bytes and content with the SHA-256s stored in the file; where False, a
        file that has been edited is read nevertheless, but still not one that is no table.

    Returns
    -------
    xarray.Dataset
        The table as it was saved, bit for bit (``tests/tables/test_tables.py``).

    Raises
    ------
    TableError
        A file that is missing, not HDF5, truncated or damaged, of another major schema
        version, not a table, or whose content differs from its hash.
    """
    content = _content(Path(path))
    sealed = seal_holds(content)
    if verify and sealed is False:
        raise TableError(path, "is damaged: its bytes differ from the SHA-256 at their end; rebuild it")
    if not sealed:
        require_whole(content, path)
        rehearse(content, path, verify)
    return read(content, path, verify)


def _content(path: Path) -> bytes:
    """All bytes of an HDF5 file of bounded size: what is parsed is what was verified."""
    try:
        if not path.is_file():
            raise TableError(path, f"{'is not a file' if path.exists() else 'does not exist'}: {EXPECTED}")
        if path.stat().st_size > MAX_BYTES:
            raise TableError(path, f"is larger than {MAX_BYTES} bytes: {EXPECTED}")
        content = path.read_bytes()
    except OSError as error:
        raise TableError(path, f"cannot be read ({error.strerror}): {EXPECTED}") from error
    if not content.startswith(_SIGNATURE):
        raise TableError(path, f"is not an HDF5 file: {EXPECTED}")
    return content


def info(path: str | PathLike[str]) -> str:
    """What the table at ``path`` holds: grid, fields, stated errors, who made it with what.

    Raises
    ------
    TableError
        As :func:`load`.
    """
    table = load(path)
    kind, about, size = table.attrs[schema.KIND], table.attrs, Path(path).stat().st_size / 1e6
    lines = [
        f"{path}: {kind} table, schema {about['schema_version']}, {size:.2f} MB, content verified",
        about["title"],
        "",
        *(f"  {axis:<8} {table[axis].size:>5} nodes in [{table[axis].values[0]:g}, {table[axis].values[-1]:g}]"
          for axis in schema.AXES[kind]),
        *(f"  {name:<8} = {table[name].item():g}" for name in ("kappa", "mu") if name in table.coords),
        "",
        f"  {'field':<25}{'over':<22}{'equation':<18}interpolation error (allowed)",
        *(_field_line(table[name]) for name in schema.FIELDS[kind]),
        "",
    ]  # fmt: skip
    lines += about["material"].splitlines() if kind == "material" else []
    lines += [
        f"{key}: {about[key]}" for key in ("grid", "tolerances", "comment", "source", "software", "history", HASH)
    ]
    return "\n".join(lines)


def _field_line(field: xr.DataArray) -> str:
    error, allowed = (field.attrs.get(key) for key in ("interpolation_error", "interpolation_error_allowed"))
    stated = "" if error is None else f"{error:.2g}" + ("" if allowed is None else f" ({allowed:.2g})")
    return f"  {field.name!s:<25}{', '.join(map(str, field.dims)):<22}{field.attrs['equation']:<18}{stated}"
