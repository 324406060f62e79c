"""What no table, grid or exported law holds is refused, or said."""

from contextlib import suppress

import numpy as np
import pytest
import xarray as xr

import viscoroll as vr
from viscoroll import fmu

MODES = vr.Prony([2.0], [1.0])


@pytest.mark.parametrize(
    ("filled", "attributes", "allowed"),
    [
        (2.0, {}, r"in \[0, 1\]"),
        (0.5, {"valid_max": 0.4}, r"within its valid range \[-inf, 0\.4\]"),
        (0.0, {"valid_min": 0.001}, r"within its valid range \[0\.001, inf\]"),
        (0.5, {"valid_range": [0.0, 0.4]}, r"within its valid range \[0, 0\.4\]"),
    ],
)
def test_a_rolling_moment_of_no_contact_is_refused(tmp_path, filled, attributes, allowed):
    """The load of no contact acts farther from the axis than R, so that M is at most P R; what the
    file declares as invalid is missing.
    """
    path = tmp_path / "grid.nc"
    V = ("V", [0.5, 1.0, 2.0], {"units": "1"})
    delta = ("delta", [-0.02, 0.0, 0.02], {"units": "1"})
    Q = (("V", "delta"), np.tile([-0.2, 0.0, 0.2], (3, 1)), {"units": "1"})
    M = ("V", [0.01, filled, 0.03], {"units": "1"} | attributes)
    grid = xr.Dataset({"Q": Q, "M": M}, {"V": V, "delta": delta}, {"mu": 0.2})
    grid.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(vr.FileError, match=rf"at V\[1\]: must be {allowed}"):
        vr.load_law(path)


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
