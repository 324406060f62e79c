"""What no table, grid or exported law holds is refused, or said."""

from contextlib import suppress

import numpy as np
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


def test_free_motions_too_slow_for_a_table_are_refused():
    """Below 1e-11 the slip is lost in rounding: speeds were wrong; the fast law rolls there."""
    cover = vr.Cover(MODES, nu=0.5, thickness=0.5, on="base")
    scene = vr.Scene(material=cover, kappa=10.0, mu=0.3, gamma=0.5)
    with pytest.raises(vr.ParameterError, match="must be 0, or at least 1e-11"):
        vr.roll(scene, 1e-20, 0.0, 1.0)
    assert 0.0 < vr.roll(scene.replace(coupled=False), 1e-200, 0.0, 1.0).V[0] < 1e-200


def test_a_grid_rolls_at_its_own_kappa_and_has_the_fields_that_it_states(tmp_path):
    scene = vr.Scene(material=vr.Prony([2.0], [1.0]), kappa=10.0, mu=0.2)
    grid = vr.tables.build(scene, np.geomspace(0.01, 10.0, 12), delta=np.linspace(-0.05, 0.05, 21))
    vr.tables.save(grid, tmp_path / "grid.nc")
    law = vr.load_law(tmp_path / "grid.nc")
    state = vr.contact(vr.Scene(material=law, kappa=10.0, mu=0.2), 1.0, delta=0.05)
    assert state.Q == 0.2
    assert "beta" not in state.as_dict()
    with pytest.raises(vr.ParameterError, match=r"kappa = 12\.0: must be 10, for which the grid"):
        vr.Scene(material=law, kappa=12.0, mu=0.2)
