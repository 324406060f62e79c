"""A material as the contact law sees it: three functions of z, and their slopes.

    F = z + g      H = z^2 + 2 z h      m = M/V

All that the law, the motion and the stresses know of a material they read here, from one of two
kinds of record: :class:`Standard`, by Bessel ratios at an alpha, and :class:`Tabulated`, by
polynomials that are made where they are met.
"""

from __future__ import annotations

from ..compile.choice import by_record
from ..compile.jit import kernel
from . import standard as ratios
from . import tabulated as table
from .standard import Standard, standard
from .tabulated import Tabulated


def _either(name, at=1):
    return by_record(at, (Standard, getattr(ratios, name)), (Tabulated, getattr(table, name)))


#: (g, h) at z; 0 for z <= 0 (no stick zone)
generators = _either("generators")
#: (g, h, g', h')
generator_slopes = _either("generator_slopes")
#: (g, h, g', h', g'', h'')
second_slopes = _either("second_slopes")
#: (g, h, g', h', g'', h'', m, m') at z = zeta
at_contact = _either("at_contact")
#: (g, h, h', m) at z > 0
at_slide = _either("at_slide")
#: m from zeta, lam, g and h there
moment_of = _either("moment_of", at=4)


@kernel
def moment_factor(zeta, lam, material):
    """M/V of Eq. (16); c as V -> 0."""
    g, h = generators(zeta, material)
    return moment_of(zeta, lam, g, h, material)
