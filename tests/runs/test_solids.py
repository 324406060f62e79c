"""Materials of a run of which strengths, times and moduli are uncertain."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from places import ROOT
from refusals import refused

import viscoroll as vr
from viscoroll.runs import export_netcdf, read_run, run_ensemble, verify
from viscoroll.runs.evaluate import roll_block, scene_of
from viscoroll.runs.inputs.units import attributes
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.store import columns_of

EXAMPLE = (ROOT / "docs/examples/rubber-sensitivity.toml").read_text(encoding="utf-8").replace("20_000", "60")
SCENE = """
[scene]
prony = { E = [0.5, { distribution = "uniform", loc = 1.0, scale = 2.0 }], tau = [1.0, 1e-2] }
kappa = 10.0
mu = 0.3
gamma = 4.0
[start]
V0 = 1.0
omega0 = { distribution = "uniform", loc = 0.0, scale = 0.5 }
[correlation]
E_2.omega0 = 0.5
[run]
n = 50
t = [0.5, 2.0]
keep = "all"
block = 20
"""
CREEP = SCENE.replace("[0.5, { ", "[0.2, { ").replace("E = [", "J = [").replace("tau =", "T =").replace(
    "prony", "creep"
).replace("loc = 1.0, scale = 2.0", "loc = 0.3, scale = 0.2").replace("E_2", "J_2")  # fmt: skip


@pytest.fixture
def read(tmp_path):
    def from_text(text: str) -> object:
        path = tmp_path / "run.toml"
        path.write_text(text, encoding="utf-8")
        return read_run(path)

    return from_text


def test_a_cylinder_of_uncertain_rubber(read):
    """Every motion is that of the cylinder with its own modulus and series, over seconds."""
    run = read(EXAMPLE.replace("rtol =", 'keep = "all"\nrtol ='))
    assert run.inputs.uncertain == ("mu", "V0", "E_1", "E_2", "tau_1", "E")
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    for i in (0, 31, 59):
        prony = vr.Prony([values["E_1"][i], values["E_2"][i], 1.5], [values["tau_1"][i], 1e-3, 1e-5])
        material = vr.Material(values["E"][i], 0.5, prony)
        cylinder = vr.Cylinder(R=0.1, m=35.5, mu=values["mu"][i], material=material)
        one = vr.roll(cylinder.scene(), cylinder.V_from_si(values["V0"][i]), 0.0, run.t, run.settings.rtol)
        for name, value in (("V", cylinder.V_to_si(one.V)), ("x", cylinder.x_to_si(one.x))):
            assert close(columns[name][i], value, rel=tol.SI_SERIES_RTOL)


@pytest.mark.parametrize("text", [SCENE, CREEP])
def test_a_scene_of_uncertain_strengths(read, text):
    run = read(text)
    values, motions = roll_block(run, 0)
    scene = scene_of(values)
    assert scene.shape == (20,)
    for i in (0, 7, 19):
        strengths, times = scene.material.given[0][i], [1.0, 1e-2]
        made = vr.Prony.creep(strengths, times) if "creep" in text else vr.Prony(strengths, times)
        one = vr.roll(vr.Scene(material=made, kappa=10.0, mu=0.3, gamma=4.0), 1.0, values["omega0"][i], run.t)
        assert close(motions.V[i], one.V, rel=tol.MOTION_EACH)


def test_a_certain_series_has_one_scene(read):
    """And its ensemble is that of the scene, by its flow map where there are many."""
    text = SCENE.replace('{ distribution = "uniform", loc = 1.0, scale = 2.0 }', "2.0")
    run = read(
        text.replace("[correlation]\nE_2.omega0 = 0.5\n", "").replace("n = 50", "n = 5000").replace("block = 20", "")
    )
    assert (run.one_scene, run.method) == (True, "flow")
    assert scene_of(run.inputs.fixed).material == vr.Prony([0.5, 2.0], [1.0, 1e-2])
    roller = read('preset = "rubber-roller"\n[start]\nV0 = 1.0\nomega0 = 0.0\n[run]\nn = 3\nt = 1.0')
    assert scene_of(roller.inputs.fixed) == vr.RUBBER_ROLLER
    slower = read('preset = "rubber-roller"\n[scene]\nalpha = 3.0\n[start]\nV0 = 1\nomega0 = 0\n[run]\nn = 3\nt = 1.0')
    assert scene_of(slower.inputs.fixed) == vr.RUBBER_ROLLER.replace(alpha=3.0)
    preset = read(text.replace("[scene]", 'preset = "paper-section-5"\n[scene]').replace("E_2.omega0 = 0.5", ""))
    assert scene_of(preset.inputs.fixed).material == vr.Prony([0.5, 2.0], [1.0, 1e-2])


def test_the_digest_follows_the_material(read):
    digest = read(SCENE).digest
    assert read("# told\n" + SCENE).digest == digest
    for old, new in (("0.5, {", "0.6, {"), ("1e-2", "2e-2"), ("scale = 2.0", "scale = 2.1")):
        assert read(SCENE.replace(old, new)).digest != digest
    assert read(EXAMPLE).digest != read(EXAMPLE.replace("1.5,", "1.6,")).digest


def test_a_material_of_a_file(read, tmp_path):
    """The run is another one where the file is."""
    text = EXAMPLE[: EXAMPLE.index("E = {")] + 'file = "rubber.nc"\n\n' + EXAMPLE[EXAMPLE.index("[start]") :]
    digests = set()
    for E in (3e6, 4e6):
        rubber = vr.Material(E, 0.5, vr.Prony([0.3, 1.5], [2e-2, 1e-5]))
        rubber.to_netcdf(tmp_path / "rubber.nc")
        run = read(text)
        digests.add(run.digest)
        assert run.inputs.fixed["pair"].cylinder == rubber
    assert len(digests) == 2


def test_store_and_export(read, tmp_path):
    """The same files for any number of threads; strengths are kept with each motion."""
    run, store = read(SCENE), tmp_path / "results.zarr"
    run_ensemble(run, store, threads=2)
    run_ensemble(run, tmp_path / "one.zarr", threads=1)
    for path in Path(store).rglob("*"):
        if path.is_file() and path.name != ".lock":
            assert path.read_bytes() == (tmp_path / "one.zarr" / path.relative_to(store)).read_bytes()
    assert verify(store).ok
    export_netcdf(store, tmp_path / "all.nc")
    with xr.open_dataset(tmp_path / "all.nc", group="motions", engine="h5netcdf") as motions:
        assert motions.E_2.dims == ("motion",)
        assert motions.E_2.attrs["long_name"] == "strength 2 of relaxation over the long-time modulus"
        assert 1.0 < motions.E_2.values.min() < motions.E_2.values.max() < 3.0


def test_sobol_indices_of_a_material(read):
    """Rolling resistance spreads by the strengths of the modes that it is made of, not by friction."""
    found = sobol_indices(read(EXAMPLE), n=64)
    total = found.rolling_loss_ST.isel(t=-1)
    assert total.sel(input="E_2") > 0.3 > total.sel(input="mu")
    assert total.sel(input="tau_1") > total.sel(input="V0")


def test_uncertain_rubber_on_a_base(read, tmp_path):
    """Every motion is that of the cylinder of its own rubber on the other body."""
    base = "[base]\nE = 3e6\nnu = 0.5\nprony = { E = [0.5], tau = [0.02] }\n"
    text = EXAMPLE.replace("n = 60", "n = 6").replace("rtol =", 'keep = "all"\nrtol =') + base
    run = read(text)
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    other = vr.Material(E=3e6, nu=0.5, prony=vr.Prony(E=[0.5], tau=[0.02]))
    for i in range(6):
        one = {name: values[name][i] if np.ndim(values[name]) else values[name] for name in values}
        series = vr.Prony(E=[one[f"E_{k}"] for k in (1, 2, 3)], tau=[one[f"tau_{k}"] for k in (1, 2, 3)])
        rubber = vr.Material(E=one["E"], nu=one["nu"], prony=series, T_ref=one["T_ref"])
        roller = vr.Cylinder(
            R=one["R"], m=one["m"], material=rubber, base=other, mu=one["mu"], j=one["j"], load=one.get("load")
        )
        m = roller.roll(one["V0"], one["omega0"], run.t, rtol=run.settings.rtol)
        for name in ("V", "omega", "x"):
            expected = getattr(m, name)
            assert close(columns[name][i], expected, rel=tol.RUN_SI, scale=np.abs(expected).max())
    run_ensemble(run, tmp_path / "s.zarr", threads=1)
    export_netcdf(tmp_path / "s.zarr", tmp_path / "s.nc")
    with xr.open_dataset(tmp_path / "s.nc", group="motions", engine="h5netcdf", decode_times=False) as kept:
        assert np.array_equal(kept["V"].values, columns["V"])


UNCERTAIN_BASE = """
[base]
E = { distribution = "lognorm", s = 0.2, scale = 3e6 }
nu = 0.5
T_ref = 0.02
[base.prony]
E = [{ distribution = "lognorm", s = 0.3, scale = 0.5 }]
tau = [{ distribution = "uniform", loc = 1.0, scale = 1.0 }]
"""
ELASTIC_BASE = """
[base]
E = { distribution = "lognorm", s = 0.2, scale = 3e7 }
nu = { distribution = "uniform", loc = 0.3, scale = 0.2 }
"""
CERTAIN = "[material]\nE = 3e6\nnu = 0.5\nprony = { E = [0.3, 1.5], tau = [2e-2, 1e-3] }\n"
CERTAIN = EXAMPLE[: EXAMPLE.index("[material]")] + CERTAIN + EXAMPLE[EXAMPLE.index("[start]") :]
RIGID = CERTAIN.replace(CERTAIN[CERTAIN.index("E = 3e6") : CERTAIN.index("[start]")], "E = inf\nnu = 0.5\n")


def body(values: dict, prefix: str, fixed: vr.Material) -> vr.Material:
    """The material of one motion of a run."""
    modes = [(values.get(f"{prefix}E_{n}"), values.get(f"{prefix}tau_{n}")) for n in range(1, 4)]
    if f"{prefix}E" not in values:
        return fixed
    series = vr.Prony(*zip(*(mode for mode in modes if mode[0] is not None), strict=True)) if modes[0][0] else None
    return vr.Material(values[f"{prefix}E"], values[f"{prefix}nu"], series or vr.Prony.elastic(), fixed.T_ref)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (EXAMPLE + UNCERTAIN_BASE, {"E", "E_1", "base_E", "base_E_1", "base_tau_1"}),
        (EXAMPLE + ELASTIC_BASE, {"E", "E_1", "base_E", "base_nu"}),
        (CERTAIN + UNCERTAIN_BASE, {"base_E", "base_E_1", "base_tau_1"}),
        (RIGID + UNCERTAIN_BASE, {"base_E", "base_E_1", "base_tau_1"}),
        (EXAMPLE + "[base]\nE = inf\nnu = 0.5\n", {"E", "E_1", "tau_1"}),
    ],
)
def test_an_uncertain_base(read, text, names):
    """Every motion is that of the cylinder of its own pair, over seconds."""
    run = read(text.replace("rtol =", 'keep = "all"\nrtol ='))
    assert names <= set(run.inputs.uncertain)
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    fixed = {
        "": vr.Material(3e6, 0.5, vr.Prony([0.3, 1.5], [2e-2, 1e-3])),
        "base_": vr.Material(np.inf, 0.5) if "base_E" not in names else vr.Material(3e6, 0.5, T_ref=0.02),
    }
    if "E = inf\nnu = 0.5\n[start]" in text:
        fixed[""] = vr.Material.rigid()
    for i in (0, 31, 59):
        one = {name: values[name][i] if np.ndim(values[name]) else values[name] for name in values}
        cylinder, base = (body(one, prefix, given) for prefix, given in fixed.items())
        roller = vr.Cylinder(R=0.1, m=35.5, mu=one["mu"], material=cylinder, base=base)
        motion = roller.roll(one["V0"], 0.0, run.t, rtol=run.settings.rtol)
        for name in ("V", "omega", "x"):
            expected = getattr(motion, name)
            assert close(columns[name][i], expected, rel=tol.RUN_SI, scale=np.abs(expected).max())


def test_names_of_a_base():
    about = attributes("base_tau_1", si=True)
    assert about == {"long_name": "base: relaxation time 1 over T_ref", "units": "1"}
    assert attributes("base_E", si=True)["units"] == "Pa"


def test_sobol_indices_of_a_base(read):
    """A base as soft as the roller takes its part of the resistance."""
    found = sobol_indices(read(EXAMPLE + UNCERTAIN_BASE), n=32)
    total = found.rolling_loss_ST.isel(t=-1)
    assert total.sel(input="base_E_1") > total.sel(input="V0")


def test_refused(read):
    spread = '{ distribution = "lognorm", s = 0.2, scale = 0.3 }'
    for text, words in (
        (EXAMPLE.replace(spread, "-0.3"), ["line 12", "E_1 = -0.3", ">= 0"]),
        (EXAMPLE.replace(spread, spread.replace("}", ", loc = -1.0 }")), ["line 12", "E_1: reaches from -1"]),
        (EXAMPLE.replace(spread, "'0.3 GPa'"), ["line 12", "E_1", "plain number"]),
        (EXAMPLE.replace(spread, spread.replace("lognorm", "lognorn")), ["line 12", "did you mean 'lognorm'?"]),
        (EXAMPLE.replace("1e-3, 1e-5]", "1e-3]"), ["tau", "one time for each E"]),
        (EXAMPLE.replace("1e-3, 1e-5]", "1e-3, 0.0]"), ["tau_3 = 0.0", "> 0"]),
        (EXAMPLE.replace("nu = 0.5", "nu = 0.6"), ["line 9", "nu = 0.6"]),
        (EXAMPLE.replace("nu = 0.5", "nu = 0.5\nEE = 2"), ["line 10", "unknown key 'EE'"]),
        (EXAMPLE.replace("nu = 0.5", "nu = 0.5\nT_sigma = 0.1"), ["T_epsilon and T_sigma"]),
        (EXAMPLE + f"[base]\nE = {spread}\nnu = 0.6\n", ["[base]", "nu = 0.6"]),
        (EXAMPLE + UNCERTAIN_BASE.replace("loc = 1.0", "loc = -1.0"), ["base_tau_1: reaches from -1"]),
        (EXAMPLE + UNCERTAIN_BASE.replace("nu =", "mu ="), ["[base]", "unknown key 'mu'"]),
        (EXAMPLE + UNCERTAIN_BASE.replace("3e6", "'3 MPa'"), ["base_E", "scale"]),
        (SCENE.replace("mu =", "alpha = 3.0\nmu ="), ["line 5", "alpha and a series"]),
        (SCENE.replace("prony", "pony"), ["line 3", "did you mean 'prony'?"]),
        (SCENE.replace("prony =", "# prony ="), ["needs alpha, prony or creep"]),
        (SCENE.replace("E_2.omega0", "E_1.omega0"), ["'E_1' has no distribution"]),
        (SCENE.replace("[run]", '[run]\nmethod = "flow"'), ["method = 'flow'"]),
        (CREEP.replace("scale = 0.2", "scale = 0.6"), ["line 3", "J may sum to 1.1"]),
        (CREEP.replace("T = [", "alpha = 3.0, T = ["), ["alpha: must be left out"]),
    ):
        refused(partial(read, text), *words, error=vr.ConfigError)
