"""The law of one material or pair as a dataset and a file: of a :class:`LawTable`, and back bit for bit."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from numbers import Real
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.checks import checked
from ..core.errors import FileError, ParameterError
from .bodies import Bodies
from .file import as_toml, materials_of, series_as_toml, series_of
from .law_axis_file import alpha_of
from .law_store import KIND, LAW, MEANING, OTHERS, REMEDY, Content, read_law, sealed
from .law_table import FUNCTIONS, LawTable, law_table
from .material import Material
from .pair import Pair
from .prony import Prony
from .prony_forms import HIGHEST_ALPHA

if TYPE_CHECKING:
    import xarray as xr

COMMENT = (
    "x = m 2^e with m in [1/2, 1) (frexp); n = e - e0. n <= 0 or x = 0: row 0 at t = x 2^-e0; 0 < n < rows: row n at "
    "t = 4 m - 3; beyond: the fast limit. A function is the sum over k of c[n, k] t^k. u = kappa |V|; "
    "L = lam (1 + epsilon); delta_star = mu L/(2 kappa); D = 2 kappa |delta|/mu; D >= L: full slip, |Q| = mu, beta = 0."
    " Else w = L - D, v = 2 u/w: beta = share(v) w/lam, |Q| = mu (1 - w^2 press(v)); where D < L/8: "
    "|Q| = mu D ((2 L - D) press(v) - (2 u L/w) S), S the mean slope of press between 2 u/L and v. "
    "M_half_space = V m_half_space, M_cylinder = V m_cylinder, M their sum. Q has the sign of omega - V. Fast limit: "
    "z = 1/(2 u sqrt(alpha)), W and C of fast_limit: lam = alpha^-1/2, epsilon = (alpha z/2)(C - W ln z), "
    "m = (alpha z^2/2)(C - W ln z + W/4) with those of either body, N = (alpha - 1) z^2/4; y = 1/v: "
    "share = 1 - (alpha y/2)(C - W ln y), press = alpha share^2. At another temperature: look up u a_T, N times a_T^2."
)


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
    return law_table(float(checked("alpha", float(material), low=1.0, high=HIGHEST_ALPHA)))


def as_dataset(table: LawTable, errors: Mapping[str, float]) -> xr.Dataset:
    """All that a file holds; ``errors``: largest relative error by function."""
    import xarray as xr

    data = {}
    for n, (name, meaning) in enumerate(MEANING.items()):
        about: dict[str, Any] = {"long_name": f"coefficients of powers of t: {meaning}"}
        about["largest_relative_error"] = errors[name]
        data[name] = xr.Variable(("octave", "power"), table.coefficients[:, :, n], about)
    for name, (dims, meaning) in OTHERS.items():
        value = np.int32(table.e0) if name == "e0" else getattr(table, name)
        data[name] = xr.Variable(dims, value, {"long_name": meaning})
    data["T_ref"].attrs["units"] = "s"  # the others have none
    bodies = "unlike" if table.unlike else "alike"
    material = described(table.pair or table.material)
    return sealed(data, LAW, name_of(table), COMMENT, bodies=bodies, material=material)


def name_of(table: LawTable) -> str:
    """The bodies in words."""
    if table.pair is None:
        return f"alpha = {table.alpha:g}, {table.relaxation_time.size} relaxation times"
    bodies = (table.pair.cylinder, table.pair.base)
    return " on ".join(body.name or "a material without a name" for body in bodies if body is not None)


def load_law(path: str | PathLike[str], alpha: float | None = None) -> LawTable:
    """The law of one material or pair from a file, to stand wherever a Prony or Bodies stands.

    Parameters
    ----------
    path : file of :func:`viscoroll.io.tables.save` or of ``viscoroll tables law``.
    alpha : of a file of every alpha of one relaxation time: that which is wanted, with T_epsilon for the unit of time.

    Returns
    -------
    LawTable
        Bit for bit that of its material (``tests/tables/test_law.py``).  In SI units, as ``material`` of
        :class:`viscoroll.Cylinder`, it stands for its :class:`viscoroll.Material`, and for the base where it has one.

    Raises
    ------
    FileError
        A file that is missing, cut or damaged in any byte, no law, or of another schema; an alpha beyond the file's.
    ParameterError
        An alpha beside the file of one material, or none for that of every alpha.
    """
    content = read_law(path)
    if content.attributes[KIND] == LAW:
        if alpha is not None:
            raise ParameterError("alpha", f"{alpha!r:.60}", f"left out: {path} is the law of one material")
        return law_of(content, path)
    return alpha_of(content, alpha, path)


def law_of(content: Content, path: Any) -> LawTable:
    """The law of what was checked; raises FileError where it does not name its material."""
    found, attributes = content
    if attributes[KIND] != LAW:
        raise FileError(path, "is the law of every alpha: of one it is vr.tables.law(vr.load_law(path, alpha=11.0))")
    try:
        given = _material_of(attributes["material"], path)
        numbers: dict[str, Any] = {name: np.asarray(found[name]) for name in OTHERS}
        for name, value in numbers.items():
            numbers[name] = int(value) if name == "e0" else float(value) if not value.ndim else _frozen(value)
        coefficients = _frozen(np.stack([found[name] for name in FUNCTIONS], axis=-1))
        pair = given if isinstance(given, Pair) else None
        return LawTable(
            given_coefficients=coefficients, **numbers, unlike=attributes["bodies"] == "unlike",
            material=given if pair is None else pair.law, pair=pair,
        )  # fmt: skip
    except (FileError, ParameterError, KeyError, TypeError, ValueError) as error:
        text = " ".join(str(error).split())
        raise FileError(path, f"is no whole law file ({text:.200}): {REMEDY}") from error


def _frozen(values: Any) -> Any:
    values = np.ascontiguousarray(values, np.float64)
    values.flags.writeable = False
    return values


def described(given: Any) -> str:
    """A pair, Bodies, a series or an alpha as TOML that reads back to the bit: as in scene files, or dimensionless."""
    if isinstance(given, Pair):
        text = as_toml(given.cylinder)
        text += "" if given.base is None else f"\n{as_toml(given.base, 'base')}"
        return f'plane = "{given.plane}"\n{text}'
    if isinstance(given, Bodies):
        parts = (f"{name} = {{ {series_as_toml(getattr(given, name))} }}" for name in ("cylinder", "base"))
        return "\n".join(["[bodies]", *parts, f"share = {given.share!r}", ""])
    return f"[scene]\n{series_as_toml(given) if isinstance(given, Prony) else f'alpha = {given!r}'}\n"


def _material_of(text: str, path: Any) -> Any:
    """What :func:`described` wrote: a pair, Bodies, a Prony series or an alpha."""
    content = tomllib.loads(text)
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
