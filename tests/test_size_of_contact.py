"""Loads and lengths in other units make a contact that is absurd, and one warning."""

import warnings

import pytest

import viscoroll as vr


@pytest.mark.parametrize(("load", "count"), [(1e3, 0), (5e4, 1)])
@pytest.mark.parametrize(
    "call", [lambda c: c.contact(0.5, delta=0.0, fields="M"), lambda c: c.roll(1.0, 10.0, 0.01)]
)
def test_a_layer_pressed_beyond_its_modulus_is_said(load, count, call):
    """On a thin cover no contact is longer than the radius: its pressure shows a wrong unit."""
    cover = vr.Material(E=2e6, nu=0.5, prony=vr.Prony([2.0], [0.01]), thickness=0.002)
    rigid = vr.Material.rigid()
    roller = vr.Cylinder(
        R=0.1, m=40.0, material=cover, base=rigid, mu=0.5, load=load, coupled=False
    )
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        call(roller)
    assert sum("peak pressure on the layer" in str(each.message) for each in said) == count
