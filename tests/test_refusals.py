"""The table refusals.txt: bad input is answered by an error of the package's own, doubtful input by one warning."""

import dataclasses
import math
import warnings
from functools import cache
from pathlib import Path

import experiments
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from drives import DMA, ON_DMA
from refusals import refused
from run_files import FILES
from scipy import stats

import viscoroll as vr
from viscoroll import fmu
from viscoroll.app.identification.measurements_toml import read_measurements
from viscoroll.contact_law.validity.free_rolling import FreeRolling
from viscoroll.contact_law.validity.steadiness import Steadiness
from viscoroll.core import errors
from viscoroll.core.scale import Scale
from viscoroll.io.config import read_law_source, read_roller
from viscoroll.io.runs import read_run
from viscoroll.io.runs.sensitivity import sobol_indices
from viscoroll.io.sampling import sample
from viscoroll.materials.law.netcdf import law_table_of
from viscoroll.materials.law.table import law_table
from viscoroll.materials.material_netcdf import material_as_dataset
from viscoroll.materials.material_toml import read_materials

TABLE = Path(__file__).with_name("refusals.txt").read_text()
LINES = [line for line in TABLE.splitlines() if line.strip() and not line.startswith("#")]
V = xr.DataArray([0.1, 0.2], dims="run", coords={"run": ["a", "b"]})
SCENE = "[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\n"
ROLLER = "[cylinder]\nR = 0.1\nm = 35.5\nmu = 0.2\n"
RUBBER = "[material]\nE = 2.3e5\nnu = 0.5\nprony = { E = [2.0, 6], tau = [1.0, 1e-4] }\nT_ref = 0.3\n"
MEASURED = vr.Material(2e6, 0.5, vr.Prony([2.0, 6.0], [1e-3, 1e-5]), measured=vr.Measured(0.06, 628.0, 0.01, "dma.csv"))
OMEGA = np.logspace(-2, 4, 20)
#: what the calls see
NAMES = vars(experiments) | {
    "vr": vr, "np": np, "math": math, "nan": math.nan, "inf": math.inf, "xr": xr, "fmu": fmu,
    "DMA": (OMEGA, 1.0 + OMEGA / (1.0 + OMEGA), 0.1 + 0.0 * OMEGA),
    "LABELLED": V, "FRAME": pd.DataFrame({"V": [0.1, 0.2], "delta": [0.0, 0.01]}, index=["x", "y"]),
    "DMA_ROLLER": ON_DMA, "ONE": vr.Scene(11.0, 10.0, 0.5, 120.0), "dataclasses": dataclasses,
    "UNSURE": ON_DMA.replace(material=vr.Prony(np.outer(np.linspace(0.9, 1.1, 7), DMA.E), DMA.tau)),
    "BELT": vr.Cylinder(R=0.1, m=30.0, material=vr.Material.rigid(), base=MEASURED, mu=0.5),
    "SERIES": vr.Prony([2.0, 6.0], [1.0, 1e-4]), "MANY": vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1]),
    "SCENE_FILE": SCENE, "ROLLER_FILE": ROLLER, "RUBBER_FILE": RUBBER,
    "CYLINDER_FILE": ROLLER + "E = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\n",
    "read_roller": read_roller, "read_law_source": read_law_source, "read_materials": read_materials, "sample": sample,
    "FreeRolling": FreeRolling, "Steadiness": Steadiness, "Scale": Scale,
    "law_table": law_table, "law_table_of": law_table_of,
    "SOFT": vr.Material(2.3e5, 0.49, vr.Prony([2.0, 6.0], [1.0, 1e-4]), density=1100.0),
    "STEEL": vr.Material.elastic(2e11, 0.3),
    "COVERED": vr.Scene(material=vr.Cover(11.0, nu=0.5, thickness=1.0), kappa=10.0, mu=0.5, gamma=1.0),
    "THIN": vr.Scene(material=vr.Cover(11.0, nu=0.3, thickness=0.02), kappa=10.0, mu=0.5),
    "RUBBER_COVER": vr.Material(2.3e5, 0.49, vr.Prony([2.0, 6.0], [1.0, 1e-4]), thickness=0.02),
    "PAIR": lambda material, base: vr.Cylinder(R=0.1, m=35.5, mu=0.2, material=material, base=base).validity(1.0),
    "material_as_dataset": material_as_dataset, "sobol_indices": sobol_indices,
    "OTHER_GRID": xr.Dataset(
        {"Q": (("V", "delta"), np.ones((3, 3)), {"units": "kN/m"}), "M": ("V", np.ones(3), {"units": "N mm/m"})},
        {"V": ("V", np.arange(1.0, 4.0), {"units": "mm/s"}), "delta": ("delta", [-0.01, 0.0, 0.01], {"units": "1"})},
        {"R": 0.1, "load": 1e3},
    ),
    "grid": cache(lambda: vr.tables.build(vr.presets.PAPER_SECTION_5, [0.1, 0.2], delta=[0.0, 0.1], alpha=[1.0, 2.0])),
    "law_file": cache(lambda: vr.tables.law(11.0)), "read_run": read_run,
    "stats": stats, "PAPER": vr.presets.PAPER_SECTION_5_ROUNDED, "ROLLER": vr.presets.RUBBER_CYLINDER,
}  # fmt: skip


def told(call, answer, names):
    """One warning that points to who called, with these words; or none, or none with these."""
    first, *words = answer.split(" | ")
    silent = first == "no warning"
    first = words.pop() if silent and words else "" if silent else first
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        eval(call, names)
    said = [each for each in found if first in str(each.message)]
    assert len(said) == (not silent), [str(each.message) for each in found]
    for each in said:
        assert (each.category, each.filename) == (vr.ModelWarning, "<string>")
        assert all(word in str(each.message) for word in words)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "answer"), [*zip(LINES[::2], LINES[1::2], strict=True)], ids=LINES[::2])
def test_answered(call, answer, tmp_path):
    def file(content, name="file.toml"):
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path / name

    def run(name, old, new):
        assert old in FILES[name]
        return read_run(file(FILES[name].replace(old, new, 1)))

    def measured(old, new):
        return vr.identify(**read_measurements(experiments.measurements(tmp_path, old, new)), starts=1)

    def netcdf(data, without=""):
        """A file of a dataset, without an attribute, as another program writes it."""
        data = data.copy()
        data.attrs.pop(without, None)
        data.to_netcdf(tmp_path / "given.nc", engine="h5netcdf")
        return tmp_path / "given.nc"

    made = {"file": file, "run": run, "measured": measured, "netcdf": netcdf}
    names, (kind, _, words) = NAMES | made, answer.strip().rpartition("! ")
    if kind == "says":
        said = str(eval(call, names))
        assert all(word in said for word in words.split(" | ")), said
        return None
    if kind == "ModelWarning" or words.startswith("no warning"):
        told(call, words, names)
        return None
    error = getattr(errors, kind or "ParameterError")
    refused(lambda: eval(call, names), *words.split(" | "), error=error)


def test_errors_of_input_are_value_errors():
    assert issubclass(vr.ParameterError, ValueError)
