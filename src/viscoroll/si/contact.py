"""Contact states, stresses and the validity of a cylinder in SI units."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..checks import checked, checked_extent
from ..contact_fields import KNOWN, OF_BODIES
from ..contact_stress import stress
from ..errors import unknown
from ..labels import Labels, unlabelled
from ..results import Values
from ..rolling_contact import contact
from ..scale import DIMENSIONS, Scale, si_unit
from ..symbols import MEASURED
from ..typed import Numbers
from .units import Cylinder, over, units_of
from .warned import look

#: what a cylinder has beside the fields of a scene, and of which of these it is made
OWN = {"length": "lam", "C_rr": "M"}


def contact_of(cylinder: Cylinder, V: Numbers, omega: Numbers | None, delta: Numbers | None, **options: Any) -> Values:
    """``Cylinder.contact``."""
    one = units_of(cylinder)
    plain, labels = unlabelled({"V": V, "omega": omega, "delta": delta})
    V, omega, delta = plain["V"], plain["omega"], plain["delta"]
    fields = options.pop("fields")
    asked = (fields,) if isinstance(fields, str) else None if fields is None else tuple(fields)
    for name in asked or ():
        if name not in (*KNOWN, *OWN):
            raise unknown("fields", name, (*KNOWN, *OWN), "a field")
    if asked is not None:
        asked = tuple(dict.fromkeys(OWN.get(name, name) for name in asked))
    V, extent = checked_extent("V", V)
    look(cylinder, V, extent)
    speeds = {"V": V / one["V"], "omega": over("omega", omega, one), "delta": delta}
    found = contact(cylinder.scene(), **speeds, fields=asked, **options).as_dict()
    names = list(found) if fields is None else [fields] if isinstance(fields, str) else list(fields)
    if fields is None:
        for name, of in OWN.items():
            names.insert(names.index(of) + 1, name)
        # of like bodies they are M/2 each: what force and moment on the cylinder take
        found |= {name: 0.5 * found["M"] for name in OF_BODIES if name not in found}
        names += [name for name in OF_BODIES if name not in names]
    if options.get("slopes"):
        names += [name for name in found if name not in names and name not in OWN.values()]
    given = {"V": V} | ({"omega": omega} if delta is None else {"delta": delta})
    about = {}
    if cylinder._held is not None and not np.ndim(one["length"]):
        about[MEASURED] = [rate * one["length"] for rate in cylinder._held]
    values = {name: found[OWN.get(name, name)] for name in names}
    return in_si(values, one, given, labels=labels, about=about)


def stress_of(cylinder: Cylinder, x: Numbers, V: Numbers, omega: Numbers | None, delta: Numbers | None) -> Values:
    """``Cylinder.stress``."""
    one = units_of(cylinder)
    plain, labels = unlabelled({"x": x, "V": V, "omega": omega, "delta": delta})
    x, V, omega, delta = plain.values()
    look(cylinder, checked("V", V))
    found = stress(
        cylinder.scene(),
        checked("x", x) / one["length"],
        over("V", V, one),
        omega=over("omega", omega, one),
        delta=delta,
    ).as_dict()  # fmt: skip
    given = {"x": x, "V": V} | ({"omega": omega} if delta is None else {"delta": delta})
    return in_si(found, one, given, "Stresses in the contact of a cylinder, SI units", labels)


def in_si(
    found: dict[str, Any], one: Scale, given: dict[str, Any], title: str = "Contact of a cylinder, SI units",
    labels: Labels | None = None, about: dict[str, Any] | None = None,
) -> Values:  # fmt: skip
    """Dimensionless results by name in SI units; ``given``: what they are over, in SI units already."""
    values = {name: one.of(name, value) for name, value in found.items()}
    units = {name: si_unit(name) for name in (*values, *given) if name in DIMENSIONS}
    return Values(values, given, units, title, labels, about)
