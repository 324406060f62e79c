"""The program ``viscoroll``: every command on good and on bad input."""

import io
import json
import re
import shlex
import shutil
import subprocess
import sys
import warnings

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
import xarray as xr
from calls import file
from places import content
from processes import printed

import viscoroll as vr
from viscoroll.cli import arguments, main
from viscoroll.materials.checked_netcdf import checksum, dataset_content
from viscoroll.materials.material_toml import read_materials
from viscoroll.presets import read_roller

pytestmark = [
    pytest.mark.usefixtures("here"),
    # the paper's own scene is beyond the model
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]

COMMANDS = [
    name for name in arguments.COMMANDS if name not in ("warmup", "identify", "fmu")
]  # these take long
UNCERTAIN = """
preset = "paper-section-5"
scene.mu = { distribution = "uniform", loc = 0.19, scale = 0.02 }
start = { V0 = 1.0, omega0 = 0.0 }
run = { n = 1, t = 1.2e-4, summaries = ["V"] }
"""


def code_of(line):
    """The exit code of a command line, in which PAPER stands for paper-section-5."""
    return main(shlex.split(line.replace("PAPER", "paper-section-5")))


@pytest.fixture
def run(capsys):
    """Runs a command line that must succeed; returns what it printed."""

    def run(line):
        code = code_of(line)
        out, err = capsys.readouterr()
        assert (code, err) == (0, "")
        return out

    return run


@pytest.fixture
def refuse(capsys, here):
    """Runs a command line that must fail in one line, leaving the folder as it was; returns the
    line.
    """

    def refuse(line):
        before = content(here)
        code = code_of(line)
        out, err = capsys.readouterr()
        assert (code, out) == (2, "")
        assert re.fullmatch(r"viscoroll: error: [^\n]+\n", err), err
        assert content(here) == before
        return err

    return refuse


@pytest.fixture(scope="module")
def law(tmp_path_factory):
    """A file of the law of a rubber."""
    path = tmp_path_factory.mktemp("tables") / "rubber.nc"
    vr.tables.save(vr.tables.law(vr.presets.RUBBER_CYLINDER.material), path)
    return path


# --- the program itself ---


def test_help_imports_nothing_heavy():
    printed(
        f"""\
import sys
from viscoroll.cli import main
for command in {COMMANDS!r}: assert main([*command.split(), '--help']) == 0
assert main(['--help']) == 0
heavy = {{'numpy', 'numba', 'scipy', 'xarray', 'matplotlib', 'h5py'}} & sys.modules.keys()
assert not heavy, heavy"""
    )


@pytest.mark.parametrize(
    "line, code, error",
    [
        ("samples . | true; exit ${PIPESTATUS[0]}", 141, ""),
        ("samples . >/dev/full", 2, "viscoroll: error: standard output: No space left on device\n"),
        ("samples . >&-", 0, ""),
        # an error that nobody hears is one
        ("contact 2>&-", 2, ""),
        ("contact 2>/dev/full", 2, ""),
    ],
)
def test_output_that_nothing_takes(line, code, error):
    command = ["bash", "-c", f"{shlex.quote(sys.executable)} -m viscoroll {line}"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", error)


def test_letters_that_a_stream_lacks_and_a_closed_one(monkeypatch):
    """A Greek letter, a name of a file that is no UTF-8, and no standard error are no failures."""
    file('[material]\nname = "\\u03bc"\nE = 1.0\nnu = 0.5\n', "m.toml")
    file(UNCERTAIN, "run.toml")
    printed = io.TextIOWrapper(io.BytesIO(), "ascii")
    for name, value in (("stdout", printed), ("stderr", None), ("orig_argv", ["\udcff"])):
        monkeypatch.setattr(sys, name, value)
    for line in ("material show m.toml", "ensemble run.toml -o s.zarr", "tables law PAPER -o l.nc"):
        assert code_of(line) == 0
    assert b"\\u03bc" in printed.buffer.getvalue()


@pytest.mark.parametrize(
    "raised, code, words",
    [
        (KeyboardInterrupt, 130, ""),
        (MemoryError, 2, "not enough memory"),
        (ImportError, 2, "error"),
    ],
)
def test_interrupt_and_memory(monkeypatch, capsys, raised, code, words):
    def fail(*_, **__):
        raise raised

    monkeypatch.setattr(vr.Scene, "contact", fail)
    assert code_of("contact PAPER --V 1 --delta 0") == code
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
    assert err.count("\n") == bool(words)


@pytest.mark.parametrize("command", ["", "tables", "material", *COMMANDS])
@pytest.mark.long
def test_example_of_help_runs(run, command):
    file(UNCERTAIN, "run.toml")
    _, *examples = run(f"{command} --help").partition("example:")[2].split("\n  viscoroll ")
    for example in examples:
        run(example)


# --- materials ---

RUBBER = """
[material]
name = "tread"
E = 3e6
nu = 0.5
prony = { E = [0.5, 1.0], tau = [1.0, 0.01] }
T_ref = 2.0
wlf = { T0 = 20.0 }
"""
DATA = vr.datasets.path("dma.csv")
ROLLER = "[cylinder]\nR = 0.1\nm = 35.5\nmu = 0.2\n"


def test_material_fit(run, here):
    """What was read, the report, and a file that holds the fit to the bit."""
    report = run(f"material fit {DATA} --nu 0.5 --name 'a rubber' -o a.toml")
    record = vr.read_dma(DATA)
    fit = vr.fit_prony(*record, source="dma.csv")
    assert report == f"{record}\n{fit}\n"
    assert read_materials(here / "a.toml") == {"material": fit.material(0.5, name="a rubber")}
    assert "; modes (terms): 4" in run(f"material fit {DATA} --modes 4 --misfit 0.05")
    assert f"measured from          {fit.measured}" in run("material show a.toml")


@pytest.mark.parametrize(
    "misfit, words, name",
    [("1e-4", "above the target of 0.01%", "poor.toml"), ("0.9", "is above 5%", "poor.nc")],
)
def test_a_fit_that_misses_writes_no_file(here, capsys, misfit, words, name):
    """Exit code 1, whether the misfit was asked for in vain or is above 5 %; with --force a file
    that says so.
    """
    fit = f"material fit {DATA} --misfit {misfit} --modes 1 -o {name}"
    assert code_of(fit) == 1
    told = capsys.readouterr().err
    assert words in told
    assert f"{name} is not written" in told
    assert "raise --misfit" not in told
    assert not (here / name).exists()
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert code_of(f"{fit} --force") == 0
    assert capsys.readouterr().err.count(words) == 1
    assert "forced: the misfit of" in read_materials(here / name)["material"].measured.source


def test_a_cylinder_of_a_file_is_in_si(run):
    """As its methods say, with the unit of every column."""
    file(ROLLER + RUBBER, "a.toml")
    cylinder = read_roller("a.toml")
    point = "contact a.toml --V 0.5 --delta 0.01"
    assert f"M = {cylinder.contact(0.5, delta=0.01).M:.10g} N m m-1" in run(point)
    table = json.loads(run("roll a.toml --V0 1 --omega0 0.5 --t 0,0.1 --format json"))
    assert table["V [m s-1]"] == cylinder.roll(1.0, 0.5, [0.0, 0.1]).V.tolist()
    assert run(f"{point} --format csv").startswith("V [m s-1],delta,lam,length [m],")
    assert f"{cylinder.steady(slope=0.003).V[0]:.10g}" in run("steady a.toml --slope 0.003")


def test_a_warning_is_one_line(capsys):
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert code_of("roll PAPER --V0 1.5 --omega0 0.5 --t 1e-6") == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(
        "viscoroll: warning: the model does not hold for this motion: the cylinder is too slow "
    )


PAPER = vr.presets.PAPER_SECTION_5
V = np.array([-1.0, 0.0, 1.0, 2.0])[:, None]
OMEGA = np.geomspace(1e-3, 1.0, 4)
SAME = {
    "contact PAPER --V -1:1:3,2 --omega 1e-3:1:4:log": lambda _: PAPER.contact(V, omega=OMEGA),
    "stress PAPER --V -0.5 --delta 0.01": lambda data: PAPER.stress(
        data["x"].values, -0.5, delta=0.01
    ),
}


@pytest.mark.parametrize("line", SAME)
def test_csv_and_netcdf_hold_the_bits_of_the_call(run, line):
    run(f"{line} -o a.csv")
    run(f"{line} -o a.nc")
    with xr.open_dataset("a.nc", engine="h5netcdf", decode_times=False) as data:
        expected = SAME[line](data).to_xarray()
        axes = [*expected.sizes]
        table = xr.Dataset.from_dataframe(pd.read_csv("a.csv").set_index(axes))
        for name, each in expected.drop_vars("regime", errors="ignore").variables.items():
            for found in (data, table) if each.ndim else ():
                assert np.array_equal(found[name].values, each.values, equal_nan=True), name


# --- tables ---

ONE = "[material]\nE = 3e6\nnu = 0.5\nprony = { E = [0.3, 0.6], tau = [2e-2, 1e-3] }\n"


def test_tables_law(run, here):
    file(ONE + "[base]\nE = 2e11\nnu = 0.3\n", "rubber.toml")
    for name in ("pair.nc", "pair.h", "pair.json"):
        assert run(f"tables law rubber.toml -o {name}").startswith(f"{name}: ")
    law = vr.load_law("pair.nc")
    assert (law.unlike, law.pair.base.E) == (True, 2e11)
    assert "static const vr_law pair = {" in (here / "pair.h").read_text()
    run("export pair.nc -o again.h")
    assert (here / "again.h").read_text().replace("again", "pair") == (here / "pair.h").read_text()
    run("tables law --alpha 8:16 -o law.nc")
    assert vr.load_law("law.nc", alpha=11.0).material == 11.0


def test_tables_validate(run, capsys, law):
    assert "EXCEEDED" not in run(f"tables validate {law} -n 99")
    wrong = vr.tables.load(law)
    wrong["press"].values[9] *= 1.0 + tol.CLI_WRONG
    vr.tables.save(
        wrong.assign_attrs(sha256_of_numbers=checksum(dataset_content(wrong).numbers)), "wrong.nc"
    )
    assert code_of("tables validate wrong.nc -n 99") == 1
    out, err = capsys.readouterr()
    assert err == ""
    assert [": press" in line for line in out.splitlines() if "EXCEEDED" in line] == [True]


# --- what is shown; what is refused: one line, exit code 2, no file touched ---


#: a command -> words of the line that refuses it
REFUSED = {
    "": "COMMAND",
    "contact --V 1 --delta 0": "SCENE",
    "samples file": "file: cannot be written",
    "material fit rpm.csv": "--units 'frequency=rad/s'",
    "contact PAPER --V 1 --delta 0 -o folder.csv": "folder.csv",
    "contact PAPER --V 1 --delta 0 -o out.xlsx": "out.xlsx",
    f"contact PAPER --V 1 --delta 0 -o {'a' * 300}.csv": "cannot be written (File name too long)",
    "contact PAPER --V 1 --delta 0 -o a.csv --format json": "argument --format: not allowed "
    "with argument -o",
    "contact PAPER --V 1 --V 2 --delta 0": "argument --V: is given twice",
    "contact law.nc --V 1 --delta 0": "law.nc: is not a scene file: its name must end in .toml",
    "contact PAPER --V one --delta 0": "--V: 'one' must be a number, LOW:HIGH:COUNT",
    "stress PAPER --V 1,2 --delta 0": "--V: '1,2' must be a number",
    "material fit rubber.toml --column storage": "argument --column: 'storage' must be "
    "NAME=HEADING, as 'storage=Module 1'",
    "material fit dma.csv --units storage=MPa,kPa": "argument --units: 'kPa' must be NAME=UNIT",
    "material fit dma.csv --mode shear": "mode = 'shear': must be 'tension', as read from dma.csv",
    "material fit dma.csv --column temperature=E_loss": "read as 'temperature', but its unit "
    "'MPa' is not a unit of temperature: give the unit of the column, as units={'temperature'",
    "material fit dma.csv --wlf 8.86,101.6": "--wlf = '8.86,101.6': must be C1,C2,T0",
    "tables law rubber.toml --alpha 1:2 -o law.nc": "which has a material of its own",
    "tables law --alpha low:high -o law.nc": "'low:high' must be LOW:HIGH",
    "tables validate file": "file: is not a netCDF-4 file of a law or grid: give a .nc file",
    "export folder.csv -o all.csv": "all.csv: must be a name that ends in .nc for the results "
    "of a run",
    "export rubber.nc -o rubber.csv": "a name that ends in .nc, .cdf, .h, .json for a law",
    "plot figure-9 -o f.png": "'figure-9' is not a file that can be plotted: give FILE.nc",
    "sensitivity run.toml -o s.png": "'s.png' must end in .txt or .csv or .nc",
    "ensemble run.toml -o all.nc": "'all.nc' must end in .zarr",
    "ensemble run.toml -o s.zarr --cluster far": "'tcp://host:port' of a dask scheduler",
    "ensemble run.toml --cluster local": "--cluster = local: must be left out without -o",
    "ensemble run.toml --threads 0": "threads = 0: must be a whole number >= 1",
    "ensemble": "the following arguments are required: RUN.toml",
    "plot half.nc -o b.png": "half.nc: is damaged or is not a netCDF-4 file",
}
#: and of what others show
SHOWN = {
    "--version": f"viscoroll {vr.__version__}",
    "material fit rpm.csv --units frequency=rpm": "omega 6.283 to 25.13 rad/s",
    "doctor": "viscoroll | threads | cache | Q =",
    "material show tread.toml": "[material] tread | E    3e+06 Pa | instantaneous modulus  7.5e+06",
    "material show warm.toml": "unit of time T_ref     0.00295",
    "validity rubber-roller --V 5 --omega 4.99": "steady         yes | small_contact",
    "validity PAPER --V 1.5": "steady         no",
    "steady PAPER --force 0.12": "load 0: no steady speed: |force + torque| = 0.12",
}


@pytest.fixture
def files(here, law):
    """What the commands above name."""
    (here / "folder.csv").mkdir()
    shutil.copy(law, here)
    shutil.copy(law, here / "law.nc")
    (here / "half.nc").write_bytes(law.read_bytes()[:1000])
    shutil.copy(DATA, here)
    for name, text in {
        "file": "as it was",
        "run.toml": UNCERTAIN,
        "rubber.toml": ONE,
        "rpm.csv": "f [Schlag/min],E' [MPa],E'' [MPa]\n60,1.2,0.4\n120,1.5,0.5\n240,1.8,0.4\n",
        "tread.toml": RUBBER,
        "warm.toml": RUBBER + "temperature = 30.0\n",
    }.items():
        file(text, name)


def assert_said(tell, table):
    """Each command says the words that the table has for it."""
    for command, words in table.items():
        said = tell(command)
        assert all(word in said for word in words.split(" | ")), (command, said)


def test_refused(files, refuse):
    assert_said(refuse, REFUSED)


def test_shown(files, run):
    assert_said(run, SHOWN)
