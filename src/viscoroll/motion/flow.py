"""Flow map of one scene: built once, kept on disk, and used to look up any number of motions.

A flow map is a set of tables from which the state of a free motion of the scene at any time follows
without integration. The tables are described in :mod:`viscoroll.kernels.motion.flow_layout`.  They
depend on alpha, kappa, mu and j; gamma only scales time.  A map covers onsets of partial slip at
kappa V
from 2**(octave - 20) to 2**octave.  2**octave is the next power of 16 above kappa times the highest
speed of the call, but at least 2**-16 and at most 2**14.

All is dimensionless.  The unit of time T is the material's own: T_epsilon of a material that is an
alpha, of a series one near its slow time (``Parameters.in_own_time``).  Speeds are divided by R/T,
and gamma is P T^2/(m R).
"""

import functools
import hashlib
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics import Parameters
from ..core import Floats, Integers, NDArray, broadcast_vector, load_kept, run_blocks, save_kept
from ..kernels.motion import flow_layout
from ..kernels.numerics.cache_folder import cache_root
from ..kernels.numerics.jit import sources_digest
from ..kernels.records import Flow, Motions
from ..laws import interleave_pairs, law_table
from ..materials import Prony
from .flow_tables import NODES, SPEEDS, fill_layers, fill_manifold
from .motion_problem import OUT_OF_RANGE, STOPS, FlowProblem, NoFlowMap, integrate_motions

# --- A flow map, and its file beside the compiled kernels ---

#: (material, kappa, mu, j), numbers, on which a map depends; the material is alpha, or a
#: :class:`Prony` series in its own unit of time
MapParameters = tuple[Any, float, float, float]
#: maps kept; the one that was used longest ago goes first
KEPT = 64


@dataclass(frozen=True)
class FlowMap:
    """Tables of the free motions of one scene, from which a motion is looked up without
    integration.

    Attributes
    ----------
    parameters : (alpha, or series in its own unit of time; kappa; mu; j), numbers.
    first : binary exponent: kappa V of the slowest tabulated onset of partial slip is 2**first.
    table : all tables in one vector, see ``kernels/motion/flow_layout.py``.
    errors : stated errors of (speeds, path, losses), four times the largest of 100 motions against
        the integrator at rtol 1e-12, measured when the map was built, at least 1e-10, 5e-10, 1e-10:
        of V and omega relative to the larger of the two; of distance and angle relative to the
        larger of the two so far (and to 1e-5 of that at rest); of slip and rolling loss relative to
        the initial energy.  Infinite where ``problem`` is not "".
    problem : why the scene has no map, or "".
    """

    parameters: MapParameters
    first: int
    table: Floats
    errors: tuple[float, ...]
    problem: str

    @property
    def slow_rate(self) -> float:
        """Decay rate of a small speed, -d ln V/d(gamma t) as V -> 0, a float, dimensionless.

        It is T_mean/(1 + j), with T_mean the slope dM/dV at V = 0 (:attr:`.Prony.T_mean`) and j the
        moment of inertia divided by m R^2; 0 for elastic bodies.
        """
        material, _, _, j = self.parameters
        return law_table(material).T_mean / (1.0 + j)


def folder() -> Path:
    """Return the path of the folder of the maps, named by the sources of kernels and modules that
    make and read them.

    It may not exist yet.
    """
    return cache_root() / f"flow-{_digest()}"


@functools.cache
def _digest() -> str:
    """Return a digest of all sources on which the bits of a map depend: kernels, materials and
    motions.

    Returns a text of the first 16 hexadecimal digits of the SHA-256; it is computed once in a
    process.
    """
    digest = hashlib.sha256(sources_digest().encode())
    for part in ("materials", "motion"):
        for path in sorted((Path(__file__).parents[1] / part).rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _numbers(parameters: MapParameters) -> tuple[float, ...]:
    """Return the parameters as numbers, by which a map is named and compared.

    parameters : (alpha or :class:`Prony` series, kappa, mu, j).
    Returns a flat tuple: (alpha, kappa, mu, j), or with a series (alpha, relaxation rates,
    strengths, kappa, mu, j).
    """
    material, *others = parameters
    if isinstance(material, Prony):
        return (material.alpha, *material.modes.a.tolist(), *material.modes.E.tolist(), *others)
    return parameters


def path_of(parameters: MapParameters, octave: int) -> Path:
    """Return the path of the file of a flow map, which may not exist.

    parameters : (alpha or :class:`Prony` series, kappa, mu, j).
    octave : the map covers kappa V < 2**octave at the onset of partial slip.
    Returns the path in :func:`folder`; its name is a digest of the parameters and the octave.
    """
    numbers = np.array((*_numbers(parameters), octave), np.float64)
    return folder() / (hashlib.sha256(numbers.tobytes()).hexdigest()[:20] + ".npz")


def load(path: Path, parameters: MapParameters) -> FlowMap | None:
    """Return the map in a file.

    The time of last change of the file is set to now if it can be: maps that were used last are
    kept.

    path : path of the file, as in :func:`path_of`.
    parameters : (alpha or :class:`Prony` series, kappa, mu, j) that the map must have.
    Returns the :class:`FlowMap`; None if there is no file that can be read, also if others may
    write to it or to a folder above it, or if one belongs to another user; None with a
    RuntimeWarning if its content is damaged or of other parameters.
    """

    def read(data: Any) -> FlowMap:
        """Return the :class:`FlowMap` in the arrays of a file.

        data: arrays by name.
        Raises ValueError for one of another scene, and KeyError for one that lacks an array.
        """
        if not np.array_equal(data["parameters"], _numbers(parameters)):
            raise ValueError("it was made for other parameters")
        return FlowMap(
            parameters=parameters,
            first=int(data["first"]),
            table=data["table"],
            errors=tuple(data["errors"].tolist()),
            problem=str(data["problem"]),
        )

    return load_kept(path, "the cached flow map cannot be used ({}) and is built again", read)


def save(new_map: FlowMap, path: Path) -> None:
    """Write a map, and delete the oldest maps of the folder beyond :data:`KEPT`.

    Nothing is raised if it cannot be written, or an old map not deleted (OSError), also if others
    may write to a folder above it: the map is then not on disk, or too many are.  The file has the
    fields of :class:`FlowMap`, with the parameters as in :func:`_numbers`, and a seal.

    new_map : the :class:`FlowMap`.
    path : path of the file, as in :func:`path_of`; it is replaced if it exists.
    """
    save_kept(path, KEPT, vars(new_map) | {"parameters": _numbers(new_map.parameters)})


# --- Its construction, and motions looked up in it ---

#: ratio of the stated error to the largest error of the sampled motions
_MARGIN = 4.0
#: least stated error of speeds, path and losses: below it the error of the integrator at rtol 1e-12
#: is visible
_FLOOR = np.array([1e-10, 5e-10, 1e-10])
#: motions on which the error of a new map is measured
_SAMPLE_SIZE = 100
#: output times of such a motion within its boundary layer
_SAMPLE_TIMES = 40
#: output rows that are measured: V, omega, x, angle, slip_loss, rolling_loss
_MEASURED_ROWS = (0, 1, 2, 3, 6, 7)
#: errors of distance and angle are divided by the path so far plus this fraction of the whole path,
#: since the map computes both as differences of the remaining path to rest
_PATH_SHARE = 1e-5
#: maps kept in memory
_MAPS_IN_MEMORY = 4
#: motions of one block of work: some milliseconds
_BLOCK = 1 << 14
#: the highest speed of a map is rounded up to a multiple of this number of octaves
_OCTAVE_STEP = 4


def map_key(scene: Parameters, speed: float) -> tuple[MapParameters, int]:
    """Return by what a flow map is found: the parameters that it depends on, and the speeds that it
    covers.

    scene : :class:`Parameters` of one scene, numbers; its material in its own time, kappa, mu and j
    are read.
    speed : highest speed, > 0 and finite, divided by R/T in the material's own unit of time T.
    Returns ((material, kappa, mu, j); octave): the map covers kappa V < 2**octave at the onset of
    partial slip.  The material is alpha, or the :class:`Prony` series in its own unit of time.  The
    octave is the least multiple of 4 with kappa ``speed`` <= 2**octave, but at least -16 and at
    most 14, the limits of the tables; a scene with faster motions has no map for those.
    """
    parameters = (scene.in_own_time()[0], scene.kappa, scene.mu, scene.j)
    octave = math.ceil((math.log2(scene.kappa) + math.log2(speed)) / _OCTAVE_STEP) * _OCTAVE_STEP
    # motions beyond these find nothing there
    return parameters, int(np.clip(octave, *flow_layout.OCTAVE_RANGE))


def flow_map(scene: Parameters, speed: float, *, threads: int | None = None) -> FlowMap:
    """Return the flow map of a scene: from memory, from disk, or built, which takes as long as some
    thousand motions.

    scene : :class:`Parameters` of one scene, numbers; gamma is ignored.
    speed : highest speed for which the map is made, > 0, dimensionless, in the material's own unit
    of time.  Beyond the limits of :func:`map_key` the map covers slower motions only.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    Returns the :class:`FlowMap`.  Nothing is raised if the scene has none: its ``problem`` then
    says why, and its stated errors are infinite.  Raises ParameterError where one is built with a
    number of threads that is no whole number >= 1.

    A damaged map on disk is built again, with a RuntimeWarning.  A new map is written to disk, that
    of a scene without one too; if that fails it is kept in memory alone.
    """
    return _map(*map_key(scene, speed), threads)


@functools.lru_cache(_MAPS_IN_MEMORY)
def _map(parameters: MapParameters, octave: int, threads: int | None) -> FlowMap:
    """Return a flow map from memory, from disk, or built and written to disk; the last four stay in
    memory.

    parameters : (material, kappa, mu, j), numbers; the material is alpha, or a :class:`Prony`
    series in its own unit of time.
    octave : the map covers kappa V < 2**octave at the onset of partial slip.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    Returns the :class:`FlowMap`, as :func:`build_map` does, and raises as it does; one of
    :data:`_MAPS_IN_MEMORY` for equal arguments is returned again.
    """
    path = path_of(parameters, octave)
    found = load(path, parameters)
    if found is None:
        found = build_map(parameters, octave, threads)
        save(found, path)
    return found


def build_map(parameters: MapParameters, octave: int, threads: int | None = None) -> FlowMap:
    """Build the flow map of a scene and measure its error; nothing is written to disk.

    parameters : (material, kappa, mu, j), numbers; the material is alpha, or a :class:`Prony`
    series in its own unit of time.
    octave : the map covers kappa V < 2**octave at the onset of partial slip.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    Returns a :class:`FlowMap`.  If the scene has none, as an elastic one (alpha = 1), its
    ``problem`` says why, its errors are infinite, and its table is incomplete.
    Raises ParameterError for a number of threads that is no whole number >= 1, unless the scene is
    elastic.
    """
    new_map = FlowMap(
        parameters,
        first=octave - flow_layout.OCTAVES,  # exponent of the lowest octave
        table=np.zeros(flow_layout.SIZE),
        errors=(math.inf,) * 3,
        problem="",
    )
    if new_map.slow_rate == 0.0:
        return replace(new_map, problem="an elastic material has no rolling resistance")
    material, kappa, mu, j = parameters
    problem = FlowProblem(
        material=material,
        kappa=kappa,
        mu=mu,
        j=j,
        law=law_table(material).record,
        slow_rate=new_map.slow_rate,
        threads=threads,
    )
    parts = flow_layout.views(new_map.table)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused
            _fill_full_slip(problem, parts)
            slow = fill_manifold(problem, parts)
            for family, sign in ((flow_layout.PLUS, 1.0), (flow_layout.MINUS, -1.0)):
                fill_layers(
                    problem,
                    sign,
                    new_map.first,
                    slow,
                    parts.asymptote[family],
                    parts.layer[family],
                )
    except NoFlowMap as reason:
        return replace(new_map, problem=str(reason))
    return replace(new_map, errors=_measure_errors(new_map, octave, threads))


def _fill_full_slip(problem: FlowProblem, parts: flow_layout.FlowTables) -> None:
    """Fill the tables of full slip, V > 0 and V < 0, from the equation V' = +-mu - M/2 in time
    gamma t.

    problem : the :class:`FlowProblem`.
    parts : :class:`FlowTables`, views of the tables, of which ``slide``, ``after`` and ``onset``
    are written.
    Raises :class:`NoFlowMap`, with the tables incomplete: for the reason STOPS where at some speed
    the rolling resistance can hold the sliding cylinder, or nearly can, and where the speed at the
    onset of partial slip is no unique function of the quantity that is constant while sliding; for
    OUT_OF_RANGE where numbers leave the range of doubles.
    """
    _, kappa, mu, j, *_ = problem
    V = SPEEDS.x / kappa
    # below the lowest speed V' is +-mu: T and X from rest to there are V/mu and V^2/(2 mu)
    least = 2.0**flow_layout.LOW / kappa
    state = problem.contact_states(V)
    # |omega - V| at the onset of partial slip
    limit = state[flow_layout.DELTA_STAR] * V
    for n, sign in enumerate((1.0, -1.0)):
        rate = mu - sign * 0.5 * state[flow_layout.MOMENT]
        if not np.isfinite(limit / rate).all():
            raise NoFlowMap(OUT_OF_RANGE)
        if not (rate > 0.0).all():
            raise NoFlowMap(STOPS)
        half = SPEEDS.half / kappa
        T = NODES.integrals(1.0 / rate, half, least / mu)
        X = NODES.integrals(V / rate, half, 0.5 * least * least / mu)
        # |I| at an onset at this speed, where omega = V + limit; I = V - j omega - 2 mu T stays
        # constant while sliding
        slip = 2.0 * mu * T - V * (1.0 - j) + sign * j * limit
        # increasing from 0: one speed at onset for each |I|
        if not (np.diff(slip.ravel(), prepend=0.0) > 0.0).all():
            raise NoFlowMap(STOPS)
        time = NODES.powers(T)
        path = NODES.powers(X)
        parts.slide[n] = np.hstack([interleave_pairs(time, NODES.powers(limit)), path])
        # nearly held: the inverse would end before the speeds that are served; the sum of powers is
        # T at the end of the third octave from the top, the highest one that is served
        if not kappa * mu * time[-3].sum() < 2.0 ** (flow_layout.HIGH - 1):
            raise NoFlowMap(STOPS)
        # over kappa mu |T|, with the octaves of kappa V
        parts.after[n] = NODES.powers(SPEEDS.inverse(time, SPEEDS.x / (kappa * mu)) / kappa)
        # over kappa |I|/(1 + j); u is kappa |V| at onset
        u = SPEEDS.inverse(NODES.powers(slip), SPEEDS.x * (1.0 + j) / kappa)
        V_on, T_on, X_on = (
            NODES.powers(value)
            for value in (u / kappa, SPEEDS.value(time, u), SPEEDS.value(path, u))
        )
        parts.onset[n] = np.hstack([interleave_pairs(V_on, T_on), X_on])


def _measure_errors(new_map: FlowMap, octave: int, threads: int | None) -> tuple[float, ...]:
    """Measure the errors of a new map on 100 random motions against the integrator at rtol 1e-12.

    The random numbers are the same for every map; they are scaled to the speeds of the map.

    new_map : the :class:`FlowMap`, with all tables.
    octave : the map covers kappa V < 2**octave at the onset of partial slip; the starts lie in the
    ten octaves below.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    Returns four times the largest relative errors: (of speeds and onset time; of distance and
    angle; of slip and rolling loss), floats, at least 1e-10, 5e-10, 1e-10, infinite if a number is
    not finite.  Errors of V and omega are divided by the larger of the two, that of the onset time
    by that time (and the relaxation time there), those of distance and angle by the larger so far,
    those of losses by the energy at the start.  Motions that the map does not contain count as
    exact.
    """
    _, kappa, mu, _ = new_map.parameters
    rng = np.random.default_rng(20)
    size = 2.0 ** (octave - rng.uniform(0.0, 10.0, _SAMPLE_SIZE)) / kappa
    angle = rng.uniform(0.0, 2.0 * math.pi, _SAMPLE_SIZE)
    starts = size[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    near = starts[: _SAMPLE_SIZE // 5]  # inside the stick zone, or close to it
    # ``near`` is a view: this changes ``starts``
    near[:, 1] = near[:, 0] * (1.0 + mu / kappa * rng.uniform(-0.5, 0.5, near.shape[0]))
    errors = np.zeros((_SAMPLE_SIZE, 3))

    def work(n: int, stop: int) -> None:
        errors[n] = _motion_errors(new_map, starts[n, :, None])

    run_blocks(work, _SAMPLE_SIZE, 1, threads=threads)
    return tuple(np.maximum(_MARGIN * errors.max(axis=0), _FLOOR).tolist())


def _motion_errors(new_map: FlowMap, start: Floats) -> Floats:
    """Return the largest relative errors of one motion of a new map, against the integrator, at
    times from its onset on.

    Most of the times lie in the boundary layer after the onset of partial slip, two before the
    onset, and the last ones at four times the time in which V falls by e at low speeds.

    new_map : the :class:`FlowMap`, with all tables.
    start : V0 and omega0, not both 0, dimensionless, (2, 1).
    Returns (error of V and omega divided by the larger of the two, or error of the onset time
    divided by that time and the relaxation time there, if larger; error of distance and angle,
    divided by the larger so far and 1e-5 of that at rest; error of both losses, divided by the
    energy at the start), (3,).  An error that is not finite is infinite; all are 0 for a motion
    outside the map.
    """
    V0, omega0 = start
    decay = 1.0 / new_map.slow_rate

    def flow(times: NDArray) -> "FlowResult":
        """Look the motion up in the new map with gamma = 1.

        times : output times, (times,), dimensionless, ascending.
        Returns a :class:`FlowResult` of one motion with the rows V, omega, x, angle, slip_loss,
        rolling_loss.
        """
        return look_up_ensemble(
            new_map,
            Motions(gamma=1.0, rest=0.0, V0=V0, omega0=omega0, t=times, rows=_MEASURED_ROWS),
        )

    # 800 decay times: V has fallen below the smallest double
    at_rest = flow(np.array([0.0, 800.0 * decay]))
    # NaN, of a motion that starts in partial slip, becomes 0
    onset = float(np.fmax(at_rest.onset[0], 0.0))
    stiff_time = _stiff_time(new_map, np.abs(start).max())
    layer = np.geomspace(1e-5, 60.0, _SAMPLE_TIMES) * stiff_time
    late = np.linspace(0.1, 4.0, 6) * decay
    times = np.sort(np.concatenate([onset * np.array([0.3, 0.9]), onset + layer, onset + late]))
    found = flow(times)
    if at_rest.status[0] < 0 or found.status[0] < 0:
        return np.zeros(3)
    exact, true_onset = integrate_motions(new_map.parameters, start, np.ones(1), times)
    out = exact[list(_MEASURED_ROWS), 0]
    difference = np.abs(found.out[:, 0] - out)
    speed = np.maximum(np.abs(out[:2]).max(axis=0), np.finfo(float).tiny)  # both may have died out
    path = (
        np.maximum.accumulate(np.abs(out[2:4]).max(axis=0))
        + _PATH_SHARE * np.abs(at_rest.out[2:4, 0, 1]).max()
    )
    energy = 0.5 * (V0 * V0 + new_map.parameters[3] * omega0 * omega0).item()
    errors = [
        (difference[:2] / speed).max(),
        (difference[2:4] / path).max(),
        difference[4:].max() / energy,
    ]
    if onset > 0.0:
        errors[0] = max(errors[0], abs(onset - true_onset.item()) / (onset + stiff_time))
    return np.where(np.isfinite(errors), errors, math.inf)


def _stiff_time(new_map: FlowMap, speed: float) -> float:
    """Return the time 1/k0 in which omega - V relaxes after the onset of partial slip near a speed.

    It is taken at the middle of the octave in which the speed lies, so that it is off by a factor
    of up to about 1.5.

    new_map : the :class:`FlowMap`, from whose tables it is read.
    speed : magnitude of the speed at onset, > 0, dimensionless; beyond the tables their first or
    last octave counts.
    Returns the time gamma t, a float > 0, dimensionless.
    """
    # the constant of the second of a pair: at the middle of an octave
    rates = flow_layout.views(new_map.table).asymptote[flow_layout.PLUS, :, 2]
    octave = math.floor(math.log2(new_map.parameters[1] * speed)) - new_map.first
    return float(1.0 / rates[min(max(octave, 0), rates.size - 1)])


class FlowResult(NamedTuple):
    """Motions as arrays, dimensionless.

    out : quantities, (rows, motions, times), float64.
    status : code of the :class:`MotionStatus` of each motion, (motions,), int8; below 0 for a
    motion without a result, as it is outside the map or was not computed yet, whose other entries
    are undefined.
    onset, rest : times from the start to the onset of partial slip and to rest, (motions,); NaN
    where there is none up to the last output time.
    switches : number of changes of regime, (motions,), int64.
    """

    out: Floats
    status: NDArray[np.int8]
    onset: Floats
    rest: Floats
    switches: Integers

    @classmethod
    def empty(cls, rows: int, count: int, times: int) -> "FlowResult":
        """Return arrays for motions of which none is computed yet: status -1, 0 switches, all else
        undefined.

        rows : number of quantities.
        count : number of motions.
        times : number of output times.
        Returns a :class:`FlowResult` of new arrays.
        """
        onset, rest = np.empty((2, count))
        status = np.full(count, -1, np.int8)
        return cls(np.empty((rows, count, times)), status, onset, rest, np.zeros(count, np.int64))


def look_up_ensemble(
    chosen: FlowMap, motions: Motions, *, threads: int | None = 1, progress: str | None = None
) -> FlowResult:
    """Compute motions from the tables of a flow map.

    chosen : the :class:`FlowMap`, with all tables (its ``problem`` is "").
    motions : :class:`Motions`: (gamma; threshold of rest, 0 for none; V0; omega0, (1,) or (n,);
    output times, (times,), ascending; a tuple of the indices of the quantities in V, omega, x,
    angle, delta, regime, slip_loss, rolling_loss), dimensionless, in the unit of time of the map's
    material.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
    available.
    progress : title of a progress bar, None for none.
    Returns the n motions as a :class:`FlowResult`, whose quantities are in the order of the
    indices, dimensionless, in the same unit of time; those outside the map have a status below 0,
    and their other entries are undefined.
    """
    from ..kernels.motion.flow_loop import look_up_motions

    # in their own lengths, but contiguous and read-only, as kernels are compiled for
    V0, omega0, times = (
        broadcast_vector(a, a.shape) for a in (motions.V0, motions.omega0, motions.t)
    )
    count = np.broadcast(V0, omega0).size  # one of the two may be a single value
    result = FlowResult.empty(len(motions.rows), count, times.size)
    motions = motions._replace(V0=V0, omega0=omega0, t=times, rows=np.array(motions.rows, np.int64))
    _, kappa, mu, j = chosen.parameters
    flow = Flow(
        table=chosen.table,
        first=chosen.first,
        kappa=kappa,
        mu=mu,
        j=j,
        slow_rate=chosen.slow_rate,
    )
    run_blocks(
        functools.partial(look_up_motions, flow, motions, result),
        count,
        _BLOCK,
        threads=threads,
        progress=progress,
    )
    return result
