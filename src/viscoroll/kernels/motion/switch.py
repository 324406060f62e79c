"""What follows where a regime of a motion ends, and where a piece of the drive begins."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from .load import acting, brakes, load_at, prescribed_speed
from .nodes import V, extremes
from .rates import rates_of
from .records import EDGE, KINK, NEITHER, OMEGA, STOP, TURN, Frame, State

#: V at the end of a panel, over that at its start, below which it is 0 there
_CLOSED = 1e-14
#: omega over V in partial slip above which V follows a prescribed omega at the same d
_FOLLOWED = 0.5
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
def closed(state, frame, clock, case):
    """Whether the stick band closes at V = 0, where omega is 0 too."""
    still = frame.locked or (
        case.drive.prescribed == OMEGA and prescribed_speed(clock.tau, clock.piece, case.drive) == 0.0
    )
    if not still:
        return state.V <= _CLOSED * case.nodes[V]
    # slip with omega = 0 ends with V, which is 0 but for the tolerance of the panel
    return state.V <= max(_CLOSED, _OFF * case.limits.rtol) * extremes(V, case.nodes)[1]


@kernel
def turned(state, frame):
    """Full slip at V = 0 as seen in the other direction."""
    slips, direction, sigma, spin, locked = frame
    return State(0.0, -state.second), Frame(slips, -direction, -sigma, -spin, locked)


@kernel
def as_prescribed(state, frame, clock, case):
    """The prescribed speed set to what it is, where a piece of the drive begins or stick forms.

    What the integration so far leaves of its error is small beside the speeds so far, but may be large beside the speed
    that is prescribed from here on.

    Parameters
    ----------
    state, frame : State, Frame
        As integrated, with V >= 0 in the frame.
    clock : Clock
        At that time.
    case : Case
        Of the motion.

    Returns
    -------
    (State, Frame)
        With the prescribed speed, the frame turned where that has V < 0 in full slip; in partial slip V is at least 0.
        There V follows a prescribed omega with d kept, except where friction is so strong that omega is far below V.
    """
    drive, (slips, direction, sigma, spin, locked) = case.drive, frame
    if drive.prescribed == NEITHER:
        return state, frame
    speed = direction * prescribed_speed(clock.tau, clock.piece, drive)
    if drive.prescribed == OMEGA and slips:
        return State(state.V, speed), frame
    if drive.prescribed == OMEGA:
        omega = here(state, frame, clock, case)[1].omega
        return (State(state.V * max(speed / omega, 0.0), state.second) if omega > _FOLLOWED * state.V else state), frame
    if slips and speed < 0.0:
        return State(-speed, -state.second), Frame(slips, -direction, -sigma, -spin, locked)
    return State(speed if slips else max(speed, 0.0), state.second), frame


@kernel
def switch(event, state, frame, clock, case):
    """(Whether the cylinder moves, state, frame) behind an event that changes the regime."""
    slips, direction, sigma, spin, locked = frame
    if event == EDGE and slips:
        if closed(state, frame, clock, case):
            return False, state, frame
        rates = here(state, frame, clock, case)[1]
        state, frame = State(state.V, sigma), Frame(False, direction, sigma, spin, locked)
        if case.drive.prescribed == OMEGA and abs(rates.V_rate) >= abs(rates.rate):
            # the time of the event is known to the tolerance, and by it the slower speed better than the faster one
            state, frame = as_prescribed(state, frame, clock, case)
        return state.V > 0.0, state, frame
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
    falls = state.V == 0.0 and here(state, frame, clock, case)[1].V_rate < 0.0
    return turned(state, frame) if falls else (state, frame)


@kernel
def at_new_piece(state, frame, clock, case):
    """(State, frame) where a piece of the drive begins: brakes take hold or let go, V may turn."""
    if clock.piece > 0:  # the start is as given
        state, frame = as_prescribed(state, frame, clock, case)
    if frame.slips:
        state, frame = setting_out(state, frame, clock, case)
    slips, direction, sigma, spin, locked = frame
    braked, omega = brakes(clock.piece, case.drive.pieces), here(state, frame, clock, case)[1].omega
    if locked or omega == 0.0:
        if braked and locks(state, frame, clock, case):
            return state, Frame(slips, direction, sigma, spin, True)
        return state, released(state, frame, clock, case)
    return state, Frame(slips, direction, sigma, np.sign(omega) if braked else 0.0, False)
