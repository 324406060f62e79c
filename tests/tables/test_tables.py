"""Tables: values, stated errors, files that are whole or refused."""

from __future__ import annotations

import json
import os
import runpy
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll import files
from viscoroll.tables import grid as grids
from viscoroll.tables import rehearsal, schema, store
from viscoroll.tables.build import solve_atlas
from viscoroll.tables.content import HASH, content_hash
from viscoroll.tables.content import read as read_content
from viscoroll.tables.survey import survey
from viscoroll.validation.table_check import check_table

ATLAS_GRID = vr.tables.AtlasGrid(nodes=(16, 40, 32), block=(4, 8, 8), allowed=(1e-3, 1e-3))
LITERAL_GRID = vr.tables.LiteralGrid(
    kappa=2.91, mu=0.2, V=np.geomspace(1e-3, 2.0, 21), delta=np.linspace(-0.04, 0.04, 33), alpha=[1.0, 3.0, 11.0]
)


@pytest.fixture(scope="module")
def atlas() -> xr.Dataset:
    return vr.tables.build(ATLAS_GRID)


@pytest.fixture(scope="module")
def literal() -> xr.Dataset:
    return vr.tables.build(LITERAL_GRID)


@pytest.fixture(scope="module", params=["atlas", "literal"])
def table(request: pytest.FixtureRequest) -> xr.Dataset:
    return request.getfixturevalue(request.param)


@pytest.fixture
def saved(literal: xr.Dataset, tmp_path: Path) -> Path:
    path = tmp_path / "table.nc"
    vr.tables.save(literal, path)
    return path


def error_of(path: Path | str) -> str:
    """Text of the error that loading raises: one line that names the file."""
    return refused(partial(vr.tables.load, path), str(path), error=vr.TableError)


# --- coordinates ---


def test_coordinate_maps_are_inverse() -> None:
    for name, values in (
        ("alpha", np.geomspace(1, 1e4, 99)), ("kappa_V", np.geomspace(1e-7, 1e5, 99)), ("s", np.linspace(0, 1, 99)),
    ):  # fmt: skip
        forward, back = grids.ATLAS_MAPS[name]
        assert close(back(forward(values)), values, rel=tol.TABLE_MAP)
        assert (np.diff(forward(values)) > 0).all(), name


def test_s_is_graded_toward_full_slip(atlas: xr.Dataset) -> None:
    steps = np.diff(atlas.s)
    assert atlas.s[0] == 0.0
    assert atlas.s[-1] == 1.0
    assert (np.diff(steps) < 0).all()


def test_axes_end_exactly_where_asked(atlas: xr.Dataset) -> None:
    assert atlas.alpha.values[[0, -1]].tolist() == [1.0, 100.0]
    assert atlas.kappa_V.values[[0, -1]].tolist() == [1e-3, 1e3]


# --- values ---


def test_atlas_nodes_are_the_contact_law(atlas: xr.Dataset) -> None:
    kappa, mu = 29.1, 0.37  # any: the table is for all of them
    alpha, kappa_V, s = (atlas[name].values for name in ("alpha", "kappa_V", "s"))
    scene = vr.Scene(alpha=alpha[:, None, None], kappa=kappa, mu=mu)
    V = (kappa_V / kappa)[:, None]
    delta_star = mu / kappa * atlas.kappa_delta_star_over_mu.values[:, :, None]
    inner = s[:-1]
    law = vr.contact(scene, V, delta=inner * delta_star)
    assert close(atlas.beta.values[..., :-1], law.beta, rel=tol.TABLE_NODE, scale=1.0)
    assert close(atlas.Q_over_mu.values[..., :-1], law.Q / mu, rel=tol.TABLE_NODE, scale=1.0)
    assert close(atlas.lam.values, law.lam[..., 0], rel=tol.TABLE_NODE)
    assert close(atlas.epsilon.values, law.epsilon[..., 0], rel=tol.TABLE_NODE)
    assert close(atlas.kappa_M.values, kappa * law.M[..., 0], rel=tol.TABLE_NODE)
    assert close(delta_star[..., 0], law.delta_star[..., 0], rel=tol.TABLE_NODE)


def test_atlas_edges_are_exact(atlas: xr.Dataset) -> None:
    assert (atlas.beta.sel(s=0.0) == 1.0).all()
    assert (atlas.Q_over_mu.sel(s=0.0) == 0.0).all()
    assert (atlas.beta.sel(s=1.0) == 0.0).all()
    assert (atlas.Q_over_mu.sel(s=1.0) == 1.0).all()


def test_atlas_holds_carter_at_alpha_1(atlas: xr.Dataset) -> None:
    elastic = atlas.sel(alpha=1.0)
    assert (elastic.lam == 1.0).all()
    assert (elastic.epsilon == 0.0).all()
    assert (elastic.kappa_M == 0.0).all()
    assert close(elastic.beta, np.broadcast_to(1 - atlas.s, elastic.beta.shape), rel=tol.TABLE_NODE, scale=1.0)


def test_literal_nodes_are_the_contact_law(literal: xr.Dataset) -> None:
    scene = vr.Scene(alpha=literal.alpha.values, kappa=2.91, mu=0.2)
    law = vr.contact(scene, literal.V.values[:, None, None], delta=literal.delta.values[:, None])
    for name in ("beta", "Q"):
        assert literal[name].dims == ("V", "delta", "alpha")
        np.testing.assert_array_equal(literal[name].values, getattr(law, name))
    for name in ("lam", "epsilon", "M", "delta_star"):
        np.testing.assert_array_equal(literal[name].values, getattr(law, name)[:, 0, :])


def test_literal_nodes_are_the_printed_equations(literal: xr.Dataset) -> None:
    scene = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2)
    V, delta = literal.V.values[:, None], literal.delta.values
    law = vr.contact(scene, V, delta=delta, method="direct", fields=("beta", "Q"))
    for name in ("beta", "Q"):
        assert close(literal[name].sel(alpha=11.0), getattr(law, name), rel=tol.TABLE_NODE, scale=1.0)


@pytest.mark.parametrize("grid", [ATLAS_GRID, LITERAL_GRID], ids=["atlas", "literal"])
def test_two_threads_give_the_bits_of_one(grid: object) -> None:
    one, two = (vr.tables.build(grid, threads=n) for n in (1, 2))
    assert content_hash(one.drop_attrs()) == content_hash(two.drop_attrs())


# --- interpolation and stated errors ---


def test_error_map_holds_off_the_nodes(atlas: xr.Dataset) -> None:
    """An independent random sample stays below the map's entry, block by block."""
    random = np.random.default_rng(7)
    log_alpha, log_kappa_V = random.uniform(0, np.log(100), 3000), random.uniform(np.log(1e-3), np.log(1e3), 3000)
    alpha, kappa_V, s = np.exp(log_alpha), np.exp(log_kappa_V), grids.s_of_u(random.uniform(0, 1, 3000))
    kappa_V = np.clip(kappa_V, 1e-3, 1e3)
    got = vr.tables.interpolate(atlas, ("beta", "Q_over_mu"), alpha=alpha, kappa_V=kappa_V, s=s)
    scene = vr.Scene(alpha=alpha, kappa=1.0, mu=1.0)
    law = vr.contact(scene, kappa_V, delta=s * vr.contact(scene, kappa_V, delta=0.0).delta_star)
    block = tuple(
        np.searchsorted(atlas[f"block_{name}_edge"].values, x, side="right") - 1
        for name, x in (("alpha", alpha), ("kappa_V", kappa_V), ("s", s))
    )
    for name, exact in (("beta", law.beta), ("Q_over_mu", law.Q)):
        error, stated = np.abs(getattr(got, name) - exact), atlas[f"error_{name}"].values
        assert (error <= tol.TABLE_MAP_SLACK * stated[block] + tol.TABLE_NODE).all()
        assert error.max() <= atlas[name].attrs["interpolation_error"] == stated.max()
        # a map of huge numbers would pass as well: it must be of the errors' own size
        assert error.max() > stated.max() / 10


def test_stated_errors_of_plane_fields(atlas: xr.Dataset) -> None:
    axes = {"alpha": np.array([1.7, 23.0, 88.0]), "kappa_V": np.array([0.0123, 0.77, 431.0]), "s": np.array([0.5])}
    exact = solve_atlas(axes)
    names = ("lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu")
    got = vr.tables.interpolate(atlas, names, alpha=axes["alpha"][:, None], kappa_V=axes["kappa_V"])
    for name in names:
        assert np.abs(getattr(got, name) - exact[name]).max() <= atlas[name].attrs["interpolation_error"]


def test_interpolation_returns_the_nodes(table: xr.Dataset) -> None:
    axes = schema.AXES[table.attrs[schema.KIND]]
    points = dict(zip(axes, np.meshgrid(*(table[axis].values for axis in axes), indexing="ij"), strict=True))
    got = vr.tables.interpolate(table, **points)
    for name in schema.FIELDS[table.attrs[schema.KIND]]:
        expected = table[name].broadcast_like(table.beta).transpose(*axes).values
        assert close(getattr(got, name), expected, rel=tol.TABLE_SPLINE_NODE, scale=1.0)


def test_literal_interpolation_keeps_its_stated_error(literal: xr.Dataset) -> None:
    V, delta = (0.5 * (x[1:] + x[:-1]) for x in (literal.V.values, literal.delta.values))
    got = vr.tables.interpolate(literal, V=V[:, None, None], delta=delta[:, None], alpha=literal.alpha.values)
    law = vr.contact(vr.Scene(alpha=literal.alpha.values, kappa=2.91, mu=0.2), V[:, None, None], delta=delta[:, None])
    for name in schema.FIELDS["literal"]:
        error = np.abs(getattr(got, name) - getattr(law, name)).max()
        assert error <= literal[name].attrs["interpolation_error"] + tol.TABLE_NODE
    assert all(check.passed for check in check_table(literal, 2000, 0))


def test_a_coarse_literal_table_states_what_its_validation_finds() -> None:
    """Between -delta and delta the error of Q is odd: none in the middle, which once was all that was looked at."""
    for V in ([0.5], [0.1, 2.0]):
        table = vr.tables.build(vr.tables.LiteralGrid(kappa=3.0, mu=0.2, V=V, delta=[-0.01, 0.01], alpha=[1.0, 11.0]))
        assert table.Q.attrs["interpolation_error"] > 1e-3
        assert [check.name for seed in range(3) for check in check_table(table, 500, seed) if not check.passed] == []


def test_one_alpha_is_enough() -> None:
    table = vr.tables.build(vr.tables.LiteralGrid(kappa=2.91, mu=0.2, V=[0.1, 0.2], delta=[0.0, 0.01], alpha=11.0))
    got = vr.tables.interpolate(table, "Q", V=0.1, delta=0.01, alpha=11.0)
    assert close(got.Q, table.Q.sel(V=0.1, delta=0.01, alpha=11.0).item(), rel=tol.TABLE_SPLINE_NODE, scale=1.0)


def test_scalars_give_scalars_and_arrays_the_same(atlas: xr.Dataset) -> None:
    one = vr.tables.interpolate(atlas, alpha=11.0, kappa_V=0.7, s=0.3)
    many = vr.tables.Interpolant(atlas)(alpha=11.0, kappa_V=[[0.7], [0.8]], s=[0.1, 0.3])
    assert isinstance(one.beta, float)
    assert many.beta.shape == (2, 2)
    assert one.beta == many.beta[0, 1]
    assert one.kappa_M == many.kappa_M[0, 1]


def test_bad_points_are_refused(atlas: xr.Dataset) -> None:
    good = {"alpha": 2.0, "kappa_V": 1.0, "s": 0.5}
    for points, text in (
        ({"alpha": 101.0}, "alpha = 101: must be within the table's range [1, 100]"),
        ({"kappa_V": [0.1, 1e-4]}, "kappa_V = 0.0001: must be within the table's range [0.001, 1000]"),
        ({"s": 1.5}, "s = 1.5: must be within the table's range [0, 1]"),
    ):
        call = partial(vr.tables.interpolate, atlas, **good | points)
        assert refused(call, error=vr.OutOfTableError) == text
    for fields, points, text in (
        ("Q", good, "'Q'"),
        (None, {"alpha": 2.0, "kappa_V": 1.0}, "alpha, kappa_V, s"),
        (None, good | {"V": 1.0}, "alpha, kappa_V, s"),
        (None, good | {"alpha": np.nan}, "alpha = nan"),
        (None, good | {"alpha": [2.0, 3.0], "kappa_V": [1.0, 1.0, 1.0]}, "broadcastable"),
    ):
        refused(partial(vr.tables.interpolate, atlas, fields, **points), text)


def test_only_tables_are_interpolated_and_saved(tmp_path: Path) -> None:
    for thing in (None, xr.Dataset()):
        for call in (
            partial(vr.tables.interpolate, thing, alpha=1.0),
            partial(vr.tables.save, thing, tmp_path / "x.nc"),
        ):
            refused(call, "not a viscoroll table", error=vr.TableError)
    assert not list(tmp_path.iterdir())


# --- grids ---


def test_bad_grids_are_refused() -> None:
    for arguments, *words in (
        ({"alpha": (0.5, 100.0)}, "alpha = 0.5 at row 0: must be finite and >= 1"),
        ({"alpha": (5.0, 5.0)}, "high = 5.0: must be > low = 5"),
        ({"kappa_V": (0.0, 1.0)}, "low = 0.0: must be finite and > 0"),
        ({"kappa_V": (1.0, np.inf)}, "high = inf: must be a finite number"),
        ({"nodes": (3, 8, 8)}, "nodes = ", "integers >= 4"),
        ({"nodes": (8, 8)}, "nodes = ", "3 numbers"),
        ({"nodes": (10**4, 10**4, 10)}, "nodes = ", "at most"),
        ({"block": (0, 1, 1)}, "block = ", "integers >= 1"),
        ({"allowed": (np.nan, 1e-6)}, "allowed = nan"),
    ):
        refused(partial(vr.tables.AtlasGrid, **arguments), *words)
    good = {"kappa": 2.91, "mu": 0.2, "V": [0.1, 0.2], "delta": [0.0, 0.1], "alpha": [11.0]}
    for changes in (
        {"kappa": 0.0}, {"kappa": [1.0, 2.0]}, {"mu": -0.2}, {"V": [0.0, 1.0]}, {"V": [[1.0]]}, {"delta": [0.1, 0.0]},
        {"delta": []}, {"alpha": [0.9]}, {"mu": 1e-200, "kappa": 1e200}, {"kappa": 1e308, "mu": 1e200},
    ):  # fmt: skip
        refused(partial(vr.tables.LiteralGrid, **good | changes), next(iter(changes)))
    refused(partial(vr.tables.build, {"kappa": 2.91}), "AtlasGrid, a LiteralGrid or a MaterialGrid")


# --- what a file says ---


def test_attributes_are_complete(table: xr.Dataset) -> None:
    for name, variable in table.variables.items():
        for key in ("long_name", "units", "symbol", "equation", "reference"):
            assert variable.attrs[key], (name, key)
        assert variable.attrs["units"] == "1"
    for key in ("title", "history", "software", "grid", "tolerances", "comment", "references", "source"):
        assert table.attrs[key], key
    assert table.attrs["Conventions"] == "CF-1.11"
    assert table.attrs["schema_version"] == schema.SCHEMA_VERSION
    assert table.attrs["viscoroll_version"] == vr.__version__


def test_variables_are_those_of_the_schema(table: xr.Dataset) -> None:
    kind = schema.check(table, "built")
    assert set(table.variables) == set(schema.VARIABLES[kind]) | set(schema.AXES[kind])


def test_history_records_the_command(literal: xr.Dataset) -> None:
    told = vr.tables.build(LITERAL_GRID, command="viscoroll tables export --kappa 2.91")
    assert told.attrs["history"].endswith("Z viscoroll tables export --kappa 2.91")
    assert sys.orig_argv[0] in literal.attrs["history"]


def test_save_load_identity(table: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "table.nc"
    vr.tables.save(table, path)
    loaded = vr.tables.load(path)
    assert loaded.attrs.pop(HASH) == content_hash(table)
    xr.testing.assert_identical(loaded, table)
    assert HASH not in table.attrs
    again = tmp_path / "again.nc"
    vr.tables.save(vr.tables.load(path), again)
    xr.testing.assert_identical(vr.tables.load(path), vr.tables.load(again))


def test_every_array_is_checksummed_and_has_no_fill_value(table: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "table.nc"
    vr.tables.save(table, path)
    with h5py.File(path) as file:
        for name in table.variables:
            assert "_FillValue" not in file[name].attrs
            assert file[name].fletcher32 or file[name].shape == ()
    assert os.stat(path).st_mode & 0o777 == 0o666 & ~_umask()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def test_info_tells_what_it_holds(saved: Path) -> None:
    text = vr.tables.info(saved)
    for part in ("literal table", "schema 1.1", "kappa    = 2.91", "3 nodes in [1, 11]", "Q ", "numpy", "pytest"):
        assert part in text, part


# --- files that are refused ---


def test_missing_and_directory(tmp_path: Path, saved: Path) -> None:
    assert "does not exist" in error_of(tmp_path / "none.nc")
    assert "is not a file" in error_of(tmp_path)
    assert "does not exist" in error_of(saved / "below.nc")


def test_not_hdf5(tmp_path: Path) -> None:
    path = tmp_path / "x.nc"
    for content in (b"", b"V,delta\n1,2\n", b"CDF\x01" + bytes(100)):
        path.write_bytes(content)
        assert "is not an HDF5 file: expected a viscoroll table of schema 1.x" in error_of(path)


def test_not_a_table(tmp_path: Path) -> None:
    path = tmp_path / "x.nc"
    with h5py.File(path, "w") as file:
        file["Q"] = np.arange(3.0)
    assert "is not a viscoroll table" in error_of(path)


FOREIGN: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "larger than memory": (
        lambda file: file.create_dataset("bomb", shape=(10**6, 10**6), dtype="f8", chunks=(1000, 1000)),
        "its arrays claim 80000000",
    ),
    "larger than the file can hold": (
        lambda file: file.create_dataset("bomb", shape=(10**8,), dtype="f8"), "its arrays claim",
    ),
    "chunk too large": (
        lambda file: file.create_dataset("bomb", (1 << 24,), "f8", chunks=(1 << 24,), compression=9), "in chunks of",
    ),
    "unknown filter": (
        lambda file: file.create_dataset("bomb", (100,), "f8", chunks=(100,), compression="lzf"), "an unknown filter",
    ),
    "stored elsewhere": (
        lambda file: file.create_dataset("bomb", (9,), "f8", external="/etc/hostname"), "is stored in other files",
    ),
    "virtual": (
        lambda file: file.create_virtual_dataset("bomb", h5py.VirtualLayout((9,), "f8")), "is stored in other files",
    ),
    "link out of the file": (
        lambda file: file.__setitem__("bomb", h5py.ExternalLink("/etc/hostname", "x")), "is a link",
    ),
    "link to nowhere": (lambda file: file.__setitem__("bomb", h5py.SoftLink("/nowhere")), "is a link"),
    "group": (lambda file: file.create_group("bomb"), "is not an array"),
    "text": (lambda file: file.__setitem__("bomb", "text"), "is of type object"),
    "large attribute": (
        lambda file: file["Q"].attrs.create("a", np.zeros(8000)), "attribute 'a' of Q is larger than",
    ),
    "many attributes": (
        lambda file: [file["Q"].attrs.create(f"a{n}", n) for n in range(120)], "attributes, more than 100",
    ),
    "many variables": (
        lambda file: [file.create_dataset(f"a{n}", (), "f8") for n in range(120)], "variables, more than 100",
    ),
}  # fmt: skip


def test_what_is_no_table_is_refused_before_an_array_is_read(saved: Path) -> None:
    content = saved.read_bytes()
    for change, text in FOREIGN.values():
        saved.write_bytes(content)
        with h5py.File(saved, "a") as file:
            change(file)
        refused(partial(survey, saved.read_bytes(), saved), text, error=vr.TableError)


def test_what_the_rehearsal_finds_is_told(saved: Path) -> None:
    with h5py.File(saved, "a") as file:
        file.create_group("bomb")
    assert "variable 'bomb' is not an array" in error_of(saved)


@pytest.mark.parametrize(
    ("mishap", "text"),
    [
        ("import os; os.kill(os.getpid(), 11)", "exit code -11"),
        ("while True: pass", "exit code -24"),
        ("bytes(1 << 34)", "MemoryError"),
        ("raise RecursionError('deep')", "RecursionError: deep"),
    ],
    ids=["crash", "endless", "memory", "error"],
)
def test_a_mishap_of_the_library_harms_nobody(
    saved: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, mishap: str, text: str
) -> None:
    """A reader that does what damaged files have made libraries do, in the process of its own."""
    child = f"""
from viscoroll.tables import rehearsal
def read(*arguments):
    {mishap}
rehearsal.read = read
rehearsal._SECONDS = 0.1
rehearsal.main()
"""
    monkeypatch.setattr(rehearsal, "_CHILD", child)
    with pytest.raises(vr.TableError, match=text):
        rehearsal.rehearse(saved.read_bytes(), saved, verify=True)


def test_truncated(saved: Path) -> None:
    content = saved.read_bytes()
    for share in (0.001, 0.1, 0.5, 0.9, 0.99):
        saved.write_bytes(content[: int(share * len(content))])
        text = error_of(saved)
        assert "damaged" in text or "is not an HDF5 file" in text, share


def test_a_file_without_its_seal_is_read_with_care(saved: Path, literal: xr.Dataset) -> None:
    """As another program writes it: its content decides."""
    content = saved.read_bytes()
    saved.write_bytes(content[: content.rindex(b"\n", 0, -1)])
    assert content_hash(vr.tables.load(saved)) == content_hash(literal)


def test_a_rewrite_by_another_program_is_verified(saved: Path, literal: xr.Dataset) -> None:
    """Texts as arrays of one text, as netCDF-C writes them, other chunks, no filters: the same content."""
    with h5py.File(saved, "a") as file:
        for key in ("schema_version", schema.KIND, "title"):
            file.attrs[key] = np.array([file.attrs[key]], dtype=h5py.string_dtype())
        values, attributes = file["M"][...], dict(file["M"].attrs)
        del file["M"]
        copy = file.create_dataset("M", data=values, chunks=(3, 1))
        for key, value in attributes.items():
            copy.attrs[key] = value
        for n, axis in enumerate(("V", "alpha")):
            copy.dims[n].attach_scale(file[axis])
    assert content_hash(vr.tables.load(saved)) == content_hash(literal)


def test_damage_is_found_before_a_library_parses_it(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    content = bytearray(saved.read_bytes())
    content[len(content) // 2] ^= 1
    saved.write_bytes(content)
    for name in ("read", "rehearse"):
        monkeypatch.setattr(store, name, None)
    assert "its bytes differ from the SHA-256 at their end" in error_of(saved)


def test_a_seal_is_no_obstacle_to_other_programs(saved: Path, literal: xr.Dataset) -> None:
    """They read the file as ever, and one that edits it leaves no seal that would no longer hold."""
    with h5py.File(saved) as file:
        np.testing.assert_array_equal(file["Q"], literal.Q)
    with xr.open_dataset(saved, engine="h5netcdf") as found:
        np.testing.assert_array_equal(found.Q, literal.Q)
    assert files.seal_holds(saved.read_bytes())
    with h5py.File(saved, "a") as file:
        file.attrs["history"] = "edited"
    assert files.seal_holds(saved.read_bytes()) is None


def test_bit_flips_are_never_silent(saved: Path, literal: xr.Dataset) -> None:
    """A flipped bit is refused, or lies where it changes nothing."""
    content = saved.read_bytes()
    expected, refused = content_hash(literal), {"sealed": 0, "without": 0}
    for position in np.random.default_rng(3).integers(0, len(content) * 8, 40):
        damaged = bytearray(content)
        damaged[position // 8] ^= 1 << (position % 8)
        saved.write_bytes(damaged)
        bare = partial(read_content, bytes(damaged), saved, verify=True)
        for way, read in (("sealed", partial(vr.tables.load, saved)), ("without", bare)):
            try:
                assert content_hash(read()) == expected
            except vr.TableError:
                refused[way] += 1
    # without the seal, some 20: the others lie in what HDF5 leaves unused, more or less with the length of the texts
    assert refused["sealed"] == 40
    assert refused["without"] >= 10


def test_edited_content_is_refused_unless_asked(saved: Path) -> None:
    with h5py.File(saved, "a") as file:
        file["M"].attrs["long_name"] = "something else"
    assert "content differs from its content_sha256" in error_of(saved)
    assert vr.tables.load(saved, verify=False).M.attrs["long_name"] == "something else"


def test_other_schema_versions_are_refused(saved: Path) -> None:
    for version in ("2.0", "0.9", "", 7, None):
        with h5py.File(saved, "a") as file:
            file.attrs.pop("schema_version", None)
            if version is not None:
                file.attrs["schema_version"] = version
        assert "reads 1.x; rebuild the table" in error_of(saved), version


def test_missing_variables_are_named(literal: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(vr.TableError, match="variable 'beta' is missing"):
        vr.tables.save(literal.drop_vars("beta"), tmp_path / "x.nc")
    with pytest.raises(vr.TableError, match="finite"):
        vr.tables.save(literal.assign(Q=literal.Q * np.nan), tmp_path / "x.nc")
    assert not list(tmp_path.iterdir())


# --- targets that cannot be written ---


def test_unwritable_targets(literal: xr.Dataset, tmp_path: Path) -> None:
    occupied = tmp_path / "file"
    occupied.write_text("keep")
    for target in (occupied / "table.nc", tmp_path, tmp_path / "none" / "table.nc"):
        with pytest.raises(vr.OutputError, match="cannot be written") as caught:
            vr.tables.save(literal, target)
        assert str(target) in str(caught.value)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert occupied.read_text() == "keep"


def test_save_replaces_and_leaves_nothing_behind(literal: xr.Dataset, saved: Path) -> None:
    vr.tables.save(literal, saved)
    assert list(saved.parent.iterdir()) == [saved]


def test_a_symbolic_link_is_followed(literal: xr.Dataset, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    link, target = tmp_path / "link.nc", tmp_path / "real" / "table.nc"
    link.symlink_to(target)
    vr.tables.save(literal, link)
    assert link.is_symlink()
    assert target.is_file()
    vr.tables.load(link)


# --- pipeline/demo/tabulate.py ---

CONFIG = """
[tables.atlas]
alpha = [1.0, 100.0]
kappa_V = [1e-3, 1e3]
nodes = [8, 12, 8]
allowed = [{allowed}, 1.0]
[tables.paper]
kappa = 2.91
mu = 0.2
V = {{ low = 1e-3, high = 2.0, count = 5, spacing = "log" }}
delta = {{ low = -0.04, high = 0.04, count = 5 }}
alpha = [1.0, 11.0]
"""


def tabulate(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, config: str) -> int:
    (tmp_path / "run.toml").write_text(config)
    folders = ["--tables", str(tmp_path / "out"), "-o", str(tmp_path / "run")]
    monkeypatch.setattr(sys, "argv", ["tabulate", "--config", str(tmp_path / "run.toml"), *folders])
    with pytest.raises(SystemExit) as exit_:
        runpy.run_module("pipeline.demo.tabulate", run_name="__main__", alter_sys=True)
    return int(exit_.value.code or 0)


def test_tabulate_writes_both_tables(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert tabulate(monkeypatch, tmp_path, CONFIG.format(allowed=1.0)) == 0
    assert vr.tables.load(tmp_path / "out/atlas.nc").sizes["alpha"] == 8
    assert vr.tables.load(tmp_path / "out/paper.nc").sizes["delta"] == 5
    record = json.loads((tmp_path / "run/stages/tabulate.json").read_text(encoding="utf-8"))
    assert not record["failed"]
    assert "atlas: size, MB" in record["headline"]


def test_tabulate_fails_where_an_error_is_too_large(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    assert tabulate(monkeypatch, tmp_path, CONFIG.format(allowed=1e-9)) == 1
    assert "Q_over_mu (allowed 1e-09)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("old", "new"), [("kappa_V", "kapa_V"), ("tables.paper", "tables.papre"), ("spacing", "spacnig"), ("= 2.91", "=")]
)
def test_tabulate_refuses_bad_configurations(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture, old: str, new: str
) -> None:
    assert tabulate(monkeypatch, tmp_path, CONFIG.format(allowed=1.0).replace(old, new)) == 2
    assert "run.toml" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
