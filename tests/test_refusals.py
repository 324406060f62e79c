"""The table of refusals, refusals.txt: bad input is answered by an error of the package's own, in one line."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from refusals import refused
from run_files import FILES
from scipy import stats

import viscoroll as vr
from viscoroll import fmu
from viscoroll.config import read_bodies, read_body
from viscoroll.materials.file import read_materials
from viscoroll.runs import read_run
from viscoroll.sampling import sample
from viscoroll.validation import validate

TABLE = Path(__file__).with_name("refusals.txt").read_text(encoding="utf-8")
LINES = [line for line in TABLE.splitlines() if line.strip() and not line.startswith("#")]
V = xr.DataArray([0.1, 0.2], dims="run", coords={"run": ["a", "b"]})
SCENE = "[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\n"
ROLLER = "[cylinder]\nR = 0.1\nm = 35.5\nmu = 0.2\n"
RUBBER = "[material]\nE = 2.3e5\nnu = 0.5\nprony = { E = [2.0, 6], tau = [1.0, 1e-4] }\nT_ref = 0.3\n"
OMEGA = np.logspace(-2, 4, 20)
#: what the calls see
NAMES = {
    "vr": vr, "np": np, "math": math, "nan": math.nan, "inf": math.inf, "validate": validate, "fmu": fmu,
    "DMA": (OMEGA, 1.0 + OMEGA / (1.0 + OMEGA), 0.1 + 0.0 * OMEGA),
    "LABELLED": V, "FRAME": pd.DataFrame({"V": [0.1, 0.2], "delta": [0.0, 0.01]}, index=["x", "y"]),
    "SERIES": vr.Prony([2.0, 6.0], [1.0, 1e-4]), "MANY": vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1]),
    "SCENE_FILE": SCENE, "ROLLER_FILE": ROLLER, "RUBBER_FILE": RUBBER,
    "CYLINDER_FILE": ROLLER + "E = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\n",
    "read_body": read_body, "read_bodies": read_bodies, "read_materials": read_materials, "sample": sample,
    "stats": stats, "PAPER": vr.PAPER_SECTION_5_ROUNDED, "ROLLER": vr.RUBBER_CYLINDER,
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "answer"), [*zip(LINES[::2], LINES[1::2], strict=True)], ids=LINES[::2])
def test_refused(call, answer, tmp_path):
    def file(content: str | bytes, name: str = "file.toml") -> Path:
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path / name

    def run(name: str, old: str, new: str) -> object:
        assert old in FILES[name]
        return read_run(file(FILES[name].replace(old, new, 1)))

    words = [word.strip() for word in answer.split(" | ")]
    kind, _, first = words[0].rpartition("! ")
    refused(
        lambda: eval(call, NAMES | {"file": file, "run": run}),
        first,
        *words[1:],
        error=getattr(vr, kind or "ParameterError"),
    )


def test_errors_of_input_are_value_errors():
    assert issubclass(vr.ParameterError, ValueError)
