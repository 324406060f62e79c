"""Laws as datasets and files: of a :class:`LawTable` or a :class:`LawAxis`, and back bit for bit."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from numbers import Real
from os import PathLike
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.checks import check_array, check_number
from ..core.errors import FileError, ParameterError
from .bodies import Bodies
from .cover import Cover
from .cover_rows import CoverRows
from .file import as_toml, materials_of, series_as_toml, series_of
from .law_axis import LawAxis
from .law_grid import load_grid
from .law_store import AXIS, COVER, KIND, KINDS, LAW, REMEDY, Content, dataset_of, read_law
from .law_table import FUNCTIONS, Floats, LawTable, law_table, made
from .material import Material
from .pair import Pair
from .prony import Prony
from .prony_forms import HIGHEST_ALPHA

if TYPE_CHECKING:
    import xarray as xr

#: columns of a table but N, and what a file says of a layer beside its series
_NOT_N = [n for n, name in enumerate(FUNCTIONS) if name != "N"]
_OF_COVER = "nu", "thickness", "on", "part", "other_nu"


def table_of(material: Any, base: Any = None) -> LawTable:
    """The law of a Prony, Bodies, alpha, Material (on a ``base``), Pair, or of a law that there is already."""
    if base is not None and not isinstance(material, Material):
        raise ParameterError("base", "given", "left out unless material is a Material")
    if isinstance(material, LawTable | Prony | Bodies):
        return law_table(material)
    if isinstance(material, Material):
        material = Pair(material, base)
    if isinstance(material, Pair):
        pair = material
        return replace(law_table(pair.law), T_ref=pair.T_ref, pair=pair)
    if not isinstance(material, Real):
        allowed = "a Prony, Bodies, a Material, a Cylinder or an alpha"
        raise ParameterError("material", f"of type {type(material).__name__}", allowed)
    return law_table(float(check_array("alpha", float(material), low=1.0, high=HIGHEST_ALPHA)))


def as_dataset(law: LawTable | LawAxis, errors: Mapping[str, float]) -> xr.Dataset:
    """All that a file holds; ``errors``: largest relative error by function."""
    if isinstance(law, LawAxis):
        return dataset_of(law, AXIS, "alpha = {:g} to {:g}".format(*law.alpha), errors)
    if law.cover is not None:
        cover: Any = law.material
        cover.refuse_unknown_split("a file")
        rows = np.concatenate([law.given_coefficients[..., _NOT_N], np.moveaxis(law.cover.creep, 0, -1)], axis=-1)
        text = ("" if law.pair is None else f"{described(law.pair)}\n") + described(law.material)
        numbers = SimpleNamespace(coefficients=rows, **{n: getattr(law, n) for n in ("e0", "alpha", "T_ref")})
        numbers.limits = law.cover.limits
        return dataset_of(numbers, COVER, name_of(law), errors, material=text)
    bodies, material = "unlike" if law.unlike else "alike", described(law.pair or law.material)
    return dataset_of(law, LAW, name_of(law), errors, bodies=bodies, material=material)


def name_of(table: LawTable) -> str:
    """The bodies in words."""
    if table.pair is None:
        return f"alpha = {table.alpha:g}, {table.relaxation_time.size} relaxation times"
    bodies = (table.pair.cylinder, table.pair.base)
    return " on ".join(body.name or "a material without a name" for body in bodies if body is not None)


def load_law(path: str | PathLike[str], alpha: float | None = None) -> Any:
    """The law of one material or pair from a file, to stand wherever a Prony or Bodies stands.

    Parameters
    ----------
    path : file of :func:`viscoroll.io.tables.save` or of ``viscoroll tables law``; or a grid of Q and M over V and
        delta, of ``viscoroll tables build`` or of another program (``materials/law_grid.py``).
    alpha : of a file of every alpha of one relaxation time, or of a grid over alpha: that which is wanted, with
        T_epsilon for the unit of time.

    Returns
    -------
    LawTable, or of a grid LawGrid
        A LawGrid is for :func:`viscoroll.law` alone: motions are integrated from rows.  A LawTable is bit for bit
        that of its material (``tests/tables/test_law.py``).  In SI units, as ``material`` of
        :class:`viscoroll.Cylinder`, it stands for its :class:`viscoroll.Material`, and for the base where it has one.

    Raises
    ------
    FileError
        A file that is missing, cut or damaged in any byte, no law, or of another schema; an alpha beyond the file's.
    ParameterError
        An alpha beside the file of one material, or none for that of every alpha.
    """
    try:
        content = read_law(path)
    except FileError:
        if (grid := load_grid(path, alpha)) is None:
            raise
        return grid
    if content.attributes[KIND] != AXIS:
        if alpha is not None:
            raise ParameterError("alpha", f"{alpha!r:.60}", f"left out: {path} is the law of one material")
        return law_of(content, path)
    axis = axis_of(content, path)
    low, high = axis.alpha
    if alpha is None or not low <= check_number("alpha", alpha, low=1.0, high=HIGHEST_ALPHA) <= high:
        wider = "`viscoroll tables law --alpha LOW:HIGH` writes others"
        raise ParameterError("alpha", alpha, f"one of {low:g} to {high:g}, which {path} holds ({wider})")
    return axis.at(alpha)


def law_of(content: Content, path: Any) -> LawTable:
    """The law of what was checked; raises FileError where it does not name its material."""
    if content.attributes[KIND] == AXIS:
        raise FileError(path, "is the law of every alpha: of one it is vr.tables.law(vr.load_law(path, alpha=11.0))")
    with _whole(path):
        given = _material_of(content.attributes["material"], path)
        if content.attributes[KIND] == COVER:
            return _of_cover(content, *given)
        pair = given if isinstance(given, Pair) else None
        found = law_table(given if pair is None else pair.law, coefficients=_stacked(content, LAW))
        numbers = content.numbers
        return replace(found, e0=int(numbers["e0"]), T_ref=float(numbers["T_ref"]), pair=pair)


def _of_cover(content: Content, cover: Cover, pair: Pair | None) -> LawTable:
    """The law of a layer from its numbers."""
    numbers, e0 = content.numbers, int(content.numbers["e0"])
    stacked = _stacked(content, COVER)
    coefficients = np.full((*stacked.shape[:2], len(FUNCTIONS)), np.nan)
    coefficients[..., _NOT_N] = stacked[..., :-2]
    rows = CoverRows(e0, coefficients, np.moveaxis(stacked[..., -2:], -1, 0), numbers["limits"])
    return replace(made(cover, cover=rows), T_ref=float(numbers["T_ref"]), pair=pair)


def axis_of(content: Content, path: Any) -> LawAxis:
    """The law of every alpha, of what was checked; raises FileError."""
    with _whole(path):
        whole, numbers = _stacked(content, AXIS), content.numbers
        rows = tuple(map(int, numbers["rows"]))
        if whole.ndim != len(KINDS[AXIS].dims) + 1 or len(rows) != len(whole):
            raise ValueError(f"functions of shape {whole.shape[:-1]}")
        return LawAxis(whole, rows, int(numbers["first"]), int(numbers["e0"]))


def _stacked(content: Content, kind: str) -> Floats:
    """The coefficients of all functions."""
    found = np.stack([content.numbers[name] for name in KINDS[kind].functions], axis=-1).astype(np.float64)
    found.flags.writeable = False
    return found


@contextmanager
def _whole(path: Any) -> Iterator[None]:
    """FileError in place of what goes wrong where a file is not as it was written."""
    try:
        yield
    except (FileError, ParameterError, KeyError, TypeError, ValueError) as error:
        text = " ".join(str(error).split())
        raise FileError(path, f"is no whole law file ({text:.200}): {REMEDY}") from error


def described(given: Any) -> str:
    """A pair, Bodies, a series or an alpha as TOML that reads back to the bit: as in scene files, or dimensionless."""
    if isinstance(given, Pair):
        text = as_toml(given.cylinder)
        text += "" if given.base is None else f"\n{as_toml(given.base, 'base')}"
        return f'plane = "{given.plane}"\n{text}'
    if isinstance(given, Cover):
        lines = (f"{name} = {json.dumps(getattr(given, name))}" for name in _OF_COVER)
        return "\n".join(["[cover]", series_as_toml(given.layer), *lines, ""])
    if isinstance(given, Bodies):
        parts = (f"{name} = {{ {series_as_toml(getattr(given, name))} }}" for name in ("cylinder", "base"))
        return "\n".join(["[bodies]", *parts, f"share = {given.share!r}", ""])
    return f"[scene]\n{series_as_toml(given) if isinstance(given, Prony) else f'alpha = {given!r}'}\n"


def _material_of(text: str, path: Any) -> Any:
    """What :func:`described` wrote: a pair, Bodies, a series or an alpha; of a layer (Cover, its pair or None)."""
    content = tomllib.loads(text)
    if "cover" in content:
        given = content["cover"]
        cover = Cover(series_of(path, "cover", given), **{name: given[name] for name in _OF_COVER})
        bodies = materials_of(path, content) if "material" in content else None
        return cover, None if bodies is None else Pair(bodies["material"], bodies.get("base"), content["plane"])
    if "material" in content:
        found = materials_of(path, content)
        return Pair(found["material"], found.get("base"), content["plane"])
    if "bodies" in content:
        given = content["bodies"]
        parts = (given[name] for name in ("cylinder", "base"))
        series: Any = (series_of(path, "bodies", one) for one in parts)
        return Bodies(*series, given["share"])  # type: ignore[call-arg]
    given = content["scene"]
    return given["alpha"] if "alpha" in given else series_of(path, "scene", given)
