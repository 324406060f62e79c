"""Section [drive] of a run file: what it means, in either units, and what is refused at which line."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll.runs import export_netcdf, open_summaries, read_run, run_ensemble
from viscoroll.runs.evaluate import block_inputs, roll_block
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.store import columns_of

SCENE = """
preset = "paper-section-5"
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, 1e-3, 1e-3], values = [0.0, { distribution = "uniform", loc = 0.1, scale = 0.2 }, 0.0] }
slope = { distribution = "norm", scale = 0.01, truncate = [-0.1, 0.1] }
force = { distribution = "norm", scale = 0.02 }
brake = 0.01
[correlation]
drive_torque_2.drive_force = 0.5
[run]
n = 40
t = [1e-3, 3e-3]
keep = "all"
fields = ["V", "force", "torque", "work_torque", "slip_loss"]
summaries = ["V", "force", "work_force", "work_torque", "brake_loss", "slip_energy", "rolling_energy", "slip_loss"]
"""
CYLINDER = """
[cylinder]
R = { distribution = "uniform", loc = 0.1, scale = 0.05 }
m = { distribution = "uniform", loc = 30.0, scale = 10.0 }
E = 2.3e5
nu = 0.49
T_epsilon = 10.7
T_sigma = 0.97
mu = 0.2
[start]
V0 = 0.014
omega0 = 0.05
[drive]
torque = { distribution = "uniform", loc = 1.0, scale = 0.5 }
force = { times = [0.0, 1.0], values = [10.0, { distribution = "uniform", loc = -20.0, scale = 5.0 }] }
slope = { distribution = "uniform", loc = -0.05, scale = 0.1 }
brake = { times = [1.5, 1.5], values = [0.0, 3.0] }
[run]
n = 8
t = [0.5, 1.0, 2.0]
keep = "all"
fields = ["V", "omega", "x", "force", "torque", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"]
"""


@pytest.fixture
def read(tmp_path):
    def read(text: str):
        (tmp_path / "run.toml").write_text(text, encoding="utf-8")
        return read_run(tmp_path / "run.toml")

    return read


def test_the_motions_of_a_block_are_those_of_ensemble(read):
    run = read(SCENE)
    values, motions = roll_block(run, 0)
    corners = np.stack([np.zeros(40), values["drive_torque_2"], np.zeros(40)], axis=-1)
    same = vr.ensemble(
        vr.PAPER_SECTION_5, 0.0, 0.0, [1e-3, 3e-3], torque=([0.0, 1e-3, 1e-3], corners), slope=values["drive_slope"],
        force=values["drive_force"], brake=0.01, fields=run.fields,
    )  # fmt: skip
    for name in run.fields:
        assert np.array_equal(getattr(motions, name), getattr(same, name)), name
    assert np.corrcoef(values["drive_torque_2"], values["drive_force"])[0, 1] > 0.0


def test_a_cylinder_is_driven_in_si_units(read):
    """Each motion of a run against the roller's own, in newtons and joules."""
    run = read(CYLINDER)
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    for n in range(8):
        one = {name: values[name][n] for name in run.inputs.uncertain}
        roller = vr.Cylinder(R=one["R"], m=one["m"], E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
        m = roller.roll(
            0.014, 0.05, [0.5, 1.0, 2.0], torque=one["drive_torque"], slope=one["drive_slope"],
            force=([0.0, 1.0], [10.0, one["drive_force_2"]]), brake=([1.5, 1.5], [0.0, 3.0]),
        )  # fmt: skip
        for name in run.settings.fields:
            expected = getattr(m, name)
            assert close(columns[name][n], expected, rel=tol.RUN_SI, scale=np.abs(expected).max())


def test_a_store_holds_the_drive(read, tmp_path):
    run = read(SCENE)
    run_ensemble(run, tmp_path / "s.zarr", threads=1)
    export_netcdf(tmp_path / "s.zarr", tmp_path / "s.nc")
    values, motions = roll_block(run, 0)
    with xr.open_dataset(tmp_path / "s.nc", group="motions", engine="h5netcdf", decode_times=False) as kept:
        assert np.array_equal(kept["drive_torque_2"].values, values["drive_torque_2"])
        assert kept["drive_torque_2"].attrs["long_name"].endswith("load times radius, value 2")
        assert np.array_equal(kept["force"].values, motions.force)
        assert kept["work_torque"].attrs["units"] == "1"
    found = open_summaries(tmp_path / "s.zarr")
    assert close(found["work_torque_mean"].values, motions.work_torque.mean(axis=0), rel=tol.MOMENT)
    assert np.isnan(found["slip_loss_mean"].values).all()  # shares of an energy that is not there
    assert (found["slip_energy_mean"].values > 0.0).all()


def test_si_summaries_have_units(read, tmp_path):
    run = read(CYLINDER.replace("t = [", 'summaries = ["force", "torque", "work_force", "slip_energy"]\nt = ['))
    run_ensemble(run, tmp_path / "s.zarr", threads=1)
    found = open_summaries(tmp_path / "s.zarr")
    units = {name: found[f"{name}_mean"].attrs["units"] for name in run.settings.summaries}
    assert units == {"force": "N m-1", "torque": "N m m-1", "work_force": "J m-1", "slip_energy": "J m-1"}
    values, motions = roll_block(run, 0)
    load = values["m"] * 9.81 * np.cos(values["drive_slope"])
    assert close(found["force_max"].values, (motions.force * load[:, None]).max(axis=0), rel=tol.SCENE)


def test_the_digest_holds_the_drive(read):
    one = read(SCENE).digest
    assert read(SCENE.replace("brake = 0.01", "brake = 0.02")).digest != one
    assert read(SCENE.replace("brake = 0.01", "# the same\nbrake = 0.01")).digest == one
    assert read(SCENE.replace("1e-3, 1e-3]", "1e-3, 2e-3]")).digest != one


def test_driven_runs_are_integrated(read):
    many = SCENE.replace("n = 40", "n = 100000")
    assert read(many).method == "integrate"
    fixed = SCENE[: SCENE.index("torque")] + "brake = 0.01\n" + SCENE[SCENE.index("[run]") :]
    run = read(fixed)
    assert (run.method, run.inputs.uncertain) == ("integrate", ())
    assert block_inputs(run, 0)["drive_brake"] == 0.01


def test_inputs_of_a_drive_have_indices(read):
    text = SCENE[: SCENE.index("[correlation]")] + SCENE[SCENE.index("[run]") :]
    found = sobol_indices(read(text.replace('"slip_loss"]', '"torque"]')), 16, threads=1)
    assert set(found["input"].values) == {"drive_torque_2", "drive_slope", "drive_force"}


REFUSED = [
    ("brake = 0.01", "brake = -0.01", "line 10: [drive] drive_brake = -0.01: must be >= 0"),
    ("brake = 0.01", 'brake = "1 N"', "drive_brake = '1 N': must be a plain number, dimensionless"),
    ("brake = 0.01", "brkae = 0.01", "did you mean 'brake'?"),
    ("brake = 0.01", 'brake = { distribution = "norm" }', "add truncate"),
    ("brake = 0.01", "brake = nan", "drive_brake = nan"),
    ("brake = 0.01", "brake = { times = [0.0], valeus = [1.0] }", "brake: must be { times = [...], values = [...] }"),
    ("brake = 0.01", "brake = { times = [0.0, 1.0], values = [1.0] }", "times (2,), values (1,)"),
    ("brake = 0.01", "brake = { times = [1.0, 0.0], values = [1.0, 2.0] }", "in ascending order"),
    ("brake = 0.01", "brake = { times = [], values = [] }", "times (0,)"),
    (
        "brake = 0.01",
        "brake = { times = [2.0, ANY], values = [1.0, 2.0] }",
        "brake: time 2 may be 0, before 2: truncate",
    ),
    ("brake = 0.01", "brake = { times = [ANY, 0.5], values = [1.0, 2.0] }", "brake: time 2 = 0.5, before 1"),
    ("brake = 0.01", 'brake = { times = ["same"], values = [1.0] }', "or 'same' as the one before"),
    (
        "brake = 0.01",
        "brake = { times = [ANY, 'same', 'same'], values = [1.0, 2.0, 3.0] }",
        "once, or twice for a jump",
    ),
    ("brake = 0.01", "V = 0.01", "V0: must be left out: [drive] prescribes V"),
    ('"norm", scale = 0.01, truncate = [-0.1, 0.1]', '"norm"', "drive_slope: reaches from -inf to inf"),
    ("force = {", "force = inf\n#", "drive_force = inf: must be a finite number"),
    ("n = 40", "n = 40\nrest = 1e-3", "rest = 0.001: must be left out where [drive] lasts to the end"),
    ("n = 40", 'n = 40\nmethod = "flow"', "method = 'flow': must be 'auto' or 'integrate' with [drive]"),
    ("drive_torque_2.drive_force", "torque.drive_force", "'torque' has no distribution"),
    ("[correlation]", "[correlation]\ndrive = 1\n[[drive]]\n#", "is not TOML"),
]


def test_refusals(read):
    for old, new, words in REFUSED:
        text = SCENE.replace(old, new.replace("ANY", '{ distribution = "uniform" }'))
        refused(lambda text=text: read(text), words, error=vr.ConfigError)
    refused(lambda: read("drive = 1\n" + SCENE.replace("[drive]", "[[drvie]]")), error=vr.ConfigError)


def test_a_drive_that_ends_goes_with_a_rest(read):
    text = SCENE[: SCENE.index("slope")] + SCENE[SCENE.index("[run]") :]
    run = read(text.replace("n = 40", "n = 4\nrest = 1e-3"))
    assert (roll_block(run, 0)[1].status <= 1).all()


OWN_TIMES = """
preset = "paper-section-5"
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, RISE, "same", FALL], values = [0.0, { distribution = "uniform", scale = 0.3 }, 0.05, -0.1] }
force = { times = [5e-4, 5e-4], values = [0.0, 0.01] }
[run]
n = 12
t = [1e-3, 3e-3]
keep = "all"
""".replace("RISE", '{ distribution = "uniform", loc = 1e-3, scale = 5e-4 }').replace(
    "FALL", '{ distribution = "uniform", loc = 2e-3, scale = 1e-3 }'
)


def test_times_of_its_own_for_every_motion(read, tmp_path):
    """As each motion by itself, to the last bit, jumps included; the times are inputs, in the digest and the store."""
    run = read(OWN_TIMES)
    values, motions = roll_block(run, 0)
    assert set(run.inputs.uncertain) == {"drive_torque_time_2", "drive_torque_time_4", "drive_torque_2"}
    for n in range(12):
        top, jump, end = (values[f"drive_torque_{name}"][n] for name in ("2", "time_2", "time_4"))
        m = vr.roll(
            vr.PAPER_SECTION_5, 0.0, 0.0, [1e-3, 3e-3], force=([5e-4, 5e-4], [0.0, 0.01]),
            torque=([0.0, jump, jump, end], [0.0, top, 0.05, -0.1]),
        )  # fmt: skip
        for name in ("V", "omega", "x"):
            assert np.array_equal(getattr(m, name), getattr(motions, name)[n]), (n, name)
    assert read(OWN_TIMES.replace("5e-4 }", "6e-4 }")).digest != run.digest
    run_ensemble(run, tmp_path / "s.zarr", threads=1)
    export_netcdf(tmp_path / "s.zarr", tmp_path / "s.nc")
    with xr.open_dataset(tmp_path / "s.nc", group="motions", engine="h5netcdf", decode_times=False) as kept:
        assert np.array_equal(kept["drive_torque_time_2"].values, values["drive_torque_time_2"])
        assert kept["drive_torque_time_2"].attrs["long_name"].startswith("time 2 of the given torque")
    dataset = motions.to_xarray()
    assert dataset["drive_torque_time"].dims == dataset["drive_torque"].dims == ("motion", "drive_torque_corner")


@pytest.mark.parametrize("name", ["V", "omega"])
def test_prescribed_speeds_of_a_run(read, name):
    """A motor or a tow whose speed is drawn, over times that are; of a cylinder in its units."""
    free, given, other = ("omega0", "V0", "omega") if name == "V" else ("V0", "omega0", "V")
    text = OWN_TIMES.replace("torque = {", f"{name} = {{").replace('"same", ', "").replace("0.05, ", "")
    text = text.replace("force =", "torque =" if name == "V" else "force =").replace(f"{given} = 0.0", "")
    values, motions = roll_block(read(text), 0)
    for n in range(12):
        times = [0.0, *(values[f"drive_{name}_time_{k}"][n] for k in (2, 3))]
        m = vr.roll(
            vr.PAPER_SECTION_5, **{"V0": None, "omega0": None, free: 0.0}, t=[1e-3, 3e-3],
            **{name: (times, [0.0, values[f"drive_{name}_2"][n], -0.1])},
            **{"torque" if name == "V" else "force": ([5e-4, 5e-4], [0.0, 0.01])},
        )  # fmt: skip
        assert np.array_equal(m.V, motions.V[n]), n
        assert np.array_equal(m.omega, motions.omega[n]), n
    lines = [
        (f"{free} = 0.0", "V0 = 0.0\nomega0 = 0.0", f"{given}: must be left out: [drive] prescribes {name}"),
        ("[run]", f"{other} = 1.0\n[run]", f"{free}: must be left out: [drive] prescribes {other}"),
        ("[run]", f"{'force' if name == 'V' else 'brake'} = 1.0\n[run]", f"must be left out with a prescribed {name}"),
        ("n = 12", "n = 12\nrest = 1e-3", "rest = 0.001: must be left out where [drive] lasts to the end"),
    ]
    for old, new, words in lines:
        wrong = text.replace(old, new)
        refused(lambda wrong=wrong: read(wrong), words, error=vr.ConfigError)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # it starts in full slip
def test_a_prescribed_speed_of_a_cylinder_in_si_units(read):
    text = CYLINDER[: CYLINDER.index("torque = ")] + "omega = { times = [0.0, 1.0], values = [0.05, 0.2] }\n[run]\n"
    run = read(text.replace("omega0 = 0.05\n", "") + CYLINDER[CYLINDER.index("n = 8") :])
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    for n in range(8):
        roller = vr.Cylinder(R=values["R"][n], m=values["m"][n], E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
        m = roller.roll(0.014, None, [0.5, 1.0, 2.0], omega=([0.0, 1.0], [0.05, 0.2]))
        for name in ("V", "omega", "x", "torque", "work_torque"):
            expected = getattr(m, name)
            assert close(columns[name][n], expected, rel=tol.RUN_SI, scale=np.abs(expected).max())
