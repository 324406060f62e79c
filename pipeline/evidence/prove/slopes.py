"""Slopes of Q and M against differences of enclosures; stress against enclosed integrals."""

from __future__ import annotations

import math
from typing import Any

import flint
import numpy as np
from flint import arb
from tqdm import tqdm

import viscoroll as vr
from pipeline.validation.states import random_states
from pipeline.validation.stresses import closures

from ..peers.standard import generators, standard
from ..truth.check_values import chosen_alpha
from ..truth.enclosures import (
    INPUTS,
    condition_numbers,
    contact_enclosure,
    shape_enclosure,
    slope_changes,
    slopes,
)
from .claim import Claim, at
from .shape import WAYS, at_edges, contact

SLOPE, STRESS, CLOSURE = 1e-10, 1e-11, 1e-11
#: where the edges of the contact and of the stick zone lie: four roundings of x and lam, four of beta
_SHIFT = 8.0 * 2.0**-53
_FIELDS = ("dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV")


def slope_scales(mu: float, V: float, alpha: float, delta_star: float) -> dict[str, float]:
    """What a slope may be measured by: a change of Q by mu as V or delta changes by all of itself; c for M."""
    return {
        "dQ_dV": mu / V, "dQ_ddelta": mu / delta_star, "dQ_domega": mu / (V * delta_star),
        "dM_dV": (alpha - 1.0) / alpha if alpha > 1.0 else 1.0,
    }  # fmt: skip


def slope_errors(found: Any, exact: dict[str, Any], scales: dict[str, float], condition: float) -> dict[str, float]:
    """dQ_ddelta, dQ_domega: relative, over what four roundings times the condition of beta exceed 1e-10; else by scale.

    dQ_dV and dM_dV pass through zero; the others go to it with beta.
    """
    off = {name: float(abs(arb(getattr(found, name)) - value).upper()) for name, value in exact.items()}
    excuse = max(1.0, 4.0 * 2.0**-53 * condition / SLOPE)
    return {
        name: error / scales[name] if name in ("dQ_dV", "dM_dV") else error / float(abs(exact[name])) / excuse
        for name, error in off.items()
    }


def allowance(given: dict[str, Any], scale: float) -> float:
    """What four roundings times the condition number of dQ_dV, over its scale, exceed 1e-10 by; 1 if they do not.

    dQ_dV depends on eta through A = H'/F', which rises from 0 within eta ~ 1/alpha: near the end of stick a relative
    error in delta, mu or V comes back up to about 2 alpha lam^2 (1 + epsilon)^2 times as large over mu/V.
    """
    return max(1.0, 4.0 * 2.0**-53 * slope_changes(given)["dQ_dV"] / scale / SLOPE)


def slope_rows(count: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    domain = "alpha in [1, 1e6], kappa V in [1e-8, 1e8], s in [1e-12, 1 - 1e-12]"
    measure = {
        "dQ_dV": "over μ/V, or where beyond the bound over its condition × 4.4e-6 μ/V",
        "dM_dV": "over (α − 1)/α",
    }
    relative = "relative, over max(1, condition of beta × 4.4e-6)"
    claims = {name: Claim(f"{name}, {measure.get(name, relative)}", domain, SLOPE) for name in _FIELDS}
    for _ in tqdm(range(count), desc="slopes", delay=1.0, leave=False):
        alpha = chosen_alpha(rng)
        kappa, mu, kappa_V, small, gap = (10.0 ** rng.uniform([-6, -6, -8, -12, -12], [6, 6, 8, 0, 0])).tolist()
        V, s = kappa_V / kappa, small if rng.random() < 0.5 else 1.0 - gap
        scene = vr.Scene(alpha, kappa, mu)
        delta_star = vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        found = vr.contact(scene, V, delta=s * delta_star, fields=(), slopes=True)
        given = dict(zip(INPUTS, map(arb, (alpha, kappa, mu, V, s * delta_star)), strict=True))
        exact, condition = slopes(given), condition_numbers(given)["beta"]
        with flint.ctx.workprec(200):
            exact["dQ_domega"] = exact["dQ_ddelta"] / V
            scales = slope_scales(mu, V, alpha, delta_star)
            errors = slope_errors(found, exact, scales, condition)
        if errors["dQ_dV"] > SLOPE:
            errors["dQ_dV"] /= allowance(given, scales["dQ_dV"])
        for name, error in errors.items():
            claims[name].add(error, at(alpha=alpha, kappa=kappa, mu=mu, V=V, s=s))
    return [one.row for one in claims.values()]


def jump_rows(rng: np.random.Generator) -> list[dict[str, Any]]:
    """Slopes at neighbouring doubles across every cell edge: largest step, over its scale."""
    claim = "step between neighbouring doubles, over its scale"
    claims = {name: Claim(f"{name}: {claim}", "every cell edge", SLOPE) for name in _FIELDS}
    for alpha in (1.0001, 1.5, 11.0, 1e3, 1e6):
        for way in WAYS:
            for kappa, mu, V, delta in at_edges(way, alpha, rng):
                state = contact(way, alpha, kappa, mu, V, delta, (*_FIELDS, "delta_star"))
                for name, scale in slope_scales(mu, V, alpha, state.delta_star).items():
                    steps = np.abs(np.diff(getattr(state, name)))
                    size = np.broadcast_to(scale, np.shape(getattr(state, name)))[..., 1:]
                    claims[name].add(steps / size, f"alpha = {alpha!r}, {way}")
    return [one.row for one in claims.values()]


def stress_points(state: Any, rng: np.random.Generator) -> np.ndarray:
    """x in l0: within 1e-16 to 1 of either edge and of the stick point, on both sides."""
    rear, front = 0.5 * state.lam * (state.epsilon - 1.0), 0.5 * state.lam * (state.epsilon + 1.0)
    stick = front - state.lam * state.beta
    near = 0.5 * state.lam * 10.0 ** rng.uniform(-16, 0, 3)
    between = rng.uniform(rear, front, 3)
    return np.concatenate([rear + near, front - near, [stick], stick + near[:2], stick - near[:2], between])


def enclosed_stress(exact: dict[str, Any], alpha: Any, kappa: Any, mu: Any, V: Any, x: Any) -> tuple[Any, Any]:
    """p/E' and tau/E' at x."""
    zeta = exact["zeta"]
    eta = exact["beta"] * zeta
    Y = x / (kappa * V) - zeta * exact["epsilon"]
    scale = V / (4 * arb.pi())
    whole = shape_enclosure(Y, zeta, alpha)
    stuck = shape_enclosure(Y - (zeta - eta), eta, alpha) if eta > 0 else arb(0)
    return scale * whole, mu * scale * (whole - stuck)


def stress_rows(count: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    domain = "alpha zeta in [1e-8, 1e8], alpha in [1, 1e4], s over its range, x at edges, stick point and between"
    claims = [
        Claim(f"{name} beyond a shift of x by 8 roundings, over its peak", domain, STRESS) for name in ("p", "tau")
    ]
    for _ in tqdm(range(count), desc="stress", delay=1.0, leave=False):
        alpha = float(10.0 ** rng.uniform(0.0, 4.0))
        a, kappa, mu, small = (10.0 ** rng.uniform([-8, 0, -2, -8], [8, 2, 0, 0])).tolist()
        zeta = a / alpha
        V = 0.5 / kappa / math.sqrt(zeta * zeta + 2.0 * zeta * generators(zeta, standard(alpha))[1])
        s = (small, 1.0 - small, float(rng.random()), 1.2)[rng.integers(4)]
        scene = vr.Scene(alpha, kappa, mu)
        delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        state = vr.contact(scene, V, delta=delta)
        x = stress_points(state, rng)
        found = vr.stress(scene, x, V, delta=delta)
        peak = vr.stress(scene, 0.5 * state.lam * (state.epsilon + np.linspace(-1, 1, 401)), V, delta=delta).p.max()
        exact = contact_enclosure(alpha, kappa, mu, V, delta, 200)
        with flint.ctx.workprec(260):
            given = [arb(value) for value in (alpha, kappa, mu, V)]
            for i, place in enumerate(x.tolist()):
                shift = _SHIFT * max(abs(place), 0.5 * state.lam * (1.0 + state.epsilon))
                here, up, down = (enclosed_stress(exact, *given, arb(place) + move) for move in (0, shift, -shift))
                for n, values in enumerate((found.p, found.tau)):
                    off = abs(arb(float(values[i])) - here[n])
                    allowed = max(float(abs(other[n] - here[n]).mid()) for other in (up, down))
                    over = (float(off.upper()) - allowed) / (peak * (mu if n else 1.0))
                    claims[n].add(over, at(alpha=alpha, kappa=kappa, mu=mu, V=V, s=s, x=place))
    return [one.row for one in claims]


def closure_rows(count: int, seed: int) -> list[dict[str, Any]]:
    domain = "alpha in [1, 1e4], kappa V in [1e-3, 1e3]"
    meaning = {"load": "Int p dx = P", "Q": "Int tau dx = Q", "M": "Int x p dx = M"}
    claims = {name: Claim(f"{text}, over the load", domain, CLOSURE) for name, text in meaning.items()}
    scene, V, delta = random_states(count, seed)
    for i in range(count):
        one = vr.Scene(scene.alpha[i], scene.kappa[i], scene.mu[i])
        for name, error in closures(one, float(V[i]), float(delta[i])).items():
            claims[name].add(abs(error), f"{one!r}, V = {V[i]!r}, delta = {delta[i]!r}")
    return [claim.row for claim in claims.values()]


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    rng = np.random.default_rng(sizes["seed"] + 3)
    return [
        *slope_rows(sizes["slope_states"], rng),
        *jump_rows(rng),
        *stress_rows(sizes["stress_states"], rng),
        *closure_rows(sizes["closures"], sizes["seed"]),
    ]
