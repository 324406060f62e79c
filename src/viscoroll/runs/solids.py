"""Materials of a run: strengths and times of a series, modulus and Poisson's ratio may be uncertain.

Each of them is an input of its own: E and nu, E_1 and tau_1 of the first mode of ``prony``, J_1 and T_1 of ``creep``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..material_file import materials_of, series_of
from ..prony import Prony
from ..sections import fault
from .ranges import CYLINDER, MODES

if TYPE_CHECKING:
    from .sources import Reader

#: keys of a series, and the lists of its strengths and times
SERIES = {"prony": ("E", "tau"), "creep": ("J", "T")}
_SOLID = ("E", "nu")


@dataclass(frozen=True)
class Modes:
    """Names of the inputs that are strengths and times of a series."""

    creep: bool
    strengths: tuple[str, ...]
    times: tuple[str, ...]

    def of(self, values: Mapping[str, Any]) -> Any:
        """The series, or one for each motion, of a block's inputs."""
        strengths, times = (
            np.stack(np.broadcast_arrays(*(values[name] for name in names)), axis=-1)
            for names in (self.strengths, self.times)
        )
        return Prony.creep(strengths, times) if self.creep else Prony(strengths, times)


def is_uncertain(section: Any) -> bool:
    """Whether a section of a file has more than numbers where an input may stand."""
    if not isinstance(section, dict):
        return False
    entries = [section.get(name) for name in _SOLID]
    for key, lists in SERIES.items():
        series = section.get(key)
        if isinstance(series, dict):
            entries += [entry for name in lists if isinstance(series.get(name), list) for entry in series[name]]
    return any(isinstance(entry, dict) for entry in entries)


def read_series(reader: Reader, section: str, given: dict[str, Any]) -> tuple[Prony | Modes | None, dict[str, Any]]:
    """The series of a section, and the section with the median of each of its distributions in their place."""
    plain = dict(given)
    uncertain = is_uncertain(given)
    for key in SERIES if uncertain else ():
        if isinstance(given.get(key), dict):
            plain[key] = {name: _medians(reader, f"{section}.{key}", name, value) for name, value in given[key].items()}
            if plain[key].get("alpha") is not None:
                raise fault(
                    reader.path, f"{section}.{key}", "alpha", "alpha: must be left out where J or T are uncertain"
                )
    series = series_of(reader.path, section, plain.get("prony"), plain.get("creep"))
    if series is None or not uncertain:
        return series, plain
    key = "creep" if "creep" in given else "prony"
    names = [tuple(f"{name}_{n}" for n in range(1, len(given[key][name]) + 1)) for name in SERIES[key]]
    if key == "creep":
        _refuse_infinite_modulus(reader, f"{section}.{key}", names[0])
    return (Modes(key == "creep", *names) if names[0] else series), plain


def read_material(reader: Reader, given: dict[str, Any]) -> None:
    """File the inputs of a section [material] that is uncertain."""
    series, plain = read_series(reader, "material", given)
    reader.section = "material"
    for name in _SOLID:
        if name in given:
            plain[name] = median(reader, name, given[name], CYLINDER[name])
    material = materials_of(reader.path, {"material": plain})["material"]
    reader.fixed |= {"series": material.prony if series is None else series, "T_ref": material.T_ref}


def _medians(reader: Reader, section: str, name: str, value: Any) -> Any:
    """File each of a list of strengths or times; what is no such list is for others to refuse."""
    if name not in SERIES[section.rsplit(".", 1)[1]] or not isinstance(value, list):
        return value
    reader.section = section
    return [median(reader, f"{name}_{n}", entry, MODES[name], line=name) for n, entry in enumerate(value, 1)]


def median(reader: Reader, name: str, value: Any, allowed: Any, line: str = "") -> float:
    """File an input; the median of its distribution, or its number."""
    reader.put(name, value, allowed, line)
    reader.line = ""
    return float(np.median(spread(reader, name, np.array([0.5]))))


def spread(reader: Reader, name: str, at: Any) -> Any:
    """Values of an input at points of its distribution, all of a sample, or its number."""
    if name in reader.fixed:
        return np.full(1, reader.fixed[name])
    if name in reader.random:
        return reader.random[name].ppf(at)
    return next(sample[name] for sample in reader.joint.values() if name in sample)


def _refuse_infinite_modulus(reader: Reader, section: str, strengths: tuple[str, ...]) -> None:
    """Of a creep series sum J must be below 1 in every draw."""
    most = sum(float(np.max(spread(reader, name, np.ones(1)))) for name in strengths)
    if not most < 1.0:
        problem = f"J may sum to {most:g}: truncate so that it stays below 1, and the instantaneous modulus finite"
        raise fault(reader.path, section, "J", problem)
