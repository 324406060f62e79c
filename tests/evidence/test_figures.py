"""Every figure is drawn without a warning and labelled; the stages that save them."""

import csv
from html import escape

import numpy as np
import pytest
import tolerances as tol
from processes import made

import viscoroll as vr
from pipeline.figures import FIGURES
from pipeline.report import SECTIONS

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model


def test_labelled_without_a_warning():
    assert FIGURES.keys() == {name for figures in SECTIONS.values() for name in figures}
    starts = np.random.default_rng(0).uniform(-2.0, 2.0, (2, 200))
    scene = vr.presets.PAPER_SECTION_5_ROUNDED
    few = scene.ensemble(*starts, np.linspace(0.0, 4e-3, 9), rtol=1e-4)
    V = np.geomspace(1e-2, 4.0, 21)
    grid = vr.tables.build(
        scene, V, delta=vr.tables.creep_nodes(scene, V, 21), alpha=[1.5, 11.0, 81.5]
    )
    given = {"ensemble": (few.to_xarray(),), "grid": (grid,)}
    for name, draw in FIGURES.items():
        figure = draw(*given.get(name, ()))
        panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>" and axes.axison]
        assert any(axes.get_xlabel() for axes in panels), name
        for axes in panels:
            assert axes.get_xlabel() or axes.get_shared_x_axes().get_siblings(axes) != [axes], name


# --- pipeline: motions, ensemble, figures, summary ---

_SMALL = """
[tables]
allowed = 1e-12
allowed_N = 1e-12
alpha = [8, 16]
[tables.laws.paper]
material = {{ E = 2.3e5, nu = 0.49, T_epsilon = 10.7, T_sigma = 0.97 }}
[tables.grid]
preset = "paper-section-5-rounded"
V = [1e-2, 4.0, 21]
delta = 21
alpha = [1.5, 11.0, 81.5]
allowed = 1e-12
[validate]
tables = ["{law}", "{folder}/grid.nc"]
states = 500
stress_states = 1
table_points = 100
times = 5
seed = 0
runtime = 1e-7
[runtime]
law = "{law}"
end = 1e-4
times = 3
rtol = 1e-8
[benchmark]
law = "{law}"
sizes = [15]
V = [1e-5, 2.1]
rtol = [1e-6]
root_solves = [1e-5]
motions = 3
speed = 2.0
seed = 5
[figures]
grid = "{folder}/grid.nc"
[ensemble]
preset = "paper-section-5-rounded"
motions = 100
speed = 2.0
t = [0.0, 1e-3, 4e-3]
rtol = 1e-4
seed = 3
kept = 40
"""


def test_motions_from_tables_are_those_of_root_solves(tmp_path):
    """A small run of every stage, after which nothing is out of date."""
    config = tmp_path / "small.toml"
    out = tmp_path / "out"
    config.write_text(_SMALL.format(law=tmp_path / "paper.nc", folder=tmp_path))
    given = "--config", config, "-o", out, "--tables", tmp_path
    assert "report: " in made("", *given)
    assert made("", *given) == ""
    rows = list(csv.DictReader((out / "benchmark.csv").read_text().splitlines()))
    assert [row["law by"] for row in rows] == [
        "grid, 15 by 15",
        "law file",
        "numerical roots",
        "vr.roll",
    ]
    for kind in ("paper", "random"):
        grid, *exact = (float(row[f"error, {kind}"]) / float(row["rtol"]) for row in rows)
        assert 0.0 < max(exact) < tol.DEMO_MOTION < grid
    page = (out / "index.html").read_text()
    assert all(f"<td>{escape(row['law by'])}</td>" in page for row in rows)
