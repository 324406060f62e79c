"""Pictures: whole or not at all, of runs without values too, and loaded when drawn."""

from dataclasses import replace

import numpy as np
import pytest
from calls import pair
from refusals import refused
from run_files import run_of

import viscoroll as vr
from viscoroll.core.plots import draw, save
from viscoroll.motion import drawn_summary
from viscoroll.runs import open_run, run_ensemble

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model


@pytest.mark.usefixtures("here")
@pytest.mark.long
def test_a_run_without_values():
    """A panel without values says so; all values at one point are one bar."""
    for n, (start, wanted, empty) in enumerate(
        (
            # none stuck
            ("V0 = 2.0\nomega0 = 0.0", '["V", "onset_time", "rest_time"]', 2),
            # all at rest
            ("V0 = 0.0\nomega0 = 0.0", '["V", "x"]', 0),
            # infinite
            ("V0 = 0.0\nomega0 = 1.0", '["V", "delta"]', 1),
        )
    ):
        text = (
            f'preset = "paper-section-5"\n[start]\n{start}\n[run]\nn = 5\nt = '
            f"[0.0]\nsummaries = {wanted}\n"
        )
        run_ensemble(run_of(text), f"{n}.zarr", threads=1)
        figure = draw(open_run(f"{n}.zarr").summaries)
        assert [axes.get_title() for axes in figure.axes].count("no values") == empty
        save(figure, "run.png")


def test_the_pressure_on_a_cover():
    """Without the shear stress, which is not known there."""
    rubber = replace(vr.Material.elastic(2e6, 0.5), thickness=0.012)
    belt = pair(vr.Material.rigid(), rubber, load=2e3)
    found = belt.stress(np.linspace(-0.02, 0.02, 21), 1.0, delta=0.0)
    (axes,) = found.plot().axes
    assert np.array_equal(axes.lines[0].get_ydata(), found.p)
    assert "shear" not in axes.get_ylabel()
    refused(belt.stress([], 1.0, delta=0.0).plot, "a plot needs")


def test_the_histogram_of_close_values_has_many_bars():
    """Speeds that differ by less than 2^-8 of their value, a bin of a stored histogram, and none
    lies beyond.
    """
    starts = 1.0 + 1e-4 * np.random.default_rng(0).standard_normal(1000)
    right = vr.presets.RUBBER_CYLINDER.ensemble(starts, 10.0, [1.0]).plot().axes[1]
    (stairs,) = right.patches
    assert (stairs.get_data().values > 0).sum() > 40
    assert not right.get_title()


def test_one_quantile_of_an_ensemble_is_no_picture():
    """It has no axis of levels, also where its level is still a coordinate."""
    motions = vr.presets.RUBBER_CYLINDER.ensemble([1.0, 2.0, 3.0], 10.0, [1.0, 2.0])
    summary = drawn_summary(motions.to_xarray())
    assert len(draw(summary).axes) == 6
    refused(lambda: draw(summary.isel(quantile=0)), "a plot needs")
