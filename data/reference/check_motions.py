"""Make check_motions.csv and check_driven.json: motions in extended precision, in Arb's digits.

    python -m data.reference.check_motions [free|driven ...] [--count N] [-o FOLDER]

Each file holds its inputs; its values are made from them again, and the file is written anew (the
first N of them with --count).  Each motion is rolled twice, the second time with more nodes,
shorter steps and more digits; how far the two differ stands beside them.

Eq. (22), free or with forces, slopes, brakes, prescribed speeds.  Nothing is shared with the
kernels but the equations: the matching conditions of the material as they stand, collocation of
high order, steps that end at every change of the law, every corner of the drive and every output.
"""

from __future__ import annotations

import argparse
import functools
import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import accumulate, groupby, pairwise
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import flint
import numpy as np
from flint import arb
from numpy.typing import NDArray
from tqdm import tqdm

from pipeline import stage
from pipeline.evidence.truth.enclosures import zone_of
from pipeline.evidence.truth.material import Material, material_of
from pipeline.evidence.truth.reference import (
    DRIVEN,
    FREE,
    OUTPUTS,
    PATHS,
    SPEEDS,
    Case,
    driven_motion,
    free_motion,
)
from viscoroll import Bodies
from viscoroll.core.drives_and_labels import Feedback, Schedule
from viscoroll.core.errors import ConvergenceError
from viscoroll.core.files import write_text
from viscoroll.rollers import Scene

# --- Radau IIA collocation of any order: a polynomial through a start and nodes ---

# (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, Sect. IV.5.)


@dataclass(frozen=True)
class Radau:
    """Nodes on (0, 1], the last of them 1, and what goes with them; made by :func:`radau`.

    ``slopes``: derivatives at the nodes from values at 0 and the nodes, ``matrix`` the latter part
    in doubles;
    ``weights``: of the integral; ``bary``: barycentric weights of the nodes; ``tail``: weights of
    the values at 0 and the nodes in the last Legendre coefficient.
    """

    nodes: list[Any]
    slopes: Any
    weights: list[Any]
    bary: list[Any]
    tail: list[Any]
    matrix: NDArray

    def at(self, values: list[list[Any]], theta: Any) -> list[Any]:
        """The polynomial through the nodes at the share ``theta`` of the step, not at a node."""
        shares = [w / (theta - c) for w, c in zip(self.bary, self.nodes, strict=True)]
        return [weighted(shares, column) / sum(shares) for column in zip(*values, strict=True)]


def weighted(weights: Sequence[Any], values: Sequence[Any]) -> Any:
    """Their sum."""
    return sum(w * value for w, value in zip(weights, values, strict=True)).mid()


@functools.cache
def radau(count: int, bits: int) -> Radau:
    """The method with ``count`` nodes, order 2 count - 1."""
    with flint.ctx.workprec(4 * bits + 20 * count):
        x = flint.fmpq_poly([-1, 2])
        lower, upper = flint.fmpq_poly([1]), x
        for n in range(1, count):
            lower, upper = upper, ((2 * n + 1) * x * upper - n * lower) / (n + 1)
        difference = (upper - lower) * (upper - lower).denom()
        roots = flint.fmpz_poly([int(c) for c in difference.coeffs()]).complex_roots()
        nodes = sorted((root.real for root, _ in roots), key=float)
        points = [arb(0), *nodes]
        bary, slopes = _barycentric(points), flint.arb_mat(count, count + 1)
        for i in range(1, count + 1):
            others = [m for m in range(count + 1) if m != i]
            for m in others:
                slopes[i - 1, m] = bary[m] / bary[i] / (points[i] - points[m])
            slopes[i - 1, i] = -sum(slopes[i - 1, m] for m in others)
        square = flint.arb_mat([[slopes[i, m] for m in range(1, count + 1)] for i in range(count)])
        weights = square.inv().entries()[-count:]
        tail = [w / math.comb(2 * count, count) for w in bary]
        matrix = np.array([float(value) for value in square.entries()]).reshape(count, count)
    return Radau(nodes, slopes, weights, _barycentric(nodes), tail, matrix)


def _barycentric(points: list[Any]) -> list[Any]:
    return [
        1 / math.prod(p - q for m, q in enumerate(points) if m != i) for i, p in enumerate(points)
    ]


# --- What drives a motion, over pieces of time in which all of it is linear. ---

NAMES = ("force", "torque", "brake", "V", "omega")


class Piece(NamedTuple):
    """What acts from ``start`` to ``end`` (tau).

    lines : names -> (value at the start, slope over tau)
    prescribed : the speed that is, "" for none
    gains : of force over V and omega, of torque over V and omega
    """

    start: Any
    end: Any
    lines: dict[str, tuple[Any, Any]]
    prescribed: str
    gains: list[Any]

    @property
    def braked(self) -> bool:
        """Whether there is a brake."""
        return any(part != 0 for part in self.lines["brake"])

    @property
    def rate(self) -> Any:
        """Slope of the prescribed speed."""
        return self.lines[self.prescribed][1]

    def at(self, tau: Any, V: Any, omega: Any) -> tuple[Any, Any, Any]:
        """(Force, torque, the most that the brake can take)."""
        values = (value + (tau - self.start) * slope for value, slope in self.lines.values())
        (force, torque, brake, *_), per = values, self.gains
        return force + per[0] * V + per[1] * omega, torque + per[2] * V + per[3] * omega, brake


def pieces_of(drive: dict[str, Any], gamma: Any, tangent: Any, end: Any) -> list[Piece]:
    """Pieces up to the time ``end``; ``tangent`` of the slope is added to the force."""
    courses, gains = {}, []
    for name in NAMES:
        given = drive.get(name) or 0.0
        if name in ("force", "torque"):
            gains += (
                [arb(given.V), arb(given.omega)] if isinstance(given, Feedback) else [arb(0)] * 2
            )
        given = given.value if isinstance(given, Feedback) else given
        times, values = (
            (given.times, given.values) if isinstance(given, Schedule) else ([0.0], [given])
        )
        more = tangent if name == "force" else 0
        pairs = zip(times, values, strict=True)
        courses[name] = [((gamma * arb(float(t))).mid(), arb(float(v)) + more) for t, v in pairs]
    prescribed = "".join(name for name in ("V", "omega") if drive.get(name) is not None)
    corners = {float(tau): tau for course in courses.values() for tau, _ in course if 0 < tau < end}
    edges = [arb(0), *(tau for _, tau in sorted(corners.items())), end]
    return [
        Piece(
            start,
            stop,
            {name: _linear(course, start) for name, course in courses.items()},
            prescribed,
            gains,
        )
        for start, stop in pairwise(edges)
    ]


def _linear(course: list[tuple[Any, Any]], start: Any) -> tuple[Any, Any]:
    """(Value at the start of a piece, slope in it)."""
    for (first, low), (last, high) in pairwise(course):
        if first <= start < last:
            slope = ((high - low) / (last - first)).mid()
            return (low + (start - first) * slope).mid(), slope
    return course[0 if start < course[0][0] else -1][1], arb(0)


# --- Full and partial slip of a motion in extended precision: what a state is, what acts on it,
# what ends it. ---
#
# Time is tau = gamma t.  A state is s = 1/zeta along ``ahead``, and omega - V in full slip, b = 1 -
# eta/zeta in partial slip.  With l = lam/(2 kappa)
#
#     V = s l      omega - V = mu s l G      G = l s (F(zeta) - F(eta))

#: of a bracket, to the last digit
_HALVINGS = 400
#: 1/zeta below which it is 0, and the share of the contact below which a stick zone is none
_LEAST, NOTHING = arb("1e-40").mid(), 1e-26
#: s at the end of a step, over that at its start, that is 0
_CLOSED = 1e-20
#: share of a piece behind which it is looked at where it begins with what moves nothing
_SOON = 1e-6


def sign(value: Any) -> int:
    """-1, 0 or 1."""
    return int(value > 0) - int(value < 0)


def root(rising: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Zero of a function that rises from below 0 at ``low``."""
    for _ in range(_HALVINGS):
        middle = ((low + high) / 2).mid()
        if not low < middle < high:
            break
        low, high = (low, middle) if rising(middle) > 0 else (middle, high)
    return ((low + high) / 2).mid()


class Law(NamedTuple):
    """A scene."""

    material: Material
    kappa: Any
    mu: Any
    j: Any


class Contact(NamedTuple):
    """What a state is: V, omega - V, friction, the parts of M, with their signs; the least omega -
    V of full slip.
    """

    V: Any
    slip: Any
    Q: Any
    M_half_space: Any
    M_cylinder: Any
    limit: Any

    @property
    def omega(self) -> Any:
        return self.V + self.slip


@dataclass
class Phase:
    """A regime and the state in it.

    spin : sign of omega that the brake acts against; ``locked`` : it holds omega at 0
    sticks : whether a part of the contact does
    ahead : sign of V, or of V' where V = 0; ``sigma`` : sign of omega - V
    u : the state
    """

    law: Law
    piece: Piece
    spin: int
    locked: bool
    sticks: bool
    ahead: int
    sigma: int
    u: list[Any]

    @property
    def regime(self) -> str:
        return "locked" if self.locked else "partial slip" if self.sticks else "full slip"

    def contact(self, u: list[Any] | None = None) -> Contact:
        """What a state is, its own if none is given."""
        s, other = u or self.u
        _, kappa, mu, _ = self.law
        size = max(abs(s), _LEAST)
        whole = zone_of(self.law.material, 1 / size)
        pressed = 1 + 2 * whole.h * size
        length = 1 / (2 * kappa * pressed.sqrt())
        V, slip, Q = self.ahead * s * length, other, self.sigma * mu
        if self.sticks:
            rest, g, h = 1 - other, 0, 0
            if rest >= NOTHING:
                stick = zone_of(self.law.material, (rest / size).mid())
                g, h = stick.g, stick.h
            slip = self.sigma * mu * s * length**2 * (other + size * (whole.g - g))
            Q *= 1 - (rest * rest + 2 * rest * size * h) / pressed
        limit = mu * abs(V) * length * (1 + whole.g * size)
        return Contact(
            *(value.mid() for value in (V, slip, Q, V * whole.parts[0], V * whole.parts[1], limit))
        )

    def pushed(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(V', omega' - V'), Eq. (22) with M/2 as each body's own part."""
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        d_V, d_omega = (
            c.Q - c.M_half_space + force,
            (torque - self.spin * brake - c.Q - c.M_cylinder) / self.law.j,
        )
        if self.piece.prescribed == "V":
            d_V = self.piece.rate
        if self.piece.prescribed == "omega":
            d_omega = self.piece.rate
        return d_V, (0 if self.locked else d_omega) - d_V

    def paths(self, u: list[Any], tau: Any) -> list[Any]:
        """Rates of x, angle, work of force and torque, losses in brake and slip."""
        c = self.contact(u)
        force, torque, brake = self.piece.at(tau, c.V, c.omega)
        if self.piece.prescribed == "V":
            force = self.piece.rate - c.Q + c.M_half_space
        if self.piece.prescribed == "omega":
            torque = self.law.j * self.piece.rate + c.Q + c.M_cylinder
        lost = brake * abs(c.omega) * abs(self.spin)
        return [c.V, c.omega, force * c.V, torque * c.omega, lost, c.slip * c.Q]

    def _held(self, c: Contact, tau: Any) -> tuple[Any, Any]:
        """(Torque that would turn a wheel that stands, what the brake can take beyond it)."""
        _, torque, brake = self.piece.at(tau, c.V, 0)
        excess = torque - c.Q - c.M_cylinder
        return excess, brake - abs(excess)

    def events(self) -> dict[str, Callable[[list[Any], Any], Any]]:
        """Functions that are positive, or 0 at first, before."""
        if self.sticks:
            return {"no creep": lambda u, _: u[1], "rest": lambda u, _: u[0]}

        def edge(u: list[Any], _: Any) -> Any:
            c = self.contact(u)
            return self.sigma * c.slip - c.limit

        found = {"reversal": lambda u, _: u[0], "edge": edge}
        if self.locked:
            found["freed"] = lambda u, tau: self._held(self.contact(u), tau)[1]
        elif self.spin:
            found["stop"] = lambda u, _: self.spin * self.contact(u).omega
        return found

    def after(self, event: str | None, u: list[Any], tau: Any) -> Phase | None:
        """The phase behind a step, which ends on an event or none; None at V = omega = 0."""
        s, other = u
        if event is None:
            if self.sticks and 1 - other <= NOTHING and other > self.u[1]:
                return replace(self, sticks=False, u=[s, self.contact([s, arb(1)]).slip])
            return replace(self, u=u)
        if event == "no creep":
            return replace(self, sigma=-self.sigma, u=[s, arb(0)])
        if event == "edge" and s > _CLOSED * abs(self.u[0]):
            return replace(self, sticks=True, u=[s, arb(1)])
        if event in ("rest", "edge"):  # the stick band closes at V = 0: omega is 0 too
            return None
        if event == "reversal":
            return None if self.locked else replace(self, u=[arb(0), other], ahead=-self.ahead)
        still = replace(self, u=[s, -self.contact(u).V], locked=False)
        excess, beyond = still._held(still.contact(), tau)
        if event == "stop" and beyond >= 0:
            return replace(still, locked=True)
        return replace(still, spin=sign(excess) if self.piece.braked else 0)

    def under(self, piece: Piece, tau: Any) -> Phase:
        """The same under the next piece of the drive."""
        moved = replace(self, piece=piece)
        c = moved.contact()
        excess, beyond = moved._held(c, tau)
        if self.locked and beyond < 0:
            return replace(moved, locked=False, spin=sign(excess) if piece.braked else 0)
        return moved if self.locked else replace(moved, spin=sign(c.omega) if piece.braked else 0)

    def balance(self, tau: Any) -> tuple[Any, Any] | None:
        """(b with the sign of delta, V' along ``ahead``) at V = 0; None where there is no balance.

        (omega' - V')/(mu l) = b V', F = z, H = z^2, l = 1/(2 kappa); the left side less the right
        one falls with b.
        """

        def pulled(b: Any) -> tuple[Any, Any]:
            c = Contact(0, 0, self.ahead * self.law.mu * b * (2 - abs(b)), 0, 0, 0)
            d_V, d_slip = (self.ahead * rate for rate in self.pushed(c, tau))
            return b * d_V - d_slip * 2 * self.law.kappa / self.law.mu, d_V

        if not (pulled(arb(-1))[0] < 0 < pulled(arb(1))[0]):
            return None
        b = root(lambda b: pulled(b)[0], arb(-1), arb(1))
        return b, pulled(b)[1]

    def guess(self, times: list[Any], tau: Any) -> list[list[Any]]:
        """States some times later: in partial slip as now, from V = 0 as the balance has it; else
        at their pace.
        """
        kappa = self.law.kappa
        if not self.sticks:
            d_V, d_slip = self.pushed(self.contact(), tau)
            pace = 2 * kappa * self.ahead * d_V, d_slip
            return [
                [(part + rate * time).mid() for part, rate in zip(self.u, pace, strict=True)]
                for time in times
            ]
        at = self.balance(tau) if self.u[0] == 0 else None
        if at is None:
            return [self.u for _ in times]
        there = [self.balance(tau + time) or at for time in times]
        return [
            [(kappa * (at[1] + a) * time).mid(), abs(b)]
            for (b, a), time in zip(there, times, strict=True)
        ]


def begun(law: Law, piece: Piece, V: Any, omega: Any) -> Phase | None:
    """The phase of a start; None at rest."""
    if V == 0 and omega == 0:
        return None
    slip, none = omega - V, arb(0)
    phase = Phase(
        law,
        piece,
        sign(omega) if piece.braked else 0,
        False,
        False,
        sign(V),
        sign(slip) or 1,
        [none, slip],
    )
    if V == 0:
        return replace(phase, ahead=sign(phase.pushed(phase.contact(), none)[0]) or 1)
    most = 4 * law.kappa * abs(V)
    for a, b in zip(law.material.a, law.material.b, strict=True):  # lam is at least 1/sqrt(alpha)
        most *= a / b
    s = root(lambda s: abs(phase.contact([s, slip]).V) - abs(V), none, most)
    phase.u = [s, slip]
    if abs(slip) >= phase.contact().limit:
        return phase
    phase = replace(phase, sticks=True, u=[s, none])
    if slip == 0:
        return replace(phase, sigma=sign(phase.pushed(phase.contact(), none)[1]) or 1)
    return replace(
        phase, u=[s, root(lambda b: abs(phase.contact([s, b]).slip) - abs(slip), none, arb(1))]
    )


def leaving(piece: Piece, law: Law, tau: Any) -> Any:
    """When a cylinder at rest is first moved, at most the end of the piece."""

    def moves(at: Any) -> Any:
        """Positive where it does; convex in time."""
        force, torque, brake = piece.at(at, 0, 0)
        if piece.prescribed:
            needs = -force if piece.prescribed == "omega" else torque
            return abs(needs) - law.mu if piece.rate == 0 else arb(1)
        return -min(law.mu - abs(force), brake - abs(force + torque))

    soon = (tau + (piece.end - tau) * _SOON).mid()
    if moves(soon) > 0:
        return tau
    return root(moves, soon, piece.end) if moves(piece.end) > 0 else piece.end


def departed(piece: Piece, law: Law, tau: Any) -> Phase:
    """The phase that leaves rest at tau."""
    soon, braked = (tau + (piece.end - tau) * _SOON).mid(), piece.braked
    for ahead in (1, -1):
        phase = Phase(law, piece, ahead * braked, False, True, ahead, ahead, [arb(0), arb(0)])
        there, now = phase.balance(soon), phase.balance(tau)
        if there is not None and now is not None and there[1] > 0:
            side = sign(there[0]) or 1
            return replace(phase, sigma=side * ahead, u=[arb(0), max(side * now[0], arb(0))])
    for sigma in (1, -1):
        phase = Phase(law, piece, 0, False, False, 1, sigma, [arb(0), arb(0)])
        c = phase.contact()
        excess, beyond = phase._held(c, soon)
        spin = sign(excess) if braked and beyond < 0 else 0
        phase = replace(phase, spin=spin, locked=braked and spin == 0)
        d_V, d_slip = phase.pushed(c, soon)
        if sigma * d_slip > 0:
            return replace(phase, ahead=sign(d_V) or 1)
    raise AssertionError("no way out of rest")


# --- A step of a motion in extended precision: collocation of V and omega - V, and the event that
# it ends on. ---

#: Iterations of a step.
_MOST_ITERATIONS = 14
#: Iterations that take a new matrix.
_MATRICES = 3
#: Steps that look for an event.
_CUTS = 12
#: a correction below this share of the unknowns leaves nothing to be corrected
_LAST_CORRECTION = 1e-26
#: Share of a step to which an event is met.
_MET = 1e-28
#: Share of a step up to which an event is looked for.
_BEYOND = arb("1.001")
#: errors of omega - V are measured by no less than this part of its limit
_LEAST_SLIP = 1e-8


def solved(
    phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau
) -> list[list[Any]] | None:
    """States at the nodes of one step, from a guess; None where the iteration does not converge."""
    n, start, length = len(method.nodes), list(phase.contact()[:2]), float(h)
    whole: NDArray[np.float64] = np.empty(0)
    scale = np.empty(0)
    for iteration in range(_MOST_ITERATIONS):
        rates = [_rates(phase, u, tau + h * c) for u, c in zip(values, method.nodes, strict=True)]
        defect = method.slopes * flint.arb_mat([start, *(state for state, _ in rates)])
        residual = np.array(
            [float(defect[i, k] - h * rates[i][1][k]) for i in range(n) for k in range(2)]
        )
        if iteration < _MATRICES:
            size = np.abs(np.array([[float(part) for part in u] for u in values])).max(axis=0)
            fastest = max(abs(float(state[0])) for state, _ in rates)
            scale = np.tile(
                np.maximum(size, [1e-200, 1e-8 if phase.sticks else 1e-8 * fastest + 1e-200]), n
            )
            whole = np.zeros((2 * n, 2 * n))
            for i, u in enumerate(values):
                for m in range(2):
                    by = -(arb(10) ** -14) * abs(u[m]) - arb(10) ** -22 * (1e-10 if m == 0 else 1)
                    beside = [part + by * (k == m) for k, part in enumerate(u)]
                    moved = _rates(phase, beside, tau + h * method.nodes[i])
                    slopes = [
                        [float((a - b) / by) for a, b in zip(*pair)]
                        for pair in zip(moved, rates[i], strict=True)
                    ]
                    for k in range(2):
                        whole[k::2, 2 * i + m] = method.matrix[:, i] * slopes[0][k]
                        whole[2 * i + k, 2 * i + m] -= length * slopes[1][k]
        matrix = whole * scale
        rows = np.abs(matrix).max(axis=1)
        if not (np.isfinite(matrix).all() and np.isfinite(residual).all() and (rows > 0.0).all()):
            return None
        change = np.linalg.solve(matrix / rows[:, None], residual / rows)
        by_node = (change * scale).reshape(n, 2)
        values = [
            [(u - float(d)).mid() for u, d in zip(*pair, strict=True)]
            for pair in zip(values, by_node, strict=True)
        ]
        beyond = phase.sticks and any(u[1] > 1 + NOTHING for u in values)
        if beyond or not np.isfinite(change).all() or np.abs(change).max() > 1e6:
            return None
        if np.abs(change).max() < _LAST_CORRECTION:
            return values
    return None


def _rates(phase: Phase, u: list[Any], tau: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """V and omega - V of a state, and their rates."""
    c = phase.contact(u)
    return (c.V, c.slip), phase.pushed(c, tau)


def met(
    phase: Phase, tau: Any, h: Any, method: Radau
) -> tuple[str | None, Any, list[list[Any]] | None]:
    """(Event, length, states at the nodes) of a step up to h that ends at the first event; None
    where none is found.
    """
    values = solved(phase, tau, h, phase.guess([h * c for c in method.nodes], tau), method)
    event = None
    for _ in range(_CUTS):
        if values is None:
            break
        event, share = _first(event, phase, tau, h, values, method)
        if event is None or abs(share - 1) < _MET:
            return event, h, values
        guess = [method.at(values, share * c) for c in method.nodes]
        h = (h * share).mid()
        values = solved(phase, tau, h, guess, method)
    return None, h, None


def _first(
    known: str | None, phase: Phase, tau: Any, h: Any, values: list[list[Any]], method: Radau
) -> tuple[str | None, Any]:
    """(Event whose function first falls below 0, share of the step), that of the ``known`` one
    maybe beyond its end.
    """
    soonest, least = None, _BEYOND
    for event, function in phase.events().items():

        def along(theta: Any, function: Any = function) -> Any:
            return function(method.at(values, theta), tau + h * theta)

        nodes = [arb(0), *method.nodes, _BEYOND]
        told = [function(u, tau + h * c) for u, c in zip(values, method.nodes, strict=True)]
        told += [along(_BEYOND)] if event == known else []
        beyond = next(
            (i for i, value in enumerate(told) if value < -NOTHING * (event == "no creep")), None
        )
        if beyond is None:
            continue
        share = root(lambda theta: -along(theta), nodes[beyond], nodes[beyond + 1])
        if share < least:
            soonest, least = event, share
    return soonest, least


def left_out(phase: Phase, values: list[list[Any]], method: Radau) -> float:
    """The last Legendre coefficients of V and omega - V, over the largest of them in the step."""
    states = [phase.contact(), *map(phase.contact, values)]
    fastest = max(max(abs(float(c.V)), abs(float(c.omega))) for c in states)
    slip = (
        max(max(abs(float(c.slip)), _LEAST_SLIP * float(c.limit)) for c in states)
        if phase.sticks
        else fastest
    )
    sizes = max(fastest, 1e-200), max(slip, 1e-200)
    return max(
        abs(float(weighted(method.tail, [c[k] for c in states]))) / sizes[k] for k in range(2)
    )


# --- A motion ---

#: Steps of a motion after which it is given up.
_MOST_STEPS = 20_000
#: Largest growth of a step, and the least length of one that is tried again, over the step before.
_GROWTH = 4.0
_SHRINK = 0.2
#: Length of a step over that which the error estimate allows.
_SAFETY = 0.8
#: An error below this one counts as this one.
_LEAST_ERROR = 1e-60
#: A step shorter than this share of what is left is given up.
_SHORTEST = 1e-40
#: First step of a phase over what is left.
_FIRST = 1e-3
#: First step into partial slip over what is left.
_ENTRY = 1e-14
#: Share of the way to the end of a stick zone that a step may go.
_APPROACH = 0.9


@dataclass
class PreciseMotion:
    """What is found at the times ``t``, as ``arb`` without a radius.

    switches : pairs of time and regime that follows ("rest" with V = omega = 0)
    reversals : times at which V changes its sign
    """

    t: list[float]
    V: list[Any] = field(default_factory=list)
    omega: list[Any] = field(default_factory=list)
    x: list[Any] = field(default_factory=list)
    angle: list[Any] = field(default_factory=list)
    work_force: list[Any] = field(default_factory=list)
    work_torque: list[Any] = field(default_factory=list)
    brake_loss: list[Any] = field(default_factory=list)
    slip_loss: list[Any] = field(default_factory=list)
    switches: list[tuple[Any, str]] = field(default_factory=list)
    reversals: list[Any] = field(default_factory=list)
    steps: int = 0

    @property
    def onset_time(self) -> Any:
        """First change from full to partial slip, or None."""
        return next((when for when, regime in self.switches if regime == "partial slip"), None)


def roll_precise(
    scene: Scene,
    V0: float | None,
    omega0: float | None,
    t: Sequence[float],
    *,
    slope: float | None = None,
    tolerance: float = 1e-22,
    nodes: int = 22,
    bits: int = 220,
    **drive: Any,
) -> PreciseMotion:
    """Motion from (V0, omega0) at ascending times ``t`` > 0; every argument is the exact double it
    is.

    Parameters
    ----------
    scene : one scene, of a material or of two bodies that share no creep time.
    slope : angle in radians.
    tolerance : what a step may leave out, relative to the largest speed in it.
    nodes : of the collocation, whose order is twice that less one.
    bits : working precision.
    **drive : force, torque, brake, V, omega as for :func:`viscoroll.roll`: numbers, schedules,
    Feedback.

    Raises
    ------
    ConvergenceError
        If a motion takes more than 20000 steps, or a step becomes too small.

    Notes
    -----
    ``data/reference/check_driven.json`` states for every motion there how far other nodes and
    tolerances are off (``tests/evidence/test_precise.py``).
    """
    with flint.ctx.workprec(bits):
        theta = arb(float(slope or 0.0))
        kappa, mu, gamma, j = (
            arb(float(value)) for value in (scene.kappa, scene.mu, scene.gamma, scene.j)
        )
        kappa, gamma = (kappa / theta.cos().sqrt()).mid(), (gamma * theta.cos()).mid()
        material = scene.material
        if isinstance(material, Bodies) and scene.like_bodies:
            material = material.cylinder
        law = Law(material_of(float(scene.alpha) if material is None else material), kappa, mu, j)
        motion = PreciseMotion([float(time) for time in t])
        ends = [(gamma * arb(time)).mid() for time in motion.t]
        pieces = pieces_of(drive, gamma, theta.tan().mid(), ends[-1])
        first = {name: arb(float(value or 0.0)) for name, value in (("V", V0), ("omega", omega0))}
        if pieces[0].prescribed:
            first[pieces[0].prescribed] = pieces[0].lines[pieces[0].prescribed][0]
        rolling = _Rolling(law, pieces, motion, gamma, (radau(nodes, bits), tolerance), **first)
        for end in ends:
            while rolling.tau < end:
                rolling.go_on(end)
            rolling.keep()
    return motion


class _Rolling:
    """A motion up to tau: its phase (None at rest), the piece of the drive, what has added up, the
    step to be tried.
    """

    def __init__(
        self,
        law: Law,
        pieces: list[Piece],
        motion: PreciseMotion,
        gamma: Any,
        how: tuple[Radau, float],
        V: Any,
        omega: Any,
    ) -> None:
        self.law, self.motion, self.gamma, self.tau, self.h = law, motion, gamma, arb(0), arb(0)
        self.method, self.tolerance = how
        self.piece, *self.pieces = pieces
        self.phase, self.heading = begun(law, self.piece, V, omega), sign(V)
        self.paths = [arb(0)] * len(PATHS)
        self._leave()

    @property
    def regime(self) -> str:
        if self.phase is None:
            return "held" if self.piece.braked or self.piece.prescribed else "rest"
        return self.phase.regime

    def keep(self) -> None:
        """What is found now."""
        contact = self.phase.contact() if self.phase else None
        self.motion.V.append(contact.V if contact else arb(0))
        self.motion.omega.append(
            contact.omega.mid() if contact and self.regime != "locked" else arb(0)
        )
        for name, value in zip(PATHS, self.paths, strict=True):
            getattr(self.motion, name).append(
                (value / self.gamma).mid() if name in ("x", "angle") else value
            )

    def go_on(self, end: Any) -> None:
        """One step, or the stay at rest, no further than the end, the next corner of the drive or
        the first event.
        """
        regime, motion = self.regime, self.motion
        if self.tau >= self.piece.end:
            self.piece, self.h = self.pieces.pop(0), arb(0)
            self.phase = self.phase and self.phase.under(self.piece, self.tau)
        limit = min(end, self.piece.end)
        if self.phase is None:
            self.tau = min(leaving(self.piece, self.law, self.tau), limit)
        else:
            self._step(self.phase, limit)
        self._leave()
        motion.steps += 1
        if motion.steps == _MOST_STEPS:
            raise ConvergenceError(f"roll_precise: more than {_MOST_STEPS} steps")
        when = (self.tau / self.gamma).mid()
        if self.regime != regime:
            motion.switches.append((when, self.regime))
        heading = self.phase.ahead if self.phase else 0
        if heading and self.heading and heading != self.heading:
            motion.reversals.append(when)
        self.heading = heading or self.heading

    def _leave(self) -> None:
        """From rest, if something moves the cylinder now."""
        if (
            self.phase is None
            and self.tau < self.piece.end
            and leaving(self.piece, self.law, self.tau) == self.tau
        ):
            self.phase, self.h = departed(self.piece, self.law, self.tau), arb(0)

    def _step(self, phase: Phase, limit: Any) -> None:
        left = (limit - self.tau).mid()
        if not self.h > 0:
            self.h = (left * (_ENTRY if phase.sticks and phase.u[1] == 1 else _FIRST)).mid()
        h = min(self.h, left)
        while True:
            if h < _SHORTEST * left:
                raise ConvergenceError("roll_precise: the step has become too small")
            event, length, values = met(phase, self.tau, h, self.method)
            factor = _SHRINK
            if values is not None:
                error = left_out(phase, values, self.method)
                factor = _SAFETY * (self.tolerance / max(error, _LEAST_ERROR)) ** (
                    1 / len(self.method.nodes)
                )
                if error <= self.tolerance:
                    break
            h = (h * max(_SHRINK, min(factor, 0.7))).mid()
        at_nodes = zip(values, self.method.nodes, strict=True)
        rates = [phase.paths(u, self.tau + length * c) for u, c in at_nodes]
        for n, column in enumerate(zip(*rates, strict=True)):
            self.paths[n] = (self.paths[n] + length * weighted(self.method.weights, column)).mid()
        self.tau = limit if event is None and length == left else (self.tau + length).mid()
        self.phase = phase.after(event, values[-1], self.tau)
        if event is not None or (self.phase is not None and self.phase.sticks != phase.sticks):
            self.h = arb(0)
            return
        grown = min(_GROWTH, factor) * length
        if (
            phase.sticks and values[-1][1] > values[-2][1]
        ):  # no further than a share of the way to full slip
            rate = (values[-1][1] - values[-2][1]) / (1 - self.method.nodes[-2]) / length
            grown = min(grown, _APPROACH * (1 - values[-1][1]) / rate)
        self.h = grown.mid()


# --- Both files ---

#: The second of two motions: what a step leaves out is about the power ``nodes`` of its length.
FINER = {"tolerance": 1e-26, "nodes": 28, "bits": 280}
#: Working precision of the differences between two motions.
_BITS = 400


def rolled_twice(case: Case) -> tuple[PreciseMotion, float]:
    """The finer of two motions, and how far they differ, to two digits."""
    given = case.scene, case.V0, case.omega0, case.t.tolist()
    coarse, fine = (roll_precise(*given, **case.drive, **how) for how in ({}, FINER))
    return fine, float(f"{difference(coarse, fine):.1e}")


def difference(one: PreciseMotion, other: PreciseMotion) -> float:
    """Worst of V, omega over the larger of both, paths and losses over their largest so far, events
    over themselves.
    """
    with flint.ctx.workprec(_BITS):
        if [regime for _, regime in one.switches] != [regime for _, regime in other.switches]:
            return math.inf
        events = ([*(when for when, _ in m.switches), *m.reversals] for m in (one, other))
        worst = [abs(a / b - 1) for a, b in zip(*events, strict=True) if b != 0]
        speeds = list(map(max, map(abs, other.V), map(abs, other.omega)))
        for name in (*SPEEDS, *PATHS):
            found = getattr(other, name)
            sizes = speeds if name in SPEEDS else accumulate(map(abs, found), max)
            worst += [
                abs(a - b) / size
                for a, b, size in zip(getattr(one, name), found, sizes)
                if size > 0
            ]
        return max(map(float, worst))


def free_rows(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row an output: inputs, values, onset (NaN: none), and the difference of the two
    motions.
    """
    case, _ = free_motion(rows)
    fine, apart = rolled_twice(case)
    onset = math.nan if fine.onset_time is None else float(fine.onset_time)
    found = {
        "motion": int(rows[0]["motion"]),
        "onset_time": onset,
        "switches": len(fine.switches),
        "difference": apart,
    }
    return [
        row | found | {name: float(getattr(fine, name)[i]) for name in OUTPUTS}
        for i, row in enumerate(rows)
    ]


def driven_row(row: dict[str, Any]) -> dict[str, Any]:
    """What a motion is and what it does, as the nearest doubles."""
    fine, apart = rolled_twice(driven_motion(row))
    found = {name: [float(value) for value in getattr(fine, name)] for name in (*SPEEDS, *PATHS)}
    switches = [[float(when), regime] for when, regime in fine.switches]
    return (
        row
        | found
        | {
            "difference": apart,
            "switches": switches,
            "reversals": [float(t) for t in fine.reversals],
        }
    )


def free(folder: Path, count: int | None) -> None:
    old = [list(rows) for _, rows in groupby(stage.read_rows(FREE), itemgetter("motion"))]
    rows = [row for rows in tqdm(old[:count], "motions", leave=False) for row in free_rows(rows)]
    stage.write_rows(folder / FREE.name, rows)


def driven(folder: Path, count: int | None) -> None:
    content = json.loads(DRIVEN.read_text(encoding="utf-8"))
    content["motions"] = [
        driven_row(row) for row in tqdm(content["motions"][:count], "driven motions", leave=False)
    ]
    write_text(folder / DRIVEN.name, json.dumps(content, indent=1) + "\n")


def main() -> int:
    """Make the files named, or both."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("files", nargs="*", metavar="FILE", help="free or driven; default: both")
    parser.add_argument("--count", type=int)
    parser.add_argument("-o", "--output", type=Path, default=FREE.parent)
    arguments = parser.parse_args()

    def made() -> None:
        for name in arguments.files or ("free", "driven"):
            (free if name == "free" else driven)(
                stage.make_folder(arguments.output), arguments.count
            )

    return stage.told("check_motions", made)


if __name__ == "__main__":
    sys.exit(main())
