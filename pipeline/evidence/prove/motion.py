"""Motions against tighter ones, and those against extended precision; identities; very long lives."""

from __future__ import annotations

import math
import warnings
from collections import defaultdict
from itertools import groupby
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr
from viscoroll.errors import MotionStatus

from ...stage import ROOT, read_rows
from ..bench.problem import speed_error
from ..truth import roll_precise
from ..truth.random_motions import DOMAIN, ChosenMotion, chosen_motion
from .claim import Claim

CHECK_MOTIONS = ROOT / "data/reference/check_motions.csv"
#: the factor of rtol that the documentation states, and the steps that no motion needs
FACTOR, STEPS = 30.0, 1000
#: the reference: the tightest that roll accepts
REFERENCE_RTOL = 1e-12
#: relative change of an input that a condition number is taken by, and rtol of the motion with it
_CHANGE = 1e-6
_CHANGED_RTOL = 1e-10
#: what motions of slight friction are compared with, and speeds that have no digits left
SLIGHT_RTOL, _GONE = 1e-11, 1e-290
#: durations of very long lives, in decay times
_LIVES = 10.0 ** np.arange(-12.0, 13.0)
_TIME_SCALE = 7.3


class Track(NamedTuple):
    """What a motion is compared by."""

    V: NDArray
    omega: NDArray
    x: NDArray
    angle: NDArray
    onset: float
    steps: float


def rolled(motion: ChosenMotion, rtol: float, t: NDArray | None = None) -> Track | None:
    """By the integrator; None where it gave up."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = vr.roll(
            motion.scene, motion.V0, motion.omega0, motion.t if t is None else t, rtol=rtol, max_steps=10 * STEPS
        )
    if found.status != MotionStatus.DONE:
        return None
    return Track(found.V, found.omega, found.x, found.angle, found.onset_time, found.steps)


def precise(motion: ChosenMotion) -> Track:
    """In extended precision."""
    found = roll_precise(motion.scene, motion.V0, motion.omega0, motion.t.tolist())
    onset = math.nan if found.onset_time is None else float(found.onset_time)
    values = (np.array([float(value) for value in getattr(found, name)]) for name in ("V", "omega", "x", "angle"))
    return Track(*values, onset, found.steps)


def errors(tried: Track, best: Track, end: float) -> dict[str, float]:
    """V and omega over the larger of the two; x over the longest way so far, of axis or circumference; onset."""
    path = np.maximum.accumulate(np.maximum(abs(best.x), abs(best.angle)))
    # an onset beyond the end is known to be no earlier than that
    early, late = np.fmin(tried.onset, end), np.fmin(best.onset, end)
    return {
        "speed": float(speed_error(tried, best).max()), "x": float((abs(tried.x - best.x) / path).max()),
        "onset": float(abs(early / late - 1.0)),
    }  # fmt: skip


def condition(motion: ChosenMotion, best: Track) -> float:
    """Sum over all inputs of the relative change of V, omega for one of the input, at the worst time.

    Inputs are alpha, kappa, mu, j, V0, omega0 and t, which stands for gamma too.
    """
    grown = 1.0 + _CHANGE
    moved = [(motion._replace(**{name: getattr(motion, name) * grown}), motion.t) for name in ("V0", "omega0")]
    for name in ("alpha", "kappa", "mu", "j"):
        scene = motion.scene.replace(**{name: getattr(motion.scene, name) * grown})
        moved.append((motion._replace(scene=scene), motion.t))
    total = np.zeros(best.V.size)
    for other, t in (*moved, (motion, motion.t * grown)):
        track = rolled(other, _CHANGED_RTOL, t)
        if track is None:
            return math.inf
        total += speed_error(track, best) / _CHANGE
    return float(total.max())


def compared(motion: ChosenMotion, tracks: dict[float, Track]) -> tuple[dict[float, dict[str, float]], Track]:
    """(errors by rtol, reference): the integrator at its tightest; where that differs much, extended precision."""
    best = rolled(motion, REFERENCE_RTOL)
    if best is not None:
        found = {rtol: errors(track, best, motion.end) for rtol, track in tracks.items()}
        if all(max(one.values()) <= FACTOR * rtol for rtol, one in found.items()):
            return found, best
    best = precise(motion)
    return {rtol: errors(track, best, motion.end) for rtol, track in tracks.items()}, best


def accuracy_rows(count: int, tolerances: list[float], rng: np.random.Generator) -> list[dict[str, Any]]:
    claims = {
        "speed": Claim(f"V, omega: error over rtol, condition below {FACTOR:g}", DOMAIN, FACTOR),
        "ill": Claim(f"V, omega: error over rtol × condition, condition above {FACTOR:g}", DOMAIN, 1.0),
        "x": Claim("x: error over rtol", DOMAIN, FACTOR),
        "onset": Claim("time of onset: error over rtol", DOMAIN, FACTOR),
        "steps": Claim("steps of a motion", DOMAIN, STEPS),
        "given up": Claim(f"motions given up after {10 * STEPS} steps", DOMAIN, 0),
    }
    curves: dict[str, dict[float, list[float]]] = defaultdict(lambda: defaultdict(list))
    for _ in tqdm(range(count), desc="motions", delay=1.0, leave=False):
        motion = chosen_motion(rng)
        tried = {rtol: rolled(motion, rtol) for rtol in (*tolerances, REFERENCE_RTOL)}
        for rtol, track in tried.items():
            claims["given up"].add(float(track is None), f"rtol = {rtol:g}, {motion}")
        tracks = {rtol: track for rtol, track in tried.items() if track is not None and rtol in tolerances}
        found, best = compared(motion, tracks)
        factor = condition(motion, best)
        name, excuse = ("speed", 1.0) if factor <= FACTOR else ("ill", factor)
        for rtol, one in found.items():
            # value of the curve, and what it is over in the claim
            for key, value, over in (
                (name, one["speed"], rtol * excuse), ("x", one["x"], rtol), ("onset", one["onset"], rtol),
                ("steps", tracks[rtol].steps, 1.0),
            ):  # fmt: skip
                claims[key].add(value / over, f"rtol = {rtol:g}, {motion}")
                curves[key][rtol].append(value)
    rows = {name: claim.row for name, claim in claims.items() if claim.points}
    for name, curve in curves.items():
        rows[name]["by_rtol"] = {
            f"{rtol:g}": {"worst": max(curve[rtol]), "median": float(np.median(curve[rtol]))}
            for rtol in tolerances
            if rtol in curve
        }
    return list(rows.values())


def check_motions() -> list[tuple[ChosenMotion, Track]]:
    """The motions of data/reference/check_motions.csv."""
    motions = []
    for _, rows in groupby(read_rows(CHECK_MOTIONS), itemgetter("motion")):
        here = list(rows)
        first = here[0]
        scene = vr.Scene(*(first[name] for name in ("alpha", "kappa", "mu", "gamma", "j")))
        values = (np.array([row[name] for row in here]) for name in ("V", "omega", "x", "angle"))
        motion = ChosenMotion(scene, first["V0"], first["omega0"], here[-1]["t"])
        motions.append((motion, Track(*values, first["onset_time"], 0)))
    return motions


def reference_rows() -> list[dict[str, Any]]:
    """The reference against extended precision."""
    claim = Claim(
        f"V, omega, x, onset at rtol = {REFERENCE_RTOL:g} against extended precision: error over rtol, "
        f"or over rtol × condition / {FACTOR:g} where that is larger",
        "data/reference/check_motions.csv",
        FACTOR,
    )
    for motion, best in check_motions():
        tried = rolled(motion, REFERENCE_RTOL)
        excuse = max(condition(motion, best) / FACTOR, 1.0)
        claim.add(max(errors(tried, best, motion.end).values()) / REFERENCE_RTOL / excuse, str(motion))
    return [claim.row]


def balances(motion: ChosenMotion, rtol: float) -> dict[str, float]:
    """What is missing in (V - j omega)' = 2 gamma Q and in the balance of energy, by Gauss's rule between the steps."""
    scene = motion.scene
    found = vr.roll(scene, motion.V0, motion.omega0, motion.end, rtol=rtol).course
    node, weight = np.polynomial.legendre.leggauss(12)
    edges = np.unique([*found.t, *(switch.t for switch in found.switches)])
    half = 0.5 * np.diff(edges)[:, None]
    along = found.at((edges[:-1, None] + half * (1.0 + node)).ravel())
    weight = (half * weight).ravel()
    state = along.contact(fields=("Q", "M"))
    V, omega = found.V[[0, -1]], found.omega[[0, -1]]
    scale = np.abs(found.V).max() + np.abs(found.omega).max()
    momentum = np.diff(V - scene.j * omega)[0] - weight @ (2.0 * scene.gamma * state.Q)
    power = scene.gamma * ((along.omega - along.V) * state.Q + 0.5 * (along.V + along.omega) * state.M)
    energy = np.diff(0.5 * (V**2 + scene.j * omega**2))[0] + weight @ power
    return {"momentum": float(abs(momentum)) / scale, "energy": float(abs(energy)) / scale**2}


def risen_energy(motion: ChosenMotion, rtol: float) -> float:
    """Largest relative rise of the kinetic energy between outputs, both with V omega >= 0."""
    found = rolled(motion, rtol, np.linspace(0.0, motion.end, 100))
    energy = 0.5 * (found.V**2 + motion.scene.j * found.omega**2)
    forward = found.V * found.omega >= 0.0
    both = forward[1:] & forward[:-1] & (energy[:-1] > 0.0)
    return float(np.max(np.diff(energy)[both] / energy[:-1][both], initial=0.0))


def same(one: Track, other: Track, sign: float = 1.0, time: float = 1.0) -> bool:
    """Whether all bits agree, with speeds times ``sign`` and times over ``time``."""
    pairs = [(one.V, other.V * sign), (one.omega, other.omega * sign)]
    pairs += [(one.x, other.x * sign * time), (one.angle, other.angle * sign * time), (one.onset, other.onset * time)]
    return all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)


def identity_rows(count: int, rtol: float, rng: np.random.Generator) -> list[dict[str, Any]]:
    at = f"rtol = {rtol:g}"
    claims = {
        "momentum": Claim(f"(V - j omega)' = 2 gamma Q, integrated: error over rtol, {at}", DOMAIN, FACTOR),
        "energy": Claim(f"balance of energy, integrated: error over rtol, {at}", DOMAIN, FACTOR),
        "rise": Claim(f"rise of kinetic energy while V omega >= 0, over rtol, {at}", DOMAIN, FACTOR),
        "mirror": Claim("(V, omega) -> (-V, -omega): motions that differ in a bit", DOMAIN, 0),
        "power": Claim("8 gamma at t/8: motions that differ in a bit", DOMAIN, 0),
        "gamma": Claim(f"{_TIME_SCALE} gamma at t/{_TIME_SCALE}: error over rtol, {at}", DOMAIN, FACTOR),
    }
    for _ in tqdm(range(count), desc="identities", delay=1.0, leave=False):
        motion = chosen_motion(rng)
        scene, here, where = motion.scene, rolled(motion, rtol), str(motion)
        for name, error in balances(motion, rtol).items():
            claims[name].add(error / rtol, where)
        claims["rise"].add(risen_energy(motion, rtol) / rtol, where)
        mirror = rolled(motion._replace(V0=-motion.V0, omega0=-motion.omega0), rtol)
        claims["mirror"].add(0.0 if same(here, mirror, sign=-1.0) else 1.0, where)
        fast = rolled(motion._replace(scene=scene.replace(gamma=8.0 * scene.gamma)), rtol, motion.t / 8.0)
        claims["power"].add(0.0 if same(here, fast, time=8.0) else 1.0, where)
        slow = motion._replace(scene=scene.replace(gamma=_TIME_SCALE * scene.gamma))
        other = rolled(slow, rtol, motion.t / _TIME_SCALE)
        other = other._replace(**{name: getattr(other, name) * _TIME_SCALE for name in ("x", "angle", "onset")})
        claims["gamma"].add(max(errors(other, here, motion.end).values()) / rtol, where)
    return [claim.row for claim in claims.values()]


def long_rows(count: int, rtol: float, rng: np.random.Generator) -> list[dict[str, Any]]:
    """One motion for 1e-12 to 1e12 of its decay times."""
    domain = f"{DOMAIN}, t from 1e-12 to 1e12 decay times"
    steps = Claim("steps of a motion", domain, STEPS)
    wrong = Claim("speeds that do not fall to 0, distances that do not converge, rest not reached: motions", domain, 0)
    for _ in tqdm(range(count), desc="long lives", delay=1.0, leave=False):
        motion = chosen_motion(rng)
        scene = motion.scene
        c = (scene.alpha - 1.0) / scene.alpha
        slide = abs(motion.omega0 - motion.V0) / (scene.gamma * scene.mu * (1.0 + 1.0 / scene.j))
        t = slide + _LIVES * (1.0 + scene.j) / (scene.gamma * (c or 1.0))
        found = vr.roll(scene, motion.V0, motion.omega0, t, rtol=rtol)
        rested = vr.roll(scene, motion.V0, motion.omega0, t, rtol=rtol, rest=1e-6)
        steps.add([found.steps, rested.steps], str(motion))
        gone = c == 0.0 or (found.V[-1] == 0.0 and found.omega[-1] == 0.0)
        stays = c == 0.0 or abs(found.x[-1] - found.x[-2]) <= FACTOR * rtol * abs(found.x).max()
        rests = c == 0.0 or rested.status == MotionStatus.RESTED
        finite = all(np.isfinite(values).all() for values in (found.V, found.omega, found.x, found.angle))
        wrong.add(0.0 if gone and stays and rests and finite else 1.0, str(motion))
    return [steps.row, wrong.row]


def slight_rows(count: int, rtol: float, rng: np.random.Generator) -> list[dict[str, Any]]:
    """Friction so slight that rolling resistance spends nearly all of it, on cylinders of little inertia."""
    domain = "alpha to 1e3, kappa to 1e3, mu in [1e-6, 1e-5], j in [1e-3, 1], starts of 1e-5 to 1"
    steps = Claim(f"steps of a motion, rtol = {rtol:g}", domain, STEPS)
    error = Claim(f"V, omega: error over rtol, rtol = {rtol:g}", domain, FACTOR)
    given_up = Claim(f"share of motions given up at {rtol:g} or {SLIGHT_RTOL:g}, left out", domain, 0.02)
    short = 0
    for _ in tqdm(range(count), desc="slight friction", delay=1.0, leave=False):
        low, high = np.log10([0.1, 1.0, 1e-6, 0.01, 1e-3]), np.log10([1e3, 1e3, 1e-5, 100.0, 1.0])
        alpha, kappa, mu, gamma, j = (10.0 ** rng.uniform(low, high)).tolist()
        V0, omega0 = (rng.normal(size=2) * 10.0 ** rng.uniform(-5.0, 0.0, 2)).tolist()
        slide = abs(omega0 - V0) / (gamma * mu * (1.0 + 1.0 / j))
        end = slide * rng.uniform(0.3, 1.1) + 10.0 ** rng.uniform(-1.0, 1.5) * (1.0 + j) * (1.0 + 1.0 / alpha) / gamma
        motion = ChosenMotion(vr.Scene(1.0 + alpha, kappa, mu, gamma, j), V0, omega0, float(end))
        tried, best = rolled(motion, rtol), rolled(motion, SLIGHT_RTOL)
        if tried is None or best is None:
            short += 1
            continue
        steps.add(tried.steps, str(motion))
        fastest = np.maximum(np.abs(best.V), np.abs(best.omega))
        off = np.maximum(np.abs(tried.V - best.V), np.abs(tried.omega - best.omega))
        error.add((off / np.maximum(fastest, _GONE)).max() / rtol, str(motion))
    given_up.add(short / count)
    return [steps.row, error.row, given_up.row]


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    rng = np.random.default_rng(sizes["seed"] + 4)
    return [
        *reference_rows(),
        *accuracy_rows(sizes["motions"], sizes["motion_rtol"], rng),
        *identity_rows(sizes["motion_identities"], 1e-8, rng),
        *long_rows(sizes["long_motions"], 1e-8, rng),
        *slight_rows(sizes["slight_motions"], 1e-8, rng),
    ]
