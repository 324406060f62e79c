"""Run files: each motion is the one that a user would call for, and what a file says is in its
digest and its store.
"""

import re
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from long_cases import long
from refusals import refused
from run_files import CERTAIN, FILES, PAPER, run_of

import viscoroll as vr
from viscoroll.motion.many_motions import FLOW_PAYS
from viscoroll.runs import export_netcdf, open_run, roll_inputs, run_ensemble, verify
from viscoroll.runs.run_records import identity
from viscoroll.runs.run_store import block_inputs, columns_of, roll_block
from viscoroll.runs.sensitivity import sobol_indices

pytestmark = [
    pytest.mark.usefixtures("here"),
    # the paper's own scene is beyond the model
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]

SI_UNITS = {
    "V": "m s-1",
    "omega": "rad s-1",
    "x": "m",
    "distance": "m",
    "angle": "rad",
    "onset_time": "s",
    "force": "N m-1",
    "torque": "N m m-1",
} | dict.fromkeys(("work_force", "slip_loss"), "J m-1")
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
    found = {
        key: drawn(each, name + key, values, i)
        for key, each in part.items()
        if key not in ("prony", "creep")
    }
    for kind in part.keys() & {"prony", "creep"}:
        series = drawn(part[kind], name, values, i).values()
        found["prony"] = vr.Prony(*series) if kind == "prony" else vr.Prony.creep(*series)
    return found


def body(wlf=None, temperature=None, reference=None, **given):
    """A material at its temperature."""
    material = vr.Material(temperature=reference, **given)
    return material.at(temperature, vr.WLF(**wlf)) if wlf else material


def alone(run, values, i):
    """One motion of a block, as a user calls for it."""
    prefix = {"base": "base_", "drive": "drive_"}
    file = {
        key: drawn(part, prefix.get(key, ""), values, i)
        for key, part in tomllib.loads(run.text).items()
    }
    call = [file["start"].get("V0"), file["start"].get("omega0"), run.t]
    options = file.get("drive", {})
    options |= {
        name: getattr(run.settings, name) for name in ("rtol", "rest", "unsteady", "rested")
    }
    if "cylinder" in file:
        bodies = {name: body(**file[name]) for name in ("material", "base") if name in file}
        return vr.Cylinder(**file["cylinder"], **bodies).roll(*call, **options)
    scene = file.get("scene", {})
    scene = (
        vr.presets.PAPER_SECTION_5.replace(**scene)
        if "preset" in file
        else vr.Scene(material=scene.pop("prony"), **scene)
    )
    return scene.roll(*call, **options)


@pytest.mark.parametrize("file", FILES)
def test_every_motion_is_that_of_a_call(file):
    """And to the bit that of a block which is cut elsewhere, but where the unit of time follows
    from the temperature of the first; inputs keep to their ranges.
    """
    run = run_of(FILES[file])
    values, motions = roll_block(run, 0)
    few = {name: value[3:5] for name, value in values.items()}
    again = roll_inputs(run, few, 2).V
    if file != "a temperature each":
        assert np.array_equal(again, motions.V[3:5], equal_nan=True)
    mu = np.asarray(values.get("mu", 0.2))
    assert ((mu >= 0.05) & (mu <= 0.6)).all()
    columns = columns_of(run, values, motions)
    for i in range(0, len(motions.V), 4):
        one = alone(run, values, i)
        for name in ("onset_time", *run.settings.fields):
            expected = getattr(one, name)
            scale = np.abs(np.nan_to_num(expected)).max()
            assert close(columns[name][i], expected, tol.RUN_SI, scale=scale, what=(name, i))


def test_a_temperature_follows_the_shift_of_a_file():
    """And the moduli, given at the temperature where it is 1, follow the vertical shift."""
    shifts = 'vertical_shift = "entropic"\nwlf = { T0 = 20.0, C1 = 17.44, C2 = 51.6 }\n'
    given = "E = 3e6\nnu = 0.5\nT_epsilon = 0.01\nT_sigma = 0.001\n"
    temperature = 'temperature = { distribution = "uniform", loc = 10.0, scale = 30.0 }\n'
    Path("rubber.toml").write_text(f"[material]\n{given}{shifts}")
    first, *others = (
        roll_block(run_of(CERTAIN.replace("E = 3e6\nnu = 0.5\n", text + temperature)), 0)[1].V
        for text in (
            'file = "rubber.toml"\n',
            given + shifts,
            given + shifts + "reference = 20.0\n",
        )
    )
    assert all(np.array_equal(first, other) for other in others)


@pytest.mark.parametrize(
    "file",
    # others say no more by their numbers
    [
        *("a preset", "compliances", "own times", "unsteady"),
        *long("rubber on rubber", "a driven roller"),
    ],
)
def test_the_identity_is_of_every_number_but_n(file):
    """Of the file, whatever is told beside it; with blocks of one size a run is the same for any
    number of motions.
    """
    text = FILES[file]
    text = text.replace("[run]\n", "[run]\nblock = 4\n" * ("block =" not in text) or "[run]\n")
    own = identity(run_of(text))
    assert identity(run_of("# told\n" + text)) == own
    assert identity(run_of(re.sub(r"\bn = \d+", "n = 1000", text))) == own
    for number in re.finditer(r"(?<![\w.-])-?\d[\w.+-]*", text):
        sign = number[0].startswith("-")
        changed = (
            text[: number.start()] + "-" * sign + "1" + number[0][sign:] + text[number.end() :]
        )
        try:
            assert (identity(run_of(changed)) == own) == (
                text[: number.start()].endswith("\nn = ")
            ), number
        except vr.FileError:
            continue


def test_the_identity_is_of_the_order_of_uncertain_numbers():
    """V0 and omega0 take the random numbers in their order: a store of one was resumed with the
    other.
    """
    text = FILES["a preset"]
    _, V0, omega0, *_ = text[text.index("[start]") :].splitlines(keepends=True)
    swapped = text.replace(V0 + omega0, omega0 + V0)
    assert run_of(swapped).digest != run_of(text).digest


@pytest.mark.parametrize("file", ["numbers", *long("driven", "a driven roller")])
def test_a_store_holds_the_run(file):
    """And what is exported of it: columns, what drove them, their units, their summaries."""
    run = run_of(FILES[file].replace("[run]", "[run]\nquantiles = [0.5]"))
    run_ensemble(run, "s.zarr", threads=2)
    assert verify("s.zarr").ok
    export_netcdf("s.zarr", "s.nc")
    blocks = [columns_of(run, *roll_block(run, block)) for block in range(run.blocks)]
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    with xr.open_dataset("s.nc", group="motions", engine="h5netcdf", decode_times=False) as kept:
        for name, values in columns.items():
            assert np.array_equal(kept[name].values, values, equal_nan=True), name
            assert kept[name].attrs["long_name"]
        for name in ("V", "onset_time"):
            assert kept[name].attrs["units"] == (SI_UNITS[name] if run.si else "1")
        assert kept.attrs["quantities"] == ("in SI units" if run.si else "dimensionless")
    found = open_run("s.zarr").summaries
    for name in run.settings.summaries:
        told = found[f"{name}_mean"].attrs
        if run.si:
            assert told["units"] == SI_UNITS.get(name, "1"), name
            assert "T_epsilon" not in told["long_name"]
        if name in columns and name != "onset_time" and not name.endswith("_loss"):
            assert np.array_equal(found[f"{name}_max"].values, columns[name].max(axis=0)), name
    if file == "driven":  # shares of an energy that is not there
        assert np.isnan(found["lost_to_slip_mean"].values).all()
        assert (found["slip_loss_mean"].values > 0.0).all()


# --- which method ---


def test_the_flow_map_where_many_start_in_one_scene():
    """Chosen by the run: a block of slow starts does not get a finer one.  Of motions at rest there
    is none.
    """
    one = FILES["a preset"].replace("[correlation]\nV0.mu = 0.7\n", "")
    one = one[: one.index("[scene]")] + one[one.index("[start]") :].replace("block = 12", "")
    run = run_of(one.replace("n = 30", f"n = {FLOW_PAYS}"))
    assert (run.mappable, run.method) == (True, "flow")
    values, motions = roll_block(run, 0)
    few = {name: value[3:4] for name, value in values.items()}
    assert roll_inputs(run, few, 2).V[0, 1] == motions.V[3, 1]
    still = run_of(
        PAPER + '[start]\nV0 = 0.0\nomega0 = 0.0\n[run]\nn = 2\nt = 1e-3\nmethod = "flow"'
    )
    assert roll_block(still, 0)[1].V.tolist() == [[0.0], [0.0]]


SPREAD = '{ distribution = "uniform", loc = 0.05, scale = 0.1 }'


@pytest.mark.parametrize("R", ["0.1", SPREAD])
def test_a_start_in_pure_rolling(R):
    """omega0 = "rolling" is V0/R of each motion, in a dimensionless file V0; a flow map serves it
    too.
    """
    roller = (
        f"[cylinder]\nR = {R}\nm = 35.5\nmu = 0.3\nE = 2.3e5\nnu = 0.49\nT_epsilon = "
        "10.7\nT_sigma = 0.97\n"
    )
    start = f'[start]\nV0 = {SPREAD}\nomega0 = "rolling"\n[run]\nn = 8\nt = [0.0, 0.5]\n'
    values, motions = roll_block(run_of(roller + start), 0)
    assert close(motions.omega[:, 0], values["V0"] / values.get("R", 0.1), tol.UNITS)
    run = run_of(PAPER + start + 'method = "flow"\n')
    values, motions = roll_block(run, 0)
    assert (motions.omega[:, 0].tolist(), run.fastest) == (
        values["V0"].tolist(),
        run.inputs.largest("V0"),
    )


# --- columns of files ---

SAMPLED = (
    FILES["numbers"]
    .replace("m = 35.5", 'm = { file = "sample.csv", column = "mass" }')
    .replace("E = 2.3e5", 'E = { file = "sample.csv", column = "modulus" }')
)


@pytest.fixture
def sample():
    frame = pd.DataFrame(
        {"mass": [30.0, 40.0, 50.0], "modulus": [2e5, 3e5, 4e5], "name": ["a", "b", "c"]}
    )
    frame.to_csv("sample.csv")
    return frame[["mass", "modulus"]]


@pytest.mark.parametrize("suffix", [".csv", ".nc", ".parquet"])
def test_columns_of_a_file_share_their_row(sample, suffix):
    if suffix == ".nc":
        xr.Dataset.from_dataframe(sample).to_netcdf("sample.nc", engine="h5netcdf")
    elif suffix == ".parquet":
        pytest.importorskip("pyarrow")
        sample.to_parquet("sample.parquet")
    run = run_of(SAMPLED.replace(".csv", suffix).replace("n = 20", "n = 100"))
    assert f"sample{suffix}" in run.inputs.dimensions
    values = block_inputs(run, 0)
    assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
    assert set(values["m"]) == {30.0, 40.0, 50.0}


def test_a_file_by_two_names_is_one_file(here, sample):
    """Also by way of a link; its columns share their row, and cannot be told apart by Sobol
    indices.
    """
    (here / "link.csv").symlink_to("sample.csv")
    for other in ("./sample.csv", "link.csv", str(here / "sample.csv")):
        run = run_of(
            SAMPLED.replace('"sample.csv", column = "modulus"', f'"{other}", column = "modulus"')
        )
        assert run.inputs.dimensions.count("sample.csv") == 1
        values = block_inputs(run, 0)
        assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
        refused(lambda run=run: sobol_indices(run, 16), "E are columns of one file, sample.csv")
    text = SAMPLED.replace('"mass"', '"name"')
    refused(lambda: run_of(text), "line 3", "'a' is not a number", error=vr.FileError)
    sample.assign(mass="a").to_parquet("sample.parquet")
    text = SAMPLED.replace(".csv", ".parquet")
    refused(lambda: run_of(text), "line 3", "one column of numbers", error=vr.FileError)
    sample.assign(mass=np.nan).to_parquet("sample.parquet")
    refused(lambda: run_of(text), "line 3", "has nan as number 1", error=vr.FileError)


@pytest.mark.parametrize("temperature", ["20.0", '{ distribution = "uniform", scale = 30.0 }'])
def test_a_material_of_a_file_is_in_the_digest(temperature):
    """Also if its temperature is uncertain: a store is not continued with another material."""
    text = CERTAIN.replace("E = 3e6\nnu = 0.5", f'file = "r.nc"\ntemperature = {temperature}')
    digests = set()
    for E in (3e6, 4e6):
        rubber = vr.Material(E, 0.5, vr.Prony([0.3, 1.5], [2e-2, 1e-5]), shift=vr.WLF(T0=20.0))
        rubber.to_netcdf("r.nc")
        digests.add(run_of(text).digest)
    assert len(digests) == 2


def test_inputs_have_indices():
    """Those of materials too."""
    text = FILES["rubber on rubber"].replace('"lost_to_slip"]', '"torque"]')
    found = sobol_indices(run_of(text), 64, threads=1)
    inputs = "mu V0 E_1 E_2 tau_1 E base_E base_E_1 base_tau_1"
    assert set(found["input"].values) == set(inputs.split())
