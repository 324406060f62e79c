"""The contact on grids for other programs: nodes, stated errors, formats, and files of every
version.
"""

import re
from functools import cache, partial

import h5py
import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from long_cases import long
from refusals import refused
from scipy import io

import viscoroll as vr
from viscoroll import tables
from viscoroll.laws.law_tables import law_table
from viscoroll.tables import table_files
from viscoroll.tables.law_dataset import NODES_ALLOWED, check_table

V = np.geomspace(1e-2, 2.0, 21)
DELTA = np.linspace(-0.04, 0.04, 33)
ALPHA = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
#: A thin rubber cover on a steel core, on concrete: delta_0 is an eighth of delta_star.
RUBBER = vr.Material(2e6, 0.5, vr.Prony([6.0], [1e-3]), thickness=0.012)
CONCRETE = vr.Material.elastic(3e10, 0.2)
COVERED = vr.Cylinder(R=0.1, m=60.0, material=RUBBER, base=CONCRETE, mu=0.6, coupled=False)
PAIR = vr.Bodies(vr.Prony([10.0], [1.0]), vr.Prony([0.3, 0.6], [1e-2, 1e-3]), 0.3)
WHAT = {
    "alphas": vr.presets.PAPER_SECTION_5,
    "cylinder": vr.presets.RUBBER_CYLINDER,
    "cover": COVERED,
    "law": law_table(PAIR),
}


@cache
def built(name):
    return tables.build(
        WHAT[name],
        V,
        delta=DELTA,
        alpha=ALPHA if name == "alphas" else None,
        command="made by a test",
    )


@pytest.fixture(scope="module", params=["alphas", "cylinder", *long("cover"), "law"])
def name(request):
    return request.param


@pytest.fixture(scope="module")
def table(name):
    return built(name)


def exact(name, points, fields):
    roller = WHAT[name] if name != "law" else vr.Scene(kappa=1.0, mu=1.0, material=PAIR)
    if name == "alphas":
        roller = roller.replace(alpha=points["alpha"])
    return roller.contact(points["V"], delta=points["delta"], fields=fields).as_dict()


def test_nodes_are_the_contact(name, table):
    axes = table_files.axes_of(table)
    points = np.meshgrid(*(table[axis] for axis in axes), indexing="ij")
    grid = dict(zip(axes, points))
    # shear acts back on a layer
    assert ("delta_0" in table) == ("delta" in table.M.dims) == (name == "cover")
    for field, values in exact(name, grid, table_files.fields_of(table)).items():
        nodes = values if "delta" in table[field].dims else values[:, 0]
        assert np.array_equal(table[field].values, nodes), field


def test_stated_errors_are_those_of_other_points(name, table):
    random = np.random.default_rng(5)
    points = {
        axis: random.uniform(*table[axis].values[[0, -1]], 8000)
        for axis in table_files.axes_of(table)
    }
    points["V"] = np.exp(random.uniform(*np.log(V[[0, -1]]), 8000)).clip(V[0], V[-1])
    truth = exact(name, points, table_files.fields_of(table))
    found = tables.interpolate(table, **points)
    linear = table.interp({axis: xr.DataArray(values) for axis, values in points.items()})
    for field in table_files.fields_of(table):
        for way, values in (("spline", found), ("linear", linear)):
            stated, at = (table[field].attrs[f"{way}_error{end}"] for end in ("", "_at"))
            error = abs(np.asarray(values[field]) - truth[field]).max()
            assert tol.GRID_LESS * stated <= error <= tol.GRID_MORE * stated, (field, way)
            # the largest occurs at the point that the attributes name, which has six digits
            place = {axis: float(x) for axis, x in re.findall(r"(\w+) = ([^,]+)", at)}
            assert set(place) == set(table[field].dims)
            whole = {axis: table[axis].values[0] for axis in points} | place
            there = tables.Interpolant(table, linear=way == "linear")(field, **place)[field]
            error = abs(there - exact(name, whole, (field,))[field])
            assert close(error, stated, tol.GRID_PLACE)


def test_splines_keep_the_bounds_of_the_law(name, table):
    """|Q| <= mu P and 0 <= beta <= 1 beside the kink at delta_star, where a cubic spline alone
    overshoots.
    """
    axes = table_files.axes_of(table)
    counts = {"alpha": 5, "V": 25, "delta": 401}
    fine = [np.linspace(*table[axis].values[[0, -1]], counts[axis]) for axis in axes]
    found = tables.interpolate(table, ("Q", "beta"), **dict(zip(axes, np.ix_(*fine))))
    most = table.attrs["mu"] * table.attrs.get("load", 1.0)
    assert abs(found.Q).max() <= most
    assert found.beta.min() >= 0.0
    assert found.beta.max() <= 1.0
    if name != "law":  # its creeps end below delta_star
        assert abs(found.Q).max() == most


def test_root_solves_meet_the_rows():
    """The paper's way to the nodes, of a cylinder in SI units, and what the grid says of them."""
    direct, rows = (
        tables.build(vr.presets.PAPER_CYLINDER, 1e-2 * V, delta=DELTA, method=way)
        for way in ("direct", "table")
    )
    assert direct.attrs["method"] == "direct"
    assert not np.array_equal(direct.Q, rows.Q)
    for name in table_files.fields_of(direct):
        assert 0.0 <= direct[name].attrs["difference_from_rows"] <= NODES_ALLOWED, name
        size = abs(rows[name].values).max()
        assert close(direct[name].values, rows[name].values, NODES_ALLOWED, scale=size)


def test_validation_finds_a_wrong_node():
    assert all(check.passed for check in check_table(built("alphas"), 2000, 1))
    wrong = built("alphas").copy(deep=True)
    wrong.Q[3, 4, 1] *= 1.0 + 10.0 * NODES_ALLOWED
    wrong.beta.attrs["spline_error"] *= 0.1
    wrong.lam.attrs["spline_error"] = 1.0  # an error as large as the range of lam
    found = {check.name: check for check in check_table(wrong, 2000, 1)}
    assert [name for name in found if not found[name].passed] == [
        "grid: beta, splines",
        "grid: Q, nodes",
    ]
    assert found["grid: lam, splines"].allowed <= 0.5


def test_creep_nodes_have_less_error_than_equal_steps():
    """Of a material whose onset of full slip falls to a thirtieth at fast speeds."""
    scene = vr.Scene(1000.0, 10.0, 0.3)
    speeds = np.geomspace(1e-4, 100.0, 60)
    nodes = tables.creep_nodes(scene, speeds, 81)
    assert nodes.size == 81
    assert np.array_equal(nodes, -nodes[::-1])
    grid = tables.build(scene, speeds, delta=nodes)
    assert (abs(grid.Q[:, [0, -1]]) == scene.mu).all()
    even = tables.build(scene, speeds, delta=np.linspace(nodes[0], nodes[-1], 81))
    for field in ("Q", "beta"):
        for way in ("spline_error", "linear_error"):
            assert grid[field].attrs[way] < 0.7 * even[field].attrs[way]


@pytest.mark.parametrize(
    "lowest, highest, alpha",
    [(1e-3, 2.0, [7.0, 11.0, 16.0]), (1e-3, 0.05, [11.0]), (1.0, 2.0, [1.0])],
)
def test_splines_slip_where_the_law_slips(lowest, highest, alpha):
    """At slow speeds and for elastic bodies all onsets of full slip coincide: beside too many nodes
    there splines reached beta = 1 beyond them."""
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    speeds = tables.spread(lowest, highest, 41, "log")
    grid = tables.build(
        scene, speeds, delta=tables.creep_nodes(scene, speeds, 41, alpha=alpha), alpha=alpha
    )
    assert grid.beta.attrs["spline_error"] < tol.ONSET_BETA
    assert grid.Q.attrs["spline_error"] < tol.ONSET_Q * scene.mu


def test_creep_nodes_of_a_cover_reach_full_slip_on_both_sides():
    """Of a thin cover full slip begins at delta_0 +- delta_star, farther from 0 than delta_star."""
    thin = COVERED.replace(mu=0.1)
    found = thin.contact(V, delta=0.0)
    assert np.max(abs(found.delta_0) / found.delta_star) > 0.1
    nodes = tables.creep_nodes(thin, V, 41)
    assert thin.contact(V[:, None], delta=nodes[[0, -1]]).full_slip.all()


# --- files ---


two_kinds = pytest.mark.parametrize("name", ["alphas", "cover"], scope="module")


@two_kinds
def test_save_load_identity(table, tmp_path):
    """Texts of attributes have a fixed length, as the C library of netCDF writes them: Octave,
    Fortran and nccopy -k classic read no others; "" too.
    """
    tables.save(table, tmp_path / "t.nc")
    xr.testing.assert_identical(tables.load(tmp_path / "t.nc"), table)
    told = tables.info(tmp_path / "t.nc")
    for words in ("grid, ", "21 nodes in [0.01, 2]", "spline", "linear", "history: "):
        assert words in told
    with h5py.File(tmp_path / "t.nc") as file:
        texts = [
            each.attrs.get_id(key).get_type()
            for each in (file, *file.values())
            for key in each.attrs
        ]
    texts = [kind for kind in texts if isinstance(kind, h5py.h5t.TypeStringID)]
    assert len(texts) > 20
    assert not any(kind.is_variable_str() for kind in texts)


# --- nodes that no contact has ---

FILL = 9.969209968386869e36
#: field, its nodes, what they become, words of the refusal
WRONG = [
    (
        "Q",
        np.s_[7, 5],
        lambda Q: FILL,
        "68386869e+36 N m-1 at index 7 of V, 5 of delta: must be a computed value: this",
    ),
    ("M", np.s_[3], lambda M: -M, "at index 3 of V: must be in [0, "),
    ("M", np.s_[1], lambda M: 1e10, "at index 1 of V: must be in [0, "),
    ("Q", np.s_[4], lambda Q: -Q, "index 4 of V, 0 of delta: must be of the same sign"),
    ("Q", np.s_[6, 32], lambda Q: 1.001 * Q, "index 6 of V, 32 of delta: must be at most "),
]


@pytest.mark.parametrize("field, nodes, change, words", WRONG)
def test_a_node_that_no_contact_has_is_refused_with_its_place(
    field, nodes, change, words, tmp_path
):
    table = built("cylinder").copy(deep=True)
    values = table[field].values
    values[nodes] = change(values[nodes])
    path = tmp_path / "edited.nc"
    other = table[["Q", "M"]]
    other.attrs = {key: table.attrs[key] for key in ("mu", "load", "R")}
    for read, data in ((tables.load, table), (vr.load_law, other)):
        plain = {key: {"_FillValue": None} for key in data.variables}
        data.to_netcdf(path, engine="h5netcdf", encoding=plain)
        refused(partial(read, path), words, error=vr.FileError)


def test_declared_invalid_values_are_refused_and_six_digits_are_read(tmp_path):
    other = built("cylinder")[["Q", "M"]].assign_attrs(mu=0.3, load=1.0, R=1.0)
    other["Q"] = (other.Q / abs(other.Q).max() * 0.3).round(6).assign_attrs(units="N/m")
    path = tmp_path / "other.nc"
    other.to_netcdf(path, engine="h5netcdf")
    assert vr.load_law(path).rows.slips
    for limits in ({"valid_min": 1.0, "valid_max": 2.0}, {"valid_range": [1.0, 2.0]}):
        bounded = other.assign(M=other.M.assign_attrs(limits))
        bounded.to_netcdf(path, engine="h5netcdf")
        refused(partial(vr.load_law, path), "index 0 of V: must be in [1, 2]", error=vr.FileError)
    other.Q[1, 2] = np.nan
    other.to_netcdf(path, engine="h5netcdf", encoding={"Q": {"_FillValue": -7.5}})
    refused(
        partial(vr.load_law, path), "Q = nan N/m at index 1 of V, 2 of delta", error=vr.FileError
    )


# --- formats of other programs ---


@two_kinds
def test_netcdf3_csv_and_matlab_hold_the_same_bits(table, tmp_path):
    tables.export(table, tmp_path / "t.cdf")
    with io.netcdf_file(tmp_path / "t.cdf", mmap=False) as file:
        for key in table.variables:
            assert np.array_equal(file.variables[key][...], table[key])
    tables.export(table, tmp_path / "t.csv")
    axes = table_files.axes_of(table)
    found = np.genfromtxt(tmp_path / "t.csv", delimiter=",", names=True)
    assert {*found.dtype.names} == {*axes, *table_files.fields_of(table)}
    wide = table.to_dataframe(dim_order=axes).reset_index()
    assert all(np.array_equal(found[key], wide[key]) for key in found.dtype.names)
    tables.export(table, tmp_path / "t.mat")
    content = io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]
    assert all(np.array_equal(content[key], table[key]) for key in table.variables)
    assert content["dimensions"]["Q"] == ", ".join(axes)
    assert content["linear_error"]["beta"] == table.beta.attrs["linear_error"]


@pytest.mark.parametrize("name", ["cylinder", "cover"], scope="module")
def test_modelica(table, tmp_path):
    """Of a cover M is over V and delta too."""
    tables.export(table, tmp_path / "t.txt")
    text = (tmp_path / "t.txt").read_text()
    assert text.startswith("#1\n")
    assert f"; units: V: {table.V.attrs['units']}, delta: dimensionless, " in text
    for field in ("Q", "M"):
        exact = np.column_stack([V, table[field].values])
        if "delta" in table[field].dims:
            exact = np.vstack([np.append(0.0, DELTA), exact])
        body = text.partition(f"double {field}({exact.shape[0]},{exact.shape[1]})")[2]
        found = re.sub("#.*", "", body).split()[: exact.size]
        assert np.array_equal(np.array(found, dtype=float), exact.ravel())
        error, at = (table[field].attrs[key] for key in ("linear_error", "linear_error_at"))
        assert f"# error_{field} = {error:.3g} at {at}\n" in text
