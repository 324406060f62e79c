"""A material as the contact law sees it: four functions of z, and their slopes.

    F = z + g      H = z^2 + 2 z h      M = V m, Eq. (16)      b = 2 z m/(lam H'), lam = z H^(-1/2)

The last is that of the slow manifold: D = zeta - eta is proportional to it in slow rolling.

All that the law and the motion know of a material they read here, from one of these records:
:class:`Standard`, an alpha, whose functions are Bessel ratios; :class:`Tabulated`, polynomials in a table;
:class:`Pair`, two of these tables, of bodies that deform unlike each other; :class:`Filled` and :class:`FilledPair`,
the same where each motion has its own series, or two.
Which one a call has is settled when it is compiled.  Where many states or motions each have an alpha of their own
the ratios serve, and where one material serves all, the table.
"""

from __future__ import annotations

from typing import Any, Callable, NamedTuple

from ..compile.choice import by_record
from ..compile.jit import kernel
from . import pair
from . import standard as ratios
from . import tabulated as table
from .each import Each, EachPair, Filled, FilledPair, of_each, of_each_pair
from .pair import Pair
from .standard import Standard, standard
from .tabulated import Tabulated


class Own(NamedTuple):
    """An alpha for each state or motion."""

    alpha: Any


def _either(name: str, at: int) -> Callable:
    tables = [(kind, getattr(table, name)) for kind in (Tabulated, Pair, Filled, FilledPair)]
    return by_record(at, (Standard, getattr(ratios, name)), *tables)


#: (g, h) at z; 0 for z <= 0 (no stick zone)
generators = _either("generators", 1)
#: (g, h, g', h') at z, all 0 for z <= 0
generator_slopes = _either("generator_slopes", 1)
#: (g, h, g', h', g'', h'') at z, all 0 for z <= 0
second_slopes = _either("second_slopes", 1)
#: (g, h, g', h', m, m', b, b') at z = zeta
at_contact = _either("at_contact", 1)
#: (g, h, h', m) at z > 0
at_slide = _either("at_slide", 1)
#: (g/z, m/z) from z and h there, where z is so small that its square may underflow
fast_limit = _either("fast_limit", 2)
#: (g, h, g', h', m of the half-space, m of the cylinder) at z > 0: halves of m where bodies are alike
at_rolling = by_record(
    1,
    (Standard, ratios.at_rolling),
    (Tabulated, table.at_rolling),
    (Pair, pair.at_rolling),
    (Filled, table.at_rolling),
    (FilledPair, pair.at_rolling),
)
#: (means of g' and of (z h)' over [zeta - D, zeta]) at zeta and D
mean_slopes = _either("mean_slopes", 2)
#: m at zeta, from zeta, lam, g and h
moment_of = _either("moment_of", 4)


@kernel(inline=True, allocates=True)  # what it returns holds a reference to the table
def _shared(material, i):
    return material


@kernel(inline=True)
def _own(material, i):
    return standard(material.alpha[min(i, material.alpha.size - 1)])


#: the material of state or motion i, from what is given for all
material_of = by_record(
    0, (Tabulated, _shared), (Pair, _shared), (Own, _own), (Each, of_each), (EachPair, of_each_pair)
)


@kernel
def moment_factor(zeta, lam, material):
    """m at zeta; c as V -> 0."""
    g, h = generators(zeta, material)
    return moment_of(zeta, lam, g, h, material)
