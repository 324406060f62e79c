"""Names of the columns of a dynamic mechanical analysis in English, German and French, and their quantities."""

from __future__ import annotations

import re
import unicodedata
from typing import NamedTuple

from ...io.measurements import readings

#: word of a name -> the kinds of word that it is; "-": a word that does not tell columns apart
_KINDS = {
    word: kinds
    for line in """
        frequency: f freq fq frequency frequenz frequence
        angle: angle angular ang circular radian winkel kreis lag
        angle frequency: w omega
        reduced: reduced red shifted reduziert reduzierte verschoben master at
        storage: storage stor sto speicher elastic elastischer elastique conservation real re single
        loss: loss verlust viscous viskoser visqueux perte imaginary imag im double
        whole: complex komplexer komplex complexe absolute abs betrag magnitude star
        tan: tan tangent tangens tg
        delta: delta d
        factor: factor faktor facteur
        damping: damping dampfung dampfungs amortissement dissipation
        phase: phase phasen
        shift: shift
        compliance: compliance nachgiebigkeit
        compliance shear: j
        temperature: temperature temperatur temp T
        tension: e young youngs tensile tension extension extensional zug axial
        shear: g shear schub scher torsion torsional
        -: modulus modul module moduli modulen mod dynamic dynamischer part component teil of the de
        -: oscillation oscillatory test mess messung pruf measured actual sample probe proben average avg mean
        -: mechanical mechanischer
        """.strip().splitlines()
    for kinds, words in [line.strip().split(": ")]
    for word in words.split()
}
#: a line for each quantity: its name, the unit that its numbers are converted to, the unit that is assumed where
#: neither the file nor the user gives one, and the sets of kinds of words that name it
_QUANTITIES = [
    [cell.strip() for cell in line.split("|")]
    for line in """
        frequency                 | rad/s | Hz    | frequency
        angular frequency         | rad/s | rad/s | angle frequency
        reduced frequency         | rad/s | Hz    | reduced frequency
        reduced angular frequency | rad/s | rad/s | reduced angle frequency
        storage                   | Pa    | Pa    | storage; storage whole
        loss                      | Pa    | Pa    | loss; loss whole
        modulus                   | Pa    | Pa    | whole
        storage compliance        | 1/Pa  |       | compliance storage; compliance storage whole
        loss compliance           | 1/Pa  |       | compliance loss; compliance loss whole
        modulus compliance        | 1/Pa  |       | compliance whole
        tan delta   | 1    | 1    | tan; tan delta; loss factor; loss tan; damping; damping factor; loss factor tan
        tan delta   | 1    | 1    | loss factor delta; loss factor tan delta; damping factor tan delta; loss tan delta
        tan delta   | 1    | 1    | damping tan delta; damping tan
        phase angle | rad  | deg  | delta; phase; phase angle; phase delta; phase angle delta; loss angle; phase shift
        phase angle | rad  | deg  | loss angle delta; phase shift delta
        temperature | degC | degC | temperature
        """.strip().splitlines()
]
#: quantity -> the unit that its numbers are converted to
UNITS = {name: unit for name, unit, *_ in _QUANTITIES}
#: quantity -> the unit that is assumed, "" where none can be
ASSUMED = {name: unit for name, _, unit, _ in _QUANTITIES}
#: kinds of the words of a name -> quantity
_NAMED_BY = {frozenset(kinds.split()): name for name, *_, sets in _QUANTITIES for kinds in sets.split(";")}
#: columns beside moduli without E or G that only a test in shear has
OF_SHEAR = re.compile(r"(?i)shear|schub|scher|torque|torsion|drehmoment|viscosity|viskosit|gamma|γ")
_LONG = sorted((word for word in _KINDS if len(word) > 2), key=len, reverse=True)
#: words written together, as "storagemodulus", "Estor", "Phasenwinkel"
_COMPOUND = re.compile(rf"([eg](?=sto|loss))?((?:{'|'.join(_LONG)})+)")
_WORD = re.compile("|".join(_LONG))
#: sign -> words, in this order
_SIGNS = [(re.compile(pattern), words) for pattern, words in (
    (r"[\u2019\u2018\u02b9\u00b4`\u2032]", "'"), (r"[\u2033\u02ba\u201c\u201d\"]", "''"), (r"[$^{}\\]", ""),
    (r"(?i)double[\s_-]*prime|dprime", "''"), (r"(?i)prime", "'"), (r"(?<=[a-z]{3})'s\b", "s"),
    (r"δ|Δ", " delta "), (r"ω|Ω", " omega "), (r"φ|ϕ|ψ", " phase "),
    (r"\|\s*([EGJegj])\s*\*?\s*\|", r" \1 star "), (r"\b([EGJDegjd])\s?\*", r" \1 star "),
    (r"(?<![A-Za-z])[Dd][\s_]*(?='|\s*star)", " compliance tension "),
    (r"''", " double "), (r"'", " single "), (r"[^\w]|_", " "), (r"\bT\b", " temperature "), (r"\bt\b", " time "),
)]  # fmt: skip


class Meaning(NamedTuple):
    """A quantity that a heading may name.

    name : name of the quantity, a key of :data:`UNITS`.
    mode : mode of the modulus, "tension", "shear", or "" where the heading does not say.
    unit : unit in the heading or in the row of units, "" without.
    log : whether the numbers are logarithms to base 10.
    """

    name: str
    mode: str
    unit: str
    log: bool


def meanings(heading: str, row: str = "") -> list[Meaning]:
    """Return all quantities that a heading may name, the likeliest first.

    heading : text of the heading, with its unit or without, as "E' [MPa]" or "Speichermodul".
    row : the cell of a row of units for this column, "" without.
    Returns a list of :class:`Meaning`, one for each way to part the heading into name and unit whose name is
    understood, in the order of :func:`.readings`: the name without a unit first; an empty list where no name is.
    """
    found = [(_quantity(name), unit, log) for name, unit, log in readings(heading, row)]
    return [Meaning(*quantity, unit, log) for quantity, unit, log in found if quantity]


def _quantity(name: str) -> tuple[str, str] | None:
    """Return quantity and mode of a column by its name without unit.

    name : words of the heading, in any case, with signs such as ' or the Greek letters; of single letters T is a
        temperature, and t a time, which is no quantity here.
    Returns (quantity, mode): a key of :data:`UNITS`; and "tension", "shear", or "" where the name does not say it.
    None if a word is not in the vocabulary, the words together name no quantity, both modes are named, or the text has
    a sign of a unit, % or °.
    """
    if re.search("[%°º]", name):  # of a unit
        return None
    text = unicodedata.normalize("NFKD", name.replace("\u2033", "''"))
    for pattern, words in _SIGNS:
        text = pattern.sub(words, "".join(sign for sign in text if not unicodedata.combining(sign)))
    parts = [part for word in re.findall(r"[^\W\d_]+|\d+", text) for part in _parts(word.lower())]
    if not all(part in _KINDS for part in parts):
        return None
    kinds = {kind for part in parts for kind in _KINDS[part].split()}
    modes = kinds & {"tension", "shear"}
    quantity = _NAMED_BY.get(frozenset(kinds - modes - {"-"}))
    return (quantity, " ".join(modes)) if quantity and len(modes) < 2 else None


def _parts(word: str) -> list[str]:
    """Split a word that is composed of words of the vocabulary, as "storagemodulus" into "storage" and "modulus".

    A letter e or g before "storage" or "loss" is split off too, as in "estorage".

    word : letters, in lower case, or digits.
    Returns the words that it is composed of; [word] if it is in the vocabulary itself or is not composed of such words.
    """
    if word in _KINDS or not (found := _COMPOUND.fullmatch(word)):
        return [word]
    return [*filter(None, [found[1]]), *_WORD.findall(found[2])]
