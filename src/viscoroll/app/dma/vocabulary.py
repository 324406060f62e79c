"""Names of the columns of a dynamic mechanical analysis, in English, German and French -> their meaning."""

from __future__ import annotations

import re
import unicodedata
from typing import NamedTuple

from ...io.measurements import readings

#: what words of a name say; "-": nothing that tells columns apart
_VOCABULARY = {
    word: kind
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
    for kind, words in [line.strip().split(": ")]
    for word in words.split()
}
#: meaning -> what the words of its names say together
_MEANINGS = {
    frozenset(kinds.split()): meaning
    for line in """
        frequency: frequency
        angular frequency: angle frequency
        reduced frequency: reduced frequency
        reduced angular frequency: reduced angle frequency
        storage: storage; storage whole
        loss: loss; loss whole
        modulus: whole
        tan delta: tan; tan delta; loss factor; loss tan; damping; damping factor; loss factor tan; loss factor delta
        tan delta: loss factor tan delta; damping factor tan delta; damping tan delta; damping tan; loss tan delta
        phase angle: delta; phase; phase angle; phase delta; phase angle delta; loss angle; phase shift
        phase angle: loss angle delta; phase shift delta
        storage compliance: compliance storage; compliance storage whole
        loss compliance: compliance loss; compliance loss whole
        modulus compliance: compliance whole
        temperature: temperature
        """.strip().splitlines()
    for meaning, names in [line.strip().split(": ")]
    for kinds in names.split("; ")
}
#: meaning -> the unit that its numbers are read in
UNITS = {
    **dict.fromkeys(("frequency", "angular frequency", "reduced frequency", "reduced angular frequency"), "rad/s"),
    **dict.fromkeys(("storage", "loss", "modulus"), "Pa"),
    **dict.fromkeys(("storage compliance", "loss compliance", "modulus compliance"), "1/Pa"),
    "tan delta": "1",
    "phase angle": "rad",
    "temperature": "degC",
}
#: columns beside moduli without E or G that only a test in shear has
OF_SHEAR = re.compile(r"(?i)shear|schub|scher|torque|torsion|drehmoment|viscosity|viskosit|gamma|γ")
_LONG = sorted((word for word in _VOCABULARY if len(word) > 2), key=len, reverse=True)
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
    """What a heading says: the meaning, "" of none; "tension", "shear" or "" of the modulus; unit; of logarithms."""

    name: str
    mode: str
    unit: str
    log: bool


def meanings(heading: str, row: str = "") -> list[Meaning]:
    """All meanings that a heading may have, the likeliest first; none where no word is known.

    Parameters
    ----------
    heading : as the file has it, with its unit or without.
    row : what a row of units has for it.
    """
    found = [(_meaning(name), unit, log) for name, unit, log in readings(heading, row)]
    return [Meaning(*meaning, unit, log) for meaning, unit, log in found if meaning is not None]


def _meaning(name: str) -> tuple[str, str] | None:
    """Meaning and mode of a name without unit, None where one of its words is unknown or they go with nothing."""
    kinds: set[str] = set()
    if re.search("[%°º]", name):  # of a unit
        return None
    text = unicodedata.normalize("NFKD", name.replace("\u2033", "''"))
    for pattern, words in _SIGNS:
        text = pattern.sub(words, "".join(sign for sign in text if not unicodedata.combining(sign)))
    for word in re.findall(r"[^\W\d_]+|\d+", text):
        parts = _parts(word.lower())
        if not all(part in _VOCABULARY for part in parts):
            return None
        kinds.update(kind for part in parts for kind in _VOCABULARY[part].split())
    modes = kinds & {"tension", "shear"}
    meaning = _MEANINGS.get(frozenset(kinds - modes - {"-"}))
    return (meaning, " ".join(modes)) if meaning and len(modes) < 2 else None


def _parts(word: str) -> list[str]:
    """A word of the vocabulary, or the words that it is made of."""
    if word in _VOCABULARY or not (found := _COMPOUND.fullmatch(word)):
        return [word]
    return [found[1] or "-", *_WORD.findall(found[2])] if found[1] else _WORD.findall(found[2])
