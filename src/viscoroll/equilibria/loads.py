"""What acts in steady rolling, checked and flattened: :class:`Loads`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import broadcast_shape, checked
from ..drive import Feedback, slope_factor
from ..errors import ParameterError
from ..parameters import Parameters

#: kappa |V| of a given speed
FASTEST = 1e100


@dataclass(frozen=True)
class Gains:
    """Of force and torque on V and omega."""

    force_V: float = 0.0
    force_omega: float = 0.0
    torque_V: float = 0.0
    torque_omega: float = 0.0

    @property
    def V(self) -> float:
        """Of both on V: that of force + torque."""
        return self.force_V + self.torque_V

    @property
    def omega(self) -> bool:
        """Whether there is any on omega."""
        return self.force_omega != 0.0 or self.torque_omega != 0.0


@dataclass(frozen=True)
class Loads:
    """Loads of one material as vectors of one length.

    shape : that of the call.  force, torque : at rest, 0 where it is to be found; ``given`` names the one that is
    given where V is, else None.  kappa : in use, that of a slope.  V : given speeds, or None.
    """

    shape: tuple[int, ...]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    gains: Gains
    given: str | None
    kappa: NDArray[np.float64]
    mu: NDArray[np.float64]
    j: NDArray[np.float64]
    V: NDArray[np.float64] | None


def loads_of(
    scene: Parameters,
    force: ArrayLike | Feedback | None,
    torque: ArrayLike | Feedback | None,
    slope: ArrayLike | None,
    V: ArrayLike | None,
) -> Loads:
    """The loads of a call of ``steady`` on the scene of a slope; errors as there."""
    if np.ndim(scene.alpha):
        raise ParameterError("alpha", f"an array of shape {np.shape(scene.alpha)}", "a single number")
    given = None if V is None else _given(force, torque, slope)
    tangent, _ = slope_factor(slope)
    f, q = _feedback("force", force), _feedback("torque", torque)
    arrays = {"force": np.asarray(f.value), "torque": np.asarray(q.value), "slope": tangent}
    arrays |= {name: np.asarray(getattr(scene, name)) for name in ("kappa", "mu", "j")}
    if V is not None:
        arrays["V"] = checked("V", V)
    shape = broadcast_shape(**arrays)
    kappa = arrays["kappa"]
    if V is not None:
        _refuse_overflow(kappa, arrays["V"])

    def flat(array: Any) -> NDArray[np.float64]:
        return np.broadcast_to(array, shape).ravel()

    return Loads(
        shape, flat(arrays["force"] + tangent), flat(arrays["torque"]), Gains(f.V, f.omega, q.V, q.omega), given,
        flat(kappa), flat(arrays["mu"]), flat(arrays["j"]), flat(arrays["V"]) if V is not None else None,
    )  # fmt: skip


def _refuse_overflow(kappa: NDArray, V: NDArray) -> None:
    with np.errstate(over="ignore"):
        largest = (kappa * np.abs(V)).max(initial=0.0)
    if largest > FASTEST:
        raise ParameterError("kappa |V|", f"{largest:g}", f"at most {FASTEST:g}")


def _feedback(name: str, value: ArrayLike | Feedback | None) -> Feedback:
    """Any load as one with gains."""
    if not isinstance(value, Feedback):
        return Feedback(checked(name, 0.0 if value is None else value))
    if not isinstance(value.value, float | np.ndarray):
        raise ParameterError(name, "a feedback on a schedule", "constant in time")
    if value.shape:
        raise ParameterError(name, f"a feedback with gains of shape {value.shape}", "one with numbers for gains")
    return value


def _given(force: ArrayLike | Feedback | None, torque: ArrayLike | Feedback | None, slope: ArrayLike | None) -> str:
    """Which of force and torque is given beside V."""
    for name, value in (("force", force), ("torque", torque)):
        if isinstance(value, Feedback):
            raise ParameterError(name, "a feedback", "a number or an array where V is given")
    names = [name for name, value in (("force", force), ("torque", torque)) if value is not None]
    if len(names) == 2:
        sentence = "V, force and torque are all given: give two of them, the third is found"
        raise ParameterError("V, force, torque", "all", "two of them", sentence)
    if not names and slope is None:
        sentence = "V is given alone: give one of force, torque and slope with it"
        raise ParameterError("V", "alone", "with one of force, torque, slope", sentence)
    return names[0] if names else "force"
