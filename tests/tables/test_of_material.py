"""Tables over (V, delta) of one material and of a pair: what they hold, and how they name it."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from places import ROOT
from refusals import refused
from scipy import io

import viscoroll as vr
from viscoroll.config import read_grids
from viscoroll.tables import schema
from viscoroll.tables.of_material import scene_of
from viscoroll.validation.table_check import check_table

RUBBER = vr.Material(3e6, 0.5, vr.Prony([0.4, 1.5, 12.0], [1.0, 1e-3, 1e-6]), T_ref=0.3, name="rubber", density=1100.0)
STEEL = vr.Material.elastic(2e11, 0.3, name="steel")
AXES = {"V": np.geomspace(1e-3, 1e4, 40), "delta": np.linspace(-0.02, 0.03, 51)}


@pytest.fixture(scope="module", params=[None, STEEL, vr.Material.rigid()], ids=["like", "steel", "rigid"])
def grid(request):
    return vr.tables.MaterialGrid(RUBBER, kappa=20.0, mu=0.5, base=request.param, **AXES)


@pytest.fixture(scope="module")
def table(grid):
    return vr.tables.build(grid)


def test_nodes_are_the_law(grid, table):
    scene = vr.Cylinder(R=1.0, m=1.0, mu=0.5, material=RUBBER, base=grid.base).scene().replace(kappa=20.0)
    for i, k in ((0, 0), (7, 20), (20, 25), (39, 50)):
        one = vr.contact(scene, AXES["V"][i], delta=AXES["delta"][k], fields=schema.FIELDS["material"])
        for name in schema.FIELDS["material"]:
            at = table[name].values[i, k] if table[name].ndim == 2 else table[name].values[i]
            assert close(at, getattr(one, name), rel=tol.SERIES_STATES, what=name)
    assert all(check.passed for check in check_table(table, 2000, 1))


def test_saved_and_loaded_with_its_material(grid, table, tmp_path):
    vr.tables.save(table, tmp_path / "t.nc")
    loaded = vr.tables.load(tmp_path / "t.nc")
    xr.testing.assert_identical(loaded.drop_attrs(), table.drop_attrs())
    assert scene_of(loaded) == grid.scene()
    told = vr.tables.info(tmp_path / "t.nc")
    for words in ('name = "rubber"', "material table", "schema 1.1", "M_cylinder"):
        assert words in told
    law = grid.pair.law
    series = law if isinstance(law, vr.Prony) else law.total
    assert np.array_equal(loaded.relaxation_time, series.tau)
    found = vr.tables.interpolate(loaded, V=0.7, delta=0.003)
    exact = vr.contact(grid.scene(), 0.7, delta=0.003)
    assert close(found.Q, exact.Q, rel=1.5 * table.Q.attrs["interpolation_error"], scale=1.0)


def test_exports(table, tmp_path):
    for name, form in (("t.nc", "netcdf3"), ("t.csv", "csv"), ("t.txt", "modelica"), ("t.mat", "matlab")):
        vr.tables.export(table, tmp_path / name, form)
    assert "tau = [1.0, 0.001, 1e-06]" in (tmp_path / "t.txt").read_text()
    content = io.loadmat(tmp_path / "t.mat", simplify_cells=True)["viscoroll"]
    assert np.array_equal(content["Q"], table.Q)
    assert content["material"] == table.attrs["material"]


def test_a_schema_of_before_still_loads(tmp_path):
    literal = vr.tables.build(vr.tables.LiteralGrid(2.91, 0.2, [0.1, 0.2], [0.0, 0.01], [1.0, 11.0]))
    vr.tables.save(literal.assign_attrs(schema_version="1.0"), tmp_path / "t.nc")
    assert vr.tables.load(tmp_path / "t.nc").attrs["schema_version"] == "1.0"


def test_a_table_without_its_material_is_refused(table, tmp_path):
    for text in ("", "[material]\nE = 1.0", "not TOML", 7):
        named = table.assign_attrs(material=text)
        refused(partial(vr.tables.save, named, tmp_path / "t.nc"), "attribute material", error=vr.TableError)


def test_grids_of_the_production_configuration():
    """A rubber fitted to a DMA, and that on steel."""
    grids = read_grids(ROOT / "pipeline/config/production.toml")
    rubber, on_steel = grids["rubber"], grids["rubber-on-steel"]
    assert rubber.material == on_steel.material
    assert (rubber.base, on_steel.base.E) == (None, 2.1e11)
    assert rubber.material.prony.E.size == 4
    assert close(on_steel.scene().material.share, 1.0, rel=1e-4, scale=1.0)


GRID = "kappa = 20.0\nmu = 0.5\nV = [0.1, 0.2]\ndelta = { low = -0.01, high = 0.01, count = 3 }\n"


def test_from_files(tmp_path):
    RUBBER.to_netcdf(tmp_path / "rubber.nc")
    STEEL.to_netcdf(tmp_path / "steel.nc")
    (tmp_path / "both.toml").write_text('[material]\nfile = "rubber.nc"\n[base]\nE = 2e11\nnu = 0.3\n')
    path = tmp_path / "tables.toml"
    for material, base in (
        ('"rubber.nc"', '"steel.nc"'),
        ('"both.toml"', ""),
        ('"rubber.nc"', "{ E = 2e11, nu = 0.3 }"),
    ):
        path.write_text(f"[tables.mine]\nmaterial = {material}\n" + (f"base = {base}\n" if base else "") + GRID)
        mine = read_grids(path)["mine"]
        assert (mine.material, mine.base.E, mine.delta.size) == (RUBBER, 2e11, 3)
    for old, new, words in (
        ("rubber.nc", "none.nc", ["line 2", "none.nc"]),
        ("rubber.nc", "none.csv", ["none.csv"]),
        ("kappa", "kapa", ["line 4", "did you mean 'kappa'?"]),
        ("mu = 0.5", "mu = -0.5", ["[tables.mine]", "mu = -0.5"]),
        ("E = 2e11", "E = -2e11", ["E = -2"]),
        ("material = ", "matrial = ", ["unknown key 'mine'"]),
        ("low = -0.01", "low = 0.02", ["[tables.mine]", "high"]),
    ):
        path.write_text(f'[tables.mine]\nmaterial = "rubber.nc"\nbase = {base}\n{GRID}'.replace(old, new))
        refused(partial(read_grids, path), *words, error=vr.ConfigError)


def test_refused():
    good = {"material": RUBBER, "kappa": 20.0, "mu": 0.5, **AXES}
    for changes, word in (
        ({"kappa": -1.0}, "kappa"),
        ({"V": [0.2, 0.1]}, "V"),
        ({"V": [0.0, 0.1]}, "V"),
        ({"delta": [[0.1]]}, "delta"),
        ({"V": [1e300]}, "kappa |V|"),
        ({"material": STEEL}, "material = elastic"),
        ({"material": 3.0}, "material"),
        ({"material": vr.Material.rigid(), "base": vr.Material.rigid()}, "rigid"),
        ({"V": np.arange(1.0, 1e4), "delta": np.arange(1e4)}, "at most"),
    ):
        refused(partial(vr.tables.MaterialGrid, **good | changes), word)
