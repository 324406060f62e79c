"""The variables of both models, in the order of their value references, which start with 1."""

from __future__ import annotations

from typing import NamedTuple


class Variable(NamedTuple):
    """A variable of an FMU.

    Attributes
    ----------
    name : as the tool shows it.
    causality : "input", "output", "parameter" or "local", as in the standard.
    unit : unit of its values, one of :data:`UNITS`.
    text : description.
    start : default start value of what can be set; None of what is computed.
    positive : whether values that are not above 0 are refused.
    """

    name: str
    causality: str
    unit: str
    text: str
    start: float | None = None
    positive: bool = False


class Model(NamedTuple):
    """A model of an FMU.

    Attributes
    ----------
    text : description.
    variables : all variables but time.
    states : names of the continuous states; the rate of each is the variable der_NAME.
    """

    text: str
    variables: tuple[Variable, ...]
    states: tuple[str, ...] = ()


def _positive(name: str, unit: str, text: str, start: float) -> Variable:
    """Return a parameter that must be above 0.

    name, text: as fields of :class:`Variable`.
    unit: one of :data:`UNITS`.
    start: default start value, in this unit.
    """
    return Variable(name, "parameter", unit, text, start, positive=True)


#: Radius at the start, in m, where no Cylinder gives one: that of the examples of the documentation.
RADIUS = 0.1
#: Normal force at the start, in N, where no Cylinder gives one.
_LOAD = 1000.0
#: Description of the load.
_LOAD_TEXT = "normal force, positive in compression"
#: Parameters of the cylinder and of its contact that both models have.
_BODY = (
    _positive("R", "m", "radius", RADIUS),
    _positive(
        "E_prime", "Pa", "long-time contact modulus pi E/(1 - nu^2); of two bodies 2/(1/E'_1 + 1/E'_2)", 1e6
    ),
    _positive("T_ref", "s", "unit of time of the law", 1.0),
    _positive("mu", "1", "coefficient of friction", 0.3),
    _positive("width", "m", "length of the cylinder along its axis", 1.0),
)  # fmt: skip

ELEMENT = Model(
    "Force element: a viscoelastic cylinder on a half-space",
    (
        Variable("v", "input", "m/s", "speed of the axis", 1.0),
        Variable("omega", "input", "rad/s", "angular velocity, which has the sign of v in pure rolling", 10.0),
        Variable("load", "input", "N", f"{_LOAD_TEXT}; at 0 and below there is no contact and no force", _LOAD),
        *_BODY,
        _positive(
            "v_min", "m/s", "lower limit of the speed in the law, since its slopes are infinite at rest",
            1e-6
        ),
        Variable("force", "output", "N", "force on the cylinder, along v"),
        Variable("torque", "output", "N.m", "torque on the cylinder about its axis, along omega"),
        Variable("moment_half_space", "output", "N.m", "rolling resistance moment on the half-space"),
        Variable("moment_cylinder", "output", "N.m", "rolling resistance moment on the cylinder"),
        Variable("contact_length", "local", "m", "contact length, lam l0"),
        Variable("contact_shift", "local", "m", "distance of the middle of the contact ahead of the axis"),
        Variable("stick_share", "local", "1", "stick zone divided by the contact length, beta; 0 in full slip"),
        Variable("creep_max", "local", "1", "critical creepage delta_star, from which the whole contact slips"),
        Variable("traction", "local", "N", "friction force in the contact, Q"),
    ),
)  # fmt: skip
ROLLER = Model(
    "A viscoelastic cylinder that rolls on a half-space",
    (
        Variable("drive_force", "input", "N", "force on the axis, along v", 0.0),
        Variable("drive_torque", "input", "N.m", "torque about the axis, along omega", 0.0),
        _positive("load", "N", _LOAD_TEXT, _LOAD),
        *_BODY,
        _positive(
            "v_min", "m/s", "co-simulation: lower limit of the speed by which creepage and errors are divided; below "
            "v_min/1000 the roller is at rest", 1e-6
        ),
        _positive(
            "v_smooth", "m/s", "model exchange: lower limit of the speed by which creepage is divided, so that solvers "
            "pass through rest", 1e-3
        ),
        _positive("mass", "kg", "mass of the cylinder", 35.0),
        _positive("inertia", "1", "j, moment of inertia divided by m R^2", 0.5),
        _positive("rtol", "1", "relative tolerance of the steps in co-simulation", 1e-8),
        Variable("v0", "parameter", "m/s", "speed at the start", 0.0),
        Variable("omega0", "parameter", "rad/s", "angular velocity at the start", 0.0),
        Variable("v", "output", "m/s", "speed of the axis"),
        Variable("slip", "output", "m/s", "omega R - v"),
        Variable("x", "output", "m", "distance travelled by the axis"),
        Variable("der_v", "local", "m/s2", "rate of v"),
        Variable("der_slip", "local", "m/s2", "rate of slip"),
        Variable("der_x", "local", "m/s", "rate of x"),
        Variable("omega", "output", "rad/s", "angular velocity"),
        Variable("traction", "local", "N", "friction force in the contact, Q"),
        Variable("rolling_moment", "local", "N.m", "rolling resistance moment, M"),
        Variable("stick_share", "local", "1", "stick zone divided by the contact length, beta; 0 in full slip"),
    ),
    ("v", "slip", "x"),
)  # fmt: skip
#: Name of a model -> the model.
MODELS = {"Roller": ROLLER, "ContactElement": ELEMENT}
#: Unit -> the same in base units, as :func:`..core.scale.dimension_powers` reads it.
UNITS = {
    "m": "m", "s": "s", "kg": "kg", "m/s": "m s-1", "m/s2": "m s-2", "rad/s": "rad s-1", "N": "kg m s-2",
    "N.m": "kg m2 s-2", "Pa": "kg m-1 s-2", "1": "",
}  # fmt: skip
