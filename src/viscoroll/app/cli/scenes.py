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
        option("--V", type=kind, required=True, help="velocity of the axis, of either sign"),
        option("--delta", type=kind, help="creepage (omega R - V)/V"),
        option("--omega", type=kind, help="angular velocity; give it or --delta"),
    )


@command("contact", *_speeds(numbers), *TABLE)
def contact(given: Namespace) -> None:
    """Compute the contact at constant speed: lam, epsilon, delta_star, beta, Q, M.

    The result has a row for every pair of V and delta (or omega).  Each option is a number, LOW:HIGH:COUNT,
    LOW:HIGH:COUNT:log, or several of these, separated by commas.

    example:
      viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5
    """
    import numpy as np

    V, creep = given.V, given.omega if given.delta is None else given.delta
    V = V[:, np.newaxis] if np.ndim(V) and np.ndim(creep) else V
    show(given, body_of(given.scene).contact(V, delta=given.delta, omega=given.omega))


@command("stress", *_speeds(float), *TABLE)
def stress(given: Namespace) -> None:
    """Compute pressure and shear stress along the contact.

    The stresses are given at 101 points of the contact, for one V and one delta (or omega).

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
    option("--V0", type=float, required=True, help="initial velocity of the axis"),
    option("--omega0", type=float, required=True, help="initial angular velocity"),
    option("--t", type=numbers, required=True, help="output times, written as the numbers of `viscoroll contact`"),
    *TABLE,
)  # fmt: skip
def roll(given: Namespace) -> None:
    """Integrate one free motion from given initial speeds.

    The motion obeys Eq. (22), and may change between full slip and partial slip.
    For driven, braked and unsteady motions use vr.roll in Python, or a run file (viscoroll ensemble).

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
    option("--force", type=numbers, help="force on the axis along V (default 0)"),
    option("--torque", type=numbers, help="torque on the cylinder along omega (default 0)"),
    option("--slope", type=numbers, help="slope angle in rad, positive if +V points downhill; the normal load is P cos(slope)"),
    option("--V", type=numbers, help="prescribed speed; then give --force or --torque, and the other one is computed"),
    *TABLE,
)  # fmt: skip
def steady(given: Namespace) -> None:
    """Find the steady speeds under force, torque or slope.

    Each equilibrium of each load is a row.  If a load has no equilibrium, the reason is printed.
    Options are written as the numbers of `viscoroll contact`: single numbers, or lists of equal length.

    example:
      viscoroll steady paper-section-5-rounded --slope 0:0.1:6
    """
    import numpy as np

    loads = {name: getattr(given, name) for name in ("force", "torque", "slope", "V")}
    found = body_of(given.scene).steady(**{name: np.atleast_1d(x) for name, x in loads.items() if x is not None})
    lines = [f"load {n}: {reason}" for n, reason in enumerate(found.reason) if reason]
    if len(lines) > _LINES:
        lines[_LINES:] = [f"{len(lines) - _LINES} more loads have no steady speed"]
    if given.output is not None or given.format != "text":  # a table for programs has no heading that says it
        for line in lines:
            warnings.warn(line, vr.ModelWarning, stacklevel=2)
    show(given, found, "\n".join(lines))


@command(
    "validity", SCENE,
    option("--V", type=float, required=True, help="velocity of the axis, of either sign"),
    option("--omega", type=float, help="angular velocity; without it the assumptions on creepage are not checked"),
)  # fmt: skip
def validity(given: Namespace) -> None:
    """Check the assumptions of the model at one speed.

    Each line has the name of an assumption, whether it holds (yes, no, or ? if data are missing), and the reason.

    example:
      viscoroll validity rubber-roller --V 5 --omega 4.9
    """
    print(body_of(given.scene).validity(given.V, omega=given.omega))
