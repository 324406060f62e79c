"""Driven motions: random ones of all kinds against tight tolerances, the balance of energy, and another method.

The other method is SciPy's Radau on (V, omega) and the contact law: it knows of no regime and no event.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from tqdm import tqdm

import viscoroll as vr

from ..truth.check_driven import PATHS, motion_of
from ..truth.check_driven import TARGET as CHECK_DRIVEN
from .claim import Claim, at

#: errors are over rtol: of all motions, and of 99 in 100
WORST, MOST = 30.0, 3.0
#: the balance of energy over its largest term, and the distance from the other method over the largest speed
BALANCE, OTHER = 1e-8, 1e-6
TIGHT, OTHER_RTOL = 1e-11, 1e-9
#: share of motions that the other method may give up: where V and omega pass 0 at once rates are infinite
GIVEN_UP = 0.2
DOMAIN = "random scenes, starts from rest and not, force and torque that stay, ramp and jump"
BRAKED = "such motions under brakes that stay, ramp and jump, a quarter of them at alpha = 1"
FED_BACK = "such motions under force and torque that follow the speeds too, with gains of -10 to -0.1"
WILD = "random scenes with alpha to 1e8, mu from 1e-6 and j from 1e-3 to 1e3, starts and drives as before"
#: of the last: errors over rtol, and share that may stop, as creep there may relax within the rounding of time
WILDEST, STOPPED = 100.0, 0.02
Case = tuple[vr.Scene, float, float, NDArray, dict[str, Any]]


def random_scene(random: np.random.Generator) -> vr.Scene:
    """A scene."""
    return vr.Scene(
        1.0 + 10.0 ** random.uniform(-1.0, 2.0), 10.0 ** random.uniform(0.3, 2.0), 10.0 ** random.uniform(-1.7, 0.0),
        1.0, random.uniform(0.2, 1.2),
    )  # fmt: skip


def wild_scene(random: np.random.Generator) -> vr.Scene:
    """A scene, most of them of no cylinder."""
    return vr.Scene(
        1.0 + 10.0 ** random.uniform(-2.0, 8.0), 10.0 ** random.uniform(-1.0, 3.0), 10.0 ** random.uniform(-6.0, 0.3),
        1.0, 10.0 ** random.uniform(-3.0, 3.0),
    )  # fmt: skip


def random_case(
    random: np.random.Generator, scene_of: Callable[[np.random.Generator], vr.Scene] = random_scene
) -> Case:
    """A scene, a start, output times, and a drive of up to three pieces."""
    scene = scene_of(random)
    V0, omega0 = random.normal(size=2) * 10.0 ** random.uniform(-2.0, 0.5) * (random.random() < 0.7)
    end, size = 10.0 ** random.uniform(0.0, 2.0), 2.0 * scene.mu * 10.0 ** random.uniform(-2.0, 0.0)
    cuts = np.repeat(np.sort(random.uniform(0.0, end, random.integers(0, 3))), 2)
    times = np.concatenate([[0.0], cuts, [end]])
    force, torque = random.normal(size=(2, times.size)) * size
    if random.random() < 0.5:  # pieces that stay
        force, torque = np.repeat(force[::2], 2)[: times.size], np.repeat(torque[::2], 2)[: times.size]
    drive = {
        "force": vr.Schedule(times, force * (random.random() < 0.7)),
        "torque": vr.Schedule(times, torque * (random.random() < 0.7)),
    }
    return scene, V0, omega0, np.linspace(0.0, end, 30), drive


def braked_case(random: np.random.Generator) -> Case:
    """As the last, with a brake; in half of the cases one of the speeds is 0 at first."""
    scene, V0, omega0, t, drive = random_case(random)
    if random.random() < 0.25:
        scene = scene.replace(alpha=1.0)
    times = drive["torque"].times
    brake = np.abs(random.normal(size=times.size)) * scene.mu * 10.0 ** random.uniform(-1.0, 0.5)
    brake *= np.repeat(random.random(times.size // 2) < 0.7, 2)
    V0, omega0 = ((V0, omega0), (V0, omega0), (V0, 0.0), (0.0, omega0))[random.integers(4)]
    return scene, V0, omega0, t, drive | {"brake": vr.Schedule(times, brake)}


def fed_back_case(random: np.random.Generator) -> Case:
    """As the first, with gains, of which none makes the speeds grow."""
    scene, V0, omega0, t, drive = random_case(random)
    force_V, force_omega, torque_omega = -(10.0 ** random.uniform(-1.0, 1.0, 3)) * (random.random(3) < 0.6)
    force, torque = (drive[name] for name in ("force", "torque"))
    fed = {"force": vr.Feedback(force, force_V, force_omega), "torque": vr.Feedback(torque, 0.0, torque_omega)}
    return scene, V0, omega0, t, fed


def off(one: vr.Motion, other: vr.Motion) -> float:
    """Largest difference of V and omega over the largest speed so far."""
    fastest = np.maximum.accumulate(np.maximum(np.abs(other.V), np.abs(other.omega)))
    difference = np.maximum(np.abs(one.V - other.V), np.abs(one.omega - other.omega))
    return float(np.max(difference[fastest > 0.0] / fastest[fastest > 0.0], initial=0.0))


def balance(m: vr.Motion) -> float:
    """What is missing in the balance of energy, over the largest of its terms."""
    energy, work = 0.5 * (m.V**2 + m.scene.j * m.omega**2), m.work_force + m.work_torque
    lost = m.brake_loss + m.slip_loss + m.rolling_loss
    scale = max(float(np.abs(part).max()) for part in (energy, work, lost))
    return float(np.abs(work - (energy - energy[0]) - lost).max()) / scale if scale > 0.0 else 0.0


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """All rows."""
    random, braked, fed, wild = (np.random.default_rng(sizes["seed"] + n) for n in (7, 8, 9, 10))
    rtol = sizes["driven_rtol"]
    claims = judged((random_case(random) for _ in range(sizes["driven_motions"])), rtol, DOMAIN)
    claims += judged((braked_case(braked) for _ in range(sizes["braked_motions"])), rtol, BRAKED)
    claims += judged((fed_back_case(fed) for _ in range(sizes["fed_back_motions"])), rtol, FED_BACK)
    claims += judged(
        (random_case(wild, wild_scene) for _ in range(sizes["wild_motions"])), rtol, WILD, WILDEST, STOPPED
    )
    return [claim.row for claim in [*claims, *other_method(random, sizes)]]


def judged(
    cases: Iterator[Case], tolerances: list[float], domain: str, bound: float = WORST, stopped: float = 0.0
) -> list[Claim]:
    """Motions at each tolerance in turn against themselves at a tight one, and the balance of energy of that.

    ``stopped`` : share that may end before the end at one of the two, with a status that says so.
    """
    worst = {rtol: Claim(f"V and omega over the largest speed so far, rtol {rtol:.0e}, over rtol", domain, bound)
             for rtol in tolerances}  # fmt: skip
    many = Claim(f"share of motions beyond {MOST:g} rtol, all rtol", domain, 0.01)
    given_up = Claim("share of motions that stop before their end, and say so, left out", domain, stopped)
    energy = Claim(f"balance of energy at rtol {TIGHT:.0e}", domain, BALANCE)
    beyond = short = count = 0
    for n, case in enumerate(tqdm(cases, desc="driven motions", leave=False)):
        rtol, where = tolerances[n % len(tolerances)], f"motion {n}, {case[0]!r:.200}"
        best, m = (rolled(case, one) for one in (TIGHT, rtol))
        count += 1
        if best is None or m is None:
            short += 1
            continue
        energy.add(balance(best), where)
        error = off(m, best) / rtol
        worst[rtol].add(error, where)
        beyond += error > MOST
    many.add(beyond / count)
    given_up.add(short / count)
    return [*worst.values(), many, given_up, energy]


def rolled(case: Case, rtol: float) -> vr.Motion | None:
    """The motion; None where it stops before its end."""
    scene, V0, omega0, t, drive = case
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        m = vr.roll(scene, V0, omega0, t, rtol=rtol, **drive)
    return m if m.status == vr.MotionStatus.DONE else None


def precise_rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    """The motions of data/reference/check_driven.json, all at every tolerance."""
    content = json.loads(CHECK_DRIVEN.read_text(encoding="utf-8"))["motions"]
    file, claims = "data/reference/check_driven.json", []
    for rtol in sizes["precise_rtol"]:
        speeds = Claim(f"V and omega over the largest speed so far, rtol {rtol:.0e}, over rtol", file, WORST)
        paths = Claim(f"x, angle, works and losses over the largest so far, rtol {rtol:.0e}, over rtol", file, WORST)
        times = Claim(
            f"times of switches and reversals over the last output time, rtol {rtol:.0e}, over rtol", file, WORST
        )
        for row in content:
            case = motion_of(row)
            m = vr.roll(case.scene, case.V0, case.omega0, row["t"], rtol=rtol, **case.drive)
            fastest = np.maximum.accumulate(np.maximum(np.abs(row["V"]), np.abs(row["omega"])))
            here = fastest > 0.0
            for name in ("V", "omega"):
                error = np.abs(getattr(m, name) - row[name])[here] / fastest[here]
                speeds.add(error / rtol, f"{case.name}, {name}")
            for name in PATHS:
                best = np.array(row[name])
                largest = np.abs(best).max()
                if largest > 0.0:
                    paths.add(np.abs(getattr(m, name) - best).max() / largest / rtol, f"{case.name}, {name}")
            found = [*(switch.t for switch in m.switches), *m.reversals.tolist()]
            best = [*(when for when, _ in row["switches"]), *row["reversals"]]
            same = [switch.regime for switch in m.switches] == [regime for _, regime in row["switches"]]
            off = np.abs(np.array(found) - best) if same and len(found) == len(best) else np.array([np.inf])
            times.add(off / row["t"][-1] / rtol, case.name)
        claims += [speeds, paths, times]
    return [claim.row for claim in claims]


def other_method(random: np.random.Generator, sizes: dict[str, Any]) -> list[Claim]:
    """Motions under a drive that stays, by SciPy's Radau."""
    claim = Claim(
        "V and omega against SciPy's Radau, over the largest speed", "random scenes and drives that stay", OTHER
    )
    lost, given_up = Claim("share of motions that SciPy's Radau gives up, left out", "the same", GIVEN_UP), 0
    for n in tqdm(range(sizes["driven_peers"]), desc="by Radau", leave=False):
        scene, _, _, _, _ = random_case(random)
        V0, omega0 = random.normal(size=2)
        f, q = random.normal(size=2) * scene.mu
        t = np.linspace(0.0, 5.0, 20)

        def rates(_: float, state: NDArray, scene: Any = scene, f: float = f, q: float = q) -> list[float]:
            c = vr.contact(scene, state[0], omega=state[1], fields=("Q", "M"))
            return [c.Q - 0.5 * c.M + f, (q - c.Q - 0.5 * c.M) / scene.j]

        m = vr.roll(scene, V0, omega0, t, rtol=TIGHT, force=f, torque=q)
        found = solve_ivp(rates, (0.0, t[-1]), (V0, omega0), "Radau", t, rtol=OTHER_RTOL, atol=1e-3 * OTHER_RTOL)
        given_up += not found.success
        if found.success:
            fastest = max(np.abs(m.V).max(), np.abs(m.omega).max())
            difference = float(np.abs(found.y - [m.V, m.omega]).max()) / fastest
            claim.add(difference, f"motion {n}, " + at(V0=float(V0), omega0=float(omega0), f=float(f), q=float(q)))
    lost.add(given_up / sizes["driven_peers"])
    return [claim, lost]
