"""What follows where a regime of a driven motion ends, and where a piece of the drive begins."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .load import acting, brakes, load_at, risen_by
from .nodes import SPEED as FASTEST
from .nodes import V, extremes
from .rates import rates_of
from .records import EDGE, KINK, NEITHER, SPEED, STOP, TURN, Frame, State

#: V at the end of a panel, over that at its start, below which it is 0 there
_CLOSED = 1e-14
#: what rounding leaves of a prescribed speed that has come to 0, over what it has changed by
_DRIFT = 1e-12
#: what an event may be off by, over rtol
_OFF = 10.0


@kernel
def here(state, frame, clock, case):
    """(The drive, what the equations say) at a state."""
    load = load_at(clock.tau, clock.piece, frame, case)
    return load, rates_of(state, load, frame, case.scene)


@kernel
def _excess(state, frame, clock, case):
    """(Torque that would turn a wheel held at omega = 0, the most that the brake can take of it)."""
    load, rates = here(state, frame, clock, case)
    _, torque, _ = acting(state.V, 0.0, load, frame)
    return torque - rates.Q - rates.M_cylinder, load.brake


@kernel
def locks(state, frame, clock, case):
    """Whether the brake holds omega, which has just become 0."""
    excess, most = _excess(state, frame, clock, case)
    return abs(excess) <= most


@kernel
def released(state, frame, clock, case):
    """The frame once a brake that held omega lets go, or the sign of omega changes under it."""
    excess, _ = _excess(state, frame, clock, case)
    spin = np.sign(excess) if brakes(clock.piece, case.drive.pieces) else 0.0
    return Frame(frame.slips, frame.direction, frame.sigma, spin, False)


@kernel
def closed(state, locked, case):
    """Whether the stick band closes at V = 0, where omega is 0 too."""
    if not locked:
        return state.V <= _CLOSED * case.nodes[V]
    # slip with omega = 0 ends with V, which is 0 but for the tolerance
    return state.V <= max(_CLOSED, _OFF * case.limits.rtol) * extremes(V, case.nodes)[1]


@kernel
def drift(fastest, clock, case):
    """What the integration of a prescribed speed may leave of it where it has come to 0."""
    return (case.limits.rtol + _DRIFT) * max(fastest, risen_by(clock.piece, case.drive.pieces))


@kernel
def turned(state, frame):
    """Full slip at V = 0 as seen in the other direction."""
    slips, direction, sigma, spin, locked = frame
    return State(0.0, -state.second), Frame(slips, -direction, -sigma, -spin, locked)


@kernel
def stands(state, frame, clock, case):
    """Whether V and omega, one of them prescribed, are 0 but for what the integration of that one leaves."""
    if case.drive.prescribed == NEITHER:
        return False
    omega, (_, fastest) = here(state, frame, clock, case)[1].omega, extremes(FASTEST, case.nodes)
    return max(abs(state.V), abs(omega)) <= drift(fastest, clock, case)


@kernel
def switch(event, state, frame, clock, case):
    """(Whether the cylinder moves, state, frame) behind an event that changes the regime."""
    slips, direction, sigma, spin, locked = frame
    if slips and stands(state, frame, clock, case):
        return False, state, frame
    if event == EDGE and slips:
        if closed(state, locked, case):
            return False, state, frame
        return True, State(state.V, sigma), Frame(False, direction, sigma, spin, locked)
    if event == EDGE:
        omega = here(state, frame, clock, case)[1].omega
        return True, State(state.V, omega), Frame(True, direction, sigma, spin, locked)
    if event == KINK:
        return True, state, Frame(False, direction, -sigma, spin, locked)
    if event == TURN:
        if not slips or state.second == 0.0:
            return False, state, frame
        state, frame = turned(state, frame)
        return True, state, frame
    if event == STOP:
        still = State(state.V, 0.0) if slips else state
        if locks(still, frame, clock, case):
            return True, still, Frame(slips, direction, sigma, spin, True)
        return True, still, released(still, frame, clock, case)
    return True, state, released(state, frame, clock, case)


@kernel
def setting_out(state, frame, clock, case):
    """(State, frame) of full slip where a piece of the drive begins: seen from where V goes if it is 0."""
    if case.drive.prescribed == SPEED and abs(state.V) <= drift(0.0, clock, case):
        state = State(0.0, state.second)
    falls = state.V == 0.0 and here(state, frame, clock, case)[1].V_rate < 0.0
    return turned(state, frame) if falls else (state, frame)


@kernel
def at_new_piece(state, frame, clock, case):
    """(State, frame) where a piece of the drive begins: brakes take hold or let go, V may turn."""
    if frame.slips:
        state, frame = setting_out(state, frame, clock, case)
    slips, direction, sigma, spin, locked = frame
    braked, omega = brakes(clock.piece, case.drive.pieces), here(state, frame, clock, case)[1].omega
    if locked or omega == 0.0:
        if braked and locks(state, frame, clock, case):
            return state, Frame(slips, direction, sigma, spin, True)
        return state, released(state, frame, clock, case)
    return state, Frame(slips, direction, sigma, np.sign(omega) if braked else 0.0, False)
