"""What a scene does: ``viscoroll contact``, ``stress``, ``roll``, ``steady`` and ``validity``."""

from __future__ import annotations

import warnings
from argparse import Namespace
from collections.abc import Callable
from typing import Any

import viscoroll as vr

from .arguments import SCENE, TABLE, Option, body_of, command, numbers, option
from .output import show

#: places across the contact, and loads without an equilibrium that are told of
_POINTS, _LINES = 101, 3


def _speeds(kind: Callable[[str], Any]) -> tuple[Option, ...]:
    return (
        SCENE,
        option("--V", type=kind, required=True, help="velocity of the axis, any sign"),
        option("--delta", type=kind, help="creep ratio (omega R - V)/V"),
        option("--omega", type=kind, help="angular velocity, in place of delta"),
    )


@command("contact", *_speeds(numbers), *TABLE)
def contact(given: Namespace) -> None:
    """State of the contact: lam, epsilon, delta_star, beta, Q, M.

    For every pair of V and delta (or omega), each a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of
    these with commas between.

    example:
      viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5
    """
    import numpy as np

    V, creep = given.V, given.omega if given.delta is None else given.delta
    V = V[:, np.newaxis] if np.ndim(V) and np.ndim(creep) else V
    show(given, body_of(given.scene).contact(V, delta=given.delta, omega=given.omega))


@command("stress", *_speeds(float), *TABLE)
def stress(given: Namespace) -> None:
    """Pressure and shear stress along the contact.

    At 101 places across it, at one V and delta (or omega).

    example:
      viscoroll stress paper-section-5 --V 0.5 --delta -0.01
    """
    import numpy as np

    body, speeds = body_of(given.scene), {"V": given.V, "delta": given.delta, "omega": given.omega}
    state = body.contact(**speeds, fields=("length", "epsilon"))
    # Eq. (8): the contact reaches from (epsilon - 1) lam/2 behind to (epsilon + 1) lam/2 ahead
    ahead = np.linspace(state.epsilon - 1.0, state.epsilon + 1.0, _POINTS)
    x = 0.5 * state.length * (ahead if given.V >= 0.0 else -ahead[::-1])
    show(given, body.stress(x, **speeds))


@command(
    "roll", SCENE,
    option("--V0", type=float, required=True, help="start velocity of the axis"),
    option("--omega0", type=float, required=True, help="start angular velocity"),
    option("--t", type=numbers, required=True, help="output times: numbers, as of `viscoroll contact`"),
    *TABLE,
)  # fmt: skip
def roll(given: Namespace) -> None:
    """One motion from given start speeds.

    Free motion of the cylinder from (V0, omega0), Eq. (22), through all regimes of slip.
    Driven, braked, unsteady motions: vr.roll in Python, or a run file (viscoroll ensemble).

    example:
      viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # how it ended is printed
        motion = body_of(given.scene).roll(given.V0, given.omega0, given.t)
    show(given, motion, str(motion))
    if given.output is not None:
        print(motion)


@command(
    "steady", SCENE,
    option("--force", type=numbers, help="along V (default 0)"),
    option("--torque", type=numbers, help="along omega (default 0)"),
    option("--slope", type=numbers, help="rad, positive downhill along +V; the load is P cos(slope)"),
    option("--V", type=numbers, help="the speed, in place of --force or --torque, which is found"),
    *TABLE,
)  # fmt: skip
def steady(given: Namespace) -> None:
    """Steady rolling under force, torque or slope.

    Every equilibrium of rolling under each load, a row each; where there is none, why.
    Options are numbers, as of `viscoroll contact`, all of one length or single.

    example:
      viscoroll steady paper-section-5-rounded --slope 0:0.1:6
    """
    import numpy as np

    loads = {name: getattr(given, name) for name in ("force", "torque", "slope", "V")}
    found = body_of(given.scene).steady(**{name: np.atleast_1d(x) for name, x in loads.items() if x is not None})
    lines = [f"load {n}: {reason}" for n, reason in enumerate(found.reason) if reason]
    if len(lines) > _LINES:
        lines[_LINES:] = [f"{len(lines) - _LINES} more loads have none"]
    if given.output is not None or given.format != "text":  # a table for programs has no heading that says it
        for line in lines:
            warnings.warn(line, vr.ModelWarning, stacklevel=2)
    show(given, found, "\n".join(lines))


@command(
    "validity", SCENE,
    option("--V", type=float, required=True, help="velocity of the axis, any sign"),
    option("--omega", type=float, help="angular velocity; without it the creep is not known"),
)  # fmt: skip
def validity(given: Namespace) -> None:
    """Which assumptions of the model a speed strains.

    A line for each assumption of the model: whether it holds (yes, no, ?: not known) and why.

    example:
      viscoroll validity rubber-roller --V 5 --omega 4.9
    """
    print(body_of(given.scene).validity(given.V, omega=given.omega))
