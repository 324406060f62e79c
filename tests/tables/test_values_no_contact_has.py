"""What no table, grid or exported law holds is refused, or said."""

from contextlib import suppress

import pytest

import viscoroll as vr
from viscoroll import fmu

MODES = vr.Prony([2.0], [1.0])


def test_an_fmu_of_a_cover_says_that_it_has_the_fast_law(tmp_path):
    """The warning states the error of Q and M of a Cylinder; without a choice none is silent."""
    cover = vr.Material(E=2e6, nu=0.5, prony=MODES, thickness=0.005)
    roller = vr.Cylinder(R=0.1, m=40.0, material=cover, base=vr.Material.rigid(), mu=0.5, load=2e3)
    with (
        pytest.warns(vr.ModelWarning, match=r"fast law of a cover.*error of Q is up to"),
        suppress(vr.MissingDependencyError),
    ):
        fmu.build(roller, tmp_path / "a.fmu")
    with suppress(vr.MissingDependencyError):  # warnings are errors
        fmu.build(roller.replace(coupled=False), tmp_path / "b.fmu")
