"""Columns of frequency, storage and loss modulus from a text file: :func:`read_dma`."""

from __future__ import annotations

import math
import re
import warnings
from os import PathLike
from pathlib import Path

import numpy as np

from ...core.errors import FileError, ModelWarning, ParameterError
from ...core.typed import Floats

_FREQUENCY = {"hz": 2.0 * math.pi, "khz": 2e3 * math.pi, "rad/s": 1.0, "1/s": 1.0, "s^-1": 1.0}
_MODULUS = {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9}
#: names of the three columns, in lower case without blanks and underscores, with what may follow them
_NAMES = (
    r"(f|freq\w*|omega|ω|w)$|(frequency|angularfrequency)",
    r"[eg](stor|sto|')?$|.*storage",
    r"[eg](loss|''|\"|’’)$|.*loss",
)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$")


def read_dma(path: str | PathLike[str], *, units: tuple[str, str] | None = None) -> tuple[Floats, Floats, Floats]:
    """Read a master curve: columns of frequency, storage modulus, loss modulus.

    Columns are parted by blanks, tabs, commas or semicolons.  Lines before the numbers are headings, as are those
    that begin with ``#``: they may name the columns (``f``, ``omega``, ``E_stor``, ``E'``, ``G''``, ``loss modulus``
    ...; by default the first three in this order) and give units, behind a name or in a row of their own (Hz or
    rad/s; Pa, kPa, MPa or GPa).  The CSV of pyvisco is such a file.

    Parameters
    ----------
    path : a text file in UTF-8.
    units : of frequency and of moduli, as ("Hz", "MPa"), of columns that the file gives none for.  Without, ``f`` is
        taken as Hz, other frequencies as rad/s, and moduli as Pa, with a warning.

    Returns
    -------
    omega, storage, loss
        rad/s, Pa, Pa; in the order of the file.

    Raises
    ------
    FileError
        If the file cannot be read, a row has no numbers where it must, columns are missing, or a unit is unknown.
    ParameterError
        ``units`` that are no two of these.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what a column is in.
    """
    kinds = _FREQUENCY, _MODULUS, _MODULUS
    if units is not None and not (
        isinstance(units, tuple) and len(units) == 2 and all(str(u).lower() in k for u, k in zip(units, kinds))
    ):
        allowed = f"(frequency, moduli), of {', '.join(_FREQUENCY)} and of {', '.join(_MODULUS)}"
        raise ParameterError("units", f"{units!r:.60}", allowed)
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(path, f"cannot be read ({error})") from error
    headings, rows = _parted(path, lines)
    columns, below = _columns(path, headings, len(rows[0]))
    values = np.array([[row[n] for n in columns] for row in rows]).T
    names = [" ".join(line[n] for line in headings if n < len(line)) for n in columns]
    names = [name + "".join(f" [{line[n]}]" for line in below) for name, n in zip(names, columns, strict=True)]
    written = [_unit(path, name, kind) for name, kind in zip(names, kinds, strict=True)]
    if units is None:
        units = "Hz" if re.match(r"f(req|$|\W)", names[0].lower()) else "rad/s", "Pa"
        if None in written:
            text = f"{path}: columns without a unit are taken in {units[0]} (frequency) and {units[1]} (moduli)"
            warnings.warn(f"{text}: write units into the file, or give units=", ModelWarning, stacklevel=2)
    wanted = zip(written, kinds, (units[0], units[1], units[1]), strict=True)
    omega, storage, loss = values * np.array([[kind[unit or other.lower()]] for unit, kind, other in wanted])
    return omega, storage, loss


def _parted(path: str | PathLike[str], lines: list[str]) -> tuple[list[list[str]], list[list[float]]]:
    """Cells of the headings, and the rows of numbers."""
    headings: list[list[str]] = []
    rows: list[list[float]] = []
    for number, line in enumerate(lines, 1):
        text = line.strip()
        cells = _cells(text.lstrip("#").strip())
        if not cells or (text.startswith("#") and rows):
            continue
        if not text.startswith("#") and all(_NUMBER.match(cell) for cell in cells):
            rows.append([float(cell) for cell in cells])
            if len(cells) != len(rows[0]):
                raise FileError(path, f"line {number} has {len(cells)} columns, those before it {len(rows[0])}")
        elif rows:
            raise FileError(path, f"line {number} is no row of numbers: {text[:60]!r}")
        else:
            headings.append(cells)
    if not rows:
        raise FileError(path, "has no row of numbers")
    return headings, rows


def _cells(text: str) -> list[str]:
    if re.search(r"[,;]", text):
        return [cell.strip() for cell in re.split(r"[,;]", text)]
    # a unit in brackets belongs to the name before it, and so does the word behind storage, loss or angular
    text = re.sub(r"\s+(?=[\[(])", "", text)
    text = re.sub(r"(?i)\b(storage|loss|angular)\s+(?=(modulus|frequency))", r"\1", text)
    return text.split()


def _columns(path: str | PathLike[str], headings: list[list[str]], width: int) -> tuple[list[int], list[list[str]]]:
    """Which columns are frequency, storage and loss modulus, and the rows below their names, which give units."""
    if width < len(_NAMES):
        raise FileError(path, f"has {width} columns: must be frequency, storage and loss modulus")
    for row, line in enumerate(headings):
        bare = [re.sub(r"[\s_*]|[\[(].*", "", cell.lower()) for cell in line[:width]]
        found = [[n for n, cell in enumerate(bare) if re.match(pattern, cell)] for pattern in _NAMES]
        if all(len(hits) == 1 for hits in found) and len({hits[0] for hits in found}) == len(_NAMES):
            below = headings.pop(row + 1) if len(headings) > row + 1 and len(headings[row + 1]) == width else None
            return [hits[0] for hits in found], [] if below is None else [[c.strip("[()] ") for c in below]]
    if width > len(_NAMES):
        raise FileError(path, f"has {width} columns, and no heading that names frequency, storage and loss modulus")
    return [0, 1, 2], []


def _unit(path: str | PathLike[str], name: str, units: dict[str, float]) -> str | None:
    """The unit that a heading gives, None if it gives none."""
    words = re.findall(r"[A-Za-zµ]*(?:rad/s|1/s|s\^-1|hz|pa)\b", name, re.IGNORECASE)
    bracketed = re.findall(r"[\[(]([^\])]+)[\])]", name)
    found = {word.strip().lower() for word in [*words, *bracketed]}
    if len(found) > 1 or not found <= units.keys():
        raise FileError(path, f"unit {', '.join(sorted(found))!r} of a column: must be one of {', '.join(units)}")
    return found.pop() if found else None
