"""Pressure and shear along the contact: :func:`stress`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, overload

import numpy as np

from .blocks import elements, run_blocks
from .checks import broadcast_shape, checked
from .labels import unlabelled
from .materials.prony import Prony
from .materials.prony_array import MaterialArray
from .materials.tables import series
from .results import Values
from .rolling_contact import contact, shaped
from .scene import Scene, checked_scene
from .typed import Numbers

_BLOCK = 1 << 15


@overload
def stress(scene: Scene, x: Numbers, V: Numbers, delta: Numbers, omega: None = None) -> Values: ...
@overload
def stress(scene: Scene, x: Numbers, V: Numbers, delta: None = None, *, omega: Numbers) -> Values: ...
def stress(
    scene: Scene,
    x: Numbers,
    V: Numbers,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
) -> Values:
    """Pressure and shear stress along the contact, Eqs. (11)-(14).

    Parameters
    ----------
    scene : alpha, kappa and mu are used.
    x : position over l0, from the foot of the axis, positive along the axis of V; any
        value, the stresses are 0 outside the contact.
    V, delta, omega : as for :func:`contact`; all arguments broadcast.

    Returns
    -------
    Values
        ``p``: p/E' >= 0.  ``tau``: shear stress on the cylinder over E', of the sign of
        omega - V, |tau| <= mu p.

    Raises
    ------
    ParameterError, ConvergenceError
        As for :func:`contact`.

    Notes
    -----
    Relative to the peak the error is below 1e-11 for alpha zeta from 1e-8 to 1e8
    (``tests/test_stress.py``).  Where V or the creep are arrays, the state of the contact is
    held beside the result: 56 bytes an element of theirs.
    """
    from .kernels.law.stress_loop import Points, stress_loop
    from .kernels.material.functions import Own

    checked_scene(scene, "stress")
    plain, labels = unlabelled({"x": x, "V": V, "delta": delta, "omega": omega})
    x, V, delta, omega = plain.values()
    creep: Any = {"delta": delta, "omega": omega}  # :func:`contact` refuses both and neither
    state = contact(scene, V, **creep, fields=("lam", "epsilon", "beta", "zeta", "delta"))
    # for V < 0 everything is mirrored, tau once more
    mirror = np.where(checked("V", V) < 0.0, -1.0, 1.0)
    many = isinstance(scene.material, MaterialArray)
    material, unit = scene.in_own_time()
    given = {"x": checked("x", x), "kappa": scene.kappa, "mu": scene.mu}
    given |= {name: getattr(state, name) for name in ("lam", "epsilon", "beta")}
    given |= {"zeta": np.asarray(state.zeta) / unit}
    given |= {"alpha": np.arange(len(material), dtype=np.float64) if many else scene.alpha}
    given |= {"mirror": mirror, "sign": np.sign(state.delta) * mirror}
    arrays = {name: np.asarray(value, dtype=np.float64) for name, value in given.items()}
    shape = broadcast_shape(**arrays)
    x_of, *others, alpha_of, mirror_of, sign_of = (elements(array, shape) for array in arrays.values())
    modes = series(material) if isinstance(material, Prony) else None
    loop = _stresses(material) if many else lambda alphas, *rest: stress_loop(modes or Own(alphas), *rest)
    count = int(np.prod(shape))
    p, tau = np.empty(count), np.empty(count)

    def work(start: int, stop: int) -> None:
        mirrored = mirror_of(start, stop) * x_of(start, stop)
        mirrored.flags.writeable = False  # as all that a kernel reads, see elements
        points = Points(mirrored, *(part(start, stop) for part in others))
        loop(alpha_of(start, stop), points, p[start:stop], tau[start:stop], 0, stop - start)
        tau[start:stop] = sign_of(start, stop) * tau[start:stop] + 0.0

    run_blocks(work, count, _BLOCK)
    given = {"x": x, "V": V} | ({"omega": omega} if delta is None else {"delta": delta})
    found = {"p": shaped("p", p, shape), "tau": shaped("tau", tau, shape)}
    return Values(found, given, title="Stresses", labels=labels)


def _stresses(materials: MaterialArray) -> Callable:
    from .contact_each import stresses_each

    return stresses_each(materials)
