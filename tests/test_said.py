"""What is answered with a warning, or with nothing; and what results say of what was found."""

import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from calls import BELT, DMA, HEAVY, LABELLED, ONE, PAPER, ROLLER, SOFT, STEEL, UNSURE, T, pair
from drives import ON_DMA as DMA_ROLLER
from experiments import ranges, roller, thrown

import viscoroll as vr

pytestmark = pytest.mark.usefixtures("here")


SAID = {
    "Figure(": lambda: ROLLER.contact(
        pd.Series([1.0, 2.0, 3.0], index=pd.date_range("2026", periods=3)), delta=0.0
    ).plot(),
    "Figure": lambda: ROLLER.contact(
        LABELLED, delta=xr.DataArray([0.1, 0.2], dims="of", coords={"of": ["x", "y"]})
    ).plot(),
    "throw has few points in full slip (2), which alone determine mu": lambda: vr.identify(
        roller(), ranges("mu"), thrown(seed=1, t=np.linspace(0.0, 60.0, 200)), starts=1
    ),
    "the data do not depend on mu: omega0 was taken as V0/R, without slip; give omega0": lambda: (
        vr.identify(
            roller(),
            ranges("mu", "E"),
            [vr.Coastdown(T, roller().roll(3.0, 30.0, T).V, sigma=5e-3, V0=3.0)],
            starts=1,
        )
    ),
    "0.5 N m m-1 - 0.1 omega | a function of t": lambda: ROLLER.roll(
        0.0, 0.0, [0.0, 1.0], torque=vr.Feedback(0.5, omega=-0.1), force=lambda t: 0.1 * t
    ),
    "|force + torque| = 0.12 exceeds 0.0847415, the largest rolling moment (at V = "
    "0.235061)": lambda: PAPER.steady(force=0.05, torque=0.07).reason,
    "|force + torque/R| = | N/m, the largest rolling moment divided by R (at V = 0. | "
    "m/s)": lambda: vr.presets.PAPER_CYLINDER.steady(slope=0.1).reason,
    "above the friction mu = 0.2": lambda: PAPER.steady(force=0.3, torque=-0.28).reason,
    "no single steady state: |Q|/load = 0.2 equals mu | torque or slope, or raise mu": lambda: (
        PAPER.steady(force=-0.175, torque=0.225).reason
    ),
    "no isolated steady speed: elastic bodies roll without resistance, so every V is "
    "steady": lambda: PAPER.replace(alpha=1.0).steady().reason,
    "yes | cylinder and half-space have the same material: Dundurs' constant is 0": lambda: (
        pair(SOFT, None).validity(1.0).bodies
    ),
    "the density of the base is not known": lambda: pair(SOFT, STEEL).validity(1.0).quasistatic,
    "no: | ; the density of the cylinder is not known": lambda: (
        pair(replace(SOFT, density=None), HEAVY).validity(1e4).quasistatic
    ),
    # of DMA_ROLLER at V = 30
    "14.03 m | 1 % down to 0.14 m/s, below 10 % down to 0.04 m/s, which is reached after a "
    "time of 25.5 s | 0.002 m/s of speed and 0.062 m of distance": lambda: (
        pair(vr.Material(2.99e6, 0.5, DMA_ROLLER.material, 3.0), None).validity(1.0).steady
    ),
}
#: on a thin cover no contact is longer than the radius: its pressure shows a wrong unit
THIN = replace(vr.Material.elastic(2e6, 0.5), thickness=0.002)
PRESSED = pair(THIN, vr.Material.rigid(), coupled=False)
WARNED = {
    "peak pressure on the layer": [
        lambda: PRESSED.replace(load=5e4).contact(0.5, delta=0.0),
        lambda: PRESSED.replace(load=5e4).roll(1.0, 10.0, 0.01),
    ],
    "T0 is outside -150 to 200 | looks like kelvin": [lambda: vr.Arrhenius(energy=8e4, T0=293.15)],
    "temperature is outside -150 to 200 | looks like kelvin": [
        lambda: vr.WLF(T0=20.0)(293.15),
        lambda: vr.fit_prony(*DMA, temperature=293.15),
    ],
    "too slow for the law of steady rolling: the computed speed has an error above 10 % on more "
    "than a tenth of the distance": [
        lambda: DMA_ROLLER.roll(3.0, 3.0, 1.0),
        lambda: UNSURE.ensemble(3.0, 3.0, 1.0),
        lambda: ONE.replace(alpha=[2.0, 11.0]).ensemble(1.0, 1.0, 1.0),
    ],
    "the cylinder starts in full slip with a creep": [
        lambda: vr.Scene(11.0, 10.0, 0.02, 0.1).roll(0.5, -0.5, 0.001)
    ],
    "the model does not hold for this contact: |V| or R |omega| exceeds the shear wave speed": [
        lambda: ROLLER.contact([1.0, 99.0], delta=0.0)
    ],
    "as measured | the contact needs the moduli from 0 to 1.9e+03 rad/s": [
        lambda: BELT.contact([0.0, 0.1, 2.895], delta=0.0)
    ],
    "as measured | the base was measured from 0.06 to 1.88e+03 rad/s, misfit 1 % (dma.csv)": [
        lambda: BELT.stress(0.0, 10.0, delta=0.0)
    ],
    "as measured | the contact needs the moduli from": [
        lambda: BELT.roll(10.0, 100.0, 0.01),
        lambda: BELT.roll(0.0, 0.0, [0.1, 1.0], force=300.0, torque=300.0),
        lambda: BELT.steady(V=10.0, torque=0.0),
    ],
    "the fit of the base misses its data | 20 %": [
        lambda: BELT.replace(
            base=replace(BELT.base, measured=replace(BELT.base.measured, misfit=0.2))
        ).contact(0.1, delta=0.0)
    ],
}
SILENT = {
    "peak pressure on the layer": [lambda: PRESSED.replace(load=1e3).contact(0.5, delta=0.0)],
    "": [
        lambda: vr.Arrhenius(energy=8e4, T0=180.0)(-60.0),
        lambda: DMA_ROLLER.roll(30.0, 30.0, 1.0),
        lambda: DMA_ROLLER.roll(0.0, 0.0, 1.0),
        lambda: DMA_ROLLER.roll(3.0, 3.0, 1.0, force=0.1),
        lambda: ROLLER.contact([1.0, 9.0], delta=0.0),
        lambda: ROLLER.replace(material=replace(ROLLER.material, density=None)).contact(
            99.0, delta=0.0
        ),
    ],
    "as measured": [
        lambda: BELT.contact([0.0, 0.1, 2.837], delta=0.0),
        lambda: BELT.roll(1.0, 10.0, [1.0, 4000.0]),
        lambda: BELT.steady(V=0.1, torque=0.0),
        lambda: BELT.replace(base=replace(BELT.base, measured=None)).contact(10.0, delta=0.0),
    ],
}


def said_of(call):
    """Warnings of a call, each of which points to this file."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        call()
    return [
        str(each.message)
        for each in found
        if each.category is vr.ModelWarning and each.filename == __file__
    ]


def rows(table):
    return [(words, call) for words, calls in table.items() for call in calls]


@pytest.mark.parametrize("words, call", rows(WARNED))
def test_warned(words, call):
    """Once."""
    first, *others = words.split(" | ")
    (message,) = [each for each in said_of(call) if first in each]
    assert all(word in message for word in others)


@pytest.mark.parametrize("words, call", rows(SILENT))
def test_not_warned(words, call):
    assert not [each for each in said_of(call) if words in each]


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize("words, call", SAID.items())
def test_said(words, call):
    text = str(call())
    assert all(word in text for word in words.split(" | ")), text
