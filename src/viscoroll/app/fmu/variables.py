"""The variables of both models, in the order of their references, which start with 1."""

from __future__ import annotations

from typing import NamedTuple


class Variable(NamedTuple):
    """``causality`` as in the standard; ``above_0``: refused otherwise; ``start`` of what is set."""

    name: str
    causality: str
    unit: str
    text: str
    start: float | None = None
    above_0: bool = False


class Model(NamedTuple):
    """``states`` of it, each with its rate der_NAME."""

    text: str
    variables: tuple[Variable, ...]
    states: tuple[str, ...] = ()


def _set(name: str, unit: str, text: str, start: float, causality: str = "parameter") -> Variable:
    return Variable(name, causality, unit, text, start, above_0=causality == "parameter")


_BODY = (
    _set("R", "m", "radius", 0.1),
    _set("E_prime", "Pa", "pi E/(1 - nu^2) of long times; of two bodies 2/(1/E'_1 + 1/E'_2)", 1e6),
    _set("T_ref", "s", "time in which the law counts", 1.0),
    _set("mu", "1", "coefficient of friction", 0.3),
    _set("width", "m", "length of the cylinder along its axis", 1.0),
)
_LOAD, _LOAD_TEXT = 1000.0, "normal force, pressing"

ELEMENT = Model(
    "Force element: a viscoelastic cylinder on a half-space",
    (
        _set("v", "m/s", "speed of the axis", 1.0, "input"),
        _set("omega", "rad/s", "angular velocity, of the sign of v in pure rolling", 10.0, "input"),
        _set("load", "N", f"{_LOAD_TEXT}; where it is not above 0 there is no contact and no force", _LOAD, "input"),
        *_BODY,
        _set("v_min", "m/s", "below this speed the law is that at it, as its slopes are infinite at rest", 1e-6),
        Variable("force", "output", "N", "on the cylinder, along v"),
        Variable("torque", "output", "N.m", "on the cylinder about its axis, along omega"),
        Variable("moment_half_space", "output", "N.m", "rolling moment that the half-space takes"),
        Variable("moment_cylinder", "output", "N.m", "rolling moment that the cylinder takes"),
        Variable("contact_length", "local", "m", "lam l0"),
        Variable("contact_shift", "local", "m", "of its middle ahead of the axis"),
        Variable("stick_share", "local", "1", "beta, 0 where all of the contact slips"),
        Variable("creep_max", "local", "1", "delta_star, the creep at which all of it slips"),
        Variable("traction", "local", "N", "friction in the contact, Q"),
    ),
)
ROLLER = Model(
    "A viscoelastic cylinder that rolls on a half-space",
    (
        _set("drive_force", "N", "on the axis, along v", 0.0, "input"),
        _set("drive_torque", "N.m", "about the axis, along omega", 0.0, "input"),
        _set("load", "N", _LOAD_TEXT, _LOAD),
        *_BODY,
        _set(
            "v_min",
            "m/s",
            "co-simulation: below it creep counts from it and errors as at it; a thousandth is rest",
            1e-6,
        ),
        _set(
            "v_smooth", "m/s", "model exchange: below it creep counts from it, so that solvers pass through rest", 1e-3
        ),
        _set("mass", "kg", "of the cylinder", 35.0),
        _set("inertia", "1", "j, moment of inertia over m R^2", 0.5),
        _set("rtol", "1", "tolerance of its own steps in co-simulation", 1e-8),
        Variable("v0", "parameter", "m/s", "speed at the start", 0.0),
        Variable("omega0", "parameter", "rad/s", "angular velocity at the start", 0.0),
        Variable("v", "output", "m/s", "speed of the axis"),
        Variable("slip", "output", "m/s", "omega R - v"),
        Variable("x", "output", "m", "way of the axis"),
        Variable("der_v", "local", "m/s2", "rate of v"),
        Variable("der_slip", "local", "m/s2", "rate of slip"),
        Variable("der_x", "local", "m/s", "rate of x"),
        Variable("omega", "output", "rad/s", "angular velocity"),
        Variable("traction", "local", "N", "friction in the contact, Q"),
        Variable("rolling_moment", "local", "N.m", "M"),
        Variable("stick_share", "local", "1", "beta, 0 where all of the contact slips"),
    ),
    ("v", "slip", "x"),
)
#: Name -> model.
MODELS = {"Roller": ROLLER, "ContactElement": ELEMENT}
#: Unit -> what of the base units it is.
UNITS = {
    "m": "m", "s": "s", "kg": "kg", "m/s": "m s-1", "m/s2": "m s-2", "rad/s": "rad s-1", "N": "kg m s-2",
    "N.m": "kg m2 s-2", "Pa": "kg m-1 s-2", "1": "",
}  # fmt: skip
