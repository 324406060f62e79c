"""Motions against themselves at a tight tolerance, and against reference motions in extended
precision; identities.
"""

import json
import math
import warnings
from functools import partial
from itertools import cycle, groupby
from operator import itemgetter
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr

from ...stage import ROOT, read_rows
from . import cases
from .cases import DRIVEN, FREE, PATHS, Case, Proof, driven_motion, free_motion

#: errors over rtol that the documentation states, of all motions and of 99 in 100; steps that no
#: motion needs
FACTOR = 30.0
MOST = 3.0
STEPS = 1000
#: what motions are held against: free ones, and where creep may relax within the rounding of time
TIGHTEST = 1e-12
TIGHT = 1e-11
#: of identities, long lives and slight friction
RTOL = 1e-8
#: relative change of an input that a condition number is taken by, and rtol of the motion with it
_CHANGE = 1e-6
_CHANGED_RTOL = 1e-10
#: speeds that have no digits left
_GONE = 1e-290
#: durations of very long lives, in decay times; changes of the unit of time, by a power of 2 and by
#: none
_LIVES = 10.0 ** np.arange(-12.0, 13.0)
_POWER = 8.0
_TIME_SCALE = 7.3
#: of a scene with a map
_STARTS = 4000
_INPUTS = ("alpha", "kappa", "mu", "j")
TOLERANCES = tuple(10.0 ** -np.arange(4.0, 12.0))
DRIVEN_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
CHECKED_TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)


def rolled(case: Case, rtol: float, **options):
    """The motion; None where it stops before its end."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        m = vr.roll(case.scene, case.V0, case.omega0, case.t, rtol=rtol, **case.drive, **options)
    return m if m.status == vr.MotionStatus.DONE else None


def speed_error(m, best, so_far: bool = False) -> NDArray:
    """Of V and omega over the larger of both, or over the largest so far."""
    size = np.maximum(np.abs(best.V), np.abs(best.omega))
    size = np.maximum(np.maximum.accumulate(size) if so_far else size, _GONE)
    return np.maximum(np.abs(m.V - best.V), np.abs(m.omega - best.omega)) / size


def path_errors(m, best) -> list[float]:
    """Of x, angle, works and losses over their largest."""
    pairs = [
        (getattr(m, name), np.array(getattr(best, name))) for name in PATHS if hasattr(best, name)
    ]
    return [np.abs(a - b).max() / np.abs(b).max() for a, b in pairs if np.abs(b).max() > 0.0]


def errors(m, best, end: float) -> dict[str, float]:
    """Of a free motion: V and omega over the larger of both; x, and the angle, over the longest way
    so far of both; the onset, of which it is known that it is no earlier than the end where it is
    beyond.
    """
    path = np.maximum.accumulate(np.maximum(abs(best.x), abs(best.angle)))
    early = np.fmin(m.onset_time, end)
    late = np.fmin(best.onset_time, end)
    return {
        "speed": speed_error(m, best).max(),
        "x": max((abs(m.x - best.x) / path).max(), (abs(m.angle - best.angle) / path).max()),
        "onset": abs(early / late - 1.0),
    }


def condition(case: Case, best) -> float:
    """Sum over all inputs of the relative change of V, omega for one of the input, at the worst
    time.

    Inputs are alpha, kappa, mu, j, V0, omega0 and t, which stands for gamma too.
    """
    grown = 1.0 + _CHANGE
    moved = [case._replace(**{name: getattr(case, name) * grown}) for name in ("V0", "omega0", "t")]
    moved += [
        case._replace(scene=case.scene.replace(**{name: getattr(case.scene, name) * grown}))
        for name in _INPUTS
    ]
    found = [rolled(other, _CHANGED_RTOL) for other in moved]
    return math.inf if None in found else sum(speed_error(m, best) for m in found).max() / _CHANGE


def free(random, count):
    """At each tolerance in turn, divided by rtol: against the tightest."""
    for _, rtol in zip(range(count), cycle(TOLERANCES)):
        case = cases.free(random)
        m, best = (rolled(case, one, max_steps=10 * STEPS) for one in (rtol, TIGHTEST))
        where = f"rtol = {rtol:g}, {case}"
        yield where, {"given up": m is None or best is None}
        if m and best:
            found = errors(m, best, case.t[-1])
            factor = condition(case, best)
            if factor > FACTOR:
                found["ill"] = found.pop("speed") / factor
            yield (
                where,
                {(name, rtol): error / rtol for name, error in found.items()} | {"steps": m.steps},
            )


def identities(random, count):
    for _ in range(count):
        case = cases.free(random)
        m = rolled(case, RTOL)
        missing = {name: error / RTOL for name, error in balances(case).items()}
        mirrored = in_other_units(case, -1.0, _POWER)
        scaled = in_other_units(case, 1.0, _TIME_SCALE)
        yield (
            str(case),
            {
                "rise": risen_energy(case) / RTOL,
                "bits": any(
                    not np.array_equal(getattr(m, name), each, True)
                    for name, each in vars(mirrored).items()
                ),
                "gamma": max(errors(scaled, m, case.t[-1]).values()) / RTOL,
            }
            | missing,
        )


def in_other_units(case: Case, sign: float, time: float):
    """Rolled the other way where ``sign`` is -1, with ``time`` gamma at t/time, and turned back."""
    scene = case.scene.replace(gamma=time * case.scene.gamma)
    found = rolled(Case(scene, sign * case.V0, sign * case.omega0, case.t / time, {}), RTOL)
    factors = {"V": sign, "omega": sign, "x": sign * time, "angle": sign * time, "onset_time": time}
    return SimpleNamespace(
        **{name: getattr(found, name) * factor for name, factor in factors.items()}
    )


def balances(case: Case) -> dict[str, float]:
    """What is missing in (V - j omega)' = 2 gamma Q and in the balance of energy, by Gauss's rule
    between the steps.
    """
    scene = case.scene
    m = rolled(case._replace(t=case.t[-1]), RTOL).course
    node, weight = np.polynomial.legendre.leggauss(12)
    edges = np.unique([*m.t, *(switch.t for switch in m.switches)])
    half = 0.5 * np.diff(edges)[:, None]
    along = m.at((edges[:-1, None] + half * (1.0 + node)).ravel())
    weight = (half * weight).ravel()
    state = along.contact(fields=("Q", "M"))
    V = m.V[[0, -1]]
    omega = m.omega[[0, -1]]
    scale = np.abs(m.V).max() + np.abs(m.omega).max()
    momentum = np.diff(V - scene.j * omega)[0] - weight @ (2.0 * scene.gamma * state.Q)
    power = scene.gamma * (
        (along.omega - along.V) * state.Q + 0.5 * (along.V + along.omega) * state.M
    )
    energy = np.diff(0.5 * (V**2 + scene.j * omega**2))[0] + weight @ power
    return {"momentum": abs(momentum) / scale, "energy": abs(energy) / scale**2}


def risen_energy(case: Case) -> float:
    """Largest relative rise of the kinetic energy between outputs, both with V omega >= 0."""
    m = rolled(case._replace(t=np.linspace(0.0, case.t[-1], 100)), RTOL)
    energy = 0.5 * (m.V**2 + case.scene.j * m.omega**2)
    forward = m.V * m.omega >= 0.0
    both = forward[1:] & forward[:-1] & (energy[:-1] > 0.0)
    return np.max(np.diff(energy)[both] / energy[:-1][both], initial=0.0)


def long_lives(random, count):
    """One motion for 1e-12 to 1e12 of its decay times: speeds fall to 0, distances converge, rest
    is reached.
    """
    for _ in range(count):
        case = cases.free(random)
        scene = case.scene
        c = (scene.alpha - 1.0) / scene.alpha
        slide = abs(case.omega0 - case.V0) / (scene.gamma * scene.mu * (1.0 + 1.0 / scene.j))
        case = case._replace(t=slide + _LIVES * (1.0 + scene.j) / (scene.gamma * (c or 1.0)))
        given = scene, case.V0, case.omega0, case.t
        m, rested = (vr.roll(*given, rtol=RTOL, **rest) for rest in ({}, {"rest": 1e-6}))
        good = all(np.isfinite(values).all() for values in (m.V, m.omega, m.x, m.angle))
        if c:
            stays = abs(m.x[-1] - m.x[-2]) <= FACTOR * RTOL * abs(m.x).max()
            good &= (
                m.V[-1] == m.omega[-1] == 0.0 and stays and rested.status == vr.MotionStatus.RESTED
            )
        yield str(case), {"steps": [m.steps, rested.steps], "wrong": not good}


def slight(random, count):
    for _ in range(count):
        case = cases.slight(random)
        m, best = (rolled(case, rtol, max_steps=10 * STEPS) for rtol in (RTOL, TIGHT))
        yield str(case), {"given up": m is None or best is None}
        if m and best:
            yield str(case), {"steps": m.steps, "speed": speed_error(m, best).max() / RTOL}


def driven(random, count, draw):
    """At each tolerance in turn, divided by rtol, and the balance of energy of the tight one."""
    for _, rtol in zip(range(count), cycle(DRIVEN_TOLERANCES)):
        case = draw(random)
        best, m = (rolled(case, one) for one in (TIGHT, rtol))
        yield str(case), {"given up": m is None or best is None}
        if m and best:
            error = speed_error(m, best, so_far=True).max() / rtol
            yield str(case), {("speed", rtol): error, "many": error > MOST, "energy": balance(best)}


def mapped(random, count):
    """By its flow map and integrated, over what the map states and 30 rtol, of the starts that the
    map answers.
    """
    for _ in range(count):
        alpha, kappa, mu = cases.powers(random, (0.0, 4.0), (-0.3, 2.3), (-2.0, 0.5))
        scene = vr.Scene(max(alpha, 1.001), kappa, mu, 1.0, random.uniform(0.1, 2.0))
        starts = random.uniform(-2.0, 2.0, (2, _STARTS))
        t = np.geomspace(1e-3, 5.0, 8) * (1.0 + scene.j) * scene.alpha / (scene.alpha - 1.0)
        quick, slow = (
            vr.ensemble(scene, *starts, t, method=method, rtol=rtol, fields=("V", "omega"))
            for method, rtol in (("flow", 1e-3), ("integrate", TIGHT))
        )
        yield repr(scene), {"given up": quick.status > vr.MotionStatus.RESTED}
        if quick.flow.any():
            error = speed_error(quick, slow)[quick.flow].max() / (quick.flow_error + FACTOR * TIGHT)
            yield repr(scene), {"speed": error}


def balance(m: vr.Motion) -> float:
    """What is missing in the balance of energy, over the largest of its terms."""
    energy = 0.5 * (m.V**2 + m.scene.j * m.omega**2)
    work = m.work_force + m.work_torque
    lost = m.brake_loss + m.slip_loss + m.rolling_loss
    scale = max(np.abs(part).max() for part in (energy, m.work_force, m.work_torque, lost))
    return np.abs(work - (energy - energy[0]) - lost).max() / scale if scale > 0.0 else 0.0


def checked_free(random, few):
    """Each of data/reference at every tolerance, divided by rtol, or over rtol x condition/30 where
    that is larger.
    """
    for _, rows in groupby(read_rows(FREE), itemgetter("motion")):
        case, best = free_motion(list(rows))
        excuse = max(condition(case, best) / FACTOR, 1.0)
        for rtol in CHECKED_TOLERANCES[:few]:
            found = errors(rolled(case, rtol), best, case.t[-1])
            yield str(case), {(name, rtol): error / rtol / excuse for name, error in found.items()}


def checked_driven(random, few):
    """Each at every tolerance, divided by rtol."""
    for row in json.loads(DRIVEN.read_text(encoding="utf-8"))["motions"]:
        case = driven_motion(row)
        best = SimpleNamespace(**{key: np.array(row[key]) for key in ("V", "omega", *PATHS)})
        for rtol in CHECKED_TOLERANCES[:few]:
            m = rolled(case, rtol)
            times = [*(switch.t for switch in m.switches), *m.reversals.tolist()]
            truth = [*(when for when, _ in row["switches"]), *row["reversals"]]
            like = [switch.regime for switch in m.switches] == [
                regime for _, regime in row["switches"]
            ]
            off = (
                np.abs(np.subtract(times, truth)) / row["t"][-1]
                if like and len(times) == len(truth)
                else np.inf
            )
            found = {
                "speed": speed_error(m, best, so_far=True),
                "paths": path_errors(m, best),
                "times": off,
            }
            yield row["name"], {(key, rtol): np.array(error) / rtol for key, error in found.items()}


def at_each(
    tolerances: tuple[float, ...], bound: float, **sentences: str
) -> dict[Any, tuple[str, float]]:
    """A claim for each tolerance."""
    return {
        (name, rtol): (f"{text}, rtol {rtol:.0e}, divided by rtol", bound)
        for name, text in sentences.items()
        for rtol in tolerances
    }


_LARGER = (
    "V and omega, divided by the larger of both, and by condition/30 where the condition "
    "number exceeds 30"
)
_SO_FAR = "V and omega, divided by the largest speed so far"
_STEPS = {"steps": ("steps of a motion", STEPS)}
_RANDOM = "random motions"


def _driven(size, domain, draw, worst=FACTOR, given_up=0.0):
    return Proof(
        "driven",
        size,
        domain,
        at_each(DRIVEN_TOLERANCES, worst, speed=_SO_FAR)
        | {
            "many": (f"share of motions beyond {MOST:g} rtol, all rtol", 0.01),
            "given up": (
                "share of motions that stop before their end, and say so, left out",
                given_up,
            ),
            "energy": (f"balance of energy at rtol {TIGHT:.0e}", 1e-8),
        },
        partial(driven, draw=draw),
    )


PROOFS = [
    Proof(
        "check_motions",
        "precise",
        str(FREE.relative_to(ROOT)),
        at_each(
            CHECKED_TOLERANCES,
            FACTOR,
            speed=_LARGER,
            x="x, divided by the longest distance so far",
            onset="time of onset",
        ),
        checked_free,
    ),
    Proof(
        "motion",
        "motions",
        _RANDOM,
        at_each(
            TOLERANCES,
            FACTOR,
            speed=f"V, omega, condition below {FACTOR:g}",
            x="x",
            onset="time of onset",
        )
        | at_each(
            TOLERANCES,
            1.0,
            ill=f"V, omega, divided by the condition number, condition above {FACTOR:g}",
        )
        | _STEPS
        | {"given up": (f"motions given up after {10 * STEPS} steps", 0.0)},
        free,
    ),
    Proof(
        "motion",
        "motion_identities",
        f"{_RANDOM}, rtol {RTOL:.0e}",
        {
            "momentum": ("(V - j omega)' = 2 gamma Q, integrated: error divided by rtol", FACTOR),
            "energy": ("balance of energy, integrated: error divided by rtol", FACTOR),
            "rise": ("rise of kinetic energy while V omega >= 0, divided by rtol", FACTOR),
            "bits": (
                f"-V, -omega under {_POWER:g} gamma at t/{_POWER:g}: motions that differ in a bit",
                0.0,
            ),
            "gamma": (f"{_TIME_SCALE} gamma at t/{_TIME_SCALE}: error divided by rtol", FACTOR),
        },
        identities,
    ),
    Proof(
        "motion",
        "long_motions",
        f"{_RANDOM}, t from 1e-12 to 1e12 decay times",
        _STEPS
        | {
            "wrong": (
                "motions whose speeds do not fall to 0, distances not converge, or that reach no "
                "rest",
                0.0,
            )
        },
        long_lives,
    ),
    Proof(
        "motion",
        "slight_motions",
        "alpha and kappa to 1e3, mu in [1e-6, 1e-5], j in [1e-3, 1], starts of 1e-5 to 1",
        _STEPS
        | {
            "speed": (f"V, omega: error divided by rtol, rtol {RTOL:.0e}", FACTOR),
            "given up": (f"share of motions given up at {RTOL:g} or {TIGHT:g}, left out", 0.02),
        },
        slight,
    ),
    _driven(
        "driven_motions",
        "random scenes, starts from rest and not, force and torque that stay, ramp and jump",
        cases.driven,
    ),
    _driven(
        "braked_motions",
        "such motions under brakes that stay, ramp and jump, a quarter of them at alpha = 1",
        cases.braked,
    ),
    _driven(
        "fed_back_motions",
        "such motions under force and torque that follow the speeds too, gains of -10 to -0.1",
        cases.fed_back,
    ),
    # at speeds of 1e-19 grip may be spent to rounding
    _driven(
        "prescribed_motions",
        "V or omega prescribed, over 12 decades beside the other speed, alpha to 1e4, kappa "
        "in [1e-3, 1e3], mu in [1e-5, kappa], gamma and j in [0.01, 100]",
        cases.prescribed,
        given_up=0.001,
    ),
    # creep may relax within the rounding of time
    _driven(
        "wild_motions",
        "random scenes with alpha to 1e8, mu from 1e-6 and j from 1e-3 to 1e3, starts, drives as "
        "before",
        partial(cases.driven, wild=True),
        100.0,
        0.02,
    ),
    Proof(
        "check_driven",
        "precise",
        str(DRIVEN.relative_to(ROOT)),
        at_each(
            CHECKED_TOLERANCES,
            FACTOR,
            speed=_SO_FAR,
            paths="x, angle, works and losses, divided by the largest value",
            times="times of switches and reversals, divided by the last output time",
        ),
        checked_driven,
    ),
    Proof(
        "flow",
        "mapped_scenes",
        "alpha in [1.001, 1e4], kappa in [0.5, 200], mu in [0.01, 3], j in [0.1, 2], starts "
        "in [-2, 2]^2, 1e-3 to 5 decay times",
        {
            "speed": (
                "V and omega against the integrator, divided by the sum of the stated error and "
                f"{FACTOR:g} rtol",
                1.0,
            ),
            "given up": ("share of motions that stop before their end", 0.0),
        },
        mapped,
    ),
]
