"""Tables of states with pressure and shear solved together (the coupled solution), and their files.

A table has a row of states at each of several speeds, at nodes of creep between which splines are
cubic.  Speeds run from a thousandth of the slowest rate of the bodies to ten times the fastest, in
equal steps of ln u, with the elastic limits at both ends; creeps from one onset of full slip over
the creep at which slip of the other sign opens to the other onset, in equal steps of the graded
coordinate t (:mod:`.coupled_splines`): -1 at the negative onset of full slip, 0 at that middle
creep, 1 at the positive onset.

Tables are made at first use, and their files are kept beside the compiled kernels.  A table depends
on mu and on the bodies, with the thickness divided by l0: kappa, gamma, j, load and radius change
it only through that ratio.
"""

import functools
import hashlib
import math
import pathlib
import sys
import threading
from typing import Any

import numpy as np

from ..core import Floats, ParameterError, check_integer, load_kept, run_blocks, save_kept
from ..kernels.numerics.cache_folder import cache_root, is_quiet
from ..kernels.numerics.jit import sources_digest
from ..laws import FIELDS, CoupledRows, LawTable, coupled_table, grade
from ..materials import lock_array, several_tables_error
from .assumptions import DUNDURS_LIMIT
from .coupled_pair import ELEMENTS, CoupledPair, CoupledRow, growth, pair_of_scene

# --- Tables of the coupled solution ---

#: Nodes of creepage: splines in the speed, not these, determine the error of motions (1e-7 at 33).
NODES = 27
#: Nodes in a decade of speed: those of bodies whose compliance changes little, and those added
#: where it is proportional to time.
_PER_DECADE = (5.0, 8.1)
#: Times in a decade at which the growth of the compliance is evaluated.
_LOOKS = 8
#: First node of speed times the longest retardation time, and last node times the shortest
#: relaxation time.
_SPEED_RANGE = (1e-3, 10.0)
#: Nodes of speed of elastic bodies, whose law does not depend on it.
_ELASTIC = np.array([0.5, 1.0, 2.0])
#: Points beside the nodes at which the error of a table is measured, and their seed.
_CHECKED = 64
_SEED = 20260103
#: The relative position of the middle creepage between the onsets is compared with its median over
#: so many rows, and may differ by this much, first coarsely, then finely: it changes by 0.01 in
#: half a decade, while outliers, up to six rows in sequence, differ by 0.2, and single ones, where
#: both ends slip, by 0.02, which made Q wrong by 1.5e-3 mu P.
_OUTLIERS = ((21, 0.03), (9, 0.005))
#: The position is then smoothed by parabolas through this number of rows: noise of 0.001, left by
#: the bisection, made Q wrong by up to 5e-4 mu P between rows; smoothed, it is by 2e-4.
_SMOOTHED = 7
#: kappa times the moment of the slip loss, divided by P R, below which a contact counts as one that
#: sticks: where it does, 1e-22 was found, where it does not, 1e-9 and more.
_STICKS = 1e-14


def coupled_law(
    scene: Any, *, nodes: tuple[int, int] | None = None, progress: bool = False
) -> LawTable:
    """Compute the table of the coupled solution of one scene, as a law.

    scene: dimensionless parameters of one material, alpha, kappa and mu, numbers.
    nodes: numbers of nodes of speed and of creepage, the second odd; None: 5 to 13 a decade of
        speed between the rates of the bodies, the more the faster their compliance grows, and 27
        (:data:`NODES`).
    progress: whether a progress bar is drawn on standard error, after one second.
    Returns the :class:`LawTable`, whose ``coupled`` rows state their errors.
    Raises ConvergenceError for a state that is not solved, and ParameterError for too few nodes.
    """
    rows = tabulate(pair_of_scene(scene), scene.mu, nodes, progress)
    return coupled_table(scene.alpha if scene.material is None else scene.material, rows)


def speed_nodes(pair: CoupledPair, count: int | None = None) -> Floats:
    """Return the nodes of u = kappa |V| of a table.

    pair: the bodies.
    count: number of nodes, >= 2; None: more the faster the compliance of the bodies grows.
    Returns ascending u, dimensionless, (n,); for elastic bodies three, whatever ``count`` is.
    """
    times = np.array([time for body in pair for time in body.T])
    if not times.size:
        return _ELASTIC
    # about the shortest relaxation time: retardation time times instantaneous compliance
    shortest = min(min(body.T) * body.instant for body in pair if body.T)
    low = _SPEED_RANGE[0] / times.max()
    high = _SPEED_RANGE[1] / shortest
    if count is None:
        decades = math.log10(high / low)
        looked = np.geomspace(1.0 / high, 1.0 / low, math.ceil(_LOOKS * decades))
        steepest = float(growth(pair, looked).max())
        count = math.ceil(decades * (_PER_DECADE[0] + _PER_DECADE[1] * steepest))
    return np.geomspace(low, high, count)


def tabulate(
    pair: CoupledPair, mu: float, nodes: tuple[int, int] | None = None, progress: bool = False
) -> CoupledRows:
    """Solve the rows of a table, on threads, and measure its errors.

    pair: the bodies.
    mu: coefficient of friction, > 0.
    nodes, progress: as in :func:`coupled_law`; 4 to 1000 nodes of speed, 9 to 1001 of creepage.
    Returns :class:`CoupledRows` with ``errors``: rows for u = 0, each node of u, and u infinite.
    Raises ConvergenceError for a state that is not solved, and ParameterError for ``nodes``.
    """
    count, across = (None, NODES) if nodes is None else nodes
    if count is not None:
        check_integer("nodes[0] (number of speeds)", count, 4, 1000)
    name = "nodes[1] (number of creepages)"
    if check_integer(name, across, 9, 1001) % 2 == 0:
        raise ParameterError(name, across, "odd, as one creepage lies in the middle")
    u = speed_nodes(pair, count)
    half = across // 2
    t = np.arange(-half, half + 1) / half  # 0 exactly in the middle
    speeds = np.concatenate([[0.0], u, [math.inf]])
    # reduced creepages of the middle, the negative and positive onset of full slip, free rolling
    edges = np.empty((speeds.size, 4))
    fields = np.empty((speeds.size, across, len(FIELDS)))
    # all rows of elastic bodies are equal: only the first is solved
    solved = 1 if u is _ELASTIC else speeds.size
    rows: list[Any] = [None] * solved

    def begin(n: int, _: int) -> None:
        rows[n] = row = CoupledRow(pair, float(speeds[n]), mu)
        edges[n, :3] = row.touch(), *row.onsets()

    def solve(n: int, _: int) -> None:
        edges[n], fields[n] = _solve_row(rows[n], float(edges[n, 0]), t)

    # two passes: the states of a row need its middle creepage, which is smoothed over all rows
    run_blocks(begin, solved, 1, progress="coupled solution, 1 of 2" if progress else None)
    edges[:solved, 0] = _without_outliers(edges[:solved, :3])
    run_blocks(solve, solved, 1, progress="coupled solution, 2 of 2" if progress else None)
    edges[solved:] = edges[0]
    fields[solved:] = fields[0]
    made = CoupledRows(mu, *map(lock_array, (u, t, edges, fields)))
    made.errors.update(measure_errors(made, pair))
    return made


def _without_outliers(edges: Floats) -> Floats:
    """Return the middle creepages of all rows, with outliers replaced by interpolation, smoothed.

    The middle creepage divides a row into two splines.  It is found by bisection of the zones of
    slip, which at single speeds yields another root.  Any creepage between the onsets is allowed,
    but splines in the speed require that it changes smoothly from row to row.
    edges: reduced creepages 2 kappa delta of the middle and of both onsets, (rows, 3).
    Returns the reduced middle creepages, (rows,).
    """
    from scipy import ndimage, signal

    middle, low, high = edges.T
    position = (middle - low) / (high - low)  # 0 and 1 at the onsets
    rows = np.arange(position.size)
    for neighbours, far in _OUTLIERS:
        good = np.abs(position - ndimage.median_filter(position, neighbours, mode="nearest")) <= far
        position = np.interp(rows, rows[good], position[good])
    if position.size >= _SMOOTHED:
        position = signal.savgol_filter(position, _SMOOTHED, 2)
    return low + (high - low) * position


def _solve_row(row: CoupledRow, middle: float, t: Floats) -> tuple[list[float], Floats]:
    """Solve one row of a table.

    row: the row, with kernels and onsets.
    middle: reduced creepage 2 kappa delta at which both splines of the row meet.
    t: nodes, -1 at the negative onset of full slip, 0 in the middle, 1 at the positive one, (m,).
    Returns ([reduced creepages of the middle, of both onsets and of free rolling], fields (m, 8) in
    the order of :data:`FIELDS`).  The middle of an elastic row is that of free rolling if nothing
    slips there, else ``middle``.
    Raises ConvergenceError for a state that is not solved.
    """
    low, high = row.onsets()
    fields = _row_fields(row, middle, t)
    free_t = _free_rolling_t(t, fields[:, 0])
    free = middle + ((low if free_t < 0.0 else high) - middle) * float(grade(free_t))
    if not 0.0 < row.u < math.inf:
        state = _fields(row, [free])[0]
        # kappa (Q delta - W_base - W_cylinder), from 2 kappa delta and works times 2 kappa
        friction = 0.5 * (row.mu * state[0] * free - state[6] - state[7])
        if friction <= _STICKS:
            # nothing slips there, and Q and M are 0 exactly: errors of the solution, up to 5e-5 of
            # mu P, are larger than all loads of a slow motion, which they would drive
            middle = free
            fields = _row_fields(row, middle, t)
            node = t.size // 2  # that of the middle creepage
            fields[node, 0] = 0.0
            shift = -fields[node, 1:3]
        else:
            # elastic bodies lose energy in slip alone: else the error of the spline would drive a
            # cylinder at rest, or keep it at rest; bodies that deform share the shift
            sides = {body.side for body in row.pair}
            deforms = np.array([side in sides for side in ("base", "cylinder")])
            found = _spline(t, fields[:, 1:3] @ deforms, free_t)(free_t)
            shift = np.where(deforms, (friction - found) / deforms.sum(), 0.0)
        # M_b + W_b, what the body loses, stays: kappa M_b in columns 1 and 2, 2 kappa W_b in 6 and
        # 7
        fields[:, 1:3] += shift
        fields[:, 6:8] -= 2.0 * shift
    return [middle, low, high, free], fields


def _row_fields(row: CoupledRow, middle: float, t: Floats) -> Floats:
    """Return the fields at the nodes of a row, (m, 8); arguments and errors as of
    :func:`_solve_row`.
    """
    low, high = row.onsets()
    creeps = middle + np.where(t < 0.0, low - middle, high - middle) * grade(t)
    return _fields(row, creeps, t)


def _fields(row: CoupledRow, creeps: Any, at: Any = None) -> Floats:
    """Return the fields of states of a row as one array.

    row, creeps, at: as in :meth:`.CoupledRow.states`, n states.
    Returns (n, 8), columns in the order of :data:`FIELDS`, dimensionless.
    Raises ConvergenceError for the first state that is not solved.
    """
    states = row.states(creeps, at)
    row.refuse_unsolved(states.status, creeps)
    return np.stack(states[: len(FIELDS)], axis=-1)


def _spline(t: Floats, values: Floats, side: float) -> Any:
    """Return the cubic spline of one row on one side of its middle, with slopes 0 at both ends.

    t, values: nodes of the row, as in :func:`_free_rolling_t`, and the values there, (m,) each.
    side: number whose sign selects the side: t <= 0 if it is negative, else t >= 0.
    Returns a function of t in that side, in the unit of ``values``.
    """
    from scipy import interpolate

    half = t.size // 2
    nodes = slice(0, half + 1) if side < 0.0 else slice(half, None)
    return interpolate.CubicSpline(t[nodes], values[nodes], bc_type="clamped")


def _free_rolling_t(t: Floats, Q: Floats) -> float:
    """Return the t of free rolling, at which the spline of one row has Q = 0.

    t: nodes of the row in the graded coordinate t of the creepage (-1: negative onset of full slip,
        0: middle creepage, 1: positive onset; :func:`.law_rows.grade`), ascending, (m,).
    Q: Q/mu at the nodes, (m,), dimensionless; it rises from about -1 to about 1.
    Returns t in (-1, 1), dimensionless.
    Raises ValueError of scipy if Q has no zero on the side of the middle that is searched, as its
    values at both ends of that side have one sign.
    """
    from scipy import optimize

    # Q rises with t: its zero lies below the middle if Q is positive there
    side = -1.0 if Q[t.size // 2] > 0.0 else 1.0
    return float(optimize.brentq(_spline(t, Q, side), *sorted((0.0, side)), xtol=1e-15))


def measure_errors(
    rows: CoupledRows,
    pair: CoupledPair,
    count: int = _CHECKED,
    seed: int = _SEED,
    elements: int = ELEMENTS,
) -> dict[str, float]:
    """Compare a table with solutions at random points: 3 of 8 near the middle creepage, the others
    anywhere between the onsets of full slip.

    rows: the table; ``errors`` are not read.
    pair: its bodies.
    count: number of points, eight at each speed, rounded up.
    seed: seed of the random points.
    elements: number of boundary elements of the solutions.
    Returns field -> largest absolute error, dimensionless; works are multiplied by 2 kappa.
    """
    from ..kernels.law.spline_law import look_up

    random = np.random.default_rng(seed)
    speeds = np.exp(random.uniform(np.log(rows.u[0]), np.log(rows.u[-1]), -(-count // 8)))
    draws = random.random((speeds.size, 8))
    worst = np.zeros((speeds.size, len(FIELDS)))

    def compare(n: int, _: int) -> None:
        """Write the largest differences at the n-th speed into ``worst[n]``."""
        u = float(speeds[n])
        draw = draws[n]
        row = CoupledRow(pair, u, rows.mu, elements)
        low, high = row.onsets()
        # edges of the rows between the limits of u = 0 and u infinite: the middle creepage
        middle = np.interp(math.log(u), np.log(rows.u), rows.edges[1:-1, 0])
        # three within 2.5 % of the distance of the onsets, where the two splines meet
        near = middle + 0.05 * (high - low) * (draw[:3] - 0.5)
        creeps = np.concatenate([near, low + (high - low) * draw[3:]])
        exact = _fields(row, creeps)
        found = look_up(rows.vector, np.full(creeps.size, u), creeps)
        worst[n] = np.abs(found - exact).max(axis=0)

    run_blocks(compare, speeds.size, 1)
    return dict(zip(FIELDS, worst.max(axis=0).tolist(), strict=True))


# --- Tables of the coupled solution that are made at first use ---

#: files kept; the one that was used longest ago goes first
_KEPT = 256
#: arrays of :class:`CoupledRows` in a file
_ARRAYS = "u", "t", "edges", "fields"
_lock = threading.Lock()


def is_coupled(scene: Any) -> bool:
    """Return whether shear acts on pressure so much that a scene needs the coupled solution.

    scene: :class:`.parameters.Parameters` of one material.
    Returns True where one is a layer, or where Dundurs' constant of half-spaces exceeds 0.05 in
    modulus, at long times or at once.
    """
    pair = pair_of_scene(scene)
    if any(math.isfinite(body.thickness) for body in pair):
        return True
    shares = [body.share for body in pair]
    at_once = [body.share * body.instant for body in pair]
    for parts in (shares, at_once):
        coupling = (part * body.sign * body.local for part, body in zip(parts, pair))
        if abs(math.fsum(coupling)) > DUNDURS_LIMIT * math.fsum(parts):
            return True
    return False


def refuse_several_tables(scene: Any) -> None:
    """Raise ParameterError where states with traction would need a table for each of several bodies
    or mu; nothing is made.

    scene: :class:`.parameters.Parameters` of one or several bodies, kappa and mu.
    """
    several = len(scene.material) if scene.material_array is not None else 1
    if scene.tabulated and scene._law is None and several * np.unique(scene.mu).size != 1:
        name = "material (of a layer also R or load)" if several > 1 else "mu"
        raise several_tables_error(name, "one value")


def stored_law(scene: Any) -> LawTable:
    """Return the law of a scene by the table of its bodies at its mu: that of this process, else
    that of the cache folder, else a new one, which both then keep.

    scene: :class:`.parameters.Parameters` of one material.
    A process that a user started shows a progress bar after one second where standard error is a
    terminal, unless $VISCOROLL_QUIET is 1.
    Raises ParameterError where there would be a table for each of several bodies or mu;
    ConvergenceError for a state that is not solved.
    """
    refuse_several_tables(scene)
    with _lock:
        rows = _stored_rows(pair_of_scene(scene), float(np.ravel(scene.mu)[0]))
    return coupled_table(scene.material, rows)


@functools.lru_cache(maxsize=32)
def _stored_rows(pair: CoupledPair, mu: float) -> CoupledRows:
    """Return the table of a pair at one mu, from its file, else solved and stored.

    The file is named by a hash of the sources on which the bits of a table depend, the bodies and
    mu; a damaged one is replaced with a warning.
    pair: the bodies.
    mu: coefficient of friction, > 0.
    Raises ConvergenceError for a state that is not solved.
    """
    digest = hashlib.sha256(f"{sources_digest()} {pair!r} {mu!r}".encode())
    for source in sorted(pathlib.Path(__file__).parent.glob("coupled*.py")):
        digest.update(source.read_bytes())
    path = cache_root() / "coupled" / f"{digest.hexdigest()[:20]}.npz"
    damaged = "the cached table of the coupled solution is damaged ({}) and is made again"
    if (found := load_kept(path, damaged, _read)) is None:
        found = tabulate(pair, mu, progress=not is_quiet() and sys.stderr.isatty())
        arrays = {name: getattr(found, name) for name in ("mu", *_ARRAYS)}
        save_kept(path, _KEPT, arrays | {"errors": list(found.errors.values())})
    return found


def _read(data: Any) -> CoupledRows:
    """Return the table in the arrays of a file; raises KeyError and ValueError for what is none."""
    arrays = {name: lock_array(data[name]) for name in _ARRAYS}
    errors = dict(zip(FIELDS, data["errors"].tolist(), strict=True))
    return CoupledRows(float(data["mu"]), **arrays, errors=errors)
