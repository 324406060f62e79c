"""Files that are written whole or not at all: temporary file, fsync, rename, fsync of the folder.

Files that this package reads again end with a seal, the SHA-256 of all bytes before it.  The seal
lies beyond the end that HDF5 and zip files state, so that other programs do not see it, and this
package detects damage before a library parses the file.

Sections of TOML files are checked for unknown keys and wrong types, with the number of the line.
"""

import dataclasses
import functools
import hashlib
import io
import math
import os
import re
import secrets
import tomllib
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_type_hints

from ..kernels.numerics.cache_folder import read_private, write_private
from .errors import FileError, ParameterError, describe_value, suggestion

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import DataArray, Dataset
else:
    #: Types of results, for type checkers alone: no library is imported for them.
    DataArray = DataFrame = Dataset = Figure = Any

#: Path of a file, as callers give it.
FilePath = str | os.PathLike[str]

# --- Files that are written whole, and read if they are as they were written ---

#: Text of a seal before its hash.
_SEAL = b"\nSHA-256 of all before, by viscoroll: "
#: Bytes of a seal: its text, the hash in 64 hexadecimal digits, a line feed.
_SEAL_SIZE = len(_SEAL) + 65


def as_path(path: Any) -> Path:
    """Return a path that a caller gave.

    path: a text or an object with ``__fspath__``.
    Raises FileError for what is no path, as None, a number, bytes or an open file, and for a text
    with a null character.
    """
    if not isinstance(path, str | os.PathLike) or "\0" in str(path):
        raise FileError(
            describe_value(path), "is not a path: must be a text without null characters, or a Path"
        )
    return Path(path)


@contextmanager
def as_file_error(path: Any, problem: str, remedy: str = "") -> Iterator[None]:
    """Raise an OSError of the body of the ``with`` as FileError, with the system's reason.

    The message is "PATH: PROBLEM (REASON)REMEDY", and the OSError is its cause.  Other exceptions
    pass unchanged.  A path with a null character, of which Python raises ValueError, is refused
    before the body.

    path: path of the file or folder, for the message.
    problem: what fails, in words, as "cannot be read".
    remedy: further words with their own punctuation, as ": it must be a table", appended directly
        after the reason in brackets; "" without.
    Yields None.
    Raises FileError too for what is no path (:func:`as_path`).
    """
    as_path(path)
    try:
        yield
    except OSError as error:
        raise FileError(path, f"{problem} ({error.strerror or error}){remedy}") from error


@contextmanager
def replace_file(path: FilePath) -> Iterator[Path]:
    """Give a temporary path beside ``path``, and rename that file to ``path`` when the body of the
    ``with`` ends.

    The body must write a file at the temporary path.  The file and its folder are synced to disk.
    After an exception of the body ``path`` is as it was, and the temporary file is deleted.  A
    process that is killed may leave a temporary file, named .PID-XXXXXXXX.tmp-NAME, which may be
    deleted.  The target of a symbolic link is replaced, and the link stays.  The temporary name has
    the suffix of ``path``, from which writers infer a format.

    path: path of the file to write or to replace.
    Yields the temporary path, at which no file is yet.
    Raises FileError if it is no path; if it cannot be written there: no such folder, a full disk, a
    read-only folder or file, a directory, a device, a loop of links; or if the body wrote no file.
    An OSError of the body becomes a FileError too.  Where the last sync alone fails, that of the
    folder, ``path`` is replaced already.
    """
    target = Path(os.path.realpath(as_path(path)))
    temporary = target.with_name(f".{os.getpid()}-{secrets.token_hex(4)}.tmp-{target.name}")
    try:
        with as_file_error(path, "cannot be written"):
            for wrong, problem in (
                (target.is_symlink(), "a loop of symbolic links"),
                (target.is_dir(), "a directory"),
                (target.exists() and not target.is_file(), "not a regular file"),
                (target.exists() and not os.access(target, os.W_OK), "read-only"),
                (not target.parent.is_dir(), "in a folder that does not exist; make the folder"),
            ):
                if wrong:
                    raise FileError(path, f"cannot be written: it is {problem}")
            yield temporary
            _sync(temporary)
            os.replace(temporary, target)
            _sync(target.parent)
    finally:
        with suppress(OSError):
            temporary.unlink()


def _sync(path: Path) -> None:
    """Write the file or folder at ``path`` from the buffers to the disk; not a folder of Windows.

    Raises OSError if the system cannot.
    """
    folder = path.is_dir()
    if folder and os.name == "nt":
        return  # Windows cannot open folders
    descriptor = os.open(path, os.O_RDONLY if folder else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def seal(content: bytes) -> bytes:
    """Return the ``content`` of a file with its seal."""
    return content + _seal_of(content)


def seal_matches(content: bytes) -> bool | None:
    """Whether the seal at the end of ``content`` is that of the bytes before it; None if there is
    no seal.
    """
    end = content[-_SEAL_SIZE:]
    return end == _seal_of(memoryview(content)[:-_SEAL_SIZE]) if end.startswith(_SEAL) else None


def load_kept(path: Path, damaged: str, read: Callable[[Any], Any]) -> Any:
    """Return the content of a sealed file of arrays in the folder of a cache.

    The time of last change of the file is set to now if possible: the files that were used longest
    ago are deleted first.
    path: path of the file.
    damaged: sentence of the warning, with {} for the fault.
    read: function that makes the result of the arrays by name; an exception in it counts as damage.
    Returns None if there is no file that can be read, also if others may write to it or to a folder
    above it, or if one belongs to another user; None with a RuntimeWarning if it is damaged.
    """
    import numpy as np

    try:
        content = read_private(path)
    except OSError:
        return None
    found = None
    if seal_matches(content):
        with suppress(Exception), np.load(io.BytesIO(content)) as data:
            found = read(data)
    if found is None:
        warnings.warn(
            f"{path}: {damaged.format('its content was damaged or changed')}",
            RuntimeWarning,
            stacklevel=3,
        )
        return None
    with suppress(OSError):  # a folder that is read-only
        path.touch()
    return found


def save_kept(path: Path, most: int, arrays: Mapping[str, Any]) -> None:
    """Write arrays to a sealed file in the folder of a cache, and limit the number of files there.

    path: path of the file, which ends with ".npz".
    most: number of files that stay in the folder, >= 1; those used longest ago are deleted.
    arrays: name -> array.
    If the folder cannot be written, nothing is stored; nothing is raised.
    """
    import numpy as np

    content = io.BytesIO()
    np.savez(content, **arrays)
    with suppress(OSError):
        write_private(path, seal(content.getvalue()))
        for file in sorted(path.parent.glob("*.npz"), key=os.path.getmtime)[:-most]:
            file.unlink()


def read_sealed(path: FilePath, max_bytes: int, kind: str, remedy: str) -> bytes:
    """Return the bytes of a file, compared with the seal at their end if there is one.

    Parameters
    ----------
    path : path of the file.
    max_bytes : largest size of a regular file in bytes, with its seal; a larger one is refused
        before it is read.
    kind : noun for the file that is expected, without its article "a", for errors.
    remedy : advice for a damaged file, the last words of its error.

    Returns
    -------
    bytes
        The whole content with its seal; a file without a seal is not checked.

    Raises
    ------
    FileError
        What is no path; a file that cannot be read, is too large, or differs from its seal;
        netCDF-3, unless a "law or grid" is expected, of which another program may have written the
        grid so.
    """
    file = as_path(path)
    with as_file_error(path, "cannot be read", f": it must be a {kind}"):
        if file.is_file() and (size := file.stat().st_size) > max_bytes:
            problem = f"is too large for a {kind}: it has {size} bytes, allowed are {max_bytes}"
            raise FileError(path, problem)
        content = file.read_bytes()
    if content.startswith(b"CDF") and kind != "law or grid":
        problem = "is netCDF-3, which viscoroll writes for other programs but cannot read"
        raise FileError(path, f"{problem}: give a {kind} in netCDF-4 (.nc)")
    if seal_matches(content) is False:
        raise FileError(
            path, f"is damaged: its content differs from the checksum at its end; {remedy}"
        )
    return content


def _seal_of(content: bytes | memoryview) -> bytes:
    """Return the seal of ``content``."""
    return _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def write_bytes(path: FilePath, content: bytes) -> None:
    """Write ``content`` to a file by :func:`replace_file`, which raises FileError."""
    with replace_file(path) as temporary:
        temporary.write_bytes(content)


def write_text(path: FilePath, text: str) -> None:
    """Write ``text`` to a file in UTF-8, by :func:`replace_file`, which raises FileError.

    What UTF-8 does not have, as a byte of a file name that is not in UTF-8, is written as \\udcff.
    """
    write_bytes(path, text.encode(errors="backslashreplace"))


def fix_texts(dataset: Dataset) -> Dataset:
    """Return a ``dataset`` whose attributes have texts of fixed length, as netCDF's C library
    writes them.

    Octave, Fortran and ``nccopy -k classic`` read no others; Python gets ``str``, from UTF-8.
    """
    import h5py
    import numpy as np

    fixed = dataset.copy()
    for attributes in (fixed.attrs, *(variable.attrs for variable in fixed.variables.values())):
        attributes |= {
            # a command in the history may name a file whose name is not in UTF-8
            key: np.array(content, h5py.string_dtype("utf-8", max(len(content), 1)))
            for key, text in attributes.items()
            if isinstance(text, str)
            for content in [text.encode(errors="backslashreplace")]
        }
    return fixed


def names_ending(dataset: Dataset, end: str) -> list[str]:
    """Return the names of the variables of a ``dataset`` that end with ``end``, without this end,
    in the order of the dataset.
    """
    return [name.removesuffix(end) for name in map(str, dataset) if name.endswith(end)]


def write_dataset(
    dataset: Dataset,
    path: FilePath,
    encoding: dict[str, Any] | None = None,
    *,
    sealed: bool = False,
) -> None:
    """Write a dataset as netCDF-4/HDF5 by :func:`replace_file`: the file is complete or unchanged.

    Texts of attributes have a fixed length (:func:`fix_texts`).

    Parameters
    ----------
    dataset : dataset to write; it is composed in memory.
    path : path of the file, which is replaced if it exists.
    encoding : encoding of variables by name, as xarray takes it, in place of the default for all
        variables.  None or {}: the default, no fill values (CF forbids them for coordinates),
        arrays of numbers that are not empty compressed by zlib and with Fletcher-32 checksums.
    sealed : whether the file ends with a seal, the SHA-256 of all bytes before it.

    Raises
    ------
    FileError
        If it cannot be written there.
    ValueError, TypeError
        Of xarray, for values, attributes or an encoding that netCDF cannot hold.
    """
    filters = {"zlib": True, "complevel": 4, "shuffle": True, "fletcher32": True}
    default = {
        str(name): {"_FillValue": None}
        | (filters if v.ndim and v.size and v.dtype.kind not in "OU" else {})
        for name, v in dataset.variables.items()
    }
    # The file is composed in memory, because HDF5 2.0 crashes the process on a full disk
    # (tests/test_files.py).
    content = bytes(fix_texts(dataset).to_netcdf(engine="h5netcdf", encoding=encoding or default))
    write_bytes(path, seal(content) if sealed else content)


# --- Sections of TOML files ---

T = TypeVar("T")

#: Type as msgspec names it -> words.
_TYPE_NAMES = {
    "float": "a number without a unit",
    "int": "a whole number",
    "str": "a text",
    "bool": "true or false",
    "array": "a list",
    "object": "a table { name = value, ... }",
}


def read_toml(path: FilePath) -> dict[str, Any]:
    """Return the content of a TOML file, as tomllib reads it: name of a key or section -> value or
    dict.

    path: path of the file, in UTF-8; a byte order mark is ignored.
    Raises FileError if it cannot be read, is not UTF-8 or is not TOML, whose integers have 64 bits.
    """
    import msgspec

    try:
        with as_file_error(path, "cannot be read"):
            text = Path(path).read_text(encoding="utf-8-sig")
            content = tomllib.loads(text, parse_float=functools.partial(_finite, path))
        msgspec.msgpack.encode(content)  # tomllib reads longer integers
    except OverflowError as error:
        problem = "has an integer of more than 64 bits: write a shorter or a decimal number"
        raise FileError(path, problem) from error
    except UnicodeDecodeError as error:
        raise FileError(path, f"is not in UTF-8 (byte {error.start}): save it in UTF-8") from error
    # a ValueError of tomllib, or of Python for a number of 5000 digits
    except (ValueError, RecursionError) as error:
        advice = _advise_on_comma(text, str(error))
        raise FileError(path, f"is not TOML: {error}{advice}") from error
    return content


def _finite(path: FilePath, text: str) -> float:
    """Return the number that ``text`` in a TOML file means.

    path: path of the file, for the error.
    Raises FileError for a number beyond the doubles, as 1e400, which Python reads as infinite.
    """
    if math.isinf(number := float(text)) and "inf" not in text:
        raise FileError(path, f"has the number {text}, beyond 1.8e308: write inf for infinity")
    return number


def _advise_on_comma(text: str, problem: str) -> str:
    """Return advice on a decimal comma in a file that is not TOML, to be appended to the error.

    text: content of the file.
    problem: message of tomllib, which names the line.
    Returns ": " and words if the value of a key in that line, outside of lists, has a decimal
    comma, else "".
    """
    if number := re.search(r"line (\d+)", problem):
        line = text.split("\n")[int(number[1]) - 1]
        without_lists = re.sub(r"\[[^\]]*\]", "", line)
        if comma := re.search(r"=\s*([-+]?[\d.]+,\d+)", without_lists):
            return f"; write {comma[1]} with a decimal point"
    return ""


def as_struct(path: Any, name: str, content: Any, kind: type[T]) -> T:
    """Return a section as an instance of a class, its keys and types checked at any depth.

    Unknown keys of the section and its subsections are refused first; then msgspec converts the
    content, and its error is put into words.

    path: path of the file, for errors; it is read again for the line.
    name: name of the section, as "material", for errors.
    content: content of the section, as tomllib reads it; not changed.
    kind: the class, of msgspec or a dataclass, whose fields are the keys.
    Returns a new instance of ``kind``.
    Raises FileError with the line of the first key that is unknown, missing, of the wrong type or
    out of range; also for a section that is no table.
    """
    import msgspec

    _check_all_keys(path, name, content, kind)
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        problem, _, location = str(error).partition(" - at `$")
        keys = re.findall(r"\w+", location)  # of a path as ".prony.E[2]"
        value = content
        for key in keys:
            value = value[int(key)] if isinstance(value, list) else value[key]
        # without the indices of lists, which have no line of their own
        words = [key for key in keys if not key.isdecimal()]
        if missing := re.fullmatch("Object missing required field `(.*)`", problem):
            raise section_error(
                path, ".".join((name, *words)), "", f"needs {missing[1]}"
            ) from error
        # every other fault is that of a key, since the section is a table
        text = repr(value)
        found = f"{words[-1]} = {text if len(text) <= 40 else f'{text:.37}...'}"
        if expected := re.fullmatch("Expected `([^`]*)`, got `[^`]*`", problem):
            types = (_TYPE_NAMES[name] for name in expected[1].split(" | ") if name != "null")
            problem = f"{'.'.join(words)} = {value!r:.40}: must be {' or '.join(types)}"
        elif bounds := re.fullmatch("Expected `[^`]*` (.*)", problem):
            problem = f"{found}: must be {bounds[1]}"
        elif choices := _list_choices(kind, words):
            problem = f"{found}: must be one of {choices}"
        elif problem == "Number out of range":
            problem = f"{found}: must be at most 1.8e308, the largest number that is allowed"
        elif not isinstance(value, dict):
            problem = f"{found}: {problem}"
        raise section_error(path, ".".join((name, *words[:-1])), words[-1], problem) from error


def _list_choices(kind: Any, keys: list[str]) -> str:
    """Return the texts that a key may have, as ``'linear', 'log'``, for an error; "" if it is not a
    choice of texts.

    kind: class of the section, whose annotations state the choices as ``Literal``.
    keys: path of the key in it, from the outermost subsection to the key; a key that the class does
    not have gives "".
    """
    for key in keys:
        kinds = map(get_type_hints, _sections_in(kind))
        kind = next((each[key] for each in kinds if key in each), None)
    return ", ".join(repr(each) for each in get_args(kind) if isinstance(each, str))


def _sections_in(kind: Any) -> list:
    """Return those of a type, or of the members of a union as Section | None, that have keys."""
    return [
        each
        for each in (kind, *get_args(kind))
        if dataclasses.is_dataclass(each) or hasattr(each, "__struct_fields__")
    ]


def _check_all_keys(path: Any, name: str, content: Any, kind: Any) -> None:
    """Raise FileError, with the line of the key, for keys that a section or its subsections do not
    have.

    A subsection is a table at a key whose type is, or may be, a struct or dataclass; other tables
    are not searched.  Keys of the section come first, then those of its subsections in order.

    path, name: path of the file and name of the section, as "material.prony", for errors.
    content: keys and values of the section; what is no table is refused too.
    kind: struct or dataclass whose fields are the allowed keys; of several that a type allows the
    first counts.
    """
    hints = get_type_hints(kind)
    check_keys(path, name, content, hints)
    for key, value in content.items():
        if (subsections := _sections_in(hints[key])) and isinstance(value, dict):
            _check_all_keys(path, f"{name}.{key}", value, subsections[0])


def check_keys(path: Any, name: str, content: Any, allowed: Iterable[str]) -> None:
    """Refuse an unknown key of a section; the error states its line and a similar allowed key if
    there is one.

    path: path of the file, for the error, which reads it again for the line.
    name: name of the section, "" for the top level.
    content: content of the section, as tomllib reads it; subsections are not searched.
    allowed: keys that the section may have.
    Raises FileError for an unknown key, and for content that is no section.
    """
    if not isinstance(content, dict):
        raise section_error(path, "", name, f"{name} = {content!r:.40}: must be a section [{name}]")
    known = list(allowed)
    for key in content:
        if key not in known:
            words = f"{', '.join(known)}{suggestion(key, known)}"
            raise section_error(path, name, key, f"unknown key {key!r}: must be one of {words}")


@contextmanager
def as_section_error(path: Any, name: str, key: str = "") -> Iterator[None]:
    """Raise a ParameterError of the body of the ``with`` as FileError of a section, with its line;
    a context manager.

    Other exceptions pass unchanged.

    path: path of the file, which is read again for the line.
    name: name of the section.
    key: key that is at fault; "": the name of the parameter in the error is taken for the key.
    Yields None.
    """
    try:
        yield
    except ParameterError as error:
        raise section_error(path, name, key or error.name, str(error)) from error


def section_error(path: Any, name: str, key: str, problem: str) -> FileError:
    """Return the FileError, not raised, of a key of a section, with the number of its line if that
    is found.

    path: path of the file, which is read again for the line.
    name: name of the section, "" for the top level.
    key: key in the section, "" for the section itself; the message states it only as far as
    ``problem`` does.
    problem: what is wrong, in words, which end the message.
    The message is "PATH: line N: [NAME] PROBLEM", without the line if neither key nor section is
    found or the file cannot be read, and without [NAME] at the top level.
    """
    if name:
        problem = f"[{name}] {problem}"
    with suppress(OSError, UnicodeDecodeError):
        if line := find_line(Path(path).read_text(encoding="utf-8-sig"), name, key):
            problem = f"line {line}: {problem}"
    return FileError(path, problem)


def find_line(text: str, name: str, key: str) -> int | None:
    """Return the number of the line that sets a key, for an error.

    text: content of the file, TOML.
    name: name of the section, as "material.prony", "" for the top level; of the second of several
    [[data]] "data 2".
    key: key in the section, "" for the section itself.
    Returns the number, from 1, of the first line that sets the key or is the header of that
    subsection; if there is none, that of the header of the section; if there is none and the name
    has a point, as for an inline table ``prony = { ... }`` in [material], what is found for "prony"
    as a key of "material"; else None.
    """
    full = f"{name}.{key}" if name else key
    plain = rf"\s*[\"']?{re.escape(key)}[\"']?\s*[=.]"
    dotted = rf"\s*{re.escape(full)}\s*[=.]"
    header = ""
    header_line = None
    tables = []
    for number, line in enumerate(text.splitlines(), 1):
        if found := re.match(r"\s*\[+\s*([^\]]*?)\s*\]", line):
            header = found[1]
            if line.lstrip().startswith("[["):
                tables.append(header)
                # as errors name them: the first [[data]] has no number
                header += f" {tables.count(header)}" * (tables.count(header) > 1)
            if header == full:
                return number
            if header == name:
                header_line = number
        elif (header == name and re.match(plain, line)) or (not header and re.match(dotted, line)):
            return number
    if header_line is None and "." in name:  # an inline table stands on the line of its name
        return find_line(text, *name.rsplit(".", 1))
    return header_line
