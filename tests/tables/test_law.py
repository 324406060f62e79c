"""Laws as files: the bits of their material, wherever a material stands, and damage that is
told.
"""

import ctypes
import json
import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from pathlib import Path

import c_code
import h5py
import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close

import viscoroll as vr
from viscoroll import tables
from viscoroll.core import files
from viscoroll.laws.law_netcdf import law_table_of
from viscoroll.laws.law_tables import LawTable, law_axis, law_table
from viscoroll.laws.row_layout import AXIS_FUNCTIONS, FUNCTIONS
from viscoroll.materials.checked_netcdf import checksum
from viscoroll.presets import read_law_source, read_roller
from viscoroll.tables.law_dataset import check_table

SERIES = vr.Prony([0.4, 1.5, 12.0], [1.0, 1e-3, 1e-6])
RUBBER = vr.Material(3e6, 0.5, SERIES, T_ref=0.3, name='a "rubber" é', density=1100.0)
STEEL = vr.Material.elastic(2e11, 0.3, name="steel")
BODIES = vr.Bodies(vr.Prony([10.0], [1.0]), SERIES, 0.3, (0.3, 0.45))
GIVEN = {
    "alpha": (11.0,),
    "elastic": (1.0,),
    "bodies": (BODIES,),
    "material": (RUBBER,),
    "on steel": (RUBBER, STEEL),
    "on a rigid base": (RUBBER, vr.Material.rigid()),
    "pair": (vr.presets.RUBBER_CYLINDER.replace(base=STEEL, plane="stress").pair,),
}
V = np.geomspace(1e-9, 1e9, 50)
DELTA = np.linspace(-0.1, 0.1, 7)[:, None]


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("law") / "rubber.nc"
    tables.save(tables.law(RUBBER), path)
    return path


def same(one, other):
    for field in fields(LawTable):
        name = field.name.removeprefix("steady_")
        np.testing.assert_equal(getattr(one, name), getattr(other, name), name)


# --- what a file holds ---


@pytest.mark.parametrize("name", GIVEN)
def test_a_file_has_the_bits_of_its_material(tmp_path, name):
    """Of covers: ``test_covers.py``."""
    table = law_table_of(*GIVEN[name])
    law = tables.law(*GIVEN[name])
    tables.save(law, tmp_path / "law.nc")
    xr.testing.assert_identical(tables.load(tmp_path / "law.nc"), law)
    loaded = vr.load_law(tmp_path / "law.nc")
    same(loaded, table)
    assert not loaded.coefficients.flags.writeable
    one = vr.Scene(kappa=20.0, mu=0.3, coupled=False, material=loaded)
    other = one.replace(material=table)
    assert one == other
    assert hash(one) == hash(other)
    states = (scene.contact(V, delta=DELTA, slopes=True).as_dict() for scene in (one, other))
    np.testing.assert_equal(*states)


@pytest.mark.parametrize(
    "given, functions, place",
    [
        ({"material": 11.0}, FUNCTIONS, (10, 0)),
        ({"material": BODIES}, FUNCTIONS, (10, 0)),
        ({"alpha": (3.0, 5.0)}, AXIS_FUNCTIONS, (1, 0, 8, 0)),
    ],
)
def test_stated_errors_are_those_of_other_places_and_wrong_numbers_are_found(
    given, functions, place
):
    law = tables.law(**given).copy(deep=True)
    stated = [law[function].attrs["largest_relative_error"] for function in functions]
    assert max(stated) < tol.LAW_STATED
    assert all(check.passed for check in check_table(law, 3000, 1))
    for function in functions:
        law[function].values[place] *= 1.0 + tol.CLI_WRONG
    failed = [check.name for check in check_table(law, 3000, 1) if not check.passed]
    assert [name.rpartition(": ")[2] for name in failed] == [*functions]


def test_one_alpha_of_a_file_of_every_alpha(tmp_path):
    saved = tmp_path / "law.nc"
    tables.save(tables.law(alpha=(1, 3.0)), saved)
    assert "alpha = 1 to 4" in tables.info(saved)
    loaded = vr.load_law(saved, alpha=1.5)
    assert np.array_equal(loaded.coefficients, law_axis(1.0, 3.0).at(1.5).coefficients)
    scene = vr.Scene(kappa=20.0, mu=0.3, material=loaded)
    own = vr.Scene(1.5, 20.0, 0.3)
    assert scene == own
    exact = own.contact(V, delta=DELTA)
    for name, value in scene.contact(V, delta=DELTA).as_dict().items():
        size = 1.0 if name in ("beta", "Q", "epsilon", "M") else 0.0
        assert close(value, exact[name], tol.AXIS_LAW, scale=size)
    assert vr.load_law(saved, alpha=4.0).alpha == 4.0


# --- wherever a material stands ---


def test_a_table_is_made_once_and_shared():
    with ThreadPoolExecutor(4) as pool:
        made = [*pool.map(law_table, [vr.Prony([1.5, 0.25], [1.0, 0.125])] * 4)]
    first = made[0]
    assert all(table is first for table in made)
    assert law_table(first) is first
    assert law_table(vr.Bodies(SERIES, SERIES)) is law_table(SERIES)
    for values in (first.coefficients, first.fast_limit, first.record.rows):
        assert not values.flags.writeable


@pytest.mark.parametrize("name", ["on steel", "pair"])
def test_a_cylinder_of_a_law(tmp_path, name):
    tables.save(tables.law(*GIVEN[name]), tmp_path / "law.nc")
    law = vr.load_law(tmp_path / "law.nc")
    pair = law_table_of(*GIVEN[name]).pair
    by_law = vr.Cylinder(R=0.1, m=30.0, mu=0.3, material=law, plane=pair.plane, coupled=False)
    own = by_law.replace(material=pair.cylinder, base=pair.base)
    assert by_law.scene() == own.scene()
    assert (by_law.T_ref, by_law.E_prime, by_law.l0) == (own.T_ref, own.E_prime, own.l0)
    assert by_law.replace(mu=0.2).scene().table is law


def test_scene_files_and_material_files(saved, tmp_path):
    (tmp_path / "rubber.nc").write_bytes(saved.read_bytes())
    cylinder = "[cylinder]\nR = 0.1\nm = 30.0\nmu = 0.3\n"
    path = tmp_path / "scene.toml"
    path.write_text(f'[material]\nfile = "rubber.nc"\n{cylinder}')
    assert read_roller(path).material == RUBBER
    assert read_law_source(path).pair == law_table_of(RUBBER).pair


# --- other writers; what is refused of their files: test_refused_files.py ---


def test_rewritten_by_another_program(saved, tmp_path):
    """Another frame, the same numbers; texts as arrays of one text are not what netCDF's own
    programs write, but texts in UTF-8 that do not state it are.
    """
    copy = tmp_path / "copy.nc"
    with xr.open_dataset(saved, engine="h5netcdf", decode_times=False) as file:
        file.to_netcdf(copy, engine="h5netcdf")
    assert files.seal_matches(copy.read_bytes()) is None
    same(vr.load_law(copy), vr.load_law(saved))
    with h5py.File(copy, "a") as file:
        file.attrs["title"] = np.bytes_("é".encode())
    assert tables.load(copy).title == "é"


# --- other formats ---


def test_json_has_the_same_bits(saved, tmp_path):
    law = tables.load(saved)
    tables.export(law, tmp_path / "rubber.json")
    found = json.loads((tmp_path / "rubber.json").read_text())
    assert found["law_schema"] == 1
    numbers = {name: np.array(found[name]) for name in law.variables}
    assert all(np.array_equal(numbers[name], law[name]) for name in numbers)
    assert checksum(numbers) == found["sha256_of_numbers"]


#: evaluates the header beside full slip, where the stick zone is a rounding of the contact; that
#: of motions needs no other header
C_EDGE = """#include "rubber.h"
#include "vr_roll.h"
void edge(double kappa, double mu, double V, double slip, double *out) {
  vr_state s; vr_slopes d;
  vr_contact_slopes(&rubber, kappa, mu, V, slip, &s, &d);
  out[0] = s.beta, out[1] = s.Q, out[2] = d.dQ_domega;
}
"""


@c_code.needs_cc
def test_the_header_beside_full_slip_at_the_largest_speeds(tmp_path):
    scene = vr.Scene(material=SERIES, kappa=10.0, mu=0.3)
    tables.export(tables.law(SERIES), tmp_path / "rubber.h")
    shutil.copy(Path(tables.__file__).parent / "c/vr_roll.h", tmp_path)
    edge = c_code.compiled(tmp_path, "edge", C_EDGE).edge
    out = np.empty(3)
    for V in (1e293, 1e296, 1e298):
        star = float(scene.contact(V, delta=0.0).delta_star)
        for ulps in (1, 2, 5):
            slip = V * star * (1.0 - ulps * 2.0**-53)
            edge(*map(ctypes.c_double, (10.0, 0.3, V, slip)), ctypes.c_void_p(out.ctypes.data))
            assert np.isfinite(out).all()
            assert close(out[1], 0.3, tol.FULL_SLIP_EDGE)
