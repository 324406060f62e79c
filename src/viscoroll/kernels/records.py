"""Records that kernels take and return, and the codes in their results; without numba.

They are those of the solver of motions, with the columns of a segment of the drive; of the flow
map's kernels; and of what a bound law returns, to Python and to jitted code alike.

All quantities are dimensionless (docs/symbols.md) unless a record says otherwise; an argument of
which no shape is stated is a number.  Times are tau = gamma t.  Speeds are V T_epsilon/R and omega
T_epsilon, forces are divided by the load P, torques by P R, as in the equations of motion of V and
omega, Eq. (22) of the paper.  ``omega_or_d`` is the second unknown: omega in full slip, d =
delta/delta_star in partial slip.
"""

from typing import Any, Generic, NamedTuple, TypeVar

# --- Records of the solver of motions ---

#: Regime of an output: the whole contact slips.
FULL_SLIP = 0
#: Regime of an output: a part of the contact sticks.
PARTIAL_SLIP = 1
#: Regime of an output: V = omega = 0 without a brake.
AT_REST = 2
#: Regime of an output: a brake holds omega at 0 while V is not 0.
OMEGA_LOCKED = 3
#: Regime of an output: V = omega = 0, held by a brake or by a prescribed speed.
HELD_AT_REST = 4
#: Entry among the regime changes: V changed its sign.
DIRECTION_REVERSED = -1

#: Code of a drive: neither speed is prescribed.
NOT_PRESCRIBED = 0
#: Code of a drive: omega is prescribed.
PRESCRIBED_OMEGA = 1
#: Code of a drive: V is prescribed.
PRESCRIBED_V = 2

#: Status of a motion: it is integrated to its last output time.
COMPLETED = 0
#: Status of a motion: it came below the rest threshold.
CAME_TO_REST = 1
#: Status of a motion: the allowed number of steps was used up.
STEP_LIMIT = 2
#: Status of a motion: all trials of one step, ever shorter, were rejected.
STEP_TOO_SMALL = 3
#: Status of a motion: the departure from rest is not unique.
NOT_UNIQUE = 4
#: Status of a motion: the added mass left the range in which the equations are regular.
ADDED_MASS_EXHAUSTED = 5

#: Unit of rounding of a double, dimensionless.
ROUNDING = 2.2e-16
#: V below which it counts as 0 in partial slip, dimensionless: far below every speed that an output
#: can tell from 0.
ZERO_SPEED = 1e-200


class Scene(NamedTuple):
    """Parameters of Eq. (22) of one motion, dimensionless.

    law : :class:`.law_record.Law`, rows of polynomials of the contact law of one material
    moments_differ : whether half-space and cylinder take unequal parts of the rolling moment M
    kappa : R/l0, radius of the cylinder divided by the length of the contact at rest
    mu : coefficient of friction
    gamma : P T_epsilon^2/(m R), Eq. (4): tau = gamma t; also the factor of the added mass N
    j : J/(m R^2), moment of inertia of the cylinder
    """

    law: Any
    moments_differ: bool
    kappa: float
    mu: float
    gamma: float
    j: float


class Gains(NamedTuple):
    """Feedback: derivatives of the applied force and torque in V and omega, dimensionless.

    force_V, force_omega : of the force, in V and in omega
    torque_V, torque_omega : of the torque of the motor, in V and in omega
    """

    force_V: float
    force_omega: float
    torque_V: float
    torque_omega: float


class Drive(NamedTuple):
    """External actions on one motion.

    segments : [segment, column], each row one segment of the drive over tau, columns as COL_* below
    gains : Gains, the feedback, the same on all segments
    prescribed : NOT_PRESCRIBED, PRESCRIBED_OMEGA or PRESCRIBED_V
    """

    segments: Any
    gains: Gains
    prescribed: int


class Load(NamedTuple):
    """The drive at one time, in the direction of the regime, dimensionless (docs/theory_motion.md,
    Driven motion).

    V' = inverse_mass (Q - M_half_space + force) + prescribed_V_rate
    omega' = inverse_inertia (-Q - M_cylinder + torque) + prescribed_omega_rate

    force, torque : force on the axis and torque of the motor, without feedback, which depends on V
    and omega
    prescribed_V_rate, prescribed_omega_rate : slope in tau of a prescribed speed; 0 where the speed
    is free
    brake : largest torque of the brake, at least 0, not signed; it is added to ``torque`` with the
    sign against omega
    inverse_mass : 1, or 0 where V is prescribed
    inverse_inertia : 1/j, or 0 where omega is prescribed or held at 0 by the brake
    gains : Gains, the feedback
    """

    force: float
    torque: float
    prescribed_V_rate: float
    prescribed_omega_rate: float
    brake: float
    inverse_mass: float
    inverse_inertia: float
    gains: Gains


class Regime(NamedTuple):
    """Regime of a motion and the orientation in which its V is at least 0.

    full_slip : whether the whole contact slips
    direction : 1 or -1; speeds, forces and torques times this are those of the regime, with V >= 0
    sigma : 1 or -1; in full slip the sign of the slip omega - V, of a cover less delta_0 V of free
        rolling; in partial slip the sign of d of the branch of the law
    spin_sign : sign of omega where a brake acts, 0 where none does; without effect while ``locked``
    locked : whether a brake holds omega at 0
    """

    full_slip: bool
    direction: float
    sigma: float
    spin_sign: float
    locked: bool


#: Regime of a cylinder at rest, before its departure is known.
REGIME_AT_REST = Regime(full_slip=False, direction=1.0, sigma=1.0, spin_sign=0.0, locked=False)


class State(NamedTuple):
    """Unknowns of a motion in the direction of its regime, dimensionless.

    V : speed of the axis
    omega_or_d : omega in full slip, d = delta/delta_star in partial slip
    """

    V: float
    omega_or_d: float


class StepState(NamedTuple):
    """Progress of the integration of one motion.

    tau : time reached, dimensionless
    next_output : index in ``Workspace.output_tau`` of the next output time
    segment : index of the segment of the drive
    n_steps : number of trial steps so far
    n_accepted : number of accepted steps so far
    h : length in tau of the next trial step; 0: not chosen yet
    """

    tau: float
    next_output: int
    segment: int
    n_steps: int
    n_accepted: int
    h: float


class Step(NamedTuple):
    """One collocation step.

    tau : time of the left end, dimensionless
    h : length in tau
    segment : index of the segment of the drive in which it lies
    initial_slope_known : whether the slope of the second unknown at the left end is finite and
        known: True in full slip, and in partial slip for V > ZERO_SPEED
    undriven : whether nothing drives from there on: then V is measured relative to itself and may
    come to rest
    """

    tau: float
    h: float
    segment: int
    initial_slope_known: bool
    undriven: bool


class Options(NamedTuple):
    """Options of the integration.

    rtol : relative tolerance of the speeds, dimensionless
    rest_speed : speed below which a motion that nothing drives ends at rest, dimensionless; 0: none
    max_steps : largest number of trial steps of a motion
    """

    rtol: float
    rest_speed: float
    max_steps: int


class Workspace(NamedTuple):
    """The problem of one motion and the arrays that its solution uses.

    scene, drive, options : Scene, Drive and Options, the problem
    output_tau : (k,), times tau of the outputs, increasing
    outputs : (13, k), [quantity, time], filled as far as the motion goes, NaN after it; rows as in
    :mod:`.output`
    with_quadratures : whether distance, angle and energies are requested
    with_forces : whether force and torque are requested
    switches : (m, 2), filled with t and the code of the regime after each regime change, or
        DIRECTION_REVERSED, until it is full
    step_ends : filled with the end t of each accepted step, until it is full
    nodes : pointer to WORKSPACE_SIZE numbers: rows ROW_* and single numbers (:mod:`.collocation`)
    p_matrix, d_matrix : pointers to the inverse Newton matrices of p and of the second unknown,
    column by column
    """

    scene: Scene
    drive: Drive
    options: Options
    output_tau: Any
    outputs: Any
    with_quadratures: bool
    with_forces: bool
    switches: Any
    step_ends: Any
    nodes: Any
    p_matrix: Any
    d_matrix: Any


class Batch(NamedTuple):
    """Parameters and starts of many motions: arrays of one value for all, or of one for each
    motion; dimensionless.

    law : of one material for all, or of each motion in turn (:mod:`.law_record`)
    moments_differ : as in ``Scene``, the same for all
    kappa, mu, gamma, j : as in ``Scene``
    V0, omega0 : initial speeds, in units of R/T_epsilon and 1/T_epsilon
    """

    law: Any
    moments_differ: bool
    kappa: Any
    mu: Any
    gamma: Any
    j: Any
    V0: Any
    omega0: Any


#: Column of a segment: tau of its left end.
COL_START = 0
#: Column of a segment: scale of its time; x = (tau - start) scale - 1 runs from -1 to 1.
COL_SCALE = 1
#: First column of the coefficients in x of a segment, in ascending powers: as many for each
#: function below as there are terms.
COL_COEFFICIENTS = 2
#: Function of a segment: force.
DRIVE_FORCE = 0
#: Function of a segment: torque of the motor.
DRIVE_TORQUE = 1
#: Function of a segment: slope in tau of the prescribed speed.
DRIVE_RATE = 2
#: Function of a segment: largest torque of the brake.
DRIVE_BRAKE = 3
#: Function of a segment: prescribed speed.
DRIVE_SPEED = 4
#: Number of functions of a segment.
N_DRIVE_FUNCTIONS = 5
#: Number of functions that are stored at the nodes of a step: all but the prescribed speed, which
#: is evaluated at single times.
N_NODE_FUNCTIONS = 4
#: Quadrature: loss in rolling.
ROLLING_LOSS = 3
#: Number of quadratures that a free motion has: distance, angle, losses in slip and in rolling.
N_FREE_QUADRATURES = 4
#: Number of quadratures: those, then work of force and of torque and the loss in the brake, 0
#: unless something drives.
N_QUADRATURES = 7


# --- Records of the flow map's kernels ---


class Flow(NamedTuple):
    """The flow map of a scene.

    table : all tables of :mod:`.flow_layout` in one vector of flow_layout.SIZE doubles.
    first : int; onsets are tabulated for kappa V from 2**first to 2**(first + flow_layout.OCTAVES).
    kappa, mu, j : slenderness R/l0, coefficient of friction and moment of inertia J/(m R^2) of the
    scene.
    slow_rate : rate at which the slow logarithm falls along the slow manifold in unit time tau =
    gamma t, > 0.
    """

    table: Any
    first: int
    kappa: float
    mu: float
    j: float
    slow_rate: float


class Motions(NamedTuple):
    """Motions to be looked up, dimensionless.

    gamma : P T^2/(m R), the ratio of load to inertia, with the unit of time T of the law: tau =
    gamma t.
    rest : rest threshold of max(|V|, |omega|), 0 for none.
    V0, omega0 : initial speeds, vectors of one or n numbers.
    t : output times, (times,), ascending.
    rows : output quantities, indices of rows of an output, int, (q,), or a tuple before the kernel
        is called; distance, angle and slip loss are computed only if they are among them.
    """

    gamma: Any
    rest: Any
    V0: Any
    omega0: Any
    t: Any
    rows: Any


class Request(NamedTuple):
    """Requested outputs of a motion that is looked up in a flow map.

    level : SPEEDS, PATH or LOSS of :mod:`.flow_lookup`.
    rest : rest threshold, the value of max(|V|, |omega|) below which it is at rest, 0 for none.
    rest_slow_log : slow logarithm at that threshold.
    """

    level: Any
    rest: Any
    rest_slow_log: Any


class FullSlipStart(NamedTuple):
    """Start of a motion in full slip, mirrored so that omega > V.

    frame : +1, or -1 if mirrored.
    w : V - j omega.
    T, X : time tau, and distance times gamma, of sliding between rest and V
        (:func:`.flow_lookup.full_slip_integrals`).
    """

    frame: Any
    w: Any
    T: Any
    X: Any


class StickOnset(NamedTuple):
    """Onset of partial slip, mirrored so that V > 0.

    frame : +1, or -1 if mirrored.
    family : PLUS or MINUS.
    v : kappa V.
    tau : time, gamma t.
    x, angle, loss : distance, angle and slip loss there, from the start of the motion, distance and
        angle in the frame of the caller.  The onset of a start in partial slip lies before the
        start: tau <= 0, and the three are minus those from the onset to the start.
    """

    frame: Any
    family: Any
    v: Any
    tau: Any
    x: Any
    angle: Any
    loss: Any


class Asymptote(NamedTuple):
    """The motion on the slow manifold that a motion in partial slip approaches.

    slow_log : its slow logarithm at the onset.
    rate : relaxation rate k0 of omega - V at onset.
    split : see :class:`.flow_layout.FlowTables`.
    x, angle, loss : excess of distance, angle and slip loss over that motion.
    """

    slow_log: Any
    rate: Any
    split: Any
    x: Any
    angle: Any
    loss: Any


class Output(NamedTuple):
    """One output state in the frame of the caller, dimensionless.

    V, omega : speeds.
    x, angle : distance and angle since the start, both multiplied by gamma.
    delta : creepage.
    regime : code of the regime, FULL_SLIP, PARTIAL_SLIP or AT_REST.
    loss : slip loss since the start, divided by m (R/T_epsilon)^2.
    """

    V: Any
    omega: Any
    x: Any
    angle: Any
    delta: Any
    regime: Any
    loss: Any


# --- What a bound law returns, to Python and to jitted code alike ---

#: Numbers, or arrays.
T = TypeVar("T")


class Loads(NamedTuple, Generic[T]):
    """Dimensionless loads, Q divided by P and M divided by P R, with the parts of M that half-space
    and cylinder take; or, of a law in SI units, forces and moments per length.
    """

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T


class LoadsAndSlopes(NamedTuple, Generic[T]):
    """As :class:`Loads`, in the same units; then dQ/dV at fixed omega, dQ/domega at fixed V, and
    the slopes of the two parts of M over V at fixed omega and over omega at fixed V.  Of
    half-spaces M does not depend on omega.
    """

    Q: T
    M: T
    M_half_space: T
    M_cylinder: T
    dQ_dV: T
    dQ_domega: T
    dM_half_space_dV: T
    dM_cylinder_dV: T
    dM_half_space_domega: T
    dM_cylinder_domega: T
