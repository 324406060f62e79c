"""Formulas of others beside the exact law -> data/results/formulas.json and
data/reference/rolling_formulas.csv (kept in git).

    python -m pipeline.evidence.prove.formulas [-o FILE]

Persson's rolling friction over speed, Jonkers' formula and the half-space for the belt of the
how-to, and the law in the limits of Hunter and of May, Morris & Atack.  Each is for a rigid
cylinder that rolls freely.  pipeline/evidence/document/ puts the tables into
docs/accuracy_independent.md.
"""

from __future__ import annotations

import csv
import io
import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

import viscoroll as vr
from viscoroll.core.files import write_text

from ...stage import ROOT
from ..peers.rolling_formulas import Rolled, jonkers, persson
from ..results import run
from .layer import MATERIAL, springs_moment

REFERENCE = ROOT / "data/reference/rolling_formulas.csv"
COLUMNS = (
    *("formula", "E", "nu", "prony_E", "prony_tau_s", "h"),
    *("R", "P", "V", "C_rr", "length"),
)
#: Idler and belt cover of docs/howto/covers.md: m, N per m of width, m.
R = 0.08
LOAD = 2e3
THICKNESS = 6e-3
BELT = vr.Material(
    E=4e6, nu=0.49, prony=vr.Prony(E=[0.3, 0.6, 1.5], tau=[0.1, 1e-3, 1e-5]), T_ref=1.0
)
SHIFT = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
TEMPERATURES = (-20.0, 20.0, 40.0)
BELT_SPEEDS = (1.0, 5.0)
#: Rubbers of Persson's formula; speeds in contact lengths at rest per longest retardation time.
RUBBERS = {"one": replace(BELT, prony=MATERIAL), "three": BELT}
SPEEDS = (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 1e2, 1e3, 1e4)
#: Speeds kappa V of the limits; at the highest the contact is glassy to the digits of the table.
SLOWEST = 1e-4
FASTEST = 1e4
#: Of the layers that tend to springs: Poisson's ratio, thickness over l0, kappa V.
SPRINGS_NU = 0.3
SPRINGS_THICKNESS = (1.0, 0.5, 0.2, 0.1)
SPRINGS_SPEEDS = (0.3, 3.0)


def idler(rubber: vr.Material) -> vr.Cylinder:
    """Return the rigid idler on ``rubber``."""
    return vr.Cylinder(R=R, m=40.0, material=vr.Material.rigid(), base=rubber, mu=0.5, load=LOAD)


def freely(rubber: vr.Material, V: float) -> Rolled:
    """Return resistance over load, and contact length, of the idler that rolls freely at V, m/s.

    Towed without a torque: at delta = 0 the pressure on a layer drives it, and M is no resistance.
    """
    roller = idler(rubber)
    state = roller.steady(V=V, torque=0.0)
    length = roller.contact(V, delta=float(state.delta[0]), fields="length").length
    return Rolled(float(state.force[0]) / LOAD, float(length))


def speeds(rubber: vr.Material) -> Iterator[tuple[float, float]]:
    """Yield the speeds of Persson's formula: contact lengths per retardation time, and m/s."""
    rest = 2.0 * np.sqrt(4.0 * LOAD * R * (1.0 - rubber.nu**2) / (np.pi * rubber.E))
    for share in SPEEDS:
        yield share, float(share * rest / rubber.prony.T.max())


def over_speed() -> list[dict[str, Any]]:
    """Persson's C_rr and contact length less those of the law, relative."""
    rows = []
    for name, rubber in RUBBERS.items():
        for share, V in speeds(rubber):
            exact = idler(rubber).contact(V, delta=0.0, fields=("C_rr", "length"))
            formula = persson(rubber, R, LOAD, V)
            rows.append(
                {
                    "modes": name,
                    "share": share,
                    "C_rr": float(exact.C_rr),
                    "formula": formula.C_rr,
                    "off": formula.C_rr / float(exact.C_rr) - 1.0,
                    "length": formula.length / float(exact.length) - 1.0,
                }
            )
    return rows


def belt() -> list[dict[str, Any]]:
    """Half-space, Jonkers and Persson over the layer of the how-to."""
    rows = []
    for temperature in TEMPERATURES:
        rubber = BELT.at(temperature, SHIFT)
        for V in BELT_SPEEDS:
            layer = freely(replace(rubber, thickness=THICKNESS), V)
            others = {
                "half": freely(rubber, V),
                "jonkers": jonkers(rubber, THICKNESS, R, LOAD, V),
                "persson": persson(rubber, R, LOAD, V),
            }
            rows.append(
                {"temperature": temperature, "V": V, "C_rr": layer.C_rr, "length": layer.length}
                | {name: each.C_rr for name, each in others.items()}
                | {f"{name}_off": each.C_rr / layer.C_rr - 1.0 for name, each in others.items()}
            )
    return rows


def limits() -> list[dict[str, Any]]:
    """Limits of Hunter, and of May, Morris & Atack: quantity, what it tends to, and the law."""
    half = vr.Scene(material=vr.Bodies(MATERIAL, vr.Prony.elastic(), 1.0), kappa=1.0, mu=1.0)
    slow = half.contact(SLOWEST, delta=0.0, fields=("M", "lam"))
    fast = half.contact(FASTEST, delta=0.0, fields=("M", "lam"))
    lost = 1.0 - float(MATERIAL.tau[0]) / float(MATERIAL.T[0])
    hunter = {
        "M R/(P V (T_epsilon - T_sigma)), slow": (float(slow.M) / SLOWEST / lost, 1.0),
        "contact length over that of the relaxed body, slow": (float(slow.lam), 1.0),
        "contact length over that of the glassy body, fast": (
            float(fast.lam) * float(MATERIAL.alpha) ** 0.5,
            1.0,
        ),
    }
    rows = [
        {"source": "Hunter", "quantity": name, "law": law, "limit": limit, "off": law / limit - 1.0}
        for name, (law, limit) in hunter.items()
    ]
    for thickness in SPRINGS_THICKNESS:
        cover = vr.Cover(MATERIAL, nu=SPRINGS_NU, thickness=thickness)
        # springs know no shear: neither does the fast law without traction
        scene = half.replace(material=cover, coupled=False)
        for u in SPRINGS_SPEEDS:
            delta = float(scene.contact(u, delta=0.0, fields="delta_0").delta_0)
            law = float(scene.contact(u, delta=delta, fields="M").M)
            limit = springs_moment(u, thickness, SPRINGS_NU)
            rows.append(
                {
                    "source": "May, Morris & Atack",
                    "quantity": f"kappa M at h/l0 = {thickness:g}, kappa V = {u:g}",
                    "law": law,
                    "limit": limit,
                    "off": law / limit - 1.0,
                }
            )
    return rows


def reference() -> str:
    """Return the formulas' own numbers as CSV, 12 digits, with every input."""
    rows = []
    for rubber in RUBBERS.values():
        rows += [("Persson", rubber, "", V, persson(rubber, R, LOAD, V)) for _, V in speeds(rubber)]
    for temperature in TEMPERATURES:
        rubber = BELT.at(temperature, SHIFT)
        rows += [
            ("Jonkers", rubber, THICKNESS, V, jonkers(rubber, THICKNESS, R, LOAD, V))
            for V in BELT_SPEEDS
        ]
    text = io.StringIO()
    file = csv.writer(text, lineterminator="\n")
    file.writerow(COLUMNS)
    for name, rubber, h, V, found in rows:
        series = rubber.prony
        times = series.tau * rubber.T_ref
        modes = (" ".join(f"{each:.12g}" for each in part) for part in (series.E, times))
        numbers = (f"{each:.12g}" for each in (V, *found))
        file.writerow([name, rubber.E, rubber.nu, *modes, h, R, LOAD, *numbers])
    return text.getvalue()


def found() -> dict[str, Any]:
    """Write the reference values; return the comparisons with the law."""
    write_text(REFERENCE, reference())
    return {"persson": over_speed(), "belt": belt(), "limits": limits()}


if __name__ == "__main__":
    sys.exit(run("prove.formulas", found, __doc__, "formulas.json", sizes=False))
