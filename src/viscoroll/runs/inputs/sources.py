"""Where inputs come from: numbers, distributions of scipy.stats, columns of files; ranges and units."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...materials.file import materials_of
from ...materials.material import Material
from ...materials.pair import Pair, Plane
from ...sections import fault, hint, refuse_unknown
from .drives import prescribed_start, read_drive
from .ranges import CYLINDER, DRIVE, DRIVE_SI, OPTIONAL, SCENE, SOLID, START, START_SI
from .reader import Reader
from .record import Distribution, Inputs, Joint
from .solids import SERIES, is_uncertain, read_series, read_solids

_PLANES = ("strain", "stress")


def read_inputs(
    path: Path,
    sections: dict[str, dict[str, Any]],
    base: dict[str, Any],
    correlation: dict[str, Any],
    materials: dict[str, Any],
    drive: dict[str, Any],
) -> Inputs:
    """Inputs of sections, materials and drive; ``base`` fills in what sections leave out.  Raises ConfigError."""
    reader = Reader(path)
    cylinder = {name: allowed for name, allowed in CYLINDER.items() if not (materials and name in SOLID)}
    ranges = {"cylinder": cylinder, "start": START_SI} if "cylinder" in sections else {"scene": SCENE, "start": START}
    for section, given in sections.items():
        reader.section = section
        others = {"cylinder": ("plane",), "scene": tuple(SERIES)}.get(section, ())
        refuse_unknown(path, section, given, (*ranges[section], *others))
        series = _series(reader, section, given, base) if section == "scene" else None
        for name, allowed in ranges[section].items():
            if prescribed_start(reader, name, given, drive):
                continue
            value = given.get(name, base.get(name, allowed.default))
            if name == "alpha" and series is not None:
                continue
            if value is not None:
                reader.put(name, value, allowed)
            elif name not in OPTIONAL:
                needed = "alpha, prony or creep" if name == "alpha" else name
                raise fault(path, "", section, f"[{section}] needs {needed}")
    driven = DRIVE_SI if "cylinder" in sections else DRIVE
    refuse_unknown(path, "drive", drive, driven)
    reader.section = "drive"
    read_drive(reader, drive, driven)
    if "cylinder" in sections:
        reader.section = "cylinder"
        plane = sections["cylinder"].get("plane", "strain")
        if plane not in _PLANES:
            raise reader.fault("plane", f"plane = {plane!r}: must be 'strain' or 'stress'")
        reader.fixed["plane"] = plane
        if any(map(is_uncertain, materials.values())):
            read_solids(reader, materials)
        elif materials:
            pair = _pair(path, materials_of(path, materials), plane)
            reader.fixed |= {"pair": pair, "T_ref": pair.T_ref}
    joint = {file: Joint(columns) for file, columns in reader.joint.items()}
    correlated, mixing = _copula(path, correlation, reader.random)
    inputs = Inputs(reader.fixed, reader.random, joint, correlated, mixing)
    if "cylinder" in sections and not materials:
        _refuse_short_retardation(reader, inputs)
    return inputs


def _series(reader: Reader, section: str, given: dict[str, Any], base: dict[str, Any]) -> Any:
    """File the series that stands in place of alpha, of the section or of its preset, if there is one."""
    series, _ = read_series(reader, section, given)
    reader.section = section
    if series is None and "alpha" not in given:
        series = base.get("series")
    if series is not None:
        if "alpha" in given:
            raise fault(reader.path, section, "alpha", "alpha and a series: must be one of the two")
        reader.fixed["series"] = series
    return series


def _pair(path: Path, materials: dict[str, Material], plane: Plane) -> Pair:
    """Both bodies of a run; raises ConfigError."""
    try:
        return Pair(materials["material"], materials.get("base"), plane)
    except ParameterError as error:
        raise fault(path, "", "material", str(error)) from error


def _copula(path: Path, given: dict[str, Any], random: dict[str, Distribution]) -> tuple[tuple[str, ...], Any]:
    """(names, Cholesky factor) of [correlation]."""
    if not isinstance(given, dict):
        raise fault(path, "", "correlation", "correlation: must be a section [correlation] with lines like V0.mu = 0.5")
    pairs = {(a, b): value for a, row in given.items() for b, value in (row.items() if isinstance(row, dict) else [])}
    for a, row in given.items():
        if not isinstance(row, dict):
            raise fault(path, "correlation", a, f"{a} = {row!r:.40}: must be a line like V0.mu = 0.5")
    names = tuple(name for name in random if any(name in pair for pair in pairs))
    matrix = np.eye(len(names))
    for (a, b), value in pairs.items():
        for name in (a, b):
            if name not in random:
                problem = f"{name!r} has no distribution: must be one of {', '.join(random)}{hint(name, random)}"
                raise fault(path, "correlation", a, problem)
        if a == b or isinstance(value, bool) or not isinstance(value, (int, float)) or not -1.0 < value < 1.0:
            raise fault(path, "correlation", a, f"{a}.{b} = {value!r:.40}: must be two names and a number in (-1, 1)")
        if pairs.get((b, a), value) != value:
            problem = f"{a}.{b} = {value!r}: must be that of {b}.{a} = {pairs[b, a]!r:.40}"
            raise fault(path, "correlation", a, problem)
        n, m = names.index(a), names.index(b)
        matrix[n, m] = matrix[m, n] = value
    try:
        return names, np.linalg.cholesky(matrix) if names else None
    except np.linalg.LinAlgError:
        raise fault(path, "", "correlation", "[correlation] no joint distribution has these correlations") from None


def _refuse_short_retardation(reader: Reader, inputs: Inputs) -> None:
    """T_epsilon must not fall below T_sigma in any draw."""
    for sample in inputs.joint.values():
        if {"T_epsilon", "T_sigma"} <= sample.columns.keys():
            if (sample.columns["T_epsilon"] < sample.columns["T_sigma"]).any():
                raise reader.fault("T_epsilon", "T_epsilon: rows with T_epsilon < T_sigma")
            return
    if _end(inputs, "T_epsilon", 0) < _end(inputs, "T_sigma", 1):
        problem = "T_epsilon may fall below T_sigma: truncate both so that it cannot"
        raise reader.fault("T_epsilon", problem)


def _end(inputs: Inputs, name: str, which: int) -> float:
    """Lower (0) or upper (1) end of an input."""
    if name in inputs.fixed:
        return inputs.fixed[name]
    if name in inputs.random:
        law = inputs.random[name]
        return (law.low, law.high)[which]
    values = next(sample.columns[name] for sample in inputs.joint.values() if name in sample.columns)
    return float((values.min(), values.max())[which])
