"""Run files: TOML -> :class:`Run`, everything checked before anything is computed.

    preset = "paper-section-5"     # or [scene] or [cylinder]; [scene] may also change a preset

    [start]
    V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
    omega0 = 0.5

    [drive]                        # if wanted
    torque = { times = [0.0, 1e-3, "same"], values = [0.0, 0.02, 0.0] }

    [run]
    n = 1_000_000
    seed = 7
    t = [1e-3, 2e-3, 3e-3]

All dimensionless, or all in SI units with [cylinder], and perhaps [material] and [base].  All keys: docs/ensembles.md.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..config import preset
from ..errors import ParameterError, unknown
from ..materials.file import SECTIONS as MATERIALS
from ..materials.file import as_toml, materials_of
from ..materials.prony import Prony
from ..motion.batch import FIELDS, FLOW_PAYS
from ..motion.checks import controls, output_times
from ..motion.unsteady import time_of_rest
from ..sections import as_struct, fault, read, refuse_unknown
from .draws import Design
from .inputs.drives import is_driven, lasts
from .inputs.ranges import CYLINDER, SCENE, START
from .inputs.record import Inputs
from .inputs.sources import read_inputs
from .inputs.units import dimensionless
from .quantities import QUANTITIES

#: a block holds at most so many motions, mapped or integrated (some seconds each), and so many bytes
_MAPPED, _INTEGRATED, _BYTES = 1 << 20, 1 << 16, 1 << 27
#: settings that came later: left out of the digest where they are not given
_LATER = ("unsteady", "rested")
_SECTIONS = ("preset", "scene", "cylinder", *MATERIALS, "start", "drive", "correlation", "run")

Whole = Annotated[int, msgspec.Meta(ge=1, le=10**12)]
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]


class RunSection(msgspec.Struct, frozen=True):
    """[run]."""

    n: Whole
    t: float | list[float] | dict[str, Any]
    seed: Annotated[int, msgspec.Meta(ge=0, le=2**63 - 1)] = 0
    design: Design = "random"
    method: Literal["auto", "flow", "integrate"] = "auto"
    rtol: float = 1e-8
    rest: float | None = None
    unsteady: bool = False
    rested: bool | float = False
    block: Whole | None = None
    keep: Literal["summaries", "all"] = "summaries"
    fields: tuple[str, ...] = ("V", "omega", "x")
    summaries: tuple[str, ...] = ("V", "omega", "x", "onset_time")
    quantiles: tuple[Share, ...] = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True, eq=False)
class Run:
    """What a run file asks for.

    Attributes
    ----------
    text : the file.
    settings : its section [run].
    inputs : what its other sections say of start, scene or cylinder.
    t : output times, dimensionless or, with [cylinder], in seconds.
    digest : SHA-256 of all that the results depend on: settings, inputs, samples.
    """

    text: str
    settings: RunSection
    inputs: Inputs
    t: NDArray[np.float64]
    digest: str

    @property
    def method(self) -> Literal["flow", "integrate"]:
        """How every block is rolled: settled by the run as a whole, so that bits do not depend on blocks."""
        if self.settings.method != "auto":
            return self.settings.method
        if is_driven(self.inputs) or self.settings.unsteady:
            return "integrate"
        return "flow" if self.one_scene and self.settings.n >= FLOW_PAYS and self.fastest > 0.0 else "integrate"

    @property
    def one_scene(self) -> bool:
        """Whether only the start is uncertain."""
        return set(self.inputs.uncertain) <= set(START)

    @property
    def fastest(self) -> float:
        """Dimensionless speed that the flow map is made for; the few motions beyond are integrated."""
        return max(dimensionless(self.inputs.fixed | {name: self.inputs.largest(name)}, name) for name in START)

    @property
    def si(self) -> bool:
        """Whether everything in the file and in the results is in SI units."""
        return self.inputs.si

    @property
    def rest(self) -> float | None:
        """Dimensionless rest threshold."""
        rest = self.settings.rest
        return None if rest is None else dimensionless(self.inputs.fixed | {"rest": rest}, "rest")

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields of the motions that a block needs, kept or summarised."""
        needed = {name for wanted in self.settings.summaries for name in QUANTITIES[wanted].fields}
        kept = set(self.settings.fields) if self.settings.keep == "all" else set()
        return tuple(name for name in FIELDS if name in needed | kept)

    @property
    def bytes_a_motion(self) -> int:
        """Memory that a motion takes while its block is worked on."""
        columns = len(self.fields) * self.t.size + 2 * len(self.inputs.uncertain) + 12
        return 8 * (columns + self.t.size)  # one output at a time is copied for its summary

    @property
    def block(self) -> int:
        """Motions a block."""
        if self.settings.block is not None:
            return min(self.settings.block, self.settings.n)
        most = _MAPPED if self.method == "flow" else _INTEGRATED
        fits = 1 << max(_BYTES // self.bytes_a_motion, 1).bit_length() - 1  # a power of two suits Sobol
        return min(most, fits, self.settings.n)

    @property
    def blocks(self) -> int:
        """How many blocks."""
        return -(-self.settings.n // self.block)

    def edges(self, block: int) -> tuple[int, int]:
        """First motion of a block, and first of the next."""
        return block * self.block, min((block + 1) * self.block, self.settings.n)


def read_run(path: str | PathLike[str]) -> Run:
    """Read and check a run file.

    Parameters
    ----------
    path : TOML file; its keys are in docs/ensembles.md.

    Returns
    -------
    Run
        Everything in it checked; nothing drawn or rolled yet.

    Raises
    ------
    ConfigError
        A file that cannot be read or is not TOML, a misspelt key (with the nearest), a value of
        the wrong type or with a unit, a range that leaves what the input allows, a sample
        that cannot be read: each with its line.
    """
    content = read(path)
    refuse_unknown(path, "", content, _SECTIONS)
    if "run" not in content:
        raise fault(path, "", "run", "section [run] is missing: it needs n and t")
    settings = as_struct(path, "run", content["run"], RunSection)
    sections, base = _parameters(path, content)
    correlation = content.get("correlation", {})
    materials = {name: content[name] for name in MATERIALS if name in content}
    drive = content.get("drive", {})
    inputs = read_inputs(Path(path), sections, base, correlation, materials, drive)
    times = _checked(path, settings, inputs)
    stored = materials_of(path, {name: given for name, given in materials.items() if "file" in given})
    described = sections | materials | {f"{name} stored": as_toml(found) for name, found in stored.items()}
    described |= {"drive": drive} if drive else {}
    digest = _digest(settings, times, described, base, correlation, inputs)
    return Run(Path(path).read_text(encoding="utf-8"), settings, inputs, times, digest)


def _parameters(path: Any, content: dict[str, Any]) -> tuple[dict[str, dict[str, Any]], dict[str, Any]]:
    """(sections of inputs, values that a preset gives)."""
    if "cylinder" in content and ("scene" in content or "preset" in content):
        raise fault(path, "", "cylinder", "[cylinder] stands alone: without preset and [scene]")
    for name in MATERIALS:
        if name in content and "cylinder" not in content:
            raise fault(path, "", name, f"[{name}] goes with [cylinder]")
    if "base" in content and "material" not in content:
        raise fault(path, "", "base", "[base] needs [material]: E, nu, T_epsilon and T_sigma there, not in [cylinder]")
    if not content.keys() & {"preset", "scene", "cylinder"}:
        raise fault(path, "", "scene", "one of preset, [scene] and [cylinder] is needed")
    if "start" not in content:
        raise fault(path, "", "start", "section [start] is missing: it needs V0 and omega0")
    base: dict[str, Any] = {}
    if "preset" in content:
        try:
            scene = preset(content["preset"])
        except ParameterError as error:
            raise fault(path, "", "preset", str(error)) from error
        base = {name: getattr(scene, name) for name in SCENE}
        if scene.material is not None:
            base = base | {"alpha": None, "series": scene.material}
    kinds = {"cylinder": CYLINDER} if "cylinder" in content else {"scene": SCENE}
    return {name: content.get(name, {}) for name in kinds} | {"start": content["start"]}, base


def _checked(path: Any, settings: RunSection, inputs: Inputs) -> NDArray[np.float64]:
    """Output times; what msgspec cannot check of [run] is checked here."""
    from ..tables import spread

    for key, allowed, kind in (("fields", FIELDS, "a field"), ("summaries", tuple(QUANTITIES), "a summary")):
        for name in getattr(settings, key):
            if name not in allowed:
                raise fault(path, "run", key, str(unknown(key, name, allowed, kind)))
    if not settings.summaries:
        raise fault(path, "run", "summaries", "summaries = []: must name at least one quantity")
    if settings.method == "flow" and is_driven(inputs):
        raise fault(path, "run", "method", "method = 'flow': must be 'auto' or 'integrate' with [drive]")
    if settings.method == "flow" and set(inputs.uncertain) - set(START):
        raise fault(path, "run", "method", "method = 'flow': must be 'auto' or 'integrate' where scenes differ")
    if settings.rest is not None and lasts(inputs):
        problem = f"rest = {settings.rest!r}: must be left out where [drive] lasts to the end"
        raise fault(path, "run", "rest", problem)
    if settings.rest is not None and inputs.si and {"R", "T_epsilon"} & set(inputs.uncertain):
        problem = f"rest = {settings.rest!r}: must be left out where R or T_epsilon is uncertain"
        raise fault(path, "run", "rest", problem)
    if settings.method == "flow" and settings.unsteady:
        raise fault(path, "run", "method", "method = 'flow': must be 'auto' or 'integrate' with unsteady")
    for key, value in (("unsteady", settings.unsteady), ("rested", settings.rested)):
        if value is not False and inputs.si and "T_epsilon" in inputs.uncertain:
            problem = f"{key} = {msgspec.json.encode(value).decode()}: must be left out where T_epsilon is uncertain"
            raise fault(path, "run", key, problem)
    if isinstance(settings.t, dict):
        refuse_unknown(path, "run.t", settings.t, ("low", "high", "count", "spacing"))
    try:
        controls(settings.rtol, settings.rest, 1)
        time_of_rest(settings.rested)
        return output_times(spread(**settings.t) if isinstance(settings.t, dict) else settings.t)
    except ParameterError as error:
        raise fault(path, "run", error.name if error.name in ("rtol", "rest", "rested") else "t", str(error)) from error
    except TypeError:
        problem = f"t = {settings.t!r:.60}: must be a list, or low, high, count (and spacing)"
        raise fault(path, "run", "t", problem) from None


def _digest(settings: RunSection, times: NDArray, *parts: Any) -> str:
    """SHA-256 of what the results depend on; comments and the order of keys are not among it."""
    *described, inputs = parts
    known = {name: value for name, value in msgspec.to_builtins(settings).items() if name not in _LATER or value}
    content = [known, times.tolist(), described, _samples(inputs)]
    content += ["SI"] * inputs.si  # there was a time when speeds and times of a cylinder were dimensionless
    return hashlib.sha256(msgspec.json.encode(_plain(content), order="deterministic")).hexdigest()


def _samples(inputs: Inputs) -> list[list[str]]:
    return [
        [name, hashlib.sha256(values.tobytes()).hexdigest()]
        for sample in inputs.joint.values()
        for name, values in sample.columns.items()
    ]


def _plain(value: Any) -> Any:
    """Infinite bounds and series as text: JSON has none."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, Prony):
        return repr(value)
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
