"""A dimensionless roller, :class:`Scene`, and the methods that it shares with a cylinder, :class:`Methods`."""

from __future__ import annotations

from .contact_law.contact import contact
from .contact_law.equilibria.resistance import resistance_extrema
from .contact_law.equilibria.steady import steady
from .contact_law.law import law
from .contact_law.parameters import Parameters, Roller
from .contact_law.stress import stress
from .contact_law.validity.validity import validity
from .heat.limits import heat_limit, turning_points
from .heat.pairs import pair_temperatures
from .heat.temperature import temperature
from .heat.warming import warming
from .motion.ensemble import ensemble
from .motion.roll import roll


class Methods(Roller):
    """The functions of the package as methods of a scene and a cylinder: ``vr.contact(roller, V, ...)`` is
    ``roller.contact(V, ...)``, with the same arguments and results.
    """

    contact = contact
    stress = stress
    steady = steady
    resistance_extrema = resistance_extrema
    law = law
    roll = roll
    ensemble = ensemble
    validity = validity
    temperature = temperature
    warming = warming
    heat_limit = heat_limit
    turning_points = turning_points
    pair_temperatures = pair_temperatures


class Scene(Methods, Parameters):
    """Dimensionless parameters of a cylinder that rolls on a half-space, as in Sect. 3.1 and Eq. (4) of the paper
    (Zobova and Goryacheva, 2020).

    Each number may be an array; they broadcast against each other and against speeds.  The functions of the package
    are its methods too.  The unit of time, T_ref, is T_epsilon where ``alpha`` is given, else that of the material; the
    unit of length in the contact is l0, the contact length at rest of half-spaces, and that of forces the load P.

    Parameters
    ----------
    alpha : T_epsilon/T_sigma, retardation time divided by relaxation time, in [1, 1e12] (1: elastic);
        the unit of time is T_epsilon.
    kappa : R/l0 = sqrt(E' R/(32 P)), radius divided by contact length at rest, > 0;
        the half-space theory requires kappa >> 1.
    mu : coefficient of friction, > 0.
    gamma : P T_ref^2/(m R), > 0; it sets the time scale of motions.  roll and ensemble need it, contact, stress and
        steady do not; validity without it does not check the quasi-steady assumption.
    j : moment of inertia divided by m R^2, > 0; 1/2 (default) for a solid cylinder.  Not used by contact or stress.
    material : a :class:`Prony` series, or two (:class:`Bodies`), or n of either, an array parameter
        (n,), in place of ``alpha``, which is then that of the material; the unit of time is T_ref, in which a series
        counts its times.  A law of :func:`viscoroll.load_law` stands for its material, or its alpha.  A
        :class:`viscoroll.Cover` is a layer of finite thickness.
    coupled : as of :class:`Cylinder`; of :class:`Bodies` by their ``poisson``.

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, kappa or mu is missing, mu/kappa is outside 1e-290 to 1e290, the
        shapes do not broadcast, or both or neither of ``alpha`` and ``material`` are given.

    Examples
    --------
    >>> import viscoroll as vr
    >>> scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3)
    >>> bool(scene.contact(0.1, delta=0.5).full_slip)
    True
    """
