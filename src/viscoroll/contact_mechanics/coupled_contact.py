"""Contacts by method "coupled": fields and tractions of states, each from its row
(:mod:`.coupled_pair`).

Everything is dimensionless, as in :mod:`.contact_table`.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ..core import ConvergenceError, Floats, ParameterError, broadcast_shape, run_blocks
from .contact_table import DEPTH, FREE_CREEP, complete, refuse_overflow
from .coupled_pair import CoupledPair, CoupledRow, depth
from .parameters import Parameters

#: What each status of the kernels says.
_REASONS = {
    1: "no zones of stick and slip satisfy Coulomb's law",
    2: "the pressure is negative in a part of the contact",
    3: "no contact length bears the load",
    4: "a matrix is singular",
}


@lru_cache(maxsize=16)
def coupled_row(pair: CoupledPair, u: float, mu: float) -> CoupledRow:
    """Return the row of a pair at u = kappa |V| with friction mu, kept for later calls.

    Raises ConvergenceError where full slip has no solution.
    """
    row = CoupledRow(pair, u, mu)
    refuse_unsolved(row.full_slip_status, np.array([-np.inf, np.inf]), u, mu)
    return row


def refuse_unsolved(status: Any, creeps: Any, u: float, mu: float) -> None:
    """Raise ConvergenceError for the first state whose status is not 0; else do nothing.

    status: status of the kernels for each state, (n,).
    creeps: reduced creepages 2 kappa delta, (n,).
    u, mu: kappa |V| and coefficient of friction of the states, for the message.
    """
    for code, creep in zip(np.asarray(status, int), creeps, strict=True):
        if code:
            state = f"kappa |V| = {u:g}, mu = {mu:g}, 2 kappa delta = {creep:g}"
            raise ConvergenceError(f"contact by method 'coupled': {_REASONS[int(code)]} at {state}")


class _States:
    """States as vectors: kappa, mu, V, slip speed omega - V and creepage, and the rows that they
    have in common.
    """

    def __init__(self, scene: Parameters, V: Floats, creep: Floats, creep_is_omega: bool) -> None:
        """Broadcast and check the states.

        scene: dimensionless parameters, of which kappa and mu, numbers or arrays, are read.
        V: speeds, dimensionless, any sign.
        creep: omega if ``creep_is_omega``, else the creepage delta.
        Raises ParameterError for kappa |V| that is too large, and shapes that do not broadcast.
        """
        arrays = {
            "kappa": scene.kappa,
            "mu": scene.mu,
            "V": V,
            "omega" if creep_is_omega else "delta": creep,
        }
        arrays = {name: np.asarray(value, np.float64) for name, value in arrays.items()}
        self.shape = broadcast_shape(**arrays)
        refuse_overflow(arrays["kappa"], arrays["V"])
        self.kappa, self.mu, self.V, given = (
            np.broadcast_to(each, self.shape).ravel() for each in arrays.values()
        )
        self.sign = np.where(self.V < 0.0, -1.0, 1.0)
        if creep_is_omega:
            self.slip = given - self.V
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                delta = self.slip / np.abs(self.V) * self.sign
                self.delta = np.where(self.slip == 0.0, 0.0, delta)
        else:
            self.slip = given * self.V
            self.delta = given
        self.u = self.kappa * np.abs(self.V)
        with np.errstate(over="ignore"):
            self.creep = 2.0 * self.kappa * self.delta
        _, self.row = np.unique(np.array([self.u, self.mu]), axis=1, return_inverse=True)

    def groups(self) -> list[Any]:
        """Return the indices of the states of each row, a list of arrays."""
        row = self.row.ravel()
        return [np.flatnonzero(row == n) for n in range(int(row.max(initial=-1)) + 1)]


def evaluate_coupled(
    scene: Parameters, V: Floats, creep: Floats, creep_is_omega: bool, names: tuple[str, ...]
) -> dict[str, Any]:
    """Return dimensionless fields of the contact by name, with pressure and shear solved together.

    scene: dimensionless parameters of one material; kappa and mu may be arrays.
    V, creep, creep_is_omega, names: as in :func:`.contact_table.evaluate_contact`.
    Returns a dict as that function does.
    Raises ParameterError for several materials, kappa |V| above 1e300, and the depth of a
    half-space; ConvergenceError where a state has no solution.
    """
    pair = CoupledPair.of_scene(scene)
    if DEPTH in names and any(math.isinf(body.thickness) for body in pair.bodies):
        allowed = "left out: a half-space in plane strain has no approach of the bodies"
        raise ParameterError("fields", repr(DEPTH), allowed)
    states = _States(scene, V, creep, creep_is_omega)
    groups = states.groups()
    computed = tuple(dict.fromkeys(names))
    out = np.empty((len(computed), states.V.size))

    def work(row: int, _: int) -> None:
        """Compute the states of a row and write them into their columns of ``out``."""
        fields = _fields_of_row(pair, states, groups[row], computed)
        for n, name in enumerate(computed):
            out[n, groups[row]] = fields[name]

    run_blocks(work, len(groups), 1)
    return complete(names, computed, out, states.shape)


def _fields_of_row(
    pair: CoupledPair, states: _States, which: Any, names: tuple[str, ...]
) -> dict[str, Any]:
    """Return the fields of states that have kappa |V| and mu in common.

    pair: the bodies.
    states: all states of the call.
    which: indices of the states of this row, (n,), n >= 1.
    names: requested fields; depth and delta_0, which take longer, are computed only if requested.
    Returns name -> values, (n,) or one number for all, dimensionless.
    Raises ConvergenceError where a state has no solution.
    """
    first = which[0]
    row = coupled_row(pair, float(states.u[first]), float(states.mu[first]))
    kappa, mu, V, sign, slip, delta, creep = (
        vars(states)[name][which] for name in ("kappa", "mu", "V", "sign", "slip", "delta", "creep")
    )
    found = row.states(creep, apart=True)
    refuse_unsolved(found.status, creep, row.u, row.mu)
    half = 0.5 * np.abs(V) / kappa
    strain = found.work_base + found.work_cylinder
    low, high = row.onsets()
    with np.errstate(divide="ignore", over="ignore"):
        zeta = 0.5 * found.lam / row.u if row.u > 0.0 else np.inf
    fields: dict[str, Any] = {
        "lam": found.lam,
        "length": found.lam,
        "epsilon": found.epsilon,
        "beta": found.beta,
        "zeta": zeta,
        "delta": delta,
        "delta_minus": 0.5 * low / kappa,
        "delta_plus": 0.5 * high / kappa,
        "delta_star": 0.25 * (high - low) / kappa,
        "full_slip": (creep <= low) | (creep >= high),
        "Q": sign * mu * found.Q_over_mu,
        "grip": 1.0 - np.abs(found.Q_over_mu),
        "M_half_space": sign * found.kM_base / kappa,
        "M_cylinder": sign * found.kM_cylinder / kappa,
        "loss_slip": sign * slip * mu * found.Q_over_mu - half * strain,
        "loss_half_space": half * (2.0 * found.kM_base + found.work_base),
        "loss_cylinder": half * (2.0 * found.kM_cylinder + found.work_cylinder),
    }
    fields["M"] = fields["C_rr"] = fields["M_half_space"] + fields["M_cylinder"]
    if FREE_CREEP in names:
        fields[FREE_CREEP] = 0.5 * row.free_creep() / kappa
    if DEPTH in names:
        depths = [depth(pair.bodies, row.u, row.profile(each)) for each in creep.tolist()]
        fields[DEPTH] = np.array(depths) / kappa
    return fields


def coupled_stress(
    scene: Parameters, x: Floats, V: Floats, creep: Floats, creep_is_omega: bool
) -> Floats:
    """Return pressure and shear stress on the cylinder along +x.

    scene, V, creep, creep_is_omega: as in :func:`evaluate_coupled`.
    x: distance ahead of the axis, divided by l0; broadcasts with the states.
    Returns p and tau divided by E', rows of an array, each of the broadcast shape; 0 outside the
    contact.
    Raises as :func:`evaluate_coupled`.
    """
    pair = CoupledPair.of_scene(scene)
    states = _States(scene, V, creep, creep_is_omega)
    shape = broadcast_shape(x=x, V=np.empty(states.shape))
    number = np.broadcast_to(np.arange(states.V.size).reshape(states.shape), shape)
    x = np.broadcast_to(x, shape)
    out = np.empty((2, *shape))
    for n in range(states.V.size):
        row = coupled_row(pair, float(states.u[n]), float(states.mu[n]))
        found = row.profile(float(states.creep[n]))
        refuse_unsolved([found.status], [states.creep[n]], row.u, row.mu)
        place = number == n
        sign = states.sign[n]
        y = sign * x[place] - found.shift
        both = [np.interp(y, found.nodes, each, left=0.0, right=0.0) for each in (found.p, found.q)]
        out[:, place] = np.array(both) / (4.0 * np.pi * states.kappa[n])
        out[1, place] *= sign
    return out
