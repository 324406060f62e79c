"""Flow map of one scene: built once, kept on disk, and asked for any number of motions.

The tables are those of :mod:`viscoroll.kernels.flow.layout`.  They depend on alpha, kappa,
mu and j; gamma only scales time.  A map covers stick onsets at up to 2**20 times below a
highest speed, which is the next power of 16 (times a constant) above the speeds at hand.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact_law.parameters import Parameters
from ..core.blocks import flattened, run_blocks
from ..core.typed import Floats, Integers
from .flow_store import FlowMap, load, path_of, save
from .rolling import motions

#: a stated error is so many times the worst that was found on the sampled motions, and at least the floor (of the
#: speeds, the path, the energy lost), below which the integrator's own error shows
_MARGIN, _FLOOR = 4.0, np.array([1e-10, 5e-10, 1e-10])
_SAMPLED, _SAMPLE_TIMES = 100, 40
#: V, omega, x, angle, slip_loss, rolling_loss
_MEASURED = (0, 1, 2, 3, 6, 7)
#: distance and angle are differences of what is left to rest: of the path, their error is relative to the path so
#: far and to this share of the whole
_PATH_SHARE = 1e-5
#: maps kept in memory
_IN_MEMORY = 4
_BLOCK = 1 << 14
#: octaves that the highest speed is rounded up to
_OCTAVES = 4


def asked(scene: Parameters, speed: float) -> tuple[tuple[Any, ...], int]:
    """(parameters, octave) of the map for a scene and speeds up to ``speed`` > 0."""
    from ..kernels.flow.layout import OCTAVE_RANGE

    parameters = (scene.in_own_time()[0], scene.kappa, scene.mu, scene.j)
    octave = math.ceil((math.log2(scene.kappa) + math.log2(speed)) / _OCTAVES) * _OCTAVES
    return parameters, min(max(octave, OCTAVE_RANGE[0]), OCTAVE_RANGE[1])  # motions beyond find nothing there


def flow_map(scene: Parameters, speed: float, *, threads: int | None = None) -> FlowMap:
    """The map of a scene for speeds up to ``speed`` > 0: from memory, from disk, or built.

    A map on disk that is damaged is built again, with a RuntimeWarning; where the disk cannot
    be written the map is kept in memory only.
    """
    return _map(*asked(scene, speed), threads)


@lru_cache(_IN_MEMORY)
def _map(parameters: tuple[Any, ...], octave: int, threads: int | None) -> FlowMap:
    path = path_of(parameters, octave)
    found = load(path, parameters)
    if found is None:
        found = build(parameters, octave, threads)
        save(found, path)
    return found


def build(parameters: tuple[Any, ...], octave: int, threads: int | None = None) -> FlowMap:
    """Build the map for kappa V < 2**octave at stick onset, and measure its error."""
    from ..kernels.flow.layout import OCTAVES, SIZE
    from .flow_fill import fill

    made = FlowMap(parameters, octave - OCTAVES, np.zeros(SIZE), (math.inf,) * 3, "")
    problem = fill(made, threads)
    if problem:
        return replace(made, problem=problem)
    return replace(made, errors=_measure(made, octave, threads))


def _measure(made: FlowMap, octave: int, threads: int | None) -> tuple[float, ...]:
    """Largest errors against the integrator, times the margin, on motions spread over the map."""
    _, kappa, mu, _ = made.parameters
    rng = np.random.default_rng(20)
    size = 2.0 ** (octave - rng.uniform(0.0, 10.0, _SAMPLED)) / kappa
    angle = rng.uniform(0.0, 2.0 * math.pi, _SAMPLED)
    starts = size[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    near = starts[: _SAMPLED // 5]  # inside the stick zone, or close to it
    near[:, 1] = near[:, 0] * (1.0 + mu / kappa * rng.uniform(-0.5, 0.5, near.shape[0]))
    errors = np.zeros((_SAMPLED, 3))

    def work(start: int, stop: int) -> None:
        for n in range(start, stop):
            errors[n] = _error_of(made, *starts[n])

    run_blocks(work, _SAMPLED, 1, threads=threads)
    worst = np.maximum(_MARGIN * errors.max(axis=0), _FLOOR)
    return tuple(worst.tolist())


def _error_of(made: FlowMap, V0: float, omega0: float) -> tuple[float, ...]:
    """Largest relative errors of one motion: of the speeds (and the onset time), of distance and angle, of losses."""
    _, _, _, j = made.parameters
    decay, start = 1.0 / made.slow_rate, (np.array([V0]), np.array([omega0]))

    def flow(times: NDArray) -> Answer:
        return ask(made, 1.0, 0.0, *start, times, _MEASURED)

    at_rest = flow(np.array([0.0, 800.0 * decay]))
    onset = float(np.fmax(at_rest.onset[0], 0.0))
    stiff_time = _stiff_time(made, max(abs(V0), abs(omega0)))
    layer = np.geomspace(1e-5, 60.0, _SAMPLE_TIMES) * stiff_time
    late = np.linspace(0.1, 4.0, 6) * decay
    times = np.sort(np.concatenate([onset * np.array([0.3, 0.9]), onset + layer, onset + late]))
    found = flow(times)
    if at_rest.status[0] < 0 or found.status[0] < 0:
        return 0.0, 0.0, 0.0
    exact, how = motions(made.parameters, start, np.ones(1), times)
    out, true_onset = exact[list(_MEASURED), 0], how[0, 3]
    difference = np.abs(found.out[:, 0] - out)
    speed = np.maximum(np.abs(out[:2]).max(axis=0), np.finfo(float).tiny)  # both may have died out
    path = np.maximum.accumulate(np.abs(out[2:4]).max(axis=0)) + _PATH_SHARE * np.abs(at_rest.out[2:4, 0, 1]).max()
    energy = 0.5 * (V0 * V0 + j * omega0 * omega0)
    errors = [(difference[:2] / speed).max(), (difference[2:4] / path).max(), difference[4:].max() / energy]
    if onset > 0.0:
        errors[0] = max(errors[0], abs(onset - true_onset) / (onset + stiff_time))
    return tuple(float(error) if math.isfinite(error) else math.inf for error in errors)


def _stiff_time(made: FlowMap, speed: float) -> float:
    """1/k0 for an onset at about this speed, of those in the map."""
    from ..kernels.flow.layout import PLUS, views

    rates = views(made.table).entry[PLUS, :, 2]  # the constant of the second of a pair: at the middle of an octave
    octave = math.floor(math.log2(made.parameters[1] * speed)) - made.first
    return float(1.0 / rates[min(max(octave, 0), rates.size - 1)])


class Answer(NamedTuple):
    """Motions as arrays: outputs (rows, motions, times), and one entry a motion of the rest.

    ``status`` < 0 stands for a motion that is not in the map, whose other entries mean nothing.
    """

    out: Floats
    status: NDArray[np.int8]
    onset: Floats
    rest: Floats
    switches: Integers

    @classmethod
    def empty(cls, rows: int, count: int, times: int) -> Answer:
        """No motion answered yet."""
        return cls(
            np.empty((rows, count, times)), np.full(count, -1, np.int8), np.empty(count), np.empty(count),
            np.zeros(count, np.int64),
        )  # fmt: skip


def ask(
    chosen: FlowMap, gamma: float, rest: float, V0: NDArray, omega0: NDArray, times: NDArray, rows: tuple[int, ...],
    *, threads: int | None = 1, progress: str | None = None,
) -> Answer:  # fmt: skip
    """Roll motions by a map; ``rows`` as in ``kernels/flow/loop.py``, ``rest`` = 0 for none."""
    from ..kernels.flow.loop import flow_loop
    from ..kernels.flow.records import Flow

    V0, omega0, times = (flattened(array, array.shape) for array in (V0, omega0, times))
    count = np.broadcast_shapes(V0.shape, omega0.shape)[0]  # one of the two may be a single value
    answer = Answer.empty(len(rows), count, times.size)
    wanted = np.array(rows, np.int64)
    _, kappa, mu, j = chosen.parameters
    flow = Flow(chosen.table, chosen.first, kappa, mu, j, chosen.slow_rate)

    def work(start: int, stop: int) -> None:
        flow_loop(flow, gamma, rest, V0, omega0, times, wanted, answer, start, stop)

    run_blocks(work, answer.status.size, _BLOCK, threads=threads, progress=progress)
    return answer
