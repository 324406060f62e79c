"""Run files: each motion is the one that a user would call for, and what a file says is in its digest and its store."""

from __future__ import annotations

import re
import tomllib
from functools import partial

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from places import DOCS
from refusals import refused

import viscoroll as vr
from viscoroll.motion.batch import FLOW_PAYS
from viscoroll.runs import estimate, export_netcdf, open_summaries, read_run, roll_inputs, run_ensemble, verify
from viscoroll.runs.evaluate import block_inputs, roll_block
from viscoroll.runs.quantities import attributes
from viscoroll.runs.rollers import roller_of
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.store import columns_of

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

PAPER = 'preset = "paper-section-5"\n'
FULL = (
    PAPER
    + """
[scene]
mu = { distribution = "lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6] }
j = 0.4
[start]
V0 = U(-2.0, 4.0)
omega0 = { distribution = "norm", scale = 0.5 }
[correlation]
V0.mu = 0.7
[run]
n = 30
seed = 5
t = { low = 0.0, high = 3e-3, count = 3 }
rtol = 1e-6
block = 12
keep = "all"
summaries = ["V", "x"]
"""
)
STRENGTHS = """
[scene]
prony = { E = [0.5, U(1.0, 2.0)], tau = [1.0, 1e-2] }
kappa = 10.0
mu = 0.3
gamma = 4.0
[start]
V0 = 1.0
omega0 = U(0.0, 0.5)
[correlation]
E_2.omega0 = 0.5
[run]
n = 20
t = [0.5, 2.0]
"""
COMPLIANCES = (
    STRENGTHS.replace("prony", "creep").replace("E = [0.5, U(1.0, 2.0)]", "J = [0.2, U(0.3, 0.2)]")
    .replace("tau =", "T =").replace("E_2", "J_2")
)  # fmt: skip
PAPER_ROLLER = "[cylinder]\nR = U(0.08, 0.04)\nm = 35.5\nmu = 0.2\n"
PAPER_RUBBER = "E = 2.3e5\nnu = 0.49\nT_epsilon = U(9.0, 3.0)\nT_sigma = 0.97\n"
SLOW = """
[start]
V0 = U(-0.02, 0.04)
omega0 = { distribution = "norm", loc = 0.05, scale = 0.1 }
[run]
n = 20
t = [1e-4, 2e-3, 0.03]
rtol = 1e-10
keep = "all"
fields = ["V", "omega", "x", "angle", "delta", "regime", "slip_loss", "rolling_loss"]
summaries = ["V", "omega", "x", "distance", "angle", "delta", "translation", "lost", "slip_loss", "onset_time"]
"""
NUMBERS = PAPER_ROLLER + PAPER_RUBBER + SLOW
SERIES = """
[material]
E = 2.3e5
nu = 0.49
prony = { E = [2.0, 6.0], tau = [1.0, 1e-3] }
T_ref = 3.0
"""
LOADED = SERIES + PAPER_ROLLER + "load = U(300.0, 100.0)\n" + SLOW
RUBBER = (DOCS / "examples/rubber-sensitivity.toml").read_text(encoding="utf-8").replace("20_000", "12")
RUBBER = re.sub("#.*", "", RUBBER).replace("rtol =", 'fields = ["V", "omega", "x"]\nkeep = "all"\nrtol =')
CERTAIN = RUBBER[: RUBBER.index("[material]")] + "[material]\nE = 3e6\nnu = 0.5\n" + RUBBER[RUBBER.index("[start]") :]
SOFT_BASE = """
[base]
E = { distribution = "lognorm", s = 0.2, scale = 3e6 }
nu = 0.5
T_ref = 0.02
[base.prony]
E = [{ distribution = "lognorm", s = 0.3, scale = 0.5 }]
tau = [U(1.0, 1.0)]
"""
HARD_BASE = '[base]\nE = { distribution = "lognorm", s = 0.2, scale = 3e7 }\nnu = U(0.3, 0.2)\n'
RIGID_BASE = "[base]\nE = inf\nnu = 0.5\n"
DRIVEN = (
    PAPER
    + """
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, 1e-3, 1e-3], values = [0.0, U(0.1, 0.2), 0.0] }
slope = { distribution = "norm", scale = 0.01, truncate = [-0.1, 0.1] }
force = { distribution = "norm", scale = 0.02 }
brake = 0.01
[correlation]
drive_torque_2.drive_force = 0.5
[run]
n = 12
t = [1e-3, 3e-3]
keep = "all"
fields = ["V", "force", "torque", "work_torque", "slip_loss"]
summaries = ["V", "force", "work_force", "work_torque", "brake_loss", "slip_energy", "rolling_energy", "slip_loss"]
"""
)
OWN_TIMES = (
    PAPER
    + """
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, U(1e-3, 5e-4), "same", U(2e-3, 1e-3)], values = [0.0, U(0.0, 0.3), 0.05, -0.1] }
force = { times = [5e-4, 5e-4], values = [0.0, 0.01] }
[run]
n = 12
t = [1e-3, 3e-3]
"""
)
GIVEN_V = OWN_TIMES.replace("torque", "V").replace('"same", ', "").replace("0.05, ", "").replace("force", "torque")
GIVEN_V = GIVEN_V.replace("V0 = 0.0\n", "")
GIVEN_OMEGA = GIVEN_V.replace("V =", "omega =").replace("omega0 =", "V0 =").replace("torque =", "force =")
DRIVEN_ROLLER = """
[cylinder]
R = U(0.1, 0.05)
m = U(30.0, 10.0)
E = 2.3e5
nu = 0.49
T_epsilon = 10.7
T_sigma = 0.97
mu = 0.2
[start]
V0 = 0.014
omega0 = 0.05
[drive]
torque = U(1.0, 0.5)
force = { times = [0.0, 1.0], values = [10.0, U(-20.0, 5.0)] }
slope = U(-0.05, 0.1)
brake = { times = [1.5, 1.5], values = [0.0, 3.0] }
[run]
n = 8
t = [0.5, 1.0, 2.0]
keep = "all"
fields = ["V", "omega", "x", "force", "torque", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"]
summaries = ["force", "torque", "work_force", "slip_energy"]
"""
SPUN = DRIVEN_ROLLER[: DRIVEN_ROLLER.index("omega0")] + "[drive]\nomega = { times = [0.0, 1.0], values = [0.05, 0.2] }"
SPUN += "\n" + DRIVEN_ROLLER[DRIVEN_ROLLER.index("[run]") :].replace('"brake_loss", ', "")
FILES = {
    "a preset": FULL, "strengths": STRENGTHS, "compliances": COMPLIANCES,
    "numbers": NUMBERS, "a series": LOADED, "rubber": RUBBER,
    "rubber on rubber": RUBBER + SOFT_BASE, "rubber on steel": RUBBER + HARD_BASE,
    "on what is rigid": RUBBER + RIGID_BASE,
    "known rubber": CERTAIN.replace("0.5\n", "0.5\nprony = { E = [0.3, 1.5], tau = [2e-2, 1e-3] }\n", 1) + SOFT_BASE,
    "a rigid roller": CERTAIN.replace("3e6", "inf") + SOFT_BASE,
    "driven": DRIVEN, "own times": OWN_TIMES, "given V": GIVEN_V, "given omega": GIVEN_OMEGA,
    "a driven roller": DRIVEN_ROLLER, "a spun roller": SPUN,
}  # fmt: skip
FILES = {
    name: re.sub(r"U\(([^ ]*), ([^ ]*)\)", r'{ distribution = "uniform", loc = \1, scale = \2 }', text)
    for name, text in FILES.items()
}
of_every_file = pytest.mark.parametrize("text", FILES.values(), ids=FILES)
SI_UNITS = {
    "V": "m s-1", "omega": "rad s-1", "x": "m", "distance": "m", "angle": "rad", "onset_time": "s", "delta": "1",
    "translation": "1", "lost": "1", "slip_loss": "1", "force": "N m-1", "torque": "N m m-1", "work_force": "J m-1",
    "slip_energy": "J m-1", "rolling_loss": "1",
}  # fmt: skip


@pytest.fixture
def read(tmp_path):
    def read(text: str):
        (tmp_path / "run.toml").write_text(text, encoding="utf-8")
        return read_run(tmp_path / "run.toml")

    return read


# --- what the inputs of a motion mean ---


def drawn(part, name, values, i):
    """A part of a file, with what was drawn for one motion in place of distributions."""
    if isinstance(part, list):
        return [drawn(each, f"{name}_{k}", values, i) for k, each in enumerate(part, 1)]
    if not isinstance(part, dict):
        return part
    if "distribution" in part:
        return values[name][i]
    if "times" in part:
        times = drawn(part["times"], f"{name}_time", values, i)
        times = [times[k - 1] if time == "same" else time for k, time in enumerate(times)]
        return vr.Schedule(times, drawn(part["values"], name, values, i))
    found = {key: drawn(each, name + key, values, i) for key, each in part.items() if key not in ("prony", "creep")}
    for kind in part.keys() & {"prony", "creep"}:
        series = drawn(part[kind], name, values, i).values()
        found["prony"] = vr.Prony(*series) if kind == "prony" else vr.Prony.creep(*series)
    return found


def alone(run, values, i):
    """One motion of a block, as a user calls for it."""
    prefix = {"base": "base_", "drive": "drive_"}
    file = {key: drawn(part, prefix.get(key, ""), values, i) for key, part in tomllib.loads(run.text).items()}
    call = [file["start"].get("V0"), file["start"].get("omega0"), run.t]
    options = file.get("drive", {}) | {"rtol": run.settings.rtol, "rest": run.settings.rest}
    if "cylinder" in file:
        bodies = {name: vr.Material(**file[name]) for name in ("material", "base") if name in file}
        return vr.Cylinder(**file["cylinder"], **bodies).roll(*call, **options)
    scene = file.get("scene", {})
    scene = vr.PAPER_SECTION_5.replace(**scene) if "preset" in file else vr.Scene(material=scene.pop("prony"), **scene)
    return vr.roll(scene, *call, **options)


def largest(values):
    return np.abs(np.nan_to_num(values)).max()


@of_every_file
def test_every_motion_is_that_of_a_call(read, text):
    run = read(text)
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    fields = ("onset_time", *run.settings.fields)
    for i in range(0, len(motions.V), 4):
        one = alone(run, values, i)
        for name in fields:
            expected = getattr(one, name)
            assert close(columns[name][i], expected, rel=tol.RUN_SI, scale=largest(expected), what=(name, i))


@of_every_file
def test_a_block_is_rolled_as_an_ensemble(read, text):
    """To the bit, however it is cut; and inputs keep to their ranges."""
    run = read(text)
    values, motions = roll_block(run, run.blocks - 1)
    few = {name: value[3:5] for name, value in values.items()}
    assert np.array_equal(roll_inputs(run, few, 2).V, motions.V[3:5], equal_nan=True)
    mu = values.get("mu", 0.2)
    assert ((np.asarray(mu) >= 0.05) & (np.asarray(mu) <= 0.6)).all()


def test_a_correlation_of_inputs(read):
    values = block_inputs(read(FILES["driven"].replace("n = 12", "n = 500")), 0)
    assert 0.4 < np.corrcoef(values["drive_torque_2"], values["drive_force"])[0, 1] < 0.6


@of_every_file
def test_the_digest_is_of_every_number(read, text):
    """Of the file, whatever is told beside it."""
    digest = read(text).digest
    assert read("# told\n" + text).digest == digest
    for number in re.finditer(r"(?<![\w.-])-?\d[\w.+-]*", text):
        sign = number[0].startswith("-")
        changed = text[: number.start()] + "-" * sign + "1" + number[0][sign:] + text[number.end() :]
        try:
            assert read(changed).digest != digest, number
        except vr.ConfigError:
            continue


def test_a_material_of_a_file_is_in_the_digest(read, tmp_path):
    text = CERTAIN.replace("E = 3e6\nnu = 0.5", 'file = "rubber.nc"')
    digests = set()
    for E in (3e6, 4e6):
        rubber = vr.Material(E, 0.5, vr.Prony([0.3, 1.5], [2e-2, 1e-5]))
        rubber.to_netcdf(tmp_path / "rubber.nc")
        run = read(text)
        digests.add(run.digest)
        assert run.inputs.content["material"] == rubber
    assert len(digests) == 2


@pytest.mark.parametrize("name", ["a preset", "numbers", "known rubber", "driven", "a driven roller"])
def test_a_store_holds_the_run(read, tmp_path, name):
    """And what is exported of it: columns, what drove them, their units, their summaries."""
    run = read(FILES[name].replace("[run]", "[run]\nquantiles = [0.5]"))
    run_ensemble(run, tmp_path / "s.zarr", threads=2)
    assert verify(tmp_path / "s.zarr").ok
    export_netcdf(tmp_path / "s.zarr", tmp_path / "s.nc")
    blocks = [columns_of(run, *roll_block(run, block)) for block in range(run.blocks)]
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    units = SI_UNITS if run.si else dict.fromkeys(SI_UNITS, "1")
    with xr.open_dataset(tmp_path / "s.nc", group="motions", engine="h5netcdf", decode_times=False) as kept:
        for name, values in columns.items():
            assert np.array_equal(kept[name].values, values, equal_nan=True), name
            assert kept[name].attrs["long_name"]
        for name in ("V", "onset_time"):
            assert kept[name].attrs["units"] == units[name]
        assert kept.attrs["quantities"] == ("in SI units" if run.si else "dimensionless")
    found = open_summaries(tmp_path / "s.zarr")
    for name in run.settings.summaries:
        told = found[f"{name}_mean"].attrs
        if run.si:
            assert told["units"] == units[name], name
            assert "T_epsilon" not in told["long_name"]
        if name in columns and name != "onset_time" and not name.endswith("_loss"):
            for kind in ("mean", "max"):
                exact = getattr(np, kind)(columns[name], axis=0)
                assert close(found[f"{name}_{kind}"].values, exact, rel=tol.MOMENT, scale=np.abs(exact).max())


def test_shares_of_an_energy_that_is_not_there(read, tmp_path):
    run_ensemble(read(FILES["driven"]), tmp_path / "s.zarr", threads=1)
    found = open_summaries(tmp_path / "s.zarr")
    assert np.isnan(found["slip_loss_mean"].values).all()
    assert (found["slip_energy_mean"].values > 0.0).all()


def test_names_of_inputs():
    about = attributes("base_tau_1", si=True)
    assert about == {"long_name": "base: relaxation time 1 over T_ref", "units": "1"}
    assert attributes("base_E", si=True)["units"] == "Pa"
    assert attributes("E_2", si=False)["long_name"] == "strength 2 of relaxation over the long-time modulus"


# --- which method ---


def test_a_cylinder_from_its_flow_map(read):
    """The map is made for dimensionless speeds, the threshold of rest is one."""
    text = FILES["numbers"].replace("n = 20", "n = 3000\nrest = 1e-3\nmethod = 'flow'").replace("1e-10", "1e-7")
    text = re.sub(r"(R|T_epsilon) = \{.*", lambda found: found[1] + (" = 0.1" if found[1] == "R" else " = 10.7"), text)
    run = read(text.replace(', "slip_loss", "rolling_loss"]', "]"))
    values, motions = roll_block(run, 0)
    assert motions.flow.mean() > 0.5
    assert np.isfinite(motions.rest_time).sum() > 100
    columns = columns_of(run, values, motions)
    for i in range(5):
        one = alone(run, values, i)
        assert close(columns["V"][i], one.V, rel=1e-7, scale=abs(values["V0"][i]))
        assert close(columns["rest_time"][i], one.rest_time, rel=1e-6)


def test_the_flow_map_where_many_start_in_one_scene(read):
    """Chosen by the run: a block of slow starts does not get a finer one.  Of motions at rest there is none."""
    one = FILES["a preset"].replace("[correlation]\nV0.mu = 0.7\n", "")
    one = one[: one.index("[scene]")] + one[one.index("[start]") :].replace("block = 12", "")
    run = read(one.replace("n = 30", f"n = {FLOW_PAYS}"))
    assert (run.mappable, run.method) == (True, "flow")
    values, motions = roll_block(run, 0)
    few = {name: value[3:4] for name, value in values.items()}
    assert roll_inputs(run, few, 2).V[0, 1] == motions.V[3, 1]
    assert read(FILES["driven"].replace("n = 12", "n = 100000")).method == "integrate"
    still = read(PAPER + '[start]\nV0 = 0.0\nomega0 = 0.0\n[run]\nn = 2\nt = 1e-3\nmethod = "flow"')
    assert roll_block(still, 0)[1].V.tolist() == [[0.0], [0.0]]


def test_nothing_is_uncertain(read):
    """The same motion n times; scenes are those of presets and series."""
    start = "[start]\nV0 = 1.5\nomega0 = 0.5\n[run]\nn = 3\nt = 1e-3"
    _, motions = roll_block(read(PAPER + start), 0)
    assert np.array_equal(motions.V[:, 0], [vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, [1e-3]).V[0]] * 3)
    rubber, series = 'preset = "rubber-roller"\n', "prony = { E = [0.5, 2.0], tau = [1.0, 1e-2] }\n"
    two = vr.Prony([0.5, 2.0], [1.0, 1e-2])
    for head, scene in (
        (rubber, vr.RUBBER_ROLLER),
        (rubber + "[scene]\nalpha = 3.0\n", vr.RUBBER_ROLLER.replace(alpha=3.0)),
        (PAPER + "[scene]\n" + series, vr.PAPER_SECTION_5.replace(material=two)),
    ):
        run = read(head + start)
        assert roller_of(run.path, run.inputs.content) == scene


def test_a_drive_that_ends_goes_with_a_rest(read):
    text = FILES["driven"]
    run = read((text[: text.index("slope")] + text[text.index("[run]") :]).replace("n = 12", "n = 4\nrest = 1e-3"))
    assert (roll_block(run, 0)[1].status <= 1).all()


@pytest.mark.parametrize(("name", "inputs"), [
    ("driven", {"drive_torque_2", "drive_slope", "drive_force"}),
    ("rubber on rubber", {"mu", "V0", "E_1", "E_2", "tau_1", "E", "base_E", "base_E_1", "base_tau_1"}),
])  # fmt: skip
def test_inputs_have_indices(read, name, inputs):
    """Rolling resistance spreads by the strengths of the modes that it is made of, less by friction and the start."""
    text = re.sub(r"\[correlation\]\n.*\n", "", FILES[name]).replace('"slip_loss"]', '"torque"]')
    found = sobol_indices(read(text), 64, threads=1)
    assert set(found["input"].values) == inputs
    if "base_E_1" in inputs:
        total = found.rolling_loss_ST.isel(t=-1)
        assert total.sel(input="E_2") > 0.2 > total.sel(input="mu")
        assert min(total.sel(input=["tau_1", "base_E_1"])) > total.sel(input="V0")


def test_size_and_time_of_a_run(read):
    run = read(FILES["a preset"].replace("n = 30", "n = 3_000_000_000").replace("block = 12", "block = 512"))
    found = estimate(run, threads=2)
    assert found.blocks == run.blocks == -(-3_000_000_000 // 512)
    assert found.seconds > 60.0
    assert "MB" in str(found)
    assert read(FILES["a preset"].replace("count = 3", "count = 3_000_000").replace("block = 12", "")).block == 1


# --- what is refused, and at which line ---

LOGNORM = '"lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6]'
SPREAD = '{ distribution = "lognorm", s = 0.2, scale = 0.3 }'
ANY = '{ distribution = "uniform" }'
BRAKE = "brake = 0.01"
REFUSED = {
    "a preset": [
        ("V0 = {", "Vo = {", "line 7: [start]", "unknown key 'Vo'", "did you mean 'V0'?"),
        ("seed = 5", "sead = 5", "line 13: [run]", "did you mean 'seed'?"),
        ("[start]", "[strat]", "line 6", "did you mean 'start'?"),
        ('"lognorm"', '"lognrom"', "line 4", "scipy.stats", "did you mean 'lognorm'?"),
        ('"lognorm"', '"poisson"', "line 4", "no continuous one"),
        ("s = 0.3", "sigma = 0.3", "line 4", "unknown key 'sigma'"),
        ("s = 0.3, ", "", "line 4", "lognorm also needs s"),
        ("s = 0.3", "s = -0.3", "line 4", "does not allow"),
        ("s = 0.3", 's = "0.3 %"', "line 4", "finite number without a unit"),
        ("[0.05, 0.6]", "[-0.05, 0.0]", "line 4", "nothing of the distribution is left"),
        ("[0.05, 0.6]", "[0.05, nan]", "line 4", "truncate = [0.05, nan]", "must be [low, high]"),
        ("[0.05, 0.6]", "[false, true]", "line 4", "truncate = [False, True]", "must be [low, high]"),
        (LOGNORM, '"norm", scale = 0.2', "line 4: [scene] mu = 0.0: must be finite and > 0"),
        (LOGNORM, '"norm", loc = 0.2, scale = 0.2', "line 4", "mu: reaches from -1.4", "> 0", "add truncate"),
        ("j = 0.4", "j = -0.4", "line 5", "j = -0.4", "> 0"),
        ("j = 0.4", 'j = "3 mm"', "line 5", "j = '3 mm': must be a number without a unit"),
        ("j = 0.4", "j = true", "line 5", "number"),
        ("j = 0.4", "j = { file = 'no.csv', column = 'j' }", "line 5", "no.csv"),
        ("V0.mu = 0.7", "V0.omega = 0.7", "line 10", "did you mean 'omega0'?"),
        ("V0.mu = 0.7", "V0.mu = 1.7", "line 10", "(-1, 1)"),
        ("V0.mu = 0.7", "V0.mu = 0.9\nmu.omega0 = 0.9\nV0.omega0 = -0.9", "line 9", "no joint distribution"),
        ("V0.mu = 0.7", "V0.mu = 0.0\nmu.V0 = 0.9", "V0.mu = 0.0: must be that of mu.V0 = 0.9"),
        ("n = 30", "n = 0", "line 12", ">= 1"),
        ("n = 30", 'n = "3000"', "line 12", "n = '3000': must be a whole number"),
        ("seed = 5", 'design = "grid"', "line 13", "grid"),
        ("count = 3 }", "count = 3, step = 1 }", "line 14", "unknown key 'step'"),
        ("t = {", "t = [2.0, 1.0] # {", "line 14", "ascending"),
        ("low = 0.0, high = 3e-3", "low = -1e308, high = 1e308", "line 14", "high = 1e+308: must be less than"),
        ("rtol = 1e-6", "rtol = 1.0", "line 15", "rtol"),
        ("block = 12", 'method = "flow"', "line 16", "scenes differ"),
        ('["V", "x"]', '["onset"]', "line 18", "onset"),
        ('["V", "x"]', "[]", "line 18: [run] summaries = []: must name at least one quantity"),
        ('"paper-section-5"', '"paper"', "line 1", "choose from paper-section-5"),
        ('"norm", scale = 0.5', '"dweibull", c = 1e-3', "line 8", "omega0: reaches from -inf to inf", "add truncate"),
        ("j = 0.4", 'j = { distribution = "uniform", loc = 1e308, scale = 1e308 }', "line 5", "j: reaches from"),
        ('"norm", scale = 0.5', '"norm", scale = 0.0', "line 8", "does not allow these parameters"),
        ('"norm", scale = 0.5', '"uniform", loc = 1e308, scale = 1e308', "line 8", "at most 1e+100"),
    ],
    "strengths": [
        ("mu =", "alpha = 3.0\nmu =", "alpha and material are both given"),
        ("prony", "pony", "line 3", "did you mean 'prony'?"),
        ("prony =", "# prony =", "'E_2' has no distribution"),
        ("E_2.omega0", "E_1.omega0", "'E_1' has no distribution"),
        ("[run]", '[run]\nmethod = "flow"', "method = 'flow'"),
    ],
    "compliances": [
        ("scale = 0.2", "scale = 0.6", "line 3", "J_2: reaches from 0.3 to 0.9", "of a sum below 1", "add truncate"),
        ("T = [", "alpha = 3.0, T = [", "alpha = 3.0: must be 1/(1 - sum J)"),
    ],
    "numbers": [
        ("V0 = {", "V0 = '3 m/s' # {", "line 11", "V0 = '3 m/s': must be a number without a unit"),
        ("omega0 = {", "omega0 = '3 rpm' # {", "line 12", "omega0 = '3 rpm': must be a number without a unit"),
        ("n = 20", "rest = 0.01\nn = 20", "line 14: [run] rest needs the same R and T_ref"),
        ("t = [", "t = '3 s' # [", "line 15", "t = '3 s': must be a number"),
        ("loc = 9.0", "loc = 0.5", "T_epsilon: reaches from 0.5 to 3.5", ">= T_sigma = 0.97"),
        ("[cylinder]", SERIES + "[cylinder]", "[cylinder] material and E, nu, T_epsilon, T_sigma are both given"),
        ("[cylinder]", SERIES.replace("material", "base") + "[cylinder]", "must be a single number"),
    ],
    "rubber": [
        (SPREAD, "-0.3", "line 12", "E = -0.3 at row 0", ">= 0"),
        (SPREAD, SPREAD.replace("}", ", loc = -1.0 }"), "line 12", "E = -0.7 at row 0"),
        (SPREAD, "'0.3 GPa'", "line 12", "prony.E = '0.3 GPa': must be a number"),
        ("1e-3, 1e-5]", "1e-3]", "tau", "one time for each E"),
        ("1e-3, 1e-5]", "1e-3, 0.0]", "tau = 0.0 at row 2", "> 0"),
        ("nu = 0.5", "nu = 0.6", "line 9", "nu = 0.6"),
        ("nu = 0.5", "nu = 0.5\nEE = 2", "line 10", "unknown key 'EE'"),
        ("nu = 0.5", "nu = 0.5\nT_sigma = 0.1", "T_epsilon and T_sigma"),
        ("[cylinder]", "[scene]", "[material] goes with [cylinder]"),
    ],
    "rubber on rubber": [
        ("loc = 1.0", "loc = -1.0", "line 37: [base.prony] tau = -0.5"),
        ("loc = 1.0", "loc = -0.1", "line 37: [base.prony] base_tau_1: reaches from -0.1", "> 0; add truncate"),
        ("nu = 0.5\nT_ref", "mu = 0.5\nT_ref", "[base]", "unknown key 'mu'"),
        ("scale = 3e6", "scale = '3 MPa'", "base_E", "scale"),
    ],
    "driven": [
        (BRAKE, "brake = -0.01", "line 10: [drive] brake = -0.01: must be finite and >= 0"),
        (BRAKE, 'brake = "1 N"', "brake = '1 N': must be a number without a unit"),
        (BRAKE, "brkae = 0.01", "did you mean 'brake'?"),
        (BRAKE, 'brake = { distribution = "norm" }', "add truncate"),
        (BRAKE, "brake = nan", "brake = nan"),
        (BRAKE, "brake = { times = [0.0], valeus = [1.0] }", "did you mean 'values'?"),
        (BRAKE, "brake = { times = [0.0, 1.0], values = [1.0] }", "times (2,), values (1,)"),
        (BRAKE, "brake = { times = [1.0, 0.0], values = [1.0, 2.0] }", "in ascending order"),
        (BRAKE, "brake = { times = [], values = [] }", "times = []: Expected `array` of length >= 1"),
        (BRAKE, f"brake = {{ times = [2.0, {ANY}], values = [1.0, 2.0] }}", "brake: times = 2.0: must be in asc"),
        (BRAKE, f"brake = {{ times = [{ANY}, 0.5], values = [1.0, 2.0] }}", "brake_time_1: reaches from"),
        (BRAKE, 'brake = { times = ["same"], values = [1.0] }', "brake.times = 'same': must be a number"),
        (BRAKE, f"brake = {{ times = [{ANY}, 'same', 'same'], values = [1.0, 2.0, 3.0] }}", "or twice for a jump"),
        (BRAKE, "V = 0.01", "V0 = 0.0: must be None, or 0.01 as prescribed"),
        ("scale = 0.01, truncate = [-0.1, 0.1]", "scale = 0.5", "drive_slope: reaches from -4", "add truncate"),
        ("force = {", "force = inf\n#", "'drive_force' has no distribution"),
        ("n = 12", "n = 12\nrest = 1e-3", "rest = 0.001 is given, but something drives the motion to its end"),
        ("n = 12", 'n = 12\nmethod = "flow"', "method = 'flow': must be 'auto' or 'integrate'"),
        ("drive_torque_2.drive_force", "torque.drive_force", "'torque' has no distribution"),
        ("[correlation]", "[correlation]\ndrive = 1\n[[drive]]\n#", "is not TOML"),
    ],
    "given V": [
        ("omega0 = 0.0", "V0 = 1.0\nomega0 = 0.0", "V0 = 1.0: must be None, or 0 as prescribed"),
        ("[run]", "omega = 1.0\n[run]", "V and omega are both given"),
        ("[run]", "force = 1.0\n[run]", "force is given beside V=: leave it out"),
        ("n = 12", "n = 12\nrest = 1e-3", "rest = 0.001 is given, but something drives the motion to its end"),
    ],
    "given omega": [
        ("V0 = 0.0", "V0 = 0.0\nomega0 = 1.0", "omega0 = 1.0: must be None, or 0 as prescribed"),
        ("[run]", "brake = 1.0\n[run]", "brake is given beside omega=: leave it out"),
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_refused(read, name):
    for old, new, *words in REFUSED[name]:
        assert old in FILES[name], old
        refused(partial(read, FILES[name].replace(old, new, 1)), *words, error=vr.ConfigError)


# --- columns of files ---

SAMPLED = FILES["numbers"].replace("m = 35.5", 'm = { file = "sample.csv", column = "mass" }').replace(
    "E = 2.3e5", 'E = { file = "sample.csv", column = "modulus" }'
)  # fmt: skip


@pytest.fixture
def sample(tmp_path):
    frame = pd.DataFrame({"mass": [30.0, 40.0, 50.0], "modulus": [2e5, 3e5, 4e5], "name": ["a", "b", "c"]})
    frame.to_csv(tmp_path / "sample.csv")
    return frame[["mass", "modulus"]]


@pytest.mark.parametrize("suffix", [".csv", ".nc", ".parquet"])
def test_columns_of_a_file_share_their_row(read, tmp_path, sample, suffix):
    if suffix == ".nc":
        xr.Dataset.from_dataframe(sample).to_netcdf(tmp_path / "sample.nc", engine="h5netcdf")
    elif suffix == ".parquet":
        pytest.importorskip("pyarrow")
        sample.to_parquet(tmp_path / "sample.parquet")
    run = read(SAMPLED.replace(".csv", suffix).replace("n = 20", "n = 100"))
    assert f"sample{suffix}" in run.inputs.dimensions
    values = block_inputs(run, 0)
    assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
    assert set(values["m"]) == {30.0, 40.0, 50.0}


def test_a_file_by_two_names_is_one_file(read, tmp_path, sample):
    """Also by way of a link; its columns share their row, and cannot be told apart by Sobol indices."""
    (tmp_path / "link.csv").symlink_to("sample.csv")
    for other in ("./sample.csv", "link.csv", str(tmp_path / "sample.csv")):
        run = read(SAMPLED.replace('"sample.csv", column = "modulus"', f'"{other}", column = "modulus"'))
        assert run.inputs.dimensions.count("sample.csv") == 1
        values = block_inputs(run, 0)
        assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
        refused(lambda run=run: sobol_indices(run, 16), "m, [cylinder] E = rows of sample.csv")
    text = SAMPLED.replace('"mass"', '"name"')
    refused(lambda: read(text), "line 3", "finite numbers", error=vr.ConfigError)
