"""Pictures: whole or not at all, of runs without values too, and loaded when drawn."""

import json

import pytest
from run_files import run_of

from viscoroll.core.plots import draw
from viscoroll.core.plots.style import save
from viscoroll.io.runs import open_run, run_ensemble

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model


def test_a_run_without_values(tmp_path):
    """A panel without values says so; all values at one point are one bar."""
    for n, (start, wanted, empty) in enumerate(
        (
            ("V0 = 2.0\nomega0 = 0.0", '["V", "onset_time", "rest_time"]', {"onset_time", "rest_time"}),  # none stuck
            ("V0 = 0.0\nomega0 = 0.0", '["V", "x"]', set()),  # all at rest
            ("V0 = 0.0\nomega0 = 1.0", '["V", "delta"]', {"delta"}),  # infinite
        )
    ):
        text = f'preset = "paper-section-5"\n[start]\n{start}\n[run]\nn = 50\nt = [0.0]\nsummaries = {wanted}\n'
        run_ensemble(run_of(text, tmp_path), tmp_path / f"{n}.zarr", threads=1)
        figure = draw(open_run(tmp_path / f"{n}.zarr").summaries)
        titles = dict(zip(sorted(json.loads(wanted)), [axes.get_title() for axes in figure.axes[1::2]], strict=True))
        assert {name for name, title in titles.items() if title == "no values"} == empty
        save(figure, tmp_path / "run.png")
