"""Pressure and shear stress along the contact: :func:`stress`.

Numbers of equations are those of A. A. Zobova and I. G. Goryacheva, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.  l0 is the contact length at rest of half-spaces, kappa = R/l0, mu the coefficient of
friction; lam is the contact length over l0, epsilon its shift ahead of the axis over half the length, beta the part of
it that sticks, zeta half the transit time in the unit of time of the material, alpha the instantaneous over the
long-time modulus.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Literal, overload

import numpy as np

from ..core.array_types import Floats, Numbers
from ..core.blocks import block_reader, run_blocks
from ..core.checks import broadcast_shape, check_array, check_choice, divide_by_unit
from ..core.errors import check_one_given
from ..core.labels import strip_labels
from ..core.results import Values
from ..materials.bodies import total_series
from ..materials.law.cover_pressure import pressure
from ..materials.law.cover_solve import CoverModes
from ..materials.law.evaluate import series_record
from .contact_table import evaluate_contact
from .coupled_contact import coupled_stress
from .parameters import Parameters, Roller, resolve_model
from .validity.model_warnings import warn_of_contact

#: Points of a block: some milliseconds of work.
_BLOCK = 1 << 15
#: Fields of the contact that the stresses depend on.
_FIELDS = "lam", "epsilon", "beta", "zeta", "delta"


@overload
def stress(
    roller: Roller, x: Numbers, V: Numbers, *, delta: Numbers, method: Literal["table", "coupled"] = "table"
) -> Values: ...
@overload
def stress(
    roller: Roller, x: Numbers, V: Numbers, *, omega: Numbers, method: Literal["table", "coupled"] = "table"
) -> Values: ...
def stress(
    roller: Roller,
    x: Numbers,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    method: Literal["table", "coupled"] = "table",
) -> Values:
    """Compute pressure and shear stress along the contact of a rolling cylinder and its base, Eqs. (11)-(14).

    The equations are those of Zobova and Goryacheva (2020), with the functions of the bodies at hand (docs/theory.md).
    The contact is that of steady rolling at a given speed and creepage, whose lengths and slip :func:`contact` gives.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used; or a :class:`Cylinder`, in SI units.
    x : position divided by l0, of a Cylinder in m, from the point below the axis, positive in the direction of a
        positive V; any value: the stresses are 0 outside the contact.
    V : velocity of the axis, any sign; of a Cylinder m/s, of a Scene divided by R/T_ref.  T_ref is the unit of time:
        T_epsilon of a Scene with ``alpha``, else the time in which the material counts.
    delta, omega : exactly one: creepage (omega R - V)/V, or angular velocity, any sign; omega of a Cylinder in rad/s,
        of a Scene multiplied by T_ref.  At V = 0 a delta means the limit V -> 0+, an omega other than 0 full slip.
        All arguments broadcast.
    method : "table", or "coupled" (:func:`contact`), with which layers have a shear stress too.

    Returns
    -------
    Values
        ``p``: pressure, >= 0.  ``tau``: shear stress on the cylinder in the direction of +x, of the sign of omega R - V
        (at V = 0 of delta), 0 for delta = 0; |tau| <= mu p, with equality in the slip zone and, in full slip, in the
        whole contact.  Both are in Pa of a Cylinder, else divided by E', and 0 outside the contact.  If a body is a
        layer of finite thickness there is ``p`` alone by method "table": its shear stress is not known.  Both have the
        broadcast shape of arguments and roller; they are floats if all of these are numbers.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300, both or neither of delta and omega, shapes that do not broadcast,
        labelled arrays beside plain ones or with other coordinates, a unit of another dimension; what is no scene and
        no cylinder; a layer too thin for its law, times of a material beyond 1e-100 to 1e100 T_ref.

    Warns
    -----
    ModelWarning
        Of a Cylinder, as :func:`contact`: a contact longer than the radius, or outside of the measured band.

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> x = np.linspace(-0.01, 0.01, 201)  # m
    >>> found = vr.stress(vr.presets.RUBBER_CYLINDER, x, 0.1, delta=0.001)
    >>> bool(found.p.max() > 0.0)
    True

    Notes
    -----
    The error relative to the peak is below 1e-11 for alpha zeta from 1e-8 to 1e8
    (``tests/test_stress.py``).  Where V or the creepage are arrays, the state of the contact takes
    56 bytes for each of their elements, beside the result.
    """
    from ..kernels.rows.stress import Points

    _, scene, scale = resolve_model(roller, "stress")
    creep_name = check_one_given(delta=delta, omega=omega)
    check_choice("method", method, "table", "coupled")
    given, labels = strip_labels({"x": x, "V": V, creep_name: omega if delta is None else delta}, scale)
    given = {name: check_array(name, value) for name, value in given.items()}
    position, speed, creep = given.values()
    if scale.si:
        warn_of_contact(roller, speed)
        # A position that overflows lies outside the contact, a speed that overflows is refused.
        with np.errstate(over="ignore"):
            position = divide_by_unit("x", position, scale["length"])
            speed = divide_by_unit("V", speed, scale["V"])
            creep = divide_by_unit(creep_name, creep, scale[creep_name])
    if method == "coupled":
        both = coupled_stress(scene, position, speed, creep, creep_name == "omega")
        parts = {name: scale["p"] * value for name, value in zip(("p", "tau"), both, strict=True)}
        parts = {name: value if value.ndim else value.item() for name, value in parts.items()}
        return Values(parts, given, si=scale.si, title="Stresses", labels=labels)
    lam, epsilon, beta, zeta, delta = evaluate_contact(scene, speed, creep, creep_name == "omega", _FIELDS).values()
    # For V < 0 positions are mirrored, and tau changes its sign.
    mirror = np.where(speed < 0.0, -1.0, 1.0)
    alpha = scene.alpha if scene.material_array is None else np.arange(len(scene.material_array), dtype=np.float64)
    arrays = {"x": position, "kappa": scene.kappa, "mu": scene.mu, "lam": lam, "epsilon": epsilon, "beta": beta}
    arrays |= {"zeta": zeta, "alpha": alpha, "mirror": mirror, "sign": np.sign(delta) * mirror}
    arrays = {name: np.asarray(value, dtype=np.float64) for name, value in arrays.items()}
    shape = broadcast_shape(**arrays)
    read_x, *readers, read_alpha, read_mirror, read_sign = (block_reader(array, shape) for array in arrays.values())
    p, tau = np.empty((2, int(np.prod(shape))))

    def work(start: int, stop: int) -> None:
        """Compute p/E' and the signed tau/E' at points ``start`` to ``stop`` - 1 of the flattened broadcast shape, and
        write them into these elements of ``p`` and ``tau``; of a cover p alone.
        """
        mirrored = read_mirror(start, stop) * read_x(start, stop)
        mirrored.flags.writeable = False  # as all arrays that kernels read (block_reader)
        points = Points(mirrored, *(read(start, stop) for read in readers))
        _compute_stresses(scene, read_alpha(start, stop), points, p[start:stop], tau[start:stop])
        if scene.cover is None:  # else tau is not computed
            tau[start:stop] = read_sign(start, stop) * tau[start:stop] + 0.0

    run_blocks(work, p.size, _BLOCK)
    unit = scale["p"]
    rows = {"p": p} if scene.cover is not None else {"p": p, "tau": tau}
    found: dict[str, Any] = {}
    for name, row in rows.items():
        values = row.reshape(shape)
        values *= unit  # in place: a copy would double the memory of a large call
        found[name] = values if shape else values.item()
    return Values(found, given, si=scale.si, title="Stresses", labels=labels)


def _compute_stresses(scene: Parameters, alpha: Floats, points: Any, p: Floats, tau: Floats) -> None:
    """Compute the stresses at points, material by material, and write them into ``p`` and ``tau``.

    scene: dimensionless parameters of the roller, of which the material alone is read.
    alpha: alphas, or for an array of materials their indices as floats, (n,) or (1,); for one material not used.
        Consecutive points of one material are computed together.
    points: record :class:`...kernels.rows.stress.Points`; its fields (position, kappa, mu, lam, epsilon, beta, zeta)
        are (n,) or (1,), dimensionless, positions in the frame where V > 0, divided by l0.
    p, tau: pressure and size of the shear stress divided by E', (n,), written, 0 outside the contact; of a cover tau is
        not written.
    """
    from ..kernels.rows.stress import new_memory_weights, stress_loop

    ends: Any = [] if scene.material_array is None else 1 + np.flatnonzero(np.diff(alpha))
    for first, last in pairwise([0, *ends, p.size]):
        part = points._make(each[first:last] if each.size > 1 else each for each in points)
        index = int(alpha[min(first, alpha.size - 1)])  # of one of many materials
        if scene.cover is not None:
            p[first:last] = _cover_pressure(scene, index, part)
            continue
        material: Any = alpha if scene.series is None else scene.series
        if scene.material_array is not None:
            material = total_series(scene.material_array[index])
        series, alphas = series_record(material)
        stress_loop(
            series, alphas, new_memory_weights(series), new_memory_weights(series), part, p[first:last], tau[first:last]
        )


def _cover_pressure(scene: Parameters, index: int, points: Any) -> Floats:
    """Return p/E' at points on a cover, by one solve of the contact of the layer for each different state.

    scene: dimensionless parameters of a roller with a cover.
    index: index of the cover, if the scene has an array of covers; else not used.
    points: record :class:`...kernels.rows.stress.Points`, of which position (divided by l0, in the frame where V > 0),
        kappa, lam, epsilon and zeta (infinite at V = 0) are used, (n,) or (1,).
    Returns p/E', dimensionless, >= 0 to rounding, 0 outside the contact, a new array (n,), where n is the common length
    of these fields.
    """
    cover: Any = scene.cover if scene.material_array is None else scene.material_array[index]
    modes = CoverModes(cover)
    x, *state = np.broadcast_arrays(points.x, points.kappa, points.lam, points.epsilon, points.zeta)
    states_of_contact, which = np.unique(np.array(state), axis=1, return_inverse=True)
    found = np.empty(x.size)
    for n, (kappa, lam, epsilon, zeta) in enumerate(states_of_contact.T.tolist()):
        place = which.ravel() == n
        y = 2.0 * x[place] / lam - epsilon
        found[place] = pressure(modes, zeta, 0.5 * lam, y) / (8.0 * np.pi * kappa * lam)
    return found
