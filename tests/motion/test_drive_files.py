"""Driven motions as datasets, and at other times."""

import numpy as np
import xarray as xr
from drives import ROLLER

import viscoroll as vr

RAMP = vr.Schedule([0.0, 1.0, 1.0], [0.0, 0.2, 0.0])
ACTING = ("force", "torque", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss")
T = np.linspace(0.0, 4.0, 9)


def test_a_motion_carries_its_drive(tmp_path):
    """Whatever kind it is: a number, times and values, a callable, gains; what was not given is not
    there.  Other times keep it.
    """
    drive = {"force": np.cos, "torque": vr.Feedback(RAMP, omega=-0.1), "slope": -0.5}
    m = vr.roll(ROLLER, 0.2, 0.0, T, **drive)
    same = vr.roll(ROLLER, 0.2, 0.0, 4.0, **drive).at(T)
    m.to_xarray().to_netcdf(tmp_path / "m.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "m.nc", engine="h5netcdf", decode_times=False) as data:
        for name in ("V", "omega", *ACTING):
            assert np.array_equal(data[name].values, m[name])
            assert np.array_equal(same[name], m[name])
        assert data.attrs["drive_force"] == "a function of t"
        assert data.attrs["drive_error"] == m.drive_error > 0.0
        assert data["drive_torque"].values.tolist() == RAMP.values.tolist()
        assert data["drive_torque_time"].values.tolist() == RAMP.times.tolist()
        assert data["drive_torque"].attrs["gain_omega"] == -0.1
        assert data["drive_slope"].item() == -0.5
        assert data.attrs["kappa"] == m.scene.kappa > ROLLER.kappa
        assert np.array_equal(data["reversals"].values, m.reversals)
        assert m.reversals.size > 0
        assert "drive_brake" not in data


def test_an_ensemble_carries_its_drives():
    steps = vr.Schedule(RAMP.times, [[0.0, 0.2, 0.0], [0.0, 0.1, 0.0]])
    e = vr.ensemble(ROLLER, 0.0, 0.0, T, torque=steps, slope=[0.01, 0.02], fields=ACTING)
    data = e.to_xarray()
    assert data["drive_torque"].dims == ("motion", "drive_torque_time")
    assert data["drive_slope"].values.tolist() == [0.01, 0.02]
    for name in ACTING:
        assert np.array_equal(data[name].values, e[name])
