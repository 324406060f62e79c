"""Two bodies with a temperature each: :func:`pair_temperatures`.

The law of a pair depends on kappa V a_T of one body and on the ratio of both times, so that each
pair of temperatures has a law of its own, of which the rows are made where they are read.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics.contact_table import evaluate_law
from ..contact_mechanics.parameters import Roller, resolve_model
from ..core.checks import Booleans, Floats, check_array, check_number
from ..core.errors import described_error, shape_error
from .heated_bodies import check_ambient, warm_pair
from .shift_curve import shift_curve

#: Nodes of each temperature, evenly spaced in ln a_T: some 0.05 s of contacts at 40 us each.
_NODES = 41
#: Step of difference quotients, K.
_DIFFERENCE = 1e-4
#: Largest residual of a zero over the larger rise, and distance in K within which zeros are one.
_RESIDUAL = 1e-9
_SAME = 1e-5


class PairTemperatures(NamedTuple):
    """Equilibria of heat of two bodies, by rising temperature of the cylinder.

    temperature : of the cylinder and of the base, degrees Celsius, (n, 2).
    stable : whether both return after small disturbances, of bodies of one capacity, (n,).
    C_rr : coefficient of rolling resistance, (n,).
    loss : of the cylinder and of the base, W/m, (n, 2).
    """

    temperature: Floats
    stable: Booleans
    C_rr: Floats
    loss: Floats


def pair_temperatures(
    roller: Roller, V: float, *, ambient: tuple[float, float], conductance: tuple[float, float]
) -> PairTemperatures:
    """Find the temperatures of two half-spaces that both relax, of one or of two materials, in free
    rolling.

    Parameters
    ----------
    roller : a :class:`Cylinder` without arrays and thicknesses, of which both materials have a
    ``shift``.
    V : speed, m/s, other than 0.
    ambient, conductance : of the cylinder and of the base, degrees Celsius and W/(m K), as in
    :func:`temperature`.

    Returns
    -------
    PairTemperatures
        Named tuple of ``temperature``, ``stable``, ``C_rr`` and ``loss``.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; a layer, a body that does not relax, arrays.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(R=0.1, m=60.0, material=rubber, mu=0.6, load=2e4)
    >>> found = vr.pair_temperatures(roller, 2.0, ambient=(20.0, 20.0), conductance=(6.0, 30.0))
    >>> bool(found.temperature[0, 0] > found.temperature[0, 1])
    True

    Notes
    -----
    Zeros are sought from the cells of a grid of 41 by 41 temperatures in which both balances change
    their sign; the balances hold to 1e-9 (``tests/test_heat.py``).
    """
    from scipy.optimize import root

    _, scene, scale = resolve_model(roller, "pair_temperatures")
    pair = roller.body_data and roller.body_data.pair
    if pair is None or scene.shape or pair.covered:
        raise described_error(
            "roller", "has arrays, a layer or no Material", "a Cylinder of two half-spaces"
        )
    speed = abs(check_number("V", V, unit=scale))
    around = check_array("ambient", ambient)
    off = check_array("conductance", conductance, above=0.0)
    for name, array in (("ambient", around), ("conductance", off)):
        if array.shape != (2,):
            raise shape_error(name, array.shape, "(2,), of cylinder and base")
    if not speed:
        raise described_error("V", "is 0, where nothing heats,", "other than 0")
    curves = [shift_curve(body) for body in (pair.cylinder, pair.half_space)]
    for at, curve in zip(around, curves, strict=True):
        check_ambient(at, curve, "ambient")
    load = roller.load  # type: ignore[attr-defined]
    kappa = scene.kappa

    def losses(theta: Floats) -> Floats:
        """Return the loss of each body, W/m, (2, m).

        theta: temperatures of cylinder and base, degrees Celsius, (2, m).
        """
        warm = warm_pair(pair, *(curve.at(at) for curve, at in zip(curves, theta, strict=True)))
        own = kappa * np.sqrt(warm.E_prime / pair.E_prime)
        index = np.arange(float(theta.shape[1]))
        fields = ("M_cylinder", "M_half_space")
        state = [index, own, 1.0, speed * warm.T_ref / scale["R"], 0.0]
        return load * speed * evaluate_law(warm.law, state, index.shape, False, fields)

    def rest(theta: Any) -> Floats:
        """Return the rise that the losses make less that of the temperatures, K, (2, m)."""
        return around[:, np.newaxis] + losses(theta) / off[:, np.newaxis] - theta

    def slopes(theta: Any) -> Floats:
        """Return the Jacobian of ``rest`` at temperatures of both, (2, 2)."""
        values = rest(
            theta[:, np.newaxis] + _DIFFERENCE * np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        )
        return (values[:, 1:] - values[:, :1]) / _DIFFERENCE

    axes = []
    for at, G, curve in zip(around, off, curves, strict=True):
        hottest = min(at + 0.5 * load * speed / kappa / G, curve.high)
        ends = np.log2(curve.at(np.array([at, hottest]))[0])
        axes.append(curve.temperature_of(np.linspace(float(ends[0]), float(ends[1]), _NODES)))
    grid = np.array(np.meshgrid(*axes, indexing="ij"))
    F = rest(grid.reshape(2, -1)).reshape(grid.shape) > 0.0
    corners = np.lib.stride_tricks.sliding_window_view(F, (2, 2), axis=(1, 2))
    cells = (corners.any(axis=(3, 4)) & ~corners.all(axis=(3, 4))).all(axis=0)
    found: list[Any] = []
    for start in 0.5 * (grid[:, :-1, :-1] + grid[:, 1:, 1:])[:, cells].T:
        at = root(lambda theta: rest(theta[:, np.newaxis])[:, 0], start, jac=slopes, tol=1e-14).x
        good = np.abs(rest(at[:, np.newaxis])).max() <= _RESIDUAL * np.abs(at - around).max()
        if good and all(np.abs(at - other).max() > _SAME for other in found):
            found.append(at)
    theta = np.array(sorted(found, key=tuple)).reshape(-1, 2)
    loss = losses(theta.T).T
    rates = [np.linalg.eigvals(off[:, np.newaxis] * slopes(at)).real.max() for at in theta]
    return PairTemperatures(theta, np.array(rates) < 0.0, loss.sum(axis=1) / (load * speed), loss)
