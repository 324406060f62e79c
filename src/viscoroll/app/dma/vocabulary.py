"""Names of the columns of tests of materials in five languages, and their quantities, read from headings.toml."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from importlib.resources import files
from typing import Any, NamedTuple

from ...io.measurements import readings

#: columns beside moduli without E or G that only a test in shear has
OF_SHEAR = re.compile(
    r"(?i)shear|schub|scher|cisaill|taglio|せん断|torque|torsion|drehmoment|viscosity|viskosit|gamma|γ"
)


def _plain(text: str) -> str:
    """Return a text without accents and in compatible characters, as words of headings are compared."""
    text = unicodedata.normalize("NFKD", text.replace("\u2033", "''"))
    return "".join(sign for sign in text if not unicodedata.combining(sign))


_DATA: dict[str, Any] = tomllib.loads((files(__package__) / "headings.toml").read_text(encoding="utf-8"))
#: quantity -> the unit that its numbers are converted to
UNITS = {name: about["unit"] for name, about in _DATA["quantities"].items()}
#: quantity -> the unit that is assumed, "" where none can be
ASSUMED = {name: about["assumed"] for name, about in _DATA["quantities"].items()}
#: test -> quantities of the columns of a file without headings, in their order
BARE = _DATA["bare"]
#: test -> its quantities
QUANTITIES = {
    test: [name for name, about in _DATA["quantities"].items() if test in about["of"].split()] for test in BARE
}
#: kinds of the words of a name -> quantity
_NAMED_BY = {frozenset(kinds.split()): name for name, about in _DATA["quantities"].items() for kinds in about["named"]}
#: word of a name -> the kinds of word that it is; "-": a word that does not tell columns apart
_KINDS = {
    _plain(word): kinds
    for language in _DATA["words"].values() for kinds, words in language.items() for word in words.split()
}  # fmt: skip
_LONG = sorted((word for word in _KINDS if len(word) > 2 or not word.isascii()), key=len, reverse=True)
#: words written together, as "storagemodulus", "Estor", "Phasenwinkel"
_COMPOUND = re.compile(rf"([eg](?=sto|loss))?((?:{'|'.join(_LONG)})+)")
_WORD = re.compile("|".join(_LONG))


class Meaning(NamedTuple):
    """A quantity that a heading may name.

    name : name of the quantity, a key of :data:`UNITS`.
    mode : mode of the modulus, "tension", "shear", or "" where the heading does not say.
    unit : unit in the heading or in the row of units, "" without.
    log : base of the logarithms of which the column is, 0 of numbers.
    sure : whether the unit stands in brackets, behind a slash or in the row of units, where nothing else stands.
    """

    name: str
    mode: str
    unit: str
    log: float
    sure: bool


def meanings(heading: str, row: str = "") -> list[Meaning]:
    """Return all quantities that a heading may name, the likeliest first.

    heading : text of the heading, with its unit or without, as "E' [MPa]" or "Speichermodul".
    row : the cell of a row of units for this column, "" without.
    Returns a list of :class:`Meaning`, one for each way to part the heading into name and unit whose name is
    understood, in the order of :func:`.readings`: the name without a unit first; an empty list where no name is.
    """
    found = [(_quantity(each.name), each) for each in readings(heading, row)]
    return [Meaning(*quantity, each.unit, each.log, each.sure) for quantity, each in found if quantity]


def _quantity(name: str) -> tuple[str, str] | None:
    """Return quantity and mode of a column by its name without unit.

    name : words of the heading, in any case, with signs such as ' or the Greek letters; of single letters T is a
        temperature, and t a time, which is no quantity here.
    Returns (quantity, mode): a key of :data:`UNITS`; and "tension", "shear", or "" where the name does not say it or
    the quantity is no modulus, compliance or stress.
    None if a word is not in the vocabulary, the words together name no quantity, both modes are named, or the text has
    a sign of a unit, % or °.
    """
    if re.search("[%°º]", name):  # of a unit
        return None
    text = _plain(name)
    for pattern, words in _DATA["signs"]["replaced"]:
        text = re.sub(pattern, words, text)
    parts = [part for word in re.findall(r"[^\W\d_]+|\d+", text) for part in _parts(word.lower())]
    if not all(part in _KINDS for part in parts):
        return None
    kinds = {kind for part in parts for kind in _KINDS[part].split()}
    modes = kinds & {"tension", "shear"}
    named = frozenset(kinds - modes - {"-"})
    quantity = _NAMED_BY.get(named) or _NAMED_BY.get(named - {"modulus"})
    if quantity is None or len(modes) > 1:
        return None
    return quantity, " ".join(modes) if "Pa" in UNITS[quantity] else ""


def _parts(word: str) -> list[str]:
    """Split a word that is composed of words of the vocabulary, as "storagemodulus" into "storage" and "modulus".

    A letter e or g before "storage" or "loss" is split off too, as in "estorage".

    word : letters, in lower case, or digits.
    Returns the words that it is composed of; [word] if it is in the vocabulary itself or is not composed of such words.
    """
    if word in _KINDS or not (found := _COMPOUND.fullmatch(word)):
        return [word]
    return [*filter(None, [found[1]]), *_WORD.findall(found[2])]
