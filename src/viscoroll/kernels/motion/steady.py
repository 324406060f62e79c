"""Steady rolling under a drive that stays as it is: the equilibrium that a motion has come to, and how it goes on.

With P = p' and B = V d' of :mod:`rates`, partial slip is

    V' = (P - p_d B/V)/p_V      d' = B/V

An equilibrium is stable where the Jacobian of (V', d') has a negative trace and a positive determinant.  A motion that
is within a small share of the tolerance of a stable equilibrium stays there as long as the drive does.  In full slip
V has equilibria of its own, while omega stands or grows linearly.  Panels could not follow either for ever: the
rounding of P, times the length of a panel, comes to more than the tolerance.
"""

from __future__ import annotations

from ..compile.jit import kernel
from .collocation import SHARES, N
from .load import load_at
from .nodes import OF_SECOND, OF_V, SECOND, Panel, V, put_drive
from .output import pass_panel
from .rates import rates_of
from .records import Clock, State

#: distance from the equilibrium over rtol, and the least that rounding leaves of it, up to which a motion is there:
#: what it leaves behind adds nothing to the errors of the panels before
_SHARE, _LEAST = 1e-3, 1e-14


@kernel(inline=True)
def nearness(rtol):
    """Relative distance of V from its equilibrium up to which a motion has come to it."""
    return max(_SHARE * rtol, _LEAST)


@kernel
def _steady_slip(state, rates, frame, noise, near):
    """:func:`equilibrium` in full slip: of V, where omega comes no nearer to V, nor to 0 under a brake, and no gain
    feeds omega back."""
    if rates.p_rate_second != 0.0 or rates.rate_second != 0.0 or not rates.p_rate_V < 0.0:
        return False, state
    if frame.sigma * rates.rate < 0.0 or frame.spin * rates.rate < 0.0:
        return False, state
    V_off = rates.p_rate / rates.p_rate_V
    return abs(V_off) <= near * state.V - noise / rates.p_rate_V, State(state.V - V_off, state.second)


@kernel
def equilibrium(state, frame, noise, clock, case):
    """The stable equilibrium of the drive as it is now, if a motion has come to it.

    Parameters
    ----------
    state, frame, clock, case : State, Frame, Clock, Case
        The motion, with V > 0.
    noise : float
        What rounding leaves of p' where that is 0, dimensionless.

    Returns
    -------
    (bool, State)
        Whether Newton's step to an equilibrium is below :func:`nearness`, of V beside itself and of d, or rounding, and
        the equilibrium is stable; the state behind that step.  False in partial slip with a speed prescribed.
    """
    load, V, near = load_at(clock.tau, clock.piece, frame, case), state.V, nearness(case.limits.rtol)
    rates = rates_of(state, load, frame, case.scene)
    if frame.slips:
        return _steady_slip(state, rates, frame, noise, near)
    if load.per_V == 0.0 or load.per_omega == 0.0:  # one speed is given, and p' says nothing of the other
        return False, state
    gains, p_d = load.gains, rates.p_second
    # gains on omega feed p' with d, which Newton's matrix of a panel leaves out
    p_rate_d = rates.p_rate_second + load.per_omega * (gains.force_omega + gains.torque_omega) * p_d
    d_rate, d_V, d_d = rates.rate / V, rates.rate_V / V, rates.rate_second / V
    V_rate = (rates.p_rate - p_d * d_rate) / rates.p_V
    V_V, V_d = (rates.p_rate_V - p_d * d_V) / rates.p_V, (p_rate_d - p_d * d_d) / rates.p_V
    determinant = V_V * d_d - V_d * d_V
    if not (V_V + d_d < 0.0 < determinant):
        return False, state
    V_off, d_off = (V_rate * d_d - d_rate * V_d) / determinant, (d_rate * V_V - V_rate * d_V) / determinant
    rounding = abs(noise / (rates.p_V * determinant))
    steady = abs(V_off) <= near * V + rounding * abs(d_d) and abs(d_off) <= near + rounding * abs(d_V)
    # force and torque that cancel leave V = 0 but for rounding
    return steady, State(max(V - V_off, 0.0), state.second - d_off)


@kernel
def stay_steady(end, noise, state, frame, clock, case):
    """Outputs up to the end of a piece of the drive if a motion has come to its equilibrium; omega is linear in full
    slip.

    Parameters
    ----------
    end : float
        tau at the end of the piece.
    noise : float
        As in :func:`equilibrium`.
    state, frame, clock, case : State, Frame, Clock, Case
        The motion, with V > 0.

    Returns
    -------
    (bool, State, Clock)
        Whether it has; state and clock at the end of the piece, one step later, or as they were.
    """
    steady, there = equilibrium(state, frame, noise, clock, case)
    if not steady:
        return False, state, clock
    state = there
    rates = rates_of(state, load_at(clock.tau, clock.piece, frame, case), frame, case.scene)
    rise = rates.rate * (end - clock.tau) if frame.slips else 0.0
    nodes, panel = case.nodes, Panel(clock.tau, end - clock.tau, clock.piece, True, False)
    for i in range(N + 1):
        nodes[V + i], nodes[SECOND + i] = state.V, state.second + rise * SHARES[i]
        nodes[OF_V + i] = nodes[OF_SECOND + i] = 0.0
    nodes[OF_SECOND] = 0.5 * rise  # of v = 0 ... 2
    put_drive(panel, case)
    clock = Clock(clock.tau, clock.at, clock.piece, clock.steps + 1, clock.ends, 0.0)
    return True, State(state.V, state.second + rise), pass_panel(end, 2.0, panel, frame, clock, case)
