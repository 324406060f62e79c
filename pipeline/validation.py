"""Is what the package computes what the paper's equations say?  :func:`validate` ->
:class:`Report`.

Read in this order: states and stresses (contact law), an integrator of its own and the motions
that it is for; rows of files are those of ``viscoroll tables validate``.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from tqdm import tqdm

from viscoroll.contact_mechanics.contact_states import Values, contact
from viscoroll.contact_mechanics.stress import stress
from viscoroll.core.errors import ConvergenceError
from viscoroll.motion.roll import roll
from viscoroll.presets import PAPER_SECTION_5, PAPER_SECTION_5_ROUNDED, PAPER_STARTS
from viscoroll.rollers import Scene
from viscoroll.tables.law_dataset import Check, Report, check_table

# --- method "table" against method "direct": random states, the paper's motions ---

FIELDS = ("lam", "epsilon", "delta_star", "beta", "Q", "M")
#: Field -> (largest difference allowed, its unit in words).  lam and epsilon: what the rows of the
#: law state of them (docs/accuracy.md).  Else the rows are good to 2e-15, and these are roundings
#: of the printed forms, with kernels/law/printed_law.py's measured figures times three or four.
ALLOWED = {
    "lam": (1.5e-14, "relative"),
    "epsilon": (3e-14, "divided by max(1, epsilon)"),
    "delta_star": (2e-15, "relative"),
    # stated as lam is, whose error in the octave of alpha from 20 to 35 enters it: 1.005e-14
    # against 50 digits
    "beta": (1.5e-14, "absolute"),
    # K1/K0, up to 1e3 at kappa V = 1e3, magnifies the rounding of the bracket of Eq. (15)
    "Q": (4e-13, "over mu"),
    # kappa V up to 1e3 magnifies the rounding of lam^2 - 1/alpha in Eq. (16)
    "M": (6e-13, "times kappa"),
}
_SHARE_ELASTIC = 0.02


def random_states(count: int, seed: int) -> tuple[Scene, NDArray, NDArray]:
    """Scene arrays, V and delta of either sign.

    alpha in [1, 1e4] (some exactly 1), kappa V in [1e-3, 1e3], kappa in [1, 100], mu in
    [0.01, 1], all log-uniform.  s = |delta|/delta_star: logarithmic toward 0 and toward 1
    (from 1e-6), uniform in [0, 1.5], and exactly 0 or 1, a quarter each.
    """
    rng = np.random.default_rng(seed)

    def log_uniform(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    alpha = np.where(rng.random(count) < _SHARE_ELASTIC, 1.0, log_uniform(1.0, 1e4))
    scene = Scene(alpha, log_uniform(1.0, 100.0), log_uniform(0.01, 1.0))
    V = log_uniform(1e-3, 1e3) / scene.kappa * rng.choice([-1.0, 1.0], count)
    toward_0 = log_uniform(1e-6, 0.5)
    toward_1 = 1.0 - log_uniform(1e-6, 0.5)
    kinds = (toward_0, toward_1, rng.uniform(0.0, 1.5, count), rng.choice([0.0, 1.0], count))
    s = np.choose(rng.integers(len(kinds), size=count), kinds) * rng.choice([-1.0, 1.0], count)
    return scene, V, s * contact(scene, V, delta=0.0, fields="delta_star").delta_star


def differences(table: Values, direct: Values, scene: Scene) -> dict[str, float]:
    """Largest difference of each of :data:`FIELDS` between two methods, in the units of
    :data:`ALLOWED`.
    """
    units = {
        "lam": table.lam,
        "epsilon": np.maximum(table.epsilon, 1.0),
        "delta_star": table.delta_star,
        "beta": 1.0,
        "Q": scene.mu,
        "M": 1.0 / np.asarray(scene.kappa),
    }
    return {
        name: np.max(np.abs(getattr(table, name) - getattr(direct, name)) / unit)
        for name, unit in units.items()
    }


def _checks(where, worst, sample):
    return [
        Check(f"{where}: {name}", worst[name], allowed, f"{unit}; table against direct, {sample}")
        for name, (allowed, unit) in ALLOWED.items()
    ]


def random_state_checks(count: int, seed: int) -> list[Check]:
    """Both methods at ``count`` random states."""
    scene, V, delta = random_states(count, seed)
    table = contact(scene, V, delta=delta, fields=FIELDS)
    direct = contact(scene, V, delta=delta, fields=FIELDS, method="direct")
    return _checks("random states", differences(table, direct, scene), f"{count} states")


def along_motion_checks(times: int) -> list[Check]:
    """Both methods at ``times`` states of each of IC1-IC3, with both sets of the paper's
    parameters.
    """
    worst = dict.fromkeys(FIELDS, 0.0)
    for scene in (PAPER_SECTION_5, PAPER_SECTION_5_ROUNDED):
        for V0, omega0 in PAPER_STARTS.values():
            motion = roll(scene, V0, omega0, np.linspace(0.0, 4e-3, times))
            found = differences(
                motion.contact(FIELDS), motion.contact(FIELDS, method="direct"), scene
            )
            worst = {name: np.maximum(worst[name], found[name]) for name in FIELDS}  # a NaN stays
    return _checks("along IC1-IC3", worst, f"{times} times a motion")


# --- closures of the stresses, Eqs. (11)-(13): load, Q and M of Eqs. (15), (16) ---

#: Roundings of the quadrature's 312 terms; 1.3e-14 seen over 200 states.
CLOSURE_ALLOWED = 1e-13
_PANELS = 26
_NODES = 12


def panels(low: float, high: float) -> tuple[NDArray, NDArray]:
    """Nodes and weights for square roots at both ends: the angle, in panels that halve toward the
    ends.
    """
    halving = 0.5 * np.pi * 0.5 ** np.arange(_PANELS // 2)
    edges = np.concatenate([[0.0], halving[::-1], np.pi - halving[1:], [np.pi]])
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    width = np.diff(edges)[:, None]
    angle = (edges[:-1, None] + 0.5 * width * (1.0 + node)).ravel()
    half = 0.5 * (high - low)
    return low + 2.0 * half * np.sin(0.5 * angle) ** 2, (
        0.5 * width * weight
    ).ravel() * half * np.sin(angle)


def closures(scene: Scene, V: float, delta: float) -> dict[str, float]:
    """Int p dx, Int tau dx and Int x p dx less load, Q and M, over the load (x in l0: its moment
    arm is l0).
    """
    c = contact(scene, V, delta=delta)
    # for V < 0 the contact is mirrored: "front" is the edge ahead of the axis
    ahead = -1.0 if V < 0.0 else 1.0
    rear = 0.5 * c.lam * (c.epsilon - 1.0)
    front = 0.5 * c.lam * (c.epsilon + 1.0)
    stick = front - c.lam * c.beta
    load = 1.0 / (32.0 * scene.kappa)
    x, weight = panels(rear, front)
    p = stress(scene, ahead * x, V, delta=delta).p
    shear = 0.0
    for low, high in ((rear, stick), (stick, front)):
        at, share = panels(low, high)
        shear += share @ stress(scene, ahead * at, V, delta=delta).tau
    return {
        "load": float(weight @ p / load - 1.0),
        "Q": float(shear / load - c.Q),
        "M": float(weight @ (ahead * x * p) / load - scene.kappa * c.M),
    }


def stress_checks(count: int, seed: int) -> list[Check]:
    """The closures at ``count`` random states."""
    scene, V, delta = random_states(count, seed)
    found = [
        closures(Scene(scene.alpha[i], scene.kappa[i], scene.mu[i]), float(V[i]), float(delta[i]))
        for i in range(count)
    ]
    meaning = {"load": "Int p dx = P", "Q": "Int tau dx = Q", "M": "Int x p dx = M"}
    return [
        # np.max: the max of Python may lose a NaN
        Check(
            f"stress: {name}",
            np.max([abs(one[name]) for one in found]),
            CLOSURE_ALLOWED,
            f"divided by the load; {text}, {count} states",
        )
        for name, text in meaning.items()
    ]


# --- Eq. (22) by scipy's integrators on the printed contact law ---

#: The tightest that run smoothly; delta's absolute one is the noise of Q as printed, 1e-16 mu/(4
#: kappa) and more.
_SLIDING_RTOL = 1e-12
_SLIDING_ATOL = 1e-13
_STICKING_RTOL = 1e-13
_STICKING_ATOL = 1e-16
_MOST_PHASES = 100


class DirectMotion(NamedTuple):
    """V and omega at the times asked for, and the first change from full to partial slip (NaN:
    none).
    """

    V: NDArray
    omega: NDArray
    onset_time: float


def roll_direct(scene: Scene, V0: float, omega0: float, t: NDArray) -> DirectMotion:
    """Motion from (V0, omega0) != (0, 0) at ascending times ``t``, on root solves of the printed
    equations.

    Full slip: unknowns (V, omega), DOP853.  Partial slip: (ln |V|, delta), LSODA, because
    with (V, omega) the slip omega - V drowns in rounding as V falls.  The regime is carried
    as state and changes only at events that look one way.

    Raises
    ------
    ConvergenceError
        If scipy's integrator gives up, or a motion changes its regime without end.

    Notes
    -----
    On IC1-IC3 down to |V| = 1e-6 it differs from :func:`viscoroll.roll` at its tightest
    tolerance by less than 1e-9 of the speed (``tests/validation/test_validation.py``).
    """
    V = np.full(t.size, np.nan)
    omega = np.full(t.size, np.nan)
    now = 0.0
    state = (float(V0), float(omega0))
    onset_time = np.nan
    sticking = abs(omega0 - V0) < _limit(scene, float(V0))
    for _ in range(_MOST_PHASES):
        phase = _stick if sticking else _slide
        solution, speeds = phase(now, t[-1], state, scene)
        reached = solution.t[-1]
        inside = (t >= now) & (t <= reached)
        if inside.any():
            V[inside], omega[inside] = speeds(solution.sol(t[inside]))
        if solution.status != 1:
            return DirectMotion(V, omega, onset_time)
        V_reached, omega_reached = speeds(solution.y[:, -1])
        now = reached
        state = (float(V_reached), float(omega_reached))
        sticking = not sticking
        if sticking and np.isnan(onset_time):
            onset_time = now
    raise ConvergenceError(f"direct motion: more than {_MOST_PHASES} changes of regime")


def _law(scene, V, delta):
    """(Q, M, delta_star), as printed."""
    found = contact(scene, V, delta=delta, fields=("Q", "M", "delta_star"), method="direct")
    return float(found.Q), float(found.M), float(found.delta_star)


def _limit(scene, V):
    """The slip |omega - V| at which stick ends."""
    return _law(scene, V, 0.0)[2] * abs(V)


def _slide(now, end, state, scene):
    """Full slip from ``state`` (V, omega) to the onset of stick or the end."""
    sigma = float(np.sign(state[1] - state[0]))

    def rates(_, y):
        M = _law(scene, y[0], 0.0)[1]
        return scene.gamma * (sigma * scene.mu - 0.5 * M), -scene.gamma / scene.j * (
            sigma * scene.mu + 0.5 * M
        )

    def onset(_, y):
        return sigma * (y[1] - y[0]) - _limit(scene, y[0])

    return _solve(
        rates, now, end, state, onset, -1.0, "DOP853", _SLIDING_RTOL, _SLIDING_ATOL
    ), lambda y: (y[0], y[1])


def _stick(now, end, state, scene):
    """Partial slip from ``state`` (V, omega) to the return of full slip or the end, seen with V >
    0.
    """
    direction = np.sign(state[0])
    speed = abs(state[0])
    start = (np.log(speed), (state[1] - state[0]) / state[0])

    def rates(_, y):
        V = np.exp(y[0])
        delta = y[1]
        Q, M, _ = _law(scene, V, delta)
        rate = scene.gamma * (Q - 0.5 * M) / V
        return rate, -scene.gamma * (Q + 0.5 * M) / (scene.j * V) - (1.0 + delta) * rate

    def slip(_, y):
        return abs(y[1]) - _law(scene, np.exp(y[0]), 0.0)[2]

    def speeds(y):
        V = direction * np.exp(y[0])
        return V, V * (1.0 + y[1])

    return _solve(
        rates, now, end, start, slip, 1.0, "LSODA", _STICKING_RTOL, _STICKING_ATOL
    ), speeds


def _solve(rates, now, end, start, event, direction, method, rtol, atol):
    event.terminal = True
    event.direction = direction
    solution = solve_ivp(
        rates, (now, end), start, method, events=event, dense_output=True, rtol=rtol, atol=atol
    )
    if solution.status < 0:
        raise ConvergenceError(
            f"direct motion: {method} gave up at t = {solution.t[-1]:.6g}: {solution.message}"
        )
    return solution


# --- motions of roll against these ---

#: What the package promises at rtol 1e-8, relative to max(|V|, |omega|), down to |V| = 1e-6.
SPEED_ALLOWED = 1e-7
#: A tenth of rtol: 1e-11 seen where the motion starts in full slip, 1.2e-10 where it comes back to
#: it.
ONSET_ALLOWED = 1e-9
RTOL = 1e-8
_LEAST_SPEED = 1e-6
#: Friction too weak for the slow manifold: the stick zone vanishes again, V turns its sign while
#: sliding.
_SLIP_RETURNS = Scene(alpha=11.0, kappa=2.91, mu=0.01, gamma=1.1e4, j=0.5)


def motion_checks(times: int) -> list[Check]:
    """IC1-IC3 down to |V| = 1e-6, and a motion in which full slip returns, at ``times`` times
    each.
    """
    cases = {name: (PAPER_SECTION_5_ROUNDED, *start) for name, start in PAPER_STARTS.items()}
    cases["slip returns"] = (_SLIP_RETURNS, 1.0, 1.0)
    return [check for name, case in cases.items() for check in _compare(name, *case, times)]


def _compare(name, scene, V0, omega0, times):
    end = roll(scene, V0, omega0, np.array([1.0]), rtol=RTOL, rest=_LEAST_SPEED).rest_time
    motion = roll(scene, V0, omega0, np.linspace(0.0, end, times), rtol=RTOL)
    direct = roll_direct(scene, V0, omega0, motion.t)
    size = np.maximum(np.abs(direct.V), np.abs(direct.omega))
    onset = abs(motion.onset_time / direct.onset_time - 1.0)
    versus = f"roll at rtol {RTOL:g} against direct solves"
    return [
        *(
            Check(
                f"motion {name}: {quantity}",
                # a NaN on either side must fail the check
                float(np.max(np.abs(getattr(motion, quantity) - getattr(direct, quantity)) / size)),
                SPEED_ALLOWED,
                f"divided by max(|V|, |omega|) >= 1e-6; {versus}",
            )
            for quantity in ("V", "omega")
        ),
        Check(f"motion {name}: onset time", onset, ONSET_ALLOWED, f"relative; {versus}"),
    ]


# --- all of it ---


def validate(
    tables: tuple[xr.Dataset, ...] = (),
    *,
    states: int = 200_000,
    stress_states: int = 50,
    table_points: int = 100_000,
    times: int = 400,
    seed: int = 0,
    progress: bool = False,
) -> Report:
    """Compare the table method, the stresses, table files and motions with the printed equations.

    Parameters
    ----------
    tables : of :func:`viscoroll.tables.load` or ``build``; each is checked at its nodes and off
    them.
    states : random states at which method "table" meets method "direct".
    stress_states : random states at which the stresses are integrated.
    table_points : random nodes, and as many points between nodes, of each table.
    times : compared times a motion.
    seed : of everything random.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    Report
        ``ok``, ``checks``, a printed table by ``str``.

    Raises
    ------
    FileError
        A table that does not state its errors.
    ConvergenceError
        If a direct solve or the comparison's own integrator gives up.

    Notes
    -----
    Each check states the error that it allows; that none passes where the law, the stresses, a
    table
    or a scene is wrong is tested in ``tests/validation/test_validation.py``.
    """
    parts = [
        lambda: random_state_checks(states, seed),
        lambda: along_motion_checks(times),
        lambda: stress_checks(stress_states, seed),
        *(lambda table=table: check_table(table, table_points, seed) for table in tables),
        lambda: motion_checks(times),
    ]
    checks = []
    for part in tqdm(parts, desc="validate", delay=1.0, leave=False, disable=not progress):
        checks += part()
    settings = {
        "states": states,
        "stress_states": stress_states,
        "table_points": table_points,
        "times": times,
    }
    return Report(tuple(checks), settings | {"seed": seed})
