"""Materials of a run: strengths and times of a series, modulus and Poisson's ratio may be uncertain.

Each of them is an input of its own: E and nu, E_1 and tau_1 of the first mode of ``prony``, J_1 and T_1 of ``creep``;
of a [base] base_E, base_E_1 and so on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...materials.bodies import Bodies
from ...materials.file import materials_of, series_of
from ...materials.material import Material
from ...materials.pair import Pair, Plane, cylinders_share, effective_modulus, joint_modulus
from ...materials.prony import Prony
from ...sections import fault
from .ranges import CYLINDER, MODES, PREFIXES

if TYPE_CHECKING:
    from .reader import Reader

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


@dataclass(frozen=True)
class Solid:
    """A body of a run: its series, modulus and Poisson's ratio, or the names of the inputs that these are."""

    series: Prony | Modes
    T_ref: float
    E: float | str
    nu: float | str
    #: of medians
    typical: Material

    @property
    def relaxes(self) -> bool:
        """Whether time means anything to it."""
        return isinstance(self.series, Modes) or self.series.alpha > 1.0

    def series_of(self, values: Mapping[str, Any]) -> Any:
        """Its series of a block's inputs, one or one for each motion."""
        return self.series.of(values) if isinstance(self.series, Modes) else self.series

    def modulus(self, values: Mapping[str, Any], plane: str) -> Any:
        """E' of a block's inputs."""
        E, nu = (values[given] if isinstance(given, str) else given for given in (self.E, self.nu))
        return effective_modulus(E, nu, plane)


@dataclass(frozen=True)
class Solids:
    """The bodies of a run of which one is uncertain; no ``base``: that of the cylinder."""

    cylinder: Solid
    base: Solid | None

    @property
    def T_ref(self) -> float:
        """What times are counted in, s, as of a :class:`viscoroll.materials.pair.Pair`."""
        return (self.base if self.base and not self.cylinder.relaxes else self.cylinder).T_ref

    def typical(self, plane: Plane) -> Pair:
        """Both bodies of medians."""
        return Pair(self.cylinder.typical, None if self.base is None else self.base.typical, plane)

    def law(self, values: Mapping[str, Any], plane: str) -> tuple[Any, Any]:
        """(Series or bodies, one or one for each motion; E' of both) of a block's inputs."""
        one = self.cylinder.modulus(values, plane)
        if self.base is None:
            return self.cylinder.series_of(values), one
        other = self.base.modulus(values, plane)
        first, second = (
            solid.series_of(values).slower(solid.T_ref / self.T_ref) for solid in (self.cylinder, self.base)
        )
        return Bodies(first, second, cylinders_share(one, other)), joint_modulus(one, other)


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


def read_series(
    reader: Reader, section: str, given: dict[str, Any], prefix: str = ""
) -> tuple[Prony | Modes | None, dict[str, Any]]:
    """The series of a section, and the section with the median of each of its distributions in their place.

    ``prefix`` : in front of the names of its inputs.
    """
    plain = dict(given)
    uncertain = is_uncertain(given)
    for key in SERIES if uncertain else ():
        if isinstance(given.get(key), dict):
            lists = given[key].items()
            plain[key] = {name: _medians(reader, f"{section}.{key}", name, value, prefix) for name, value in lists}
            if plain[key].get("alpha") is not None:
                raise fault(
                    reader.path, f"{section}.{key}", "alpha", "alpha: must be left out where J or T are uncertain"
                )
    series = series_of(reader.path, section, plain.get("prony"), plain.get("creep"))
    if series is None or not uncertain:
        return series, plain
    key = "creep" if "creep" in given else "prony"
    names = [tuple(f"{prefix}{name}_{n}" for n in range(1, len(given[key][name]) + 1)) for name in SERIES[key]]
    if key == "creep":
        _refuse_infinite_modulus(reader, f"{section}.{key}", names[0])
    return (Modes(key == "creep", *names) if names[0] else series), plain


def read_solids(reader: Reader, materials: Mapping[str, Any]) -> None:
    """File the inputs of [material] and [base], of which one is uncertain."""
    bodies = [_read_solid(reader, name, materials[name]) for name in PREFIXES if name in materials]
    solids = Solids(bodies[0], bodies[1] if len(bodies) > 1 else None)
    reader.fixed |= {"solids": solids, "T_ref": solids.T_ref}


def _read_solid(reader: Reader, section: str, given: dict[str, Any]) -> Solid:
    """A body, with its inputs filed where it is uncertain."""
    if not is_uncertain(given):
        material = materials_of(reader.path, {section: given})[section]
        return Solid(material.prony, material.T_ref, material.E, material.nu, material)
    prefix = PREFIXES[section]
    series, plain = read_series(reader, section, given, prefix)
    reader.section = section
    for name in _SOLID:
        if name in given:
            plain[name] = median(reader, prefix + name, given[name], CYLINDER[name], line=name)
    material = materials_of(reader.path, {section: plain})[section]
    return Solid(material.prony if series is None else series, material.T_ref, prefix + "E", prefix + "nu", material)


def _medians(reader: Reader, section: str, name: str, value: Any, prefix: str) -> Any:
    """File each of a list of strengths or times; what is no such list is for others to refuse."""
    if name not in SERIES[section.rsplit(".", 1)[1]] or not isinstance(value, list):
        return value
    reader.section = section
    return [median(reader, f"{prefix}{name}_{n}", entry, MODES[name], line=name) for n, entry in enumerate(value, 1)]


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
