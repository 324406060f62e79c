"""A finished run as a result: text, HTML, datasets, a table, a figure."""

import numpy as np
import pytest
import xarray as xr
from refusals import refused
from run_files import run_of

import viscoroll as vr
from viscoroll.runs import open_run, run_ensemble

RUN = """
[cylinder]
R = 0.1
m = 35.5
mu = { distribution = "uniform", loc = 0.2, scale = 0.2 }
[material]
E = 3e6
nu = 0.5
prony = { E = [0.3, 0.6], tau = [2e-2, 1e-3] }
[start]
V0 = 2.0
omega0 = 0.0
[run]
n = 40
t = [0.1, 1.0]
rtol = 1e-6
keep = "KEEP"
summaries = ["V", "onset_time"]
quantiles = [0.1, 0.5, 0.9]
"""


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("keep", ["all", "summaries"])
@pytest.mark.long
def test_a_store_shows_itself(keep):
    """And its summaries as a table."""
    run_ensemble(run_of(RUN.replace("KEEP", keep)), "s.zarr", threads=1)
    found = open_run("s.zarr")
    if keep == "summaries":
        refused(found.motions, "keep", error=vr.FileError)
        return
    assert found.motions().V.shape == (40, 2)
    assert all(
        words in repr(found) for words in ("40 motions", "m s-1", "40 of 40 motions: reached")
    )
    assert "loc = 0.2" in found.run_file
    assert found.to_xarray().identical(xr.open_zarr("s.zarr", chunks=None))
    assert len(found.plot().axes) == 4
    table = found.to_pandas()
    data = found.summaries
    assert table.index.names == ["quantity", "t [s]"]
    assert table.loc[("V [m s-1]", 1.0), "mean"] == data.V_mean.values[1]
    assert table.loc[("V [m s-1]", 0.1), 0.5] == data.V_quantiles.values[1, 0]
    assert list(table.columns) == ["mean", "std", "min", "max", 0.1, 0.5, 0.9]
    assert np.isfinite(table.loc["onset_time [s]", "mean"].item())
