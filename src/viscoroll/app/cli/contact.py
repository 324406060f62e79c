"""``viscoroll contact`` and ``viscoroll stress``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import FORMATS, NUMBERS, add_creep, add_output_option, add_scene, body_of, number, numbers

_POINTS = 101


def add_commands(commands: Any) -> None:
    """Add both commands to the program."""
    parser = commands.add_parser(
        "contact",
        help="state of the contact: lam, epsilon, delta_star, beta, Q, M",
        description=f"State of the contact for every pair of V and delta (or omega), each\n{NUMBERS}.",
        epilog="example:\n  viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5",
    )
    add_scene(parser)
    add_creep(parser, numbers)
    parser.add_argument("--slopes", action="store_true", help="also dQ_dV, dQ_ddelta, dQ_domega, dM_dV")
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_contact)

    parser = commands.add_parser(
        "stress",
        help="pressure and shear stress along the contact",
        description=f"Pressure and shear stress at {_POINTS} places across the contact, at one V and delta (or omega).",
        epilog="example:\n  viscoroll stress paper-section-5 --V 0.5 --delta -0.01",
    )
    add_scene(parser)
    add_creep(parser, number)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_stress)


def _contact(arguments: Namespace) -> int:
    import numpy as np

    from .output import show

    name = "omega" if arguments.delta is None else "delta"
    V, creep = arguments.V, getattr(arguments, name)
    V = V[:, np.newaxis] if np.ndim(V) and np.ndim(creep) else V
    show(arguments, body_of(arguments.scene).contact(V, **{name: creep}, slopes=arguments.slopes))
    return 0


def _stress(arguments: Namespace) -> int:
    import numpy as np

    from .output import show

    body, speeds = body_of(arguments.scene), {"V": arguments.V, "delta": arguments.delta, "omega": arguments.omega}
    state = body.contact(**speeds, fields=("length", "epsilon"))
    # Eq. (8): the contact reaches from (epsilon - 1) lam/2 behind to (epsilon + 1) lam/2 ahead
    ahead = np.linspace(state.epsilon - 1.0, state.epsilon + 1.0, _POINTS)
    x = 0.5 * state.length * (ahead if arguments.V >= 0.0 else -ahead[::-1])
    show(arguments, body.stress(x, **speeds))
    return 0
