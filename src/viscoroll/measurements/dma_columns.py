"""Columns of tests of materials: which columns of a table are frequency, moduli and temperature,
and their numbers; and a column by the name that the user gives, in a unit (:func:`column_in_unit`).

Names of columns in seven languages, and the quantities that they mean, are read from headings.toml.
"""

import math
import re
import unicodedata
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..core import CYCLES, TURNS, Floats, ParameterError, suggestion, warn_of_model
from ..materials import ABSOLUTE_ZERO
from .text_cells import DATA, MULTIPLIED, NO_UNIT, Numbers, Reading, conversion, readings
from .text_table import Table, find_column, missing_column

# --- Names of the columns of tests of materials in seven languages ---

#: columns beside moduli without E or G that only a test in shear has
OF_SHEAR = re.compile(
    r"(?i)shear|schub|scher|cisaill|taglio|せん断|torque|torsion|drehmoment|viscosity|viskosit|gamma|γ"
)


def _plain(text: str) -> str:
    """Return a text without accents and in compatible characters, as words of headings are
    compared.
    """
    text = unicodedata.normalize("NFKD", text.replace("\u2033", "''"))
    return "".join(sign for sign in text if not unicodedata.combining(sign))


#: quantity -> what headings.toml says of it
_QUANTITIES = DATA["quantities"]
#: quantity -> its heading, or a unit
ByQuantity = Mapping[str, str]
#: quantity -> the unit that its numbers are converted to
UNITS = {name: about["unit"] for name, about in _QUANTITIES.items()}
#: test -> quantities of the columns of a file without headings, in their order
BARE = DATA["bare"]
#: test -> its quantities
QUANTITIES = {
    test: [name for name, about in _QUANTITIES.items() if test in about["of"]] for test in BARE
}
#: kinds of the words of a name -> quantity
_NAMED_BY = {
    frozenset(kinds.split()): name
    for name, about in _QUANTITIES.items()
    for kinds in about["named"]
}
#: word of a name -> the kinds of word that it is; "-": a word that does not tell columns apart
_KINDS = {
    _plain(word): kinds
    for language in DATA["words"].values()
    for kinds, words in language.items()
    for word in words.split()
}
_LONG = sorted(
    (word for word in _KINDS if len(word) > 2 or not word.isascii()), key=len, reverse=True
)
#: words written together, as "storagemodulus", "Estor", "Phasenwinkel"
_COMPOUND = re.compile(rf"(?:[eg](?=sto|loss))?(?:{'|'.join(_LONG)})+")
#: a word of these, or the letter before them
_WORD = re.compile("|".join(["^[eg](?=sto|loss)", *_LONG]))


def unit_advice(name: str) -> str:
    """Return the advice to state the unit of a quantity: the argument of the readers and, of
    quantities of a DMA, the option of the command.
    """
    unit = "%" if UNITS[name] == "1" else UNITS[name]
    advice = f"give the unit of the column, as units={{{name!r}: {unit!r}}}"
    return advice + f" (in a shell: --units '{name}={unit}')" * (name in QUANTITIES["dma"])


def meanings(heading: str, row: str = "") -> list[Reading]:
    """Return all quantities that a heading may name, the likeliest first.

    heading : text of the heading, with its unit or without, as "E' [MPa]" or "Speichermodul".
    row : the cell of a row of units for this column, "" without.
    Returns a list of :class:`Reading`, one for each way to part the heading into name and unit
    whose name is understood, with that of the quantity and its mode, in the order of
    :func:`.readings`: the name without a unit first; an empty list where no name is understood.
    """
    return [*filter(None, map(_meaning, readings(heading, row)))]


def _meaning(reading: Reading) -> Reading | None:
    """Return a reading of a heading with the quantity and the mode that its name means.

    reading : way to read the heading, whose name is words in any case, with signs such as ' or the
        Greek letters; of single letters T is a temperature, and t a time.
    Returns it with the name of the quantity, a key of :data:`UNITS`, and the mode, "tension",
    "shear", or "" where the name does not say it or the quantity is no modulus, compliance or
    stress.
    None if a word is not in the vocabulary, the words together name no quantity, both modes are
    named, or the name has a sign of a unit, %, ‰ or °.
    """
    text = _plain(reading.name)
    for pattern, words in DATA["signs"]["replaced"]:
        text = re.sub(pattern, words, text)
    parts = [part for word in re.findall(r"[^\W\d_]+|\d+", text) for part in _parts(word.lower())]
    # an unknown word is of a kind of its own, with which no quantity is named
    kinds = {kind for part in parts for kind in _KINDS.get(part, "unknown").split()}
    modes = kinds & {"tension", "shear"}
    named = frozenset(kinds - modes - {"-"})
    # of "storage modulus" and "mean storage" one word alone tells what it is
    quantity = _NAMED_BY.get(named) or _NAMED_BY.get(named - {"modulus", "mean"})
    # % and such are of a unit
    if quantity is None or len(modes) > 1 or re.search("[%‰°º]", reading.name):
        return None
    return reading._replace(name=quantity, mode=" ".join(modes) if "Pa" in UNITS[quantity] else "")


def _parts(word: str) -> list[str]:
    """Split a word that is composed of words of the vocabulary, as "storagemodulus" into "storage"
    and "modulus".

    A letter e or g before "storage" or "loss" is split off too, as in "estorage".

    word : letters, in lower case, or digits.
    Returns the words that it is composed of; [word] if it is in the vocabulary itself or is not
    composed of such words.
    """
    if word in _KINDS or not _COMPOUND.fullmatch(word):
        return [word]
    return _WORD.findall(word)


# --- Which columns of a table are frequency, moduli and temperature ---

#: degrees; temperatures without a unit that go above it are taken to be kelvins, in which DMA
#: seldom goes below
KELVIN = 200.0
#: a heading that begins with G and at most three further letters or digits
_OF_G = re.compile(r"\W*[Gg][^\W_]{0,3}(?![^\W_])")
#: units of what instruments measure beside moduli, which end a heading without brackets
_RAW = re.compile(r"[kmcdMµ]?N(?:\W?[cm]?m|/[cm]?m)?|kgf?|lbf?|[mµ]m|m?V")


class Column(NamedTuple):
    """A column of a known quantity.

    position, heading : index from 0 and heading in its table.
    name : name of its quantity, a key of :data:`UNITS`.
    quantity : what its numbers are converted to, as "storage" or "frequency"
        (:func:`_quantity_of_column`).
    mode : mode of its modulus, "tension", "shear", or "" where the heading does not say.
    log : base of the logarithms that its numbers are, 0 of others.
    unit : unit in which its numbers are written, of the file, the user, or assumed; "" where none
    can be assumed.
    stated : whether the file or the user gives the unit; False: it is assumed.
    """

    position: int
    heading: str
    name: str
    quantity: str
    mode: str
    log: float
    unit: str
    stated: bool


def columns_of(
    table: Table, test: str, named: ByQuantity, overruling: ByQuantity, defaults: ByQuantity
) -> tuple[list[Column], dict[str, str]]:
    """Find the columns of a table whose quantity is known: the user named it, or the heading says
    it and its unit fits.

    table : :class:`Table`, table with headings.
    test : "dma" or "relaxation", whose quantities are looked for.
    named : quantity -> heading, of columns that the user named; keys of :data:`UNITS`,
    here and below.
    overruling : quantity -> unit in place of that of the file.
    defaults : quantity -> unit where the file gives none.
    Returns (a list of :class:`Column`, the columns of known quantities, in the order of the table;
    a dict, heading of each other column, or "column INDEX" without one -> why it is left out: "no
    numbers", a unit that does not fit, or "" where no quantity is known of it).  Headings of what
    the user named by another column are left out.
    Raises ParameterError for a heading that the table does not have, FileError for one that several
    columns have, and for a column that the user named and whose unit is not understood.
    """
    owners = {}
    for name, heading in named.items():
        if (position := find_column(table, heading)) is None:
            raise ParameterError(
                f"columns[{name!r}]",
                f"{heading!r:.60}",
                f"a heading of the file, one of {', '.join(map(repr, table.headings))}"
                f"{suggestion(str(heading), table.headings)}",
            )
        owners[position] = name
    taken = {_quantity_of_column(name) for name in named}
    columns = []
    others = {}
    for index, (heading, row) in enumerate(zip(table.headings, table.units)):
        if index in owners:
            found = _named(owners[index], heading, row, overruling)
        else:
            found = [
                each
                for each in meanings(heading, row)
                if each.name in QUANTITIES[test] and _quantity_of_column(each.name) not in taken
            ]
        faults = [_contradiction(each, overruling) for each in found]
        if not table.has_numbers(index):
            faults = ["it has no numbers"]
        if "" in faults:
            name, unit, log, _, mode = found[faults.index("")]
            if unit in NO_UNIT:
                # of a ratio, where per cent are as usual
                unit = "1" if name == "strain" and any(each.unit for each in found) else ""
            unit = overruling.get(name) or unit or defaults.get(name, "")
            columns.append(
                Column(
                    position=index,
                    heading=heading,
                    name=name,
                    quantity=_quantity_of_column(name),
                    mode=mode,
                    log=log,
                    unit=unit or _QUANTITIES[name]["assumed"],
                    stated=bool(unit),
                )
            )
        elif index in owners:
            raise table.error(
                f"column {heading!r} is to be read as {owners[index]!r}, but {faults[0]}; if "
                "another column is meant, name it by columns= (in a shell: --column)"
            )
        else:
            others[heading or f"column {index}"] = faults[0] if faults else ""
    return columns, others


def _named(name: str, heading: str, row: str, overruling: ByQuantity) -> list[Reading]:
    """Return the ways to read a heading of a column whose quantity the user named, those with a
    unit first.

    name : the quantity.
    heading, row : text of the heading, and the cell of a row of units.
    overruling : quantity -> unit in place of that of the file.
    Returns a list of :class:`Reading`.  A modulus is of shear where the heading begins with G and
    at most three further letters or digits, as "Gp"; a heading that says "angular" is of an angular
    frequency.  A heading that states a unit cannot be read without one, and one with a power of ten
    has no known unit, if ``overruling`` has none.
    """
    known = meanings(heading, row)
    mode = next((each.mode for each in known if each.mode), "shear" if _OF_G.match(heading) else "")
    if any("angular " + name == each.name for each in known):
        name = "angular " + name
    mode = mode if "Pa" in UNITS[name] else ""
    ways = [each._replace(name=name, mode=mode) for each in readings(heading or "column", row)]
    ways.sort(key=lambda each: each.unit in NO_UNIT)
    if name not in overruling and MULTIPLIED.search(heading):
        return [ways[0]._replace(unit=heading)]
    # units behind the name, as bpm of "freq_bpm", not "prime" of "G_prime"
    behind = {each.unit for each in known if each.name == name}
    with_unit = [each for each in ways if each.unit not in NO_UNIT]
    if any(
        each.sure
        or (each.unit in behind and behind.isdisjoint(NO_UNIT))
        or _RAW.fullmatch(each.unit)
        for each in with_unit
    ):
        return with_unit
    return ways


def _quantity_of_column(name: str) -> str:
    """Return what the numbers of a quantity are converted to, by its ``name``.

    An angular frequency counts as a frequency, a compliance as the modulus of the same name, a
    phase angle as tan delta; "reduced" stays in the name.
    """
    name = name.replace("angular ", "").removesuffix(" compliance")
    return "tan delta" if name == "phase angle" else name


def _contradiction(meaning: Reading, overruling: ByQuantity) -> str:
    """Return why the unit of a heading contradicts the quantity that the heading may name, and what
    helps.

    meaning : :class:`Reading`, the quantity that the heading may name, with the unit that stands in
    the heading.
    overruling : quantity -> unit that the user gives in place of that of the file; these are not
    checked.
    Returns a text for the user: the unit is unknown or of another dimension, is Hz of an angular
    frequency, or is an angle of tan delta or none of a phase angle.  "" where the unit fits, is
    missing, or is replaced by the user.
    """
    name, unit, *_ = meaning
    if name in overruling or unit in NO_UNIT:
        return ""
    try:
        conversion(unit, UNITS[name])
    except ParameterError:
        return f"its unit {unit!r} is not a unit of {name}: {unit_advice(name)}"
    if "angular" in name and unit.lower().endswith(("hz", "cps")):
        return (
            f"an angular frequency cannot be in {unit}: if the numbers are in {unit}, write "
            f"{name.replace('angular ', '')!r} in the heading (and in columns=, if the column is "
            f"named there); if they are in rad/s, {unit_advice(name)}"
        )
    return ""


@np.errstate(all="ignore")  # a number beyond the doubles is infinite, which is refused
def numbers_of(table: Table, column: Column) -> Numbers:
    """Return the numbers of a column, converted to the unit of its quantity.

    Logarithms become numbers, frequencies in cycles angular ones, and phase angles their tangents.

    table : :class:`Table`, the table that has the column.
    column : :class:`Column`, a column whose quantity is known.
    Returns :class:`Numbers` in rad/s, Pa, 1/Pa, degrees Celsius, or dimensionless for tan delta:
    the values, (n,), and half a unit of the last digit that the file states of each, converted in
    the same way, (n,).
    Raises FileError for cells that are no numbers, and for a unit that is missing and cannot be
    assumed: of compliances, of temperatures above 200, and of phase angles that may be in radians;
    for a phase angle of 90 degrees and more, and a temperature at or below absolute zero.  Other
    values are not checked: they may be infinite.
    """
    name = column.name
    unit = column.unit
    values, half = table.numbers(column.position)
    most = values.max()
    # a phase angle of rubber in degrees goes above pi/2
    in_doubt = {"phase angle": most <= 0.5 * math.pi, "temperature": most > KELVIN}
    if not column.stated and (not unit or in_doubt.get(name)):
        raise table.error(
            f"column {column.heading!r} has no unit, and its largest value {most:g} does not "
            f"show which unit is meant: {unit_advice(name)}"
        )
    if column.log:
        values = column.log**values
        # the derivative of log^x is log^x ln(log): half a digit of x, carried to first order
        half = values * math.log(column.log) * half
    factor, offset = conversion(unit, UNITS[name])
    if column.quantity.endswith("frequency") and "angular" not in name and not CYCLES.search(unit):
        factor *= 2.0 * math.pi  # 1/s of a frequency are cycles, which pint takes for radians
    values = factor * values + offset
    half = factor * half
    if name == "temperature":
        table.require(
            (values > ABSOLUTE_ZERO) & (values < math.inf),
            f"the temperature, read in {unit}, must be above {ABSOLUTE_ZERO} °C: correct or remove "
            "this line, or correct the unit",
        )
    if name == "phase angle":
        table.require(
            values < 0.5 * math.pi,
            f"the phase angle, read in {unit}, must be below 90 degrees: correct or remove this "
            "line, or correct the unit",
        )
        # the derivative of the tangent is 1/cos^2
        return Numbers(np.tan(values), half / np.cos(values) ** 2)
    return Numbers(values, half)


# --- A column of a table by the name that the user gives ---


def column_in_unit(table: Table, name: str, wanted: str, unit: str = "") -> Floats:
    """Return the numbers of the column with a name, converted to a unit.

    Parameters
    ----------
    table : :class:`Table`, a table with headings.
    name : name of the column, with its unit or without.
    wanted : unit of the result in pint's spelling, "1" of a ratio.
    unit : unit of the numbers in the file, in place of the one that the file gives; "": that of the
        heading or of the row of units.  Where none is given, or it is a sign as "-" or "1", the
        numbers are taken to be in ``wanted``, with a warning unless that is "1".

    Returns
    -------
    array of shape (n,)
        The numbers, in the unit ``wanted``, float64; of a heading of logarithms the numbers of
        which they are.

    Raises
    ------
    FileError
        No such column, several columns of that name, several tables in the file, cells that are no
        numbers, gaps, or marks that may be separators of thousands (:meth:`Table.numbers`).
    ParameterError
        A unit that is unknown or of another dimension.

    Warns
    -----
    ModelWarning
        A column without a unit, whose numbers are taken to be in ``wanted``.
    """
    index = find_column(table, name)
    if index is None:
        raise missing_column(table, name)
    table.refuse_several()
    heading = table.headings[index]
    if not unit and MULTIPLIED.search(heading):
        unit = heading  # in which nothing is converted
    found = readings(heading, table.units[index])
    # a heading can be read in several ways: the unit is that of the way that gives this name, else
    # of the likeliest way that has one; ``log`` is the same for all ways
    ranked = sorted(found, key=lambda each: each.name != name)
    unit = unit or next((each.unit for each in ranked if each.unit not in NO_UNIT), "")
    factor, offset = conversion_of_column(
        table.path,
        heading,
        unit,
        wanted,
        f"write its unit in the heading, as in '{name} [{wanted}]'",
    )
    values = table.numbers(index).values
    base = found[0].log if found else 0.0
    return factor * (base**values if base else values) + offset


def conversion_of_column(
    path: Any, column: str, unit: str, wanted: str, advice: str
) -> tuple[float, float]:
    """Return factor and offset of the conversion of a column; numbers without a unit are taken to
    be in the wanted one, with a :class:`ModelWarning`.

    path: path of the file.
    column: name of the column.
    unit: its unit, a text of :data:`NO_UNIT` where it has none.
    wanted: unit in which it is taken; "1" gives no warning.
    advice: how the file states the unit.
    Returns (factor, offset) of number in ``wanted`` = factor * number + offset.
    Raises ParameterError for a unit that is unknown or of another dimension, and for what may be of
    turns or of radians: an angular velocity in 1/min or such, and a column whose name says turns
    and whose unit says neither.
    """
    found = (1.0, 0.0) if unit in NO_UNIT else conversion(unit, wanted)
    turns = wanted == "rad s-1" and not CYCLES.search(unit)
    if turns and any(each.name == "rotational speed" for each in meanings(column)):
        given = "(not stated)" if unit in NO_UNIT else unit
        raise ParameterError(
            "unit", given + TURNS, f"one of these units, stated for the column {column!r}"
        )
    if unit in NO_UNIT and wanted != "1":
        warn_of_model(f"{path}: column {column!r} has no unit; {wanted} is assumed: {advice}")
    return found
