"""Splines of a grid in compiled code, and the law that they make: for integrators in Python, numba
and C.
"""

import ctypes
import pickle
from functools import partial

import numba
import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll import tables
from viscoroll.tables import table_files

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
ROLLER = vr.presets.PAPER_CYLINDER
V = np.geomspace(1e-4, 4.0, 81)
ALPHA = np.array([5.0, 7.0, 11.0, 16.0])


@pytest.fixture(scope="module")
def grid():
    speeds = V[::2]
    nodes = tables.creep_nodes(SCENE, speeds, 41, alpha=ALPHA)
    return tables.build(SCENE, speeds, delta=nodes, alpha=ALPHA)


def inside(table, count):
    """Random points in a grid, of V and alpha even in their logarithms."""
    random = np.random.default_rng(3)
    points = {}
    for name in table_files.axes_of(table):
        ends = table[name].values[[0, -1]]
        even = np.linspace(*ends, count) if name == "delta" else np.geomspace(*ends, count)
        points[name] = random.permutation(even).clip(*ends)
    return points


@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("nodes", [{}, {"alpha": 0}, {"V": [0, 9], "delta": [3, 9, 20]}])
def test_compiled_values_are_those_of_the_interpolant(grid, nodes, linear):
    table = grid.isel(nodes, drop=True)
    look_up = tables.Interpolant(table, linear)
    points = inside(table, 200)
    places = np.transpose([points.get(axis, np.ones(200)) for axis in ("V", "delta", "alpha")])
    for field in table_files.fields_of(table):
        own = {str(dim): points[str(dim)] for dim in table[field].dims}
        at, spline = look_up.jitted(field)
        out = np.array([at(spline, *place) for place in places])
        size = abs(table[field].values).max()
        assert close(out[:, 0], look_up(field, **own)[field], tol.COMPILED_SPLINE, scale=size)
        others = [n for n, axis in enumerate(("V", "delta", "alpha"), 1) if axis not in own]
        assert not out[:, others].any()


def test_compiled_slopes_are_those_of_the_values(grid):
    step = 1e-6
    middle = [
        each * (1.0 - 4.0 * step) + 2.0 * step * grid[name].values.mean()
        for name, each in inside(grid, 100).items()
    ]
    for field in ("Q", "lam"):
        at, spline = tables.Interpolant(grid).jitted(field)
        for place in np.transpose(middle):
            value, *slopes = at(spline, *place)
            for slope, move in zip(slopes, np.diag(step * place)):
                low, high = (at(spline, *place + each).value for each in (-move, move))
                if SCENE.mu not in np.abs([value, low, high]):
                    found = (high - low) / (2.0 * move.sum())
                    size = abs(step * value / move.sum())
                    assert close(found, slope, tol.COMPILED_SLOPE, scale=size)


def test_compiled_values_are_clipped_and_nothing_is_extrapolated(grid):
    at, Q = tables.Interpolant(grid.sel(alpha=[11.0])).jitted("Q")
    slips = np.array([at(Q, 0.02, creep, 0.0) for creep in np.linspace(0.02, 0.05, 1001)])
    slips = slips[slips[:, 0] == SCENE.mu]
    assert slips.size
    assert not slips[:, 1:].any()
    for outside in ((5.0, 0.0), (1e-5, 0.0), (0.1, 1.0), (np.nan, 0.0), (0.1, np.nan), (-0.1, 0.0)):
        assert np.isnan(at(Q, *outside, 0.0)).all()


# --- the law of a grid ---


@numba.njit
def called(law, V, omega):
    return law(V, omega)


def test_the_law_of_a_grid_is_that_of_rows_within_its_stated_error(grid, tmp_path):
    tables.save(grid, tmp_path / "grid.nc")
    law = vr.law(vr.load_law(tmp_path / "grid.nc", alpha=11.0))
    points = inside(grid, 2000)
    speeds = points["V"] * np.random.default_rng(1).choice([-1.0, 1.0], 2000)
    omega = speeds * (1.0 + points["delta"])
    found = law(speeds, omega, slopes=True)
    truth = SCENE.law()(speeds, omega)
    for field in ("Q", "M"):
        error = abs(getattr(found, field) - getattr(truth, field)).max()
        assert error <= grid[field].attrs["spline_error"]
    assert (found.M_half_space == found.M_cylinder).all()
    function, data = law.ctypes
    out = (ctypes.c_double * 10)()
    for n, at in enumerate(zip(speeds[:50], omega[:50])):
        assert function(*at, out, data) == 0
        state = tuple(float(each[n]) for each in found)
        assert tuple(out) == state == called(law.jitted, *at) == law.jitted(*at)
        assert law(*at) == state[:4]
    again = pickle.loads(pickle.dumps(law))
    assert again(0.3, 0.301) == law(0.3, 0.301)


def test_a_grid_of_another_program(tmp_path):
    """Q, M and the part of one body, whose other one is the rest, in other units and order of
    dimensions, netCDF 3, no attribute of this package.
    """
    nodes = 1e-3 * V
    own = tables.build(ROLLER, nodes, delta=tables.creep_nodes(ROLLER, nodes, 81))
    other = own[["Q", "M"]].transpose().drop_attrs()
    other.attrs = {"R": ROLLER.R, "mu": ROLLER.mu, "load": ROLLER.load}
    other["delta"].attrs["units"] = "1"
    for name, unit, factor in (("Q", "kN/m", 1e-3), ("M", "N mm/m", 1e3), ("V", "mm s-1", 1e3)):
        other[name] = (factor * other[name]).assign_attrs(units=unit)
    other["M_cylinder"] = other["M"]
    other.to_netcdf(tmp_path / "other.nc", engine="scipy", format="NETCDF3_64BIT")
    speeds = np.array([1e-3, -3e-3, 1e-4, 2e-3])
    omega = speeds * np.array([1.001, 1.005, 0.99, 1.5]) / ROLLER.R
    law = vr.law(vr.load_law(tmp_path / "other.nc"))
    found, truth = (each(speeds, omega, slopes=True) for each in (law, ROLLER.law()))
    labelled = law(*(xr.DataArray(each, dims="run") for each in (speeds, omega)))
    assert labelled.Q.identical(xr.DataArray(found.Q, dims="run", name="Q"))
    pint = pytest.importorskip("pint").get_application_registry()
    with_unit = law(pint.Quantity(3.6 * speeds, "km/h"), pint.Quantity(0.036 * omega, "km/h/cm"))
    assert close(with_unit.M, found.M, tol.SCENE)
    moment = ROLLER.load * ROLLER.R
    assert close(found.Q, truth.Q, tol.COARSE_GRID, scale=ROLLER.load)
    assert close(found.M, truth.M, tol.COARSE_GRID, scale=moment)
    size = moment / abs(speeds)
    assert close(found.dQ_domega, truth.dQ_domega, tol.COARSE_GRID_SLOPE, scale=size)


def test_a_grid_has_no_onset_and_no_stick_zone(tmp_path):
    """The ends of its axis of delta are none; shapes are those of any law."""
    nodes = tables.spread(1e-3, 2.0, 9, "log")
    own = tables.build(SCENE, nodes, delta=tables.creep_nodes(SCENE, nodes, 21))
    tables.save(own, tmp_path / "own.nc")
    read = vr.load_law(tmp_path / "own.nc")
    roller = SCENE.replace(alpha=None, material=read)
    assert list(roller.contact(1.0, delta=0.0).keys()) == ["delta", "Q", "M", "delta_0"]
    for name in ("delta_star", "delta_minus", "delta_plus", "full_slip"):
        refused(partial(roller.contact, 1.0, delta=0.0, fields=name), "a grid contains only Q")
    assert np.isnan(roller.steady(V=0.5, torque=0.0).beta).all()
    law = vr.law(read)
    refused(lambda: law([1.0, 1.1], [1.0, 1.1, 1.2]), "V (2,), omega (3,) do not fit together")
    tables.save(tables.build(SCENE, nodes, delta=[8.0, 9.0]), tmp_path / "ahead.nc")
    ahead = vr.law(vr.load_law(tmp_path / "ahead.nc"))
    refused(lambda: ahead(1.0, 1.0), "within the table")
