"""Tables in other formats: the same bits, read by something else, and errors as stated."""

from __future__ import annotations

import csv
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from numpy.typing import NDArray
from refusals import refused
from scipy import io

import viscoroll as vr
from viscoroll.tables import schema
from viscoroll.tables.accuracy import linear_errors

LITERAL = vr.tables.LiteralGrid(
    kappa=2.91, mu=0.2, V=np.geomspace(0.01, 2.0, 21), delta=np.linspace(-0.04, 0.04, 33), alpha=[1.0, 3.0, 11.0]
)


@pytest.fixture(scope="module")
def literal() -> xr.Dataset:
    return vr.tables.build(LITERAL)


@pytest.fixture(params=["literal", "small_atlas"])
def table(request: pytest.FixtureRequest) -> xr.Dataset:
    return request.getfixturevalue(request.param)


def read_modelica(path: Path) -> tuple[dict[str, float], dict[str, NDArray]]:
    """Stated errors and matrices of a table text, read as Modelica's standard tables do: "#" starts a comment."""
    text = path.read_text()
    assert text.startswith("#1\n")
    errors = {name: float(value) for name, value in re.findall(r"^# error_(\w+) = (\S+)$", text, re.MULTILINE)}
    words = re.sub("#.*", "", text).split()
    matrices: dict[str, NDArray] = {}
    while words:
        kind, head, *words = words
        name, rows, columns = re.fullmatch(r"(\w+)\((\d+),(\d+)\)", head).groups()
        assert kind == "double"
        size = int(rows) * int(columns)
        matrices[name] = np.array(words[:size], dtype=float).reshape(int(rows), int(columns))
        words = words[size:]
    return errors, matrices


def linear_segments(nodes: NDArray, values: NDArray, x: NDArray) -> NDArray:
    """Along the first axis of ``values``, which may depend on the point in the second."""
    cell = np.clip(np.searchsorted(nodes, x) - 1, 0, nodes.size - 2)
    share = (x - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
    points = np.arange(x.size)
    lower, upper = (values[row] if values.ndim == 1 else values[row, points] for row in (cell, cell + 1))
    return (1.0 - share) * lower + share * upper


def test_netcdf3_holds_the_same_bits(table, tmp_path):
    vr.tables.export(table, tmp_path / "t.nc", "netcdf3")
    with io.netcdf_file(tmp_path / "t.nc", mmap=False) as file:
        assert file.version_byte == 2
        assert file.title.decode() == table.attrs["title"]
        assert set(file.variables) == set(table.variables)
        for name, variable in table.variables.items():
            assert file.variables[name].dimensions == variable.dims
            assert np.array_equal(file.variables[name][...], variable.values)
            assert file.variables[name].units == b"1"


def test_csv_holds_the_same_bits(table, tmp_path):
    vr.tables.export(table, tmp_path / "t.csv", "csv")
    kind = table.attrs[schema.KIND]
    with (tmp_path / "t.csv").open(newline="") as file:
        names, *rows = csv.reader(file)
    columns = dict(zip(names, np.array(rows, dtype=float).T, strict=True))
    expected = table[list(schema.FIELDS[kind])]
    for name in (*expected.data_vars, *expected.coords):
        wide = expected[name].broadcast_like(expected).transpose(*schema.AXES[kind])
        assert np.array_equal(columns[name], wide.values.ravel()), name


def test_netcdf4_at_one_alpha_is_a_table(literal, tmp_path):
    vr.tables.export(literal, tmp_path / "t.nc", alpha=3.0)
    part = vr.tables.load(tmp_path / "t.nc")
    assert part["alpha"].values.tolist() == [3.0]
    assert np.array_equal(part["Q"].values[..., 0], literal["Q"].values[..., 1])
    assert "only alpha = 3" in part.attrs["grid"]
    assert vr.tables.interpolate(part, "M", V=0.5, alpha=3.0).M > 0.0


def test_modelica_text_and_its_interpolant(literal, tmp_path):
    vr.tables.export(literal, tmp_path / "t.txt", "modelica", alpha=11.0)
    errors, matrices = read_modelica(tmp_path / "t.txt")
    Q, M = matrices["Q"], matrices["M"]
    assert np.array_equal(Q[1:, 1:], literal["Q"].values[..., 2])
    assert np.array_equal(M, np.column_stack([literal["V"].values, literal["M"].values[:, 2]]))
    assert np.array_equal(Q[1:, 0], literal["V"].values)
    assert np.array_equal(Q[0, 1:], literal["delta"].values)
    random, count = np.random.default_rng(5), 100_000
    V, delta = random.uniform(0.01, 2.0, count), random.uniform(-0.04, 0.04, count)
    exact = vr.contact(vr.Scene(11.0, 2.91, 0.2), V, delta=delta, fields=("Q", "M"))
    along_V = np.stack([linear_segments(Q[1:, 0], column, V) for column in Q[1:, 1:].T])
    found = {"Q": linear_segments(Q[0, 1:], along_V, delta), "M": linear_segments(M[:, 0], M[:, 1], V)}
    for name, values in found.items():
        error = np.abs(values - getattr(exact, name)).max()
        assert errors[name] * tol.EXPORT_FEW_POINTS <= error <= errors[name] * tol.EXPORT_SAMPLES, name


def test_matlab_struct_and_its_errors(table, tmp_path):
    vr.tables.export(table, tmp_path / "t.mat", "matlab")
    content = io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]
    kind = table.attrs[schema.KIND]
    for name in (*schema.AXES[kind], *schema.FIELDS[kind]):
        assert np.array_equal(content[name], table[name].values)
    assert content["dimensions"][schema.FIELDS[kind][0]] == ", ".join(schema.AXES[kind])
    # xarray's own linear interpolation, at points of another seed
    random, count = np.random.default_rng(6), 20_000
    points = {name: xr.DataArray(random.uniform(table[name][0], table[name][-1], count)) for name in schema.AXES[kind]}
    beta = table["beta"].interp(points).values
    if kind == "literal":
        scene = vr.Scene(points["alpha"].values, 2.91, 0.2)
        exact = vr.contact(scene, points["V"].values, delta=points["delta"].values).beta
    else:
        scene = vr.Scene(points["alpha"].values, 1.0, 1.0)
        delta = points["s"].values * vr.contact(scene, points["kappa_V"].values, delta=0.0).delta_star
        exact = vr.contact(scene, points["kappa_V"].values, delta=delta).beta
    error = np.abs(beta - exact).max()
    assert error <= content["linear_error"]["beta"] * tol.EXPORT_SAMPLES
    assert error >= content["linear_error"]["beta"] * tol.EXPORT_FEW_POINTS


def test_matlab_at_one_alpha_has_two_axes(literal, tmp_path):
    vr.tables.export(literal, tmp_path / "t.mat", "matlab", alpha=11)
    content = io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]
    assert (content["alpha"], content["kappa"], content["mu"]) == (11.0, 2.91, 0.2)
    assert content["Q"].shape == (21, 33)
    assert (content["dimensions"]["Q"], content["dimensions"]["M"]) == ("V, delta", "V")


def test_error_between_the_alphas_is_told_apart(literal, tmp_path):
    vr.tables.export(literal, tmp_path / "t.mat", "matlab")
    content = io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]
    stated = {name: literal[name].attrs["interpolation_error"] for name in schema.FIELDS["literal"]}
    for name, at_alpha in content["linear_error_at_alpha"].items():
        assert at_alpha < content["linear_error"][name]
        assert close(at_alpha, stated[name], rel=tol.EXPORT_STATED)


def test_linear_error_of_a_table_with_one_node():
    table = vr.tables.build(vr.tables.LiteralGrid(2.91, 0.2, [0.5], [0.01], [11.0]))
    assert max(linear_errors(table).values()) <= tol.EXPORT_NODE


def test_refused(literal, small_atlas, tmp_path):
    empty, one_of = "alpha = an array of shape (0,): must be one alpha or a vector", "must be one that the table holds"
    for table, name, options, words in (
        (
            literal,
            "t.nc",
            {"format": "excel"},
            "format: 'excel' is not a format; choose from netcdf4, netcdf3, csv, modelica, matlab",
        ),
        (literal, "t.txt", {"format": "matlab"}, "a name that ends in .mat for format matlab"),
        (literal, "t.nc", {"alpha": 5.0}, f"alpha = 5: {one_of}: 1, 3, 11"),
        (literal, "t.nc", {"alpha": [1.0, 3.1]}, f"alpha = 3.1: {one_of}"),
        (literal, "t.nc", {"alpha": np.nan}, "alpha"),
        (literal, "t.csv", {"format": "csv", "alpha": []}, empty),
        (literal, "t.txt", {"format": "modelica", "alpha": []}, empty),
        (literal, "t.mat", {"format": "matlab", "alpha": []}, empty),
        (literal, "t.nc", {"alpha": [[1.0, 3.0]]}, "alpha = an array of shape (1, 2)"),
        (literal, "t.txt", {"format": "modelica"}, "alpha = 1, 3, 11: must be one of these alone"),
        (small_atlas, "t.nc", {"alpha": 3.0}, "exported whole"),
        (small_atlas, "t.txt", {"format": "modelica"}, "two inputs"),
    ):
        refused(partial(vr.tables.export, table, tmp_path / name, **options), words)
        assert not list(tmp_path.iterdir())


def test_failed_write_leaves_what_was_there(literal, tmp_path):
    for name, format in (("t.nc", "netcdf3"), ("t.csv", "csv"), ("t.txt", "modelica"), ("t.mat", "matlab")):
        (tmp_path / name).mkdir()
        for path, words in ((tmp_path / "missing" / name, "cannot be written"), (tmp_path / name, "directory")):
            call = partial(vr.tables.export, literal, path, format, alpha=11.0)
            refused(call, words, error=vr.OutputError)
        assert list(tmp_path.rglob("*")) == [tmp_path / name]
        (tmp_path / name).rmdir()
