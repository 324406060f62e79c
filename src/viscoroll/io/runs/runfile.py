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
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from ...core.array_types import Floats
from ...core.errors import FileError, ParameterError, check_names
from ...core.sections import read_toml, section_error
from ...materials.file import as_toml, materials_of
from ...motion.batch import FLOW_PAYS
from ...motion.checks import output_times
from ...motion.drive import Drive
from ...motion.ensemble import FIELDS
from ...motion.problem import SolverOptions, make_problem
from ...motion.summaries import QUANTITIES
from ..config import check_sections, locate_error
from ..sampling import Design
from ..tables import spread
from .inputs import Inputs, inputs_in
from .rollers import Rollers, drive_of, roller_of
from .uncertain import correlated, inputs_of

#: a block holds at most so many motions, mapped or integrated (some seconds each), and so many bytes
_MAPPED, _INTEGRATED, _BYTES = 1 << 20, 1 << 16, 1 << 27
START = ("V0", "omega0")
#: settings that the digest leaves out: a store may grow with n, and its identity has the method and block that result
_NOT_IN_DIGEST = ("n", "method", "block")

Whole = Annotated[int, msgspec.Meta(ge=1, le=10**12)]
Numbers = Annotated[list[float], msgspec.Meta(min_length=1)]
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]


class StartSection(msgspec.Struct):
    """[start]: one is left out where [drive] prescribes it."""

    V0: float | None = None
    omega0: float | None = None


class CourseSection(msgspec.Struct):
    """{ times = [...], values = [...] }."""

    times: Numbers
    values: Numbers


class DriveSection(msgspec.Struct):
    """[drive]."""

    force: float | CourseSection | None = None
    torque: float | CourseSection | None = None
    brake: float | CourseSection | None = None
    slope: float | None = None
    drag: float | None = None
    V: float | CourseSection | None = None
    omega: float | CourseSection | None = None


class TimesSection(msgspec.Struct):
    """{ low, high, count, spacing }."""

    low: float
    high: float
    count: int
    spacing: Literal["linear", "log"] = "linear"


class RunSection(msgspec.Struct, frozen=True):
    """[run].

    n : motions, up to 1e12.
    t : output times, in s with [cylinder].
    seed : of every draw.
    design : how inputs are drawn: each by itself, in a Latin hypercube, or along Sobol's sequence.
    method, rtol, rest, unsteady, rested : as of :func:`viscoroll.ensemble`; with [cylinder] in SI units.
    block : motions a block; the default fits the memory.
    keep : summaries alone, or every motion with its inputs.
    fields : of the motions that are kept.
    summaries : quantities whose distribution is kept.
    quantiles : which of them are shown.
    """

    n: Whole
    t: float | list[float] | TimesSection
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
    path, text : of the file.
    settings : its section [run].
    inputs : what its other sections say of start, scene or cylinder, and what of it is uncertain.
    t : output times, dimensionless or, with [cylinder], in seconds.
    digest : SHA-256 of what the results depend on beside the number of motions, the method and the size of blocks:
        other settings, inputs, samples.
    """

    path: Path
    text: str
    settings: RunSection
    inputs: Inputs
    t: Floats
    digest: str

    @property
    def method(self) -> Literal["flow", "integrate"]:
        """How every block is rolled: settled by the run as a whole, so that bits do not depend on blocks."""
        if self.settings.method != "auto":
            return self.settings.method
        if not self.mappable:
            return "integrate"
        return "flow" if self.settings.n >= FLOW_PAYS and self.fastest > 0.0 else "integrate"

    @property
    def mappable(self) -> bool:
        """Whether only the start is uncertain, and nothing drives."""
        driven = self.inputs.content.get("drive") or self.settings.unsteady
        return not driven and set(self.inputs.uncertain) <= set(START)

    @cached_property
    def fastest(self) -> float:
        """Speed that the flow map is made for; the few motions beyond are integrated."""
        R = self.inputs.content["cylinder"]["R"] if self.si else 1.0
        return max(self.inputs.largest("V0"), R * self.inputs.largest("omega0"))

    @property
    def si(self) -> bool:
        """Whether everything in the file and in the results is in SI units."""
        return "cylinder" in self.inputs.content

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
    FileError
        A file that cannot be read or is not TOML, a misspelt key (with the nearest), a value of
        the wrong type or with a unit, a range that leaves what the input allows, a sample
        that cannot be read: each with its line.
    """
    path, content = Path(path), read_toml(path)
    inputs = inputs_of(path, content)
    medians = inputs.filled(inputs.medians)
    sections = {"start": StartSection, "drive": DriveSection, "run": RunSection, "correlation": None}
    check_sections(path, medians, sections)
    for name, needed in (("run", "n and t"), ("start", "V0 and omega0")):
        if name not in content:
            raise section_error(path, "", name, f"section [{name}] is missing: it needs {needed}")
    materials = materials_of(path, medians)
    # those that are certain are read once
    known = {name: found for name, found in materials.items() if not inputs_in(inputs.content[name])}
    inputs = correlated(path, replace(inputs, content=inputs.content | known))
    settings = msgspec.convert(content["run"], RunSection)
    try:
        given = settings.t
        times = output_times(spread(**msgspec.to_builtins(given)) if isinstance(given, TimesSection) else given)
    except ParameterError as error:
        raise section_error(path, "run", "t", str(error)) from error
    text = path.read_text(encoding="utf-8-sig")
    digest = _digest(settings, times, content, [as_toml(each) for each in known.values()], inputs)
    run = Run(path, text, settings, inputs, times, digest)
    _check_settings(run)
    _check_inputs(run)
    return run


def _check_settings(run: Run) -> None:
    """Raise FileError for what msgspec cannot check of [run]."""
    settings = run.settings
    try:
        check_names("fields", settings.fields, FIELDS, "a field")
        check_names("summaries", settings.summaries, QUANTITIES, "a summary")
    except ParameterError as error:
        raise section_error(run.path, "run", error.name, str(error)) from error
    if not settings.summaries:
        raise section_error(run.path, "run", "summaries", "summaries = []: must name at least one quantity")
    if settings.method == "flow" and not run.mappable:
        problem = "method = 'flow': must be 'auto' or 'integrate' with [drive], with unsteady, and where scenes differ"
        raise section_error(run.path, "run", "method", problem)


def _check_inputs(run: Run) -> None:
    """Refuse, before anything is drawn, what a motion would: of the medians, of each input's ends, and of all ends."""
    inputs, medians = run.inputs, run.inputs.medians
    try:
        _begin(run, medians)
    except ParameterError as error:
        raise locate_error(run.path, inputs.content, error) from error
    for at in inputs_in(inputs.content):
        ends = inputs.ends(at.name)
        try:
            _begin(run, medians | {at.name: ends})
        except (ParameterError, FileError) as error:
            if isinstance(error, ParameterError) and error.name in inputs.content["run"]:
                raise locate_error(run.path, inputs.content, error) from error
            reaches = f"{at.name}: reaches from {ends[0]:.6g} to {ends[1]:.6g}"
            problem = getattr(error, "problem", str(error)).rpartition("] ")[2]
            raise section_error(
                run.path, at.section, at.key, f"{reaches}: {problem}; add truncate = [low, high]"
            ) from error
    wholes = (medians | columns for columns in inputs.joint.values() if len(columns) > 1)
    for values in (inputs.corners(), *wholes):
        try:
            _begin(run, values)
        except ParameterError as error:
            more = ParameterError(
                error.name, error.value, error.allowed, f"{error} in every draw: truncate so that it is"
            )
            raise locate_error(run.path, inputs.content, more) from error


def _begin(run: Run, values: dict[str, Any]) -> None:
    content, settings = run.inputs.filled(values), run.settings
    roller = roller_of(run.path, content)
    for name in ("unsteady", "rested"):
        if getattr(settings, name) is not False and isinstance(roller, Rollers) and roller.seconds:
            raise ParameterError(name, str(getattr(settings, name)).lower(), "left out where T_epsilon is uncertain")
    start = tuple(content["start"].get(name) for name in START)
    options = SolverOptions(settings.rtol, settings.rest, 1, None, settings.unsteady, settings.rested)
    drive = Drive(**drive_of(content))
    make_problem(roller, start, drive, run.t[-1], options)


def _digest(settings: RunSection, times: Floats, content: dict[str, Any], materials: list[str], inputs: Inputs) -> str:
    """The ``digest`` of a :class:`Run`; comments and the order of keys do not change it."""
    kept = {name: value for name, value in msgspec.to_builtins(settings).items() if name not in _NOT_IN_DIGEST}
    sections = {name: given for name, given in content.items() if name != "run"}
    samples = [
        [name, hashlib.sha256(values.tobytes()).hexdigest()]
        for columns in inputs.joint.values()
        for name, values in columns.items()
    ]
    described = [kept, times.tolist(), sections, materials, samples]
    return hashlib.sha256(msgspec.msgpack.encode(described, order="deterministic")).hexdigest()
