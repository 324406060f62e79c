"""Run files: TOML -> :class:`runs.Run`, everything checked before anything is computed.

    preset = "paper-section-5"     # or [scene] or [cylinder]; [scene] may also change a preset

    [start]
    V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
    omega0 = 0.5

    [drive]                        # optional
    torque = { times = [0.0, 1e-3, "same"], values = [0.0, 0.02, 0.0] }

    [run]
    n = 1_000_000
    seed = 7
    t = [1e-3, 2e-3, 3e-3]

All numbers are dimensionless, or, with [cylinder] and perhaps [material] and [base], in SI units.
All keys are in docs/ensembles.md.
"""

import hashlib
import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import msgspec
import numpy as np

from ..contact_mechanics import refuse_several_tables
from ..core import (
    FileError,
    FilePath,
    Floats,
    Named,
    Names,
    ParameterError,
    as_section_error,
    check_names,
    is_real,
    read_toml,
    section_error,
    suggestion,
)
from ..materials import material_as_toml, parse_materials
from ..motion import (
    FIELDS,
    FLOW_PAYS,
    LEVELS,
    QUANTITIES,
    Drive,
    SolverOptions,
    make_problem,
    output_times,
)
from ..presets import check_sections, locate_error
from ..sampling import Design
from .run_rollers import RUN_SECTIONS, Rollers, drive_of, roller_of
from .uncertain_inputs import Inputs, inputs_in, inputs_of

#: Largest number of motions of a block, by method: some seconds of work.
_MOST_MOTIONS = {"flow": 1 << 20, "integrate": 1 << 16}
#: Largest size of a block in memory, bytes.
_MOST_BYTES = 1 << 27
#: First words of a FileError of a section.
_PLACE = r"^(line \d+: )?(\[[^]]*\] )?"
#: Keys of the section [start].
START = ("V0", "omega0")
#: Settings that the digest leaves out: a store may grow with n, and its identity contains the
#: resulting method and block.
_NOT_IN_DIGEST = ("n", "method", "block")

#: A positive whole number.
Whole = Annotated[int, msgspec.Meta(ge=1, le=10**12)]
#: A number in [0, 1].
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]


class TimesSection(msgspec.Struct):
    """{ low, high, count, spacing }: equally spaced output times, or logarithms of these."""

    low: float
    high: float
    count: int
    spacing: Literal["linear", "log"] = "linear"


class RunSection(msgspec.Struct, frozen=True):
    """[run].

    n : number of motions, up to 1e12.
    t : output times, dimensionless; with [cylinder] in s.
    seed : seed of all random inputs.
    design : "random" draws inputs independently, "latin" in a Latin hypercube, "sobol" from a Sobol
    sequence.
    method : "flow" reads the motions from a flow map, for which start speeds alone may be
    uncertain, without [drive] and unsteady, of half-spaces of one material; "integrate" integrates
    each motion; "auto" takes "flow" for at least 4096 motions where these conditions hold.
    rtol : relative tolerance of the integrator, in [1e-12, 1e-2].
    rest : speed, dimensionless; with [cylinder] in m/s.  A motion ends at rest when |V| and
    R |omega| are below it and no force, torque, slope, brake, drag or prescribed speed acts any
    more.  Default: no such end.
    unsteady : whether the moment contains N dV/dt, the effect of slow changes of the speed (N is
    the added mass).  It is allowed for half-spaces of one material only.
    rested : whether the cylinder stood still for long before the start; a number is the time for
    which it stood still, with [cylinder] in s.  It is refused for covers, for half-spaces with
    Dundurs' constant above 0.05 unless ``coupled`` is false, and for a start in full slip.
    block : number of motions that are computed together; default: 128 MiB of motions, at most 65536
    (1048576 from a flow map).
    keep : "summaries" stores statistics alone, "all" also every motion with its inputs.
    fields : quantities of each motion that are stored with keep = "all".
    summaries : quantities whose statistics are stored.
    quantiles : probabilities of the quantiles that are stored.
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
    fields: Names = ("V", "omega", "x")
    summaries: Names = ("V", "omega", "x", "onset_time")
    quantiles: tuple[Share, ...] = LEVELS


@dataclass(frozen=True, eq=False)
class Run:
    """A run, as a run file states it.

    Attributes
    ----------
    path, text : path and text of the file.
    settings : its section [run], a :class:`RunSection`.
    inputs : its other sections, and which of their numbers are uncertain, as
        :class:`.uncertain_inputs.Inputs`.
    t : output times, dimensionless or, with [cylinder], in s, (t,).
    digest : SHA-256 of what the results depend on, apart from the number of motions, the method and
        the size of
        blocks: other settings, inputs, samples.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> run.method, run.blocks, run.inputs.uncertain
    ('integrate', 1, ('mu', 'V0'))
    """

    path: Path
    text: str
    settings: RunSection
    inputs: Inputs
    t: Floats
    digest: str

    @property
    def method(self) -> Literal["flow", "integrate"]:
        """Method of all blocks: "flow" or "integrate".

        A flow map is a set of tables of all free motions of one scene, which are looked up there
        and not integrated.  The method is that of the file, or for "auto" the flow map if one
        serves (:attr:`mappable`), the run has at least 4096 motions
        (:data:`.many_motions.FLOW_PAYS`), and a start speed differs from 0.  It depends on the
        run as a whole, so that bits do not depend on blocks.
        """
        if self.settings.method != "auto":
            return self.settings.method
        pays = self.mappable and self.settings.n >= FLOW_PAYS and self.fastest > 0.0
        return "flow" if pays else "integrate"

    @property
    def mappable(self) -> bool:
        """Whether a flow map serves: start speeds alone are uncertain, [drive] is absent or empty,
        unsteady false, and the bodies are half-spaces of one material.  Raises FileError for a
        roller that is wrong.
        """
        return not self._no_map

    @cached_property
    def _no_map(self) -> str:
        """Why no flow map serves, in words of a message; "" if one does (:attr:`mappable`)."""
        if self.inputs.content.get("drive"):
            return "the file has [drive]"
        if self.settings.unsteady:
            return "unsteady is true"
        if others := [name for name in self.inputs.uncertain if name not in START]:
            return f"{others[0]} is uncertain, and not only V0 and omega0"
        scene = roller_of(self.path, self.inputs.filled(self.inputs.medians)).scene()
        return "" if scene.like_bodies else "the roller has a cover or two materials"

    @cached_property
    def fastest(self) -> float:
        """Speed up to which the flow map is tabulated: the larger of |V0| and R |omega0|.

        It is a float >= 0 in m/s, or dimensionless, where R is 1; of distributions see
        :meth:`.uncertain_inputs.Inputs.largest`.  The few faster motions are integrated.  Raises
        KeyError if [start] lacks one of the two.
        """
        R = self.inputs.content["cylinder"]["R"] if self.si else 1.0
        V0 = self.inputs.largest("V0")
        return V0 if self.inputs.rolls else max(V0, R * self.inputs.largest("omega0"))

    @property
    def si(self) -> bool:
        """Whether the file and the results are in SI units."""
        return "cylinder" in self.inputs.content

    @property
    def fields(self) -> Names:
        """Fields of the motions that are kept (with keep = "all" only) or summarised, in the order
        of ``FIELDS``.
        """
        needed = {name for wanted in self.settings.summaries for name in QUANTITIES[wanted].fields}
        if self.settings.keep == "all":
            needed |= {*self.settings.fields}
        return tuple(name for name in FIELDS if name in needed)

    @property
    def bytes_a_motion(self) -> int:
        """Memory that a motion takes while its block is evaluated, bytes, an int: of its fields and
        inputs.
        """
        # inputs as points and as values; 12: parameters, starts, and how a motion ended
        columns = len(self.fields) * self.t.size + 2 * len(self.inputs.uncertain) + 12
        return 8 * (columns + self.t.size)  # one output at a time is copied for its summary

    @property
    def block(self) -> int:
        """Number of motions in a full block, an int from 1 to n: as the file states, else as many
        as fit the memory.

        That is the largest power of two of motions that take at most 128 MiB together, but 1 where
        a single one takes more; not more than 2^20 motions of a flow map or 2^16 that are
        integrated.  In either case it is n if n is smaller.
        """
        block = self.settings.block
        if block is None:
            # a power of two suits Sobol's sequence: the largest one that fits
            fits = 1 << max(_MOST_BYTES // self.bytes_a_motion, 1).bit_length() - 1
            block = min(_MOST_MOTIONS[self.method], fits)
        return min(block, self.settings.n)

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return -(-self.settings.n // self.block)

    def _with_settings(self, **changes: Any) -> Self:
        """Return a new run with other values of some settings.

        changes: name of a setting of :class:`RunSection` -> its value, which is not checked.
        """
        return replace(self, settings=msgspec.structs.replace(self.settings, **changes))

    def edges(self, block: int) -> tuple[int, int]:
        """Return the range of the motions of a block, counted over the run.

        Parameters
        ----------
        block : number of the block, from 0 to ``blocks`` - 1, which is not checked.

        Returns
        -------
        start, stop : index of the first motion of the block, and of the first one after it; the
            last block ends at the number of all motions, and may be shorter than the others.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.runs.read_run(vr.datasets.path("run.toml")).edges(0)
        (0, 16)
        """
        return block * self.block, min((block + 1) * self.block, self.settings.n)


def read_run(path: FilePath) -> Run:
    """Read and check a run file.

    Parameters
    ----------
    path : TOML file; its keys are in docs/ensembles.md.

    Returns
    -------
    Run
        The run, with all of the file checked, the motions of median and extreme inputs for their
        ranges too; nothing is drawn or rolled yet.

    Raises
    ------
    FileError
        A file that cannot be read or is not TOML, a section [run] or [start] that is missing, a
        misspelt key (with the nearest), a value of the wrong type or with a unit, a range that
        exceeds what the input allows, a sample that cannot be read, an unknown quantity, no
        quantity in ``summaries``, correlations that contradict each other, method "flow" where no
        flow map serves: each with its line if that is found.
    MissingDependencyError
        A sample in a .parquet file, if pyarrow is not installed.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.runs.read_run(vr.datasets.path("run.toml")).settings.n
    16
    """
    content = read_toml(path)
    path = Path(path)
    inputs = inputs_of(path, content)
    medians = inputs.filled(inputs.medians)
    check_sections(path, medians, RUN_SECTIONS | {"run": RunSection, "correlation": None})
    needs = {"run": "n and t", "start": "V0 and omega0, except a speed that [drive] prescribes"}
    for name, needed in needs.items():
        if name not in content:
            raise section_error(path, "", name, f"section [{name}] is missing: it needs {needed}")
    for name in START:
        # V0 may be missing where [drive] prescribes V, omega0 where it prescribes omega
        if name not in content["start"] and name[:-1] not in content.get("drive", {}):
            advice = ', or "rolling" for V0/R' * ("V0" in content["start"])
            problem = f"{name} is missing: give a number{advice}"
            raise section_error(path, "start", name, problem)
    materials = parse_materials(path, medians)
    # a material without uncertain numbers is read once
    certain = {
        name: material
        for name, material in materials.items()
        if not inputs_in(inputs.content[name])
    }
    inputs = correlated(path, replace(inputs, content=inputs.content | certain))
    settings = msgspec.convert(content["run"], RunSection)
    with as_section_error(path, "run", "t"):
        t: Any = settings.t
        if isinstance(t, TimesSection):
            from ..tables import spread

            t = spread(**msgspec.to_builtins(t))
        times = output_times(t)
    with as_section_error(path, "run"):
        check_names("fields", settings.fields, FIELDS, "a field")
        check_names("summaries", settings.summaries, QUANTITIES, "a summary")
    text = path.read_text(encoding="utf-8-sig")
    digest = _digest(settings, times, content, materials, inputs)
    run = Run(path=path, text=text, settings=settings, inputs=inputs, t=times, digest=digest)
    if not settings.summaries:
        raise section_error(
            path, "run", "summaries", "summaries = []: must name at least one quantity, as 'V'"
        )
    if settings.method == "flow" and run._no_map:
        problem = f"method = 'flow': must be 'auto' or 'integrate', since {run._no_map}"
        raise section_error(path, "run", "method", problem)
    _check_inputs(run)
    return run


def _check_inputs(run: Run) -> None:
    """Raise FileError for values of inputs that a motion refuses, before anything is drawn.

    It checks in turn the medians; the ends of each input with the others at their medians;
    combinations of ends (:meth:`.uncertain_inputs.Inputs.corners`); and all rows of each file of
    several columns.

    run: :class:`runs.Run`, with its inputs and settings.
    The error states the line and the reason: of an end of an input also the range of its draws, and
    the remedy to truncate; of a wrong setting of [run] that setting; of combinations the first
    parameter that is refused.
    """
    inputs = run.inputs
    medians = inputs.medians
    _check_motions(run, medians)
    for number in inputs_in(inputs.content):
        ends = inputs.ends(number.name)
        error = _fault_of(run, medians | {number.name: ends})
        if isinstance(error, ParameterError) and error.name in inputs.content["run"]:
            raise locate_error(run.path, inputs.content, error) from error
        if error is not None:
            # without "line N: [section] " of a FileError, which the new error states itself
            problem = re.sub(_PLACE, "", getattr(error, "problem", str(error)))
            # a single end is refused too: the range is at fault, else that the motions differ
            if any(_fault_of(run, medians | {number.name: end}) for end in ends.tolist()):
                problem = f"extend from {ends[0]:.6g} to {ends[1]:.6g}: {problem}"
                problem = (
                    f"draws {problem}; narrow the distribution by truncate = [low, high]"
                    if number.name in inputs.random
                    else f"numbers of the data file {problem}; remove its rows out of range"
                )
            problem = f"{number.name}: {problem}"
            raise section_error(run.path, number.section, number.key, problem) from error
    samples = (medians | columns for columns in inputs.joint.values() if len(columns) > 1)
    for values in (inputs.corners(), *samples):
        _check_motions(
            run,
            values,
            " (in some combinations of the draws: narrow distributions by truncate = [low, high], "
            "or remove rows of data files)",
        )


def _check_motions(run: Run, values: Named, advice: str = "") -> None:
    """Raise the error that :func:`_fault_of` returns as FileError with its line; nothing is rolled,
    None is returned.

    run: :class:`runs.Run`, of which path, inputs, settings and t are read.
    values: name of an input -> number or (n,), for every input, in the units of the file.
    advice: last words of the message, which follow it directly, "" for none; not added to the error
        of a material, which is raised as it is.
    """
    error = _fault_of(run, values)
    if isinstance(error, ParameterError):
        refusal = ParameterError(error.name, error.value, error.allowed, f"{error}{advice}")
        raise locate_error(run.path, run.inputs.content, refusal) from error
    if error is not None:
        raise error


def _fault_of(run: Run, values: Named) -> ParameterError | FileError | None:
    """Find out whether motions would be refused, without rolling them.

    run: :class:`runs.Run`, of which path, inputs, the last of t, and of the settings rtol, rest,
        unsteady and rested are read.
    values: name of an input -> number or (n,), for every input, in the units of the file.
    Returns None if the motions are allowed.  Else the error, which is not raised: a ParameterError
    for a roller, start, drive or setting that a motion refuses, and for ``unsteady`` or ``rested``
    where T_epsilon differs between motions; a FileError for a material.
    """
    content = run.inputs.filled(values)
    settings = run.settings
    try:
        roller = roller_of(run.path, content)
        for name in ("unsteady", "rested"):
            given = getattr(settings, name)
            if given is not False and isinstance(roller, Rollers) and roller.seconds:
                allowed = "left out, as T_epsilon is uncertain"
                return ParameterError(name, str(given).lower(), allowed)
        start = tuple(map(content["start"].get, START))
        options = SolverOptions(
            rtol=settings.rtol,
            rest=settings.rest,
            max_steps=1,  # nothing is integrated: the problem is made, which checks all
            resolve=None,
            unsteady=settings.unsteady,
            rested=settings.rested,
        )
        problem = make_problem(
            roller, start, drive=Drive(**drive_of(content)), end=run.t[-1], options=options
        )
        refuse_several_tables(problem.scene)
    except (ParameterError, FileError) as error:
        return error
    return None


def _digest(
    settings: RunSection, times: Floats, content: Named, materials: Named, inputs: Inputs
) -> str:
    """Return the ``digest`` of a :class:`runs.Run`.

    Comments and the order of keys do not change it, but that of the uncertain numbers: they take
    the random numbers in their order.

    settings: :class:`RunSection`, content of the section [run], of which n, method and block do not
    count.
    times: output times, (t,), in the unit of the file.
    content: name of a section, or ``preset`` -> content, as read; [run] is left out.
    materials: name of a section -> material of the median inputs, so that files that they name
        count too.
    inputs: :class:`.uncertain_inputs.Inputs`, whose columns of data files, names and numbers,
    count, and the order of its dimensions.
    Returns a SHA-256, 64 hexadecimal digits.
    """
    kept = msgspec.to_builtins(settings)
    for name in _NOT_IN_DIGEST:
        del kept[name]
    described = [
        kept,
        times.tolist(),
        {name: section for name, section in content.items() if name != "run"},
        [material_as_toml(material) for material in materials.values()],
        [
            [name, hashlib.sha256(column.tobytes()).hexdigest()]
            for name, column in inputs.columns.items()
        ],
        inputs.dimensions,
    ]
    # deterministic: keys in sorted order
    return hashlib.sha256(msgspec.msgpack.encode(described, order="deterministic")).hexdigest()


def correlated(path: Path, inputs: Inputs) -> Inputs:
    """Return the inputs with the Gaussian copula that the section [correlation] states; without it
    nothing is added.

    path: path of the run file, for errors.
    inputs: :class:`Inputs` of the run without correlations; ``content["correlation"]`` has a ->
        b -> correlation in (-1, 1) of the normal variables of which the inputs a and b are monotone
        functions.  A pair that is not given has correlation 0; a.b and b.a may both be given if
        they are equal.
    Returns new Inputs with ``correlated``, the names in [correlation] in the order of ``random``,
    and ``mixing``, the Cholesky factor of their matrix; without that section they are () and None.
    Raises FileError for a section of another form, a name without distribution, a value out of
    range, a.b that differs from b.a, or a matrix that is not positive definite.
    """
    section = inputs.content.get("correlation", {})
    random = inputs.random
    if not isinstance(section, dict):
        raise section_error(
            path,
            "",
            "correlation",
            f"correlation = {section!r:.40}: must be a section [correlation] with lines like "
            "V0.mu = 0.5",
        )
    pairs: dict[tuple[str, str], Any] = {}
    for a, row in section.items():
        if not isinstance(row, dict):
            problem = (
                f"{a!r} is one name, as it has quotes: write {a} without quotes"
                if "." in a
                else f"{a} = {row!r:.40} names one input: name two, as in V0.mu = 0.5"
            )
            raise section_error(path, "correlation", a, problem)
        pairs |= {(a, b): value for b, value in row.items()}
    names = tuple(name for name in random if any(name in pair for pair in pairs))
    matrix = np.eye(len(names))
    for (a, b), value in pairs.items():
        problem = ""
        if unknown := {a, b} - random.keys():
            name = a if a in unknown else b
            known = ", ".join(random) or "none"
            problem = f"{name!r} is no input with a distribution; the file has: {known}"
            problem += suggestion(name, random)
        elif a == b:
            problem = f"{a}.{b} names one input twice: name two different inputs"
        elif not is_real(value) or not -1.0 < value < 1.0:
            problem = f"{a}.{b} = {value!r:.40}: must be a number above -1 and below 1"
        elif pairs.get((b, a), value) != value:
            problem = f"{a}.{b} = {value!r}: must be equal to {b}.{a} = {pairs[b, a]!r:.40}"
        if problem:
            raise section_error(path, "correlation", a, problem)
        n, m = map(names.index, (a, b))
        matrix[n, m] = matrix[m, n] = value
    try:
        mixing: Any = np.linalg.cholesky(matrix) if names else None
    except np.linalg.LinAlgError:
        raise section_error(
            path,
            "",
            "correlation",
            "[correlation] these correlations contradict each other (their matrix must be positive "
            "definite): bring them nearer to 0",
        ) from None
    return replace(inputs, correlated=names, mixing=mixing)
