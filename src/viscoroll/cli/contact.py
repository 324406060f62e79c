"""``viscoroll contact`` and ``viscoroll stress``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import (
    FORMATS,
    NUMBERS,
    add_creep_options,
    add_output_option,
    add_scene_options,
    number,
    numbers,
)
from .body import body_of

_POINTS = 101


def add_commands(commands: Any) -> None:
    """Add both commands to the program."""
    parser = commands.add_parser(
        "contact",
        help="state of the contact: lam, epsilon, delta_star, beta, Q, M",
        description=f"State of the contact for every pair of V and delta (or omega), each\n{NUMBERS}.",
        epilog="example:\n  viscoroll contact --preset paper-section-5 --V 0.5,1 --delta -0.04:0.04:5"
        " --fields beta,Q,M",
    )
    add_creep_options(parser, numbers)
    parser.add_argument("--fields", help="names with commas between; default: all")
    parser.add_argument("--slopes", action="store_true", help="also dQ_dV, dQ_ddelta, dQ_domega, dM_dV")
    parser.add_argument("--method", default="table", help="table (default) or direct")
    add_scene_options(parser)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_contact)

    parser = commands.add_parser(
        "stress",
        help="pressure and shear stress along the contact",
        description="p/E' and tau/E' at positions x/l0 from the foot of the axis, at one V and delta (or omega).",
        epilog="example:\n  viscoroll stress --preset paper-section-5 --V 0.5 --delta -0.01 --x -0.2:0.6:9",
    )
    add_creep_options(parser, number)
    parser.add_argument("--x", type=numbers, help=f"{NUMBERS}; default: {_POINTS} points across the contact")
    add_scene_options(parser)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_stress)


def _contact(arguments: Namespace) -> int:
    import numpy as np

    from .output import Sheet, as_dataset, deliver

    body = body_of(arguments)
    V = np.atleast_1d(arguments.V)
    creep: Any = {
        name: np.atleast_1d(value)
        for name, value in (("delta", arguments.delta), ("omega", arguments.omega))
        if value is not None
    }
    result = body.contact(
        V[:, np.newaxis], **creep, slopes=arguments.slopes, method=arguments.method,
        fields=None if arguments.fields is None else arguments.fields.split(","),
    )  # fmt: skip
    axes = {"V": V, **creep}
    values = {name: value for name, value in result.as_dict().items() if name not in axes}
    columns = dict(zip(axes, map(np.ravel, np.meshgrid(*axes.values(), indexing="ij")), strict=True))
    columns |= {name: value.ravel() for name, value in values.items()}
    constants, title = _of_contact(body), "Contact of a viscoelastic cylinder rolling with partial slip"
    deliver(
        arguments,
        lambda: Sheet((title,), constants, columns, body.units),
        lambda: as_dataset(title, axes, values, constants, body.units),
    )
    return 0


def _stress(arguments: Namespace) -> int:
    import numpy as np

    from .output import Sheet, as_dataset, deliver

    body = body_of(arguments)
    speeds = {"V": arguments.V, "delta": arguments.delta, "omega": arguments.omega}
    length = "length" if body.units else "lam"
    state = body.contact(**speeds, fields=dict.fromkeys(("lam", "epsilon", "delta", "beta", length)))
    if arguments.x is None:
        # Eq. (8): the contact reaches from (epsilon - 1) lam/2 behind to (epsilon + 1) lam/2 ahead
        ahead = np.linspace(state.epsilon - 1.0, state.epsilon + 1.0, _POINTS)
        x = 0.5 * getattr(state, length) * (ahead if arguments.V >= 0.0 else -ahead[::-1])
    else:
        x = np.atleast_1d(arguments.x)
    values = body.stress(x, **speeds).as_dict()
    title = "Pressure and shear stress of a rolling viscoelastic cylinder"
    constants = {**_of_contact(body), "V": arguments.V, **state.as_dict()}
    deliver(
        arguments,
        lambda: Sheet((title,), constants, {"x": x, **values}, body.units),
        lambda: as_dataset(title, {"x": x}, values, constants, body.units),
    )
    return 0


def _of_contact(body: Any) -> dict[str, float]:
    """The parameters that contact and stress use."""
    return {name: value for name, value in body.constants.items() if name not in ("gamma", "j")}
