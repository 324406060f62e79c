"""Laws as datasets and files: of a :class:`LawTable` or a :class:`LawAxis`, and back bit for
bit.
"""

import contextlib
import json
import os
import tomllib
import types
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..core import (
    Dataset,
    FileError,
    Floats,
    ParameterError,
    check_number,
    describe_value,
    described_error,
    is_real,
)
from ..materials import (
    AXIS,
    COUPLED,
    COVER,
    HIGHEST_ALPHA,
    KIND,
    KINDS,
    LAW,
    REMEDY,
    Bodies,
    Content,
    Cover,
    Material,
    Pair,
    Prony,
    lock_array,
    make_dataset,
    material_as_toml,
    parse_materials,
    parse_series,
    read_law,
    series_as_toml,
)
from .law_grid import check_alpha, load_grid
from .law_rows import CoupledRows
from .law_tables import LawAxis, LawTable, coupled_table, law_table, make_table
from .row_layout import STEADY, CoverRows, steady_table

#: attributes of a cover that its file states besides the series; the last one where the other body
#: is a layer
_COVER_ATTRIBUTES = ("nu", "thickness", "on", "part", "other_nu", "other_thickness")


def law_table_of(material: Any, base: Any = None) -> LawTable:
    """Return the :class:`LawTable` of any kind of material that a user may give.

    material: a :class:`.prony.Prony`, a :class:`.bodies.Bodies` or :class:`.bodies.Cover`, an
        alpha >= 1 as a number, a :class:`.material.Material`, a :class:`.pair.Pair`, or a
        LawTable, which is returned.
    base: Material of the half-space, only beside a Material; None: that of the cylinder.
    Returns the table; of a Material or a Pair with its T_ref in s and the bodies as ``pair``, of a
    series, of bodies and of an alpha with T_ref = 1.
    Raises ParameterError for another type, an alpha out of [1, 1e12], a base beside anything but a
    Material, a Material or Pair with a thickness (its law depends on load and radius), many
    materials, and as :func:`.law_tables.law_table`.
    """
    if base is not None and not isinstance(material, Material):
        raise described_error("base", "is given", "left out unless material is a Material")
    if isinstance(material, LawTable | Prony | Bodies):
        return law_table(material)
    if isinstance(material, Material):
        material = Pair(material, base)
    if isinstance(material, Pair):
        return replace(law_table(material.law), T_ref=material.T_ref, pair=material)
    if not is_real(material):
        raise ParameterError(
            "material",
            describe_value(material),
            "a Material, a Cylinder, a Prony, Bodies, or a number alpha (instantaneous divided by "
            "long-time modulus)",
        )
    return law_table(check_number("alpha", material, low=1.0, high=HIGHEST_ALPHA))


def law_as_dataset(law: LawTable | LawAxis, errors: Mapping[str, float]) -> Dataset:
    """Return the content of the file of a law.

    law: the law of one material or cover, :class:`LawTable`, or of all alpha, :class:`LawAxis`.
    errors: name of a function, as "lam" -> its largest relative error, dimensionless; for each
        function of the kind of file (:data:`.checked_netcdf.KINDS`), else KeyError.
    Returns the dataset of :func:`.checked_netcdf.make_dataset`, with the coefficients of each
    function, and with what :func:`load_law` needs to make the law again, of a table the text of its
    material
    as attribute ``material`` (:func:`bodies_as_toml`); of half-spaces also ``bodies``, "unlike" or
    "alike".  Of these N is computed if it was not yet.
    """
    if isinstance(law, LawAxis):
        return make_dataset(law, AXIS, "alpha = {:g} to {:g}".format(*law.alpha), errors)
    texts = [bodies_as_toml(given) for given in (law.pair, law.material) if given is not None]
    title = _title(law)
    if law.moment_of_speed_alone:
        bodies = "unlike" if law.unlike else "alike"
        return make_dataset(law, LAW, title, errors, bodies=bodies, material=texts[0])
    if law.coupled is not None:
        kind = COUPLED
        title += f", mu = {law.coupled.mu:g}"
        errors = law.coupled.errors | dict(errors)
        own = vars(law.coupled) | {"coefficients": law.coupled.fields}
    else:
        kind = COVER
        cover: Any = law.cover
        creep = np.moveaxis(cover.creep, 0, -1)
        coefficients = np.concatenate([law.steady_coefficients[..., STEADY], creep], axis=-1)
        own = {"coefficients": coefficients, "limits": cover.limits}
    # make_dataset reads the numbers of a kind of file as attributes of one object
    numbers = types.SimpleNamespace(**(vars(law) | own))
    return make_dataset(numbers, kind, title, errors, material="\n".join(texts))


def _title(table: LawTable) -> str:
    """Return the bodies of a ``table`` in words, for a title: the names of the materials of its
    ``pair``, joined by " on "; without a pair alpha and the number of relaxation times.
    """
    if table.pair is None:
        return f"alpha = {table.alpha:g}, {table.relaxation_time.size} relaxation times"
    bodies = (table.pair.cylinder, table.pair.base)
    return " on ".join(
        body.name or "material without a name" for body in bodies if body is not None
    )


def load_law(path: str | os.PathLike[str], alpha: float | None = None) -> Any:
    """Load the law of one material or pair from a file, for use wherever a Prony or Bodies is used.

    Parameters
    ----------
    path : file of :func:`viscoroll.tables.save` or of ``viscoroll tables law``; or a grid of Q
        and M over V and delta, of ``viscoroll tables build`` or of another program
        (``viscoroll.laws.law_grid.load_grid``).
    alpha : of a file of every alpha of one relaxation time, or of a grid over alpha: that which is
        wanted, with T_epsilon for the unit of time.  It must be left out for any other file.

    Returns
    -------
    LawTable, or of a grid LawGrid
        A LawGrid is for :func:`viscoroll.law`, and the ``material`` of a :class:`viscoroll.Scene`.
        A LawTable is bit for bit that of its material (``tests/tables/test_law.py``).  In SI units,
        as ``material`` of :class:`viscoroll.Cylinder`, it stands for its
        :class:`viscoroll.Material`, and for the base where it has one.

    Raises
    ------
    FileError
        A file that is missing, cut or damaged in any byte, no law, or of another schema; a grid
        that is incomplete.
    ParameterError
        An alpha beside the file of one material or a grid without an axis alpha; for the file of
        every alpha, or a grid over alpha, none, or one that is no number or beyond the range of the
        file.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(vr.presets.RUBBER_CYLINDER), "rubber.nc")
    >>> roller = vr.presets.RUBBER_CYLINDER.replace(material=vr.load_law("rubber.nc"))
    >>> bool(
    ...     roller.contact(1.0, delta=0.0).M
    ...     == vr.presets.RUBBER_CYLINDER.contact(1.0, delta=0.0).M
    ... )
    True
    """
    try:
        content = read_law(path)
    except FileError:
        if (grid := load_grid(path, alpha)) is None:
            raise
        return grid
    if content.attributes[KIND] != AXIS:
        if alpha is not None:
            raise ParameterError(
                "alpha", describe_value(alpha), f"left out: {path} has no range of alpha"
            )
        return parse_law(content, path)
    axis = parse_axis(content, path)
    wider = "`viscoroll tables law --alpha LOW:HIGH` writes another range"
    return axis.at(check_alpha(alpha, axis.alpha, f"{path} ({wider})"))


def parse_law(content: Content, path: Any) -> LawTable:
    """Return the law of one material or cover.

    content: :class:`.checked_netcdf.Content` of the file, verified.
    path: path of the file, for errors.
    Returns a new :class:`LawTable`, with the coefficients (those of N too but for a cover), e0 and
    T_ref of the file, and the bodies as ``pair`` if it states them in SI units; of elastic
    half-spaces it has the constant functions.
    Raises FileError for the law of every alpha, and for a file that does not state its material or
    is incomplete.
    """
    numbers, attributes = content
    kind = attributes[KIND]
    if kind == AXIS:
        raise FileError(
            path,
            "has the laws of a range of alpha, not of one material: in Python give for example "
            "vr.tables.law(vr.load_law(path, alpha=11.0)); or write the law of one alpha by "
            "`viscoroll tables law` of a file with this alpha in [scene]",
        )
    with _refuse_incomplete(path):
        given, pair = _parse_bodies(attributes["material"], path)
        coefficients = _coefficients(content)
        if kind == COUPLED:
            u, t, edges = (
                lock_array(np.array(numbers[name], dtype=float)) for name in ("u", "t", "edges")
            )
            if coefficients.shape[:-1] != (u.size + 2, t.size) or edges.shape != (u.size + 2, 4):
                raise ValueError(f"its functions have shape {coefficients.shape[:-1]}")
            rows = CoupledRows(mu=float(numbers["mu"]), u=u, t=t, edges=edges, fields=coefficients)
            law = coupled_table(given, rows)
        elif kind == COVER:
            functions = np.moveaxis(coefficients, -1, 0)
            # the file has the functions of steady rolling, all but N, and then those of covers
            steady, creep = np.split(functions, [len(STEADY)])
            table = steady_table(steady)
            cover = CoverRows(int(numbers["e0"]), table, creep, numbers["limits"])
            law = make_table(given, cover=cover)
        else:
            law = replace(law_table(given, coefficients), e0=int(numbers["e0"]))
        return replace(law, T_ref=float(numbers["T_ref"]), pair=pair)


def parse_axis(content: Content, path: Any) -> LawAxis:
    """Return the law of one relaxation time for a range of alpha, from the content of its file.

    content: :class:`.checked_netcdf.Content` of a file of the kind :data:`.checked_netcdf.AXIS`,
        whose checksum was verified.
    path: path of the file, for errors.
    Returns the :class:`LawAxis`, with the coefficients of the file.
    Raises FileError where a variable is missing, where the coefficients do not have the dimensions
    of this kind, and where they are not for as many octaves of alpha as the variable ``rows``
    lists.
    """
    with _refuse_incomplete(path):
        coefficients = _coefficients(content)
        numbers = content.numbers
        rows = tuple(map(int, numbers["rows"]))
        if coefficients.ndim != len(KINDS[AXIS].dims) + 1 or len(rows) != len(coefficients):
            raise ValueError(f"its functions have shape {coefficients.shape[:-1]}")
        return LawAxis(coefficients, rows, int(numbers["first"]), int(numbers["e0"]))


def _coefficients(content: Content) -> Floats:
    """Return the coefficients of all functions of a file as one read-only array of doubles, (...,
    functions).

    content: :class:`.checked_netcdf.Content` of the file, whose kind states the names and the order
        of the functions.
    Raises KeyError for a function that is missing, ValueError for functions of different shapes.
    """
    names = KINDS[content.attributes[KIND]].functions
    return lock_array(np.stack([content.numbers[name] for name in names], axis=-1).astype(float))


@contextlib.contextmanager
def _refuse_incomplete(path: Any) -> Iterator[None]:
    """Raise FileError in place of the errors that parsing an incomplete file ends with; a context
    manager.

    path: path of the file, for the error.
    Replaces FileError, KeyError, TypeError and ValueError (ParameterError is one); other exceptions
    pass.
    """
    try:
        yield
    except (FileError, KeyError, TypeError, ValueError) as error:
        raise FileError(
            path,
            "is damaged or was edited: its variables, or its attribute material, are not those "
            f"that were written; {REMEDY}",
        ) from error


def bodies_as_toml(given: Any) -> str:
    """Return TOML that :func:`_parse_bodies` reads back to the bit.

    given: :class:`.pair.Pair` (in SI units, as in scene files), or :class:`.bodies.Cover`,
        :class:`.bodies.Bodies`, :class:`.prony.Prony` or alpha as a float (dimensionless), each
        of one material.
    Returns a text with the key plane and the sections [material] and, unless the base is that of
    the cylinder, [base]; or with the section [cover], [bodies] or, of a Prony or alpha, [scene].
    """
    if isinstance(given, Pair):
        text = material_as_toml(given.cylinder)
        text += "" if given.base is None else f"\n{material_as_toml(given.base, 'base')}"
        return f'plane = "{given.plane}"\n{text}'
    if isinstance(given, Cover):
        lines = [
            f"{name} = {json.dumps(value)}"
            for name in _COVER_ATTRIBUTES
            if (value := getattr(given, name)) is not None
        ]
        if given.other.alpha > 1.0:
            lines.append(f"other = {{ {series_as_toml(given.other)} }}")
        return "\n".join(["[cover]", series_as_toml(given.layer), *lines, ""])
    if isinstance(given, Bodies):
        parts = (
            f"{name} = {{ {series_as_toml(getattr(given, name))} }}"
            for name in ("cylinder", "base")
        )
        poisson = "" if given.poisson is None else f"poisson = {list(given.poisson)!r}\n"
        return "\n".join(["[bodies]", *parts, f"share = {given.share!r}", poisson])
    return (
        f"[scene]\n{series_as_toml(given) if isinstance(given, Prony) else f'alpha = {given!r}'}\n"
    )


def _parse_bodies(text: str, path: Any) -> tuple[Any, Pair | None]:
    """Parse text of :func:`bodies_as_toml`.

    text: TOML.
    path: path of the file, for errors.
    Returns (Cover, Bodies, Prony or alpha, dimensionless: of the section [cover]; without it
    ``Pair.law`` of the materials in SI units; without these of [bodies], or [scene]; then the
    :class:`Pair` of the sections [material] and [base], None without).
    Raises FileError for a section that is wrong, KeyError for a section or key that is missing, and
    ValueError, of which ParameterError is one, for text that is not TOML and for bodies that do not
    go together.
    """
    content = tomllib.loads(text)
    pair = None
    if "material" in content:
        bodies = parse_materials(path, content)
        pair = Pair(bodies["material"], bodies.get("base"), content["plane"])
    if "cover" in content:
        given = content["cover"]
        more = {name: given[name] for name in _COVER_ATTRIBUTES if name in given}
        if "other" in given:
            more["other"] = parse_series(path, "cover", given["other"])
        return Cover(parse_series(path, "cover", given), **more), pair
    if pair is not None:
        return pair.law, pair
    if "bodies" in content:
        given = content["bodies"]
        series = {name: parse_series(path, "bodies", given[name]) for name in ("cylinder", "base")}
        return Bodies(**(given | series)), None
    given = content["scene"]
    return given["alpha"] if "alpha" in given else parse_series(path, "scene", given), None
