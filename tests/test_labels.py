"""Labels of xarray and pandas: what comes in with them goes out with them."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import viscoroll as vr

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
ROLLER = vr.presets.RUBBER_CYLINDER
V = xr.DataArray([0.1, 0.2], dims="run", coords={"run": ["a", "b"], "day": 3}, name="speed")
TABLE = pd.DataFrame({"V": [0.1, 0.2], "delta": [0.0, 0.01]}, index=pd.Index(["x", "y"], name="roller"))


@pytest.mark.parametrize("body", [SCENE, ROLLER], ids=["scene", "cylinder"])
def test_contact_states(body):
    own = body.contact
    creep = xr.DataArray([0.0, 0.01, 0.02], dims="creep")
    found = own(V, delta=creep)
    assert found.M.dims == found.to_xarray()["M"].dims == ("run", "creep")
    assert np.array_equal(found.M.sel(run="b"), own(0.2, delta=creep.values).M)
    found = own(TABLE["V"], delta=TABLE["delta"])
    assert found.M["y"] == own(0.2, delta=0.01).M
    assert found.to_pandas().index.name == "roller"
    assert found.to_pandas()["M [N m m-1]" if body is ROLLER else "M"]["y"] == found.M["y"]
    assert own(V.rename(run="V").assign_coords(V=V.values), delta=0.0).to_xarray()["M"].dims == ("V",)


@pytest.mark.parametrize("body", [SCENE, ROLLER], ids=["scene", "cylinder"])
def test_equilibria(body):
    own = body.steady
    slope = xr.DataArray(np.radians([0.01, 0.02, 40.0]), dims="place", coords={"place": ["a", "b", "c"]})
    found, plain = own(slope=slope), own(slope=slope.values)
    assert found.V.dims == ("place", "equilibrium")
    assert np.array_equal(found.V.sel(place="b"), plain.V[1], equal_nan=True)
    assert found.eigenvalues.dims == (*found.loss.slip.dims, "rate")
    assert found.count.sel(place="c") == 0
    assert own(slope=slope.to_series()).V.loc["b", 0] == plain.V[1, 0]
    force = xr.DataArray([0.001, 0.002], dims="force", coords={"force": [0.001, 0.002]})
    assert own(force=force).to_xarray()["V"].dims == ("given_force", "equilibrium")


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
@pytest.mark.parametrize("body", [SCENE, ROLLER], ids=["scene", "cylinder"])
def test_ensembles(body):
    own = body.ensemble
    found, plain = own(TABLE["V"], TABLE["V"], [1e-3, 2e-3]), own(TABLE["V"].values, TABLE["V"].values, [1e-3, 2e-3])
    assert np.array_equal(found.V, plain.V)
    data = found.to_xarray()
    assert data.V.sel(motion="y", t=2e-3) == plain.V[1, 1]
    assert data["motion"].attrs["long_name"] == "roller"
    assert found.to_pandas().loc[("y", 2e-3), "V [m s-1]" if body is ROLLER else "V"] == plain.V[1, 1]
    by_array = own(V, 0.0, [1e-3], slope=0.01 * V, force=vr.Schedule([0.0, 1.0], [0.0, 0.0])).to_xarray()
    assert list(by_array["motion"]) == ["a", "b"]
    levels = pd.MultiIndex.from_tuples([("p", 1), ("q", 2)], names=["maker", "batch"])
    assert list(own(TABLE["V"].set_axis(levels), 0.0, 1e-3).to_xarray()["maker"]) == ["p", "q"]
