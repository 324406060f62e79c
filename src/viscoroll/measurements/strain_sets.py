"""Moduli measured at several strains, and the fit at the strain of a contact:
:func:`fit_at_strain`.

Filled rubbers soften with the strain (Payne).  The contact depends on the moduli, and its strain on
the contact, so that the strain is a fixed point: contact -> strain -> moduli -> contact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..core.errors import ConvergenceError, described_error
from .dynamic_moduli import DynamicModuli
from .fit_results import Fit
from .fit_series import fit_prony

#: ln of the ratio of two strains from which on they are of two sets: tests hold theirs to some per
#: cent
_GAP = math.log(1.2)
#: largest change of ln(strain) of the fixed point, far below what changes moduli by a per cent
_CHANGE = 1e-3
#: fits of the fixed point: each changes the strain by some tenth of the change before
_FITS = 30


def fit_at_strain(
    records: DynamicModuli | Sequence[DynamicModuli], cylinder: Any, V: float, **options: Any
) -> Fit:
    """Fit a Prony series to moduli measured at several strains, at the strain of a contact.

    Parameters
    ----------
    records : what :func:`viscoroll.read_dma` returns, one record or several, of which each point
        has its ``strain``; points whose strains differ by less than a fifth are one set.
    cylinder : a :class:`viscoroll.Cylinder` without arrays, whose ``material`` is replaced by that
        of each fit; its nu, name, density, thickness and shift stay.
    V : speed, m/s.
    **options : of :func:`viscoroll.fit_prony`.

    Returns
    -------
    Fit
        Of log E' and log E'' interpolated in log strain between two isothermal sets, or of the set
        nearest to the strain, where it is beyond all sets or they have several temperatures;
        ``strain`` is that of these moduli, and ``source`` says which sets they are.  Of one set it
        is ``fit_prony(record)``.

    Raises
    ------
    ParameterError
        A record without strain, and as :func:`viscoroll.fit_prony` and :func:`viscoroll.validity`.
    ConvergenceError
        A strain that does not settle, as where the nearest of two sets depends on the moduli of
        each.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> soft = vr.read_dma(vr.datasets.path("dma.csv"))
    >>> soft = replace(soft, strain=np.full(soft.omega.size, 0.1))
    >>> stiff = replace(
    ...     soft, storage=2.0 * soft.storage, loss=2.0 * soft.loss, strain=0.01 * soft.strain
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01), mu=0.6
    ... )
    >>> fit = vr.fit_at_strain([soft, stiff], roller, 1.0)
    >>> 0.001 < fit.strain < 0.1
    True

    Notes
    -----
    The strain of the contact with the material of the fit is ``strain`` to 1e-3
    (``tests/test_heat.py``).
    """
    sets = _sets_of([records] if isinstance(records, DynamicModuli) else records)
    if len(sets) == 1:
        return fit_prony(sets[0], **options)
    strain = math.exp(np.mean([math.log(each.mean_strain) for each in sets]))
    for _ in range(_FITS):
        fit = fit_prony(_at_strain(sets, strain), **options)
        body = fit.material(cylinder.material.nu)
        own = {
            name: getattr(body, name) for name in ("E", "prony", "T_ref", "measured", "temperature")
        }
        roller = cylinder.replace(material=replace(cylinder.material, **own))
        last = strain
        strain = float(np.max(roller.validity(V).strain.value))
        if abs(math.log(strain / last)) <= _CHANGE:
            return fit
    raise ConvergenceError(
        f"fit_at_strain: the strain of the contact does not settle; the last are {last}, {strain}"
    )


def _sets_of(records: Sequence[DynamicModuli]) -> list[Any]:
    """Return records of one strain each, by rising strain; one that has one strain as it is."""
    found: list[Any] = []
    for record in records:
        if record.mean_strain is None:
            raise described_error(
                "records", f"have no strain ({record.source})", "with the strain of each point"
            )
        order = np.argsort(strains := np.asarray(record.strain), kind="stable")
        parts = np.split(order, np.flatnonzero(np.diff(np.log(strains[order])) > _GAP) + 1)
        found += [record] if len(parts) == 1 else [_points(record, np.sort(part)) for part in parts]
    return sorted(found, key=lambda each: each.mean_strain)


def _points(record: DynamicModuli, at: Any) -> DynamicModuli:
    """Return a record of the points ``at`` of another."""
    names = ("omega", "storage", "loss", "temperature", "strain")
    return replace(
        record, **{name: each[at] for name in names if (each := getattr(record, name)) is not None}
    )


def _at_strain(sets: list[Any], strain: float) -> DynamicModuli:
    """Return the moduli at a strain, by two sets or by the nearest; arguments as of
    :func:`fit_at_strain`.
    """
    strains = np.array([each.mean_strain for each in sets])
    n = int(np.searchsorted(strains, strain).clip(1, strains.size - 1))
    part = math.log(strain / strains[n - 1]) / math.log(strains[n] / strains[n - 1])
    less, more = sets[n - 1 : n + 1]
    if not (0.0 < part < 1.0 and less.isothermal and more.isothermal):
        nearest = less if part < 0.5 else more
        return replace(
            nearest, source=f"{nearest.source}, the set at a strain of {nearest.mean_strain:.3g}"
        )
    both = (less.omega >= more.omega.min()) & (less.omega <= more.omega.max())
    low = _points(less, both)
    order = np.argsort(more.omega)
    moduli = {}
    for name in ("storage", "loss"):
        other = np.interp(
            np.log(low.omega), np.log(more.omega[order]), np.log(getattr(more, name)[order])
        )
        moduli[name] = np.exp((1.0 - part) * np.log(getattr(low, name)) + part * other)
    of = (
        f"interpolated at a strain of {strain:.3g} between the sets at {strains[n - 1]:.3g} and "
        f"{strains[n]:.3g}"
    )
    return replace(
        low, strain=np.full(low.omega.size, strain), source=f"{low.source}, {of}", **moduli
    )
