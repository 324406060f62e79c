"""Formulas of others: their derivations in limits, and how far they are from the law."""

import numpy as np
import tolerances as tol
from closeness import close
from places import DATA, kept
from scipy.integrate import quad
from scipy.special import j1

import viscoroll as vr
from pipeline.evidence.prove import formulas
from pipeline.evidence.prove.formulas import LOAD, R, jonkers, persson
from pipeline.stage import read_rows


def test_persson_is_the_integral_of_the_loss_modulus():
    """At its own half-length, from E' and E'' of the material, by quadrature."""
    rubber = formulas.RUBBERS["one"]
    V = 0.005
    found = persson(rubber, R, LOAD, V)
    s = 0.5 * found.length

    def density(k):
        E = (rubber.storage(k * V / s) + 1j * rubber.loss(k * V / s)) / (1.0 - rubber.nu**2)
        return (j1(k) / k) ** 2 * E.imag / abs(E) ** 2

    F = 8.0 * LOAD / np.pi / s * sum(quad(density, k, k + 10.0)[0] for k in range(0, 600, 10))
    assert close(found.C_rr, F, tol.FORMULA_QUADRATURE)


def test_jonkers_of_little_loss_is_an_elastic_bed_of_columns():
    """C_rr = pi/2 tan(delta) (pi/4)^(4/3) (P h/(E D^2))^(1/3), and half a wave over the contact."""
    h = 0.006
    rubber = vr.Material(4e6, 0.49, vr.Prony([1e-4], [1e-2]))
    found = jonkers(rubber, h, R, LOAD, 1.0)
    assert close(found.length**3, 4.0 * np.pi * LOAD * h * R / rubber.E, tol.FORMULA_SLOW)
    lost = rubber.tan_delta(np.pi * 1.0 / found.length)
    bed = np.cbrt(LOAD * h / (rubber.E * 4.0 * R**2))
    expected = 0.5 * np.pi * lost * (0.25 * np.pi) ** (4.0 / 3.0) * bed
    assert close(found.C_rr, expected, tol.FORMULA_SLOW)


def test_kept_values_are_those_of_the_formulas():
    """From the inputs of each row."""
    for row in read_rows(DATA / "reference/rolling_formulas.csv"):
        E, tau = (np.array(str(row[name]).split(), float) for name in ("prony_E", "prony_tau_s"))
        rubber = vr.Material(row["E"], row["nu"], vr.Prony(E, tau), 1.0)
        given = row["R"], row["P"], row["V"]
        by_height = row["formula"] == "Jonkers"
        found = jonkers(rubber, row["h"], *given) if by_height else persson(rubber, *given)
        assert close([*found], [row["C_rr"], row["length"]], tol.FORMULA_KEPT)


def test_the_law_is_as_near_as_the_page_says():
    rows = kept("formulas.json")
    three = [row for row in rows["persson"] if row["modes"] == "three"]
    assert max(abs(row[name]) for row in three for name in ("off", "length")) <= tol.PERSSON_THREE
    hunter = [row for row in rows["limits"] if row["source"] == "Hunter"]
    assert all(abs(row["off"]) <= tol.FORMULA_SLOW for row in hunter)
    thin = [
        row
        for row in rows["limits"]
        if f"h/l0 = {formulas.SPRINGS_THICKNESS[-1]:g}," in row["quantity"]
    ]
    assert thin
    assert all(abs(row["off"]) <= tol.SPRINGS_THIN for row in thin)
