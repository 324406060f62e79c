"""The tables of a flow map, made from the rows of the law and from integrated motions: :func:`fill_tables`.

A flow map is a set of tables from which any free motion of a scene follows without integration
(:mod:`viscoroll.kernels.flow.layout`).  In full slip the motion is an integral of the law.  Behind the onset of partial
slip it passes a boundary layer, in which omega - V relaxes, and then follows the slow manifold, one curve in (V, delta)
that all motions approach.  Motions give V and delta at interpolation nodes; distance, angle and loss are integrals of
their polynomials.  All is dimensionless, times are gamma t.
"""

from __future__ import annotations

import numpy as np

from ..kernels.flow import layout
from ..kernels.flow.layout import FlowTables
from ..kernels.flow.states import DELTA_STAR, MOMENT
from ..materials.law.pack import interleave_pairs
from ..materials.law.table import law_table
from .flow_layer import fill_layers
from .flow_manifold import fill_manifold
from .flow_problem import OUT_OF_RANGE, SPEEDS, STOPS, FlowProblem, NoFlowMap
from .flow_rows import NODES
from .flow_store import FlowMap


def fill_tables(new_map: FlowMap, threads: int | None) -> str:
    """Fill the tables of a new flow map.

    new_map : the :class:`FlowMap`, whose ``table`` is written.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, or where that is not set the cores available.
    Returns "", or the reason why the scene has no map, a sentence; the table is then incomplete.  Of an elastic scene,
    which never slows down, nothing is written.
    """
    if new_map.slow_rate == 0.0:
        return "an elastic cylinder never slows down"
    parts, first = layout.views(new_map.table), new_map.first
    problem = FlowProblem(new_map.parameters, law_table(new_map.parameters[0]).record, new_map.slow_rate, threads)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused
            _fill_full_slip(problem, parts)
            slow = fill_manifold(problem, parts)
            for family, sign in ((layout.PLUS, 1.0), (layout.MINUS, -1.0)):
                fill_layers(problem, sign, first, slow, parts.asymptote[family], parts.layer[family])
    except NoFlowMap as reason:
        return str(reason)
    return ""


def _fill_full_slip(problem: FlowProblem, parts: FlowTables) -> None:
    """Fill the tables of full slip, V > 0 and V < 0, from the equation V' = +-mu - M/2 in time gamma t.

    problem : the :class:`FlowProblem`.
    parts : :class:`FlowTables`, views of the tables, of which ``slide``, ``after`` and ``onset`` are written.
    Raises :class:`NoFlowMap`, with the tables incomplete: for the reason STOPS where at some speed the rolling
    resistance can hold the sliding cylinder, or nearly can, and where the speed at the onset of partial slip is no
    unique function of the quantity that is constant while sliding; for OUT_OF_RANGE where numbers leave the range of
    doubles.
    """
    _, kappa, mu, j = problem.parameters
    V, least = SPEEDS.x / kappa, 2.0**layout.LOW / kappa
    state = problem.contact_states(V, np.zeros(V.shape))
    limit = state[DELTA_STAR] * V
    for n, sign in enumerate((1.0, -1.0)):
        rate = mu - sign * 0.5 * state[MOMENT]
        if not np.isfinite(limit / rate).all():
            raise NoFlowMap(OUT_OF_RANGE)
        if not (rate > 0.0).all():
            raise NoFlowMap(STOPS)
        half = SPEEDS.half / kappa
        T = NODES.integrals(1.0 / rate, half, least / mu)
        X = NODES.integrals(V / rate, half, 0.5 * least * least / mu)
        slip = 2.0 * mu * T - V * (1.0 - j) + sign * j * limit
        if not (np.diff(slip.ravel(), prepend=0.0) > 0.0).all():
            raise NoFlowMap(STOPS)
        time, path, onset = NODES.powers(T), NODES.powers(X), NODES.powers(slip)
        parts.slide[n] = np.concatenate([interleave_pairs(time, NODES.powers(limit)), path], axis=-1)
        # nearly held: the inverse would end before the speeds that are served
        if not kappa * mu * time[-3].sum() < 2.0 ** (layout.HIGH - 1):
            raise NoFlowMap(STOPS)
        parts.after[n] = NODES.powers(SPEEDS.inverse(time, SPEEDS.x / (kappa * mu)) / kappa)
        u = SPEEDS.inverse(onset, SPEEDS.x * (1.0 + j) / kappa)
        values = [NODES.powers(value) for value in (u / kappa, SPEEDS.value(time, u), SPEEDS.value(path, u))]
        parts.onset[n] = np.concatenate([interleave_pairs(*values[:2]), values[2]], axis=-1)
