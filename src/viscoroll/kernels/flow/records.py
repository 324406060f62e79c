"""What the kernels of a flow map hand to one another."""

from __future__ import annotations

from typing import Any, NamedTuple


class Flow(NamedTuple):
    """The flow map of a scene: all of :mod:`layout` as one vector, stick onsets from kappa V = 2**first on.

    slow_rate : at which lambda falls along the slow manifold.
    """

    table: Any
    first: int
    kappa: float
    mu: float
    j: float
    slow_rate: float


class Request(NamedTuple):
    """What is asked of a motion: need (SPEEDS, PATH or LOSS), rest threshold, lambda of the slow manifold there."""

    need: Any
    rest: Any
    rest_lambda: Any


class Slide(NamedTuple):
    """Full slip, in the frame mirrored so that omega > V: V - j omega, and T and X of the slide table, at the start."""

    frame: Any
    w: Any
    T: Any
    X: Any


class Stick(NamedTuple):
    """Entry into partial slip, in the frame mirrored so that V > 0: family of motions, kappa V, time, path and loss.

    That of a start inside the stick zone lies before it: ``tau``, distance, angle and loss are from the start on.
    """

    frame: Any
    family: Any
    v: Any
    tau: Any
    x: Any
    angle: Any
    loss: Any


class Entry(NamedTuple):
    """What the map holds of an entry: lambda, k0, split; distance, angle, slip loss gained on the slow manifold."""

    lam: Any
    rate: Any
    split: Any
    x: Any
    angle: Any
    loss: Any


class Output(NamedTuple):
    """One column of outputs, in the frame of the caller, times gamma where it is a length."""

    V: Any
    omega: Any
    x: Any
    angle: Any
    delta: Any
    regime: Any
    loss: Any
