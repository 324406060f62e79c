"""The fields of contact() against certified enclosures: of an alpha each by the axis of alpha, of one by its rows."""

from __future__ import annotations

import math
from typing import Any

import flint
import numpy as np
from flint import arb
from tqdm import tqdm

import viscoroll as vr

from ..truth.check_values import EDGE_ALPHAS, chosen_state
from ..truth.enclosures import INPUTS, condition_numbers, contact_enclosure
from .claim import Claim, at

FIELDS = ("lam", "epsilon", "delta_star", "beta", "Q", "M")
#: relative error where the condition number leaves it, else that many roundings of the inputs
WELL, ROUNDINGS, UNIT = 1e-13, 4.0, 2.0**-53
#: the two bounds meet here
WELL_CONDITIONED = WELL / (ROUNDINGS * UNIT)
#: ULP of delta_star: where full slip begins, against where it should
SLIP_ULP = 2.0
SLIP = "full_slip: distance from delta_star where wrong, ULP"
#: the last subnormals have no relative accuracy: their spacing, some times over
_LEAST = 8 * 5e-324


def by_axis(states: list[tuple[float, ...]]) -> vr.rolling_contact.Values:
    """States with an alpha each."""
    alpha, kappa, mu, V, delta = np.array([*states, states[0]]).T  # of one alone its rows would be made
    state = vr.contact(vr.Scene(alpha, kappa, mu), V, delta=delta, fields=(*FIELDS, "full_slip"))
    return vr.rolling_contact.Values({name: value[:-1] for name, value in state.as_dict().items()})


def by_rows(states: list[tuple[float, ...]]) -> vr.rolling_contact.Values:
    """States of one alpha."""
    alpha, kappa, mu, V, delta = np.array(states).T
    return vr.contact(vr.Scene(float(alpha[0]), kappa, mu), V, delta=delta, fields=(*FIELDS, "full_slip"))


class Tally(dict[str, Claim]):
    """The claims of one way."""

    def __init__(self, way: str) -> None:
        super().__init__()
        self.way = way

    def add(self, claim: str, bound: float, error: float, state: tuple[float, ...]) -> None:
        row = self.setdefault(claim, Claim(f"{claim} ({self.way})", DOMAIN, bound))
        row.add(error, at(**dict(zip(INPUTS, state, strict=True))))


DOMAIN = "alpha in [1, 1e6], kappa V in [1e-300, 1e300], kappa, mu in [1e-6, 1e6], s from 1e-300 to 1 and beyond"
_WELL_CLAIM = f"{{}}, relative, condition below {WELL_CONDITIONED:.0f}"
_ILL_CLAIM = f"{{}}, over condition × 1.1e-16, condition above {WELL_CONDITIONED:.0f}"


def compare(tally: Tally, state: tuple[float, ...], found: dict[str, float]) -> None:
    """One state into the tally: full_slip, then each field over its bound."""
    exact = contact_enclosure(*state)
    if found["full_slip"] != exact["full_slip"]:
        star = exact["delta_star"]
        off = abs(arb(abs(state[4])) - star) / arb(float(np.spacing(float(star))))
        tally.add(SLIP, SLIP_ULP, float(off.upper()), state)
        return
    tally.add(SLIP, SLIP_ULP, 0.0, state)
    condition = condition_numbers({name: arb(abs(value)) for name, value in zip(INPUTS, state, strict=True)})
    for name in FIELDS:
        error, factor = relative_error(found[name], exact[name]), condition[name]
        if factor <= WELL_CONDITIONED:
            tally.add(_WELL_CLAIM.format(name), WELL, error, state)
        else:
            tally.add(_ILL_CLAIM.format(name), ROUNDINGS, error / (factor * UNIT), state)


def relative_error(value: float, exact: Any) -> float:
    """|value - exact|/|exact|, less what the last subnormals cannot hold."""
    with flint.ctx.workprec(200):
        off = abs(arb(value) - exact)
        if off <= _LEAST:
            return 0.0
        return math.inf if exact.contains(0) else float((off / abs(exact)).upper())


def rows(sizes: dict[str, Any]) -> list[dict[str, Any]]:
    rng = np.random.default_rng(sizes["seed"] + 1)
    batches = {"an alpha each": [([chosen_state(rng) for _ in range(sizes["states"])], by_axis)], "one alpha": []}
    alphas = [*EDGE_ALPHAS[1:], *(10.0 ** rng.uniform(0.0, 6.0, sizes["slices"])).tolist()]
    for alpha in alphas[: sizes["slices"]]:
        batches["one alpha"].append(([chosen_state(rng, alpha) for _ in range(sizes["slice_states"])], by_rows))
    result = []
    for way, parts in batches.items():
        tally = Tally(way)
        for states, method in tqdm(parts, desc=f"contact, {way}", delay=1.0, leave=False):
            values = method(states).as_dict()
            for i, state in enumerate(tqdm(states, desc="states", delay=1.0, leave=False)):
                compare(tally, state, {name: column[i] for name, column in values.items()})
        result += sorted((claim.row for claim in tally.values()), key=lambda row: row["claim"])
    return result
