"""What proofs are made of: claims on errors against a truth; random states, scenes and motions,
over the whole domain and along its edges; reference motions of data/reference, of which
data/README.md says how they were made.
"""

import json
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from flint import arb
from numpy.random import Generator
from scipy.special import i0e, i1e, k0e, k1e
from tqdm import tqdm

import viscoroll as vr

from ... import stage
from ...stage import Row
from ..truth import contact_enclosure

# --- a proof: what is drawn, errors against a truth, and the claims on these ---

#: (where it was, errors of it or of many, by name), one after the other
Found = Iterable[tuple[str, dict[Any, Any]]]


class Proof(NamedTuple):
    """One row a claim.

    part : of the file, which --only renews.
    size : how many are drawn, a name in [prove] of the sizes.
    domain : what is drawn.
    claims : name of an error -> (sentence, bound); one that begins with "share" is held by the
    mean.
    found : (random numbers, size) -> errors; names of which nothing is claimed are left out.
    name : tells proofs of one part and size apart.
    """

    part: str
    size: str
    domain: str
    claims: dict[Any, tuple[str, float]]
    found: Callable[[Generator, Any], Found]
    name: str = ""

    def key(self) -> str:
        """Return part, size and name: the name of this proof among all."""
        return f"{self.part} {self.size} {self.name}"

    def random(self, seed: int) -> Generator:
        """Return the random numbers of this proof.

        They follow from its own key, not from its place among the proofs, so that a new proof
        changes no other's draws.

        seed: of all proofs, [prove].seed of the sizes.
        """
        return np.random.default_rng([seed, *self.key().encode()])

    def rows(self, seed: int, size) -> list[Row]:
        """Return a row for each claim: claim, domain, bound, points, worst, mean, and where the
        worst was.

        A NaN counts as infinite, an error below 0, within what was allowed for, as 0.

        seed: of all proofs.
        size: how many states or motions are drawn.
        """
        kept = {name: [0, 0.0, -1.0, ""] for name in self.claims}  # points, sum, worst, where
        progress = tqdm(self.found(self.random(seed), size), self.part, delay=1.0, leave=False)
        for where, errors in progress:
            for name in self.claims.keys() & errors.keys():
                each = np.asarray(errors[name], float).ravel()
                each = np.where(np.isnan(each), np.inf, np.maximum(each, 0.0))
                row = kept[name]
                worst = each.max(initial=0.0)
                row[0] += each.size
                row[1] += each.sum()
                row[2:] = (worst, where) if worst > row[2] else row[2:]
        rows = []
        for name, (points, total, worst, where) in kept.items():
            if points:
                claim, bound = self.claims[name]
                mean = total / points
                rows.append(
                    {
                        "claim": claim,
                        "domain": self.domain,
                        "bound": bound,
                        "mean": mean,
                        "where": where,
                        "points": points,
                        "worst": mean if claim.startswith("share") else worst,
                    }
                )
        return rows


def at(**values: float) -> str:
    """Where an error was found, to the last digit."""
    return ", ".join(f"{name} = {value!r}" for name, value in values.items())


# --- reference values as scenes, starts and drives ---

FOLDER = stage.ROOT / "data/reference"
VALUES, FREE, DRIVEN = (
    FOLDER / name for name in ("check_values.csv", "check_motions.csv", "check_driven.json")
)
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
OUTPUTS = ("V", "omega", "x", "angle")
PATHS = ("x", "angle", "work_force", "work_torque", "brake_loss", "slip_loss")


class Case(NamedTuple):
    """A motion: scene, start, output times, and the keywords of its drive."""

    scene: vr.Scene
    V0: float | None
    omega0: float | None
    t: Any
    drive: Row

    def __str__(self) -> str:
        return (
            f"{self.scene!r:.200}, V0 = {self.V0!r}, omega0 = {self.omega0!r}, end = "
            f"{float(self.t[-1])!r}"
        )


def free_motion(rows: list[Row]) -> tuple[Case, Any]:
    """The motion that rows of check_motions.csv describe, and its values."""
    first = rows[0]
    t = np.array([row["t"] for row in rows])
    values = {name: np.array([row[name] for row in rows]) for name in OUTPUTS}
    scene = vr.Scene(*(first[name] for name in PARAMETERS))
    return Case(scene, first["V0"], first["omega0"], t, {}), SimpleNamespace(
        **values, onset_time=first["onset_time"]
    )


def driven_motion(row: Row) -> Case:
    """The motion that a row of check_driven.json describes."""
    given = dict(row["scene"])
    bodies = {
        name: vr.Prony(**given.pop(name))
        for name in ("prony", "cylinder", "half_space")
        if name in given
    }
    if bodies:
        given["material"] = bodies.get("prony") or vr.Bodies(*bodies.values(), given.pop("share"))
    drive = {
        name: value
        if not isinstance(value, dict)
        else (vr.Schedule if "times" in value else vr.Feedback)(**value)
        for name, value in row["drive"].items()
    }
    return Case(vr.Scene(**given), row["V0"], row["omega0"], np.array(row["t"]), drive)


def read_elements(name: str) -> list[Row]:
    """Return the states of check_elements.json of one kind: "bodies", "covers" or "free_creep"."""
    return json.loads((FOLDER / "check_elements.json").read_text(encoding="utf-8"))[name]


# --- random states, scenes and motions ---

#: alphas at the end of the domain and next to it
EDGE_ALPHAS = (1.0, float(np.nextafter(1.0, 2.0)), 1.0 + 1e-15, 1.0 + 1e-8, 1.0001, 1e6)
STATES = (
    "alpha in [1, 1e6], kappa V in [1e-300, 1e300], kappa, mu in [1e-6, 1e6], s from 1e-300 "
    "to 1 and beyond"
)
#: shares of the duration of a free motion that outputs fall on
OUTPUT_SHARES = np.array([1e-3, 1e-2, 0.1, 0.25, 0.5, 0.75, 1.0])


def powers(random: Generator, *ends: tuple[float, float]) -> list[float]:
    """10^x, x even between the ends."""
    low, high = zip(*ends)
    return (10.0 ** random.uniform(low, high)).tolist()


def generators(z, alpha: float) -> tuple[Any, Any]:
    """g and h of one relaxation time, to place states by a half length z over V T."""
    r = i1e(alpha * z) / i0e(alpha * z)
    k = k0e(z) / k1e(z)
    h = (alpha - 1.0) / alpha * r / (1.0 + r * k)
    return h * k, h


def chosen_alpha(random: Generator) -> float:
    """At an edge, one time in four; else log-uniform in [1, 1e6]."""
    return (
        float(random.choice(EDGE_ALPHAS))
        if random.random() < 0.25
        else powers(random, (0.0, 6.0))[0]
    )


def chosen_creep(random: Generator, delta_star) -> float:
    """s = delta/delta_star log-uniform toward 0 and toward 1, at 0, at 1e-300 and 1e-16, and within
    an ULP of 1.
    """
    star = float(delta_star)
    edges = (
        np.nextafter(star, 0.0),
        star,
        np.nextafter(star, np.inf),
        1.5 * star,
        float(delta_star * (1 - arb(10) ** -16)),
        1e-300 * star,
        1e-16 * star,
        0.0,
    )
    small, gap = powers(random, (-20.0, 0.0), (-15.0, 0.0))
    kinds = (
        float(random.choice(edges)),
        small * star,
        (1.0 - gap) * star,
        float(random.random()) * star,
    )
    return kinds[random.integers(len(kinds))]


def chosen_state(random: Generator, alpha: float) -> tuple[float, float, float, float, float]:
    """(alpha, kappa, mu, V, delta): kappa, mu in [1e-6, 1e6], kappa V in [1e-300, 1e300], half of
    it in [1e-8, 1e8].
    """
    most = 300.0 if random.random() < 0.5 else 8.0
    kappa, mu, kappa_V = powers(random, (-6.0, 6.0), (-6.0, 6.0), (-most, most))
    delta = chosen_creep(
        random, contact_enclosure(alpha, kappa, mu, kappa_V / kappa, 0.0)["delta_star"]
    )
    sign_V, sign_delta = random.choice([-1.0, 1.0], 2).tolist()
    return alpha, kappa, mu, sign_V * kappa_V / kappa, sign_delta * delta


def free(random):
    """alpha in [1, 1e4], kappa in [0.5, 200], mu in [0.01, 3], gamma in [1e-3, 1e8], j in [0.1, 2],
    starts of every sign in [-2, 2]^2, half of them at an edge: V0 = 0, omega0 = 0, pure rolling,
    V0 + j omega0 = 0; onset and rest within and beyond the end.

    At alpha = 1 the last edge would stop both speeds at once and for good, so that no error is
    relative to anything (tests/motion/test_nasty_starts.py has it); there it is missed by 1e-3.
    """
    alpha = 1.0 if random.random() < 0.05 else powers(random, (0.0, 4.0))[0]
    kappa, mu, gamma = powers(
        random, (np.log10(0.5), np.log10(200.0)), (-2.0, np.log10(3.0)), (-3.0, 8.0)
    )
    j = float(random.choice([0.5, 1.0]) if random.random() < 0.3 else random.uniform(0.1, 2.0))
    V0, omega0 = random.uniform(-2.0, 2.0, 2).tolist()
    edges = [(0.0, omega0), (V0, 0.0), (V0, V0), (V0, -V0 / j if alpha > 1.0 else -0.999 * V0 / j)]
    V0, omega0 = (*edges, *4 * [(V0, omega0)])[random.integers(8)]
    slide = abs(omega0 - V0) / (gamma * mu * (1.0 + 1.0 / j))
    decay = (1.0 + j) / (gamma * max((alpha - 1.0) / alpha, 0.1))
    sliding = random.random() < 0.2 and slide > 0.0
    end = random.random() * slide if sliding else slide + 10.0 ** random.uniform(-1.0, 1.5) * decay
    return Case(vr.Scene(alpha, kappa, mu, gamma, j), V0, omega0, float(end) * OUTPUT_SHARES, {})


def slight(random):
    """Friction so slight that rolling resistance spends nearly all of it, on cylinders of little
    inertia.
    """
    alpha, kappa, mu, gamma, j = powers(
        random, (-1.0, 3.0), (0.0, 3.0), (-6.0, -5.0), (-2.0, 2.0), (-3.0, 0.0)
    )
    V0, omega0 = (random.normal(size=2) * powers(random, (-5.0, 0.0), (-5.0, 0.0))).tolist()
    slide = abs(omega0 - V0) / (gamma * mu * (1.0 + 1.0 / j))
    end = (
        slide * random.uniform(0.3, 1.1)
        + 10.0 ** random.uniform(-1.0, 1.5) * (1.0 + j) * (1.0 + 1.0 / alpha) / gamma
    )
    return Case(
        vr.Scene(1.0 + alpha, kappa, mu, gamma, j), V0, omega0, float(end) * OUTPUT_SHARES, {}
    )


def driven(random, wild=False):
    """A scene, most of them of no cylinder if ``wild``, a start from rest or not, and a drive of up
    to three pieces.
    """
    alpha, kappa, mu = powers(
        random, *([(-2, 8), (-1, 3), (-6, 0.3)] if wild else [(-1, 2), (0.3, 2), (-1.7, 0)])
    )
    j = powers(random, (-3.0, 3.0))[0] if wild else random.uniform(0.2, 1.2)
    V0, omega0 = random.normal(size=2) * 10.0 ** random.uniform(-2.0, 0.5) * (random.random() < 0.7)
    end, size = powers(random, (0.0, 2.0), (-2.0, 0.0))
    cuts = np.repeat(np.sort(random.uniform(0.0, end, random.integers(0, 3))), 2)
    times = np.concatenate([[0.0], cuts, [end]])
    values = random.normal(size=(2, times.size)) * 2.0 * mu * size
    if random.random() < 0.5:  # pieces that stay
        values = np.repeat(values[:, ::2], 2, axis=1)
    drive = {
        name: vr.Schedule(times, each * (random.random() < 0.7))
        for name, each in zip(("force", "torque"), values)
    }
    return Case(
        vr.Scene(1.0 + alpha, kappa, mu, 1.0, j), V0, omega0, np.linspace(0.0, end, 30), drive
    )


def braked(random):
    """Such a motion with a brake, a quarter of them at alpha = 1; in half of them one of the speeds
    is 0 at first.
    """
    scene, V0, omega0, t, drive = driven(random)
    scene = scene.replace(alpha=1.0) if random.random() < 0.25 else scene
    times = drive["torque"].times
    brake = np.abs(random.normal(size=times.size)) * scene.mu * 10.0 ** random.uniform(-1.0, 0.5)
    brake *= np.repeat(random.random(times.size // 2) < 0.7, 2)
    V0, omega0 = ((V0, omega0), (V0, omega0), (V0, 0.0), (0.0, omega0))[random.integers(4)]
    return Case(scene, V0, omega0, t, drive | {"brake": vr.Schedule(times, brake)})


def prescribed(random):
    """V or omega prescribed, as large as the other speed at first times 1e-9 to 1e3, and long
    enough for that to pass.

    Returns
    -------
    Case
        alpha - 1 in [0.01, 1e4], kappa in [1e-3, 1e3], mu in [1e-5, 2], at most kappa, so that
        omega does not change its sign in partial slip; gamma and j in [0.01, 100].  The speed
        stays,
        ramps up and down, falls by up to 8 decades and stays, or stands at 0 for a while; the other
        one is driven by a force or a torque of up to 4 mu that stays, ramps and jumps.
    """
    alpha, kappa, mu, gamma, j = powers(
        random, (-2.0, 4.0), (-3.0, 3.0), (-5.0, 0.3), (-2.0, 2.0), (-2.0, 2.0)
    )
    mu = min(mu, kappa)
    by_V = random.random() < 0.5
    other, ratio, size, longer = powers(random, (-4.0, 1.0), (-9.0, 3.0), (-2.0, 0.6), (-0.3, 1.3))
    other *= float(random.normal()) * float(random.random() < 0.8)
    end = max(abs(other), 1e-3) * (j if by_V else 1.0) / (mu * gamma) * longer
    speed = _prescribed_speed(random, end, max(abs(other), 1e-3) * ratio)
    cuts = np.repeat(np.sort(random.uniform(0.0, end, random.integers(0, 4))), 2)
    times = np.concatenate([[0.0], cuts, [end]])
    acting = vr.Schedule(times, random.normal(size=times.size) * mu * size)
    scene = vr.Scene(1.0 + alpha, kappa, mu, gamma, j)
    t = np.linspace(0.0, end, 25)
    if by_V:
        return Case(scene, None, other, t, {"V": speed, "torque": acting})
    return Case(scene, other, None, t, {"omega": speed, "force": acting})


def _prescribed_speed(random, end, size):
    """A speed of about this size that stays, ramps, falls by up to 8 decades, or stands at 0 for a
    while.
    """
    sign = float(random.choice([-1.0, 1.0]))
    times = np.sort(random.uniform(0.0, end, 4))
    kind = random.integers(4)
    if kind == 0:
        return vr.Schedule([0.0], [sign * size])
    if kind == 1:
        return vr.Schedule(times, random.normal(size=4) * size)
    if kind == 2:
        return vr.Schedule(times[:2], [sign * size, sign * size * powers(random, (-8.0, 0.0))[0]])
    return vr.Schedule(times, [sign * size, 0.0, 0.0, size * float(random.normal())])


def fed_back(random):
    """Such a motion with gains, of which none makes the speeds grow."""
    case = driven(random)
    force_V, force_omega, torque_omega = -(10.0 ** random.uniform(-1.0, 1.0, 3)) * (
        random.random(3) < 0.6
    )
    force, torque = (case.drive[name] for name in ("force", "torque"))
    fed = {
        "force": vr.Feedback(force, force_V, force_omega),
        "torque": vr.Feedback(torque, 0.0, torque_omega),
    }
    return case._replace(drive=fed)
